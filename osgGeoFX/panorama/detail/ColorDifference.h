// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>

namespace osgGeoFX
{

/// What a reader with this vision sees in the place of a color. Both are coded in sRGB, 0…1. The matrices are those of
/// Machado, Oliveira and Fernandes (2009) for dichromats; they work on linear light.
glsl::Rgb seenWith(ColorVision vision, const glsl::Rgb& color);

/// CIE L*a*b* of a color that is coded in sRGB, for the white of D65.
glm::dvec3 labOf(const glsl::Rgb& color);

/// How different two colors look: CIEDE2000, of their L*a*b*.
double colorDifference(const glm::dvec3& first, const glm::dvec3& second);

} // namespace osgGeoFX
