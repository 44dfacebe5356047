// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpCamera.h>

namespace osgGeoFX
{

CloseUpTraversal& CloseUpCamera::freeTraversal(const ScenePass& pass, const CloseUpTask& task)
{
    const bool starts = pass.frame != _frame;
    _frame = pass.frame;
    if (starts) _used = 0;
    if (_used == _traversals.size()) _traversals.push_back(std::make_unique<CloseUpTraversal>());
    CloseUpTraversal& traversal = *_traversals[_used++];
    traversal.states.use(pass.prefix, task);
    traversal.layers.startFrame();
    // The last frame has been drawn, so deleted drawables need their copies no longer. Copies hold the arrays of
    // these drawables.
    for (std::size_t i = 0; starts && i < _traversals.size(); ++i)
        _traversals[i]->copies.startFrame();
    return traversal;
}

std::string CloseUpCamera::cull(const ScenePass& pass, const CloseUpTask& task)
{
    CloseUpFrame frame(pass, task, freeTraversal(pass, task), _compositor);
    std::string sentence = frame.cull(_outlook);
    _statistics = frame.statistics();
    return sentence;
}

void CloseUpCamera::resizeGLObjectBuffers(unsigned int size)
{
    for (const std::unique_ptr<CloseUpTraversal>& each : _traversals)
        each->resizeGLObjectBuffers(size);
    _compositor.resizeGLObjectBuffers(size);
}

void CloseUpCamera::releaseGLObjects(osg::State* state) const
{
    for (const std::unique_ptr<CloseUpTraversal>& each : _traversals)
        each->releaseGLObjects(state);
    _compositor.releaseGLObjects(state);
}

} // namespace osgGeoFX
