// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>

#include <osgViewer/Viewer>

#include <string>
#include <vector>

namespace geofx::test
{

/// A viewer in a context of OpenGL 3.3 with the core profile.
class CoreView
{
public:
    CoreView(int width, int height);
    ~CoreView();
    CoreView(const CoreView&) = delete;
    CoreView& operator=(const CoreView&) = delete;

    bool valid() const { return viewer.valid(); }
    osg::State& state() { return *_context->getState(); }
    osg::ref_ptr<osg::Image> render(osg::Node* scene, const osg::Camera& like, int frames = 1);

    osg::ref_ptr<osgViewer::Viewer> viewer;
    std::vector<std::string> errors; ///< of OpenGL, but for those of what OSG itself calls in any context

private:
    osg::ref_ptr<osgGeoFX::EglGraphicsContext> _context;
    osg::ref_ptr<osgGeoFX::ImageCapture> _capture;
};

} // namespace geofx::test
