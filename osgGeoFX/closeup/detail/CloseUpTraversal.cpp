// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpTraversal.h>

namespace osgGeoFX
{

void CloseUpTraversal::resizeGLObjectBuffers(unsigned int size)
{
    states.values.resizeGLObjectBuffers(size);
    layers.resizeGLObjectBuffers(size);
    copies.resizeGLObjectBuffers(size);
    for (ContourFence& fence : fences)
        fence.resizeGLObjectBuffers(size);
}

void CloseUpTraversal::releaseGLObjects(osg::State* state) const
{
    states.values.releaseGLObjects(state);
    layers.releaseGLObjects(state);
    copies.releaseGLObjects(state);
    for (const ContourFence& fence : fences)
        fence.releaseGLObjects(state);
}

} // namespace osgGeoFX
