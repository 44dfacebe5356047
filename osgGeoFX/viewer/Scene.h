// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/Node>
#include <osg/Vec4>
#include <osg/View>
#include <osgDB/Options>

#include <optional>
#include <string>

namespace osgGeoFX
{

/** The settings that a scene gives to the program that shows it. They are user values of its root node; the .geofx
    plugin sets them. All are optional:

    - `geofx.homeView`: string "LON,LAT,HEIGHT,HEADING,PITCH[,ROLL]" in degrees and metres.
    - `geofx.homeFov`: double, the vertical field of view in degrees, between 0 and 180.
    - `geofx.background`: string "r,g,b", 0…1.
    - `geofx.hasLight`: bool, true if the scene has its own light and needs no headlight.
    - `geofx.visibility`: double, metres, above 0, if the scene has haze (EarthSky.h).
    - `geofx.hasSky`: bool, true if the scene draws a sky.
    @ingroup viewer */
struct OSGGEOFX_EXPORT SceneSettings
{
    std::optional<ViewPoint> homeView;
    std::optional<double> homeFov; ///< vertical, degrees
    osg::Vec4 background = {0.72f, 0.80f, 0.88f, 1.0f};
    bool hasLight = false;
    std::optional<double> visibility; ///< of haze, metres
    bool hasSky = false;

    /// Returns nothing, with a sentence in `error`, if a value is present but invalid.
    static std::optional<SceneSettings> read(const osg::Node& root, std::string& error);
};

/// A scene file that is loaded and ready to be shown: its tiles are guarded, and its settings and terrain facts are
/// read.
/// @ingroup viewer
struct OSGGEOFX_EXPORT Scene
{
    osg::ref_ptr<osg::Node> node;
    /// The first EffectScene in the file, or a new empty one above the file's node; then `node` is this one. Never
    /// null.
    osg::ref_ptr<EffectScene> effects;
    osg::ref_ptr<TileGuard> guard;
    SceneSettings settings;
    std::optional<TerrainInfo> terrain;
    osg::ref_ptr<Georeference> reference; ///< null if the scene has none
    std::string referenceError;           ///< the reason why there is none

    /// Returns nothing, with a sentence in `error`, if the scene cannot be read. The option string "allowOutside" lets
    /// a .geofx scene name network addresses and files outside its folder; without it such a scene is refused.
    static std::optional<Scene> load(const std::string& file, std::string& error,
                                     const osgDB::Options* options = nullptr);
    /// The same for a scene that the program has already read.
    static std::optional<Scene> adopt(osg::Node* node, std::string& error);

    /// Sets a view's background, light and near/far ratio (1 : 5000) for a wide landscape. It changes neither the
    /// scene data nor the camera's pose.
    void setUpView(osg::View& view) const;

    /// Adds a city model of others to the effects' children, in the scene's world coordinates. Its buildings keep their shape in
    /// bends (RigidModel), also those of tiles that are read later. False, with a sentence in `error`, if the file cannot be read.
    /// Call it before the scene is shown.
    bool addCity(const std::string& file, std::string& error, const osgDB::Options* options = nullptr);

    /// Puts a sky around the Earth (makeEarthSky()) behind the scene. The color of its deep air is the background's, and its haze the scene's.
    /// A scene that has a sky keeps its own. False, with a sentence in `error`, if the scene is not geocentric. Call it before the
    /// scene is shown.
    bool addSky(std::string& error);

    /// Adds to the node what reads the depths of each picture as soon as it is drawn, for what is put onto pictures. Call it before the scene is shown.
    osg::ref_ptr<DepthReader> readDepths();

    /// The LOD scale that keeps the terrain's pixel-error bound; 1 for a scene without a terrain of osggeofx_build.
    /// `height` is the height of the viewport in pixels, `fieldOfView` is vertical, in radians.
    float lodScale(double height, double fieldOfView) const;

    /// The view matrix of the home view or, if there is none, of a view of the whole scene. `fieldOfView` is vertical,
    /// in radians; `aspect` is width / height.
    osg::Matrixd homeViewMatrix(double fieldOfView, double aspect) const;
};

} // namespace osgGeoFX
