// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>

#include <functional>

struct _cairo; // cairo_t of Cairo

namespace osgGeoFX
{

/// Draws with Cairo over some rows of a picture, an image as wide as the picture with 8 or 16 bits for each of three or four channels. `top`: the
/// picture's row, from the uppermost one, that is the image's uppermost. `draw` has the picture's pixels, y downwards; it may be called several times. False
/// if the image is another one.
bool drawOver(osg::Image& image, int top, int width, const std::function<void(_cairo*)>& draw);

} // namespace osgGeoFX
