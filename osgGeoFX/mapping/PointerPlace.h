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

/// The place in the mappings' frame that the picture shows under the mouse pointer, whatever the effects do to the ground;
/// nothing for the sky. For event handlers.
OSGGEOFX_EXPORT std::optional<osg::Vec3d> placeUnderPointer(EffectScene& scene,
                                                            const ProjectiveMappings& mappings,
                                                            const osg::Camera& camera,
                                                            const osgGA::GUIEventAdapter& event);

} // namespace osgGeoFX
