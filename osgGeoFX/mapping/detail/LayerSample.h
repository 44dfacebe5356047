// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/DataLayer.h>

#include <osg/Image>
#include <osg/Vec2d>
#include <osg/Vec4d>

#include <optional>

namespace osgGeoFX
{

/// What a raster has at a place, seen from so near that a texel is larger than a pixel: as shaders/stages/mappings.frag.glsl
/// samples level 0, from the image itself and in time that does not depend on its size. Thread-safe.
struct LayerSample
{
    osg::Vec4d color;   ///< of colors: as coded, straight, 0…1
    double value = 0.0; ///< of values and classes
    double cover = 0.0; ///< the share of data there: 0 for none

    struct How
    {
        DataLayer::Kind kind = DataLayer::COLOR;
        bool smooth = true;
        std::optional<double> noData;

        static How of(const DataLayer& layer);
    };
    /// `raster`: 0…1, from the lower left corner. Nothing for images that cannot be read so: compressed or without pixels.
    static std::optional<LayerSample> read(const osg::Image& image, const How& how, const osg::Vec2d& raster);
};

} // namespace osgGeoFX
