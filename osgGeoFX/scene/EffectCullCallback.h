// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/NodeCallback>

#include <atomic>

namespace osgGeoFX
{

/** Draws what is below a node with the effects of an EffectScene, where a program cannot put a group above its terrain.

    @code
    osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    terrain->setCullingActive(false);
    terrain->addCullCallback(new osgGeoFX::EffectCullCallback(scene));
    @endcode

    The scene has no children and is not in the graph. It keeps the effects and the settings, and whatever takes an
    EffectScene, such as DeformedView, works with it after the first frame. Everything that EffectScene promises holds
    for the children of the node: they may be loaded by anything, and by the node itself. World coordinates are those of
    the children. The transform and the state of the node itself are as OSG applies them.

    The node must be an osg::Group of any class. Its own `setCullingActive(false)` keeps OSG from culling it as if it
    were not deformed; a warning reports where it is missing, and where the scene has children. Callbacks of the program that were added to the node later
    run within this one; those added before run outside of it. A scene has one terrain: use one node for each scene. A
    warning reports a second one.

    Threads: as for EffectScene. Add and remove the callback between frames.

    @ingroup scene */
class OSGGEOFX_EXPORT EffectCullCallback : public osg::NodeCallback
{
public:
    /// `scene`: with its effects; null for a new one without any.
    explicit EffectCullCallback(EffectScene* scene = nullptr);
    EffectCullCallback(const EffectCullCallback& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, EffectCullCallback);

    /// Never null. Null is refused with a warning, and the former scene stays.
    void setScene(EffectScene* scene);
    EffectScene* getScene() { return _scene.get(); }
    const EffectScene* getScene() const { return _scene.get(); }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~EffectCullCallback() override;

private:
    enum Fault
    {
        NO_GROUP,
        CULLED,
        CHILDREN
    };
    void warnOnce(const osg::Node& node, Fault fault);

    osg::ref_ptr<EffectScene> _scene;
    std::atomic<unsigned int> _warned{0}; ///< a bit for each fault
};

} // namespace osgGeoFX
