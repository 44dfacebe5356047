// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/closeup/detail/CloseUpTask.h>
#include <osgGeoFX/closeup/detail/VisibleCloseUp.h>
#include <osgGeoFX/effect/ScenePass.h>

namespace osgGeoFX
{

/// Puts the layers of close-ups and anchors into the camera's picture. Each layer comes over what is behind it.
class CloseUpCompositor
{
public:
    void compose(const ScenePass& pass, const CloseUpTask& task, const std::vector<CloseUpItem>& items,
                 const std::vector<VisibleCloseUp>& visible, CloseUpLayers& layers);
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    osg::ref_ptr<osg::Program> _program;
};

} // namespace osgGeoFX
