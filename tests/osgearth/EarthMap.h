// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osgEarth/MapNode>
#include <osgViewer/Viewer>

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

namespace geofx::test
{

class TempDir;

/** Maps of osgEarth in an OpenGL context without a window: hills of 1 degree at the equator, 0…1000 m high, in several
    colors and without light, on a globe or in a projection. */
class EarthMaps : public testing::Test
{
protected:
    static constexpr int WIDTH = 320, HEIGHT = 200;

    EarthMaps();
    ~EarthMaps() override;
    void SetUp() override;

    /// The profile of the maps that are shown from now on; "" for a globe.
    void setProfile(const std::string& name) { _profile = name; }
    /// Writes an .earth file with an extension's element, and shows it. False, after a failure, if it cannot be read.
    bool show(const std::string& geofx, const std::string& terrainOptions = "skirt_ratio=\"0.05\"");
    /// Shows a map that is not ours, without an extension. False, after a failure, if it cannot be read.
    bool showFile(const std::string& file);
    /// Adds an extension with this element to the map that is shown. False, after a failure, if there is no scene then.
    bool addExtension(const std::string& geofx);
    /// What scene files have in <effects>, as an extension.
    static std::string extension(const std::string& effects, const std::string& culling = "proxy");
    /// A picture from a place, degrees and metres, when all tiles have come.
    osg::ref_ptr<osg::Image> draw(double longitude, double latitude, double height, double heading,
                                  double pitch);
    /// From a view matrix.
    osg::ref_ptr<osg::Image> draw(const osg::Matrixd& view);
    /// The view matrix of a camera at a place, degrees and metres.
    osg::Matrixd viewFrom(double longitude, double latitude, double height, double heading, double pitch);
    /// Where the labels and icons of the last picture stand, pixels, by their drawables.
    std::map<const osg::Drawable*, osg::Vec2d> laidOut();
    /// Leaves the ground in one color.
    void hideImages();
    /// Pixels that differ.
    static int differing(const osg::Image& a, const osg::Image& b);

    osgViewer::Viewer& viewer() { return *_viewer; }
    osg::Camera& camera() { return *_viewer->getCamera(); }
    /// The scene of the extension; null for none.
    osgGeoFX::EffectScene* scene();
    osgEarth::MapNode& map() { return *_map; }
    const std::string& file() const { return _file; }
    /// The projection that each picture begins with.
    void setProjection(double near, double far);
    const osg::Matrixd& projection() const { return _projection; }

    /// How long labels take to fade in, milliseconds.
    int fading = 0;

private:
    bool startViewer();
    bool showMap(const std::string& file);

    std::unique_ptr<TempDir> _folder;
    std::string _file, _profile;
    osg::ref_ptr<osgEarth::MapNode> _map;
    osg::ref_ptr<osg::Group> _root;
    osg::ref_ptr<osgViewer::Viewer> _viewer;
    osg::Matrixd _projection;
};

} // namespace geofx::test
