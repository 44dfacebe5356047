// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osg/Camera>
#include <osg/Vec4d>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class EffectScene;

/// What a mapping has at a place. A plain value.
/// @ingroup mapping
struct OSGGEOFX_EXPORT LayerReading
{
    osg::ref_ptr<ProjectiveMapping> mapping; ///< never null
    std::string name;                        ///< the mapping's or its layer's; never empty
    DataLayer::Kind kind = DataLayer::COLOR;
    osg::Vec2d raster;  ///< the place in raster coordinates, 0…1 from the lower left corner
    double texel = 0.0; ///< the side of the texel that was read, metres; 0 for a mapping without a raster
    /// Of values and classes; nothing where there is no data. Values are interpolated between texels if the layer is smooth.
    std::optional<double> value;
    std::string unit, className; ///< as LayerWords has them; empty for none
    /// The color that the mapping brings, sRGB-coded, 0…1, with straight alpha: after table, color matrix and alpha function,
    /// before opacity, fades and blending. Nothing where it brings none: no data, or the scene's own color.
    std::optional<osg::Vec4d> color;
    /// The layer is this one's, with the picture of its clock's time. Null for other layers.
    osg::ref_ptr<LayerSequence> sequence;

    /// "rain: 3.25 mm", "cover: woods (10)", "photo: #3f5a2c", "rain: no data".
    std::string text() const;
};

/** Reads all layers at a place of the ground, in the thread of the frame loop, between frames.

    @code
    if (const auto probe = osgGeoFX::LayerProbe::under(*scene, *viewer.getCamera(), x, y))
        for (const osgGeoFX::LayerReading& reading : probe->readings)
            std::cout << reading.text() << std::endl;
    @endcode

    Layers are read from their images in main memory, in full resolution, whatever the GPU shows. A PagedRaster is read from its finest
    tile in memory, so `texel` tells how fine that is; nothing is read from disk. Fades and the opacity do not count, and mappings that
    are off, pinhole cameras, sizes in pixels, turned symbols and layers that the GPU fills (DataLayer::setTexture()) are left out.
    @ingroup mapping */
struct OSGGEOFX_EXPORT LayerProbe
{
    osg::Vec3d world; ///< the place on the undeformed ground, in the frame of the scene's children
    std::vector<LayerReading> readings; ///< the topmost first

    /// All mappings of a scene at a place, those of effects that are on.
    static LayerProbe at(EffectScene& scene, const osg::Vec3d& world);
    /// The same at the ground that a pixel shows, deformed or not; nothing for the sky. Pixels count from the viewport's lower left
    /// corner, as in DeformedView.
    static std::optional<LayerProbe> under(EffectScene& scene, const osg::Camera& camera, double x, double y);
    /// The mappings of one effect. `place`: x, y and height in its frame, metres.
    static std::vector<LayerReading> read(const ProjectiveMappings& mappings, const osg::Vec3d& place);
};

} // namespace osgGeoFX
