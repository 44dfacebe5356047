// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Image>
#include <osg/Matrixd>

#include <optional>

namespace osgGeoFX
{

/// Reads on the CPU what a tile's texture of normals says (effect/detail/TileNormals.h), as a GPU would without mipmaps.
class NormalSampler
{
public:
    /// With the texture in the geometry's own state.
    explicit NormalSampler(const osg::Geometry& geometry);

    /// Whether there is a texture that can be read.
    bool valid() const { return _image.valid(); }
    /// The normal, of length 1, at texture coordinates of unit 0; nothing without a texture.
    std::optional<osg::Vec3d> at(double s, double t) const;

private:
    osg::ref_ptr<const osg::Image> _image;
    osg::Matrixd _places;
};

} // namespace osgGeoFX
