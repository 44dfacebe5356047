// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Camera>

namespace osgGeoFX
{

/// The first parent of a node; null at a root, and below the camera of a view. That camera's own thread changes its state
/// while others cull (osgUtil::SceneView::setLightingMode), so what walks up for a state must not read it.
inline const osg::Node* firstParent(const osg::Node& node)
{
    const osg::Node* parent = node.getNumParents() > 0 ? node.getParent(0) : nullptr;
    const osg::Camera* camera = parent ? parent->asCamera() : nullptr;
    return camera && camera->getView() ? nullptr : parent;
}

} // namespace osgGeoFX
