// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgGeoFX
{

/** What a database's tiles have for light and shade: a texture of normals in the frame of the tile's geometry (x
    east, y north, z up at the tile's center). It is bound but not enabled.

    A byte b stands for (255 b − 128) / 127, with b from 0 to 1 as in shaders. With two channels, z follows from x and
    y, and is never below 0. Texture coordinates are those of unit 0, times the texture matrix of its own unit. */
struct TileNormals
{
    static constexpr unsigned int unit = 2;
    static constexpr const char* texture = "geofx normals";
    /// The name of the program that lights with it where OpenGL's fixed functions would draw. The kit draws as if it
    /// were not there.
    static constexpr const char* program = "geofx tile";
};

} // namespace osgGeoFX
