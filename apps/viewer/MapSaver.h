// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <optional>
#include <string>
#include <vector>

namespace geofx::viewer
{

/// Writes the panorama map that a view shows, with all that was tuned, by the key F12: as a scene file, and as a recipe of
/// osggeofx_panorama. They lie beside the file that the viewer shows, as NAME-map.geofx and NAME-map.json; a number keeps
/// them apart from those that are there.
class MapSaver : public osgGA::GUIEventHandler
{
public:
    /// `file`: what the viewer shows.
    MapSaver(const osgGeoFX::Scene& scene, std::string file);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// What was written, or why it was not, as one sentence for each file.
    std::string save(osgViewer::View& view) const;

private:
    struct Pose
    {
        osg::Vec2d place; ///< degrees on a globe, else the world's x and y
        double longitude, latitude, height;
        double heading;             ///< from the grid's north on a projected terrain, radians
        double northHeading;        ///< from north
        double radius, fieldOfView; ///< metres, radians
    };
    std::optional<Pose> poseOf(osgGeoFX::PanoramaMap& map, const osg::Camera& camera) const;
    void writeRecipe(const osgGeoFX::PanoramaMap& map, const Pose& pose, const osg::Camera& camera,
                     const std::string& file) const;
    void writeScene(const osgGeoFX::PanoramaMap& map, const Pose& pose, const std::string& file) const;

    const osgGeoFX::Scene _scene;
    const std::string _file;
    /// The scene's effects when it was made: first those of the file, in its order.
    std::vector<osg::ref_ptr<osgGeoFX::Effect>> _known;
};

} // namespace geofx::viewer
