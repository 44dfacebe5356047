// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GlFixture.h>

namespace geofx::test
{

/** Pictures of a small plain with things on it: 300 × 300 m around the origin, x east, y north, z up, seen from
    south and above; the natural horizon lies above the picture. Near and far planes are fixed, and there is no light. */
class BentGround : public GlFixture
{
protected:
    static constexpr int WIDTH = 160;
    static constexpr int HEIGHT = 120;

    BentGround() : GlFixture(WIDTH, HEIGHT) {}
    void SetUp() override;

    /// A wavy ground in many colors; texture coordinates 0 … 6 on unit 0 and unit 1.
    static osg::ref_ptr<osg::Geometry> makeGround();
    /// A box with faces in different colors and its reference at the origin, `size` wide and twice as high.
    static osg::ref_ptr<osg::Geometry> makeBox(float size);
    /// The same somewhere.
    static osg::ref_ptr<osg::MatrixTransform> makeBox(float size, const osg::Vec3d& place);

    static osg::ref_ptr<osgGeoFX::BirdsEyeView> makeBend();
    /// One color all over the middle of the ground.
    static osg::ref_ptr<osgGeoFX::ProjectiveMappings> makePaint();
    /// A scene with a bend and some children.
    static osg::ref_ptr<osgGeoFX::EffectScene>
    makeScene(const std::vector<osg::ref_ptr<osg::Node>>& children);
    /// The same children below a plain group.
    static osg::ref_ptr<osg::Group> makePlain(const std::vector<osg::ref_ptr<osg::Node>>& children);

    /// The same picture, to the last bit.
    static ::testing::AssertionResult same(const osg::Image& a, const osg::Image& b,
                                           const std::string& name = "");
    /// How many pixels differ from the background.
    static int covered(const osg::Image& image);
    /// How many pixels of rows from … to differ between two pictures.
    static int differing(const osg::Image& a, const osg::Image& b, int from = 0, int to = HEIGHT);
};

} // namespace geofx::test
