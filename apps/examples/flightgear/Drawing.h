// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures of SimGear's scenery, without a window.
#pragma once

#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/Switch>
#include <osgViewer/Viewer>

#include <memory>

namespace flightgear
{

struct Frame
{
    int width = 1600, height = 900;
    double fieldOfView = 40.0; ///< vertical, degrees
    int samples = 4;
    bool lamps = false; ///< of towns and runways

    osg::Matrixd projection() const;
    /// The size of a pixel, as a share of the distance of what it shows.
    double pixel() const;
};

/// FlightGear shows its lamps at night.
void hideLamps(osg::Camera& camera);

/// Whether two pictures have the same bytes.
bool same(const osg::Image& a, const osg::Image& b);

/// Draws a scene, or its world without the kit. Throws std::runtime_error with a sentence.
class Drawing
{
public:
    Drawing(const osgGeoFX::Scene& scene, const Frame& frame);

    osg::Camera& camera() { return *_viewer->getCamera(); }
    /// Whether the EffectScene is above the world; true at first.
    void setWithEffects(bool on) { _root->setSingleChildOn(on ? 0 : 1); }
    /** Draws until two pictures in a row are the same. SimGear asks OpenGL about a technique in the first frame that
        wants it, and draws with it in the next one. */
    osg::ref_ptr<osg::Image> draw(const osg::Matrixd& view);

private:
    osg::ref_ptr<osg::Image> drawOnce();

    osg::ref_ptr<osg::Switch> _root = new osg::Switch;
    osg::ref_ptr<osgViewer::Viewer> _viewer;
    osg::ref_ptr<osgGeoFX::ImageCapture> _capture;
    std::unique_ptr<osgGeoFX::PagerMonitor> _monitor;
};

} // namespace flightgear
