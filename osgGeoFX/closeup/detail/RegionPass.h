// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpTraversal.h>
#include <osgGeoFX/closeup/detail/RegionFilter.h>
#include <osgGeoFX/closeup/detail/VisibleCloseUp.h>
#include <osgGeoFX/effect/ScenePass.h>

namespace osgGeoFX
{

/// Draws what lies over regions, in one cull. A CloseUpPipeline decides what is drawn, when, and into which stage.
class RegionPass
{
public:
    const ScenePass& pass;
    CloseUpTraversal& traversal;
    const std::vector<CloseUpItem>& items;
    const std::vector<DrawableCompanion*>
        companions; ///< of other effects; they are drawn in the layers of close-ups

    RegionPass(const ScenePass& scenePass, const CloseUpTask& task, CloseUpTraversal& needed,
               const std::vector<CloseUpItem>& closeUps, bool tessellates);

    /// Call it before anything is drawn. `copies`: a geometry stage copies triangles into layers.
    void choosePrograms(bool copies);
    /// Goes on with the vertex and the fragment stage alone, which can draw any geometry.
    void simplify();
    bool tessellated() const { return _tessellated; }

    osgUtil::RenderStage* newStage() const { return traversal.layers.newStage(pass.outer, pass.depth); }
    osgUtil::RenderStage* surveyStage() const { return traversal.layers.surveyStage(pass.outer, pass.depth); }
    /// Finds everything over the regions, as detailed as the overview is, and draws it into the stage with the states
    /// that `statesOf` gives.
    RegionSurvey survey(const RegionFilter::StatesOf& statesOf, osgUtil::RenderStage* stage) const;
    /// Draws the ground over one region into the layer of its close-up (0) or of its anchor (1). Levels of detail go
    /// by the size after `chain`. Adds the heights to `found`.
    void draw(const VisibleCloseUp& visible, std::size_t which, const DeformationChain& chain,
              RegionContents& found);
    /// Draws the wall and the line around a region into its anchor's layer.
    void drawFence(const VisibleCloseUp& visible, const RegionContents& found);

    int drawables = 0; ///< handed to the GPU; the pipelines count those of a survey

private:
    RegionSurvey run(std::vector<std::size_t> wanted, const RegionFilter::StatesOf& statesOf,
                     osgUtil::RenderStage* stage, const DeformationChain* chain, bool accompanied) const;

    const CloseUpTask& _task;
    bool _tessellated;
    bool _amplified = false; ///< whether there is a geometry stage
};

} // namespace osgGeoFX
