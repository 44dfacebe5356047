// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Image>
#include <osg/Matrixd>

#include <cstddef>
#include <optional>

namespace osgGeoFX
{

/// Reads a tile's texture of normals (effect/detail/TileNormals.h) on the CPU, as a GPU would without mipmaps.
class NormalSampler
{
public:
    /// Takes the texture from the geometry's own state.
    explicit NormalSampler(const osg::Geometry& geometry);

    /// Whether there is a texture that can be read.
    bool valid() const { return _image.valid(); }
    /// The normal, of length 1, at texture coordinates of unit 0. Nothing without a texture.
    std::optional<osg::Vec3d> at(double s, double t) const;

private:
    osg::ref_ptr<const osg::Image> _image;
    std::size_t _rowStep = 0; ///< bytes; OSG works it out anew each time
    osg::Matrixd _places;
};

} // namespace osgGeoFX
