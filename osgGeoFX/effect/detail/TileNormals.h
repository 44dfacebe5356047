// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgGeoFX
{

/** What a database's tiles have for light and shade: a texture of normals, bound but not enabled, in the frame of the tile's
    geometry (x east, y north, z up at the tile's center).

    A byte b of it means (255 b − 128) / 127, with b from 0 to 1 as shaders have it. With two channels z is what is left, and
    never below 0. Its coordinates are those of unit 0, by the texture matrix of its own unit. */
struct TileNormals
{
    static constexpr unsigned int unit = 2;
    static constexpr const char* texture = "geofx normals";
    /// The program that lights with it where OpenGL's fixed functions would draw. The kit draws as if it were not there.
    static constexpr const char* program = "geofx tile";
};

} // namespace osgGeoFX
