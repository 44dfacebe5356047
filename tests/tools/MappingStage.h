// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GlFixture.h>

#include <osg/Geometry>

#include <functional>
#include <vector>

namespace geofx::test
{

/// Pictures of mappings on a flat dark ground, 1000 m around the origin, x east, y north, z up; there is no light.
class MappingStage : public GlFixture
{
protected:
    explicit MappingStage(int width = 160, int height = 160);
    void SetUp() override;

    static osg::ref_ptr<osg::Geometry> makeGround(double half = 1000.0, int cells = 8);
    static osg::Vec3d groundColor() { return {51 / 255.0, 26 / 255.0, 26 / 255.0}; }

    /// A square of one color with hard edges.
    static osg::ref_ptr<osgGeoFX::ProjectiveMapping> makeSolid(const osg::Vec2d& center, double half,
                                                               const osg::Vec3d& color);
    /// A square with a picture and hard edges.
    static osg::ref_ptr<osgGeoFX::ProjectiveMapping> makePicture(const osg::Vec2d& center, double half,
                                                                 osg::Image* image);
    /// RGBA bytes; the function gets the texels' middles, 0…1.
    static osg::ref_ptr<osg::Image> makeImage(int width, int height,
                                              const std::function<osg::Vec4d(double u, double v)>& color);
    static osg::ref_ptr<osg::Image> makeImage(int side, const osg::Vec3d& color);
    /// Two patterns for makeImage(): one that varies in all four channels, and one with sharp borders.
    static osg::Vec4d waves(double u, double v);
    static osg::Vec4d stripes(double u, double v);
    /// A color of its own for each number, far from the ground's.
    static osg::Vec3d colorOf(int number);

    /// Straight down and without perspective; a pixel spans so many metres, the heading is clockwise from north.
    void lookDown(const osg::Vec2d& at, double pixel, double heading = 0.0);
    void look(const osg::Vec3d& eye, const osg::Vec3d& at, double angle = 45.0);
    /// Where the camera has a place of the world, pixels; the first one's middle is (0.5, 0.5).
    osg::Vec2d pixelOf(const osg::Vec3d& world);
    osg::Vec2d pixelOf(const osg::Vec2d& ground) { return pixelOf(osg::Vec3d(ground, 0.0)); }
    bool inside(const osg::Vec2d& pixel, double border = 0.0) const;

    osg::ref_ptr<osg::Image> draw() { return render(_scene); }
    /// When a raster has all tiles that the picture needs.
    osg::ref_ptr<osg::Image> drawSettled(const osgGeoFX::PagedRaster& raster);
    static osg::Vec3d at(const osg::Image& image, int x, int y);
    static osg::Vec3d at(const osg::Image& image, const osg::Vec2d& pixel);
    /// The largest difference of a channel.
    static double difference(const osg::Vec3d& a, const osg::Vec3d& b);
    /// Rounding to bytes, in the texture and in the picture.
    static constexpr double tolerance = 2.0 / 255.0;
    static bool alike(const osg::Vec3d& a, const osg::Vec3d& b) { return difference(a, b) <= tolerance; }
    static ::testing::AssertionResult same(const osg::Image& a, const osg::Image& b);
    /// How many pixels are further off than the tolerance.
    static int differing(const osg::Image& a, const osg::Image& b);

    const int _width;
    const int _height;
    osg::ref_ptr<osgGeoFX::ProjectiveMappings> _mappings = new osgGeoFX::ProjectiveMappings;
    osg::ref_ptr<osgGeoFX::EffectScene> _scene = new osgGeoFX::EffectScene;
};

} // namespace geofx::test
