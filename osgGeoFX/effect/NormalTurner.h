// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// A second base class of a Deformation whose SLOT_normal changes normals. It also turns the normals that fragments
/// take from a database's texture.
/// @ingroup effect
class NormalTurner
{
public:
    /// The shader file with `vec3 SLOT_normal(vec3 position, vec3 normal)` for the fragment stage. It has no inputs and
    /// outputs. `position` is in eye space, before all deformations.
    virtual std::string normalFile() const = 0;

protected:
    ~NormalTurner() = default;
};

} // namespace osgGeoFX
