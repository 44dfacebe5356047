// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A road round the south of Oahu, a river and a town on a panorama map: lines are closed at every zoom.
#include <osgGeoFX/geodata/StrokeVectors.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/TempDir.h>

#include <osg/Math>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int width = 640, height = 480;

/// Longitudes and latitudes: along the coast from Nanakuli over Honolulu, and up the plain's middle.
const char* const road = "[-158.15,21.38],[-158.11,21.33],[-158.05,21.34],[-157.99,21.37],[-157.93,21.365],"
                         "[-157.87,21.32],[-157.83,21.29],[-157.78,21.28],[-157.71,21.29],[-157.67,21.31]";
const char* const river = "[-158.01,21.39],[-158.02,21.43],[-158.03,21.47],[-158.02,21.51]";
const char* const town = "[[-158.06,21.35],[-158.01,21.35],[-158.01,21.38],[-158.06,21.38],[-158.06,21.35]]";

class PanoramaLines : public GlFixture
{
protected:
    const TempDir _folder;

    void add(std::vector<StrokeLines::Line>& lines, StrokeLines::Kind kind, const std::string& type,
             const std::string& coordinates)
    {
        const auto file = _folder.write(type + std::to_string(kind) + ".geojson",
                                        "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"" +
                                            type + "\",\"coordinates\":[" + coordinates + "]}}");
        MappingFrame frame;
        frame.globe = true;
        std::string error;
        EXPECT_TRUE(StrokeVectors::read(file.string(), "", kind, frame, lines, error)) << error;
    }

    osg::ref_ptr<StrokeLines> lines()
    {
        std::vector<StrokeLines::Line> all;
        add(all, StrokeLines::ROAD, "LineString", road);
        add(all, StrokeLines::RIVER, "LineString", river);
        add(all, StrokeLines::TOWN, "Polygon", town);
        osg::ref_ptr<StrokeLines> result = new StrokeLines;
        EXPECT_TRUE(result->set(StrokeLines::DEGREES, all));
        return result;
    }
};

osg::Matrixd viewFrom(const Scene& scene, const std::string& place)
{
    std::string error;
    const std::optional<ViewPoint> point = ViewPoint::parse(place, error);
    osg::Matrixd view;
    EXPECT_TRUE(point && point->viewMatrix(*scene.reference, view)) << error;
    return view;
}

osg::ref_ptr<osg::Image> draw(const Scene& scene, const osg::Matrixd& view, const char* name)
{
    SceneRenderer::Options options;
    options.width = width;
    options.height = height;
    std::string error;
    FrameStatistics statistics;
    const std::unique_ptr<SceneRenderer> renderer = SceneRenderer::create(scene, options, error);
    osg::ref_ptr<osg::Image> picture = renderer ? renderer->render(view, 0.0, statistics, error) : nullptr;
    EXPECT_TRUE(picture) << error;
    // To be looked at.
    const char* folder = std::getenv("GEOFX_KEEP_PICTURES");
    if (picture && folder) osgDB::writeImageFile(*picture, std::string(folder) + "/" + name + ".png");
    return picture;
}

double difference(const osg::Image& a, const osg::Image& b, int x, int y)
{
    if (x < 0 || y < 0 || x >= width || y >= height) return 0.0;
    const auto column = static_cast<unsigned int>(x), row = static_cast<unsigned int>(y);
    return static_cast<double>((a.getColor(column, row) - b.getColor(column, row)).length());
}

TEST_F(PanoramaLines, ARoadIsClosedAtEveryZoom)
{
    const std::optional<Scene> oahu = loadOahu("oahu");
    if (!oahu) return;
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setReflection(0.0); // so that nothing but the strokes differs
    oahu->effects->addEffect(map);
    const osg::ref_ptr<StrokeLines> all = lines();
    const std::vector<osg::Vec2d>& points = all->getLines()[0].points;
    struct Zoom
    {
        double radius; ///< metres
        int parts;     ///< of each kilometre of the road that are looked at
    };
    for (const auto& [radius, parts] : {Zoom{28000.0, 1}, Zoom{9000.0, 2}, Zoom{3000.0, 12}})
    {
        if (!fullTest() && radius == 9000.0) continue;
        SCOPED_TRACE(radius);
        map->setViewRadius(radius);
        const double base = 21.365 - 1.2 * radius / 111e3;
        const osg::Matrixd view = viewFrom(*oahu, "-157.95," + std::to_string(base) + ",20000,0,-45");
        map->setLines(nullptr);
        const osg::ref_ptr<osg::Image> without = draw(*oahu, view, "without");
        map->setLines(all);
        const osg::ref_ptr<osg::Image> with =
            draw(*oahu, view, ("lines-" + std::to_string(static_cast<int>(radius))).c_str());
        ASSERT_TRUE(with && without);

        const DeformedView seen(
            *oahu->effects, view,
            osg::Matrixd::perspective(30.0, static_cast<double>(width) / height, 10.0, 1e6), width, height);
        int asked = 0, drawn = 0;
        for (std::size_t i = 1; i < points.size(); ++i)
        {
            for (int j = 0; j < parts; ++j)
            {
                const osg::Vec2d at =
                    points[i - 1] + (points[i] - points[i - 1]) * (static_cast<double>(j) / parts);
                const double longitude = osg::DegreesToRadians(at.x()),
                             latitude = osg::DegreesToRadians(at.y());
                double ground = 10.0, there[2] = {};
                osg::Vec2d pixel;
                bool within = true;
                // Twice, since the ground's height is not known at first.
                for (int turn = 0; turn < 2 && within; ++turn)
                {
                    within =
                        seen.project(longitude, latitude, ground, *oahu->reference, pixel) &&
                        std::min(pixel.x(), pixel.y()) > 4.0 && pixel.x() < width - 4.0 &&
                        pixel.y() < height - 4.0 &&
                        seen.unproject(pixel.x(), pixel.y(), *oahu->reference, there[0], there[1], ground);
                }
                if (!within) continue;
                // Where it is behind a hill, the pixel shows another place.
                const double off =
                    6371000.0 * std::hypot((there[0] - longitude) * std::cos(latitude), there[1] - latitude);
                if (off > 2.0 * radius / width) continue;
                ++asked;
                double most = 0.0;
                for (int dy = -2; dy <= 2; ++dy)
                    for (int dx = -2; dx <= 2; ++dx)
                        most = std::max(most, difference(*with, *without, static_cast<int>(pixel.x()) + dx,
                                                         static_cast<int>(pixel.y()) + dy));
                drawn += most > 0.1 ? 1 : 0;
            }
        }
        std::cout << "radius " << radius << " m: " << drawn << " of " << asked << " places of the road"
                  << std::endl;
        EXPECT_GT(asked, 20);
        EXPECT_GE(drawn, 0.98 * asked);
    }
}

} // namespace
