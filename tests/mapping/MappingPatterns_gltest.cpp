// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Contour lines, graticules, hatching and dots in pictures, against heights, places and degrees that the test works out itself.
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/MappingStage.h>

#include <GeographicLib/Geocentric.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

class MappingPatterns : public MappingStage
{
protected:
    MappingPatterns() : MappingStage(160, 160) {}

    /// A white pattern over all of the ground.
    ColorTransfer& add(ColorTransfer::Pattern pattern, double interval, double width, double half = 1000.0)
    {
        const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setRectangle({0.0, 0.0}, half, half);
        ColorTransfer& transfer = *mapping->getTransfer();
        transfer.setSource(ColorTransfer::CONSTANT);
        transfer.setConstant({1.0, 1.0, 1.0, 1.0});
        transfer.setPattern(pattern);
        transfer.setPatternInterval(interval);
        transfer.setPatternWidth(width);
        _mappings->removeMappings();
        _mappings->addMapping(mapping);
        return transfer;
    }
    void replaceGround(osg::Node* node)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(node);
    }
    /// A grid of vertices over [-1, 1]², where a function has them.
    static osg::ref_ptr<osg::Geometry> mesh(int cells, const std::function<osg::Vec3d(double, double)>& at)
    {
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        const osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
        for (int y = 0; y <= cells; ++y)
        {
            for (int x = 0; x <= cells; ++x)
            {
                vertices->push_back(osg::Vec3(at(2.0 * x / cells - 1.0, 2.0 * y / cells - 1.0)));
                if (x == cells || y == cells) continue;
                const int corner = y * (cells + 1) + x;
                for (const int index : {0, 1, cells + 2, 0, cells + 2, cells + 1})
                    triangles->push_back(static_cast<unsigned int>(corner + index));
            }
        }
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array;
        color->push_back(osg::Vec4(osg::Vec4d(groundColor(), 1.0)));
        geometry->setVertexArray(vertices);
        geometry->setColorArray(color, osg::Array::BIND_OVERALL);
        geometry->addPrimitiveSet(triangles);
        return geometry;
    }
    /// Of something with lines at the multiples of an interval: pixels that must be in a line, or must not, by the distance to the nearest line in
    /// pixels. `known`: how far that may be off.
    void judge(const osg::Image& image, int x, int y, double away, double width, double known)
    {
        const osg::Vec3d color = at(image, x, y);
        if (away < 0.5 * width - 0.5 - known)
        {
            ++_in;
            EXPECT_LT(difference(color, {1.0, 1.0, 1.0}), 0.02) << x << ", " << y << ": " << away;
        }
        else if (away > 0.5 * width + 0.5 + known)
        {
            ++_out;
            EXPECT_LT(difference(color, groundColor()), 0.02) << x << ", " << y << ": " << away;
        }
    }
    int _in = 0, _out = 0;
};

double toNearest(double value, double interval)
{
    return std::abs(value - interval * std::round(value / interval));
}

} // namespace

TEST_F(MappingPatterns, ContoursAreAtTheirHeights)
{
    const auto height = [](double x, double y)
    {
        return 60.0 * std::sin(x / 150.0) + 40.0 * std::cos(y / 120.0);
    };
    replaceGround(mesh(400, [&](double x, double y)
                       { return osg::Vec3d(400.0 * x, 400.0 * y, height(400.0 * x, 400.0 * y)); }));
    add(ColorTransfer::CONTOURS, 20.0, 3.0).setPatternIndex(2);
    lookDown({10.0, -20.0}, 1.5);
    const osg::ref_ptr<osg::Image> image = draw();
    int wide = 0;
    for (int row = 1; row < 159; ++row)
    {
        for (int column = 1; column < 159; ++column)
        {
            const double x = 10.0 + 1.5 * (column + 0.5 - 80.0), y = -20.0 + 1.5 * (row + 0.5 - 80.0);
            const double slope =
                1.5 * std::hypot(0.4 * std::cos(x / 150.0), -40.0 / 120.0 * std::sin(y / 120.0));
            // Summits and saddles, where lines are as wide as the ground is level, are another matter.
            if (slope < 0.3 || 20.0 / slope < 13.0) continue;
            const double value = height(x, y);
            const bool index = toNearest(value, 40.0) < 10.0;
            judge(*image, column, row, toNearest(value, 20.0) / slope, index ? 6.0 : 3.0, 0.35);
            wide += index ? 1 : 0;
        }
    }
    EXPECT_GT(_in, 400);
    EXPECT_GT(_out, 4000);
    EXPECT_GT(wide, 400);
}

TEST_F(MappingPatterns, HatchingAndDotsAreMetresApart)
{
    const double angle = 0.6;
    ColorTransfer& transfer = add(ColorTransfer::HATCHING, 40.0, 4.0);
    transfer.setPatternAngle(angle);
    lookDown({100.0, 50.0}, 2.0);
    osg::ref_ptr<osg::Image> image = draw();
    for (int row = 0; row < 160; ++row)
    {
        for (int column = 0; column < 160; ++column)
        {
            const double x = 100.0 + 2.0 * (column + 0.5 - 80.0), y = 50.0 + 2.0 * (row + 0.5 - 80.0);
            // Clockwise from north, so the lines go along (sin, cos).
            const double across = x * std::cos(angle) - y * std::sin(angle);
            judge(*image, column, row, toNearest(across, 40.0) / 2.0, 4.0, 0.1);
        }
    }
    EXPECT_GT(_in, 2000);
    EXPECT_GT(_out, 10000);
    add(ColorTransfer::DOTS, 40.0, 5.0);
    _in = _out = 0;
    image = draw();
    for (int row = 0; row < 160; ++row)
    {
        for (int column = 0; column < 160; ++column)
        {
            const double x = 100.0 + 2.0 * (column + 0.5 - 80.0), y = 50.0 + 2.0 * (row + 0.5 - 80.0);
            judge(*image, column, row, std::hypot(toNearest(x, 40.0), toNearest(y, 40.0)) / 2.0, 5.0, 0.1);
        }
    }
    EXPECT_GT(_in, 500);
    EXPECT_GT(_out, 10000);
    // Nothing of it is composed beforehand.
    _mappings->setCaching(ProjectiveMappings::AUTOMATIC);
    for (int i = 0; i < 5; ++i)
        draw();
    EXPECT_EQ(_mappings->cacheStatistics().pagedFrames, 0u) << "lines are as wide as the view has them";
}

TEST_F(MappingPatterns, AGraticuleIsAtItsDegreesOnAGlobe)
{
    const double longitude = -157.913, latitude = 21.37;
    const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
    const auto world = [&](double x, double y, double height)
    {
        osg::Vec3d place;
        earth.Forward(y, x, height, place.x(), place.y(), place.z());
        return place;
    };
    const osg::Vec3d middle = world(longitude, latitude, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(middle));
    place->addChild(mesh(60,
                         [&](double x, double y) {
                             return world(longitude + 0.06 * x, latitude + 0.06 * y,
                                          300.0 + 300.0 * std::sin(3.0 * x)) -
                                    middle;
                         }));
    const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
    globe->setEllipsoidModel(new osg::EllipsoidModel);
    globe->addChild(place);
    replaceGround(globe);
    // The frame's origin lies elsewhere.
    _mappings->setGeodeticOrigin(osg::DegreesToRadians(longitude - 0.21),
                                 osg::DegreesToRadians(latitude + 0.17));
    add(ColorTransfer::GRATICULE, 0.01, 4.0, 1e5);
    osg::Vec3d up = middle;
    up.normalize();
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt(world(longitude + 0.01, latitude - 0.04, 6000.0),
                                 world(longitude, latitude, 0.0), up);
    camera.setProjectionMatrixAsPerspective(50.0, 1.0, 10.0, 1e5);
    const osg::ref_ptr<osg::Image> image = draw();
    const DeformedView view(*_scene, camera);
    const auto degrees = [&](double x, double y, osg::Vec2d& at)
    {
        const auto hit = view.pick(x, y);
        double height = 0.0;
        if (hit) earth.Reverse(hit->world.x(), hit->world.y(), hit->world.z(), at.y(), at.x(), height);
        return hit.has_value();
    };
    for (int row = 2; row < 158; row += 3)
    {
        for (int column = 2; column < 158; column += 3)
        {
            osg::Vec2d at, right, above;
            if (!degrees(column + 0.5, row + 0.5, at) || !degrees(column + 1.5, row + 0.5, right) ||
                !degrees(column + 0.5, row + 1.5, above))
                continue;
            const auto pixels = [&](int axis)
            {
                const double slope = std::hypot(right[axis] - at[axis], above[axis] - at[axis]);
                return std::pair(toNearest(at[axis], 0.01) / slope, 0.01 / slope);
            };
            const auto [x, roomX] = pixels(0);
            const auto [y, roomY] = pixels(1);
            if (std::min(roomX, roomY) < 17.0) continue;
            judge(*image, column, row, std::min(x, y), 4.0, 0.4);
        }
    }
    EXPECT_GT(_in, 60);
    EXPECT_GT(_out, 700);
}

TEST_F(MappingPatterns, AGridOnAPlaneHasTheTerrainsCoordinates)
{
    // The ground lies 1000 m around the world's origin, and the frame's origin elsewhere.
    _mappings->setOrigin({-137.5, 61.25});
    ColorTransfer& transfer = add(ColorTransfer::GRATICULE, 50.0, 3.0, 2000.0);
    transfer.setPatternIndex(4);
    lookDown({13.0, 27.0}, 2.0);
    const osg::ref_ptr<osg::Image> image = draw();
    for (int row = 0; row < 160; ++row)
    {
        for (int column = 0; column < 160; ++column)
        {
            const double x = 13.0 + 2.0 * (column + 0.5 - 80.0), y = 27.0 + 2.0 * (row + 0.5 - 80.0);
            const auto reach = [](double value)
            {
                // How far it is from being covered, over the nearest line's half width.
                const double width = toNearest(value, 200.0) < 25.0 ? 6.0 : 3.0;
                return toNearest(value, 50.0) / 2.0 - 0.5 * width;
            };
            judge(*image, column, row, std::min(reach(x), reach(y)) + 0.5 * 3.0, 3.0, 0.1);
        }
    }
    EXPECT_GT(_in, 1500);
    EXPECT_GT(_out, 10000);
}
