// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/EffectCullCallback.h>

#include <osg/Notify>

namespace osgGeoFX
{

EffectCullCallback::EffectCullCallback(EffectScene* scene) : _scene(scene ? scene : new EffectScene) {}

EffectCullCallback::EffectCullCallback(const EffectCullCallback& other, const osg::CopyOp& copy)
    : osg::Object(other, copy), osg::Callback(other, copy), osg::NodeCallback(other, copy),
      _scene(osg::clone(other._scene.get(), copy))
{
}

EffectCullCallback::~EffectCullCallback() = default;

void EffectCullCallback::setScene(EffectScene* scene)
{
    if (scene)
        _scene = scene;
    else
        OSG_WARN << "osgGeoFX: EffectCullCallback::setScene got no scene; the former one stays." << std::endl;
}

void EffectCullCallback::warnOnce(const osg::Node& node, const char* fault)
{
    if (_warned.exchange(true)) return;
    OSG_WARN << "osgGeoFX: The node \"" << node.getName() << "\" (" << node.className()
             << ") has an EffectCullCallback, but " << fault << std::endl;
}

void EffectCullCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    osgUtil::CullVisitor* const culling = visitor->asCullVisitor();
    osg::Group* const terrain = node->asGroup();
    if (culling && !terrain)
        warnOnce(*node, "has no children to draw with effects; add the callback to a group.");
    if (culling && terrain)
    {
        if (terrain->isCullingActive())
            warnOnce(*node, "OSG culls it undeformed; call its setCullingActive(false).");
        _scene->setTerrain(*terrain);
        const auto below = [this, node](osg::NodeVisitor& inner)
        {
            traverse(node, &inner);
        };
        if (_scene->cull(*culling, *terrain, below)) return;
    }
    traverse(node, visitor);
}

void EffectCullCallback::resizeGLObjectBuffers(unsigned int size)
{
    _scene->resizeGLObjectBuffers(size);
    osg::NodeCallback::resizeGLObjectBuffers(size);
}

void EffectCullCallback::releaseGLObjects(osg::State* state) const
{
    _scene->releaseGLObjects(state);
    osg::NodeCallback::releaseGLObjects(state);
}

} // namespace osgGeoFX
