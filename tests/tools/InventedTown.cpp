// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/InventedTown.h>

#include <tools/OahuRaster.h>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <osg/Math>
#include <osg/Vec2d>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace geofx::test
{

namespace
{

/// Metres about the middle of Honolulu: x east, y north.
constexpr double LONGITUDE = -157.86, LATITUDE = 21.30, METRES_X = 103715.0, METRES_Y = 110730.0;

osg::Vec2d place(double longitude, double latitude)
{
    return {(longitude - LONGITUDE) * METRES_X, (latitude - LATITUDE) * METRES_Y};
}

// Values of data/oahu/landcover.csv.
enum Cover
{
    MARSH = 5,
    TOWN = 15,
    URBAN = 16,
    INDUSTRIAL = 17,
    PAVED = 18,
    ROAD = 19,
    SUBURB = 25 ///< of ground.csv: houses with gardens
};

/// From a street's middle to the houses, and the shortest street, metres.
constexpr double STREET_ROOM = 6.0, LEAST_STREET = 45.0;

/// Numbers that look random, the same for the same seed on any machine.
class Dice
{
public:
    Dice(std::uint64_t a, std::uint64_t b, std::uint64_t c)
        : _state(a * 0x9e3779b97f4a7c15u ^ b * 0xbf58476d1ce4e5b9u ^ c)
    {
        next();
        next();
    }
    std::uint64_t next()
    {
        std::uint64_t z = (_state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform(double low, double high)
    {
        return low + (high - low) * static_cast<double>(next() >> 11) * 0x1.0p-53;
    }
    bool chance(double share) { return uniform(0.0, 1.0) < share; }

private:
    std::uint64_t _state;
};

/// The value of a raster at a place.
template<typename T>
T valueAt(const OahuRaster<T>& raster, const osg::Vec2d& place)
{
    return raster.at(LONGITUDE + place.x() / METRES_X, LATITUDE + place.y() / METRES_Y);
}

struct House
{
    std::vector<osg::Vec2d> outline, courtyard;
    double height = 0.0;
    const char *roof = "flat", *use = "house";
    double rank = 0.0;
    std::size_t block = 0;
};

/// Houses between four streets.
struct Block
{
    std::size_t district = 0;
    int row = 0, column = 0;
    osg::Vec2d middle, along, across;
    char kind = 't'; ///< of its lots
};

// Of a block with its streets, metres.
constexpr double BLOCK_LENGTH = 118.0, BLOCK_WIDTH = 76.0;

/// Where streets have one direction.
struct District
{
    osg::Vec2d middle;
    double turn = 0.0; ///< of the streets from the east, counter-clockwise, radians
};

/// Where high-rises stand.
struct Center
{
    osg::Vec2d middle;
    double width, share, tallest;
};

double awayFrom(const osg::Vec2d& place, const osg::Vec2d& from, const osg::Vec2d& to)
{
    const osg::Vec2d side = to - from;
    const double share =
        side.length2() > 0.0 ? std::clamp(((place - from) * side) / side.length2(), 0.0, 1.0) : 0.0;
    return (place - from - side * share).length();
}

/// Things by the cells of a grid.
template<typename T>
class Grid
{
public:
    void add(const osg::Vec2d& low, const osg::Vec2d& high, const T& thing)
    {
        for (int y = cell(low.y()); y <= cell(high.y()); ++y)
            for (int x = cell(low.x()); x <= cell(high.x()); ++x)
                _cells[{y, x}].push_back(thing);
    }
    const std::vector<T>& at(const osg::Vec2d& place) const
    {
        static const std::vector<T> none;
        const auto found = _cells.find({cell(place.y()), cell(place.x())});
        return found == _cells.end() ? none : found->second;
    }

private:
    static int cell(double value) { return static_cast<int>(std::floor(value / 64.0)); }
    std::map<std::pair<int, int>, std::vector<T>> _cells;
};

/// The lines of data/oahu/streets.geojson: freeways, roads, railroads, streams and canals, as wide as they are.
class OahuLines
{
public:
    OahuLines()
    {
        GDALAllRegister();
        const std::string file = std::string(GEOFX_SOURCE_DIR) + "/data/oahu/streets.geojson";
        const std::unique_ptr<GDALDataset> data(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
        if (!data || data->GetLayerCount() == 0) throw std::runtime_error(file + " cannot be read.");
        for (const auto& feature : data->GetLayer(0))
        {
            const std::string style = feature->GetFieldAsString("style");
            const double half = style == "motorway"    ? 15.0
                                : style == "canal"     ? 18.0
                                : style == "secondary" ? 6.5
                                                       : 4.5;
            for (const OGRLineString* line : *feature->GetGeometryRef()->toMultiLineString())
                for (int i = 0; i + 1 < line->getNumPoints(); ++i)
                    add(place(line->getX(i), line->getY(i)), place(line->getX(i + 1), line->getY(i + 1)),
                        half, style == "secondary");
        }
    }
    /// Whether one of them is nearer than this to a place, but for those that streets meet if these are not `all`.
    bool isNear(const osg::Vec2d& at, double metres, bool all) const
    {
        for (const Line& line : _lines.at(at))
            if ((all || !line.street) && awayFrom(at, line.from, line.to) < line.half + metres) return true;
        return false;
    }
    /// Whether a house would stand on one of them.
    bool reaches(const std::vector<osg::Vec2d>& outline) const
    {
        for (std::size_t i = 0; i < outline.size(); ++i)
        {
            const osg::Vec2d side = outline[(i + 1) % outline.size()] - outline[i];
            for (int part = 0; part < 4; ++part)
                if (isNear(outline[i] + side * (0.25 * part), 3.0, true)) return true;
        }
        return false;
    }

private:
    struct Line
    {
        osg::Vec2d from, to;
        double half; ///< metres
        bool street;
    };
    void add(const osg::Vec2d& from, const osg::Vec2d& to, double half, bool street)
    {
        const osg::Vec2d room(half + 20.0, half + 20.0);
        const osg::Vec2d low(std::min(from.x(), to.x()), std::min(from.y(), to.y())),
            high(std::max(from.x(), to.x()), std::max(from.y(), to.y()));
        _lines.add(low - room, high + room, {from, to, half, street});
    }
    Grid<Line> _lines;
};

/// The most from a district's middle to one of its blocks, metres.
constexpr double REACH = 1700.0;

class Inventor
{
public:
    Inventor() : _cover("landcover.tif", GDT_Byte), _ground("elevation.tif", GDT_Float32)
    {
        // Those whose streets everyone knows.
        const std::pair<osg::Vec2d, double> known[] = {
            {place(-157.826, 21.280), -38.0}, {place(-157.835, 21.289), -40.0},
            {place(-157.848, 21.296), -40.0}, {place(-157.861, 21.309), -47.0},
            {place(-157.815, 21.283), -12.0}, {place(-157.840, 21.303), -35.0}};
        for (const auto& [middle, degrees] : known)
            _districts.push_back({middle, osg::DegreesToRadians(degrees)});
        for (int row = -14; row <= 34; ++row)
            for (int column = -32; column <= 24; ++column)
            {
                Dice dice(static_cast<std::uint64_t>(row + 100), static_cast<std::uint64_t>(column + 100), 1);
                const osg::Vec2d middle((column + dice.uniform(-0.35, 0.35)) * 1700.0,
                                        (row + dice.uniform(-0.35, 0.35)) * 1700.0);
                const double turn = osg::DegreesToRadians(dice.uniform(-45.0, 45.0));
                const bool near = std::any_of(_districts.begin(), _districts.begin() + std::size(known),
                                              [&](const District& each)
                                              { return (each.middle - middle).length() < 1100.0; });
                if (!near) _districts.push_back({middle, turn});
            }
        _centers = {{place(-157.8265, 21.2795), 900.0, 0.62, 118.0},
                    {place(-157.8605, 21.3085), 750.0, 0.60, 130.0},
                    {place(-157.8470, 21.2945), 900.0, 0.45, 125.0},
                    {place(-157.8370, 21.2900), 700.0, 0.30, 100.0}};
    }

    /// At most so many; 0: all.
    std::vector<House> houses(int count)
    {
        for (std::size_t i = 0; i < _districts.size(); ++i)
            addDistrict(i);
        std::stable_sort(_houses.begin(), _houses.end(),
                         [](const House& a, const House& b) { return a.rank < b.rank; });
        if (count > 0 && static_cast<std::size_t>(count) < _houses.size())
            _houses.resize(static_cast<std::size_t>(count));
        return std::move(_houses);
    }
    const std::vector<Block>& blocks() const { return _blocks; }
    const OahuRaster<unsigned char>& cover() const { return _cover; }
    const OahuLines& lines() const { return _lines; }

private:
    /// Those that may be nearer to a block of a district than its own middle.
    std::vector<osg::Vec2d> beside(std::size_t index) const
    {
        std::vector<osg::Vec2d> result;
        for (std::size_t i = 0; i < _districts.size(); ++i)
            if (i != index && (_districts[i].middle - _districts[index].middle).length() < 2.0 * REACH)
                result.push_back(_districts[i].middle);
        return result;
    }

    void addDistrict(std::size_t index)
    {
        const District& district = _districts[index];
        const osg::Vec2d along(std::cos(district.turn), std::sin(district.turn)),
            across(-along.y(), along.x());
        constexpr int reach = 24;
        const std::vector<osg::Vec2d> others = beside(index);
        for (int row = -reach; row <= reach; ++row)
            for (int column = -reach; column <= reach; ++column)
            {
                const osg::Vec2d middle =
                    district.middle + along * (column * BLOCK_LENGTH) + across * (row * BLOCK_WIDTH);
                const double own = (middle - district.middle).length();
                if (own > REACH ||
                    std::any_of(others.begin(), others.end(),
                                [&](const osg::Vec2d& other) { return (middle - other).length() < own; }))
                    continue;
                Dice dice(index, static_cast<std::uint64_t>(row + 1000),
                          static_cast<std::uint64_t>(column + 1000));
                _blocks.push_back({index, row, column, middle, along, across});
                addBlock(middle, along, across, BLOCK_LENGTH, BLOCK_WIDTH, dice);
            }
    }

    void addBlock(const osg::Vec2d& middle, const osg::Vec2d& along, const osg::Vec2d& across, double length,
                  double width, Dice& dice)
    {
        const int kind = valueAt(_cover, middle);
        const double dense = density(middle);
        if (kind == INDUSTRIAL) addRows(middle, along, across, {length, width, 18.0, 34.0, 1, 'h'}, dice);
        // The land cover takes most of Honolulu for a city; its houses begin where high-rises end.
        else if (dense > 0.1 || (kind == URBAN && dice.chance(0.3)))
            addRows(middle, along, across, {length, width, 15.0, 33.0, 2, 'u'}, dice);
        else
            addRows(middle, along, across, {length, width, 11.0, 16.5, 2, 't'}, dice);
    }

    struct Lots
    {
        double length, width, street, lot;
        int rows;
        char kind;
    };

    void addRows(const osg::Vec2d& middle, const osg::Vec2d& along, const osg::Vec2d& across,
                 const Lots& lots, Dice& dice)
    {
        _blocks.back().kind = lots.kind;
        const double inner = lots.length - lots.street, deep = (lots.width - lots.street) / lots.rows;
        const int count = std::max(1, static_cast<int>(inner / lots.lot));
        const double wide = inner / count;
        for (int row = 0; row < lots.rows; ++row)
            for (int lot = 0; lot < count; ++lot)
            {
                Dice own(dice.next(), 2, 3);
                const osg::Vec2d at = middle + along * (-0.5 * inner + (lot + 0.5) * wide) +
                                      across * (-0.5 * (lots.width - lots.street) + (row + 0.5) * deep);
                if (own.chance(0.06)) continue; // a garden, a parking place
                House house;
                if (lots.kind == 'h')
                    hall(house, at, along, across, wide, deep, own);
                else if (lots.kind == 'u')
                    flats(house, at, along, across, wide, deep, own);
                else
                    home(house, at, along, across, wide, deep, row == 0 ? -1.0 : 1.0, own);
                keep(house, at);
            }
    }

    /// The share of lots with a high-rise.
    double density(const osg::Vec2d& at) const
    {
        double share = 0.0;
        for (const Center& center : _centers)
        {
            const double d = (at - center.middle).length() / center.width;
            share = std::max(share, center.share * std::exp(-d * d));
        }
        return share;
    }

    double tallest(const osg::Vec2d& at) const
    {
        double best = 60.0, nearest = 1e300;
        for (const Center& center : _centers)
            if (const double d = (at - center.middle).length() / center.width; d < nearest)
            {
                nearest = d;
                best = std::max(45.0, center.tallest * std::exp(-0.25 * d * d));
            }
        return best;
    }

    static std::vector<osg::Vec2d> box(const osg::Vec2d& middle, const osg::Vec2d& along,
                                       const osg::Vec2d& across, double length, double width)
    {
        const osg::Vec2d a = along * (0.5 * length), b = across * (0.5 * width);
        return {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
    }

    static void home(House& house, const osg::Vec2d& at, const osg::Vec2d& along, const osg::Vec2d& across,
                     double wide, double deep, double front, Dice& dice)
    {
        const double length = dice.uniform(0.58, 0.80) * wide, width = dice.uniform(8.0, 12.5);
        const osg::Vec2d middle = at +
                                  across * (front * (0.5 * deep - 0.5 * width - dice.uniform(3.0, 6.5))) +
                                  along * dice.uniform(-0.8, 0.8);
        house.outline = box(middle, along, across, std::max(length, 7.0), width);
        house.height = dice.chance(0.35) ? dice.uniform(6.4, 8.2) : dice.uniform(4.2, 5.6);
        house.roof = dice.chance(0.85) ? "gabled" : "flat";
    }

    void flats(House& house, const osg::Vec2d& at, const osg::Vec2d& along, const osg::Vec2d& across,
               double wide, double deep, Dice& dice) const
    {
        const double share = density(at);
        const osg::Vec2d middle = at + along * dice.uniform(-1.5, 1.5) + across * dice.uniform(-1.0, 1.0);
        house.use = "flats";
        if (dice.chance(share))
        {
            const bool slab = dice.chance(0.5);
            house.outline =
                box(middle, along, across, slab ? dice.uniform(0.75, 0.92) * wide : dice.uniform(18.0, 24.0),
                    slab ? dice.uniform(14.0, 18.0) : dice.uniform(18.0, std::min(24.0, 0.9 * deep)));
            house.height = dice.uniform(0.38, 1.0) * tallest(at);
            house.use = dice.chance(0.35) ? "office" : "flats";
            return;
        }
        const double length = dice.uniform(0.62, 0.9) * wide, width = dice.uniform(0.55, 0.85) * deep;
        house.outline = box(middle, along, across, length, width);
        house.height = dice.chance(0.3 + share) ? dice.uniform(14.0, 34.0) : dice.uniform(6.5, 13.0);
        if (dice.chance(0.3)) house.use = "office";
        const osg::Vec2d a = along * (0.5 * length), b = across * (0.5 * width);
        if (length > 24.0 && width > 22.0 && dice.chance(0.25))
            house.courtyard = box(middle, along, across, length - 18.0, width - 18.0);
        else if (dice.chance(0.25))
            // An L.
            house.outline = {middle - a - b,   middle + a - b,       middle + a,
                             middle + a * 0.1, middle + a * 0.1 + b, middle - a + b};
        else if (house.height < 9.0 && dice.chance(0.4))
            house.roof = "gabled";
    }

    static void hall(House& house, const osg::Vec2d& at, const osg::Vec2d& along, const osg::Vec2d& across,
                     double wide, double deep, Dice& dice)
    {
        house.outline = box(at + across * dice.uniform(-4.0, 4.0), along, across,
                            dice.uniform(0.7, 0.92) * wide, dice.uniform(0.45, 0.85) * deep);
        house.height = dice.uniform(5.5, 11.0);
        house.use = "hall";
        if (dice.chance(0.25)) house.roof = "gabled";
    }

    /// Keeps a house that stands on built land, on no road and in no water, and not on a cliff.
    void keep(House& house, const osg::Vec2d& at)
    {
        const auto built = [&](const osg::Vec2d& corner)
        {
            const int kind = valueAt(_cover, corner);
            return kind == TOWN || kind == URBAN || kind == INDUSTRIAL;
        };
        double low = 1e300, high = -1e300;
        if (!built(at) || _lines.reaches(house.outline)) return;
        for (const osg::Vec2d& corner : house.outline)
        {
            if (!built(corner)) return;
            low = std::min(low, static_cast<double>(valueAt(_ground, corner + (corner - at))));
            high = std::max(high, static_cast<double>(valueAt(_ground, corner + (corner - at))));
        }
        if (high - low > 14.0) return;
        const osg::Vec2d line[] = {place(-157.8720, 21.3150), place(-157.8605, 21.3085),
                                   place(-157.8470, 21.2945), place(-157.8265, 21.2795),
                                   place(-157.8140, 21.2740)};
        double nearest = 1e300;
        for (std::size_t i = 0; i + 1 < std::size(line); ++i)
        {
            const osg::Vec2d side = line[i + 1] - line[i];
            const double share = std::clamp(((at - line[i]) * side) / side.length2(), 0.0, 1.0);
            nearest = std::min(nearest, (at - line[i] - side * share).length());
        }
        house.rank = nearest;
        house.block = _blocks.size() - 1;
        _houses.push_back(std::move(house));
    }

    const OahuRaster<unsigned char> _cover;
    const OahuRaster<float> _ground;
    const OahuLines _lines;
    std::vector<District> _districts;
    std::vector<Center> _centers;
    std::vector<Block> _blocks;
    std::vector<House> _houses;
};

void addRing(OGRPolygon& polygon, const std::vector<osg::Vec2d>& places)
{
    auto* ring = new OGRLinearRing;
    // Whole ten-millionths of a degree, a centimetre.
    const auto rounded = [](double degrees)
    {
        return std::round(degrees * 1e7) * 1e-7;
    };
    for (const osg::Vec2d& each : places)
        ring->addPoint(rounded(LONGITUDE + each.x() / METRES_X), rounded(LATITUDE + each.y() / METRES_Y));
    ring->closeRings();
    polygon.addRingDirectly(ring);
}

/// Writes buildings, one after the other, as a GeoPackage's layer "buildings".
class TownFile
{
public:
    explicit TownFile(std::string file) : _file(std::move(file))
    {
        GDALAllRegister();
        GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
        if (!driver) throw std::runtime_error("GDAL has no driver for GeoPackages.");
        std::filesystem::remove(_file);
        CPLSetConfigOption("OGR_CURRENT_DATE", "2026-01-01T00:00:00.000Z"); // else the file has the day's
        _data.reset(driver->Create(_file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
        OGRSpatialReference srs;
        srs.importFromEPSG(4326);
        srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        _layer = _data ? _data->CreateLayer("buildings", &srs, wkbPolygon, nullptr) : nullptr;
        if (!_layer) throw std::runtime_error(_file + " cannot be made.");
        OGRFieldDefn height("height", OFTReal), storeys("storeys", OFTInteger), roof("roof", OFTString),
            use("use", OFTString);
        for (OGRFieldDefn* field : {&height, &storeys, &roof, &use})
            _layer->CreateField(field);
        _data->StartTransaction();
    }

    void add(const House& house)
    {
        OGRPolygon polygon;
        addRing(polygon, house.outline);
        if (!house.courtyard.empty()) addRing(polygon, house.courtyard);
        const std::unique_ptr<OGRFeature> feature(OGRFeature::CreateFeature(_layer->GetLayerDefn()));
        feature->SetGeometry(&polygon);
        feature->SetField("height", std::round(house.height * 10.0) / 10.0);
        feature->SetField("storeys", std::max(1, static_cast<int>(house.height / 3.1)));
        feature->SetField("roof", house.roof);
        feature->SetField("use", house.use);
        if (_layer->CreateFeature(feature.get()) != OGRERR_NONE)
            throw std::runtime_error(_file + " cannot be written.");
    }

    void finish()
    {
        _data->CommitTransaction();
        _data.reset(); // which writes the date
        CPLSetConfigOption("OGR_CURRENT_DATE", nullptr);
    }

private:
    const std::string _file;
    std::unique_ptr<GDALDataset> _data;
    OGRLayer* _layer = nullptr;
};

} // namespace

int inventTown(const std::string& file, int count)
{
    const std::vector<House> houses = Inventor().houses(count);
    TownFile town(file);
    for (const House& house : houses)
        town.add(house);
    town.finish();
    return static_cast<int>(houses.size());
}

int inventStreets(const std::string& file, int count)
{
    Inventor inventor;
    const std::vector<House> houses = inventor.houses(count);
    Grid<const House*> near;
    std::vector<char> lived(inventor.blocks().size(), 0);
    for (const House& house : houses)
    {
        lived[house.block] = 1;
        osg::Vec2d low(1e300, 1e300), high(-1e300, -1e300);
        for (const osg::Vec2d& corner : house.outline)
        {
            low.set(std::min(low.x(), corner.x()), std::min(low.y(), corner.y()));
            high.set(std::max(high.x(), corner.x()), std::max(high.y(), corner.y()));
        }
        const osg::Vec2d room(STREET_ROOM, STREET_ROOM);
        near.add(low - room, high + room, &house);
    }
    const auto isFree = [&](const osg::Vec2d& at)
    {
        const int kind = valueAt(inventor.cover(), at);
        if (kind != TOWN && kind != URBAN && kind != INDUSTRIAL && kind != PAVED && kind != ROAD)
            return false;
        if (inventor.lines().isNear(at, 4.0, false)) return false;
        for (const House* house : near.at(at))
            for (std::size_t i = 0; i < house->outline.size(); ++i)
                if (awayFrom(at, house->outline[i], house->outline[(i + 1) % house->outline.size()]) <
                    STREET_ROOM)
                    return false;
        return true;
    };
    // Sides of blocks, by their line: the district, whether it runs across, and its number; and by their place on it.
    struct Side
    {
        osg::Vec2d from, to;
    };
    std::map<std::tuple<std::size_t, bool, int>, std::map<int, Side>> lines;
    for (std::size_t i = 0; i < lived.size(); ++i)
    {
        if (!lived[i]) continue;
        const Block& block = inventor.blocks()[i];
        const osg::Vec2d a = block.along * (0.5 * BLOCK_LENGTH), b = block.across * (0.5 * BLOCK_WIDTH);
        for (const int end : {0, 1})
        {
            const double sign = end == 0 ? -1.0 : 1.0;
            lines[{block.district, false, block.row + end}][block.column] = {block.middle - a + b * sign,
                                                                             block.middle + a + b * sign};
            lines[{block.district, true, block.column + end}][block.row] = {block.middle - b + a * sign,
                                                                            block.middle + b + a * sign};
        }
    }
    std::ofstream out(file);
    out << "{\"type\": \"FeatureCollection\", \"features\": "
           "[\n{\"type\":\"Feature\",\"properties\":{\"style\":"
           "\"residential\"},\"geometry\":{\"type\":\"MultiLineString\",\"coordinates\":[";
    int made = 0;
    const auto write = [&](const osg::Vec2d& from, const osg::Vec2d& to)
    {
        if ((to - from).length() < LEAST_STREET) return;
        char text[128];
        std::snprintf(text, sizeof text, "%s[[%.5f,%.5f],[%.5f,%.5f]]", made > 0 ? ",\n" : "\n",
                      LONGITUDE + from.x() / METRES_X, LATITUDE + from.y() / METRES_Y,
                      LONGITUDE + to.x() / METRES_X, LATITUDE + to.y() / METRES_Y);
        out << text;
        ++made;
    };
    for (const auto& [key, sides] : lines)
    {
        // As long as they are free, and one side follows the other.
        osg::Vec2d start, last;
        bool open = false;
        int former = 0;
        for (const auto& [number, side] : sides)
        {
            if (open && number != former + 1)
            {
                write(start, last);
                open = false;
            }
            former = number;
            const int steps = static_cast<int>((side.to - side.from).length() / 4.0);
            for (int step = 0; step <= steps; ++step)
            {
                const osg::Vec2d at = side.from + (side.to - side.from) * (double(step) / steps);
                const bool free = isFree(at);
                if (free && !open) start = at;
                if (!free && open) write(start, last);
                open = free;
                last = at;
            }
        }
        if (open) write(start, last);
    }
    out << "\n]}}\n]}\n";
    if (!out) throw std::runtime_error(file + " cannot be written.");
    return made;
}

int inventGardens(const std::string& source, const std::string& file)
{
    Inventor inventor;
    const std::vector<House> houses = inventor.houses(0);
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> data(GDALDataset::Open(source.c_str()));
    double transform[6];
    if (!data || data->GetGeoTransform(transform) != CE_None)
        throw std::runtime_error(source + " cannot be read.");
    const int columns = data->GetRasterXSize(), rows = data->GetRasterYSize();
    std::vector<unsigned char> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    if (data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, cells.data(), columns, rows, GDT_Byte,
                                         0, 0) != CE_None)
        throw std::runtime_error(source + " cannot be read.");
    const auto at = [&](int column, int row) -> unsigned char&
    {
        return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
    };
    std::vector<char> lived(inventor.blocks().size(), 0);
    for (const House& house : houses)
        lived[house.block] = 1;
    for (std::size_t i = 0; i < lived.size(); ++i)
    {
        const Block& block = inventor.blocks()[i];
        if (!lived[i] || block.kind != 't') continue;
        const osg::Vec2d degrees(LONGITUDE + block.middle.x() / METRES_X,
                                 LATITUDE + block.middle.y() / METRES_Y);
        const int column = static_cast<int>((degrees.x() - transform[0]) / transform[1]),
                  row = static_cast<int>((degrees.y() - transform[3]) / transform[5]);
        for (int r = std::max(row - 3, 0); r <= std::min(row + 3, rows - 1); ++r)
            for (int c = std::max(column - 3, 0); c <= std::min(column + 3, columns - 1); ++c)
            {
                const osg::Vec2d way =
                    place(transform[0] + (c + 0.5) * transform[1], transform[3] + (r + 0.5) * transform[5]) -
                    block.middle;
                unsigned char& cell = at(c, r);
                if (std::abs(way * block.along) <= 0.5 * BLOCK_LENGTH &&
                    std::abs(way * block.across) <= 0.5 * BLOCK_WIDTH && (cell == TOWN || cell == URBAN))
                    cell = SUBURB;
            }
    }
    // What lies between two of them belongs to them.
    for (int pass = 0; pass < 2; ++pass)
    {
        const std::vector<unsigned char> former = cells;
        for (int r = 1; r + 1 < rows; ++r)
            for (int c = 1; c + 1 < columns; ++c)
            {
                if (at(c, r) != TOWN && at(c, r) != URBAN) continue;
                int around = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx)
                        around +=
                            former[static_cast<std::size_t>(r + dy) * static_cast<std::size_t>(columns) +
                                   static_cast<std::size_t>(c + dx)] == SUBURB;
                if (around >= 5) at(c, r) = SUBURB;
            }
    }
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const char* options[] = {"COMPRESS=DEFLATE", "TILED=YES", nullptr};
    const std::unique_ptr<GDALDataset> copy(
        driver->CreateCopy(file.c_str(), data.get(), FALSE, const_cast<char**>(options), nullptr, nullptr));
    if (!copy || copy->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, cells.data(), columns, rows,
                                                  GDT_Byte, 0, 0) != CE_None)
        throw std::runtime_error(file + " cannot be written.");
    return static_cast<int>(std::count(cells.begin(), cells.end(), static_cast<unsigned char>(SUBURB)));
}

int inventCrowd(const std::string& file, int count)
{
    const OahuRaster<unsigned char> cover("landcover.tif", GDT_Byte);
    // All land, in rows from the north; as far apart as makes the wanted number.
    const double west = cover.transform()[0], north = cover.transform()[3], across = cover.transform()[1],
                 down = cover.transform()[5];
    const auto isLand = [](unsigned char kind)
    {
        return kind > MARSH;
    };
    double land = 0.0;
    for (int row = 0; row < cover.rows(); ++row)
        for (int column = 0; column < cover.columns(); ++column)
            land += isLand(cover.pixel(column, row)) ? 1.0 : 0.0;
    // A little closer than needed, since chance decides what is land.
    const double step = std::sqrt(land / (1.02 * std::max(count, 1)));
    TownFile town(file);
    int made = 0;
    for (double row = 0.5 * step; row < cover.rows() && made < count; row += step)
        for (double column = 0.5 * step; column < cover.columns() && made < count; column += step)
        {
            if (!isLand(cover.pixel(static_cast<int>(column), static_cast<int>(row)))) continue;
            Dice dice(static_cast<std::uint64_t>(row * 64.0), static_cast<std::uint64_t>(column * 64.0), 9);
            const osg::Vec2d middle = place(west + across * column, north + down * row);
            const double turn = dice.uniform(0.0, 1.5), room = 0.35 * step * 30.0;
            const osg::Vec2d along(std::cos(turn), std::sin(turn)), side(-along.y(), along.x());
            House house;
            const osg::Vec2d a = along * std::min(dice.uniform(0.5, 1.0) * room, 12.0),
                             b = side * std::min(dice.uniform(0.5, 1.0) * room, 8.0);
            house.outline = {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
            house.height = dice.uniform(4.0, 12.0);
            house.roof = dice.chance(0.5) ? "gabled" : "flat";
            town.add(house);
            ++made;
        }
    town.finish();
    return made;
}

} // namespace geofx::test
