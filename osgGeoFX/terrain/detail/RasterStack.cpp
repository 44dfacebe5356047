// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

// No point of the Earth has a height beyond these. Such a height is an undeclared no-data value.
constexpr float LOWEST = -12000.0f, HIGHEST = 9500.0f;
// No place of any planet has one beyond this.
constexpr float FARTHEST = 1e6f;

// A higher value is an undeclared no-data value. A resampling kernel may overshoot a little.
constexpr float MOST_PERCENT = 100.5f;

struct RampStop
{
    float fraction; ///< 0 at the database's lowest land, 1 at its highest
    float red, green, blue;
};

// From lowland green over yellow and brown to white summits. The colors are muted, so that light and shade can be
// seen.
constexpr RampStop RAMP[] = {{0.0f, 116, 143, 94},   {0.15f, 152, 168, 107}, {0.35f, 197, 189, 137},
                             {0.55f, 176, 149, 110}, {0.75f, 150, 127, 106}, {0.9f, 190, 182, 174},
                             {1.0f, 240, 240, 238}};
constexpr RampStop SEA_RAMP[] = {{0.0f, 40, 70, 112}, {1.0f, 108, 147, 178}};

template<std::size_t N>
void rampColor(const RampStop (&ramp)[N], float fraction, unsigned char* rgb)
{
    std::size_t next = 1;
    while (next + 1 < N && ramp[next].fraction < fraction)
        ++next;
    const RampStop &a = ramp[next - 1], &b = ramp[next];
    const float t = std::clamp((fraction - a.fraction) / (b.fraction - a.fraction), 0.0f, 1.0f);
    rgb[0] = static_cast<unsigned char>(std::lround(a.red + t * (b.red - a.red)));
    rgb[1] = static_cast<unsigned char>(std::lround(a.green + t * (b.green - a.green)));
    rgb[2] = static_cast<unsigned char>(std::lround(a.blue + t * (b.blue - a.blue)));
}

/// A place turned by full circles, so that it lies on a layer if any of its turns does.
double turnedInto(const BuildPlan::Layer& layer, const TilingScheme& scheme, double x)
{
    if (!scheme.crs.geographic) return x;
    return x - 360.0 * std::floor((x - layer.west) / 360.0 + 1e-12);
}

/// Whether a lattice may have points of a layer.
bool meets(const BuildPlan::Layer& layer, const TilingScheme& scheme, const Lattice& lattice)
{
    const double south = lattice.y0, north = lattice.y0 + (lattice.rows - 1) * lattice.dy;
    if (north < layer.south - layer.stepY || south > layer.north + layer.stepY) return false;
    const double west = lattice.x0, east = lattice.x0 + (lattice.columns - 1) * lattice.dx;
    for (const double turn : {-720.0, -360.0, 0.0, 360.0, 720.0})
        if ((turn == 0.0 || scheme.crs.geographic) && east + turn >= layer.west - layer.stepX &&
            west + turn <= layer.east + layer.stepX)
            return true;
    return false;
}

unsigned char byteOf(double share)
{
    return static_cast<unsigned char>(std::lround(share * 255.0));
}

} // namespace

RasterStack::RasterStack(const BuildPlan& plan) : _plan(plan)
{
    for (std::size_t i = 0; i < plan.options.dems.size(); ++i)
        _dems.emplace_back(plan.options.dems[i], RasterKind::Elevation, RasterBands(), plan.demVoids[i]);
    for (std::size_t i = 0; i < plan.options.imagery.size(); ++i)
        _imagery.emplace_back(plan.options.imagery[i], RasterKind::Imagery, plan.imagerySources[i].bands);
    _blends.resize(plan.layers.size());
    if (!plan.options.landCover.empty())
    {
        _landCover.emplace_back(plan.options.landCover, RasterKind::LandCover);
        _landCoverColors.emplace_back(plan.options.landCover, RasterKind::LandCover);
        _landCoverColors.back().colorize(plan.classColors);
        std::array<std::array<unsigned char, 4>, 256> shares{};
        for (const auto& entry : plan.classes)
            shares[static_cast<std::size_t>(entry.value)] = {byteOf(entry.trees), byteOf(entry.town),
                                                             byteOf(entry.bare), 255};
        _landCoverShares.emplace_back(plan.options.landCover, RasterKind::LandCover);
        _landCoverShares.back().colorize(shares);
    }
    if (!plan.options.treeCover.empty())
        _treeCover.emplace_back(plan.options.treeCover, RasterKind::TreeCover);
    if (plan.options.vertical == VerticalDatum::Egm96)
    {
        OGRSpatialReference geoid, ellipsoid;
        geoid.SetFromUserInput("EPSG:4326+5773");
        ellipsoid.importFromEPSG(4979);
        _geoid = createTransformation(gisOrder(geoid), gisOrder(ellipsoid), plan.options.dems.front());
    }
}

std::vector<float> RasterStack::heights(const Lattice& lattice)
{
    std::vector<float> result = heightsAboveSea(lattice);
    if (_geoid) moveToEllipsoid(lattice, result);
    return result;
}

std::vector<float> RasterStack::unitHeights(const Unit& unit)
{
    const Unit square = _plan.sampledSquare(unit);
    const Lattice own = _plan.postsWithApron(unit), all = _plan.postsWithApron(square);
    if (square.root == unit.root) return heights(own);
    if (!_square || !(*_square == square.root) || _squareFilled != (_plan.voids != nullptr))
    {
        _squareHeights = heights(all);
        _square = square.root;
        _squareFilled = _plan.voids != nullptr;
    }
    const int n = _plan.scheme.intervals;
    const int column = (unit.root.x - square.root.x * square.span()) * n,
              row = (unit.root.y - square.root.y * square.span()) * n;
    std::vector<float> result;
    for (int j = 0; j < own.rows; ++j)
    {
        const auto start =
            _squareHeights.begin() + static_cast<std::ptrdiff_t>(row + j) * all.columns + column;
        result.insert(result.end(), start, start + own.columns);
    }
    return result;
}

std::vector<float> RasterStack::heightsAboveSea(const Lattice& lattice, std::vector<unsigned char>* filled)
{
    std::vector<float> result = measuredHeights(lattice);
    if (filled) filled->assign(result.size(), 0);
    if (_plan.voids) _plan.voids->fill(lattice, result, filled);
    return result;
}

std::vector<unsigned char> RasterStack::covered(const Lattice& lattice, const std::vector<float>& heights)
{
    std::vector<unsigned char> result;
    result.reserve(heights.size());
    for (const float height : heights)
        result.push_back(std::isnan(height) ? 0 : 1);
    for (auto& dem : _dems)
        dem.markCovered(_plan.scheme.crs, lattice, result.data());
    return result;
}

std::vector<float> RasterStack::measuredHeights(const Lattice& lattice)
{
    std::vector<float> result = layerHeights(_plan.layers.front(), lattice);
    for (std::size_t i = 1; i < _plan.layers.size(); ++i)
    {
        const BuildPlan::Layer& layer = _plan.layers[i];
        if (!meets(layer, _plan.scheme, lattice)) continue;
        auto& blend = _blends[i];
        if (!blend)
            blend = std::make_unique<BlendMask>(
                BlendMask::Area{layer.west, layer.south, layer.east, layer.north},
                osg::Vec2d(layer.blendX, layer.blendY),
                [&](const Lattice& points) { return layerHeights(layer, points); });
        const std::vector<float> own = layerHeights(layer, lattice);
        for (int row = 0; row < lattice.rows; ++row)
            for (int column = 0; column < lattice.columns; ++column)
            {
                const std::size_t at =
                    static_cast<std::size_t>(row) * static_cast<std::size_t>(lattice.columns) +
                    static_cast<std::size_t>(column);
                if (std::isnan(own[at])) continue;
                const double share =
                    std::isnan(result[at])
                        ? 1.0
                        : blend->share(turnedInto(layer, _plan.scheme, lattice.x0 + column * lattice.dx),
                                       lattice.y0 + row * lattice.dy);
                result[at] = share >= 1.0 ? own[at]
                             : share <= 0.0
                                 ? result[at]
                                 : static_cast<float>(share * static_cast<double>(own[at]) +
                                                      (1.0 - share) * static_cast<double>(result[at]));
            }
    }
    return result;
}

std::vector<float> RasterStack::layerHeights(const BuildPlan::Layer& layer, const Lattice& lattice)
{
    std::vector<float> result(static_cast<std::size_t>(lattice.columns) *
                                  static_cast<std::size_t>(lattice.rows),
                              std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = layer.first; i < layer.last; ++i)
        _dems[i].sampleHeights(_plan.scheme.crs, lattice, result.data());
    const bool all = _plan.options.allHeights;
    const float lowest = all ? -FARTHEST : LOWEST, highest = all ? FARTHEST : HIGHEST;
    for (float& height : result)
        if (!(height >= lowest && height <= highest)) height = std::numeric_limits<float>::quiet_NaN();
    return result;
}

void RasterStack::moveToEllipsoid(const Lattice& lattice, std::vector<float>& heights)
{
    const auto columns = static_cast<std::size_t>(lattice.columns);
    std::vector<double> x(columns), y(columns), z(columns);
    std::vector<int> success(columns);
    const TransformationPtr toGeographic =
        _plan.scheme.crs.geographic ? nullptr
                                    : createTransformation(_plan.scheme.crs.srs, GridCrs::geocentric().srs,
                                                           _plan.options.dems.front());
    for (int row = 0; row < lattice.rows; ++row)
    {
        float* line = heights.data() + static_cast<std::size_t>(row) * columns;
        for (std::size_t i = 0; i < columns; ++i)
        {
            x[i] = lattice.x0 + static_cast<double>(i) * lattice.dx;
            y[i] = lattice.y0 + row * lattice.dy;
            z[i] = 0.0;
        }
        if (toGeographic)
            toGeographic->Transform(lattice.columns, x.data(), y.data(), nullptr, success.data());
        for (double& longitude : x)
            longitude -= 360.0 * std::round(longitude / 360.0);
        _geoid->Transform(lattice.columns, x.data(), y.data(), z.data(), success.data());
        for (std::size_t i = 0; i < columns; ++i)
        {
            // No geoid undulation lies beyond ±150 m. PROJ has then passed the height on without a grid.
            if (!success[i] || !(std::abs(z[i]) < 150.0))
                throw BuildError(
                    _plan.options.dems.front() +
                    ": PROJ cannot move its heights from EGM96 to the ellipsoid; install the package "
                    "proj-data, or build with --vertical none.");
            line[i] += static_cast<float>(z[i]);
        }
    }
}

std::vector<unsigned char> RasterStack::classes(const Lattice& lattice)
{
    if (_landCover.empty()) return {};
    std::vector<unsigned char> result(static_cast<std::size_t>(lattice.columns) *
                                      static_cast<std::size_t>(lattice.rows));
    _landCover.front().sampleClasses(_plan.scheme.crs, lattice, result.data());
    return result;
}

std::vector<unsigned char> RasterStack::colors(const Lattice& lattice)
{
    const std::size_t count =
        static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows);
    std::vector<unsigned char> planes(4 * count, 0);
    // Each layer covers those before it where it has data: the hypsometric ramp, the land cover's colors, the
    // imagery.
    if (_landCover.empty())
    {
        const TileFacts& whole = _plan.whole();
        const float top = std::max(whole.maxHeight, 1.0f), bottom = std::max(whole.minHeight, 0.0f);
        const std::vector<float> ground = heights(lattice);
        for (std::size_t i = 0; i < count; ++i)
        {
            unsigned char rgb[3] = {128, 128, 128};
            if (ground[i] <= 0.0f)
                rampColor(SEA_RAMP, 1.0f - ground[i] / std::min(whole.minHeight, -1.0f), rgb);
            else if (ground[i] > 0.0f)
                rampColor(RAMP, (ground[i] - bottom) / std::max(top - bottom, 1.0f), rgb);
            for (std::size_t channel = 0; channel < 3; ++channel)
                planes[channel * count + i] = rgb[channel];
            planes[3 * count + i] = 255;
        }
    }
    else
    {
        std::fill(planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(3 * count),
                  static_cast<unsigned char>(128));
        _landCoverColors.front().sampleColors(_plan.scheme.crs, lattice, planes.data());
        std::fill(planes.begin() + static_cast<std::ptrdiff_t>(3 * count), planes.end(),
                  static_cast<unsigned char>(255));
    }
    for (auto& image : _imagery)
        image.sampleColors(_plan.scheme.crs, lattice, planes.data());

    std::vector<unsigned char> result(3 * count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            result[3 * i + channel] = planes[channel * count + i];
    return result;
}

std::vector<unsigned char> RasterStack::cover(const Lattice& lattice, const std::vector<GroundCell>& ground)
{
    const std::size_t count = ground.size();
    std::vector<unsigned char> planes(4 * count, 0);
    for (std::size_t i = 0; i < count; ++i)
    {
        planes[i] = ground[i].trees;
        planes[2 * count + i] = ground[i].bare;
        planes[3 * count + i] = 255;
    }
    for (auto& shares : _landCoverShares)
        shares.sampleColors(_plan.scheme.crs, lattice, planes.data());
    std::vector<float> percent;
    if (!_treeCover.empty())
    {
        percent.assign(count, std::numeric_limits<float>::quiet_NaN());
        _treeCover.front().sampleMeans(_plan.scheme.crs, lattice, percent.data());
    }
    std::vector<unsigned char> result(4 * count);
    for (std::size_t i = 0; i < count; ++i)
    {
        unsigned char* texel = &result[4 * i];
        for (std::size_t channel = 0; channel < 3; ++channel)
            texel[channel] = planes[channel * count + i];
        if (!percent.empty() && percent[i] >= 0.0f && percent[i] <= MOST_PERCENT)
            texel[0] = byteOf(std::min(static_cast<double>(percent[i]) / 100.0, 1.0));
        texel[3] = static_cast<unsigned char>((ground[i].shore + 128) / 256);
    }
    return result;
}

} // namespace osgGeoFX
