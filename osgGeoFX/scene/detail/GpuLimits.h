// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgUtil
{
class CullVisitor;
}

namespace osgGeoFX
{

/** What the context of a camera can do, while culling. Before the context has drawn, nobody knows it. May be called by any
    thread that culls. */
struct GpuLimits
{
    float version = 0.0f; ///< of OpenGL; 0 while it is not known
    int textureSide =
        16384; ///< texels along the side of a texture; what GPUs with OpenGL 4 have, while it is not known
    int textureLayers =
        256; ///< layers of a texture array; what GPUs with OpenGL 3 have at least, while it is not known

    static GpuLimits of(osgUtil::CullVisitor& outer);
};

} // namespace osgGeoFX
