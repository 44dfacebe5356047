// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A database whose sources change: the bytes of a build from nothing, and no file written again that need not be.
#include <osgGeoFX/terrain/DistributedBuild.h>
#include <tools/DatabaseReader.h>
#include <tools/FolderContents.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

using Files = std::map<std::string, std::string>;

constexpr double WEST = 600000.0, NORTH = 2400000.0, PIXEL = 30.0;
constexpr int COLUMNS = 260, ROWS = 200;

/// Of all files that belong to the database itself: the root, the tiles, and what it is built from.
Files published(const fs::path& folder)
{
    Files result = contents(folder);
    for (auto file = result.begin(); file != result.end();)
        file = file->first.rfind("tiles/", 0) == 0 || file->first.find('/') == std::string::npos
                   ? std::next(file)
                   : result.erase(file);
    return result;
}

::testing::AssertionResult sameFiles(const Files& expected, const Files& found)
{
    for (const auto& [name, bytes] : expected)
    {
        const auto other = found.find(name);
        if (other == found.end()) return ::testing::AssertionFailure() << name << " is missing";
        if (other->second != bytes) return ::testing::AssertionFailure() << name << " differs";
    }
    for (const auto& [name, bytes] : found)
        if (!expected.count(name)) return ::testing::AssertionFailure() << name << " is one file too many";
    return expected.size() > 20 ? ::testing::AssertionSuccess()
                                : ::testing::AssertionFailure() << "only " << expected.size() << " files";
}

/// Files by their numbers in the file system. A file that is written again has another one.
std::map<std::string, ino_t> numbers(const fs::path& folder)
{
    std::map<std::string, ino_t> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "tiles"))
    {
        struct stat status
        {
        };
        if (entry.is_regular_file() && stat(entry.path().c_str(), &status) == 0)
            result[fs::relative(entry.path(), folder).string()] = status.st_ino;
    }
    return result;
}

/// On a plane, and on a globe.
class DatabaseUpdate : public ::testing::TestWithParam<bool>
{
protected:
    void SetUp() override
    {
        _options.dems = {base()};
        _options.epsg = GetParam() ? 32604 : 0;
        _options.tileSize = 8;
        _options.textureSize = 32;
        _options.output = (_folder / "db").string();
        _options.threads = 2;
        _options.update = true;
        _options.keep = true;
    }

    using Bump = std::function<double(int column, int row)>;
    /// A file that is again as it was has the time that it had, as from a backup: what a build from nothing gives is known then.
    std::string write(const std::string& name, int column, int row, int columns, int rows, double pixel,
                      const Bump& height)
    {
        TestRaster raster(columns, rows);
        raster.placed(WEST + column * PIXEL, NORTH - row * PIXEL, pixel, pixel).crs("EPSG:32604");
        raster.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
        const std::string file =
            raster.fill([&](int c, int r, int) { return height(c, r); }).write(_folder / name);
        std::ostringstream bytes;
        bytes << std::ifstream(file, std::ios::binary).rdbuf();
        const auto [time, isNew] = _times.try_emplace({name, bytes.str()}, fs::last_write_time(file));
        if (!isNew) fs::last_write_time(file, time->second);
        return file;
    }
    std::string base(const Bump& bump = {})
    {
        return write("base.tif", 0, 0, COLUMNS, ROWS, PIXEL,
                     [&](int c, int r)
                     {
                         const double change = bump ? bump(c, r) : 0.0;
                         return change < -1000.0 ? -9999.0 : relief(c, r) + change;
                     });
    }
    /// Higher ground over a part of the base: 60 × 50 of its pixels, or so many.
    std::string patch(double pixel = PIXEL, int column = 100, int row = 80, int columns = 60, int rows = 50)
    {
        const double share = pixel / PIXEL;
        return write("patch" + std::to_string(column) + ".tif", column, row,
                     static_cast<int>(columns / share), static_cast<int>(rows / share), pixel,
                     [&](int c, int r) { return relief(column + c * share, row + r * share) + 20.0; });
    }
    std::string bytes(const std::string& name, int column, int row, int columns, int rows, int bands,
                      const TestRaster::Value& value) const
    {
        return TestRaster(columns, rows, bands, GDT_Byte)
            .placed(WEST + column * PIXEL, NORTH - row * PIXEL, PIXEL, PIXEL)
            .crs("EPSG:32604")
            .fill(value)
            .write(_folder / name);
    }
    /// With classes, colors do not follow from the range of heights.
    void useLandCover(int changed = 0)
    {
        _options.landCover = bytes("landcover.tif", 0, 0, COLUMNS, ROWS, 1,
                                   [&](int c, int r, int)
                                   {
                                       const bool here = c >= 200 && c < 200 + changed && r > 140 && r < 170;
                                       return here ? 3 : 1 + (c / 20 + r / 30) % 2;
                                   });
        if (!_options.landCoverTable.empty()) return;
        _options.landCoverTable =
            _folder
                .write("table.csv",
                       "value,class,name,red,green,blue,trees,town,bare,water\n"
                       "1,a,A,40,90,20,1,0,0,0\n2,b,B,160,150,90,0,0,1,0\n3,c,C,90,90,120,0,0,0,1\n")
                .string();
    }
    BuildSummary build(bool resume = false)
    {
        BuildOptions options = _options;
        options.resume = resume;
        const bool first = !fs::exists(database());
        const BuildSummary summary = buildDatabase(options);
        if (first) _fresh[sources()] = contents(database());
        return summary;
    }
    fs::path database() const { return _options.output; }

    /// What a build depends on: the options that tests change, and the sources as they are now.
    std::string sources() const
    {
        const auto& o = _options;
        std::ostringstream result;
        result << o.voidReach << ' ' << o.lakeArea << ' ' << o.tileSize << ' ' << o.pixelError << ' '
               << o.compressTextures << ' ' << o.keep;
        for (const std::vector<std::string>& files : {o.dems, o.imagery, {o.landCover, o.treeCover}})
            for (const std::string& file : files)
                if (!file.empty())
                    result << '\n' << file << ' ' << fs::last_write_time(file).time_since_epoch().count();
        return result.str();
    }
    /// What a build from nothing gives. Each is made once.
    const Files& fromNothing()
    {
        const auto [files, isNew] = _fresh.try_emplace(sources());
        if (isNew)
        {
            BuildOptions options = _options;
            options.output = (_folder / ("fresh" + std::to_string(_fresh.size()))).string();
            buildDatabase(options);
            files->second = contents(options.output);
        }
        return files->second;
    }

    /// Updates the database, and compares it with a build from nothing. At most `most` of its files may be written.
    BuildSummary expectUpdate(double most)
    {
        const Files before = published(database());
        const auto former = numbers(database());
        const BuildSummary summary = build();
        EXPECT_TRUE(summary.updated);
        EXPECT_EQ(summary.allBecause, "");
        const Files after = contents(database());
        EXPECT_TRUE(sameFiles(fromNothing(), after));
        const auto now = numbers(database());
        std::size_t written = 0, needless = 0;
        for (const auto& [name, number] : now)
        {
            const auto old = former.find(name);
            if (old != former.end() && old->second == number) continue;
            ++written;
            const auto bytes = before.find(name);
            if (bytes != before.end() && bytes->second == after.at(name)) ++needless;
        }
        EXPECT_GT(written, 0u) << "the change changes nothing";
        EXPECT_LE(static_cast<double>(written), most * static_cast<double>(now.size()))
            << written << " of " << now.size() << " files are written";
        EXPECT_LE(needless, written / 10) << "of " << written << " files";
        EXPECT_GT(summary.tilesKept, 0u);
        EXPECT_LT(summary.tilesKept, summary.tiles);
        return summary;
    }

    const TempDir _folder;
    BuildOptions _options;
    std::map<std::string, Files> _fresh;
    std::map<std::pair<std::string, std::string>, fs::file_time_type> _times;
};

INSTANTIATE_TEST_SUITE_P(Grids, DatabaseUpdate,
                         ::testing::ValuesIn(fullTest() ? std::vector<bool>{false, true}
                                                        : std::vector<bool>{false}),
                         [](const auto& parameter) { return parameter.param ? "OnAPlane" : "OnAGlobe"; });

TEST_P(DatabaseUpdate, ElevationIsAddedAndTakenAway)
{
    useLandCover();
    build();
    const Files before = contents(database());
    _options.dems.push_back(patch());
    const BuildSummary summary = expectUpdate(0.5);
    EXPECT_GT(summary.unitsKept, 0u);
    _options.dems.pop_back();
    expectUpdate(0.5);
    EXPECT_TRUE(sameFiles(before, contents(database())));
}

TEST_P(DatabaseUpdate, DenserElevationIsAddedAndTakenAway)
{
    useLandCover();
    build();
    const Files before = contents(database());
    const int levels = DatabaseRoot(database()).finestLevel();
    _options.dems.push_back(patch(PIXEL / 2.6, 100, 80, 24, 20));
    expectUpdate(0.9); // many of them are new
    EXPECT_EQ(DatabaseRoot(database()).finestLevel(), levels + 2);
    // Levels go deeper where there is data alone.
    std::map<int, int> tiles;
    for (const auto& tile : readTiles(database()))
        ++tiles[tile.level];
    EXPECT_GE(tiles[levels + 2], 16 * 6);
    EXPECT_LE(tiles[levels + 2], 16 * 20);
    if (fullTest())
    {
        // A second place with denser data yet.
        _options.dems.push_back(patch(PIXEL / 7.0, 190, 140, 12, 10));
        expectUpdate(0.9);
        EXPECT_EQ(DatabaseRoot(database()).finestLevel(), levels + 3);
        _options.dems.pop_back();
        expectUpdate(0.5);
    }
    _options.dems.pop_back();
    expectUpdate(0.7);
    EXPECT_TRUE(sameFiles(before, contents(database()))) << "finer tiles are left";
}

/// Colors are those of heights here, and their range stays.
TEST_P(DatabaseUpdate, AFileChangesInPlace)
{
    build();
    const auto bump = [](int c, int r)
    {
        const double distance = std::hypot(c - 150.0, r - 120.0);
        return distance < 20.0 ? 5.0 * std::cos(distance / 20.0 * 1.5707963) : 0.0;
    };
    base(bump);
    const BuildSummary summary = expectUpdate(0.4);
    EXPECT_EQ(summary.unitsKept, 0u) << "whose file has changed must be sampled";
    base();
    expectUpdate(0.4);
}

TEST_P(DatabaseUpdate, VoidsBesideTheChange)
{
    const auto holes = [](double deeper)
    {
        return [deeper](int c, int r)
        {
            // One reaches into the patch, one lies far away, and one is as far from it as the search for data goes.
            const bool hole = std::hypot(c - 95.0, r - 100.0) < 12.0 ||
                              std::hypot(c - 230.0, r - 40.0) < 9.0 ||
                              std::hypot(c - 200.0, r - 100.0) < 15.0;
            return hole ? -9999.0 : c > 180 && c < 184 && r > 90 && r < 94 ? deeper : 0.0;
        };
    };
    _options.voidReach = 30;
    _options.dems = {base(holes(0.0))};
    useLandCover();
    const BuildSummary first = build();
    ASSERT_GT(first.filledShare, 0.0);
    _options.dems.push_back(patch());
    expectUpdate(0.7);
    base(holes(-30.0));
    expectUpdate(0.7);
    // Without any void.
    base();
    expectUpdate(0.7);
    if (!fullTest()) return;
    base(holes(0.0));
    expectUpdate(0.7);
    _options.dems.pop_back();
    expectUpdate(0.7);
}

TEST_P(DatabaseUpdate, ImageryOfAPart)
{
    const auto colors = [](int c, int r, int band)
    {
        return (c * 7 + r * 13 * (band + 1)) % 251;
    };
    _options.imagery = {bytes("imagery.tif", 0, 0, COLUMNS, ROWS, 3, colors)};
    useLandCover();
    build();
    _options.imagery.push_back(
        bytes("part.tif", 190, 100, 50, 40, 3, [](int c, int, int) { return c % 2 ? 20 : 220; }));
    const BuildSummary summary = expectUpdate(0.5);
    EXPECT_GT(summary.unitsKept, 0u);
    bytes("part.tif", 190, 100, 50, 40, 3, [](int c, int, int) { return c % 2 ? 20 : 221; });
    expectUpdate(0.5);
    _options.imagery.pop_back();
    expectUpdate(0.5);
}

/// Water moves the shores of all land around it.
TEST_P(DatabaseUpdate, LandCoverOfAPart)
{
    useLandCover(20);
    build();
    useLandCover(22);
    expectUpdate(0.7);
    _options.treeCover = bytes("trees.tif", 0, 0, COLUMNS, ROWS, 1, [](int c, int, int) { return c % 100; });
    EXPECT_NE(build().allBecause.find("with tree cover"), std::string::npos);
    EXPECT_TRUE(sameFiles(fromNothing(), contents(database())));
    bytes("trees.tif", 0, 0, COLUMNS, ROWS, 1,
          [](int c, int r, int) { return c > 50 && c < 90 && r > 100 && r < 140 ? 100 : c % 100; });
    expectUpdate(0.5);
}

TEST_P(DatabaseUpdate, NothingHasChanged)
{
    build();
    const Files before = contents(database());
    const auto former = numbers(database());
    const BuildSummary summary = build();
    EXPECT_EQ(summary.tilesKept, summary.tiles);
    EXPECT_FALSE(summary.updated);
    EXPECT_EQ(numbers(database()), former);
    EXPECT_TRUE(sameFiles(before, contents(database())));
}

/// What every tile depends on; each with the reason that is given.
TEST_P(DatabaseUpdate, OptionsThatAffectEverything)
{
    build();
    int count = 0;
    const auto expectAll = [&](const std::string& reason)
    {
        const BuildSummary summary = build();
        EXPECT_NE(summary.allBecause.find(reason), std::string::npos) << summary.allBecause;
        EXPECT_EQ(summary.tilesKept, 0u);
        if (!fullTest() && ++count % 3 != 0) return;
        EXPECT_TRUE(sameFiles(fromNothing(), contents(database()))) << reason;
    };
    _options.pixelError = 2.0;
    expectAll("pixel error 2");
    _options.tileSize = 16;
    expectAll("tile size 16");
    _options.compressTextures = true;
    expectAll("textures compressed");
    _options.compressTextures = false;
    // Beyond the border of before.
    _options.dems.push_back(patch(PIXEL, COLUMNS - 20));
    expectAll("extent ");
    _options.keep = false;
    _options.lakeArea = 1e5;
    expectAll("lake area");
    EXPECT_FALSE(fs::exists(database() / "kept"));
    _options.keep = true;
    _options.lakeArea = 2e5;
    expectAll("kept nothing");
    // The highest summit of all gives all colors.
    base([](int c, int r) { return c == 10 && r == 10 ? 3000.0 : 0.0; });
    expectAll("range of heights");
}

TEST_P(DatabaseUpdate, TilesThatAreDamagedOrMissing)
{
    useLandCover();
    build();
    std::vector<fs::path> tiles;
    for (const auto& [name, number] : numbers(database()))
        tiles.push_back(database() / name);
    fs::remove(tiles.front());
    fs::resize_file(tiles.back(), 100);
    _options.dems.push_back(patch());
    build();
    EXPECT_TRUE(sameFiles(fromNothing(), contents(database())));
    // The same among what is kept.
    for (const char* folder : {"facts", "roots", "tiles", "records"})
    {
        bool second = false;
        for (const auto& entry : fs::recursive_directory_iterator(database() / "kept" / folder))
            if (entry.is_regular_file()) second ? void(fs::remove(entry.path())) : void(second = true);
    }
    _options.dems.pop_back();
    build();
    EXPECT_TRUE(sameFiles(fromNothing(), contents(database())));
}

/// A folder stands in the way of a file, so the update ends in the midst of its last step. What is there then can be
/// read, from the old root or the new one, and any call brings it to its end.
TEST_P(DatabaseUpdate, InterruptedWhileFilesTakeTheirPlaces)
{
    useLandCover();
    _options.dems.push_back(patch(PIXEL / 2.0, 180));
    build();
    const Files before = published(database());
    _options.dems.back() = patch(PIXEL / 2.0);
    const Files whole = fromNothing();
    planBuild(_options);
    std::ifstream stream(database() / "work" / "plan.json");
    const nlohmann::json plan = nlohmann::json::parse(stream);
    for (const auto& stage : plan.at("stages"))
        if (stage.at("name") != "finish") buildUnits(_options.output, {stage.at("name")});
    EXPECT_EQ(published(database()), before);

    // Files that are replaced, of several levels.
    std::vector<std::string> obstacles{"terrain.osgb", "built-from.txt"};
    std::map<std::string, std::string> byLevel;
    std::size_t obsolete = 0;
    for (const auto& [name, bytes] : before)
    {
        obsolete += whole.count(name) == 0;
        if (name.rfind("tiles/", 0) == 0 && whole.count(name) && whole.at(name) != bytes)
            byLevel[name.substr(0, name.find('/', 6))] = name;
    }
    EXPECT_GT(obsolete, 10u);
    std::size_t number = 0;
    for (const auto& [level, name] : byLevel)
        if (fullTest() || number++ % 2 == 0) obstacles.push_back(name);
    ASSERT_GT(obstacles.size(), 4u);
    int mixed = 0;
    for (const std::string& obstacle : obstacles)
    {
        SCOPED_TRACE(obstacle);
        const fs::path copy = _folder / "copy";
        fs::remove_all(copy);
        fs::copy(database(), copy, fs::copy_options::recursive);
        fs::rename(copy / obstacle, copy / "aside");
        fs::create_directories(copy / obstacle / "full");
        EXPECT_THROW(buildUnits(copy.string(), {"finish"}), BuildError);
        fs::remove_all(copy / obstacle);
        fs::rename(copy / "aside", copy / obstacle);
        Files now = published(copy);
        std::size_t old = 0, fresh = 0;
        for (const auto& [name, bytes] : now)
        {
            const auto was = before.find(name), becomes = whole.find(name);
            const bool isOld = was != before.end() && was->second == bytes,
                       isNew = becomes != whole.end() && becomes->second == bytes;
            EXPECT_TRUE(isOld || isNew) << name;
            old += isOld && !isNew;
            fresh += isNew && !isOld;
        }
        EXPECT_GT(old, 0u);
        mixed += fresh > 0;
        std::size_t tiles = 0;
        EXPECT_NO_THROW(readDatabase(copy.string(), [&](const DatabaseTile&) { ++tiles; }));
        EXPECT_GT(tiles, 100u);
        BuildOptions options = _options;
        options.output = copy.string();
        options.resume = mixed % 2 == 0;
        buildDatabase(options);
        EXPECT_TRUE(sameFiles(whole, contents(copy)));
    }
    EXPECT_GT(mixed, 2);
}

/// Until all is ready, the former database is as it was; afterwards it goes on.
TEST_P(DatabaseUpdate, InterruptedAtEachUnit)
{
    useLandCover();
    build();
    const Files before = published(database());
    _options.dems.push_back(patch(PIXEL / 2.0));
    const Files whole = fromNothing();
    BuildOptions options = _options;
    options.threads = 1;
    std::uint64_t last = 0;
    std::set<std::string> phases;
    for (std::uint64_t stop = 1;; stop += 1 + stop / (fullTest() ? 20 : 3))
    {
        bool stopped = false;
        try
        {
            buildDatabase(options,
                          [&](std::uint64_t done, std::uint64_t, const std::string& phase)
                          {
                              if (done == stop) phases.insert(phase);
                              return done < stop;
                          });
        }
        catch (const BuildError&)
        {
            stopped = true;
        }
        last = stop;
        if (!stopped || published(database()) != before) break;
        // Every second time it begins again, which is an interruption, too.
        options.resume = !options.resume;
    }
    EXPECT_GT(last, 30u);
    EXPECT_GE(phases.size(), 3u);
    options.resume = false;
    buildDatabase(options);
    EXPECT_TRUE(sameFiles(whole, contents(database())));
}

TEST_P(DatabaseUpdate, AnotherUpdateTakesThePlaceOfAnInterruptedOne)
{
    useLandCover();
    build();
    const Files before = contents(database());
    const auto stop = [&]
    {
        EXPECT_THROW(buildDatabase(_options, [](std::uint64_t done, std::uint64_t total, const std::string&)
                                   { return done < 3 * total / 4; }),
                     BuildError);
    };
    _options.dems.push_back(patch());
    stop();
    _options.dems.back() = patch(PIXEL, 180);
    EXPECT_THROW(build(true), BuildError) << "it continues what it has not begun";
    const BuildSummary summary = build();
    EXPECT_GT(summary.tilesKept, 0u);
    EXPECT_TRUE(sameFiles(fromNothing(), contents(database())));
    // And none at all: the sources of before.
    _options.dems.pop_back();
    build();
    _options.dems.push_back(patch());
    stop();
    _options.dems.pop_back();
    build();
    EXPECT_TRUE(sameFiles(before, contents(database())));
}

TEST_P(DatabaseUpdate, ByManyProcesses)
{
    useLandCover();
    _options.dems = {
        base([](int c, int r) { return std::hypot(c - 230.0, r - 40.0) < 9.0 ? -9999.0 : 0.0; })};
    build();
    const Files before = published(database());
    const auto former = numbers(database());
    _options.dems.push_back(patch(PIXEL / 2.0));
    const Files whole = fromNothing();
    planBuild(_options);
    EXPECT_FALSE(readBuildStatus(database()).finished);
    std::ifstream stream(database() / "work" / "plan.json");
    const nlohmann::json plan = nlohmann::json::parse(stream);
    std::uint64_t kept = 0, built = 0, tiles = 0;
    for (const auto& stage : plan.at("stages"))
    {
        EXPECT_EQ(published(database()), before) << "before " << stage.at("name");
        for (std::uint64_t unit = stage.at("units"); unit > 0;)
        {
            std::vector<std::string> ranges;
            while (unit > 0 && ranges.size() < (fullTest() ? 1u : 5u))
                ranges.push_back(stage.at("name").get<std::string>() + ":" + std::to_string(--unit));
            const BuiltDatabaseUnits done = buildUnits(_options.output, ranges);
            kept += done.kept;
            built += done.built;
            tiles += done.tilesKept;
        }
    }
    EXPECT_TRUE(sameFiles(whole, contents(database())));
    EXPECT_TRUE(readBuildStatus(database()).finished);
    EXPECT_GT(kept, 0u);
    EXPECT_GT(built, 0u);
    EXPECT_GT(tiles, 0u);
    std::size_t same = 0;
    for (const auto& [name, number] : numbers(database()))
        same += former.count(name) && former.at(name) == number;
    EXPECT_GT(same, former.size() / 3);
}

} // namespace
