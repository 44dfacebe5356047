// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osgEarth's own test maps, as far as they need no network: nothing of them is lost below an effect. They are found in the folder that
// the CMake variable OSGEARTH_SOURCE names, and nothing of them is copied.
#include "EarthMap.h"

#include <osgDB/WriteFile>
#include <osgEarth/Layer>
#include <osgEarth/Map>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

std::string textOf(const fs::path& file)
{
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Whether a map, or a file that it includes, names an address.
bool needsNetwork(const fs::path& file, std::set<fs::path>& met)
{
    if (!met.insert(file).second) return false;
    const std::string text = textOf(file);
    if (text.find("http://") != std::string::npos || text.find("https://") != std::string::npos) return true;
    const std::string mark = "href=\"";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1))
    {
        const std::size_t begin = at + mark.size();
        const fs::path included = file.parent_path() / text.substr(begin, text.find('"', begin) - begin);
        if (fs::is_regular_file(included) && needsNetwork(included, met)) return true;
    }
    return false;
}

std::vector<std::string> localMaps()
{
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(GEOFX_OSGEARTH_SOURCE) / "tests"))
    {
        std::set<fs::path> met;
        if (entry.path().extension() == ".earth" && !needsNetwork(entry.path(), met))
            names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

class OsgEarthsMaps : public EarthMaps, public testing::WithParamInterface<std::string>
{
protected:
    struct Place
    {
        double longitude = -100.0, latitude = 40.0;
    };
    /// The middle of the smallest layer.
    Place middle()
    {
        Place place;
        double least = 1e30;
        osgEarth::LayerVector layers;
        map().getMap()->getLayers(layers);
        for (const auto& layer : layers)
        {
            osgEarth::GeoExtent extent = layer->getExtent();
            if (!extent.isValid()) continue;
            extent = extent.transform(osgEarth::SpatialReference::get("wgs84"));
            if (!extent.isValid() || extent.area() >= least || extent.area() > 5000.0) continue;
            least = extent.area();
            place = {extent.getCentroid().x(), extent.getCentroid().y()};
        }
        return place;
    }
    /// The share of pixels that differ by more than 4 %.
    static double apart(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
            {
                int most = 0;
                for (int channel = 0; channel < 3; ++channel)
                    most = std::max(most, std::abs(a.data(static_cast<unsigned int>(x),
                                                          static_cast<unsigned int>(y))[channel] -
                                                   b.data(static_cast<unsigned int>(x),
                                                          static_cast<unsigned int>(y))[channel]));
                count += most > 10 ? 1 : 0;
            }
        return static_cast<double>(count) / (WIDTH * HEIGHT);
    }
};

} // namespace

TEST_P(OsgEarthsMaps, LoseNothingWhereNothingMoves)
{
    fading = 600;
    const fs::path folder = fs::path(GEOFX_OSGEARTH_SOURCE) / "tests";
    ASSERT_TRUE(showFile((folder / (GetParam() + ".earth")).string()));
    const Place place = middle();
    struct View
    {
        double south, height, pitch; ///< degrees before the place, metres, degrees
    };
    constexpr View views[] = {{0.0, 9e6, -90.0}, {8.0, 9e5, -45.0}, {0.6, 5e4, -35.0}};
    const auto picture = [&](const View& view)
    {
        // Depths that tell a feature from the ground 2 km below it, with 24 bits. Chance would decide otherwise.
        setProjection(view.height / 100.0, 2e7);
        return draw(viewFrom(place.longitude, place.latitude - view.south, view.height, 0.0, view.pitch));
    };
    std::vector<osg::ref_ptr<osg::Image>> plain;
    for (const View& view : views)
        plain.push_back(picture(view));
    ASSERT_TRUE(addExtension(extension("<verticalExaggeration factor=\"1.0005\"/>")));
    const char* const pictures = std::getenv("GEOFX_PICTURES");
    for (std::size_t i = 0; i < plain.size(); ++i)
    {
        const osg::ref_ptr<osg::Image> image = picture(views[i]);
        const double differs = apart(*image, *plain[i]);
        EXPECT_LE(differs, 0.0005) << "view " << i;
        if (!pictures) continue;
        const std::string name = std::string(pictures) + "/" + GetParam() + std::to_string(i);
        osgDB::writeImageFile(*plain[i], name + "a.png");
        osgDB::writeImageFile(*image, name + "b.png");
    }
}

INSTANTIATE_TEST_SUITE_P(Local, OsgEarthsMaps, testing::ValuesIn(localMaps()),
                         [](const auto& info)
                         {
                             std::string name = info.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });
