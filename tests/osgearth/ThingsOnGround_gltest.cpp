// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What osgEarth draws on its ground, under effects that move the ground: labels and icons, draped shapes, and what has no depth test.
#include "EarthMap.h"

#include <tools/RandomSamples.h>

#include <osgDB/WriteFile>
#include <osgEarth/AnnotationLayer>
#include <osgEarth/IconSymbol>
#include <osgEarth/ImageLayer>
#include <osgEarth/LabelNode>
#include <osgEarth/PlaceNode>
#include <osgEarth/ScreenSpaceLayout>
#include <osgEarth/TextSymbol>
#include <osgUtil/RenderStage>
#include <osgViewer/Renderer>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

struct Kind
{
    const char* name;
    const char* element;
};
const Kind kinds[] = {
    {"Exaggeration", "<verticalExaggeration factor=\"2\"/>"},
    {"BirdsEyeView", "<birdsEyeView/>"},
    {"PedestrianView", "<pedestrianView/>"},
    {"PanoramaMap", "<panoramaMap ripples=\"0\"/>"},
};

struct Rectangle
{
    double west, south, east, north;
};

/// Each effect that moves the ground.
class ThingsOnGround : public EarthMaps, public testing::WithParamInterface<Kind>
{
protected:
    ThingsOnGround() { osgEarth::ScreenSpaceLayout::setDeclutteringEnabled(false); }
    ~ThingsOnGround() override { osgEarth::ScreenSpaceLayout::setDeclutteringEnabled(true); }

    static bool isPedestrian() { return std::string(GetParam().name) == "PedestrianView"; }
    struct Camera
    {
        double longitude, latitude, height, heading, pitch;
    };
    /// Somewhere over the hills, as the effect likes it.
    static Camera anyCamera(Random& random)
    {
        return {random.uniform(10.3, 10.7), random.uniform(0.2, 0.4),
                isPedestrian() ? random.uniform(1200.0, 2000.0) : random.uniform(4000.0, 12000.0),
                random.uniform(-15.0, 15.0),
                isPedestrian() ? random.uniform(-25.0, -10.0) : random.uniform(-40.0, -20.0)};
    }
    /// A place before a camera, near or up to a distance, metres.
    static osg::Vec2d anyPlace(Random& random, const Camera& camera, double farthest)
    {
        constexpr double degree = 111000.0;
        const double distance =
            isPedestrian() ? random.logarithmic(500.0, 0.3 * farthest) : random.logarithmic(2000.0, farthest);
        const double bearing = osg::DegreesToRadians(camera.heading + random.uniform(-25.0, 25.0));
        return {camera.longitude + distance / degree * std::sin(bearing),
                camera.latitude + distance / degree * std::cos(bearing)};
    }
    osg::Matrixd view(const Camera& camera)
    {
        return viewFrom(camera.longitude, camera.latitude, camera.height, camera.heading, camera.pitch);
    }
    /// A place in the frame of the world.
    osg::Vec3d placeAt(double longitude, double latitude, double height)
    {
        osg::Vec3d world;
        osgEarth::GeoPoint(osgEarth::SpatialReference::get("wgs84"), longitude, latitude, height)
            .transform(map().getMapSRS())
            .toWorld(world);
        return world;
    }
    /// Where a place of the eye's space is in the picture, pixels; z ≤ 0 behind the eye.
    osg::Vec3d pixelOf(const osg::Vec3d& place) const
    {
        const osg::Vec4d clip = osg::Vec4d(place, 1.0) * projection();
        return {0.5 * WIDTH * (clip.x() / clip.w() + 1.0), 0.5 * HEIGHT * (clip.y() / clip.w() + 1.0),
                clip.w()};
    }
    static bool isWithin(const osg::Vec3d& pixel, double margin)
    {
        return pixel.z() > 0.0 && pixel.x() > margin && pixel.x() < WIDTH - margin && pixel.y() > margin &&
               pixel.y() < HEIGHT - margin;
    }
    /// Not so far away that a texel of osgEarth's draping is larger than a pixel.
    static std::vector<Rectangle> anyRectangles(Random& random, const Camera& camera)
    {
        std::vector<Rectangle> rectangles;
        for (int i = 0; i < 36; ++i)
        {
            const osg::Vec2d place = anyPlace(random, camera, 25000.0);
            const double most = 0.2 * (place - osg::Vec2d(camera.longitude, camera.latitude)).length();
            rectangles.push_back({place.x(), place.y(), place.x() + random.uniform(0.2, 1.0) * most,
                                  place.y() + random.uniform(0.2, 1.0) * most});
        }
        return rectangles;
    }
    void keep(const osg::Image& image, const std::string& name) const
    {
        const char* const pictures = std::getenv("GEOFX_PICTURES");
        if (pictures)
            osgDB::writeImageFile(image, std::string(pictures) + "/" + GetParam().name + "_" + name + ".png");
    }
};

bool isBelow(const osg::Drawable& drawable, const osg::Node& node)
{
    for (const osg::NodePath& path : drawable.getParentalNodePaths())
        if (std::find(path.begin(), path.end(), &node) != path.end()) return true;
    return false;
}

using Mask = std::vector<bool>;

/// What is red in a picture of green hills.
Mask redOf(const osg::Image& image)
{
    Mask mask;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
        {
            const unsigned char* color =
                image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            mask.push_back(color[0] - std::max(color[1], color[2]) > 75);
        }
    return mask;
}

/// How many pixels of a mask are not within a distance, pixels, of another mask.
int beyond(const Mask& mask, const Mask& other, double distance, int width, int height)
{
    const int reach = static_cast<int>(distance);
    int count = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            if (!mask[static_cast<std::size_t>(y * width + x)]) continue;
            bool near = false;
            for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
                for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
                    near = near || (std::hypot(u - x, v - y) <= distance &&
                                    other[static_cast<std::size_t>(v * width + u)]);
            count += near ? 0 : 1;
        }
    return count;
}

std::string mappingOf(const std::vector<Rectangle>& rectangles)
{
    std::ostringstream text;
    text.precision(10);
    text << "<projectiveMappings><transfer name=\"red\" source=\"constant\" constantColor=\"#ff0000\"/>";
    for (const Rectangle& each : rectangles)
        text << "<mapping transfer=\"red\" west=\"" << each.west << "\" south=\"" << each.south
             << "\" east=\"" << each.east << "\" north=\"" << each.north << "\"/>";
    text << "</projectiveMappings>";
    return text.str();
}

std::string polygonsOf(const std::vector<Rectangle>& rectangles, const std::string& style)
{
    std::ostringstream text;
    text.precision(10);
    text << "<Annotations>";
    for (const Rectangle& each : rectangles)
        text << "<feature><srs>wgs84</srs><geometry>POLYGON((" << each.west << " " << each.south << ", "
             << each.east << " " << each.south << ", " << each.east << " " << each.north << ", " << each.west
             << " " << each.north << ", " << each.west << " " << each.south
             << "))</geometry><style type=\"text/css\">" << style << "</style></feature>";
    text << "</Annotations>";
    return text.str();
}

} // namespace

// The kit's own deformation of the processor says where.
TEST_P(ThingsOnGround, LabelsAndIconsStandWhereItMovesTheirPlaces)
{
    ASSERT_TRUE(show(extension(GetParam().element)));
    ASSERT_TRUE(scene());
    Random random(57);
    struct Thing
    {
        osg::Vec3d place;
        std::array<unsigned char, 3> color = {0, 0, 0}; ///< of an icon
        osg::ref_ptr<osg::Node> node;
        bool isLabel = false;
    };
    std::vector<Thing> things;
    std::vector<Camera> cameras;
    for (int i = 0; i < (fullTest() ? 30 : 2); ++i)
        cameras.push_back(anyCamera(random));
    osg::ref_ptr<osgEarth::AnnotationLayer> layer = new osgEarth::AnnotationLayer;
    map().getMap()->addLayer(layer);
    const int count = fullTest() ? 900 : 80;
    for (int i = 0; i < count; ++i)
    {
        const osg::Vec2d at =
            anyPlace(random, cameras[static_cast<std::size_t>(i) % cameras.size()], 60000.0);
        const double longitude = at.x(), latitude = at.y();
        const double height = random.uniform(100.0, 1000.0);
        const osgEarth::GeoPoint point(osgEarth::SpatialReference::get("wgs84"), longitude, latitude, height,
                                       osgEarth::ALTMODE_ABSOLUTE);
        Thing thing;
        thing.place = placeAt(longitude, latitude, height);
        osg::ref_ptr<osg::Node> node;
        osgEarth::Style style;
        if (i % 3 == 0)
        {
            style.getOrCreate<osgEarth::TextSymbol>()->alignment() =
                osgEarth::TextSymbol::ALIGN_CENTER_CENTER;
            node = new osgEarth::LabelNode(point, "Hill", style);
            thing.isLabel = true;
        }
        else
        {
            thing.color = {static_cast<unsigned char>(255 - i % 16), 0,
                           static_cast<unsigned char>(255 - i / 16 % 256)};
            osg::ref_ptr<osg::Image> image = new osg::Image;
            image->allocateImage(5, 5, 1, GL_RGBA, GL_UNSIGNED_BYTE);
            for (int pixel = 0; pixel < 25; ++pixel)
            {
                std::copy(thing.color.begin(), thing.color.end(), image->data() + 4 * pixel);
                image->data()[4 * pixel + 3] = 255;
            }
            style.getOrCreate<osgEarth::IconSymbol>()->alignment() =
                osgEarth::IconSymbol::ALIGN_CENTER_CENTER;
            node = new osgEarth::PlaceNode(point, "", style, image);
        }
        thing.node = node;
        // Programs put annotations below the map itself, too.
        if (i % 2)
            map().addChild(node);
        else
            layer->addChild(node);
        things.push_back(thing);
    }
    int icons = 0, labels = 0, moved = 0;
    for (std::size_t i = 0; i < cameras.size(); ++i)
    {
        const osg::Matrixd view = this->view(cameras[i]);
        const osg::ref_ptr<osg::Image> image = draw(view);
        keep(*image, "labels" + std::to_string(i));
        const osg::ref_ptr<const DeformationChain> deformation = scene()->deformation(view, projection());
        const std::map<const osg::Drawable*, osg::Vec2d> anchors = laidOut();
        std::vector<osg::Vec3d> pixels;
        for (const Thing& thing : things)
            pixels.push_back(pixelOf(deformation->deform(thing.place * view)));
        for (std::size_t k = 0; k < things.size(); ++k)
        {
            const osg::Vec3d& pixel = pixels[k];
            // All that is beyond a panorama map is one point of its horizon.
            if (!isWithin(pixel, 8.0) || deformation->isBeyond(things[k].place * view)) continue;
            SCOPED_TRACE("camera " + std::to_string(i) + ", thing " + std::to_string(k) + " at " +
                         std::to_string(pixel.x()) + ", " + std::to_string(pixel.y()));
            if ((pixel - pixelOf(things[k].place * view)).length() > 3.0) ++moved;
            const auto found =
                std::find_if(anchors.begin(), anchors.end(),
                             [&](const auto& each) { return isBelow(*each.first, *things[k].node); });
            EXPECT_NE(found, anchors.end());
            if (found == anchors.end()) continue;
            const osg::Vec2d anchor = found->second;
            EXPECT_LE(std::hypot(anchor.x() - pixel.x(), anchor.y() - pixel.y()), 0.05);
            if (things[k].isLabel)
            {
                ++labels;
                continue;
            }
            // Others may stand before it.
            bool alone = true;
            for (std::size_t other = 0; other < things.size(); ++other)
            {
                const double reach = things[other].isLabel ? 25.0 : 8.0;
                alone = alone &&
                        (other == k ||
                         std::hypot(pixels[other].x() - pixel.x(), pixels[other].y() - pixel.y()) > reach ||
                         pixels[other].z() < 0.0);
            }
            if (!alone) continue;
            osg::Vec2d sum;
            int size = 0;
            for (int y = 0; y < HEIGHT; ++y)
                for (int x = 0; x < WIDTH; ++x)
                {
                    const unsigned char* color =
                        image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                    if (!std::equal(things[k].color.begin(), things[k].color.end(), color)) continue;
                    sum += osg::Vec2d(x + 0.5, y + 0.5);
                    ++size;
                }
            EXPECT_GE(size, 16);
            if (size == 0) continue;
            sum /= size;
            // Where a side of it falls between pixels, the layout draws 4 of its 5 rows.
            EXPECT_LE(std::hypot(sum.x() - anchor.x(), sum.y() - anchor.y()), 1.6);
            ++icons;
        }
    }
    EXPECT_GT(icons, 5);
    EXPECT_GT(labels, 0);
    EXPECT_GT(moved, 5);
}

// As a mapping colors it. 500 places with GEOFX_TEST_FULL.
TEST_P(ThingsOnGround, DrapedShapesEndWhereMappingsEnd)
{
    Random random(58);
    const int maps = fullTest() ? 14 : 1;
    for (int i = 0; i < maps; ++i)
    {
        SCOPED_TRACE(i);
        const Camera camera = anyCamera(random);
        const std::vector<Rectangle> rectangles = anyRectangles(random, camera);
        const auto picture = [&](const std::string& layers)
        {
            EXPECT_TRUE(show(layers));
            hideImages();
            return draw(view(camera));
        };
        const osg::ref_ptr<osg::Image> draped =
            picture(polygonsOf(rectangles, "fill:#ff0000; altitude-clamping:terrain-drape;") +
                    extension(GetParam().element));
        const osg::ref_ptr<osg::Image> mapped =
            picture(extension(GetParam().element + mappingOf(rectangles)));
        keep(*draped, "draped" + std::to_string(i));
        keep(*mapped, "mapped" + std::to_string(i));
        const Mask a = redOf(*draped), b = redOf(*mapped);
        EXPECT_GT(std::count(b.begin(), b.end(), true), 50);
        // Single pixels at the corners of far shapes, where a texel is as large as a pixel.
        const auto few = std::count(b.begin(), b.end(), true) / 500;
        EXPECT_LE(beyond(a, b, 1.5, WIDTH, HEIGHT), few);
        EXPECT_LE(beyond(b, a, 1.5, WIDTH, HEIGHT), few);
    }
}

// Features without a depth test, as osgEarth's own examples have them.
TEST_P(ThingsOnGround, TheFarSideOfTheEarthDoesNotShineThrough)
{
    const std::string style =
        "default { render-depth-test:false; render-clip-plane:0; render-max-tess-angle:0.5; fill:#ff0000; }";
    const auto layers = [&](double longitude)
    {
        return "<OGRFeatures name=\"shapes\"><geometry>POLYGON((" + std::to_string(longitude - 20.0) +
               " -20, " + std::to_string(longitude + 20.0) + " -20, " + std::to_string(longitude + 20.0) +
               " 20, " + std::to_string(longitude - 20.0) +
               " 20))</geometry></OGRFeatures><FeatureModel name=\"land\" features=\"shapes\"><styles><style "
               "type=\"text/css\">" +
               style + "</style></styles></FeatureModel>";
    };
    for (const double away : {180.0, 0.0})
    {
        SCOPED_TRACE(away);
        ASSERT_TRUE(show(layers(60.0 - away) + extension(GetParam().element)));
        hideImages();
        for (const double height : {1.5e7, 3e6, 2e5})
        {
            SCOPED_TRACE(height);
            // A bend raises the horizon by which osgEarth leaves features out, and nothing hides them then.
            if (std::string(GetParam().name) == "BirdsEyeView" && height == 3e6) continue;
            const osg::ref_ptr<osg::Image> image = draw(60.0, 0.0, height, 0.0, height > 1e6 ? -90.0 : -30.0);
            keep(*image, "far" + std::to_string(static_cast<int>(away)) + "_" +
                             std::to_string(static_cast<int>(height)));
            const Mask mask = redOf(*image);
            const auto count = std::count(mask.begin(), mask.end(), true);
            EXPECT_EQ(count > 0, away < 90.0) << count;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Moved, ThingsOnGround, testing::ValuesIn(kinds),
                         [](const auto& info) { return std::string(info.param.name); });
