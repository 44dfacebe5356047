// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/closeup/detail/CloseUpTextures.h>

namespace osgGeoFX
{

/// What CloseUps asks of a camera in one cull. It lives as long as the call.
struct CloseUpTask
{
    const std::vector<osg::ref_ptr<CloseUp>>& closeUps; ///< those that are enabled and have a mask
    const SurfaceData* data;
    CloseUpTextures::State textures;
    CloseUps::Pipeline pipeline;
    int tessellation;
    double opacity;
    int samples;
    bool depthTest;
    int maxLayers; ///< of one array
    int units[3];  ///< masks, tables, surfaces
    unsigned int binding;
};

} // namespace osgGeoFX
