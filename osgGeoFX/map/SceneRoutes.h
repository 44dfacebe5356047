// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RoutePath.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Node>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Shows ways of files on the ground of a scene: GPX, KML and any vector data with lines (RouteVectors), as RouteMapping draws them.

    @code
    osgGeoFX::SceneRoutes routes(*scene.node, *scene.effects);
    if (!routes.add("hike.gpx", {}, error)) …
    @endcode

    A way lies on the ground, whatever its altitude mode is, and one with heights is in the air, too (`ribbons`): above the sea, or above the ground of
    the scene, as fine as its database has it. It follows geodesics between its places. Way points get marks,
    the points of tracks none. Buildings of a town (RigidParts) stand on ways, and do not show them. Each is a RouteMapping, which stays in the scene when this object is gone: they are in effects named "routes", behind the scene's
    other effects, one for each part of the globe of 45° of arc. The plugin osgdb_geofxdata reads the files. One thread at a time, between frames.
    @ingroup map */
class OSGGEOFXMAPS_EXPORT SceneRoutes
{
public:
    /// `node`: the scene's outermost node, with all that tells its place on the Earth. Both must outlive this.
    SceneRoutes(osg::Node& node, EffectScene& scene);

    struct Options
    {
        std::string layer; ///< one layer; empty: all
        RoutePath::Look look;
        bool onGround =
            true; ///< whether ways lie on the ground; without it there is what `ribbons` says alone
        bool ribbons =
            true; ///< whether ways with heights are also drawn in the air (PathRibbon): as tubes, extruded ones with a curtain
    };
    /// Adds the ways of a file. False, with a sentence in `error`, if it cannot; the ways before the one at fault stay then.
    bool add(const std::string& file, const Options& options, std::string& error);
    /// Adds a way. False, with a sentence in `error`, if it cannot.
    bool add(const RoutePath& route, const Options& options, std::string& error);

    /// Of the KML files that were added: these themselves and the files on disk that they link or show.
    const std::vector<std::string>& files() const { return _files; }

private:
    struct Way
    {
        std::vector<osg::Vec3d> world;
        osg::Vec3d middle;
        double radius = 0.0; ///< metres
    };
    bool placeOf(const RoutePath& route, Way& way, std::string& error);
    ProjectiveMappings* effectFor(const Way& way, std::string& error);
    bool addMappings(const RoutePath& route, const Way& way, const Options& options, std::string& error);
    bool addRibbons(const RoutePath& route, const Options& options, std::string& error);

    class Heights;
    osg::Node& _node;
    osg::ref_ptr<EffectScene> _scene;
    const double _groundExtent;        ///< metres; negative where there is no ground
    std::shared_ptr<Heights> _heights; ///< of the ground; null until they are needed
    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    osg::ref_ptr<Georeference> _reference;
    std::string _referenceError;
    std::vector<osg::ref_ptr<ProjectiveMappings>> _effects;
    std::vector<osg::ref_ptr<osg::Node>> _ribbons;
    std::vector<std::string> _files;
};

} // namespace osgGeoFX
