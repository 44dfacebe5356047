// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osg/Camera>
#include <osgGA/GUIEventAdapter>

#include <optional>

namespace osgGeoFX
{

class EffectScene;

/// The place in the mappings' frame (x, y and height, metres) that is visible under the mouse pointer, on the ground
/// as the effects deform it. Empty if the pointer is over the sky. Event handlers call this function.
/// @ingroup mapping
OSGGEOFX_EXPORT std::optional<osg::Vec3d> placeUnderPointer(EffectScene& scene,
                                                            const ProjectiveMappings& mappings,
                                                            const osg::Camera& camera,
                                                            const osgGA::GUIEventAdapter& event);

} // namespace osgGeoFX
