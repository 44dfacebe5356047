// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpFrame.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** What the close-ups of one camera keep from one cull to the next. A CloseUpFrame does the culling. */
class CloseUpCamera
{
public:
    /// Culls. The result is a sentence that should be printed once; empty as a rule.
    std::string cull(const ScenePass& pass, const CloseUpTask& task);
    const CloseUps::Statistics& statistics() const { return _statistics; }
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    /// A traversal that no frame on its way to the screen needs.
    CloseUpTraversal& freeTraversal(const ScenePass& pass, const CloseUpTask& task);

    unsigned int _frame = 0; ///< ScenePass::frame
    std::vector<std::unique_ptr<CloseUpTraversal>> _traversals;
    std::size_t _used = 0; ///< traversals of this frame
    CloseUpCompositor _compositor;
    CloseUpFrame::Outlook _outlook;
    CloseUps::Statistics _statistics;
};

} // namespace osgGeoFX
