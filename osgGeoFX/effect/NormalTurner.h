// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// What a Deformation is, too, whose SLOT_normal changes normals: those that fragments have for themselves (effect/TileNormals.h).
class NormalTurner
{
public:
    /// The shader file with `vec3 SLOT_normal(vec3 position, vec3 normal)` for fragments, without inputs and outputs. The position
    /// is that before all deformations.
    virtual std::string normalFile() const = 0;

protected:
    ~NormalTurner() = default;
};

} // namespace osgGeoFX
