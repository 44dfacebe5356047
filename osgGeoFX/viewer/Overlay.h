// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osgViewer/View>

namespace osgGeoFX
{

/** Makes a camera that draws its children over the picture of a parent camera. Its units are pixels of a viewport of
    this size. Lighting and depth test are off. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Camera> makeOverlay(int width, int height);

/** Adds an overlay camera to a view as a slave, so that the loaded scene stays unchanged. The overlay gets the view's
    graphics context and needs a viewport. Call this from the thread that calls frame(), but not while a frame renders.
    Running threads are stopped and started again: else OSG would cull the new slave in the drawing thread while
    handlers change its children. */
OSGGEOFX_EXPORT void attachOverlay(osgViewer::View& view, osg::Camera& overlay);

/** Shows an overlay over a view's whole viewport, whatever the window's size is now. If `overlay` is null, it is made
    and attached; overlays of lower `order` are drawn first. Returns true if the overlay is new or its viewport has
    changed. The view's camera needs a viewport. The rules of attachOverlay() apply. */
OSGGEOFX_EXPORT bool showOverlay(osgViewer::View& view, osg::ref_ptr<osg::Camera>& overlay, int order);

} // namespace osgGeoFX
