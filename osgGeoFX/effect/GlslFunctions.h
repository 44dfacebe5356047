// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <glm/glm.hpp>

/** The functions of shaders/lib as C++, from the same text that the GPU runs. `osgGeoFX::glsl` has them in double
    precision; `osgGeoFX::glslf` has them in float, to show what a GPU loses. Each file tells its units and ranges.

    A file of shaders/lib uses only what GLSL 3.30 and C++ with GLM have in common:
    - It has pure functions, marked GEOFX_INLINE, and constants and structures. All names begin with geofx_ or
      GEOFX_.
    - It uses the types below instead of float and vec2, and Number(0.5) instead of 0.5, which would be a double.
      Integers may stand in arithmetic with scalars, but not with vectors and not as arguments.
    - It has no swizzles of several components, uniforms, samplers, gl_... or main. `out` parameters need a macro.
    - Its includes stand in #ifndef __cplusplus, because this header includes all files, in order, twice.

    As in GLSL, structures are passed by value. Where a function is not inlined, that copies hundreds of bytes: most of the
    time that culling and picking spent in panorama maps. */
#define GEOFX_INLINE [[gnu::always_inline]] inline

namespace osgGeoFX
{

/// GLSL's own functions that shaders/lib uses.
namespace glslBuiltIns
{
using glm::abs;
using glm::atan;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::fract;
using glm::length;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::sin;
using glm::sqrt;
} // namespace glslBuiltIns

namespace glsl
{
using namespace glslBuiltIns;
constexpr int GEOFX_NEWTON_STEPS = 3;
constexpr int GEOFX_SERIES_TERMS = 12;
using Number = double;
using Length = double;
using Angle = double;
using PerMetre = double;
using Vector2 = glm::dvec2;
using Vector3 = glm::dvec3;
using Row = glm::dvec4;
using Profile = glm::dvec2;
using Position = glm::dvec3;
using Rgb = glm::dvec3;
using Rgba = glm::dvec4;
#include <shaders/lib/series.glsl>

#include <shaders/lib/bend.glsl>

#include <shaders/lib/bendview.glsl>
#include <shaders/lib/closeup.glsl>
#include <shaders/lib/exaggeration.glsl>
#include <shaders/lib/liberty.glsl>
#include <shaders/lib/mapping.glsl>

#include <shaders/lib/cover.glsl>
#include <shaders/lib/strokes.glsl>

#include <shaders/lib/lines.glsl>

#include <shaders/lib/painting.glsl>

#include <shaders/lib/detail.glsl>

#include <shaders/lib/bendstyle.glsl>

#include <shaders/lib/cylinder.glsl>
#include <shaders/lib/profile.glsl>

#include <shaders/lib/panorama.glsl>

#include <shaders/lib/edge.glsl>
} // namespace glsl

namespace glslf
{
using namespace glslBuiltIns;
constexpr int GEOFX_NEWTON_STEPS = 1;
constexpr int GEOFX_SERIES_TERMS = 5;
using Number = float;
using Length = float;
using Angle = float;
using PerMetre = float;
using Vector2 = glm::vec2;
using Vector3 = glm::vec3;
using Row = glm::vec4;
using Profile = glm::vec2;
using Position = glm::vec3;
using Rgb = glm::vec3;
using Rgba = glm::vec4;
#include <shaders/lib/series.glsl>

#include <shaders/lib/bend.glsl>

#include <shaders/lib/bendview.glsl>
#include <shaders/lib/closeup.glsl>
#include <shaders/lib/exaggeration.glsl>
#include <shaders/lib/liberty.glsl>
#include <shaders/lib/mapping.glsl>

#include <shaders/lib/cover.glsl>
#include <shaders/lib/strokes.glsl>

#include <shaders/lib/lines.glsl>

#include <shaders/lib/painting.glsl>

#include <shaders/lib/detail.glsl>

#include <shaders/lib/bendstyle.glsl>

#include <shaders/lib/cylinder.glsl>
#include <shaders/lib/profile.glsl>

#include <shaders/lib/panorama.glsl>

#include <shaders/lib/edge.glsl>
} // namespace glslf

} // namespace osgGeoFX

#undef GEOFX_INLINE
