// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MappingsLoader.h"

#include "MapLoader.h"

#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/PathRibbon.h>
#include <osgGeoFX/panorama/TerrainRelief.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <osg/Math>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace osgGeoFX
{

namespace
{

/// Without a transfer of its own, a mapping shows its table, or its values from the lowest to the highest.
void setTransfer(ProjectiveMapping& mapping, double lowest, double highest)
{
    const osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
    if (mapping.getTable())
    {
        transfer->setSource(ColorTransfer::TABLE);
        std::tie(lowest, highest) = mapping.getTable()->range();
    }
    constexpr double most = 9e7;
    lowest = std::clamp(lowest, -most, most);
    highest = std::clamp(highest, -most, most);
    if (lowest < highest) transfer->setValueRange(lowest, highest);
    mapping.setTransfer(transfer);
}

/// One effect and the terrain below it.
class Loader
{
public:
    Loader(const SceneMappings& mappings, SceneTerrain& terrain, EffectScene& node)
        : _mappings(mappings), _effect(*mappings.effect), _terrain(terrain), _node(node),
          _ellipsoid(terrain.ellipsoid()), _hasOrigin(mappings.hasOrigin)
    {
    }

    void load()
    {
        for (const SceneMappings::Layer& layer : _mappings.layers)
            layer.layer->setImage(
                _terrain.pictureOf(layer.file, layer.layer->getKind(), _mappings.effect->getPageSide()));
        for (const SceneTable& table : _mappings.tables)
            readTable(table);
        for (const SceneMapping& mapping : _mappings.mappings)
        {
            if (mapping.box)
                place(mapping, *mapping.box);
            else if (mapping.point)
                place(mapping, *mapping.point);
            else if (mapping.raster)
                place(mapping, *mapping.raster);
            if (!mapping.raster && !mapping.hasTransfer && mapping.mapping->getTable())
                setTransfer(*mapping.mapping, 0.0, 1.0);
            // The origin is the first mapping's, or nobody's.
            _hasOrigin = true;
        }
        for (const SceneSequence& sequence : _mappings.sequences)
            add(sequence);
        for (const SceneOverlay& overlay : _mappings.overlays)
            add(overlay);
        for (const SceneRoute& route : _mappings.routes)
            add(route);
        const std::string fault = whyItDrawsNothing(_effect);
        if (!fault.empty()) warn(_mappings.place, fault);
    }

private:
    osg::Vec2d placeOf(const ScenePlace& place, const osg::Vec3d& world) const
    {
        if (_ellipsoid)
        {
            const osg::Vec3d there = _ellipsoid->computeLocalUpVector(world.x(), world.y(), world.z());
            const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Z_AXIS, _effect.frameToWorld(_ellipsoid));
            // Where the frame's plane is seen from its edge, a place has no x and y to go by.
            constexpr double nearlyBeyond = 0.05;
            if (there * up < nearlyBeyond)
                fail(place, "it lies on the other side of the globe from the effect's origin; give "
                            "<projectiveMappings> its longitude and latitude near it.");
        }
        const osg::Vec3d result = _effect.placeOf(world, _ellipsoid);
        return {result.x(), result.y()};
    }

    void setOrigin(const osg::Vec2d& middle)
    {
        if (!_hasOrigin) _effect.setLocalOrigin(_terrain.originAt(middle));
    }

    void place(const SceneMapping& mapping, SceneBox box)
    {
        _terrain.straighten(mapping.place, box);
        setOrigin({(box.west + box.east) / 2.0, (box.south + box.north) / 2.0});
        const osg::Vec2d edges[4] = {
            {box.west, box.south}, {box.east, box.south}, {box.east, box.north}, {box.west, box.north}};
        osg::Vec2d corners[4];
        for (int i = 0; i < 4; ++i)
            corners[i] = placeOf(mapping.place, _terrain.worldOfMap(mapping.place, edges[i]));
        if (!mapping.mapping->setQuad(corners))
            fail(mapping.place,
                 "its corners span no quadrilateral on the ground; keep its edges apart, and off "
                 "the poles.");
    }

    void place(const SceneMapping& mapping, const SceneMapping::Point& point)
    {
        const osg::Vec3d world = _terrain.worldOf(mapping.place, point.longitude, point.latitude);
        setOrigin(_ellipsoid ? osg::Vec2d(point.longitude, point.latitude)
                             : osg::Vec2d(world.x(), world.y()));
        mapping.mapping->setCenter(placeOf(mapping.place, world));
    }

    /// The same for all mappings of the effect that show a raster.
    const MappingRasterRequest& read(const ScenePlace& place, const SceneMapping::Raster& raster)
    {
        const auto [known, isNew] = _rasters.emplace(
            std::make_tuple(osgDB::getRealPath(raster.file.path), raster.file.variable, raster.kind,
                            raster.maxSide, raster.bands ? raster.bands->channels[0].range : std::nullopt),
            MappingRasterRequest());
        MappingRasterRequest& request = known->second;
        if (!isNew) return request;
        request.file = raster.file.name();
        request.options.kind = raster.kind;
        request.options.maxSide = _terrain.sideWithin(raster.file, raster.maxSide);
        if (raster.bands) request.options.bands = *raster.bands;
        request.hasOrigin = _hasOrigin;
        request.frame = _terrain.frame();
        request.frame.origin = _effect.getLocalOrigin();
        const std::string fault =
            SceneTerrain::ask(place, "mappingRaster", &request, "use a <layer> with a <mapping>");
        if (!request.raster.layer) fail(place, fault);
        _effect.setLocalOrigin(request.frame.origin);
        _terrain.count(request.raster.layer->getImage());
        return request;
    }

    void place(const SceneMapping& mapping, const SceneMapping::Raster& raster)
    {
        const MappingRasterRequest& request = read(mapping.place, raster);
        if (!request.raster.apply(*mapping.mapping))
            fail(mapping.place, "the raster covers no area on the ground; check it with gdalinfo.");
        const bool plainColors =
            request.raster.layer->getKind() == DataLayer::COLOR && !mapping.mapping->getTable();
        if (!mapping.hasTransfer && !plainColors)
            setTransfer(*mapping.mapping, request.raster.lowest, request.raster.highest);
    }

    void add(const SceneSequence& each)
    {
        SceneSequenceRequest request;
        request.file = each.file.name();
        request.globe = _ellipsoid != nullptr;
        request.wkt = _terrain.frame().wkt;
        // Some steps are in memory at a time.
        request.maxSide = _terrain.sideWithin(each.file, each.maxSide, 64.0);
        request.moves = !_hasOrigin;
        request.origin = _effect.getLocalOrigin();
        const std::string fault =
            SceneTerrain::ask(each.place, "sceneSequence", &request, "use a <layer> with a <mapping>");
        if (!request.steps) fail(each.place, fault);
        _effect.setLocalOrigin(request.origin);
        _hasOrigin = true;
        const osg::ref_ptr<LayerSequence> sequence = new LayerSequence(request.steps);
        sequence->setBlending(each.blending);
        ProjectiveMapping& mapping = *each.mapping;
        const osg::Vec2d half = (request.high - request.low) / 2.0;
        if (!mapping.setRectangle(request.low + half, half.x(), half.y()))
            fail(each.place, "the rasters cover no area on the ground; check them with gdalinfo.");
        mapping.setLayer(sequence->getLayer());
        LayerWords::setUnit(*sequence->getLayer(), request.unit);
        const bool plainColors = request.steps->kind() == DataLayer::COLOR && !mapping.getTable();
        if (!each.hasTransfer && !plainColors) setTransfer(mapping, request.lowest, request.highest);
        if (mapping.getName().empty()) mapping.setName(request.variable);
        _effect.addMapping(&mapping);

        LayerPlayer& player = *LayerPlayer::onto(_node);
        const std::string clash = player.faultOf(*sequence);
        if (!clash.empty()) fail(each.place, clash);
        player.add(sequence, LayerPlayer::usualTime);
        if (each.speed) player.getClock()->setSpeed(*each.speed);
        // So that there is a picture in the first frame.
        sequence->setWaiting(true);
        sequence->update();
        sequence->setWaiting(false);
        if (!sequence->fault().empty()) fail(each.place, sequence->fault());
        _terrain.count(sequence->getLayer()->getImage());
    }

    void add(const SceneOverlay& overlay)
    {
        SceneOverlaysRequest request;
        request.file = overlay.file.path;
        request.globe = _ellipsoid != nullptr;
        request.wkt = _terrain.frame().wkt;
        request.maxSide = _terrain.sideWithin(overlay.file, overlay.maxSide);
        request.maxTexels = _terrain.texelsLeft();
        request.pictures = _terrain.overlayPictures();
        request.layer = overlay.layer;
        if (overlay.style) request.style = overlay.style->path;
        request.bands = overlay.bands;
        if (_hasOrigin) request.frames.push_back(_effect.getLocalOrigin());
        const osg::BoundingSphere bound = _terrain.node().getBound();
        if (_ellipsoid)
            request.ground = osg::BoundingSphered(bound.center(), static_cast<double>(bound.radius()));
        const std::string fault =
            SceneTerrain::ask(overlay.place, "sceneOverlays", &request, "use a <layer> with a <mapping>");
        if (request.overlays.empty()) fail(overlay.place, fault);
        for (const std::string& notice : request.notices)
            warn(overlay.place, notice);
        for (const GroundOverlay& each : request.overlays)
            if (each.layer) _terrain.count(each.layer->getImage());
        if (request.pictures)
            for (const auto& [key, layer] : *request.pictures)
                _terrain.count(layer->getImage());
        if (request.frames.size() > 1)
            fail(overlay.place,
                 "its rasters lie too far from the effect's origin, or from each other; give them a "
                 "<projectiveMappings> of their own, or split the file.");
        _effect.setLocalOrigin(request.frames[0]);
        _hasOrigin = true;
        giveHeights(request);
        for (const GroundOverlay& each : request.overlays)
        {
            std::string error;
            const osg::ref_ptr<PagedRaster> raster =
                each.tiles ? PagedRaster::create(each.tiles, {}, error) : nullptr;
            if (each.tiles && !raster) fail(overlay.place, error);
            if (raster) each.setLook(*raster->getMapping());
            const osg::ref_ptr<ProjectiveMapping> mapping =
                raster ? osg::ref_ptr<ProjectiveMapping>(raster->getMapping()) : each.makeMapping();
            if (!mapping)
                fail(overlay.place,
                     "the overlay \"" + each.name + "\" covers no area on the ground; correct it.");
            mapping->setOpacity(mapping->getOpacity() * overlay.opacity);
            mapping->setOrder(overlay.order);
            if (raster)
                _effect.addRaster(raster);
            else
                _effect.addMapping(mapping);
        }
    }

    /// Symbols without a height stand on the ground.
    void giveHeights(SceneOverlaysRequest& request) const
    {
        constexpr int cells = 512;
        std::string error;
        std::optional<TerrainRelief> relief;
        for (GroundOverlay& each : request.overlays)
        {
            if (!each.symbol || each.symbol->height) continue;
            if (!relief) relief = TerrainRelief::read(_terrain.node(), _ellipsoid, cells, error);
            if (!relief) return;
            osg::Vec2d place(each.symbol->longitude, each.symbol->latitude);
            if (!relief->geocentric)
                place = (each.corners[0] + each.corners[2]) / 2.0 + request.frames[each.frame].place();
            const double height = relief->heightAt(place.x(), place.y());
            if (std::isfinite(height)) each.symbol->height = height;
        }
    }

    void add(const SceneRoute& route)
    {
        std::vector<RoutePath> paths = {route.path};
        if (route.file)
        {
            SceneRoutesRequest request;
            request.file = route.file->path;
            request.layer = route.layer;
            const std::string fault =
                SceneTerrain::ask(route.place, "sceneRoutes", &request, "use <wayPoint> elements");
            if (request.routes.empty()) fail(route.place, fault);
            paths = request.routes;
        }
        for (RoutePath& path : paths)
        {
            if (route.color) path.color = route.color;
            if (!route.path.name.empty()) path.name = route.path.name;
            if (path.places.empty()) continue;
            const osg::Vec2d degrees(path.places[0].x(), path.places[0].y());
            const osg::Vec3d world = _terrain.worldOf(route.place, degrees.x(), degrees.y());
            setOrigin(_ellipsoid ? degrees : osg::Vec2d(world.x(), world.y()));
            _hasOrigin = true;
            std::string fault;
            RoutePath::Look look = route.look;
            look.groundExtent = 2.0 * static_cast<double>(_terrain.node().getBound().radius());
            const osg::ref_ptr<Georeference> ground = _ellipsoid ? nullptr : _terrain.reference(fault);
            if (!path.showOn(_effect, _ellipsoid, ground, look, fault)) fail(route.place, fault);
            if (path.altitude == RoutePath::CLAMPED || !route.inAir) continue;
            if (path.altitude == RoutePath::ABOVE_GROUND)
            {
                loadWayInAir(route.place, path, look, _node);
                continue;
            }
            std::string error;
            const osg::ref_ptr<Georeference> reference = _terrain.reference(error);
            if (!reference) fail(route.place, error);
            for (const osg::ref_ptr<osg::Node>& ribbon : PathRibbon::nodesOf(path, look, *reference, error))
                _node.addChild(ribbon);
            if (!error.empty()) fail(route.place, error);
        }
    }

    const SceneMappings& _mappings;
    ProjectiveMappings& _effect;
    SceneTerrain& _terrain;
    EffectScene& _node;
    const osg::EllipsoidModel* _ellipsoid;
    bool _hasOrigin;
    using RasterKey = std::tuple<std::string, std::string, std::optional<DataLayer::Kind>, int,
                                 std::optional<std::pair<double, double>>>;
    std::map<RasterKey, MappingRasterRequest> _rasters;
};

} // namespace

void loadMappings(const SceneFile& scene, SceneTerrain& terrain, EffectScene& node)
{
    for (const SceneMappings& mappings : scene.mappings)
        Loader(mappings, terrain, node).load();
}

} // namespace osgGeoFX
