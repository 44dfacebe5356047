// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "CloseUpsLoader.h"

#include <osgGeoFX/viewer/EffectKinds.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// One effect and the terrain below it.
class Loader
{
public:
    Loader(const SceneCloseUps& closeUps, SceneTerrain& terrain) : _closeUps(closeUps), _terrain(terrain) {}

    void load()
    {
        for (const SceneTable& table : _closeUps.tables)
            readTable(table);
        if (_closeUps.surfaceData) loadData(*_closeUps.surfaceData);
        for (const SceneCloseUp& closeUp : _closeUps.closeUps)
            place(closeUp);
        const std::string fault = whyItDrawsNothing(*_closeUps.effect);
        if (!fault.empty()) warn(_closeUps.place, fault);
    }

private:
    void loadData(const SceneSurfaceData& scene)
    {
        SurfaceRequest request;
        request.maxSide = sideOf(scene);
        request.radius = scene.radius;
        request.data = new SurfaceData;
        request.frame = _terrain.frame();
        if (scene.box) setRectangle(scene, *scene.box, request);
        for (const SceneSurface& surface : scene.surfaces)
        {
            if (surface.source == SceneSurface::DERIVED)
            {
                if (!request.data->addDerived(surface.name, surface.kind, scene.radius))
                    fail(surface.place, "it cannot be derived; check that the heights before it are there.");
                continue;
            }
            request.surface = &surface;
            request.done = false;
            const std::string fault =
                SceneTerrain::ask(surface.place, "surfaceData", &request, "leave <surfaceData> out");
            if (!request.done) fail(surface.place, fault);
        }
        for (int i = 0; i < request.data->getNumLayers(); ++i)
            _terrain.count(request.data->getLayerImage(i));
        _closeUps.effect->setSurfaceData(request.data);
    }

    int sideOf(const SceneSurfaceData& scene) const
    {
        // Four floats in each layer, and while a DEM is read some more.
        constexpr double texel = 16.0, ofDem = 5.0, more = 3.0;
        double layers = more;
        const ScenePath* file = nullptr;
        for (const SceneSurface& surface : scene.surfaces)
        {
            layers += surface.source == SceneSurface::DEM ? ofDem : 1.0;
            if (!file && surface.source != SceneSurface::DERIVED) file = &surface.file;
        }
        return file ? _terrain.sideWithin(*file, scene.maxSide, layers * texel) : scene.maxSide;
    }

    /// About the middle of the edges.
    void setRectangle(const SceneSurfaceData& scene, SceneBox box, SurfaceRequest& request)
    {
        _terrain.straighten(scene.place, box);
        const osg::Vec2d middle((box.west + box.east) / 2.0, (box.south + box.north) / 2.0);
        SurfaceData& data = *request.data;
        data.setLocalOrigin(_terrain.originAt(middle));
        request.frame.origin = data.getLocalOrigin();
        includeEdges(scene.place, box, request);
        if (!data.setRectangle(request.low, request.high))
            fail(scene.place, "it covers no area on the ground; move its edges apart.");
    }

    /// The rectangle in the frame that holds all of the edges; on a globe they are bent there.
    void includeEdges(const ScenePlace& place, const SceneBox& box, SurfaceRequest& request)
    {
        // Beyond, the frame's plane is seen from its edge.
        constexpr double most = 60.0;
        if (_terrain.ellipsoid() && (box.east - box.west > 2.0 * most || box.north - box.south > 2.0 * most))
            fail(place, "it covers too much of the globe; expected: 120 degrees at most.");
        const osg::EllipsoidModel* ellipsoid = _terrain.ellipsoid();
        const osg::Matrixd toFrame = osg::Matrixd::inverse(request.data->frameToWorld(ellipsoid));
        request.low.set(1e30, 1e30);
        request.high.set(-1e30, -1e30);
        constexpr int steps = 16;
        for (int i = 0; i <= steps; ++i)
        {
            for (int j = 0; j <= steps; ++j)
            {
                const osg::Vec2d point(box.west + (box.east - box.west) * i / steps,
                                       box.south + (box.north - box.south) * j / steps);
                const osg::Vec3d inFrame = _terrain.worldOfMap(place, point) * toFrame;
                for (int axis = 0; axis < 2; ++axis)
                {
                    request.low[axis] = std::min(request.low[axis], inFrame[axis]);
                    request.high[axis] = std::max(request.high[axis], inFrame[axis]);
                }
            }
        }
    }

    void place(const SceneCloseUp& closeUp)
    {
        RegionOfInterest& region = *closeUp.closeUp->getRegion();
        if (closeUp.image && !region.setImage(_terrain.pictureOf(*closeUp.image)))
            fail(closeUp.place, "the picture \"" + closeUp.image->path +
                                    "\" cannot be a mask; expected: a plain picture, such as a grey PNG.");
        if (_terrain.ellipsoid())
        {
            if (closeUp.center == SceneCloseUp::METRES)
                fail(closeUp.place, "the terrain is a globe; write longitude and latitude in the place "
                                    "of centerX and centerY.");
            if (closeUp.center == SceneCloseUp::NOTHING)
                fail(closeUp.place, "nothing says where the region lies, and the terrain is a globe; give "
                                    "<region> its longitude and latitude.");
        }
        else if (closeUp.center == SceneCloseUp::DEGREES)
        {
            const osg::Vec3d world =
                _terrain.worldOf(closeUp.place, osg::RadiansToDegrees(region.getLongitude()),
                                 osg::RadiansToDegrees(region.getLatitude()));
            region.setCenter({world.x(), world.y()});
        }
        const osg::Vec2d center = _terrain.ellipsoid()
                                      ? osg::Vec2d(osg::RadiansToDegrees(region.getLongitude()),
                                                   osg::RadiansToDegrees(region.getLatitude()))
                                      : region.getCenter();
        _terrain.warnIfOff(closeUp.place, center, std::hypot(region.getWidth(), region.getDepth()) / 2.0);
    }

    const SceneCloseUps& _closeUps;
    SceneTerrain& _terrain;
};

} // namespace

void loadCloseUps(const SceneFile& scene, SceneTerrain& terrain)
{
    for (const SceneCloseUps& closeUps : scene.closeUps)
        Loader(closeUps, terrain).load();
}

} // namespace osgGeoFX
