// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Land-cover tables: what is read, and the sentence for what cannot be.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/LandCoverTable.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

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

} // namespace
