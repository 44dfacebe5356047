// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpLayers.h>
#include <osgGeoFX/closeup/detail/CloseUpStates.h>
#include <osgGeoFX/closeup/detail/ContourFence.h>
#include <osgGeoFX/closeup/detail/TriangleCopies.h>

namespace osgGeoFX
{

/// What one traversal needs until its frame is drawn. Another frame may use it afterwards.
struct CloseUpTraversal
{
    CloseUpStates states;
    CloseUpLayers layers;
    TriangleCopies copies;
    std::vector<ContourFence> fences; ///< one for each item
    osg::ref_ptr<osg::Program> program, fenceProgram;

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;
};

} // namespace osgGeoFX
