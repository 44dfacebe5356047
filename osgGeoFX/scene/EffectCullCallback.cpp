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

void EffectCullCallback::warnOnce(const osg::Node& node, Fault fault)
{
    static constexpr const char* sentences[] = {
        "has no children to draw with effects; add the callback to a group.",
        "OSG culls it undeformed; call its setCullingActive(false).",
        "the callback's scene has children, which are not drawn; put them below the node."};
    const unsigned int bit = 1u << fault;
    if (_warned.fetch_or(bit) & bit) return;
    OSG_WARN << "osgGeoFX: The node \"" << node.getName() << "\" (" << node.className()
             << ") has an EffectCullCallback, but " << sentences[fault] << std::endl;
}

void EffectCullCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    osgUtil::CullVisitor* const culling = visitor->asCullVisitor();
    osg::Group* const terrain = node->asGroup();
    if (culling && !terrain) warnOnce(*node, NO_GROUP);
    if (culling && terrain)
    {
        if (terrain->isCullingActive()) warnOnce(*node, CULLED);
        if (_scene->getNumChildren() > 0) warnOnce(*node, CHILDREN);
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
