// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "InventedTerrain.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>

namespace geofx::test
{

namespace
{

double mixed(double a, double b, double t)
{
    return a + (b - a) * t;
}

/// 0 below `low`, 1 above `high`.
double step(double low, double high, double x)
{
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double lattice(int x, int y, unsigned int seed)
{
    std::uint32_t h = static_cast<std::uint32_t>(x) * 374761393u +
                      static_cast<std::uint32_t>(y) * 668265263u + seed * 2246822519u;
    h = (h ^ (h >> 13)) * 1274126177u;
    h ^= h >> 16;
    return static_cast<double>(h) / 4294967295.0 * 2.0 - 1.0;
}

/// Smooth noise, −1…1, with hills about 1 apart.
double noise(double x, double y, unsigned int seed)
{
    const double column = std::floor(x), row = std::floor(y);
    const double u = x - column, v = y - row;
    const double s = u * u * u * (u * (6.0 * u - 15.0) + 10.0), t = v * v * v * (v * (6.0 * v - 15.0) + 10.0);
    const int i = static_cast<int>(column), j = static_cast<int>(row);
    return mixed(mixed(lattice(i, j, seed), lattice(i + 1, j, seed), s),
                 mixed(lattice(i, j + 1, seed), lattice(i + 1, j + 1, seed), s), t);
}

/// Noise of several sizes: hills, −1…1.
double hills(double x, double y, unsigned int seed, int octaves = 8)
{
    double sum = 0.0, size = 0.5;
    for (int i = 0; i < octaves; ++i, x = 2.03 * x + 17.0, y = 2.03 * y - 9.0, size *= 0.5)
        sum += size * noise(x, y, seed + static_cast<unsigned int>(i));
    return sum;
}

/// Ridges with branches and rounded valleys: 0…1.
double ridges(double x, double y, unsigned int seed, int octaves = 9)
{
    // What is straight in nature is only the grid.
    const double bentX = x + 0.35 * hills(x + 5.2, y + 1.3, seed + 90, 3);
    const double bentY = y + 0.35 * hills(x - 8.1, y + 2.8, seed + 70, 3);
    double sum = 0.0, size = 0.5, weight = 1.0, px = bentX, py = bentY;
    for (int i = 0; i < octaves; ++i)
    {
        double ridge = 1.0 - std::abs(noise(px, py, seed + static_cast<unsigned int>(i)));
        ridge *= ridge;
        sum += size * ridge * weight;
        weight = std::clamp(1.6 * ridge, 0.0, 1.0);
        px = 2.07 * px + 11.0;
        py = 2.07 * py + 7.0;
        size *= 0.48;
    }
    return sum;
}

/** A landscape that rivers have cut: land rises where `rise` says so (0…1) while rain carries it away, down to where
    `shore` says that the rivers end. Each step follows the water from the river mouths up (Braun and Willett, 2013), so
    that even large steps are stable. Heights are 0…1, smooth between the cells. */
class Rivers
{
public:
    using Map = std::function<double(double x, double y)>;

    Rivers(const Map& rise, const std::function<bool(double x, double y)>& shore, unsigned int seed)
    {
        for (int row = 0; row < side; ++row)
        {
            for (int column = 0; column < side; ++column)
            {
                const double x = (column + 0.5) / side, y = (row + 0.5) / side;
                const auto cell = static_cast<std::size_t>(index(column, row));
                _end[cell] = shore(x, y);
                _rise[cell] = std::max(rise(x, y), 0.0);
                _height[cell] =
                    _end[cell] ? 0.0 : 0.002 * (1.0 + noise(40.0 * x, 40.0 * y, seed)) + 0.01 * _rise[cell];
            }
        }
        for (int i = 0; i < steps; ++i)
            grow();
        const double highest = *std::max_element(_height.begin(), _height.end());
        for (double& height : _height)
            height /= highest;
    }

    double operator()(double x, double y) const
    {
        const double c = std::clamp(x * side - 0.5, 1.0, side - 2.001),
                     r = std::clamp(y * side - 0.5, 1.0, side - 2.001);
        const int column = static_cast<int>(c), row = static_cast<int>(r);
        std::array<double, 4> rows{};
        for (int j = 0; j < 4; ++j)
        {
            const auto at = [&](int i)
            {
                return _height[static_cast<std::size_t>(
                    index(std::clamp(column - 1 + i, 0, side - 1), std::clamp(row - 1 + j, 0, side - 1)))];
            };
            rows[static_cast<std::size_t>(j)] = cubic(at(0), at(1), at(2), at(3), c - column);
        }
        return std::max(cubic(rows[0], rows[1], rows[2], rows[3], r - row), 0.0);
    }

private:
    static constexpr int side = 400, steps = 140;
    static constexpr double power = 0.0012, share = 0.45;
    static constexpr double diagonal = 1.4142135623730951; ///< between the middles of two cells

    static int index(int column, int row) { return row * side + column; }
    static double cubic(double a, double b, double c, double d, double t)
    {
        return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
    }

    /// All cells, each one after the one that its water goes to.
    static std::vector<int> upstream(const std::vector<int>& to)
    {
        // The givers of each cell, one behind the other.
        std::vector<int> first(to.size(), -1), next(to.size(), -1), order, waiting;
        order.reserve(to.size());
        for (int cell = static_cast<int>(to.size()) - 1; cell >= 0; --cell)
        {
            const int taker = to[static_cast<std::size_t>(cell)];
            if (taker == cell)
            {
                waiting.push_back(cell);
                continue;
            }
            next[static_cast<std::size_t>(cell)] = first[static_cast<std::size_t>(taker)];
            first[static_cast<std::size_t>(taker)] = cell;
        }
        while (!waiting.empty())
        {
            const int cell = waiting.back();
            waiting.pop_back();
            order.push_back(cell);
            for (int giver = first[static_cast<std::size_t>(cell)]; giver >= 0;
                 giver = next[static_cast<std::size_t>(giver)])
                waiting.push_back(giver);
        }
        return order;
    }

    /// The steepest of a cell's eight neighbours, or the cell itself if none is lower.
    int steepestFrom(int column, int row) const
    {
        const int cell = index(column, row);
        const bool inner = column > 0 && row > 0 && column < side - 1 && row < side - 1;
        const double height = _height[static_cast<std::size_t>(cell)];
        double steepest = 0.0;
        int lowest = cell;
        for (int y = -1; y <= 1; ++y)
        {
            for (int x = -1; x <= 1; ++x)
            {
                if (!inner && (column + x < 0 || column + x >= side || row + y < 0 || row + y >= side))
                    continue;
                const int other = cell + y * side + x;
                const double drop = height - _height[static_cast<std::size_t>(other)];
                const double fall = x != 0 && y != 0 ? drop / diagonal : drop;
                // Without a branch, which processors could not foresee.
                lowest = fall > steepest ? other : lowest;
                steepest = std::max(fall, steepest);
            }
        }
        return lowest;
    }

    void grow()
    {
        // Water goes to the steepest of eight neighbours.
        std::vector<int> to(_height.size());
        for (int row = 0; row < side; ++row)
        {
            for (int column = 0; column < side; ++column)
            {
                const int cell = index(column, row);
                to[static_cast<std::size_t>(cell)] =
                    _end[static_cast<std::size_t>(cell)] ? cell : steepestFrom(column, row);
            }
        }
        const std::vector<int> order = upstream(to);
        std::vector<double> water(_height.size(), 1.0);
        for (auto cell = order.rbegin(); cell != order.rend(); ++cell)
            if (to[static_cast<std::size_t>(*cell)] != *cell)
                water[static_cast<std::size_t>(to[static_cast<std::size_t>(*cell)])] +=
                    water[static_cast<std::size_t>(*cell)];
        for (const int number : order)
        {
            const auto cell = static_cast<std::size_t>(number);
            if (_end[cell]) continue;
            _height[cell] += 0.01 * _rise[cell];
            const int next = to[cell];
            if (next == number) continue;
            const double away = next % side != number % side && next / side != number / side ? diagonal : 1.0;
            // Most cells have none but their own.
            const double flow = water[cell] == 1.0 ? 1.0 : std::pow(water[cell], share);
            const double force = 130.0 * power * flow / away;
            _height[cell] = (_height[cell] + force * _height[static_cast<std::size_t>(next)]) / (1.0 + force);
            // Nothing stands steeper than scree and rock allow.
            const double most = _height[static_cast<std::size_t>(next)] + 0.02 * away;
            _height[cell] = std::min(_height[cell], most);
        }
    }

    std::vector<double> _height = std::vector<double>(std::size_t{side} * side), _rise = _height;
    std::vector<char> _end = std::vector<char>(std::size_t{side} * side);
};

/// Heights in metres at x to the east and y to the north, 0…1 over the terrain.
using Heights = std::function<double(double x, double y)>;

struct Terrain
{
    Heights heights;
    int epsg = 4326;
    double west = 0.0, north = 0.0; ///< of the CRS
    double size = 1.0;              ///< of a side, in the CRS's units
    double turned = 0.0;            ///< of the grid, degrees
    double unit = 1.0;              ///< metres
    int samples = 1201;
    double share = 1.0; ///< of `size`, from north to south
};

/// The floor of the alps' main valley: how far to its side a place lies.
double besideValley(double x, double y)
{
    return std::abs(-0.6 * x + 0.8 * y - 0.10 * std::sin(5.0 * (0.8 * x + 0.6 * y)) - 0.08);
}

double alps(double x, double y)
{
    // A main valley with a lake, from the south-west to the north-east.
    static const Rivers rivers([](double u, double v)
                               { return 0.25 + 0.75 * step(0.02, 0.3, besideValley(u, v)); },
                               [](double u, double v) { return besideValley(u, v) < 0.018; }, 3);
    const double along = 0.8 * x + 0.6 * y;
    const double floor = 470.0 + 240.0 * along;
    const bool lake =
        besideValley(x, y) < 0.013 + 0.003 * noise(30.0 * x, 30.0 * y, 8) && along > 0.45 && along < 0.72;
    return lake ? 590.0 : floor + 3300.0 * rivers(x, y) + 30.0 * ridges(25.0 * x, 25.0 * y, 4, 4);
}

double landOfIslands(double x, double y)
{
    return hills(3.2 * x + 0.4, 3.2 * y, 21) + 0.9 * (y - x) - 0.02;
}

double islands(double x, double y)
{
    static const Rivers rivers([](double u, double v) { return step(0.0, 0.5, landOfIslands(u, v)); },
                               [](double u, double v) { return landOfIslands(u, v) < 0.0; }, 25);
    const double land = landOfIslands(x, y);
    return land < 0.0 ? std::max(400.0 * land, -180.0)
                      : 1500.0 * rivers(x, y) + 8.0 + 25.0 * ridges(20.0 * x, 20.0 * y, 29, 4);
}

double canyon(double x, double y)
{
    const double wander =
        0.5 + 0.13 * std::sin(7.0 * x) + 0.05 * std::sin(19.0 * x) + 0.05 * hills(4.0 * x, 4.0 * y, 7);
    const double side = 0.24 * std::pow(ridges(5.0 * x, 5.0 * y, 33, 6), 2.0);
    const double away = std::abs(y - wander) + 0.10 - side;
    const double depth = 1.0 - step(0.01, 0.17, away);
    // Beds of rock end in steps.
    const double stairs = 7.0 * depth, bed = std::floor(stairs);
    const double stepped = (bed + step(0.55, 1.0, stairs - bed)) / 7.0;
    return 2100.0 + 60.0 * hills(6.0 * x, 6.0 * y, 41) + 300.0 * (y - 0.5) - 1450.0 * stepped;
}

double volcano(double x, double y)
{
    static const Rivers rivers(
        [](double u, double v)
        {
            return 0.05 + std::exp(-11.0 * std::hypot(u - 0.53, v - 0.56)) +
                   0.4 * std::exp(-20.0 * std::hypot(u - 0.3, v - 0.72));
        },
        [](double u, double v)
        { return std::hypot(u - 0.53, v - 0.56) > 0.42 + 0.05 * noise(5.0 * u, 5.0 * v, 3); },
        5);
    const double away = std::hypot(x - 0.53, y - 0.56);
    const double crater = 230.0 * (1.0 - step(0.0, 0.012, away));
    const double plain = 110.0 + 90.0 * hills(6.0 * x, 6.0 * y, 60) + 120.0 * y;
    return plain + 1100.0 * rivers(x, y) + 1750.0 * std::exp(-10.0 * away) - crater +
           18.0 * ridges(30.0 * x, 30.0 * y, 66, 5);
}

double rolling(double x, double y)
{
    static const Rivers rivers(
        [](double u, double v) { return 0.6 + 0.4 * hills(3.0 * u, 3.0 * v, 82) + 0.4 * v; },
        [](double u, double v) { return v < 0.02 || std::abs(u - 0.5 - 0.12 * std::sin(6.0 * v)) < 0.004; },
        80);
    return 90.0 + 330.0 * std::pow(rivers(x, y), 0.8) + 12.0 * hills(20.0 * x, 20.0 * y, 84, 5);
}

double atoll(double x, double y)
{
    const double dx = x - 0.5, dy = y - 0.5, angle = std::atan2(dy, dx);
    const double radius = 0.27 * (1.0 + 0.16 * std::sin(2.0 * angle + 0.6) + 0.07 * std::sin(5.0 * angle));
    const double away = std::hypot(dx, dy) - radius;
    const double sill = hills(9.0 * x, 9.0 * y, 91, 6);
    if (away > 0.02) return std::max(-40.0 - 30000.0 * (away - 0.02), -2200.0);
    if (away < -0.02) return -24.0 + 16.0 * std::max(sill, -0.5) - 16.0 * step(0.02, 0.2, -away - 0.02);
    return 7.0 * (1.0 - std::abs(away) / 0.02) * step(-0.25, 0.1, sill) - 2.0;
}

double glacier(double x, double y)
{
    // Fjords, and an ice cap above them.
    const auto fjord = [](double u, double v)
    {
        return std::min(std::abs(hills(2.2 * u + 3.0, 2.2 * v, 111, 4)) - 0.012,
                        u + 0.3 * v - 0.16 + 0.1 * hills(4.0 * u, 4.0 * v, 117));
    };
    static const Rivers rivers([=](double u, double v) { return 0.2 + step(0.0, 0.3, fjord(u, v)); },
                               [=](double u, double v) { return fjord(u, v) < 0.0; }, 101);
    if (fjord(x, y) < 0.0) return std::max(3000.0 * fjord(x, y) - 5.0, -320.0);
    const double cap =
        1250.0 * std::sqrt(std::max(1.0 - 7.0 * (std::pow(x - 0.62, 2) + std::pow(y - 0.62, 2)), 0.0));
    return std::max(1700.0 * rivers(x, y) + 5.0,
                    cap * step(0.0, 0.12, fjord(x, y)) + 15.0 * hills(9.0 * x, 9.0 * y, 121, 4));
}

double range(double x, double y)
{
    static const Rivers rivers([](double u, double v)
                               { return 0.06 + step(0.3, 0.8, v + 0.1 * hills(3.0 * u, 3.0 * v, 134)); },
                               [](double, double v) { return v < 0.01; }, 131);
    return 300.0 + 3100.0 * rivers(x, y) + 40.0 * ridges(20.0 * x, 20.0 * y, 141, 4);
}

double massif(double x, double y)
{
    static const Rivers rivers(
        [](double u, double v)
        { return 0.12 + std::exp(-9.0 * (std::pow(u - 0.5, 2) + std::pow(v - 0.55, 2))); },
        [](double u, double v) {
            return std::min({u, v, 1.0 - u, 1.0 - v}) < 0.01;
        },
        151);
    return 250.0 + 2700.0 * rivers(x, y) + 30.0 * ridges(24.0 * x, 24.0 * y, 160, 4);
}

double longRange(double x, double y)
{
    static const Rivers rivers([](double u, double v)
                               { return 0.08 + step(0.25, 0.6, v + 0.15 * hills(3.0 * u, 3.0 * v, 174)); },
                               [](double, double v) { return v < 0.01; }, 171);
    return 150.0 + 5600.0 * rivers(x, y) + 160.0 * ridges(60.0 * x, 60.0 * y, 181, 6);
}

/// A planet's continents in a sea at 0, as DEMs of the whole Earth have them; none where Oahu is.
double earth(double x, double y)
{
    const double longitude = 2.0 * M_PI * (x - 0.5), latitude = M_PI * (y - 0.5);
    const double p[] = {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                        std::sin(latitude)};
    // Of three planes, so that no place on the sphere is a seam.
    const auto around = [&](double scale, unsigned int seed, int octaves)
    {
        return hills(scale * p[0] + 3.1, scale * p[1] + 7.7, seed, octaves) +
               hills(scale * p[1] + 1.9, scale * p[2] + 4.3, seed + 20, octaves) +
               hills(scale * p[2] + 8.5, scale * p[0] + 2.2, seed + 40, octaves);
    };
    const double oahu[] = {std::cos(0.375) * std::cos(-2.757), std::cos(0.375) * std::sin(-2.757),
                           std::sin(0.375)};
    const double near = p[0] * oahu[0] + p[1] * oahu[1] + p[2] * oahu[2];
    const double land = around(1.7, 201, 9) - 0.06 - step(0.85, 0.97, near);
    if (land <= 0.0) return 0.0;
    const double chain = 1.0 - std::abs(around(2.6, 301, 8));
    return 5.0 + 700.0 * land + 5200.0 * step(0.03, 0.5, land) * std::pow(std::max(chain, 0.0), 4.0);
}

const std::map<std::string, Terrain>& terrains()
{
    static const std::map<std::string, Terrain> all = [&]
    {
        std::map<std::string, Terrain> made;
        made["alps"] = {alps, 32632, 400000.0, 5160000.0, 36000.0};
        made["islands"] = {islands, 4326, 15.0, 44.2, 0.6};
        made["canyon"] = {canyon, 4326, -112.6, 36.5, 0.5};
        made["volcano"] = {volcano, 4326, 173.8, -39.0, 0.6};
        made["hills"] = {rolling, 32630, 500000.0, 5650000.0, 30000.0};
        made["atoll"] = {atoll, 4326, -145.8, -16.3, 0.5};
        made["glacier"] = {glacier, 32633, 480000.0, 7790000.0, 60000.0};
        made["feet"] = {range, 2285, 1500000.0, 300000.0, 160000.0, 0.0, 1200.0 / 3937.0};
        made["rotated"] = {massif, 32719, 300000.0, 6400000.0, 40000.0, 27.0};
        made["huge"] = {longRange, 4326, 78.0, 31.0, 3.0, 0.0, 1.0, 30000};
        made["earth"] = {earth, 4326, -180.0, 90.0, 360.0, 0.0, 1.0, 5400, 0.5};
        made["flat"] = {[](double, double) { return 12.0; }, 4326, 5.0, 52.5, 0.5};
        made["cliff"] = {[](double x, double) { return x < 0.5 ? 20.0 : 320.0; }, 4326, -9.5, 53.0, 0.2};
        made["sea"] = {[](double, double) { return -30.0; }, 4326, -30.0, 40.0, 0.5};
        made["tiny"] = {alps, 4326, 8.0, 46.5, 0.1, 0.0, 1.0, 10};
        made["nowhere"] = {alps, 0, 0.0, 0.0, 1.0};
        return made;
    }();
    return all;
}

const Terrain& terrainOf(const std::string& name)
{
    const auto found = terrains().find(name);
    if (found == terrains().end()) throw std::runtime_error("There is no invented terrain \"" + name + "\".");
    return found->second;
}

struct Closer
{
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};

} // namespace

std::vector<std::string> inventedTerrains()
{
    std::vector<std::string> names;
    for (const auto& [name, terrain] : terrains())
        names.push_back(name);
    return names;
}

double inventedHeight(const std::string& name, double x, double y)
{
    return terrainOf(name).heights(x, y);
}

void inventTerrain(const std::string& name, const std::string& file, int samples)
{
    const Terrain& terrain = terrainOf(name);
    const int side = samples > 0 ? samples : terrain.samples;
    GDALAllRegister();
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    char** options = CSLSetNameValue(nullptr, "TILED", "YES");
    options = CSLSetNameValue(options, "COMPRESS", "DEFLATE");
    options = CSLSetNameValue(options, "NUM_THREADS", "ALL_CPUS");
    options = CSLSetNameValue(options, "BIGTIFF", "IF_SAFER");
    const std::unique_ptr<GDALDataset, Closer> dataset(
        driver->Create(file.c_str(), side, side, 1, side > 10000 ? GDT_Int16 : GDT_Float32, options));
    CSLDestroy(options);
    if (!dataset) throw std::runtime_error(file + ": cannot be written.");
    if (terrain.epsg != 0)
    {
        OGRSpatialReference srs;
        srs.importFromEPSG(terrain.epsg);
        dataset->SetSpatialRef(&srs);
        const double pixel = terrain.size / side, angle = terrain.turned * M_PI / 180.0;
        const double tall = terrain.share * pixel;
        std::array<double, 6> transform = {terrain.west,  pixel * std::cos(angle), tall * std::sin(angle),
                                           terrain.north, pixel * std::sin(angle), -tall * std::cos(angle)};
        dataset->SetGeoTransform(transform.data());
    }
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    if (terrain.unit != 1.0) band.SetUnitType("ft");
    // A huge one has its formula on every eighth sample; between them a surface of the second order is enough.
    const int every = side > 10000 ? 8 : 1;
    std::vector<float> row(static_cast<std::size_t>(side));
    std::vector<double> below, above;
    const auto line = [&](int at)
    {
        std::vector<double> values;
        for (int column = 0; column <= side + every; column += every)
            values.push_back(terrain.heights((column + 0.5) / side, 1.0 - (at + 0.5) / side) / terrain.unit);
        return values;
    };
    int known = -1;
    for (int y = 0; y < side; ++y)
    {
        const int first = y / every;
        if (first != known)
        {
            above = known == first - 1 && !below.empty() ? below : line(first * every);
            below = line((first + 1) * every);
            known = first;
        }
        const double t = static_cast<double>(y % every) / every;
        for (int x = 0; x < side; ++x)
        {
            const auto left = static_cast<std::size_t>(x / every);
            const double s = static_cast<double>(x % every) / every;
            row[static_cast<std::size_t>(x)] = static_cast<float>(
                mixed(mixed(above[left], above[left + 1], s), mixed(below[left], below[left + 1], s), t));
        }
        if (band.RasterIO(GF_Write, 0, y, side, 1, row.data(), side, 1, GDT_Float32, 0, 0) != CE_None)
            throw std::runtime_error(file + ": cannot be written.");
    }
}

} // namespace geofx::test
