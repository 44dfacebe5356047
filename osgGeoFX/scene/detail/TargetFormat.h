// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/CullVisitor>

namespace osgGeoFX
{

/// The format of textures with alpha that lose nothing of what a visitor's camera draws: GL_RGBA8, GL_RGBA16, GL_RGBA16F_ARB or
/// GL_RGBA32F_ARB. It follows from the camera's color attachment, or from the stage's frame buffer object if that is the
/// application's own.
GLenum targetFormat(osgUtil::CullVisitor& visitor);

/// Whether colors above 1 stay what they are in a format.
bool holdsBrightColors(GLenum format);

} // namespace osgGeoFX
