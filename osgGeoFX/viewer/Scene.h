// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TileGuard.h>
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

/** What a scene wishes of the program that shows it, from user values of its root node (the .geofx plugin sets them):

    `geofx.homeView` string "LON,LAT,ALT,HEADING,PITCH[,ROLL]" in degrees and metres; `geofx.homeFov` double, the
    vertical field of view in degrees; `geofx.background` string "r,g,b", 0…1; `geofx.hasLight` bool, true where
    the scene has a light of its own and wants no headlight. All are optional. */
struct OSGGEOFX_EXPORT SceneSettings
{
    std::optional<ViewPoint> homeView;
    std::optional<double> homeFov; ///< degrees
    osg::Vec4 background = {0.72f, 0.80f, 0.88f, 1.0f};
    bool hasLight = false;

    /// Nothing, and a sentence in `error`, where a value is there but cannot be understood.
    static std::optional<SceneSettings> read(const osg::Node& root, std::string& error);
};

/// A scene file, read for showing: its tiles are guarded, and what it says about itself is at hand.
struct OSGGEOFX_EXPORT Scene
{
    osg::ref_ptr<osg::Node> node;
    /// The first EffectScene in the file, or an empty one that was put above it and is `node`. Never null.
    osg::ref_ptr<EffectScene> effects;
    osg::ref_ptr<TileGuard> guard;
    SceneSettings settings;
    std::optional<TerrainInfo> terrain;
    osg::ref_ptr<Georeference> reference; ///< null where the scene has none
    std::string referenceError;           ///< why there is none

    /// Nothing, and a sentence in `error`, where the scene cannot be read. With the option string "allowOutside" a .geofx scene
    /// may name files outside its folder, and addresses; without, it is refused.
    static std::optional<Scene> load(const std::string& file, std::string& error,
                                     const osgDB::Options* options = nullptr);
    /// The same for a scene that has been read already.
    static std::optional<Scene> adopt(osg::Node* node, std::string& error);

    /// Gives a view the scene's background and light, and near and far planes fit for a wide landscape. The scene data
    /// and the camera's place are left alone.
    void setUpView(osg::View& view) const;

    /// The LOD scale that keeps the terrain's pixel-error bound; 1 for a scene without a terrain of ours.
    /// `height` is the picture's in pixels, `fieldOfView` the vertical one in radians.
    float lodScale(double height, double fieldOfView) const;

    /// The home view, or else one that shows the whole scene. `aspect` is width / height, `fieldOfView` the
    /// vertical one in radians.
    osg::Matrixd homeViewMatrix(double fieldOfView, double aspect) const;
};

} // namespace osgGeoFX
