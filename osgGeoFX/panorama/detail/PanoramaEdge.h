// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/Texture2D>
#include <osg/Vec4d>

namespace osgGeoFX
{

class PanoramaMap;
class PanoramaTextures;

/// What the shaders of a panorama map need of the terrain's edge and of the sky behind it, for one camera
/// (shaders/lib/edge.glsl, shaders/stages/panorama.edge.glsl).
struct PanoramaEdge
{
    /// `modelView`: from the frame of the EffectScene's children to eye space.
    PanoramaEdge(const PanoramaMap& settings, PanoramaTextures& textures, const ViewGeometry& view,
                 const osg::Matrixd& modelView, const glsl::geofx_Panorama& panorama);

    osg::Vec4d eye, ways;
    osg::Vec4d
        kind; ///< whether on a globe, the extent's middle latitude, how wide the land runs out (metres), how it is drawn
    osg::Vec4d
        sky; ///< the horizon's height in the picture, its arch, the heading and the part across, in turns
    glsl::geofx_Cylinder cylinder{};         ///< the map's
    osg::ref_ptr<osg::Texture2D> map;        ///< an empty one if none is needed
    osg::ref_ptr<osg::Texture2D> skyTexture; ///< the same

    /// The place of a map in the edge's picture, by the numbers above.
    glsl::geofx_Edge frame() const;
};

} // namespace osgGeoFX
