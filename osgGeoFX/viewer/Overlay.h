// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osgViewer/View>

namespace osgGeoFX
{

/** A camera that draws what is below it over the picture of the one it is put under; its units are pixels of a picture of this
    size. Without light and depth test. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Camera> makeOverlay(int width, int height);

/** Puts such a camera over a view's picture, as a slave, so that the scene itself stays as it was loaded. The overlay takes the
    view's graphics context; it needs a viewport. From the thread that calls frame(), at any time of a frame but while it renders:
    where threads run they are stopped and started anew, since OSG would cull a slave that comes later in the thread that draws,
    while handlers change what is below it. */
OSGGEOFX_EXPORT void attachOverlay(osgViewer::View& view, osg::Camera& overlay);

/** Shows an overlay over the whole of a view's picture, whatever the window's size has become; makes and attaches it where it is null,
    drawn after those of lower orders. Whether it is new or has another place or size than before. The view's camera needs a
    viewport; for the rest as attachOverlay(). */
OSGGEOFX_EXPORT bool showOverlay(osgViewer::View& view, osg::ref_ptr<osg::Camera>& overlay, int order);

} // namespace osgGeoFX
