// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Color maps of SLD: what the three types mean, and what is refused.
#include <osgGeoFX/geodata/SldColors.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

using namespace osgGeoFX;

namespace
{

const osg::Vec4 red(1, 0, 0, 1), green(0, 1, 0, 1), blue(0, 0, 1, 1), clear;

class SldColorsTest : public ::testing::Test
{
protected:
    /// As GeoServer and QGIS write it, with their namespaces.
    std::string file(const std::string& map) const
    {
        return _folder
            .write("map.sld", R"(<?xml version="1.0" encoding="UTF-8"?>
<sld:StyledLayerDescriptor xmlns:sld="http://www.opengis.net/sld" xmlns:se="http://www.opengis.net/se" version="1.0.0">
<sld:UserLayer><sld:UserStyle><sld:FeatureTypeStyle><sld:Rule><sld:RasterSymbolizer>
)" + map + R"(
</sld:RasterSymbolizer></sld:Rule></sld:FeatureTypeStyle></sld:UserStyle></sld:UserLayer></sld:StyledLayerDescriptor>)")
            .string();
    }
    osg::ref_ptr<ColorTable> read(const std::string& map) const
    {
        std::string error;
        const osg::ref_ptr<ColorTable> table = SldColors::read(file(map), error);
        EXPECT_TRUE(table) << error;
        return table ? table : osg::ref_ptr<ColorTable>(new ColorTable);
    }
    std::string faultOf(const std::string& map) const
    {
        std::string error;
        EXPECT_FALSE(SldColors::read(file(map), error));
        return error;
    }

    geofx::test::TempDir _folder;
};

const std::string entries = R"(<sld:ColorMapEntry color="#ff0000" quantity="10" label="low"/>
<sld:ColorMapEntry color="#00FF00" quantity="20" opacity="1.0"/>
<sld:ColorMapEntry color="#0000ff" quantity="3e1" opacity="0.5"/>)";

} // namespace

TEST_F(SldColorsTest, ARampMixes)
{
    for (const std::string& map : {"<sld:ColorMap>" + entries + "</sld:ColorMap>",
                                   R"(<se:ColorMap type="ramp">)" + entries + "</se:ColorMap>"})
    {
        const osg::ref_ptr<ColorTable> table = read(map);
        EXPECT_EQ(table->getMode(), ColorTable::LINEAR);
        EXPECT_EQ(table->at(0.0), red);
        EXPECT_EQ(table->at(15.0), (red + green) / 2.0f);
        EXPECT_EQ(table->at(99.0), osg::Vec4(0, 0, 1, 0.5f));
    }
}

TEST_F(SldColorsTest, IntervalsHoldBelowTheirQuantities)
{
    const osg::ref_ptr<ColorTable> table =
        read(R"(<sld:ColorMap type="intervals">)" + entries + "</sld:ColorMap>");
    EXPECT_EQ(table->at(-5.0), red);
    EXPECT_EQ(table->at(9.9), red);
    EXPECT_EQ(table->at(10.0), green);
    EXPECT_EQ(table->at(19.9), green);
    EXPECT_EQ(table->at(20.0), osg::Vec4(0, 0, 1, 0.5f));
    EXPECT_EQ(table->at(30.0), clear);
    EXPECT_EQ(table->at(99.0), clear);
}

TEST_F(SldColorsTest, TheLastQuantityMayBeInfinite)
{
    // As QGIS writes it.
    const std::string open = entries + R"(<sld:ColorMapEntry color="#ff0000" quantity="inf"/>)";
    for (const std::string type : {"intervals", "ramp", "values"})
    {
        const osg::ref_ptr<ColorTable> table =
            read("<sld:ColorMap type=\"" + type + "\">" + open + "</sld:ColorMap>");
        const osg::Vec4 blue(0, 0, 1, 0.5f);
        EXPECT_EQ(table->at(99.0), type == "intervals" ? red : type == "ramp" ? blue : clear) << type;
    }
    const osg::ref_ptr<ColorTable> one = read(
        R"(<sld:ColorMap type="intervals"><sld:ColorMapEntry color="#ff0000" quantity="inf"/></sld:ColorMap>)");
    EXPECT_EQ(one->at(-99.0), red);
    EXPECT_EQ(one->at(99.0), red);
    EXPECT_FALSE(faultOf(R"(<sld:ColorMap><sld:ColorMapEntry color="#ff0000" quantity="inf"/>
                            <sld:ColorMapEntry color="#ff0000" quantity="1"/></sld:ColorMap>)")
                     .empty());
}

TEST_F(SldColorsTest, ValuesHoldAlone)
{
    const osg::ref_ptr<ColorTable> table =
        read(R"(<sld:ColorMap type="values">)" + entries + "</sld:ColorMap>");
    EXPECT_EQ(table->at(10.0), red);
    EXPECT_EQ(table->at(20.0), green);
    EXPECT_EQ(table->at(15.0), clear);
}

TEST_F(SldColorsTest, WhatCannotBeIsToldWithItsLine)
{
    const auto contains = [](const std::string& text, const std::string& part)
    {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(contains(faultOf(""), "map.sld: it has no ColorMap"));
    EXPECT_TRUE(contains(faultOf("<sld:ColorMap/>"), "map.sld:4: the ColorMap has no ColorMapEntry"));
    EXPECT_TRUE(
        contains(faultOf(R"(<sld:ColorMap type="other">)" + entries + "</sld:ColorMap>"), "\"other\""));
    const auto entry = [&](const std::string& attributes)
    {
        return faultOf("<sld:ColorMap><sld:ColorMapEntry " + attributes + "/></sld:ColorMap>");
    };
    EXPECT_TRUE(contains(entry("color=\"red\" quantity=\"1\""), "map.sld:4: the entry's color is \"red\""));
    EXPECT_TRUE(contains(entry("color=\"#ff0000\" quantity=\"nan\""), "quantity is \"nan\""));
    EXPECT_TRUE(contains(entry("color=\"#ff0000\" quantity=\"1\" opacity=\"2\""), "opacity is \"2\""));
    EXPECT_TRUE(contains(faultOf(R"(<sld:ColorMap><sld:ColorMapEntry color="#ff0000" quantity="2"/>
                                    <sld:ColorMapEntry color="#ff0000" quantity="1"/></sld:ColorMap>)"),
                         "map.sld:5: the entry's quantity is less"));
    std::string error;
    EXPECT_FALSE(SldColors::read(_folder.write("cut.sld", "<sld><ColorMap>").string(), error));
    EXPECT_TRUE(contains(error, "cut.sld:1: it is not XML")) << error;
    EXPECT_FALSE(SldColors::read((_folder / "none.sld").string(), error));
    EXPECT_TRUE(contains(error, "none.sld: ")) << error;
}
