// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgViewer/Viewer>

namespace geofx::test
{

/// No light of the viewer's, near and far planes that stay, and black where nothing is.
inline void usePlainView(osgViewer::Viewer& viewer)
{
    viewer.setLightingMode(osg::View::NO_LIGHT);
    viewer.getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    viewer.getCamera()->setClearColor({0.0f, 0.0f, 0.0f, 1.0f});
}

} // namespace geofx::test
