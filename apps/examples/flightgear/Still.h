// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/offscreen/SceneRenderer.h>

namespace flightgear
{

/// Whether two pictures have the same bytes.
bool same(const osg::Image& a, const osg::Image& b);

/** Draws until two pictures in a row are the same. SimGear asks OpenGL about a technique in the first frame that wants it,
    and draws with it in the next one. Throws std::runtime_error with a sentence. */
osg::ref_ptr<osg::Image> drawStill(osgGeoFX::SceneRenderer& renderer, const osg::Matrixd& view);

} // namespace flightgear
