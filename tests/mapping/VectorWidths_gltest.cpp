// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How wide lines of vector data are in pictures whose styles give them in pixels: straight views and bends.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/geodata/TiledVectors.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/GeofxPlugins.h>
#include <tools/MappingStage.h>
#include <tools/TempDir.h>

#include <GeographicLib/TransverseMercator.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr double lineWidth = 4.0; ///< of the style, pixels
constexpr int enough = 256;       ///< MiB, for the straight views
constexpr double reach = 20000.0; ///< metres of ground around the origin
constexpr double spacing = 1000.0;
const osg::Vec2d zero(5e5, 5.4e6);

/// White lines to the north on dark ground.
class VectorWidths : public MappingStage
{
protected:
    VectorWidths() : MappingStage(1000, 625) {}

    static std::string geographic(double x, double y)
    {
        double latitude = 0.0, longitude = 0.0;
        GeographicLib::TransverseMercator::UTM().Reverse(15.0, x + zero.x() - 5e5, y + zero.y(), latitude,
                                                         longitude);
        char text[80];
        std::snprintf(text, sizeof(text), "[%.10f,%.10f]", longitude, latitude);
        return text;
    }

    void SetUp() override
    {
        MappingStage::SetUp();
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(makeGround(reach, 200));
        std::string lines;
        for (double at = -reach + spacing; at < reach - 1.0; at += spacing)
        {
            std::string line;
            for (double along = -reach + spacing; along < reach - 1.0; along += spacing)
                line += (line.empty() ? "" : ",") + geographic(at, along);
            lines += (lines.empty() ? "[" : ",[") + line + "]";
        }
        _folder.write(
            "lines.geojson",
            R"({"type":"Feature","properties":{},"geometry":{"type":"MultiLineString","coordinates":[)" +
                lines + "]}}");
        _folder.write(
            "lines.sld",
            "<FeatureTypeStyle><Rule><LineSymbolizer><Stroke><CssParameter "
            "name=\"stroke\">#ffffff</CssParameter>"
            "<CssParameter "
            "name=\"stroke-width\">4</CssParameter></Stroke></LineSymbolizer></Rule></FeatureTypeStyle>");
        std::string error;
        const auto vectors = TiledVectors::read((_folder / "lines.geojson").string(), {}, error);
        ASSERT_TRUE(vectors) << error;
        MappingFrame frame;
        frame.globe = false;
        frame.wkt = wktOf(32633);
        frame.origin = LocalOrigin::onPlane(zero);
        const osg::ref_ptr<RasterTiles> tiles = vectors->tiles(frame, std::nullopt, error);
        ASSERT_TRUE(tiles) << error;
        _tiles = tiles;
        fresh(enough);
    }

    /// As if nothing had been seen before.
    void fresh(int megabytes)
    {
        std::string error;
        if (_raster) _mappings->removeRaster(_raster);
        PagedRaster::Options options;
        options.megabytes = megabytes;
        _raster = PagedRaster::create(_tiles, options, error);
        ASSERT_TRUE(_raster) << error;
        ASSERT_TRUE(_mappings->addRaster(_raster));
    }

    osg::ref_ptr<osg::Image> drawSettled() { return MappingStage::drawSettled(*_raster); }

    double whiteAt(const osg::Image& image, const osg::Vec2d& pixel) const
    {
        const auto x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
        const double u = pixel.x() - x, v = pixel.y() - y;
        const auto one = [&](int i, int k)
        {
            const double green = at(image, std::clamp(i, 0, _width - 1), std::clamp(k, 0, _height - 1)).y();
            return (green - groundColor().y()) / (1.0 - groundColor().y());
        };
        return (one(x, y) * (1.0 - u) + one(x + 1, y) * u) * (1.0 - v) +
               (one(x, y + 1) * (1.0 - u) + one(x + 1, y + 1) * u) * v;
    }

    struct Width
    {
        osg::Vec2d place; ///< metres
        osg::Vec2d pixel;
        double pixels = 0.0;
    };
    /// Where other lines are far enough away in the picture.
    std::vector<Width> widths(const osg::Image& image)
    {
        const DeformedView view(*_scene, *viewer().getCamera());
        std::vector<Width> found;
        for (double across = -reach + 2.0 * spacing; across < reach - 1.5 * spacing; across += spacing)
        {
            for (double along = -reach + 1.5 * spacing; along < reach - spacing; along += spacing)
            {
                const auto placeAt = [&](double a, double b)
                {
                    return osg::Vec3d(a, b, 0.0);
                };
                osg::Vec2d middle, before, after, left, right;
                if (!view.project(placeAt(across, along), middle) ||
                    !view.project(placeAt(across, along - 20.0), before) ||
                    !view.project(placeAt(across, along + 20.0), after) ||
                    !view.project(placeAt(across - spacing, along), left) ||
                    !view.project(placeAt(across + spacing, along), right) || !inside(middle, 20.0))
                    continue;
                osg::Vec2d direction = after - before;
                direction.normalize();
                const osg::Vec2d normal(-direction.y(), direction.x());
                const double room =
                    std::min(std::abs((left - middle) * normal), std::abs((right - middle) * normal));
                if (room < 6.0 * lineWidth) continue;
                double sum = 0.0;
                constexpr double step = 0.25;
                for (double t = -room / 2.0; t <= room / 2.0; t += step)
                    sum += step * whiteAt(image, middle - osg::Vec2d(0.5, 0.5) + normal * t);
                const auto hit = view.pick(middle.x(), middle.y());
                if (!hit || (osg::Vec2d(hit->world.x(), hit->world.y()) -
                             osg::Vec2d(placeAt(across, along).x(), placeAt(across, along).y()))
                                    .length() > 50.0)
                    continue;
                found.push_back({{placeAt(across, along).x(), placeAt(across, along).y()}, middle, sum});
            }
        }
        return found;
    }

    /// Looks to the north from so high, and measures.
    void expectWidths(double height, Effect* effect, int megabytes = enough)
    {
        SCOPED_TRACE(testing::Message() << height << " m, " << (effect ? effect->className() : "straight"));
        look({0, -15000.0, height}, {0, -15000.0 + height * 1.5, 0.0}, 50.0);
        if (effect) _scene->addEffect(effect);
        fresh(megabytes);
        const osg::ref_ptr<osg::Image> image = drawSettled();
        std::vector<double> all;
        for (const Width& width : widths(*image))
        {
            EXPECT_LT(width.pixels, 1.5 * lineWidth) << width.place.x() << ", " << width.place.y();
            all.push_back(width.pixels);
        }
        ASSERT_GT(all.size(), 20u);
        std::nth_element(all.begin(), all.begin() + all.size() / 2, all.end());
        EXPECT_GT(all[all.size() / 2], 0.3 * lineWidth);
        EXPECT_EQ(_raster->statistics().coarser, megabytes < enough);
        if (effect) _scene->removeEffect(effect);
    }

    const TempDir _folder;
    osg::ref_ptr<RasterTiles> _tiles;
    osg::ref_ptr<PagedRaster> _raster;
};

} // namespace

// A bend must not ask for tiles that are so much finer than the picture needs that the memory, which is enough for the straight view,
// does not hold them: all would be coarser, and lines wider.
TEST_F(VectorWidths, AreThoseOfTheStyleInBends)
{
    expectWidths(1500.0, nullptr);
    const osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
    expectWidths(1500.0, view);
    view->setContextTilt(0.5);
    expectWidths(1500.0, view);
    expectWidths(4000.0, view);
}

// Tiles are coarser than they should be, and drawn for that.
TEST_F(VectorWidths, AreThoseOfTheStyleWhereTheMemoryIsShort)
{
    expectWidths(1500.0, nullptr, 110);
    const osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
    view->setContextTilt(0.5);
    expectWidths(1500.0, view, 110);
    expectWidths(4000.0, view, 48);
}
