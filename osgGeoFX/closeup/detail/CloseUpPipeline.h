// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/RegionPass.h>

namespace osgGeoFX
{

/** How the close-ups of one cull get into their layers. The calls come in this order: survey() once, draw() for each
    close-up, handOver() once the layers have their size, and finish() for each close-up in sight. */
class CloseUpPipeline
{
public:
    explicit CloseUpPipeline(RegionPass& regions) : _regions(regions) {}
    CloseUpPipeline(const CloseUpPipeline&) = delete;
    CloseUpPipeline& operator=(const CloseUpPipeline&) = delete;
    virtual ~CloseUpPipeline() = default;

    virtual CloseUps::Pipeline kind() const = 0;
    /// Finds what lies over the regions, as the overview draws it.
    virtual RegionSurvey survey() = 0;
    /// Whether the pipeline can draw what was found.
    virtual bool takes(const RegionSurvey& found) const = 0;
    /// Draws one close-up, whose part of the picture is not known yet. Adds the heights of finer tiles to `found`.
    virtual void draw(VisibleCloseUp& visible, RegionContents& found) = 0;
    /// Hands the stage that draws all close-ups at once to the camera. `picture` is the viewport of the whole
    /// picture.
    virtual void handOver(osg::Viewport* picture) = 0;
    /// Draws what needs the close-up's part of the picture.
    virtual void finish(VisibleCloseUp& visible, const RegionContents& found) = 0;

protected:
    RegionPass& _regions;
};

} // namespace osgGeoFX
