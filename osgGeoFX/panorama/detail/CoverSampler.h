// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Geometry>
#include <osg/Image>

#include <cstddef>

namespace osgGeoFX
{

/// Reads a tile's cover texture (shaders/lib/cover.glsl) on the CPU, as a GPU would without mipmaps.
class CoverSampler
{
public:
    /// Takes the 2D texture at the unit from the geometry's state. If it has none, that of the nearest node above
    /// counts, by first parents.
    explicit CoverSampler(const osg::Geometry& geometry, unsigned int unit = 7);

    /// Whether there is a texture that can be read.
    bool valid() const { return _image.valid(); }
    /// Whether it has one texel, and so is the same at all coordinates.
    bool uniform() const { return _image && _image->s() == 1 && _image->t() == 1; }
    /// The texel at texture coordinates (those of unit 0), filtered and clamped to the border; (0, 0, 0, 1) without a
    /// texture.
    glsl::Rgba at(double s, double t) const;

private:
    osg::ref_ptr<const osg::Image> _image;
    std::size_t _rowStep = 0; ///< bytes; OSG works it out anew each time
};

} // namespace osgGeoFX
