// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>
#include <osg/Image>
#include <osg/State>
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgViewer/Viewer>

#include <functional>
#include <memory>

namespace geofx::test
{

/** A test with an OpenGL context and a viewer, both off-screen, that draws in the test's own thread.

    Every message of OpenGL that tells of an error, of undefined, deprecated or unportable behaviour, or
    whose severity is medium or high, and every notice and warning of OSG fails the test at once. Without
    a context the test fails where GEOFX_REQUIRE_GL=1 is in the environment (under ctest), and is skipped
    elsewhere. */
class GlFixture : public ::testing::Test
{
protected:
    explicit GlFixture(int width = 256, int height = 256, unsigned int samples = 0);
    ~GlFixture() override;

    void SetUp() override;
    void TearDown() override;

    /// Draws with its camera: view, projection and clear color are the test's to set.
    osgViewer::Viewer& viewer() { return *_viewer; }
    osgGeoFX::EglGraphicsContext& context() { return *_context; }
    NotifyWatch& watch() { return *_watch; }

    /// One frame of a scene, with the viewer's camera.
    osg::ref_ptr<osg::Image> render(osg::Node* scene);

    /// Runs an action with the context current.
    void withContext(const std::function<void(osg::State&)>& action);

private:
    void reportGl(const osgGeoFX::EglGraphicsContext::DebugMessage& message);

    const int _width;
    const int _height;
    const unsigned int _samples;
    std::unique_ptr<NotifyWatch> _watch;
    osg::ref_ptr<osgGeoFX::EglGraphicsContext> _context;
    osg::ref_ptr<osgGeoFX::ImageCapture> _capture;
    osg::ref_ptr<osgViewer::Viewer> _viewer;
};

} // namespace geofx::test
