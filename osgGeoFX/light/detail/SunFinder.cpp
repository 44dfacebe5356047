// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/SunFinder.h>

#include <osg/Camera>
#include <osg/LightSource>
#include <osg/Transform>
#include <osg/View>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

/// A light, and the matrix that leads from its frame to the eye space of the camera.
struct LightAt
{
    const osg::Light* light = nullptr;
    osg::Matrixd toEye;
};

/// The last light with the number 0, and the last one of the others that has a direction.
struct Lights
{
    LightAt first;
    const osg::Light* other = nullptr;

    void meet(const osg::Light* light, const osg::Matrixd& toEye)
    {
        if (!light) return;
        if (light->getLightNum() == 0)
            first = {light, toEye};
        else if (light->getPosition().w() == 0.0f)
            other = light;
    }
};

/** Meets the lights that OSG's culling will come to after the scene: it takes the same way, by switches and levels of detail,
    but goes only where something is not to be culled, as lights are not. */
class LightsBehind : public osg::NodeVisitor
{
public:
    LightsBehind(osgUtil::CullVisitor& outer, Lights& lights)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN), _lights(lights),
          _lodScale(static_cast<double>(outer.getLODScale()))
    {
        setTraversalMask(outer.getTraversalMask());
        setNodeMaskOverride(outer.getNodeMaskOverride());
        setFrameStamp(const_cast<osg::FrameStamp*>(outer.getFrameStamp()));
        // What stands around a nested camera has lights of its own.
        const osg::NodePath& path = outer.getNodePath();
        const auto camera = std::find_if(path.rbegin(), path.rend(),
                                         [](const osg::Node* node) { return node->asCamera() != nullptr; });
        _way.assign(camera.base(), path.end());
        if (_way.empty()) return;
        _toEye = osg::computeWorldToLocal(_way) * *outer.getModelViewMatrix();
        _way.front()->accept(*this);
    }

    using osg::NodeVisitor::apply;
    void apply(osg::Node& node) override
    {
        if (_behind)
        {
            if (!node.getCullingActive() || node.getNumChildrenWithCullingDisabled() > 0) traverse(node);
            return;
        }
        if (&node != _way[_depth]) return;
        _behind = ++_depth == _way.size();
        if (!_behind) traverse(node);
    }
    void apply(osg::Transform& node) override
    {
        const osg::Matrixd former = _toEye;
        node.computeLocalToWorldMatrix(_toEye, this);
        apply(static_cast<osg::Node&>(node));
        _toEye = former;
    }
    void apply(osg::LightSource& node) override
    {
        if (_behind)
            _lights.meet(node.getLight(),
                         node.getReferenceFrame() == osg::LightSource::RELATIVE_RF ? _toEye : osg::Matrixd());
        apply(static_cast<osg::Node&>(node));
    }
    void apply(osg::Camera&) override {}
    float getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const override
    {
        return static_cast<float>((osg::Vec3d(position) * _toEye).length() *
                                  (withLodScale ? _lodScale : 1.0));
    }

private:
    Lights& _lights;
    const double _lodScale;
    osg::NodePath _way; ///< to the scene
    std::size_t _depth = 0;
    bool _behind = false; ///< whether the scene has been passed
    osg::Matrixd _toEye;
};

/// What the stage knows already, in the order in which OSG applies it.
void meetLightsOfStage(osgUtil::CullVisitor& outer, Lights& lights)
{
    const osg::View* const view = outer.getCurrentCamera()->getView();
    const osg::Light* const headlight =
        view && view->getLightingMode() == osg::View::HEADLIGHT ? view->getLight() : nullptr;
    osgUtil::PositionalStateContainer& known =
        *outer.getCurrentRenderBin()->getStage()->getPositionalStateContainer();
    for (const auto& [attribute, matrix] : known.getAttrMatrixList())
    {
        const auto* light = dynamic_cast<const osg::Light*>(attribute.get());
        if (light != headlight) lights.meet(light, matrix ? osg::Matrixd(*matrix) : osg::Matrixd());
    }
}

} // namespace

Sun Sun::find(const ScenePass& pass)
{
    Lights lights;
    meetLightsOfStage(pass.outer, lights);
    const LightsBehind behind(pass.outer, lights);
    Sun sun;
    if (!lights.first.light)
    {
        sun.kind = lights.other ? OTHER_NUMBER : NONE;
        sun.number = lights.other ? lights.other->getLightNum() : 0;
        return sun;
    }
    const osg::Vec4& position = lights.first.light->getPosition();
    const osg::Vec4& color = lights.first.light->getDiffuse();
    osg::Matrixd toView = lights.first.toEye;
    if (!pass.view.image.ofView) toView.postMult(pass.view.image.toView);
    sun.towards =
        osg::Matrixd::transform3x3(osg::Vec3d(osg::Vec3(position.x(), position.y(), position.z())), toView);
    if (position.w() != 0.0f || !(sun.towards.normalize() > 0.0))
        sun.kind = WITHOUT_RAYS;
    else
        sun.kind = std::max({color.r(), color.g(), color.b()}) > 0.0f ? SHINING : DARK;
    return sun;
}

std::string Sun::complaint() const
{
    switch (kind)
    {
    case NONE:
        return "SunShadows finds no sun, and draws no shadows. Add a light 0 with a direction to the scene, "
               "such as a "
               "SunLight; a view's headlight is none.";
    case OTHER_NUMBER:
        return "SunShadows draws the shadows of light 0, and the scene's light has the number " +
               std::to_string(number) + ". Call setLightNum(0) on it.";
    case WITHOUT_RAYS:
        return "SunShadows draws no shadows, since light 0 has a place and no direction. Set its position "
               "with w = 0.";
    default:
        return {};
    }
}

} // namespace osgGeoFX
