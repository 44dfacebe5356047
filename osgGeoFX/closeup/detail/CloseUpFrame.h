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

    The size of a close-up in the picture depends on the heights of the ground over its region. So the cull first
    surveys the scene, as detailed as the overview is. Then the layers get their size, the stages their viewports, and
    the camera its stages. */
class CloseUpFrame
{
public:
    /// What one survey tells the next cull. AUTOMATIC chooses the pipeline by it.
    struct Outlook
    {
        bool levels = true;   ///< whether anything has levels of detail
        double sharing = 1.0; ///< how many regions a drawable over some region touches on average
    };

    CloseUpFrame(const ScenePass& pass, const CloseUpTask& task, CloseUpTraversal& traversal,
                 CloseUpCompositor& compositor);
    CloseUpFrame(const CloseUpFrame&) = delete;
    CloseUpFrame& operator=(const CloseUpFrame&) = delete;

    /// Culls with the last cull's outlook, and replaces it. The result is a sentence that should be printed once;
    /// empty as a rule.
    std::string cull(Outlook& outlook);
    /// Call it after cull().
    CloseUps::Statistics statistics() const;

private:
    // The steps, in their order.
    void prepare();
    void choosePipeline(const Outlook& outlook);
    /// Finds what lies over the regions. This may show that another pipeline is needed.
    void survey(Outlook& outlook);
    /// Finds the parts of the picture, and moves near and far planes.
    void place();
    /// Gives layers and uniform blocks their size.
    void allocate();
    void draw();

    bool singleIsCheaper(const Outlook& outlook) const;

    const ScenePass& _pass;
    const CloseUpTask& _task;
    CloseUpTraversal& _traversal;
    CloseUpCompositor& _compositor;
    const std::vector<CloseUpItem> _items;
    const int _perArray; ///< the layers of one texture array
    RegionPass _regions;
    std::unique_ptr<CloseUpPipeline> _pipeline;
    RegionSurvey _survey;
    std::vector<VisibleCloseUp> _visible;
    std::string _sentence;
};

} // namespace osgGeoFX
