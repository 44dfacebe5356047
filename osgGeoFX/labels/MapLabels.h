// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Group>
#include <osg/observer_ptr>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Shows the names of a map over the live picture of an EffectScene, whatever its effects do: panorama maps, bent views, plain ones.

    @code
    osg::ref_ptr<osgGeoFX::MapLabels> labels = new osgGeoFX::MapLabels(*scene, new osgGeoFX::NameSet(names));
    root->addChild(scene);
    root->addChild(labels); // beside the scene and not below it
    viewer.setSceneData(root);
    @endcode

    Names are upright and do not overlap. A line leads from a summit's name down to the summit. What the terrain, or
    a close-up, hides in the picture has no name. While the camera moves, each name moves exactly as its place does. Names come and go by
    fading.

    **Cameras.** Each view has names of its own. Slaves that draw parts of a view's picture, as drawInParts() makes them, and
    walls of screens show parts of the view's names. Cameras above or below the node (shadow maps, textures) show none.

    **Hidden places** are found by the depths of earlier frames, up to four frames ago. So the first frames of a viewer have no names.
    For a single picture use LabelPicture. Files do not keep the node.

    **Threads.** All threading models of OSG's viewers. Change names and styles between frames.
    @ingroup labels */
class OSGGEOFXMAPS_EXPORT MapLabels : public osg::Group
{
public:
    MapLabels(EffectScene& scene, NameSet* names);

    /// Null for none.
    void setNames(NameSet* names);
    NameSet* getNames() { return _names.get(); }
    void setRules(const LabelLayout::Rules& rules);
    const LabelLayout::Rules& getRules() const { return _rules; }
    /// Whether names are shown; they fade out and in. True by default.
    void setShown(bool shown) { _shown = shown; }
    bool isShown() const { return _shown; }

    /// A name as the last frame of a view has shown it.
    struct Shown
    {
        std::size_t name = 0; ///< its index in the set
        PlacedLabel label;    ///< in the view's picture
    };
    /// The names of a view's last frame. `camera`: the view's camera.
    std::vector<Shown> shown(const osg::Camera& camera) const;

    void traverse(osg::NodeVisitor& visitor) override;
    osg::BoundingSphere computeBound() const override { return {}; }
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "MapLabels"; }

protected:
    ~MapLabels() override;

private:
    struct Views;
    osg::observer_ptr<EffectScene> _scene;
    osg::ref_ptr<NameSet> _names;
    LabelLayout::Rules _rules;
    bool _shown = true;
    osg::ref_ptr<DepthReader> _reader;
    std::unique_ptr<Views> _views;
};

} // namespace osgGeoFX
