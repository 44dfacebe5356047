// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Land-cover tables: what is read, and the sentence for what cannot be.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/LandCoverTable.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <map>

using namespace osgGeoFX;
using geofx::test::TempDir;

namespace
{

/// The sentence with which a table is refused; empty where it is read.
std::string refusal(const std::string& content, const std::string& name = "table.csv")
{
    const TempDir folder;
    const std::string file = folder.write(name, content);
    try
    {
        readLandCoverTable(file);
    }
    catch (const BuildError& error)
    {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(file, 0), 0u) << "the file is not named first: " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_EQ(message.back(), '.') << message;
        return message.substr(file.size());
    }
    return "";
}

const std::string header = "value,class,name,red,green,blue\n";

TEST(LandCoverTable, OahusTable)
{
    const auto classes = readLandCoverTable(GEOFX_SOURCE_DIR "/data/oahu/landcover.csv");
    ASSERT_GE(classes.size(), 10u);
    for (const auto& entry : classes)
    {
        EXPECT_GT(entry.value, 0);
        EXPECT_FALSE(entry.id.empty());
        EXPECT_FALSE(entry.name.empty());
    }
}

TEST(LandCoverTable, ColumnsInAnyOrderWithOthersBetween)
{
    const TempDir folder;
    const auto classes = readLandCoverTable(
        folder.write("t.csv", "blue,note,name,class,value,green,red\n3,x,\"Wood, dense\",wood,7,2,1\n")
            .string());
    ASSERT_EQ(classes.size(), 1u);
    EXPECT_EQ(classes[0].value, 7);
    EXPECT_EQ(classes[0].id, "wood");
    EXPECT_EQ(classes[0].name, "Wood, dense");
    EXPECT_EQ(classes[0].color, (std::array<unsigned char, 3>{1, 2, 3}));
}

TEST(LandCoverTable, WindowsLineEndsAndByteOrderMark)
{
    const TempDir folder;
    const auto classes = readLandCoverTable(
        folder.write("t.csv", "\xEF\xBB\xBFvalue,class,name,red,green,blue\r\n255,a,A,0,128,255\r\n"));
    ASSERT_EQ(classes.size(), 1u);
    EXPECT_EQ(classes[0].value, 255);
    EXPECT_EQ(classes[0].color[2], 255);
}

TEST(LandCoverTable, RefusesWithFileAndLine)
{
    EXPECT_EQ(refusal(header + "1,a,A,1,2,3\n"), "");
    EXPECT_EQ(refusal(header + "1,a,A,1,2,3\n300,b,B,1,2,3\n"),
              ":3: the column \"value\" holds \"300\"; write a whole number from 0 to 255.");
    EXPECT_EQ(refusal(header + "1,a,A,red,2,3\n"),
              ":2: the column \"red\" holds \"red\"; write a whole number from 0 to 255.");
    EXPECT_EQ(refusal(header + "1,a,A,1,-2,3\n"),
              ":2: the column \"green\" holds \"-2\"; write a whole number from 0 to 255.");
    EXPECT_EQ(refusal(header + "1,a,A,1,2\n"),
              ":2: the column \"blue\" holds \"\"; write a whole number from 0 to 255.");
    EXPECT_EQ(refusal(header + "1,a,A,1,2,2.5\n"),
              ":2: the column \"blue\" holds \"2.5\"; write a whole number from 0 to 255.");
    EXPECT_NE(refusal(header + "0,a,A,1,2,3\n").find(":2: the value 0 is kept"), std::string::npos);
    EXPECT_NE(refusal(header + "4,a,A,1,2,3\n5,b,B,1,2,3\n4,c,C,1,2,3\n").find(":4: the value 4 stands"),
              std::string::npos);
    EXPECT_NE(refusal("value,class,name,red,green\n1,a,A,1,2\n").find("the column \"blue\" is missing"),
              std::string::npos);
    EXPECT_NE(refusal(header).find("has no classes"), std::string::npos);
    EXPECT_NE(refusal("").find("land-cover table"), std::string::npos);
    EXPECT_NE(refusal(std::string("\0\1\2\3", 4)).find("land-cover table"), std::string::npos);
}

TEST(LandCoverTable, BlankLinesAndQuotedLineBreaksDoNotShiftTheNumbering)
{
    EXPECT_NE(refusal(header + "1,a,A,1,2,3\n\n\nx,b,B,1,2,3\n").find(":5: "), std::string::npos);
    EXPECT_NE(refusal(header + "1,a,\"A\nB\",1,2,3\nx,b,B,1,2,3\n").find(":4: "), std::string::npos);
}

TEST(LandCoverTable, MissingFile)
{
    try
    {
        readLandCoverTable("/nowhere/table.csv");
        FAIL();
    }
    catch (const BuildError& error)
    {
        EXPECT_NE(std::string(error.what()).find("/nowhere/table.csv: "), std::string::npos) << error.what();
    }
}

/// What a class of this identifier means in a table that does not say so.
LandCoverClass coverOf(const std::string& id)
{
    LandCoverClass entry;
    entry.id = id;
    coverOfClass(entry);
    return entry;
}

TEST(LandCoverTable, CoverIsOptionalByColumnAndByLine)
{
    const TempDir folder;
    const auto classes = readLandCoverTable(folder.write(
        "t.csv", "value,class,name,red,green,blue,trees,water\n1,sea,A,1,2,3,0.25,\n2,x,B,1,2,3,,1\n"));
    ASSERT_EQ(classes.size(), 2u);
    EXPECT_EQ(classes[0].trees, 0.25);
    EXPECT_TRUE(classes[0].water) << "the identifier tells";
    EXPECT_EQ(classes[1].trees, 0.0);
    EXPECT_TRUE(classes[1].water);
}

TEST(LandCoverTable, RefusesCoverThatIsNone)
{
    const std::string first = "value,class,name,red,green,blue,trees,town,bare,water\n";
    EXPECT_EQ(refusal(first + "1,a,A,1,2,3,0,0.5,1,0\n"), "");
    EXPECT_EQ(refusal(first + "1,a,A,1,2,3,40,0,0,0\n"),
              ":2: the column \"trees\" holds \"40\"; write a number from 0 to 1.");
    EXPECT_EQ(refusal(first + "1,a,A,1,2,3,0,-1,0,0\n"),
              ":2: the column \"town\" holds \"-1\"; write a number from 0 to 1.");
    EXPECT_EQ(refusal(first + "1,a,A,1,2,3,0,0,much,0\n"),
              ":2: the column \"bare\" holds \"much\"; write a number from 0 to 1.");
    EXPECT_EQ(refusal(first + "1,a,A,1,2,3,0,0,0,yes\n"),
              ":2: the column \"water\" holds \"yes\"; write 0 or 1.");
}

TEST(LandCoverTable, OahusClassesAreKnown)
{
    for (const auto& entry : readLandCoverTable(GEOFX_SOURCE_DIR "/data/oahu/landcover.csv"))
    {
        const bool water =
            entry.id == "sea" || entry.id == "lake" || entry.id == "river" || entry.id == "canal";
        EXPECT_EQ(entry.water, water) << entry.id;
        const bool plain = entry.id == "airfield_grass" || entry.id == "runway";
        EXPECT_EQ(entry.trees + entry.town + entry.bare > 0.0, !water && !plain) << entry.id;
    }
    EXPECT_GT(coverOf("mixed_forest").trees, 0.8);
    EXPECT_EQ(coverOf("URBAN").town, 1.0);
    EXPECT_EQ(coverOf("sand").bare, 0.5);
    EXPECT_EQ(coverOf("no such class").trees, 0.0);
    EXPECT_FALSE(coverOf("no such class").water);
}

TEST(LandCoverTable, ReadyLegends)
{
    std::vector<int> corine(44), water, ice;
    for (int value = 1; value <= 44; ++value)
        corine[static_cast<std::size_t>(value - 1)] = value;
    const std::map<std::string, std::vector<int>> values{
        {"worldcover", {10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 100}},
        {"corine", corine},
        {"nlcd", {11, 12, 21, 22, 23, 24, 31, 41, 42, 43, 51, 52, 71, 72, 73, 74, 81, 82, 90, 95}}};
    const std::map<std::string, std::vector<int>> waters{
        {"worldcover", {80}}, {"corine", {40, 41, 42, 43, 44}}, {"nlcd", {11}}};
    const std::map<std::string, int> ices{{"worldcover", 70}, {"corine", 34}, {"nlcd", 12}};
    ASSERT_EQ(readyLegends(), (std::vector<std::string>{"worldcover", "corine", "nlcd", "flightgear"}));
    for (const std::string& name : readyLegends())
    {
        SCOPED_TRACE(name);
        EXPECT_EQ(landCoverTableText(name),
                  landCoverTableText(GEOFX_SOURCE_DIR "/data/legends/" + name + ".csv"));
        std::vector<int> found;
        water.clear();
        ice.clear();
        for (const auto& entry : readLandCoverTable(name))
        {
            found.push_back(entry.value);
            if (entry.water) water.push_back(entry.value);
            if (entry.bare == 1.0) ice.push_back(entry.value);
            EXPECT_LE(entry.trees + entry.town, 1.2) << entry.id;
            EXPECT_TRUE(!entry.water || entry.trees + entry.town + entry.bare == 0.0) << entry.id;
            EXPECT_FALSE(entry.name.empty());
        }
        if (name == "flightgear") continue;
        EXPECT_EQ(found, values.at(name));
        EXPECT_EQ(water, waters.at(name));
        EXPECT_EQ(ice, std::vector<int>{ices.at(name)});
    }
    // A class that a legend knows needs no columns of cover in another table.
    EXPECT_GT(coverOf("EvergreenBroadCover").trees, 0.9);
    EXPECT_TRUE(coverOf("ocean").water);
    EXPECT_EQ(coverOf("clc_335").bare, 1.0);
}

} // namespace
