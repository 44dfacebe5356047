// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/CloseUpSamples.h>
#include <tools/GlFixture.h>

#include <osg/Geometry>
#include <osg/Group>

#include <utility>
#include <vector>

namespace geofx::test
{

/** Pictures of close-ups of wavy ground, 1000 m around the origin, x east, y north, z up, without levels of detail. It has
    a texture and a sun. The scene has no effect but the close-ups. */
class CloseUpStage : public GlFixture
{
protected:
    using Effects = std::vector<osg::ref_ptr<osgGeoFX::Effect>>;

    explicit CloseUpStage(int width = 200, int height = 150);
    void SetUp() override;

    static double groundHeight(double x, double y);
    /// With normals and coordinates for one texture.
    static osg::ref_ptr<osg::Geometry> makeHills(double half = 1000.0, int cells = 40);
    /// Houses on a part of the ground.
    static osg::ref_ptr<osg::Geometry> makeHouses();
    static osg::ref_ptr<osgGeoFX::CloseUp> makeCloseUp(const osg::Vec2d& center, double size = 400.0,
                                                       double rise = 300.0);

    void look(const osg::Vec3d& eye, const osg::Vec3d& at, double angle = 45.0);
    /// Somewhere above the ground; rolled, or without perspective, now and then.
    void lookAnyhow(Random& random);
    osg::ref_ptr<osg::Image> draw() { return render(_root); }
    /// A scene with these effects.
    static osg::ref_ptr<osgGeoFX::EffectScene> sceneOf(const Effects& effects, osg::Node* content);
    /// The second picture of such a scene, which takes the place of the one before.
    osg::ref_ptr<osg::Image> picture(const Effects& effects, osg::Node* content);
    /// One picture with each pipeline; both must have drawn what they were asked to.
    std::pair<osg::ref_ptr<osg::Image>, osg::ref_ptr<osg::Image>> drawBoth();

    /// The share of the pixels that are off by more than a tolerance, of 255.
    static double differing(const osg::Image& a, const osg::Image& b, int tolerance = 2);
    static bool same(const osg::Image& a, const osg::Image& b) { return differing(a, b, 0) == 0.0; }

    const int _width;
    const int _height;
    osg::ref_ptr<osg::Group> _root = new osg::Group;
    osg::ref_ptr<osgGeoFX::EffectScene> _scene = new osgGeoFX::EffectScene;
    osg::ref_ptr<osgGeoFX::CloseUps> _closeUps = new osgGeoFX::CloseUps;
};

} // namespace geofx::test
