// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The table in osgGeoFX/Integration.md of what the kit takes of OpenGL, against the code.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/ground/GroundDetail.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace osgGeoFX;

namespace
{

using Row = std::vector<std::string>; // what, which, who uses it, given out by, changed by

std::vector<Row> readTable()
{
    std::ifstream file(GEOFX_SOURCE_DIR "/osgGeoFX/Integration.md");
    std::vector<Row> rows;
    bool inside = false;
    std::string what;
    for (std::string line; std::getline(file, line);)
    {
        if (line.rfind("## ", 0) == 0)
            inside = line.find("What the kit takes of OpenGL") != std::string::npos;
        if (!inside || line.rfind("| ", 0) != 0 || line.rfind("| ---", 0) == 0) continue;
        Row row;
        std::istringstream cells(line.substr(1));
        for (std::string cell; std::getline(cells, cell, '|');)
            row.push_back(cell);
        // An empty first cell goes on with what is above.
        if (row.front().find_first_not_of(' ') == std::string::npos)
            row.front() = what;
        else
            what = row.front();
        rows.push_back(row);
    }
    return rows;
}

TextureUnits::Units numbersIn(const std::string& text)
{
    TextureUnits::Units numbers;
    const std::regex number("[0-9]+");
    for (std::sregex_iterator each(text.begin(), text.end(), number), end; each != end; ++each)
        numbers.push_back(std::stoi(each->str()));
    return numbers;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// The one row of a kind that names a class as its user.
Row rowOf(const std::string& what, const std::string& className)
{
    Row found(5);
    int count = 0;
    for (const Row& row : readTable())
    {
        if (row.size() != 5 || !contains(row[0], what) || !contains(row[2], "`" + className + "`")) continue;
        found = row;
        ++count;
    }
    EXPECT_EQ(count, 1) << what << " of " << className;
    return found;
}

} // namespace

TEST(IntegrationTable, HasTheUnitsAndBindingsThatTheSceneGives)
{
    const TextureUnits::Effects effects = {new ProjectiveMappings, new PanoramaMap, new CloseUps,
                                           new GroundDetail, new SunShadows};
    const TextureUnits given = TextureUnits::of(effects);
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const auto& user = dynamic_cast<const TextureUser&>(*effects[i]);
        const Row units = rowOf("texture units", effects[i]->className());
        TextureUnits::Units expected;
        const std::vector<TextureUnitWish> wishes = user.textureUnits();
        for (std::size_t j = 0; j < wishes.size(); ++j)
        {
            if (!wishes[j].ofTerrain) expected.push_back(given.ofEffects[i][j]);
            if (!wishes[j].ofTerrain)
            {
                EXPECT_TRUE(contains(units[4], wishes[j].property)) << wishes[j].property;
            }
        }
        EXPECT_EQ(numbersIn(units[1]), expected) << effects[i]->className();
        EXPECT_TRUE(contains(units[4], "setFirstTextureUnit"));
        if (user.uniformBlocks().empty()) continue;
        const Row blocks = rowOf("uniform block bindings", effects[i]->className());
        EXPECT_EQ(numbersIn(blocks[1]), given.ofBlocks[i]);
        EXPECT_TRUE(contains(blocks[4], user.uniformBlocks().front().property));
        EXPECT_TRUE(contains(blocks[4], "setFirstBlockBinding"));
    }
}

// The prefixes that the table promises: no uniform, varying or define of the kit's shaders has another one.
TEST(IntegrationTable, HasThePrefixesOfAllNames)
{
    const ShaderLibrary library;
    const std::regex declared("(^|\\n)[ ]*(?:flat )?(uniform|in|out) +(?:[a-z0-9A-Z]+) +([A-Za-z_0-9]+)");
    const std::regex imported("import_defines\\(([^)]*)\\)");
    const std::regex word("[A-Za-z_0-9]+");
    int names = 0, defines = 0;
    for (const std::string& file : ShaderLibrary::files())
    {
        const std::string text = library.read(file);
        // A program of the kit's own, for a square that no one else draws.
        const bool alone = contains(file, "panorama.sky.");
        for (std::sregex_iterator each(text.begin(), text.end(), declared), end; each != end; ++each)
        {
            const std::string kind = (*each)[2], name = (*each)[3];
            ++names;
            if (alone && kind != "uniform") continue;
            EXPECT_TRUE(name.rfind("geofx_", 0) == 0 || name.rfind("SLOT_", 0) == 0) << file << ": " << name;
            // No generic attribute.
            EXPECT_FALSE(kind == "in" && contains(file, ".vert")) << file << ": " << name;
        }
        for (std::sregex_iterator each(text.begin(), text.end(), imported), end; each != end; ++each)
        {
            const std::string list = (*each)[1];
            for (std::sregex_iterator define(list.begin(), list.end(), word); define != end; ++define)
            {
                ++defines;
                const std::string name = define->str();
                EXPECT_TRUE(name.rfind("GEOFX_", 0) == 0 || name.rfind("SLOT_", 0) == 0)
                    << file << ": " << name;
            }
        }
    }
    EXPECT_GT(names, 100);
    EXPECT_GT(defines, 50);
    int rows = 0;
    for (const Row& row : readTable())
        rows += contains(row[1], "`geofx_…`") || contains(row[1], "`GEOFX_…`") ? 1 : 0;
    EXPECT_EQ(rows, 2);
}

// A table that says how osgEarth's parts fare is worth as much as the tests behind it.
TEST(IntegrationTable, PartsOfOsgEarthAreShownByTests)
{
    std::set<std::string> tests, named;
    const std::regex test(R"(TEST(?:_F|_P)?\((\w+),\s*(\w+)\))"), name("`(\\w+)[.](\\w+)`");
    for (const auto& entry : std::filesystem::directory_iterator(GEOFX_SOURCE_DIR "/tests/osgearth"))
    {
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        for (std::sregex_iterator each(text.begin(), text.end(), test), end; each != end; ++each)
            tests.insert(each->str(1) + "." + each->str(2));
    }
    ASSERT_GT(tests.size(), 20u);
    std::ifstream file(GEOFX_SOURCE_DIR "/osgGeoFX/Integration.md");
    bool inside = false;
    int parts = 0;
    for (std::string line; std::getline(file, line);)
    {
        if (line.rfind("| of osgEarth | how |", 0) == 0)
        {
            inside = true;
            continue;
        }
        inside = inside && line.rfind("| ", 0) == 0;
        if (!inside || line.rfind("| ---", 0) == 0) continue;
        ++parts;
        const std::string shownBy = line.substr(line.rfind('|', line.size() - 2));
        const bool isOpen = contains(shownBy, "| no test |");
        EXPECT_NE(isOpen, std::regex_search(shownBy, name)) << line;
        for (std::sregex_iterator each(shownBy.begin(), shownBy.end(), name), end; each != end; ++each)
        {
            const std::string full = each->str(1) + "." + each->str(2);
            named.insert(full);
            EXPECT_TRUE(tests.count(full)) << full << " is no test";
        }
        const bool saysHow = contains(line, " | follows | ") || contains(line, " | rigid | ") ||
                             contains(line, " | left alone | ");
        EXPECT_TRUE(saysHow) << line;
    }
    EXPECT_GT(parts, 20);
    for (const std::string& each : tests)
    {
        if (each.rfind("ThingsOnGround.", 0) == 0)
        {
            EXPECT_TRUE(named.count(each)) << each << " is of no part in the table";
        }
    }
}
