// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>

namespace osgGeoFX
{

/// A file of shaders/ as it was when the library was built.
struct BakedShader
{
    const char* name; ///< relative to shaders/, for example "lib/bend.glsl"
    const char* text;
};

extern const BakedShader bakedShaders[];
extern const std::size_t bakedShaderCount;

} // namespace osgGeoFX
