// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/GpuLimits.h>

#include <osg/GLExtensions>
#include <osgUtil/CullVisitor>

namespace osgGeoFX
{

GpuLimits GpuLimits::of(osgUtil::CullVisitor& outer)
{
    GpuLimits limits;
    const osg::State* const state = outer.getRenderInfo().getState();
    const osg::GLExtensions* const extensions =
        state ? osg::GLExtensions::Get(state->getContextID(), false) : nullptr;
    if (!extensions) return limits;
    limits.version = extensions->glVersion;
    if (extensions->maxTextureSize > 0) limits.textureSide = extensions->maxTextureSize;
    if (extensions->maxLayerCount > 0) limits.textureLayers = extensions->maxLayerCount;
    return limits;
}

} // namespace osgGeoFX
