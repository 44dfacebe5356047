// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/LayerPixels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>

namespace osgGeoFX
{

namespace
{

using Texel = LayerPixels::Texel;
using Options = LayerPixels::Options;
using Kind = LayerPixels::Kind;

constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());

constexpr int zero = -1; // a channel that the image lacks
constexpr int full = -2;

/// Where an image's pixel has red, green, blue and alpha.
struct Channels
{
    GLenum format;
    int count;
    std::array<int, 4> at;
};

constexpr Channels knownChannels[] = {
    {GL_RGB, 3, {0, 1, 2, full}},         {GL_RGBA, 4, {0, 1, 2, 3}},
    {GL_BGR, 3, {2, 1, 0, full}},         {GL_BGRA, 4, {2, 1, 0, 3}},
    {GL_LUMINANCE, 1, {0, 0, 0, full}},   {GL_LUMINANCE_ALPHA, 2, {0, 0, 0, 1}},
    {GL_ALPHA, 1, {full, full, full, 0}}, {GL_RED, 1, {0, zero, zero, full}},
    {GL_RG, 2, {0, 1, zero, full}},
};

const Channels* findChannels(GLenum format)
{
    const auto* found = std::find_if(std::begin(knownChannels), std::end(knownChannels),
                                     [&](const Channels& channels) { return channels.format == format; });
    return found == std::end(knownChannels) ? nullptr : found;
}

/// Rows may begin at any byte.
template<typename T>
T load(const unsigned char* row, int index)
{
    T number;
    std::memcpy(&number, row + index * sizeof(T), sizeof(T));
    return number;
}

template<typename T>
Texel byteOf(T number)
{
    if constexpr (std::is_same_v<T, std::uint8_t>)
        return number;
    else
    {
        constexpr double one =
            std::is_integral_v<T> ? static_cast<double>(std::numeric_limits<T>::max()) : 1.0;
        const double share = static_cast<double>(number) / one;
        // This way round NaN is black.
        return share > 0.0 ? static_cast<Texel>(std::lround(std::min(share, 1.0) * 255.0)) : 0u;
    }
}

template<typename T>
void readColors(const unsigned char* row, const Channels& channels, const Options&, int width, Texel* texels)
{
    if (std::is_same_v<T, std::uint8_t> && channels.format == GL_RGBA)
    {
        // What live images have; compilers make this a copy.
        for (int x = 0; x < width; ++x, row += 4)
            texels[x] = Texel{row[0]} | Texel{row[1]} << 8 | Texel{row[2]} << 16 | Texel{row[3]} << 24;
        return;
    }
    for (int x = 0; x < width; ++x)
    {
        Texel texel = 0;
        for (int channel = 0; channel < 4; ++channel)
        {
            const int at = channels.at[channel];
            const Texel byte = at >= 0      ? byteOf(load<T>(row, x * channels.count + at))
                               : at == full ? 255u
                                            : 0u;
            texel |= byte << (8 * channel);
        }
        texels[x] = texel;
    }
}

template<typename T>
void readValues(const unsigned char* row, const Channels& channels, const Options& options, int width,
                Texel* texels)
{
    double noData = options.noData.value_or(std::nan(""));
    // What a person writes in decimals is what a float image holds rounded.
    if (std::is_same_v<T, float> && std::abs(noData) <= largest)
        noData = static_cast<double>(static_cast<float>(noData));
    const int first = std::max(channels.at[0], 0);
    for (int x = 0; x < width; ++x)
    {
        const auto value = static_cast<double>(load<T>(row, x * channels.count + first));
        const bool isData = std::abs(value) <= largest && value != noData;
        texels[x] = isData ? LayerPixels::texel(static_cast<float>(value)) : LayerPixels::none;
    }
}

using ReadRow = void (*)(const unsigned char*, const Channels&, const Options&, int, Texel*);

struct Reader
{
    GLenum type;
    std::size_t size;
    ReadRow colors, values;
};

constexpr Reader knownTypes[] = {
    {GL_UNSIGNED_BYTE, sizeof(std::uint8_t), readColors<std::uint8_t>, readValues<std::uint8_t>},
    {GL_BYTE, sizeof(std::int8_t), readColors<std::int8_t>, readValues<std::int8_t>},
    {GL_UNSIGNED_SHORT, sizeof(std::uint16_t), readColors<std::uint16_t>, readValues<std::uint16_t>},
    {GL_SHORT, sizeof(std::int16_t), readColors<std::int16_t>, readValues<std::int16_t>},
    {GL_UNSIGNED_INT, sizeof(std::uint32_t), readColors<std::uint32_t>, readValues<std::uint32_t>},
    {GL_INT, sizeof(std::int32_t), readColors<std::int32_t>, readValues<std::int32_t>},
    {GL_FLOAT, sizeof(float), readColors<float>, readValues<float>},
    {GL_DOUBLE, sizeof(double), readColors<double>, readValues<double>},
};

const Reader* findReader(GLenum type)
{
    const auto* found = std::find_if(std::begin(knownTypes), std::end(knownTypes),
                                     [&](const Reader& reader) { return reader.type == type; });
    return found == std::end(knownTypes) ? nullptr : found;
}

/// An image's rows from below, as texels.
class Source
{
public:
    Source(const osg::Image& image, const Options& options, const Channels& channels, const Reader& reader)
        : _image(image), _options(options), _channels(channels),
          _readRow(options.kind == Kind::Color ? reader.colors : reader.values)
    {
        // osg::Image does not know the size of a double.
        const std::size_t packing = std::max(1u, image.getPacking());
        const std::size_t length = image.getRowLength() > 0 ? image.getRowLength() : image.s();
        const std::size_t bytes = length * channels.count * reader.size;
        _step = (bytes + packing - 1) / packing * packing;
    }
    int width() const { return _image.s(); }
    int height() const { return _image.t(); }
    void read(int y, Texel* texels) const
    {
        const int row = _image.getOrigin() == osg::Image::TOP_LEFT ? height() - 1 - y : y;
        _readRow(_image.data() + row * _step, _channels, _options, width(), texels);
    }

private:
    const osg::Image& _image;
    const Options& _options;
    const Channels& _channels;
    ReadRow _readRow;
    std::size_t _step = 0;
};

/// From bytes to light and back. Light in 16 bits is fine enough: a byte's smallest step is 19 of them.
class Light
{
public:
    explicit Light(bool sRGB) : _codes(65536)
    {
        for (int code = 0; code < 256; ++code)
            _light[code] = static_cast<std::uint16_t>(std::lround(65535.0 * decode(code / 255.0, sRGB)));
        // Each for the middle of [light, light + 1).
        for (int light = 0; light < 65536; ++light)
            _codes[light] = static_cast<std::uint8_t>(
                std::lround(255.0 * encode(std::min(1.0, (light + 0.5) / 65535.0), sRGB)));
    }
    static const Light& of(bool sRGB)
    {
        static const Light coded(true), linear(false);
        return sRGB ? coded : linear;
    }
    double light(Texel code) const { return _light[code]; }
    Texel lightBits(Texel code) const { return _light[code]; }
    Texel code(double light) const { return _codes[static_cast<std::size_t>(light)]; }
    Texel code(Texel light) const { return _codes[light]; }

private:
    static double decode(double c, bool sRGB)
    {
        if (!sRGB) return c;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    static double encode(double c, bool sRGB)
    {
        if (!sRGB) return c;
        return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    }

    std::array<std::uint16_t, 256> _light{};
    std::vector<std::uint8_t> _codes;
};

// Three ways to make one texel of several; add() takes the share of the new one that each covers.

class ColorMean
{
public:
    explicit ColorMean(const Options& options) : _light(&Light::of(options.sRGB)) {}
    void add(Texel texel, double share)
    {
        const Texel alpha = texel >> 24;
        // Where all are transparent, their color is kept for those that blend without alpha.
        const double weight = share * (alpha > 0 ? alpha : 1e-6);
        for (int channel = 0; channel < 3; ++channel)
            _sum[channel] += weight * _light->light((texel >> (8 * channel)) & 255u);
        _weight += weight;
        _alpha += share * alpha;
        _share += share;
    }
    Texel take()
    {
        Texel texel = static_cast<Texel>(std::lround(_alpha / _share)) << 24;
        for (int channel = 0; channel < 3; ++channel)
            texel |= _light->code(_sum[channel] / _weight) << (8 * channel);
        *this = ColorMean(*_light);
        return texel;
    }
    /// The mean of four, in whole numbers: the same to the bit, and many times faster. The sums are exact, and their quotients are
    /// cut off to whole numbers either way.
    Texel ofFour(const Texel (&four)[4])
    {
        const Texel alphas[] = {four[0] >> 24, four[1] >> 24, four[2] >> 24, four[3] >> 24};
        const Texel sum = alphas[0] + alphas[1] + alphas[2] + alphas[3];
        if (alphas[0] == 0 || alphas[1] == 0 || alphas[2] == 0 || alphas[3] == 0)
        {
            for (const Texel texel : four)
                add(texel, 1.0);
            return take();
        }
        const bool even = alphas[0] == alphas[1] && alphas[0] == alphas[2] && alphas[0] == alphas[3];
        Texel texel = (sum + 2) / 4 << 24;
        for (int shift = 0; shift < 24; shift += 8)
        {
            Texel light = 0;
            for (int i = 0; i < 4; ++i)
                light += _light->lightBits(four[i] >> shift & 255u) * (even ? 1u : alphas[i]);
            texel |= _light->code(even ? light / 4 : light / sum) << shift;
        }
        return texel;
    }

private:
    explicit ColorMean(const Light& light) : _light(&light) {}

    const Light* _light;
    std::array<double, 3> _sum{};
    double _weight = 0.0, _alpha = 0.0, _share = 0.0;
};

class ValueMean
{
public:
    explicit ValueMean(const Options&) {}
    void add(Texel texel, double share)
    {
        if (texel == LayerPixels::none) return;
        _sum += share * static_cast<double>(LayerPixels::value(texel));
        _share += share;
    }
    Texel take()
    {
        const double sum = std::exchange(_sum, 0.0), share = std::exchange(_share, 0.0);
        return share > 0.0 ? LayerPixels::texel(static_cast<float>(sum / share)) : LayerPixels::none;
    }
    Texel ofFour(const Texel (&four)[4])
    {
        for (const Texel texel : four)
            add(texel, 1.0);
        return take();
    }

private:
    double _sum = 0.0, _share = 0.0;
};

class MostFrequent
{
public:
    explicit MostFrequent(const Options&) {}
    void add(Texel texel, double share)
    {
        if (texel == LayerPixels::none) return;
        for (auto& [known, sum] : _shares)
        {
            if (known != texel) continue;
            sum += share;
            return;
        }
        _shares.emplace_back(texel, share);
    }
    Texel take()
    {
        Texel best = LayerPixels::none;
        double most = 0.0;
        for (const auto& [texel, share] : _shares)
        {
            // The margin is for sums of fractions that are equal but for rounding.
            if (share <= most + 1e-9) continue;
            best = texel;
            most = share;
        }
        _shares.clear();
        return best;
    }
    Texel ofFour(const Texel (&four)[4])
    {
        for (const Texel texel : four)
            add(texel, 1.0);
        return take();
    }

private:
    std::vector<std::pair<Texel, double>> _shares;
};

/// The source pixels under each of fewer target pixels, with the share that is covered.
struct Cover
{
    int first = 0;
    std::vector<double> shares;
};

std::vector<Cover> coversOf(int source, int target)
{
    std::vector<Cover> covers(target);
    for (int i = 0; i < target; ++i)
    {
        const double begin = static_cast<double>(i) * source / target;
        const double end = static_cast<double>(i + 1) * source / target;
        covers[i].first = static_cast<int>(begin + 1e-9);
        for (int k = covers[i].first; k < std::min(source, static_cast<int>(std::ceil(end - 1e-9))); ++k)
            covers[i].shares.push_back(std::min(k + 1.0, end) - std::max<double>(k, begin));
    }
    return covers;
}

template<typename Mean>
void reduce(const Source& source, const Mean& empty, LayerPixels& pixels)
{
    const std::vector<Cover> columns = coversOf(source.width(), pixels.width);
    const std::vector<Cover> rows = coversOf(source.height(), pixels.height);
    std::vector<Texel> row(source.width());
    std::vector<Mean> means(pixels.width, empty);
    for (int y = 0; y < pixels.height; ++y)
    {
        for (std::size_t k = 0; k < rows[y].shares.size(); ++k)
        {
            source.read(rows[y].first + static_cast<int>(k), row.data());
            for (int x = 0; x < pixels.width; ++x)
                for (std::size_t i = 0; i < columns[x].shares.size(); ++i)
                    means[x].add(row[columns[x].first + i], rows[y].shares[k] * columns[x].shares[i]);
        }
        Texel* target = &pixels.levels[0][static_cast<std::size_t>(y) * pixels.side];
        for (int x = 0; x < pixels.width; ++x)
            target[x] = means[x].take();
    }
}

/// Rows of the level above one with so many texels a side, which has room for them.
template<typename Mean>
void halve(const std::vector<Texel>& below, std::size_t side, std::size_t firstRow, std::size_t endRow,
           Mean mean, std::vector<Texel>& above)
{
    for (std::size_t y = firstRow; y < endRow; ++y)
    {
        const Texel* low = &below[2 * y * side];
        const Texel* high = low + side;
        Texel* target = &above[y * (side / 2)];
        for (std::size_t x = 0; x < side; x += 2)
        {
            const Texel four[] = {low[x], low[x + 1], high[x], high[x + 1]};
            const bool same = four[0] == four[1] && four[0] == four[2] && four[0] == four[3];
            *target++ = same ? four[0] : mean.ofFour(four);
        }
    }
}

/// The rest of a row, beyond the picture.
void pad(Texel* row, const LayerPixels& pixels)
{
    std::fill(row + pixels.width, row + pixels.side, row[pixels.width - 1]);
}

/// The rows above the picture.
void padRows(LayerPixels& pixels)
{
    const auto side = static_cast<std::size_t>(pixels.side);
    std::vector<Texel>& base = pixels.levels[0];
    const Texel* last = &base[static_cast<std::size_t>(pixels.height - 1) * side];
    for (auto y = static_cast<std::size_t>(pixels.height); y < side; ++y)
        std::copy_n(last, side, &base[y * side]);
}

/// Level 0 with its padding, and the levels above it.
template<typename Mean>
void fill(const Source& source, const Options& options, LayerPixels& pixels)
{
    const auto side = static_cast<std::size_t>(pixels.side);
    pixels.levels.emplace_back(side * side);
    std::vector<Texel>& base = pixels.levels[0];
    if (pixels.reduced) reduce(source, Mean(options), pixels);
    for (int y = 0; y < pixels.height; ++y)
    {
        Texel* row = &base[static_cast<std::size_t>(y) * side];
        if (!pixels.reduced) source.read(y, row);
        pad(row, pixels);
    }
    padRows(pixels);
    for (auto s = side; s > 1 && static_cast<int>(pixels.levels.size()) != options.levels; s /= 2)
    {
        pixels.levels.emplace_back(s * s / 4);
        halve(*(pixels.levels.end() - 2), s, 0, s / 2, Mean(options), pixels.levels.back());
    }
}

/// Puts into the pixels what of the source is not there yet.
template<typename Mean>
LayerPixels::Rows refill(const Source& source, const Options& options, LayerPixels& pixels)
{
    const auto side = static_cast<std::size_t>(pixels.side);
    std::vector<Texel> row(side);
    LayerPixels::Rows changed;
    for (int y = 0; y < pixels.height; ++y)
    {
        source.read(y, row.data());
        Texel* former = &pixels.levels[0][static_cast<std::size_t>(y) * side];
        if (std::equal(row.data(), row.data() + pixels.width, former)) continue;
        std::copy_n(row.data(), pixels.width, former);
        pad(former, pixels);
        if (changed.end == 0) changed.first = y;
        changed.end = y + 1;
    }
    if (changed.end == 0) return changed;
    if (changed.end == pixels.height)
    {
        padRows(pixels);
        changed.end = pixels.side;
    }
    auto first = static_cast<std::size_t>(changed.first), end = static_cast<std::size_t>(changed.end);
    for (std::size_t level = 1; level < pixels.levels.size(); ++level)
    {
        first /= 2;
        end = (end + 1) / 2;
        halve(pixels.levels[level - 1], side >> (level - 1), first, end, Mean(options), pixels.levels[level]);
    }
    return changed;
}

std::string refusal(const osg::Image& image, const Options& options)
{
    if (!image.data() || image.s() < 1 || image.t() < 1) return "the image is empty; give one with pixels.";
    if (image.isCompressed()) return "the image is compressed; store it as plain RGB or RGBA.";
    if (image.r() != 1) return "the image has depth; give each of its slices as a layer of its own.";
    if (!findChannels(image.getPixelFormat()))
        return "the image's pixel format " + std::to_string(image.getPixelFormat()) +
               " is not known; store it as RGB, RGBA or LUMINANCE.";
    if (!findReader(image.getDataType()))
        return "the image's data type " + std::to_string(image.getDataType()) +
               " is not known; store it as bytes, shorts, ints, floats or doubles.";
    if (options.maxSide < 1 || options.maxSide > 16384)
        return "the largest side of a layer is " + std::to_string(options.maxSide) + "; set 1 to 16384.";
    if (options.levels < 0)
        return "the number of levels is " + std::to_string(options.levels) +
               "; set 0 for all, or 1 and more.";
    return {};
}

} // namespace

std::optional<LayerPixels> LayerPixels::make(const osg::Image& image, const Options& options,
                                             std::string& error)
{
    if (const std::string reason = refusal(image, options); !reason.empty())
    {
        error = (image.getFileName().empty() ? "Layer" : image.getFileName()) + ": " + reason;
        return std::nullopt;
    }
    const Source source(image, options, *findChannels(image.getPixelFormat()),
                        *findReader(image.getDataType()));
    LayerPixels pixels;
    const int larger = std::max(image.s(), image.t());
    pixels.reduced = larger > options.maxSide;
    const double scale = pixels.reduced ? static_cast<double>(options.maxSide) / larger : 1.0;
    pixels.width = std::max(1, static_cast<int>(std::lround(image.s() * scale)));
    pixels.height = std::max(1, static_cast<int>(std::lround(image.t() * scale)));
    pixels.side = 1;
    while (pixels.side < std::max(pixels.width, pixels.height))
        pixels.side *= 2;

    switch (options.kind)
    {
    case Kind::Color:
        fill<ColorMean>(source, options, pixels);
        break;
    case Kind::Value:
        fill<ValueMean>(source, options, pixels);
        break;
    case Kind::Class:
        fill<MostFrequent>(source, options, pixels);
        break;
    }
    return pixels;
}

std::optional<LayerPixels> LayerPixels::remake(const osg::Image& image, const Options& options,
                                               const LayerPixels& former, Rows& changed, std::string& error)
{
    const bool same = image.s() == former.width && image.t() == former.height && !former.reduced &&
                      std::max(image.s(), image.t()) <= options.maxSide;
    if (!same || !refusal(image, options).empty())
    {
        std::optional<LayerPixels> made = make(image, options, error);
        if (made) changed = {0, made->side};
        return made;
    }
    const Source source(image, options, *findChannels(image.getPixelFormat()),
                        *findReader(image.getDataType()));
    LayerPixels pixels = former;
    switch (options.kind)
    {
    case Kind::Color:
        changed = refill<ColorMean>(source, options, pixels);
        break;
    case Kind::Value:
        changed = refill<ValueMean>(source, options, pixels);
        break;
    case Kind::Class:
        changed = refill<MostFrequent>(source, options, pixels);
        break;
    }
    return pixels;
}

float LayerPixels::value(Texel texel)
{
    float value;
    std::memcpy(&value, &texel, sizeof(value));
    return value;
}

LayerPixels::Texel LayerPixels::texel(float value)
{
    if (std::isnan(value)) return none;
    value += 0.0f; // −0 is the class 0 too
    Texel texel;
    std::memcpy(&texel, &value, sizeof(texel));
    return texel;
}

} // namespace osgGeoFX
