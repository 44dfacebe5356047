// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUpFilter.h>
#include <osgGeoFX/closeup/CloseUpItems.h>
#include <osgGeoFX/closeup/CloseUpLayers.h>
#include <osgGeoFX/closeup/CloseUpTextures.h>
#include <osgGeoFX/closeup/CloseUps.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The close-ups of one camera, in one of the frames that are on their way: what culling them comes to.

    In a frame: which close-ups there are (items), what lies over their regions (a look at the scene as the overview shows it,
    which in SINGLE_PASS draws it, too), in MULTI_PASS a traversal for each, then how large each is in the picture, and with
    that the layers, the uniform blocks, and the stages in their order. */
class CloseUpCamera
{
public:
    struct Task
    {
        const std::vector<osg::ref_ptr<CloseUp>>& closeUps; ///< those that are enabled and have a mask
        const SurfaceData* data;
        CloseUpTextures::State textures;
        CloseUps::Pipeline pipeline;
        int tessellation;
        double opacity;
        int samples;
        bool depthTest;
        int maxLayers; ///< of one array
        int units[3];  ///< masks, tables, surfaces
        unsigned int binding;
    };

    /// A sentence that is to be said once; empty as a rule.
    std::string cull(const ScenePass& pass, const Task& task);
    const CloseUps::Statistics& statistics() const { return _statistics; }
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    /// What one traversal of a frame needs until it is drawn.
    struct Traversal
    {
        /// Forgets all state where the names in it, or the places that it binds to, are no longer these.
        void use(const std::string& names, const Task& task);

        std::string prefix;
        std::vector<int> places; ///< texture units and the block's binding
        CloseUpItems values;
        CloseUpLayers layers;
        osg::ref_ptr<osg::StateSet> base = new osg::StateSet;
        int units[3] = {};                                                      ///< where its textures are
        std::map<std::vector<std::size_t>, osg::ref_ptr<osg::StateSet>> groups; ///< of a single pass
        TriangleCopies copies;
        std::vector<osg::ref_ptr<osg::StateSet>>
            layerStates; ///< of a layer each: item 0, its anchor, item 1…
        std::vector<osg::ref_ptr<osg::StateSet>> fenceStates; ///< wall and line of each item
        std::vector<ContourFence> fences;
    };
    /// An item's part of the picture and its layers.
    struct Seen
    {
        std::size_t item;
        PixelRectangle part;                  ///< of the picture that its layers cover
        std::optional<PixelRectangle> lifted; ///< and of that, the close-up without its anchor
        int layer;                            ///< the anchor's is the next one
        osgUtil::RenderStage* stages[2];
    };

    bool singleIsCheaper() const;
    void setUp(const ScenePass& pass, const Task& task, std::size_t items);
    CompensatingCullVisitor::Task passTask(const ScenePass& pass, const Task& task) const;
    osg::StateSet* groupState(const ScenePass& pass, const Task& task, const std::vector<std::size_t>& group);
    void setLayerStates(const ScenePass& pass, const Task& task, std::size_t items);
    void collectGroups(const ScenePass& pass, const Task& task, const std::vector<std::size_t>& touched,
                       std::vector<osg::StateSet*>& states);
    void drawItem(const ScenePass& pass, const Task& task, Seen& seen, RegionContents& found);
    void drawFence(const ScenePass& pass, const Task& task, const Seen& seen, const RegionContents& found,
                   osgUtil::RenderStage& stage);
    void show(const ScenePass& pass, const Task& task, const std::vector<Seen>& all);

    osg::ref_ptr<CompensatingCullVisitor> _overview = new CompensatingCullVisitor;
    // One for each program: what one remembers of looks is for its program, until the frame has been drawn.
    osg::ref_ptr<CompensatingCullVisitor> _single = new CompensatingCullVisitor;
    osg::ref_ptr<CompensatingCullVisitor> _pieces = new CompensatingCullVisitor;
    std::vector<std::unique_ptr<Traversal>> _traversals;
    std::size_t _used = 0;
    Traversal* _now = nullptr;
    std::vector<CloseUpItem> _items;
    bool _tessellated = false;
    bool _levels = true;   ///< whether something had levels of detail in the last frame
    double _sharing = 1.0; ///< regions that a drawable over any touched on average
    osg::ref_ptr<osg::Program> _program, _fenceProgram; ///< of this frame
    osg::ref_ptr<osg::Program> _layerProgram;
    CloseUps::Statistics _statistics;
};

} // namespace osgGeoFX
