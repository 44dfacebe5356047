// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Towns in databases: each building once on each level, on the ground as it is drawn, the same bytes, and what bad input becomes.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/town/TownBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/FolderContents.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <town/TownFiles.h>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

// Some 13 × 11 km of hills.
constexpr double WEST = 10.0, NORTH = 47.0, PIXEL = 0.0005;
constexpr int COLUMNS = 360, ROWS = 200;

void buildTerrain(const std::filesystem::path& folder, const std::filesystem::path& output, int epsg = 0)
{
    BuildOptions options;
    options.dems = {writeRelief(folder / "dem.tif", COLUMNS, ROWS, WEST, NORTH, PIXEL)};
    options.tileSize = 32;
    options.epsg = epsg;
    options.output = output.string();
    options.threads = 2;
    buildDatabase(options);
}

/// One terrain for all tests, to be copied.
const std::filesystem::path& terrain(bool projected = false)
{
    static const TempDir folder;
    static std::map<bool, std::filesystem::path> made;
    auto& path = made[projected];
    if (path.empty())
    {
        path = folder / (projected ? "projected" : "globe");
        buildTerrain(folder.path(), path, projected ? 32632 : 0);
    }
    return path;
}

std::string copyOfTerrain(const TempDir& folder, const std::string& name = "database", bool projected = false)
{
    std::filesystem::copy(terrain(projected), folder / name, std::filesystem::copy_options::recursive);
    return (folder / name).string();
}

/// Buildings all over the terrain, a few of them high.
std::vector<Feature> someBuildings(int count)
{
    std::vector<Feature> features;
    Random random(11);
    for (int i = 0; i < count; ++i)
    {
        const double x = random.uniform(WEST + 0.01, WEST + COLUMNS * PIXEL - 0.01),
                     y = random.uniform(NORTH - ROWS * PIXEL + 0.01, NORTH - 0.01);
        features.push_back(
            {rectangle(x, y, random.uniform(1e-4, 4e-4), random.uniform(1e-4, 3e-4)),
             {std::to_string(random.logarithmic(4.0, 90.0)), random.integer(0, 1) ? "gabled" : "flat"}});
    }
    return features;
}

std::vector<Feature> oneBuilding()
{
    Feature one = someBuildings(1).front();
    one.values.resize(1);
    return {one};
}

std::string refusalOf(const TownOptions& options)
{
    try
    {
        buildTown(options);
        return {};
    }
    catch (const BuildError& error)
    {
        return error.what();
    }
}

TownOptions optionsOf(const std::string& database, const std::string& buildings)
{
    TownOptions options;
    options.database = database;
    options.buildings = buildings;
    options.threads = 2;
    return options;
}

/// A ground triangle: places of DatabaseRoot::fromWorld.
struct Triangle
{
    std::array<osg::Vec3d, 3> corners;
    double from = 0.0; ///< metres from the eye to any of it from which on it may be drawn
    int level = 0;
    bool finest = false;

    bool heightAt(double x, double y, double& height) const
    {
        const osg::Vec3d &a = corners[0], ab = corners[1] - a, ac = corners[2] - a;
        const double twice = ab.x() * ac.y() - ab.y() * ac.x();
        if (std::abs(twice) < 1e-16) return false;
        const double u = ((x - a.x()) * ac.y() - (y - a.y()) * ac.x()) / twice;
        const double v = (ab.x() * (y - a.y()) - ab.y() * (x - a.x())) / twice;
        if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) return false;
        height = a.z() + u * ab.z() + v * ac.z();
        return true;
    }
};

/// All meshes of all tiles.
std::vector<Triangle> groundOf(const std::string& database)
{
    const DatabaseRoot root(database);
    std::vector<Triangle> triangles;
    for (const DatabaseTile& tile : readTiles(database))
        for (const DatabaseTile::Mesh& mesh : tile.meshes)
        {
            // No nearer than the mesh's range, and than the tile's own: finer tiles are drawn within it.
            const double radius = static_cast<double>(mesh.block->getBound().radius());
            double from = mesh.from - radius;
            if (tile.lod)
                from = std::max(from, static_cast<double>(tile.lod->getMaxRange(1)) -
                                          static_cast<double>(tile.lod->getBound().radius()));
            for (const DatabaseTile::Triangle& triangle : mesh.ground)
            {
                Triangle each;
                for (std::size_t i = 0; i < 3; ++i)
                    each.corners[i] = root.fromWorld(tile.world(triangle[i]));
                each.from = std::max(from, 0.0);
                each.level = tile.level;
                each.finest = tile.level == root.finestLevel() && mesh.smallest && mesh.from == 0.0;
                triangles.push_back(each);
            }
        }
    return triangles;
}

/// Triangles by cells of the terrain.
class GroundIndex
{
public:
    explicit GroundIndex(std::vector<Triangle> triangles)
        : _triangles(std::move(triangles)), _cells(SIDE * SIDE)
    {
        for (const Triangle& each : _triangles)
            for (const osg::Vec3d& corner : each.corners)
                _box.expandBy(corner);
        for (const Triangle& each : _triangles)
        {
            osg::BoundingBoxd box;
            for (const osg::Vec3d& corner : each.corners)
                box.expandBy(corner);
            for (int row = cell(box.yMin(), 1); row <= cell(box.yMax(), 1); ++row)
                for (int column = cell(box.xMin(), 0); column <= cell(box.xMax(), 0); ++column)
                    _cells[static_cast<std::size_t>(row * SIDE + column)].push_back(&each);
        }
    }
    const std::vector<const Triangle*>& at(const osg::Vec3d& place) const
    {
        return _cells[static_cast<std::size_t>(cell(place.y(), 1) * SIDE + cell(place.x(), 0))];
    }

private:
    static constexpr int SIDE = 128;
    int cell(double value, int axis) const
    {
        const double share = (value - _box._min[axis]) / (_box._max[axis] - _box._min[axis]);
        return std::clamp(static_cast<int>(share * SIDE), 0, SIDE - 1);
    }
    const std::vector<Triangle> _triangles;
    osg::BoundingBoxd _box;
    std::vector<std::vector<const Triangle*>> _cells;
};

} // namespace

TEST(TownBuilder, EachBuildingOnceOnEachLevel)
{
    const TempDir folder;
    const std::string database = copyOfTerrain(folder);
    const int count = 300;
    const std::vector<Feature> features = someBuildings(count);
    const std::string file = writeFeatures(folder / "town.gpkg", {"height:real", "roof"}, features);
    const TownSummary summary = buildTown(optionsOf(database, file));
    EXPECT_EQ(summary.buildings, static_cast<std::uint64_t>(count));
    EXPECT_GT(summary.gabled, static_cast<std::uint64_t>(count / 4));
    EXPECT_EQ(summary.byArea + summary.byStoreys + summary.badHeights + summary.leftOut + summary.outside,
              0u);
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(database + "/terrain.osgb");
    ASSERT_TRUE(node);
    const osg::Group& children = *node->asGroup();
    const osg::Node& town = *children.getChild(children.getNumChildren() - 1);
    EXPECT_EQ(town.getName(), "buildings");
    EXPECT_EQ(town.getStateSet()->getMode(GL_CULL_FACE), osg::StateAttribute::ON);
    const DatabaseRoot root(database);
    // The middles of the source, and heights.
    std::map<std::pair<long, long>, double> wanted;
    for (const Feature& feature : features)
    {
        OGRGeometry* geometry = nullptr;
        OGRGeometryFactory::createFromWkt(feature.wkt.c_str(), nullptr, &geometry);
        const std::unique_ptr<OGRGeometry> owner(geometry);
        OGRPoint middle;
        geometry->Centroid(&middle);
        wanted[{std::lround(middle.getX() * 1e6), std::lround(middle.getY() * 1e6)}] =
            std::stod(feature.values[0]);
    }
    ASSERT_EQ(wanted.size(), static_cast<std::size_t>(count));
    for (const std::string level : {"detail", "single"})
    {
        SCOPED_TRACE(level);
        const std::vector<TownBuilding> found = buildingsOf(database, level);
        EXPECT_EQ(found.size(), static_cast<std::size_t>(count));
        std::set<std::pair<long, long>> seen;
        int high = 0;
        for (const TownBuilding& each : found)
        {
            const osg::Vec3d place = root.fromWorld(each.reference);
            const std::pair<long, long> key(std::lround(place.x() * 1e6), std::lround(place.y() * 1e6));
            const auto entry = wanted.find(key);
            ASSERT_NE(entry, wanted.end()) << place.x() << " " << place.y();
            EXPECT_TRUE(seen.insert(key).second);
            if (level != "detail") continue;
            // On steep ground low roofs are raised.
            EXPECT_GT(each.highest, entry->second - 0.01);
            high += each.highest < entry->second + 0.01 ? 1 : 0;
        }
        if (level == "detail")
        {
            EXPECT_GT(high, count / 2);
        }
    }
    // From afar there are fewer, but no cell is empty.
    const std::size_t blocks = buildingsOf(database, "blocks").size();
    EXPECT_GT(blocks, 50u);
    EXPECT_LE(blocks, static_cast<std::size_t>(count));
}

TEST(TownBuilder, StandsOnTheDrawnGround)
{
    const TempDir folder;
    for (const bool projected : {false, true})
    {
        SCOPED_TRACE(projected ? "projected" : "globe");
        const std::string name = projected ? "flat" : "round";
        const std::string database = copyOfTerrain(folder, name, projected);
        const std::string file = writeFeatures(folder / (name + ".gpkg"), {"height:real", "roof"},
                                               someBuildings(fullTest() ? 400 : 60));
        buildTown(optionsOf(database, file));
        const DatabaseRoot root(database);
        const GroundIndex ground(groundOf(database));
        const double pixel = 1.0 / root.value<double>("geofx.pixelsPerRadian");
        struct LevelCheck
        {
            const char* name;
            double range;
        };
        // What each level is drawn within, by the ranges in its files; the far side of a cell is a little farther.
        for (const LevelCheck level : {LevelCheck{"detail", 0.75 / pixel}, LevelCheck{"single", 2.5 / pixel},
                                       LevelCheck{"blocks", 15.0 / pixel}})
        {
            SCOPED_TRACE(level.name);
            int checked = 0, coarse = 0;
            double off = 0.0;
            for (const TownBuilding& each : buildingsOf(database, level.name))
            {
                const osg::Vec3d middle = root.fromWorld(each.reference);
                double height = 0.0;
                for (const Triangle* triangle : ground.at(middle))
                    if (std::string(level.name) == "detail" && triangle->finest &&
                        triangle->heightAt(middle.x(), middle.y(), height))
                    {
                        off = std::max(off, std::abs(height - middle.z()));
                        ++checked;
                    }
                // All walls reach into the ground, as coarse as it may be drawn beside them.
                for (std::size_t i = 0; i < each.vertices.size(); i += 5)
                {
                    const osg::Vec3d place = root.fromWorld(each.vertices[i]);
                    for (const Triangle* triangle : ground.at(place))
                    {
                        const bool drawn = triangle->finest || triangle->from <= level.range;
                        if (!drawn || !triangle->heightAt(place.x(), place.y(), height)) continue;
                        EXPECT_LT(middle.z() + each.lowest, height + 0.02)
                            << "ground of level " << triangle->level << " drawn from " << triangle->from
                            << " m";
                        coarse += triangle->finest ? 0 : 1;
                    }
                }
            }
            if (std::string(level.name) == "detail")
            {
                EXPECT_GT(checked, 50);
                EXPECT_LT(off, 0.3);
                EXPECT_LT(off, 0.05); // rounding, measured
            }
            // The hills are even: from nearby only the finest ground is drawn.
            if (std::string(level.name) == "blocks")
            {
                EXPECT_GT(coarse, 100);
            }
        }
    }
}

// The shade around buildings lies on the ground as it is drawn from nearby, and each level has it, but not where it is not wanted.
TEST(TownBuilder, TheShadeAroundBuildingsLiesOnTheDrawnGround)
{
    const TempDir folder;
    const std::string database = copyOfTerrain(folder);
    TownOptions options =
        optionsOf(database, writeFeatures(folder / "town.gpkg", {"height:real", "roof"}, someBuildings(60)));
    buildTown(options);
    const DatabaseRoot root(database);
    const GroundIndex ground(groundOf(database));
    const auto filesOf = [&](const std::string& level)
    {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(
                 std::filesystem::path(database) / "buildings" / level))
            if (entry.is_regular_file()) files.push_back(entry.path());
        return files;
    };
    for (const auto& [level, tolerance] :
         {std::pair<std::string, double>{"detail", 0.15}, {"single", 0.55}, {"blocks", 2.1}})
    {
        SCOPED_TRACE(level);
        int geometries = 0, shades = 0, checked = 0;
        double off = 0.0;
        for (const auto& file : filesOf(level))
        {
            forEachGeometry(file, [&](const osg::Geometry&, const osg::Matrixd&) { ++geometries; });
            forEachGeometry(
                file,
                [&](const osg::Geometry& geometry, const osg::Matrixd& toWorld)
                {
                    ++shades;
                    for (const osg::Vec3& vertex :
                         static_cast<const osg::Vec3Array&>(*geometry.getVertexArray()))
                    {
                        const osg::Vec3d place = root.fromWorld(osg::Vec3d(vertex) * toWorld);
                        double height = 0.0;
                        for (const Triangle* triangle : ground.at(place))
                            if (triangle->finest && triangle->heightAt(place.x(), place.y(), height))
                            {
                                off = std::max(off, std::abs(height - place.z()));
                                ++checked;
                                break;
                            }
                    }
                },
                true);
        }
        // One more drawable for each.
        EXPECT_GT(geometries, 5);
        EXPECT_EQ(shades, geometries);
        EXPECT_GT(checked, 300);
        EXPECT_LT(off, tolerance);
    }
    options.ambientOcclusion = false;
    buildTown(options);
    int shades = 0;
    for (const std::string level : {"detail", "single", "blocks"})
        for (const auto& file : filesOf(level))
            forEachGeometry(
                file, [&](const osg::Geometry&, const osg::Matrixd&) { ++shades; }, true);
    EXPECT_EQ(shades, 0);
}

TEST(TownBuilder, TheSameBytesAndTheTilesStay)
{
    const TempDir folder;
    const std::string file = writeFeatures(folder / "town.gpkg", {"height:real", "roof"}, someBuildings(150));
    const std::string one = copyOfTerrain(folder, "one"), two = copyOfTerrain(folder, "two");
    const auto before = contents(one);
    TownOptions options = optionsOf(one, file);
    options.threads = 1;
    buildTown(options);
    options.database = two;
    options.threads = 3;
    buildTown(options);
    const auto first = contents(one);
    EXPECT_EQ(first, contents(two));
    for (const auto& [name, bytes] : before)
    {
        if (name == "terrain.osgb") continue;
        ASSERT_EQ(first.count(name), 1u) << name;
        EXPECT_EQ(first.at(name), bytes) << name;
    }
    EXPECT_GT(first.size(), before.size() + 30);
    // Once more: the same again, and nothing of the work is left.
    buildTown(options);
    EXPECT_EQ(first, contents(two));
    // Another town in its place.
    options.buildings = writeFeatures(folder / "other.gpkg", {"height:real"}, oneBuilding());
    buildTown(options);
    EXPECT_EQ(buildingsOf(two, "detail").size(), 1u);
    const DatabaseRoot root(two);
    EXPECT_EQ(root.value<double>("geofx.buildings"), 1.0);
}

// A row of houses across all borders of cells and files, with and without towers in front of their eastern walls.
TEST(TownBuilder, NeighboursDarkenWallsAcrossAllBorders)
{
    const TempDir folder;
    const double y = NORTH - 0.04, metre = 1.0 / 76000.0; // of a longitude here
    std::vector<Feature> alone, beside;
    const int count = 60;
    for (int i = 0; i < count; ++i)
    {
        const double x = WEST + 0.02 + 80.0 * metre * i;
        alone.push_back({rectangle(x, y, 10.0 * metre, 1.5e-4), {"8"}});
        beside.push_back(alone.back());
        beside.push_back({rectangle(x + 18.0 * metre, y, 10.0 * metre, 3e-4), {"40"}});
    }
    /// The mean green of the eastern walls of houses, by their reference; those of towers are left out.
    const auto eastern = [&](const std::string& database, const std::string& level)
    {
        std::map<std::pair<long, long>, std::pair<double, int>> result;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(
                 std::filesystem::path(database) / "buildings" / level))
            if (entry.is_regular_file())
                forEachGeometry(
                    entry.path(),
                    [&](const osg::Geometry& geometry, const osg::Matrixd& toWorld)
                    {
                        const osg::Vec4Array& references = *osgGeoFX::RigidParts::of(geometry);
                        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
                        const auto& normals = static_cast<const osg::Vec3bArray&>(*geometry.getNormalArray());
                        const auto& colors = static_cast<const osg::Vec4ubArray&>(*geometry.getColorArray());
                        std::map<osg::Vec4, float> tops;
                        for (std::size_t i = 0; i < vertices.size(); ++i)
                            tops[references[i]] =
                                std::max(tops[references[i]], vertices[i].z() - references[i].z());
                        for (std::size_t i = 0; i < vertices.size(); ++i)
                        {
                            if (normals[i].x() < 120 || tops[references[i]] > 20.0f) continue;
                            const osg::Vec3d at =
                                osg::Vec3d(references[i].x(), references[i].y(), references[i].z()) * toWorld;
                            auto& [sum, many] = result[{std::lround(at.x()), std::lround(at.y())}];
                            sum += colors[i].g();
                            ++many;
                        }
                    });
        return result;
    };
    TownOptions options = optionsOf(copyOfTerrain(folder, "alone"),
                                    writeFeatures(folder / "alone.gpkg", {"height:real"}, alone));
    buildTown(options);
    TownOptions withTowers = optionsOf(copyOfTerrain(folder, "beside"),
                                       writeFeatures(folder / "beside.gpkg", {"height:real"}, beside));
    buildTown(withTowers);
    for (const std::string level : {"single", "detail"})
    {
        SCOPED_TRACE(level);
        const auto bright = eastern(options.database, level), dark = eastern(withTowers.database, level);
        ASSERT_EQ(bright.size(), static_cast<std::size_t>(count));
        ASSERT_EQ(dark.size(), bright.size());
        for (const auto& [place, found] : bright)
        {
            ASSERT_EQ(dark.count(place), 1u);
            const auto& shaded = dark.at(place);
            EXPECT_LT(shaded.first / shaded.second, 0.93 * found.first / found.second);
        }
    }
    // Without it, towers darken nothing.
    options.ambientOcclusion = withTowers.ambientOcclusion = false;
    buildTown(options);
    buildTown(withTowers);
    EXPECT_EQ(eastern(options.database, "detail"), eastern(withTowers.database, "detail"));
}

TEST(TownBuilder, BadInput)
{
    const TempDir folder;
    const std::string database = copyOfTerrain(folder);
    const double x = WEST + 0.05, y = NORTH - 0.05, a = 2e-4;
    const std::string bowTie =
        CPLSPrintf("POLYGON((%f %f,%f %f,%f %f,%f %f,%f %f))", x, y, x + a, y + a, x + a, y, x, y + a, x, y);
    const std::string line = CPLSPrintf("LINESTRING(%f %f,%f %f)", x, y, x + a, y);
    const std::string thin =
        CPLSPrintf("POLYGON((%f %f,%f %f,%f %f,%f %f))", x, y, x + a, y, x + a / 2, y, x, y);
    const std::string court = CPLSPrintf(
        "POLYGON((%.9f %.9f,%.9f %.9f,%.9f %.9f,%.9f %.9f,%.9f %.9f),(%.9f %.9f,%.9f %.9f,%.9f %.9f,%.9f "
        "%.9f,%.9f %.9f))",
        x + 0.01, y, x + 0.01 + 3 * a, y, x + 0.01 + 3 * a, y + 3 * a, x + 0.01, y + 3 * a, x + 0.01, y,
        x + 0.01 + a, y + a, x + 0.01 + 2 * a, y + a, x + 0.01 + 2 * a, y + 2 * a, x + 0.01 + a, y + 2 * a,
        x + 0.01 + a, y + a);
    const std::vector<Feature> features = {
        {rectangle(x + 0.02, y, a, a), {"12", ""}},   // fine
        {rectangle(x + 0.021, y, a, a), {"", "4"}},   // no height, but storeys
        {rectangle(x + 0.022, y, a, a), {"", ""}},    // nothing at all
        {rectangle(x + 0.023, y, a, a), {"nan", ""}}, // a height that is none
        {rectangle(x + 0.024, y, a, a), {"-3", "2"}},
        {rectangle(x + 0.025, y, a, a), {"1e9", ""}},
        {bowTie, {"9", ""}}, // two triangles when it is mended
        {court, {"9", ""}},
        {"NAN", {"9", ""}},
        {line, {"9", ""}},
        {thin, {"9", ""}},
        {rectangle(x, 0.0, a, a), {"9", ""}}, // elsewhere
    };
    const std::string file = writeFeatures(folder / "bad.gpkg", {"height:real", "building:levels"}, features);
    const TownSummary summary = buildTown(optionsOf(database, file));
    EXPECT_EQ(summary.byStoreys, 2u);
    EXPECT_EQ(summary.byArea, 3u);
    EXPECT_EQ(summary.badHeights, 2u); // a GeoPackage has no NaN
    EXPECT_EQ(summary.repaired, 2u);
    EXPECT_EQ(summary.leftOut, 2u);
    EXPECT_EQ(summary.outside, 1u);
    EXPECT_EQ(summary.otherFeatures, 1u);
    EXPECT_EQ(summary.buildings, 9u);
    EXPECT_EQ(buildingsOf(database, "detail").size(), 9u);
    for (const char* words : {"9 buildings", "guessed", "mended", "left out", "no ground", "no numbers"})
        EXPECT_NE(summary.text().find(words), std::string::npos) << words;
    // The courtyard's walls stand too, and look into it.
    const DatabaseRoot root(database);
    int inner = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder / "database" / "buildings" / "detail"))
    {
        if (!entry.is_regular_file()) continue;
        forEachGeometry(
            entry.path(),
            [&](const osg::Geometry& geometry, const osg::Matrixd& toWorld)
            {
                const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
                const auto& normals = static_cast<const osg::Vec3bArray&>(*geometry.getNormalArray());
                for (std::size_t i = 0; i < vertices.size(); ++i)
                {
                    const osg::Vec3d world = osg::Vec3d(vertices[i]) * toWorld, here = root.fromWorld(world);
                    if (normals[i].z() != 0 || std::abs(here.x() - (x + 0.01 + 1.5 * a)) > 0.6 * a ||
                        std::abs(here.y() - (y + 1.5 * a)) > 0.6 * a)
                        continue;
                    ++inner;
                    const osg::Vec3d middle = root.toWorld({x + 0.01 + 1.5 * a, y + 1.5 * a, here.z()});
                    const osg::Vec3d normal = osg::Matrixd::transform3x3(
                        osg::Vec3d(normals[i].x(), normals[i].y(), normals[i].z()), toWorld);
                    EXPECT_GT(normal * (middle - world), 0.0);
                }
            });
    }
    EXPECT_GE(inner, 16);
}

TEST(TownBuilder, OtherSystemsAndFeet)
{
    const TempDir folder;
    // The same house, in degrees and metres, and in a projection and feet.
    OGRSpatialReference degrees, metres;
    degrees.importFromEPSG(4326);
    metres.importFromEPSG(32632);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> project(
        OGRCreateCoordinateTransformation(&degrees, &metres));
    OGRGeometry* geometry = nullptr;
    const std::string wkt = rectangle(WEST + 0.06, NORTH - 0.04, 3e-4, 2e-4);
    OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &geometry);
    geometry->transform(project.get());
    const std::string projected = geometry->exportToWkt();
    OGRGeometryFactory::destroyGeometry(geometry);
    std::vector<TownBuilding> found;
    for (const std::string name : {"degrees", "projection", "feet"})
    {
        const std::string database = copyOfTerrain(folder, name);
        const bool utm = name != "degrees";
        TownOptions options = optionsOf(
            database, writeFeatures(folder / (name + ".gpkg"), {"tall:real"},
                                    {{utm ? projected : wkt, {name == "feet" ? "65.6167979" : "20"}}},
                                    utm ? "EPSG:32632" : "EPSG:4326"));
        options.heightField = "tall";
        options.unit = name == "feet" ? HeightUnit::FEET : HeightUnit::METRES;
        buildTown(options);
        const std::vector<TownBuilding> here = buildingsOf(database, "detail");
        ASSERT_EQ(here.size(), 1u);
        found.push_back(here.front());
    }
    for (const TownBuilding& each : found)
    {
        EXPECT_LT((each.reference - found.front().reference).length(), 0.05);
        EXPECT_NEAR(each.highest, 20.0, 0.01);
    }
}

TEST(TownBuilder, HeightsInWords)
{
    const TempDir folder;
    const std::string database = copyOfTerrain(folder);
    std::vector<Feature> features;
    const std::vector<std::string> words = {"12 m", "40 ft", "41'", "inf", "tall", "nan", "12.2"};
    for (std::size_t i = 0; i < words.size(); ++i)
        features.push_back(
            {rectangle(WEST + 0.05 + 0.001 * static_cast<double>(i), NORTH - 0.05, 2e-4, 2e-4), {words[i]}});
    const TownSummary summary = buildTown(optionsOf(
        database, writeFeatures(folder / "words.geojson", {"height"}, features, "EPSG:4326", "GeoJSON")));
    EXPECT_EQ(summary.buildings, words.size());
    EXPECT_EQ(summary.badHeights, 3u);
    EXPECT_EQ(summary.byArea, 3u);
    int twelve = 0;
    for (const TownBuilding& each : buildingsOf(database, "detail"))
        twelve += each.highest > 11.9 && each.highest < 12.6 ? 1 : 0;
    EXPECT_EQ(twelve, 4);
}

// A tower and a bridge that stand in place of an outline, and a tower that does not fill its outline.
TEST(TownBuilder, PartsStandInPlaceOfTheirOutline)
{
    const TempDir folder;
    const double x = WEST + 0.05, y = NORTH - 0.05, a = 4e-4;
    const std::vector<Feature> features = {
        {rectangle(x, y, a, a), {"yes", "", "10", "", ""}},
        {rectangle(x - 0.25 * a, y, 0.5 * a, a), {"", "yes", "40", "12", ""}},
        {rectangle(x + 0.25 * a, y, 0.5 * a, a),
         {"", "roof", "", "", "\"building:levels\"=>\"8\",\"building:min_level\"=>\"5\""}},
        {rectangle(x + 0.01, y, a, a), {"yes", "", "10", "", ""}},
        {rectangle(x + 0.01 + 0.1 * a, y, 0.3 * a, 0.3 * a), {"", "yes", "30", "10", ""}},
        {rectangle(x + 0.02, y, a, a), {"", "", "9", "", ""}},      // woods, or anything
        {rectangle(x + 0.03, y, a, a), {"yes", "", "8", "20", ""}}, // an underside above the roof
    };
    for (const bool tags : {false, true})
    {
        const std::string name = tags ? "tags" : "columns";
        const std::string database = copyOfTerrain(folder, name);
        std::vector<Feature> all = features;
        std::vector<std::string> fields = {"building", "building:part", "height", "min_height", "other_tags"};
        if (tags)
        {
            // As GDAL hands out OpenStreetMap's: all but `building` are further tags.
            fields = {"building", "other_tags"};
            for (Feature& each : all)
            {
                std::string text;
                for (std::size_t i = 1; i < 4; ++i)
                    if (!each.values[i].empty())
                        text +=
                            (text.empty() ? "" : ",") + std::string("\"") +
                            std::vector<std::string>{"building", "building:part", "height", "min_height"}[i] +
                            "\"=>\"" + each.values[i] + "\"";
                if (!each.values[4].empty()) text += (text.empty() ? "" : ",") + each.values[4];
                each.values = {each.values[0], text};
            }
        }
        const TownSummary summary =
            buildTown(optionsOf(database, writeFeatures(folder / (name + ".gpkg"), fields, all)));
        EXPECT_EQ(summary.parts, 3u);
        EXPECT_EQ(summary.inParts, 1u);
        EXPECT_EQ(summary.otherFeatures, 1u);
        EXPECT_EQ(summary.buildings, 5u);
        for (const char* const level : {"detail", "single"})
        {
            std::vector<std::pair<double, double>> found;
            for (const TownBuilding& each : buildingsOf(database, level))
                found.emplace_back(each.highest, each.lowest);
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found.size(), 5u) << level;
            const std::pair<double, double> expected[] = {
                {8, -1}, {10, -1}, {25.8, 15.5}, {30, 10}, {40, 12}};
            for (std::size_t i = 0; i < 5; ++i)
            {
                EXPECT_NEAR(found[i].first, expected[i].first, 0.6) << level << i;
                // Walls on the ground go into it; undersides are those above its lowest point.
                if (expected[i].second < 0.0)
                    EXPECT_LT(found[i].second, 0.0) << level << i;
                else
                {
                    // Undersides count from the lowest ground below.
                    EXPECT_LE(found[i].second, expected[i].second + 0.1) << level << i;
                    EXPECT_GT(found[i].second, expected[i].second - 8.0) << level << i;
                }
            }
        }
    }
}

// Over the antimeridian, on the terrain's western edge, and in the outermost tiles.
TEST(TownBuilder, AtTheEndsOfLongitudes)
{
    const TempDir folder;
    BuildOptions terrain;
    terrain.dems = {writeRelief(folder / "dem.tif", 128, 64, 179.968, 10.0, 0.0005)};
    terrain.tileSize = 16;
    terrain.output = (folder / "database").string();
    buildDatabase(terrain);
    const DatabaseRoot root(terrain.output);
    const double y = 9.98, a = 2e-4;
    std::vector<Feature> features = {
        {rectangle(root.west() + 2e-4, y, 6e-4, a), {"9"}}, // partly beyond the edge
        {rectangle(root.west() + 1e-3, y, a, a), {"9"}},
        {rectangle(root.east() - 360.0 - 1e-3, y, a, a), {"9"}},
        // One ring, with longitudes of both ends.
        {CPLSPrintf("POLYGON((179.9999 %f,-179.9999 %f,-179.9999 %f,179.9999 %f,179.9999 %f))", y, y, y + a,
                    y + a, y),
         {"9"}}};
    const TownSummary summary =
        buildTown(optionsOf(terrain.output, writeFeatures(folder / "town.gpkg", {"height:real"}, features)));
    EXPECT_EQ(summary.buildings, features.size());
    const std::vector<Triangle> ground = groundOf(terrain.output);
    for (const TownBuilding& each : buildingsOf(terrain.output, "detail"))
    {
        for (const osg::Vec3d& vertex : each.vertices)
            EXPECT_LT((vertex - each.reference).length(), 120.0);
        const osg::Vec3d middle = root.fromWorld(each.reference);
        int found = 0;
        for (const Triangle& triangle : ground)
        {
            double height = 0.0;
            if (!triangle.finest || !triangle.heightAt(middle.x(), middle.y(), height)) continue;
            ++found;
            EXPECT_NEAR(height, middle.z(), 0.3);
        }
        EXPECT_GT(found, 0) << middle.x();
    }
}

TEST(TownBuilder, FoldersOfOthersStay)
{
    const TempDir folder;
    const std::string database = copyOfTerrain(folder);
    const std::filesystem::path own = folder / "database" / "buildings";
    std::filesystem::create_directories(own);
    const std::string source = writeFeatures(own / "city.gpkg", {"height:real"}, oneBuilding());
    const std::string elsewhere = writeFeatures(folder / "town.gpkg", {"height:real"}, oneBuilding());
    const auto before = contents(database);
    EXPECT_NE(refusalOf(optionsOf(database, source)).find("lies in a folder that the town takes"),
              std::string::npos);
    EXPECT_NE(refusalOf(optionsOf(database, elsewhere)).find("something else has the name"),
              std::string::npos);
    EXPECT_FALSE(removeStrayTown(database));
    EXPECT_EQ(before, contents(database));
    // A town that was being exchanged when the process was killed is put back.
    std::filesystem::remove_all(own);
    buildTown(optionsOf(database, elsewhere));
    const auto town = contents(database);
    std::filesystem::rename(own, folder / "database" / "buildings.old");
    EXPECT_FALSE(removeStrayTown(database));
    EXPECT_EQ(town, contents(database));
}

TEST(TownBuilder, RefusalsAreSentencesAndLeaveTheDatabase)
{
    const TempDir folder;
    const std::string database = copyOfTerrain(folder);
    const std::string good = writeFeatures(folder / "good.gpkg", {"height:real"}, oneBuilding());
    buildTown(optionsOf(database, good));
    const auto before = contents(database);
    const auto refused = [&](const TownOptions& options, const std::string& words)
    {
        const std::string text = refusalOf(options);
        EXPECT_NE(text.find(words), std::string::npos) << text;
        EXPECT_EQ(text.empty() ? ' ' : text.back(), '.') << text;
        EXPECT_EQ(before, contents(database));
    };
    refused(optionsOf(database, (folder / "none.gpkg").string()), "there is no such file; check the path");
    refused(optionsOf((folder / "nothing").string(), good), "no finished terrain database");
    TownOptions options = optionsOf(database, good);
    options.heightField = "altitude";
    refused(options, "no field \"altitude\"");
    options = optionsOf(database, good);
    options.layer = "streets";
    refused(options, "no layer \"streets\"");
    refused(optionsOf(database, writeFeatures(folder / "nowhere.gpkg", {"height:real"},
                                              {{rectangle(100.0, 0.0, 1e-3, 1e-3), {"9"}}})),
            "is a building that stands on this terrain");
    refused(optionsOf(database, writeFeatures(folder / "unplaced.shp", {"height:real"}, oneBuilding(), "",
                                              "ESRI Shapefile")),
            "no coordinate reference system");
    // Cancelled in the middle.
    EXPECT_THROW(buildTown(optionsOf(database, good),
                           [](std::uint64_t, std::uint64_t, const std::string& phase)
                           { return phase != "town"; }),
                 BuildError);
    EXPECT_EQ(before, contents(database));
}

TEST(TownBuilder, AnUpdatedTerrainLosesItsTownUntilItIsBuiltAgain)
{
    const TempDir folder;
    const std::string output = (folder / "database").string();
    buildTerrain(folder.path(), output);
    const std::string file = writeFeatures(folder / "town.gpkg", {"height:real"}, oneBuilding());
    buildTown(optionsOf(output, file));
    removeStrayTown(output);
    EXPECT_TRUE(std::filesystem::exists(folder / "database/buildings"));
    BuildOptions options;
    options.dems = {writeRelief(folder / "dem.tif", COLUMNS, ROWS, WEST, NORTH, PIXEL)};
    options.tileSize = 64;
    options.output = output;
    options.update = true;
    buildDatabase(options);
    EXPECT_TRUE(std::filesystem::exists(folder / "database/buildings"));
    EXPECT_TRUE(removeStrayTown(output));
    EXPECT_FALSE(std::filesystem::exists(folder / "database/buildings"));
    buildTown(optionsOf(output, file));
    EXPECT_EQ(buildingsOf(output, "detail").size(), 1u);
}
