// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where the ground overlays of a KMZ file lie on pictures, against GeographicLib: a hundred on a globe, up to 80° of latitude and over
// the antimeridian, and on a projected terrain. GDAL writes the file.
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/GeofxPlugins.h>
#include <tools/KmlFiles.h>
#include <tools/MappingStage.h>
#include <tools/Outlines.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>

#include <algorithm>
#include <array>
#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

using Place = osg::Vec2d; // degrees of longitude and latitude
using Corners = std::array<Place, 4>;
using World = std::function<osg::Vec3d(const Place&)>;

osg::Vec3d onEarth(const Place& place)
{
    osg::Vec3d p;
    GeographicLib::Geocentric::WGS84().Forward(place.y(), place.x(), 0.0, p.x(), p.y(), p.z());
    return p;
}

class OverlayPlaces : public MappingStage
{
protected:
    OverlayPlaces() : MappingStage(480, 360) {}

    /// Overlays in a grid around a place, as quadrilaterals and as boxes, which shows 25 of them.
    std::string features(const Place& middle, double halfX, double halfY)
    {
        std::string text;
        for (int i = 0; i < 25; ++i)
        {
            const auto number = static_cast<int>(_overlays.size());
            Random random(static_cast<std::uint64_t>(number));
            const Place center(middle.x() + halfX * (i % 5 - 2) / 2.6,
                               middle.y() + halfY * (i / 5 - 2) / 2.6);
            const osg::Vec2d half(0.14 * halfX, 0.14 * halfY);
            Corners corners = {center - half, center + osg::Vec2d(half.x(), -half.y()), center + half,
                               center + osg::Vec2d(-half.x(), half.y())};
            char coordinates[400];
            std::string place;
            if (i % 2 == 0)
            {
                for (Place& corner : corners)
                    corner += osg::Vec2d(random.uniform(-0.3, 0.3) * half.x(),
                                         random.uniform(-0.3, 0.3) * half.y());
                std::snprintf(coordinates, sizeof(coordinates),
                              "<gx:LatLonQuad><coordinates>%.12f,%.12f %.12f,%.12f %.12f,%.12f %.12f,%.12f"
                              "</coordinates></gx:LatLonQuad>",
                              std::remainder(corners[0].x(), 360.0), corners[0].y(),
                              std::remainder(corners[1].x(), 360.0), corners[1].y(),
                              std::remainder(corners[2].x(), 360.0), corners[2].y(),
                              std::remainder(corners[3].x(), 360.0), corners[3].y());
                place = coordinates;
            }
            else
            {
                std::snprintf(
                    coordinates, sizeof(coordinates),
                    "<LatLonBox><north>%.12f</north><south>%.12f</south><east>%.12f</east><west>%.12f</west>"
                    "</LatLonBox>",
                    corners[2].y(), corners[0].y(), std::remainder(corners[1].x(), 360.0),
                    std::remainder(corners[0].x(), 360.0));
                place = coordinates;
            }
            const std::string name = std::to_string(number) + ".png";
            const osg::Vec3d color = colorOf(number);
            writePicture(
                (_folder / name).string(), 32, 32,
                [&](int x, int y)
                {
                    // Its upper right quarter is brighter, to tell how it is turned.
                    const double more = x >= 16 && y < 16 ? 0.5 : 0.0;
                    const auto part = [&](double c)
                    {
                        return static_cast<int>(std::lround(255.0 * (c + more * (1.0 - c))));
                    };
                    return std::array<int, 4>{part(color.x()), part(color.y()), part(color.z()), 255};
                });
            _entries.emplace_back(name, bytesOf((_folder / name).string()));
            text += groundOverlay(name, place);
            _overlays.push_back(corners);
        }
        return text;
    }

    void show(const std::string& text, bool globe)
    {
        std::vector<std::pair<std::string, std::string>> entries = _entries;
        entries.emplace_back("doc.kml", kml(text));
        const std::string file = (_folder / "overlays.kmz").string();
        writeArchive(file, entries);
        OverlayReader reader;
        reader.globe = globe;
        reader.wkt = globe ? std::string() : wktOf(32604);
        std::string error;
        ASSERT_TRUE(reader.read(file, {}, error)) << error;
        ASSERT_EQ(reader.overlays.size(), _overlays.size());
        _scene->removeEffect(_mappings);
        for (const LocalOrigin& origin : reader.frames)
        {
            const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
            effect->setLocalOrigin(origin);
            _scene->addEffect(effect);
            _effects.push_back(effect);
        }
        for (const GroundOverlay& overlay : reader.overlays)
            _effects[overlay.frame]->addMapping(overlay.makeMapping());
    }

    osg::ref_ptr<osg::Node> groundAround(const Place& middle, double halfX, double halfY, const World& world)
    {
        const osg::ref_ptr<osg::Geometry> ground = makeGround(1.0, 160);
        const osg::Vec3d center = world(middle);
        for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*ground->getVertexArray()))
            vertex = osg::Vec3(world(middle + osg::Vec2d(halfX * static_cast<double>(vertex.x()),
                                                         halfY * static_cast<double>(vertex.y()))) -
                               center);
        ground->dirtyBound();
        osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(osg::Matrix::translate(center));
        node->addChild(ground);
        return node;
    }

    /// Those from `first` on that the picture shows as a whole: each pixel more than one from the outline is the overlay's within it,
    /// and not outside of it. What is filtered across an edge belongs to the one that it is more like.
    void expectOutlines(std::size_t first, const World& world)
    {
        const osg::ref_ptr<osg::Image> image = draw();
        const DeformedView view(*_scene, *viewer().getCamera());
        int seen = 0;
        for (std::size_t i = first; i < first + 25; ++i)
        {
            std::vector<osg::Vec2d> outline;
            osg::Vec2d low(1e9, 1e9), high(-1e9, -1e9);
            constexpr int pieces = 8;
            for (std::size_t c = 0; c < 4 * pieces; ++c)
            {
                const Place& a = _overlays[i][c / pieces];
                const Place& b = _overlays[i][(c / pieces + 1) % 4];
                osg::Vec2d pixel;
                ASSERT_TRUE(
                    view.project(world(a + (b - a) * (static_cast<double>(c % pieces) / pieces)), pixel));
                outline.push_back(pixel);
                low.set(std::min(low.x(), pixel.x()), std::min(low.y(), pixel.y()));
                high.set(std::max(high.x(), pixel.x()), std::max(high.y(), pixel.y()));
            }
            if (!inside(low, 4.0) || !inside(high, 4.0)) continue;
            const osg::Vec3d color = colorOf(static_cast<int>(i));
            const osg::Vec3d bright = color + (osg::Vec3d(1.0, 1.0, 1.0) - color) * 0.5;
            int within = 0, wrong = 0;
            for (int y = static_cast<int>(low.y()) - 3; y <= static_cast<int>(high.y()) + 3; ++y)
            {
                for (int x = static_cast<int>(low.x()) - 3; x <= static_cast<int>(high.x()) + 3; ++x)
                {
                    const double depth = insideOf(outline, osg::Vec2d(x + 0.5, y + 0.5));
                    const osg::Vec3d here = at(*image, x, y);
                    const bool ground = (here - groundColor()).length() <
                                        std::min((here - color).length(), (here - bright).length());
                    within += depth > 1.0 ? 1 : 0;
                    wrong += (depth > 1.0 && ground) || (depth < -1.0 && !ground) ? 1 : 0;
                }
            }
            EXPECT_EQ(wrong, 0) << "overlay " << i << " of " << within << " pixels";
            EXPECT_GT(within, 60) << "overlay " << i;
            // How it is turned, and whose colors it has.
            const std::array<osg::Vec2d, 4> quarters = {
                osg::Vec2d(0.25, 0.25), {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}};
            for (std::size_t q = 0; q < 4; ++q)
            {
                const double u = quarters[q].x(), v = quarters[q].y();
                const Corners& c = _overlays[i];
                osg::Vec2d pixel;
                ASSERT_TRUE(view.project(world(c[0] * ((1 - u) * (1 - v)) + c[1] * (u * (1 - v)) +
                                               c[2] * (u * v) + c[3] * ((1 - u) * v)),
                                         pixel));
                EXPECT_TRUE(alike(at(*image, pixel), q == 2 ? bright : color))
                    << "overlay " << i << ", quarter " << q;
            }
            ++seen;
        }
        EXPECT_GE(seen, 20);
    }

    void lookAt(const Place& middle, const osg::Vec3d& up, const osg::Vec3d& north, double half,
                const World& world)
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(world(middle) + up * (3.2 * half) - north * (0.8 * half), world(middle),
                                     north);
        camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(_width) / _height, 0.05 * half,
                                                20.0 * half);
    }

    TempDir _folder;
    std::vector<Corners> _overlays;
    std::vector<std::pair<std::string, std::string>> _entries;
    std::vector<osg::ref_ptr<ProjectiveMappings>> _effects;
};

struct Region
{
    Place middle;
    double half; ///< metres
};

} // namespace

TEST_F(OverlayPlaces, AHundredOnAGlobe)
{
    const World world = onEarth;
    // Small and large ones; over the antimeridian; at 80° north, and so in the south.
    const Region regions[] = {{{-158.0, 21.45}, 4000.0},
                              {{179.98, -17.0}, 150000.0},
                              {{20.0, 80.0}, 20000.0},
                              {{-60.0, -78.0}, 300000.0}};
    const auto halfOf = [](const Region& region)
    {
        const double halfY = region.half / 111000.0;
        return osg::Vec2d(halfY / std::cos(osg::DegreesToRadians(region.middle.y())), halfY);
    };
    std::string text;
    for (const Region& region : regions)
        text += features(region.middle, halfOf(region).x(), halfOf(region).y());
    ASSERT_EQ(_overlays.size(), 100u);
    show(text, true);
    EXPECT_GE(_effects.size(), 2u);
    EXPECT_LE(_effects.size(), 7u);
    for (std::size_t i = 0; i < std::size(regions); ++i)
    {
        SCOPED_TRACE(i);
        const Region& region = regions[i];
        const osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode;
        node->setEllipsoidModel(new osg::EllipsoidModel);
        node->addChild(
            groundAround(region.middle, 1.5 * halfOf(region).x(), 1.5 * halfOf(region).y(), world));
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(node);
        std::vector<double> turn(9);
        osg::Vec3d foot;
        GeographicLib::Geocentric::WGS84().Forward(region.middle.y(), region.middle.x(), 0.0, foot.x(),
                                                   foot.y(), foot.z(), turn);
        lookAt(region.middle, {turn[2], turn[5], turn[8]}, {turn[1], turn[4], turn[7]}, region.half, world);
        expectOutlines(25 * i, world);
    }
}

TEST_F(OverlayPlaces, AHundredOnAProjectedTerrain)
{
    const World world = [](const Place& place)
    {
        int zone = 0;
        bool north = false;
        double x = 0.0;
        double y = 0.0;
        GeographicLib::UTMUPS::Forward(place.y(), place.x(), zone, north, x, y, 4);
        return osg::Vec3d(x, y, 0.0);
    };
    const Region regions[] = {{{-157.9, 21.4}, 3000.0},
                              {{-157.0, 22.0}, 30000.0},
                              {{-159.5, 60.0}, 90000.0},
                              {{-161.0, 78.0}, 20000.0}};
    const auto halfOf = [](const Region& region)
    {
        const double halfY = region.half / 111000.0;
        return osg::Vec2d(halfY / std::cos(osg::DegreesToRadians(region.middle.y())), halfY);
    };
    std::string text;
    for (const Region& region : regions)
        text += features(region.middle, halfOf(region).x(), halfOf(region).y());
    show(text, false);
    ASSERT_EQ(_effects.size(), 1u);
    for (std::size_t i = 0; i < std::size(regions); ++i)
    {
        SCOPED_TRACE(i);
        const Region& region = regions[i];
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(
            groundAround(region.middle, 1.5 * halfOf(region).x(), 1.5 * halfOf(region).y(), world));
        lookAt(region.middle, osg::Z_AXIS, osg::Y_AXIS, region.half, world);
        expectOutlines(25 * i, world);
    }
}

// A frame's plane has each of its places twice, on this side of the globe and on the other one.
TEST_F(OverlayPlaces, NothingShowsOnTheOtherSideOfTheGlobe)
{
    const World world = onEarth;
    const Place here(10.0, 0.5), there(-169.0, -0.5); // within the overlay; mirrored by the frame's plane
    _overlays.push_back({});
    writePicture((_folder / "a.png").string(), 8, 8,
                 [](int, int) {
                     return std::array<int, 4>{255, 255, 0, 255};
                 });
    _entries.emplace_back("a.png", bytesOf((_folder / "a.png").string()));
    show(groundOverlay("a.png", latLonBox(5.0, -4.0, 17.0, 4.0)), true);
    auto* const effect = dynamic_cast<ProjectiveMappings*>(_scene->getEffect(0));
    ASSERT_TRUE(effect);
    for (const auto caching : {ProjectiveMappings::OFF, ProjectiveMappings::AUTOMATIC})
    {
        effect->setCaching(caching);
        for (const Place& middle : {here, there})
        {
            const osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode;
            node->setEllipsoidModel(new osg::EllipsoidModel);
            node->addChild(groundAround(middle, 1.0, 1.0, world));
            _scene->removeChildren(0, _scene->getNumChildren());
            _scene->addChild(node);
            osg::Vec3d up = world(middle);
            up.normalize();
            lookAt(middle, up, osg::Z_AXIS, 100000.0, world);
            const std::uint64_t before = effect->cacheStatistics().pagedFrames;
            for (int frame = 0; frame < 30; ++frame)
                draw();
            const osg::Vec3d color = at(*draw(), _width / 2, _height / 2);
            EXPECT_TRUE(alike(color, middle == here ? osg::Vec3d(1.0, 1.0, 0.0) : groundColor()))
                << middle.x() << ": " << color.x() << " " << color.y() << " " << color.z();
            EXPECT_EQ(effect->cacheStatistics().pagedFrames > before, caching != ProjectiveMappings::OFF)
                << effect->cacheStatistics().reason;
        }
    }
}

namespace
{

/// A color that tells a place on the globe, without a jump anywhere: its direction from the Earth's center.
std::array<int, 4> directionColor(double longitude, double latitude)
{
    const double x = osg::DegreesToRadians(longitude), y = osg::DegreesToRadians(latitude);
    const auto part = [](double c)
    {
        return static_cast<int>(std::lround(127.5 + 110.0 * c));
    };
    return {part(std::cos(y) * std::cos(x)), part(std::cos(y) * std::sin(x)), part(std::sin(y)), 255};
}

class OverlayAround : public OverlayPlaces
{
protected:
    /// Pictures of parts of the globe must have, pixel by pixel, the color of the place that they show.
    void expectDirections(const std::string& file, double texel)
    {
        const World world = onEarth;
        OverlayReader reader;
        std::string error;
        ASSERT_TRUE(reader.read(file, {}, error)) << error;
        EXPECT_EQ(reader.frames.size(), 6u);
        _scene->removeEffect(_mappings);
        for (const LocalOrigin& origin : reader.frames)
        {
            _effects.push_back(new ProjectiveMappings);
            _effects.back()->setLocalOrigin(origin);
            _effects.back()->setPageSide(1024);
            _scene->addEffect(_effects.back());
        }
        for (const GroundOverlay& overlay : reader.overlays)
            _effects[overlay.frame]->addMapping(overlay.makeMapping());
        // Middles, edges and corners of the six parts, the antimeridian, the poles.
        for (const Place& middle :
             {Place(0.0, 0.0), Place(45.0, 0.0), Place(45.0, 35.26), Place(180.0, 10.0), Place(-135.0, -35.0),
              Place(20.0, 89.9), Place(-70.0, -89.9), Place(-90.0, 45.0)})
        {
            SCOPED_TRACE(::testing::Message() << middle.x() << ", " << middle.y());
            osg::Matrixd frame;
            osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
                osg::DegreesToRadians(middle.y()), osg::DegreesToRadians(middle.x()), 0.0, frame);
            const osg::Vec3d center = frame.getTrans();
            const auto placeAt = [&](double x, double y)
            {
                const osg::Vec3d position = osg::Vec3d(x, y, 0.0) * frame;
                Place place;
                double height = 0.0;
                GeographicLib::Geocentric::WGS84().Reverse(position.x(), position.y(), position.z(),
                                                           place.y(), place.x(), height);
                return place;
            };
            // A cap around the place.
            const osg::ref_ptr<osg::Geometry> ground = makeGround(2e6, 160);
            for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*ground->getVertexArray()))
                vertex = osg::Vec3(
                    world(placeAt(static_cast<double>(vertex.x()), static_cast<double>(vertex.y()))) -
                    center);
            ground->dirtyBound();
            const osg::ref_ptr<osg::MatrixTransform> moved =
                new osg::MatrixTransform(osg::Matrix::translate(center));
            moved->addChild(ground);
            const osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode;
            node->setEllipsoidModel(new osg::EllipsoidModel);
            node->addChild(moved);
            _scene->removeChildren(0, _scene->getNumChildren());
            _scene->addChild(node);
            osg::Vec3d up = center;
            up.normalize();
            lookAt(middle, up, osg::Matrixd::transform3x3(osg::Y_AXIS, frame), 1e6, world);
            const osg::ref_ptr<osg::Image> image = draw();
            const DeformedView view(*_scene, *viewer().getCamera());
            int seen = 0, wrong = 0;
            double most = 0.0;
            for (int i = 0; i < 41 * 41; ++i)
            {
                const Place place = placeAt(-1e6 + 5e4 * (i % 41), -7e5 + 3.5e4 * (i / 41));
                osg::Vec2d pixel;
                if (!view.project(world(place), pixel) || !inside(pixel, 2.0)) continue;
                ++seen;
                const std::array<int, 4> expected = directionColor(place.x(), place.y());
                const double off =
                    difference(at(*image, pixel), osg::Vec3d(expected[0], expected[1], expected[2]) / 255.0);
                most = std::max(most, off);
                // A color's change over a texel, beside rounding.
                wrong += off > 2.5 / 255.0 + 110.0 / 255.0 * texel ? 1 : 0;
            }
            EXPECT_GT(seen, 800);
            EXPECT_EQ(wrong, 0) << "of " << seen << "; at most " << 255.0 * most << " of 255";
        }
    }
};

} // namespace

// The whole world as an overlay of KML, and as a raster in degrees.
TEST_F(OverlayAround, AMapOfTheWorldAsAGroundOverlay)
{
    writePicture((_folder / "world.png").string(), 1440, 720,
                 [](int x, int y)
                 { return directionColor(-180.0 + (x + 0.5) / 4.0, 90.0 - (y + 0.5) / 4.0); });
    _folder.write("doc.kml", kml(groundOverlay("world.png", latLonBox(-180.0, -90.0, 180.0, 90.0))));
    expectDirections((_folder / "doc.kml").string(), osg::DegreesToRadians(0.25));
}

TEST_F(OverlayAround, AMapOfTheWorldAsARaster)
{
    TestRaster raster(1440, 720, 3, GDT_Byte);
    raster.placed(-180.0, 90.0, 0.25, 0.25).crs("EPSG:4326");
    raster.fill(
        [](int x, int y, int band) {
            return directionColor(-180.0 + (x + 0.5) / 4.0,
                                  90.0 - (y + 0.5) / 4.0)[static_cast<std::size_t>(band)];
        });
    expectDirections(raster.write(_folder / "world.tif"), osg::DegreesToRadians(0.25));
}
