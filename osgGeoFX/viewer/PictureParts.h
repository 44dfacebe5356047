// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <vector>

namespace osgGeoFX
{

/** Lets several cameras draw a view's picture side by side, each a column of it; EffectScene::leastParts() tells how many
    are needed. They are slaves of the view's camera, which
    goes on to set the view, the projection and all else, and to get the events, but draws nothing itself. Its graphics context
    and its viewport must be there. The columns follow when the window's size changes.

    Call it from the thread that calls frame(), but not while a frame renders; running threads are stopped and started again.
    Returns the cameras from left to right; with less than two parts none, and nothing changes.
    @ingroup viewer */
OSGGEOFX_EXPORT std::vector<osg::ref_ptr<osg::Camera>> drawInParts(osgViewer::View& view, unsigned int parts);

/// A handler that calls drawInParts() as soon as the effects of a scene need it, also after they have changed. The columns
/// stay. It serves one view.
/// @ingroup viewer
OSGGEOFX_EXPORT osg::ref_ptr<osgGA::GUIEventHandler> makePartsHandler(EffectScene& scene);

} // namespace osgGeoFX
