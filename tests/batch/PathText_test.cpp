// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Names of files go through JSON, whatever their bytes are.
#include <osgGeoFX/batch/PathText.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <random>

using osgGeoFX::PathText;

TEST(PathText, KeepsNamesThatAreUtf8)
{
    for (const std::string name :
         {"", "dem.tif", "a b/c", "Kōʻolau.tif", "山.tif", "\U0001F5FB.tif", "\U0010FFFD"})
        EXPECT_EQ(PathText::path(PathText::of(name)), name);
    for (const std::string name : {"dem.tif", "Kōʻolau.tif", "山.tif", "\U0001F5FB.tif"})
        EXPECT_EQ(PathText::of(name), name);
}

TEST(PathText, TakesAnyBytesThroughJson)
{
    std::mt19937 random(5);
    std::vector<std::string> names = {"m\xe4p.tif",      "\xff\xfe",         "\xc3",
                                      "\xed\xa0\x80",    "\xf4\x8f\xbf\xa4", "\xe0\x80\xaf",
                                      "\xf4\x90\x80\x80"};
    for (int i = 0; i < 2000; ++i)
    {
        std::string name;
        for (unsigned int length = 1 + random() % 12; length > 0; --length)
            name += static_cast<char>(1 + random() % 255);
        names.push_back(name);
    }
    for (const std::string& name : names)
    {
        const nlohmann::json json = PathText::of(name);
        EXPECT_EQ(PathText::path(nlohmann::json::parse(json.dump()).get<std::string>()), name);
    }
}
