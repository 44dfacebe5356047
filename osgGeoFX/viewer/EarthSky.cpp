// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/EarthSky.h>

#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Depth>
#include <osg/Geometry>
#include <osg/Uniform>
#include <osgUtil/CullVisitor>

#include <cmath>

namespace osgGeoFX
{

namespace
{

// Before everything else of the camera's stage.
constexpr int FIRST_BIN = -1000;

/// No bound: it shall count neither for culling nor for near and far.
struct NoBound : public osg::Drawable::ComputeBoundingBoxCallback
{
    osg::BoundingBox computeBound(const osg::Drawable&) const override { return {}; }
};

/// Gives each camera a state with its own place. Doubles become floats only after the Earth's middle has been taken off.
class PlaceOfEye : public osg::NodeCallback
{
public:
    PlaceOfEye(const osg::EllipsoidModel& ellipsoid, const osg::Vec3& air, double haze, EffectScene* scene,
               osg::StateSet& look)
        : _scale(1.0 / ellipsoid.getRadiusEquator(), 1.0 / ellipsoid.getRadiusEquator(),
                 1.0 / ellipsoid.getRadiusPolar()),
          _air(air), _haze(static_cast<float>(haze * ellipsoid.getRadiusEquator())), _scene(scene),
          _look(&look)
    {
    }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osgUtil::CullVisitor* cull = visitor->asCullVisitor();
        if (!cull || (*cull->getProjectionMatrix())(3, 3) != 0.0) return;
        osg::Matrixd modelView = *cull->getModelViewMatrix();
        osg::ref_ptr<EffectScene> scene;
        if (_scene.lock(scene)) modelView.postMult(scene->turnOfHorizon(*cull));
        const osg::Matrixd toWorld = osg::Matrixd::inverse(modelView);
        const osg::Vec3d eye = osg::componentMultiply(toWorld.getTrans(), _scale);
        osg::Matrix3 turn;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                turn(row, column) = static_cast<float>(toWorld(row, column) * _scale[column] / _scale[0]);
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        state->addUniform(new osg::Uniform("geofx_earthTurn", turn));
        state->addUniform(new osg::Uniform("geofx_earthEye", osg::Vec3(eye)));
        state->addUniform(new osg::Uniform("geofx_earthRise", static_cast<float>(eye.length2() - 1.0)));
        state->addUniform(new osg::Uniform("geofx_earthAir", _air));
        state->addUniform(new osg::Uniform("geofx_earthHaze", _haze));
        cull->pushStateSet(_look);
        cull->pushStateSet(state);
        traverse(node, visitor);
        cull->popStateSet();
        cull->popStateSet();
    }

private:
    const osg::Vec3d _scale;
    const osg::Vec3 _air;
    const float _haze;
    const osg::observer_ptr<EffectScene> _scene;
    const osg::ref_ptr<osg::StateSet> _look;
};

} // namespace

double hazeDensity(double visibility)
{
    return -std::log(0.02) / visibility;
}

osg::ref_ptr<osg::Node> makeEarthSky(const osg::EllipsoidModel& ellipsoid, const osg::Vec3& air,
                                     double visibility, EffectScene* scene)
{
    osg::ref_ptr<osg::Geometry> picture = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    corners->push_back({-1.0f, -1.0f, 0.0f});
    corners->push_back({3.0f, -1.0f, 0.0f});
    corners->push_back({-1.0f, 3.0f, 0.0f});
    picture->setVertexArray(corners);
    picture->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    picture->setUseDisplayList(false);
    picture->setUseVertexBufferObjects(true);
    picture->setComputeBoundingBoxCallback(new NoBound);
    picture->setCullingActive(false);

    // No node's, since OSG compiles a scene's programs ahead and gives them uniforms of nodes that stand elsewhere, such as osgEarth's.
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttributeAndModes(
        ShaderLibrary::createProgram("sky of the Earth", "stages/earthsky.vert", "stages/earthsky.frag"),
        osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    state->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false),
                                osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    state->setMode(GL_CULL_FACE, osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED);
    state->setMode(GL_BLEND, osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED);
    state->setRenderBinDetails(FIRST_BIN, "RenderBin");

    osg::ref_ptr<osg::Group> sky = new osg::Group;
    sky->setName("sky of the Earth");
    sky->setCullingActive(false);
    sky->addChild(picture);
    sky->setCullCallback(new PlaceOfEye(ellipsoid, air, hazeDensity(visibility), scene, *state));
    return sky;
}

} // namespace osgGeoFX
