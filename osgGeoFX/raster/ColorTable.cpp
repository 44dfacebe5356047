// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/ColorTable.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace osgGeoFX
{

namespace
{

using Stop = ColorTable::Stop;
using Stops = ColorTable::Stops;

struct NamedTable
{
    const char* name;
    std::vector<double> places;        ///< 0…1; evenly spread where there are none
    std::vector<std::uint32_t> colors; ///< 0xrrggbb
};

// Every 17th of the 256 published colors: viridis and magma by Smith, van der Walt and Firing (CC0), cividis by Nuñez,
// Anderton and Renslow (2018).
const std::vector<NamedTable>& namedTables()
{
    static const std::vector<NamedTable> tables = {
        {"viridis",
         {},
         {0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e, 0x2a788e, 0x23888e, 0x1f988b, 0x22a884,
          0x35b779, 0x54c568, 0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725}},
        {"magma",
         {},
         {0x000004, 0x0b0924, 0x20114b, 0x3b0f70, 0x57157e, 0x721f81, 0x8c2981, 0xa8327d, 0xc43c75, 0xde4968,
          0xf1605d, 0xfa7f5e, 0xfe9f6d, 0xfebf84, 0xfddea0, 0xfcfdbf}},
        {"cividis",
         {},
         {0x00204d, 0x002c6a, 0x0f386e, 0x31446b, 0x46506b, 0x575c6d, 0x666970, 0x757575, 0x848279, 0x958f78,
          0xa69d75, 0xb8ab70, 0xcbba69, 0xddc95f, 0xf1d951, 0xffea46}},
        {"terrain",
         {0.0, 0.15, 0.25, 0.5, 0.75, 1.0},
         {0x333399, 0x0099ff, 0x00cc66, 0xffff99, 0x805c54, 0xffffff}},
        {"greys", {}, {0x000000, 0xffffff}},
        {"traffic", {}, {0x1a9641, 0xa6d96a, 0xffffbf, 0xfdae61, 0xd7191c}},
    };
    return tables;
}

bool isColor(const osg::Vec4& color)
{
    for (int i = 0; i < 4; ++i)
        if (!(color[i] >= 0.0f && color[i] <= 1.0f)) return false;
    return true;
}

/// For the setters: why a stop is refused, nothing where it is fine.
const char* refusal(double value, const osg::Vec4& color)
{
    if (!std::isfinite(value)) return "the value of a stop must be a finite number";
    if (!isColor(color)) return "the color's parts must be from 0 to 1";
    return nullptr;
}

bool accept(const char* reason)
{
    if (!reason) return true;
    OSG_WARN << "osgGeoFX: ColorTable: " << reason << "; the table stays as it was." << std::endl;
    return false;
}

bool below(const Stop& a, const Stop& b)
{
    return a.value < b.value;
}

Stops::const_iterator firstAbove(const Stops& stops, double value)
{
    return std::upper_bound(stops.begin(), stops.end(), Stop{value, {}}, below);
}

/// The 32-bit float that a layer holds for a value.
float single(double value)
{
    constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
    return static_cast<float>(std::clamp(value, -largest, largest));
}

/// On the line through two stops, before and behind them too, as far as colors go.
osg::Vec4 mix(const Stop& a, const Stop& b, double value)
{
    // Halves, for differences beyond the largest number.
    const double t = (0.5 * value - 0.5 * a.value) / (0.5 * b.value - 0.5 * a.value);
    osg::Vec4 color;
    for (int i = 0; i < 4; ++i)
    {
        const auto from = static_cast<double>(a.color[i]), to = static_cast<double>(b.color[i]);
        color[i] = static_cast<float>(std::clamp(from + (to - from) * t, 0.0, 1.0));
    }
    return color;
}

/// A color in whole numbers, of which the largest is full intensity.
template<typename Texel>
Texel whole(const osg::Vec4& color)
{
    using Part = typename Texel::value_type;
    const auto part = [](float share)
    {
        return static_cast<Part>(std::lround(share * static_cast<float>(std::numeric_limits<Part>::max())));
    };
    return {part(color[0]), part(color[1]), part(color[2]), part(color[3])};
}

/// Places of values among the texels of a row, as the shader finds them.
struct Places
{
    double low, high;
    int last;

    double of(double value) const { return (value - low) / (high - low) * last; }
    int nearest(double value) const { return static_cast<int>(std::floor(of(value) + 0.5)); }
    /// A texel's own value; exact at both ends.
    double value(int texel) const
    {
        const double share = static_cast<double>(texel) / last;
        return low * (1.0 - share) + high * share;
    }
};

/// The stops from low to high.
std::pair<Stops::const_iterator, Stops::const_iterator> within(const Stops& stops, double low, double high)
{
    return {std::lower_bound(stops.begin(), stops.end(), Stop{low, {}}, below), firstAbove(stops, high)};
}

} // namespace

ColorTable::ColorTable(const ColorTable& other, const osg::CopyOp& copy)
    : osg::Object(other, copy), _stops(other._stops), _mode(other._mode), _noDataColor(other._noDataColor)
{
}

ColorTable::~ColorTable() = default;

bool ColorTable::setStops(Stops stops)
{
    for (const Stop& stop : stops)
        if (!accept(refusal(stop.value, stop.color))) return false;
    std::stable_sort(stops.begin(), stops.end(), below);
    _stops = std::move(stops);
    ++_revision;
    return true;
}

bool ColorTable::addStop(double value, const osg::Vec4& color)
{
    if (!accept(refusal(value, color))) return false;
    _stops.insert(firstAbove(_stops, value), Stop{value, color});
    ++_revision;
    return true;
}

void ColorTable::setMode(Mode mode)
{
    _mode = mode;
    ++_revision;
}

bool ColorTable::setNoDataColor(const osg::Vec4& color)
{
    if (!accept(refusal(0.0, color))) return false;
    _noDataColor = color;
    ++_revision;
    return true;
}

osg::Vec4 ColorTable::at(double value) const
{
    if (std::isnan(value)) return _noDataColor;
    if (_stops.empty()) return {};
    if (_mode == EXACT)
    {
        const auto above = std::upper_bound(_stops.begin(), _stops.end(), single(value),
                                            [](float a, const Stop& b) { return a < single(b.value); });
        const bool found = above != _stops.begin() && single((above - 1)->value) == single(value);
        return found ? (above - 1)->color : osg::Vec4();
    }
    const auto above = firstAbove(_stops, value);
    if (above == _stops.begin()) return above->color;
    const auto under = above - 1;
    if (above == _stops.end() || _mode == STEPS) return under->color;
    if (_mode == NEAREST) return value - under->value < above->value - value ? under->color : above->color;
    return mix(*under, *above, value);
}

std::pair<double, double> ColorTable::range() const
{
    if (_stops.empty()) return {0.0, 1.0};
    return {_stops.front().value, _stops.back().value};
}

bool ColorTable::row(double low, double high, osg::Vec4ub* texels, int width) const
{
    return fillRow(low, high, texels, width);
}

bool ColorTable::row(double low, double high, osg::Vec4us* texels, int width) const
{
    return fillRow(low, high, texels, width);
}

template<typename Texel>
bool ColorTable::fillRow(double low, double high, Texel* texels, int width) const
{
    if (!(high > low) || !std::isfinite(high - low) || width < 2)
    {
        std::fill(texels, texels + std::max(0, width), whole<Texel>(at(low)));
        return true;
    }
    const Places places{low, high, width - 1};
    for (int i = 0; i < width; ++i)
        texels[i] = whole<Texel>(at(places.value(i)));
    if (_mode == LINEAR)
        snapJumps(low, high, texels, width);
    else
        snapStops(low, high, texels, width);

    const auto [first, end] = within(_stops, low, high);
    for (auto stop = first; stop != end && stop + 1 != end; ++stop)
    {
        const double gap = places.of((stop + 1)->value) - places.of(stop->value);
        if (gap > 0.0 && gap < 1.0) return false;
    }
    return true;
}

template<typename Texel>
void ColorTable::snapJumps(double low, double high, Texel* texels, int width) const
{
    const Places places{low, high, width - 1};
    const auto [first, end] = within(_stops, low, high);
    for (auto stop = first; stop != end; ++stop)
    {
        const bool isJump = stop != _stops.begin() && (stop - 1)->value == stop->value;
        const bool isLast = stop + 1 == _stops.end() || (stop + 1)->value > stop->value;
        if (!isJump || !isLast) continue;
        // The margin is for a value that is a texel's own but for rounding.
        const int texel = static_cast<int>(std::floor(places.of(stop->value) + 1e-3));
        const bool ramp = stop + 1 != _stops.end() && places.of((stop + 1)->value) > texel + 1;
        texels[texel] = whole<Texel>(ramp ? mix(*stop, *(stop + 1), places.value(texel)) : stop->color);
    }
}

template<typename Texel>
void ColorTable::snapStops(double low, double high, Texel* texels, int width) const
{
    const Places places{low, high, width - 1};
    const auto [first, end] = within(_stops, low, high);
    for (auto stop = first; stop != end; ++stop)
        texels[places.nearest(stop->value)] = whole<Texel>(stop->color);
}

osg::ref_ptr<ColorTable> ColorTable::named(const std::string& name, double low, double high)
{
    for (const NamedTable& table : namedTables())
    {
        if (name != table.name) continue;
        Stops stops;
        for (std::size_t i = 0; i < table.colors.size(); ++i)
        {
            const double place = table.places.empty()
                                     ? static_cast<double>(i) / static_cast<double>(table.colors.size() - 1)
                                     : table.places[i];
            osg::Vec4 color(0.0f, 0.0f, 0.0f, 1.0f);
            for (int channel = 0; channel < 3; ++channel)
                color[channel] = static_cast<float>((table.colors[i] >> (16 - 8 * channel)) & 255u) / 255.0f;
            stops.push_back({low * (1.0 - place) + high * place, color});
        }
        osg::ref_ptr<ColorTable> made = new ColorTable;
        return made->setStops(std::move(stops)) ? made : nullptr;
    }
    return nullptr;
}

std::vector<std::string> ColorTable::names()
{
    std::vector<std::string> names;
    for (const NamedTable& table : namedTables())
        names.emplace_back(table.name);
    return names;
}

osg::ref_ptr<osg::Image> ColorTable::legend(double low, double high, int width, int height) const
{
    constexpr int largest = 16384;
    if (width < 1 || height < 1 || width > largest || height > largest) return nullptr;
    std::vector<osg::Vec4ub> bar(std::max(width, height));
    if (_mode != EXACT)
        row(low, high, bar.data(), static_cast<int>(bar.size()));
    else if (const auto [first, end] = within(_stops, low, high); first != end)
        for (std::size_t i = 0; i < bar.size(); ++i)
            bar[i] =
                whole<osg::Vec4ub>(first[static_cast<std::ptrdiff_t>(i * (end - first) / bar.size())].color);

    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            std::copy_n(bar[width >= height ? x : y].ptr(), 4, image->data(x, y));
    return image;
}

} // namespace osgGeoFX
