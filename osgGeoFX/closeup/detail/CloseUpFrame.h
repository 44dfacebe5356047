// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpCompositor.h>
#include <osgGeoFX/closeup/detail/CloseUpPipeline.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** One cull of a camera's close-ups.

    How large a close-up is in the picture depends on the heights of what lies over its region. So a look at the scene comes first, as
    detailed as the overview is; then layers get their size, stages their viewports, and the camera the stages. */
class CloseUpFrame
{
public:
    /// What one cull's look at the scene says of the next one's: AUTOMATIC goes by it.
    struct Outlook
    {
        bool levels = true;   ///< whether something has levels of detail
        double sharing = 1.0; ///< regions that a drawable over any touches on average
    };

    CloseUpFrame(const ScenePass& pass, const CloseUpTask& task, CloseUpTraversal& traversal,
                 CloseUpCompositor& compositor);
    CloseUpFrame(const CloseUpFrame&) = delete;
    CloseUpFrame& operator=(const CloseUpFrame&) = delete;

    /// Takes the last one's outlook, and leaves its own. A sentence that is to be said once; empty as a rule.
    std::string cull(Outlook& outlook);
    /// When it has culled.
    CloseUps::Statistics statistics() const;

private:
    // The steps, in their order.
    void prepare();
    void choosePipeline(const Outlook& outlook);
    /// What lies over the regions; the pipeline may prove to be the wrong one.
    void survey(Outlook& outlook);
    /// Parts of the picture, and near and far planes.
    void place();
    /// Layers and uniform blocks.
    void allocate();
    void draw();

    bool singleIsCheaper(const Outlook& outlook) const;

    const ScenePass& _pass;
    const CloseUpTask& _task;
    CloseUpTraversal& _traversal;
    CloseUpCompositor& _compositor;
    const std::vector<CloseUpItem> _items;
    const int _perArray; ///< layers of a texture array
    RegionPass _regions;
    std::unique_ptr<CloseUpPipeline> _pipeline;
    RegionSurvey _survey;
    std::vector<VisibleCloseUp> _visible;
    std::string _sentence;
};

} // namespace osgGeoFX
