// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneFile.h"

#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Image>

#include <map>
#include <set>
#include <tuple>

namespace osgGeoFX
{

/// Thrown by what loads the parts of a scene, with the whole sentence; it does not leave this plugin.
struct SceneFailure
{
    std::string sentence;
};

[[noreturn]] void fail(const ScenePlace& place, const std::string& text);

/// What osgdb_geofxdata is asked for under the name "picture", and its answer: a raster's own pixels.
struct PictureRequest
{
    std::string file;
    std::optional<DataLayer::Kind> kind;
    int maxSide = 0;
    bool look = false; ///< without pixels
    int width = 0;     ///< of the file
    int height = 0;
    osg::ref_ptr<osg::Image> image;
    bool done = false;
};

/// A warning about a place of the scene file.
void warn(const ScenePlace& place, const std::string& text);
/// The colors of a file.
void readTable(const SceneTable& table);

/// The terrain of a scene, and where places of its file lie on it.
class SceneTerrain
{
public:
    /// The terrain is a child of the scene's node already. Both must outlive this. `anywhere`: the program trusts the scene.
    SceneTerrain(const EffectScene& node, const osg::Node& terrain, bool anywhere)
        : _terrain(terrain), _ellipsoid(node.ground().ellipsoid), _anywhere(anywhere)
    {
    }

    /** The picture of a file, or a film; several requests for the same give the same image. Colors are read by OSG, and by GDAL
        where OSG does not know the file, where it is a TIFF, or where it is so large that it must be reduced while it is read; values
        and classes by GDAL, and by OSG where GDAL does not know it or is not there. What GDAL reads has no more than `maxSide` texels
        on a side; a warning says where it had more. Without the program's trust OSG reads only what FilesByOthers reads, and all
        pictures of a scene take up to 512 MiB. */
    osg::ref_ptr<osg::Image> pictureOf(const ScenePath& file, DataLayer::Kind kind = DataLayer::COLOR,
                                       int maxSide = 16384);
    /// How many texels a raster of the scene may have along a side, `maxSide` at most, so that the pictures stay within their limit;
    /// a warning tells of fewer. `bytes`: of a texel, while the raster is read. Throws SceneFailure where the limit is reached.
    int sideWithin(const ScenePath& file, int maxSide, double bytes = 16.0) const;
    /// Counts a picture that others have read, once.
    void count(const osg::Image* image);
    /// How many texels of colors the pictures may still have; very many where the program trusts the scene.
    double texelsLeft() const;
    /// The pictures of KML files that are shared; null where the program trusts the scene.
    OverlayRaster::Pictures* overlayPictures() { return _anywhere ? nullptr : &_overlayPictures; }

    const osg::Node& node() const { return _terrain; }
    /// Null on a projected terrain.
    const osg::EllipsoidModel* ellipsoid() const { return _ellipsoid; }
    /// Of degrees; on a projected terrain by its georeference.
    osg::Vec3d worldOf(const ScenePlace& place, double longitude, double latitude);
    /// Checks the unit of edges; on a globe, the eastern one is beyond the western one afterwards.
    void straighten(const ScenePlace& place, SceneBox& box) const;
    /// Warns where a region about a point of the map, within so many metres of it, lies off the terrain.
    void warnIfOff(const ScenePlace& place, const osg::Vec2d& point, double reach);
    /// Of a point of the map: degrees on a globe, else metres.
    osg::Vec3d worldOfMap(const ScenePlace& place, const osg::Vec2d& point);
    /// The origin of a frame at a point of the map.
    LocalOrigin originAt(const osg::Vec2d& point) const;
    /// Null, with the reason, where the terrain has none.
    osg::ref_ptr<Georeference> reference(std::string& error);
    /// A frame without its origin.
    MappingFrame frame() const;
    /// Asks osgdb_geofxdata to answer a request; without it, `instead` is what a person may do. Its sentence, empty as a
    /// rule.
    static std::string ask(const ScenePlace& place, const std::string& service, void* request,
                           const std::string& instead);
    /// The same; nothing where there is no such plugin.
    static std::optional<std::string> askIfAny(const std::string& service, void* request,
                                               const std::string& plugin = "geofxdata");

private:
    osg::ref_ptr<osg::Image> readPicture(const ScenePath& file, DataLayer::Kind kind, int maxSide);

    const osg::Node& _terrain;
    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    const bool _anywhere;
    osg::ref_ptr<Georeference> _reference;
    std::map<std::tuple<std::string, DataLayer::Kind, int>, osg::ref_ptr<osg::Image>> _pictures;
    OverlayRaster::Pictures _overlayPictures;
    std::set<osg::ref_ptr<const osg::Image>> _counted;
    double _pictureBytes = 0.0;
};

} // namespace osgGeoFX
