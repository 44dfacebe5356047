// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/effect/detail/GlobeFrame.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/mapping/detail/CameraPages.h>
#include <osgGeoFX/mapping/detail/GpuMappings.h>
#include <osgGeoFX/mapping/detail/Graticule.h>
#include <osgGeoFX/mapping/detail/RankOfRoute.h>

#include <glm/glm.hpp>
#include <osg/Math>
#include <osg/Notify>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <unordered_map>

namespace osgGeoFX
{

/// What drawing needs and no one else sees.
class ProjectiveMappings::Drawing
{
public:
    /// One camera's, in one of the frames that are on their way.
    struct Camera
    {
        Camera() = default;
        Camera(const Camera&) = delete;
        Camera& operator=(const Camera&) = delete;
        ~Camera() { show(nullptr); }

        /// In the place of the former ones.
        void show(const std::shared_ptr<GpuMappings>& others)
        {
            if (gpu == others) return;
            if (gpu) gpu->release(list);
            gpu = others;
        }
        /// Binds the textures of a frame.
        void setTextures(const GpuMappings::Frame& frame, osg::StateSet& state, const std::string& prefix,
                         const std::vector<int>& units)
        {
            if (store != frame.store)
            {
                store = frame.store;
                for (auto& each : textures)
                    each = {new StoreTexture(store, GpuStore::Part::Data),
                            new StoreTexture(store, GpuStore::Part::Layers),
                            new StoreTexture(store, GpuStore::Part::Tables)};
            }
            turn = 1 - turn;
            const char* const names[3] = {"data", "layers", "tables"};
            for (std::size_t i = 0; i < 3; ++i)
            {
                StoreTexture* texture = textures[turn][i];
                texture->show(frame.number);
                state.setTextureAttribute(static_cast<unsigned int>(units[i]), texture);
                state.getOrCreateUniform(prefix + names[i], osg::Uniform::INT)->set(units[i]);
            }
        }

        std::shared_ptr<GpuMappings> gpu;
        /// Two of each, in turn: OSG does not apply anew what it has applied last.
        std::array<std::array<osg::ref_ptr<StoreTexture>, 3>, 2> textures;
        osg::ref_ptr<GpuStore> store;
        std::size_t turn = 0;
        CameraList list;
        CameraPages pages;
        PageFrame plane;
        bool sees = false; ///< whether the plane is that of this frame

        void releaseGLObjects(osg::State* state) { pages.releaseGLObjects(state); }
        void resizeGLObjectBuffers(unsigned int size) { pages.resizeGLObjectBuffers(size); }
    };

    /// The mappings as they lie on a ground. One for each ground that some camera sees them on, and for the last one in any
    /// case.
    std::shared_ptr<GpuMappings> on(const osg::EllipsoidModel* ellipsoid, const Mappings& mappings)
    {
        // By what they say: scenes have ellipsoids of their own that say the same.
        const osg::Vec2d radii =
            ellipsoid ? osg::Vec2d(ellipsoid->getRadiusEquator(), ellipsoid->getRadiusPolar()) : osg::Vec2d();
        const std::lock_guard<std::mutex> lock(_mutex);
        _grounds.erase(std::remove_if(_grounds.begin(), _grounds.end(),
                                      [](const Ground& ground) { return ground.gpu.expired(); }),
                       _grounds.end());
        for (const Ground& ground : _grounds)
        {
            if (ground.radii == radii) _last = ground.gpu.lock();
            if (ground.radii == radii) return _last;
        }
        _last = std::make_shared<GpuMappings>();
        for (const osg::ref_ptr<ProjectiveMapping>& mapping : mappings)
            _last->add(*mapping);
        for (const auto& [rank, mapping] : ranked)
            _last->add(*mapping, rank);
        for (const auto& [whole, parts] : _parts)
            _last->setParts(*whole, parts, {});
        _grounds.push_back({radii, _last});
        return _last;
    }

    /// Replaces what is drawn in the place of a mapping.
    void setParts(const osg::ref_ptr<ProjectiveMapping>& whole, GpuMappings::Parts parts)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        GpuMappings::Parts& former = _parts[whole];
        std::sort(parts.begin(), parts.end());
        GpuMappings::Parts added, removed;
        std::set_difference(parts.begin(), parts.end(), former.begin(), former.end(),
                            std::back_inserter(added));
        std::set_difference(former.begin(), former.end(), parts.begin(), parts.end(),
                            std::back_inserter(removed));
        for (const Ground& ground : _grounds)
        {
            if (const std::shared_ptr<GpuMappings> gpu = ground.gpu.lock())
                gpu->setParts(*whole, added, removed);
        }
        former = std::move(parts);
        if (former.empty()) _parts.erase(whole);
    }

    /// Tells all of them.
    template<class Action>
    void each(const Action& action) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const Ground& ground : _grounds)
        {
            if (const std::shared_ptr<GpuMappings> gpu = ground.gpu.lock()) action(*gpu);
        }
    }

    Capacity capacity() const
    {
        std::uint64_t uploaded = 0;
        each([&](const GpuMappings& gpu) { uploaded += gpu.capacity().uploadedBytes; });
        const std::lock_guard<std::mutex> lock(_mutex);
        Capacity result = _last ? _last->capacity() : Capacity();
        result.uploadedBytes = uploaded;
        return result;
    }

    PerCamera<Camera, osg::StateSet> cameras;
    std::mutex rasters; ///< what one camera takes from them is shown before another one asks
    /// To be found faster than in the list, with the ranks of those of routes, else 0.
    std::unordered_map<const ProjectiveMapping*, std::uint64_t> all;
    std::map<std::uint64_t, osg::ref_ptr<ProjectiveMapping>> ranked; ///< of routes
    std::uint64_t routes = 0;                                        ///< that were added

private:
    struct Ground
    {
        osg::Vec2d radii; ///< of the ellipsoid, metres; 0 without one
        std::weak_ptr<GpuMappings> gpu;
    };
    mutable std::mutex _mutex;
    std::map<osg::ref_ptr<ProjectiveMapping>, GpuMappings::Parts>
        _parts; ///< by what they are drawn for, sorted
    std::vector<Ground> _grounds;
    std::shared_ptr<GpuMappings> _last;
};

namespace
{

glsl::geofx_Exaggeration globeOf(const osg::EllipsoidModel& ellipsoid, double latitude)
{
    glsl::geofx_Exaggeration globe{};
    globe.up = {0.0, 0.0, 1.0};
    globe.axis = {0.0, std::cos(latitude), std::sin(latitude)};
    setGlobe(globe, ellipsoid, std::sin(latitude));
    return globe;
}

template<typename Value>
void setUniform(osg::StateSet& state, const std::string& name, osg::Uniform::Type type, const Value& value)
{
    state.getOrCreateUniform(name, type)->set(value);
}

constexpr double texelsInMegabyte = 65536.0;
/// Fewer may take several turns of loops each: llvmpipe leaves a fragment's loops after 65,536 turns together.
constexpr std::size_t longList = 4096;

bool isPowerOfTwo(int value)
{
    return value > 0 && (value & (value - 1)) == 0;
}

} // namespace

/// Mappings as an effect that draws more than the scene: the pages.
class ProjectiveMappings::Pages : public PassEffect
{
public:
    explicit Pages(Drawing& drawing, const std::vector<osg::ref_ptr<PagedRaster>>& rasters)
        : _drawing(drawing), _rasters(rasters)
    {
    }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "ProjectiveMappings::Pages"; }
    const Properties& properties() const override
    {
        static const Properties none;
        return none;
    }

    DrawableCompanion* companion(const ScenePass& pass) override
    {
        return pass.within() ? nullptr : &_drawing.cameras.of(pass.state).pages.watch();
    }
    void cull(const ScenePass& pass) override
    {
        Drawing::Camera& camera = _drawing.cameras.of(pass.state);
        // What has no bounds asks for no tiles.
        if (camera.sees)
        {
            for (const osg::ref_ptr<PagedRaster>& raster : _rasters)
                see(*raster, camera, pass);
        }
        camera.sees = false;
        // A camera's replacement of the effect may want pages where the scene's list has no units for them.
        if (pass.units.size() == 5) camera.pages.draw(pass, pass.units[3], pass.units[4]);
    }

protected:
    ~Pages() override = default;

private:
    static void see(PagedRaster& raster, Drawing::Camera& camera, const ScenePass& pass)
    {
        const PlaneBox extent{raster.low(), raster.high()};
        PageView view(
            extent, [](const PlaneBox&) { return false; }, pass, camera.plane);
        raster.see(&camera, view.groundBelow(camera.pages.watch().boxes()), view);
    }

    Drawing& _drawing;
    const std::vector<osg::ref_ptr<PagedRaster>>& _rasters;
};

ProjectiveMappings::ProjectiveMappings()
    : _drawing(std::make_unique<Drawing>()), _pages(new Pages(*_drawing, _rasters))
{
}

ProjectiveMappings::ProjectiveMappings(const ProjectiveMappings& other, const osg::CopyOp& copy)
    : SurfaceEffect(other, copy), _drawing(std::make_unique<Drawing>()),
      _pages(new Pages(*_drawing, _rasters))
{
    for (const Property& property : ProjectiveMappings::properties())
        property.put(*this, property.get(other));
    const bool deep = (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS) != 0;
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : other._mappings)
        addMapping(deep ? osg::clone(mapping.get(), copy) : mapping.get());
    for (const osg::ref_ptr<RouteMapping>& route : other._routes)
        addRoute(osg::clone(route.get(), copy));
}

ProjectiveMappings::~ProjectiveMappings()
{
    removeMappings();
}

const Properties& ProjectiveMappings::properties() const
{
    using Self = ProjectiveMappings;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            LocalOrigin::originX().of<&Self::_origin, &LocalOrigin::x>(),
            LocalOrigin::originY().of<&Self::_origin, &LocalOrigin::y>(),
            LocalOrigin::originLongitude().of<&Self::_origin, &LocalOrigin::longitude>(),
            LocalOrigin::originLatitude().of<&Self::_origin, &LocalOrigin::latitude>(),
            Property::number("opacity", "the opacity of all mappings together", 0.0, 1.0)
                .of<&Self::_opacity>()
                .turnedBy(0.05),
            Property::flag(
                "wholeList",
                "whether every fragment goes through all mappings instead of the grid, for comparison")
                .of<&Self::_wholeList>(),
            Property::integer("anisotropy",
                              "the largest number of probes along the longer side of a pixel's footprint", 1,
                              16)
                .of<&Self::_anisotropy>(),
            Property::flag("linear",
                           "whether colors are made linear, for scenes that are lit in linear light")
                .of<&Self::_linear>(),
            Property::flag("groundOnly", "whether things that keep their shape, as buildings, show none")
                .of<&Self::_groundOnly>(),
            TextureUnits::property("dataUnit", "the texture unit of the parameters").of<&Self::_dataUnit>(),
            TextureUnits::property("layerUnit", "the texture unit of the rasters").of<&Self::_layerUnit>(),
            TextureUnits::property("tableUnit", "the texture unit of the color tables")
                .of<&Self::_tableUnit>(),
            Property::integer("pageSide", "the side of the pages that rasters share, a power of two", 64,
                              16384, "texel")
                .of<&Self::_pageSide>(),
            Property::integer("maxPages", "the largest number of pages", 1, 2048).of<&Self::_maxPages>(),
            Property::number("maxDataSize", "the most memory for the mappings' parameters", 0.001, 32000.0,
                             "MiB")
                .of<&Self::_maxDataSize>(),
            Property::choice("caching", "whether mappings are composed beforehand",
                             {{"off", ""}, {"automatic", "into pages, where these can show the same"}})
                .of<&Self::_caching>(),
            Property::integer("cacheSize", "the largest texture of pages, for each camera", 1, 512, "MiB")
                .of<&Self::_cacheSize>(),
            Property::integer("pagesPerFrame", "the number of pages that are drawn in a frame at most", 1, 64)
                .of<&Self::_pagesPerFrame>(),
            TextureUnits::property("pageUnit", "the texture unit of the pages").of<&Self::_pageUnit>(),
            TextureUnits::property("pageTableUnit", "the texture unit of the table of pages")
                .of<&Self::_pageTableUnit>(),
        });
    return all;
}

std::string ProjectiveMappings::inconsistency() const
{
    if (!isPowerOfTwo(_pageSide))
        return "pageSide must be a power of two, not " + std::to_string(_pageSide) + ".";
    return TextureUnits::inconsistency(textureUnits());
}

std::vector<TextureUnitWish> ProjectiveMappings::textureUnits() const
{
    std::vector<TextureUnitWish> wishes = {
        {"dataUnit", _dataUnit, 8}, {"layerUnit", _layerUnit, 9}, {"tableUnit", _tableUnit, 10}};
    if (_caching == OFF) return wishes;
    for (TextureUnitWish wish :
         {TextureUnitWish{"pageUnit", _pageUnit, 16}, TextureUnitWish{"pageTableUnit", _pageTableUnit, 17}})
    {
        // Without pages, fragments go through the mappings themselves.
        wish.optional = true;
        wishes.push_back(wish);
    }
    return wishes;
}

osg::Vec3d ProjectiveMappings::placeOf(const osg::Vec3d& world, const osg::EllipsoidModel* ellipsoid) const
{
    return placeOfPosition(world * osg::Matrixd::inverse(frameToWorld(ellipsoid)), ellipsoid);
}

osg::Vec3d ProjectiveMappings::placeOfPosition(const osg::Vec3d& position,
                                               const osg::EllipsoidModel* ellipsoid) const
{
    if (!ellipsoid) return position;
    const glsl::geofx_Exaggeration globe = globeOf(*ellipsoid, _origin.latitude);
    const glm::dvec3 p(position.x(), position.y(), position.z());
    const glm::dvec3 foot = glsl::geofx_exaggerate(globe, p);
    return {foot.x, foot.y, glsl::geofx_exaggerationHeight(globe, p)};
}

osg::Vec3d ProjectiveMappings::positionOf(const osg::Vec3d& place, const osg::EllipsoidModel* ellipsoid) const
{
    if (!ellipsoid) return place;
    const glsl::geofx_Exaggeration globe = globeOf(*ellipsoid, _origin.latitude);
    // Newton's method for the height at which the ellipsoid lies below the tangent plane.
    glm::dvec3 p(place.x(), place.y(), 0.0);
    for (int i = 0; i < 20; ++i)
    {
        const double step = glsl::geofx_exaggerationHeight(globe, p) /
                            std::max(glm::normalize(glsl::geofx_exaggerationGradient(globe, p)).z, 0.1);
        p.z -= step;
        if (std::abs(step) < 1e-6) break;
    }
    p += place.z() * glm::normalize(glsl::geofx_exaggerationGradient(globe, p));
    return {p.x, p.y, p.z};
}

bool ProjectiveMappings::addMapping(ProjectiveMapping* mapping)
{
    if (!mapping || _drawing->all.count(mapping) > 0)
    {
        OSG_WARN << "osgGeoFX: ProjectiveMappings::addMapping got "
                 << (mapping ? "a mapping that it has already" : "no mapping") << "; nothing changes."
                 << std::endl;
        return false;
    }
    _mappings.emplace_back(mapping);
    mapping->addListener(*this);
    _drawing->all[mapping] = 0;
    _drawing->each([&](GpuMappings& gpu) { gpu.add(*mapping); });
    touch();
    return true;
}

bool ProjectiveMappings::removeMapping(ProjectiveMapping* mapping)
{
    const auto found = std::find(_mappings.begin(), _mappings.end(), mapping);
    if (found == _mappings.end()) return false;
    const osg::ref_ptr<ProjectiveMapping> lives = mapping;
    _rasters.erase(std::remove_if(_rasters.begin(), _rasters.end(),
                                  [&](const auto& raster) { return raster->getMapping() == mapping; }),
                   _rasters.end());
    _drawing->setParts(lives, {});
    mapping->removeListener(*this);
    _drawing->all.erase(mapping);
    _drawing->each([&](GpuMappings& gpu) { gpu.remove(*mapping); });
    _mappings.erase(found);
    touch();
    return true;
}

void ProjectiveMappings::removeMappings()
{
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : _mappings)
        mapping->removeListener(*this);
    for (const osg::ref_ptr<PagedRaster>& raster : _rasters)
        _drawing->setParts(raster->getMapping(), {});
    _rasters.clear();
    for (const auto& [rank, mapping] : _drawing->ranked)
        mapping->removeListener(*this);
    for (const osg::ref_ptr<RouteMapping>& route : _routes)
        route->forget();
    _routes.clear();
    _drawing->ranked.clear();
    _drawing->all.clear();
    _drawing->each([](GpuMappings& gpu) { gpu.clear(); });
    _mappings.clear();
    touch();
}

bool ProjectiveMappings::addRaster(PagedRaster* raster)
{
    ProjectiveMapping* const mapping = raster ? raster->getMapping() : nullptr;
    const bool there = mapping && std::find(_mappings.begin(), _mappings.end(), mapping) != _mappings.end();
    const bool shown = std::find(_rasters.begin(), _rasters.end(), raster) != _rasters.end();
    // A raster that is shown is refused as its mapping is.
    if ((!there || shown) && !addMapping(mapping)) return false;
    raster->reset();
    _rasters.emplace_back(raster);
    return true;
}

bool ProjectiveMappings::removeRaster(PagedRaster* raster)
{
    const bool found = std::find(_rasters.begin(), _rasters.end(), raster) != _rasters.end();
    return found && removeMapping(raster->getMapping());
}

bool ProjectiveMappings::addRoute(RouteMapping* route)
{
    if (!route || route->_host)
    {
        OSG_WARN << "osgGeoFX: ProjectiveMappings::addRoute got "
                 << (route ? "a route that is in a ProjectiveMappings already" : "no route")
                 << "; nothing changes." << std::endl;
        return false;
    }
    if (_routes.empty()) _drawing->routes = 0;
    _routes.emplace_back(route);
    route->show(this, _drawing->routes++);
    touch();
    return true;
}

bool ProjectiveMappings::removeRoute(RouteMapping* route)
{
    const auto found = std::find(_routes.begin(), _routes.end(), route);
    if (found == _routes.end()) return false;
    route->show(nullptr, 0);
    _routes.erase(found);
    touch();
    return true;
}

RouteMapping* ProjectiveMappings::routeOf(const ProjectiveMapping& mapping) const
{
    const auto found = _drawing->all.find(&mapping);
    if (found == _drawing->all.end() || found->second == 0) return nullptr;
    for (const osg::ref_ptr<RouteMapping>& route : _routes)
        if (RankOfRoute::routeOf(found->second) == route->_number) return route;
    return nullptr;
}

void ProjectiveMappings::addRanked(ProjectiveMapping& mapping, std::uint64_t rank)
{
    _drawing->ranked[rank] = &mapping;
    mapping.addListener(*this);
    _drawing->all[&mapping] = rank;
    _drawing->each([&](GpuMappings& gpu) { gpu.add(mapping, rank); });
    touch();
}

void ProjectiveMappings::removeRanked(std::uint64_t rank)
{
    const auto found = _drawing->ranked.find(rank);
    if (found == _drawing->ranked.end()) return;
    const osg::ref_ptr<ProjectiveMapping> mapping = found->second;
    mapping->removeListener(*this);
    _drawing->all.erase(mapping);
    _drawing->each([&](GpuMappings& gpu) { gpu.remove(*mapping); });
    _drawing->ranked.erase(found);
    touch();
}

/// Shows what has been read since.
void ProjectiveMappings::updateRasters()
{
    const std::lock_guard<std::mutex> lock(_drawing->rasters);
    for (const osg::ref_ptr<PagedRaster>& raster : _rasters)
    {
        PagedRaster::Parts parts;
        if (raster->update(parts)) _drawing->setParts(raster->getMapping(), std::move(parts));
    }
}

void ProjectiveMappings::propertyChanged(PropertyHolder& mapping)
{
    _drawing->each([&](GpuMappings& gpu) { gpu.change(static_cast<ProjectiveMapping&>(mapping)); });
}

std::vector<ProjectiveMapping*> ProjectiveMappings::mappingsAt(const osg::Vec2d& place) const
{
    std::vector<ProjectiveMapping*> found;
    const auto look = [&](ProjectiveMapping* mapping)
    {
        if (!mapping->getEnabled()) return;
        const glm::dvec3 raster = mapping->placeToRaster() * glm::dvec3(place.x(), place.y(), 1.0);
        const double u = raster.x / raster.z;
        const double v = raster.y / raster.z;
        const bool within = u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
        if (within && mapping->getProjector() == ProjectiveMapping::PLANE) found.push_back(mapping);
    };
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : _mappings)
        look(mapping);
    for (const auto& [rank, mapping] : _drawing->ranked)
        look(mapping);
    std::reverse(found.begin(), found.end());
    std::stable_sort(found.begin(), found.end(),
                     [](const ProjectiveMapping* a, const ProjectiveMapping* b)
                     { return a->getOrder() > b->getOrder(); });
    return found;
}

ProjectiveMappings::Capacity ProjectiveMappings::capacity() const
{
    return _drawing->capacity();
}

MappingSettings ProjectiveMappings::settings(const osg::EllipsoidModel* ellipsoid) const
{
    MappingSettings settings;
    settings.pageSide = _pageSide;
    settings.maxPages = _maxPages;
    settings.maxTexels = static_cast<int>(std::min(_maxDataSize * texelsInMegabyte, 2147483647.0));
    for (const osg::ref_ptr<PagedRaster>& raster : _rasters)
        settings.reservedPages += raster->pagesOf(_pageSide);
    if (ellipsoid)
    {
        settings.longitude = _origin.longitude;
        settings.latitude = _origin.latitude;
    }
    return settings;
}

void ProjectiveMappings::update(const osg::EllipsoidModel* ellipsoid)
{
    CameraList none;
    _drawing->on(ellipsoid, _mappings)
        ->commit(
            settings(ellipsoid), [&](const osg::Vec3d& place) { return positionOf(place, ellipsoid); }, none,
            nullptr);
}

bool ProjectiveMappings::fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view)
{
    if ((_mappings.empty() && _drawing->ranked.empty()) || _opacity <= 0.0) return false;
    const osg::EllipsoidModel* ellipsoid = view.geometry.ground.ellipsoid.get();
    const osg::Matrixd frameToEye = frameToWorld(ellipsoid) * view.modelView;
    const osg::Matrixd eyeToFrame = osg::Matrixd::inverse(frameToEye);
    // What a pixel spans, metres: at a metre from the eye, and whatever the distance.
    const osg::Matrixd& projection = view.geometry.image.projection;
    const double span =
        2.0 / std::max(std::abs(projection(1, 1)) * std::max(view.viewportHeight, 1.0), 1e-30);
    const bool parallel = projection(3, 3) != 0.0;

    Drawing::Camera& camera = _drawing->cameras.of(state);
    updateRasters();
    camera.show(_drawing->on(ellipsoid, _mappings));
    const osg::Vec3d eye = eyeToFrame.getTrans();
    const auto position = [&](const osg::Vec3d& place)
    {
        return positionOf(place, ellipsoid);
    };
    const auto largeEnough = [&](const ProjectiveMapping& mapping)
    {
        if (mapping.getPixelsNone() <= 0.0 || mapping.getProjector() == ProjectiveMapping::PINHOLE)
            return true;
        const osg::Vec2d center = mapping.getCenter();
        const osg::Vec3d at = position({center.x(), center.y(), mapping.getHeight()});
        const double metres = parallel ? span : (at - eye).length() * span;
        const double size = 2.0 * std::sqrt(mapping.getU().length() * mapping.getV().length());
        // A little more than what the shader draws.
        return size / metres > 0.99 * mapping.getPixelsNone();
    };
    const GpuMappings::Frame frame = camera.gpu->commit(
        settings(ellipsoid), position, camera.list, _wholeList ? GpuMappings::Wanted(largeEnough) : nullptr);
    camera.pages.skip();
    const MappingIndex::Root& root = frame.root;
    const auto start = static_cast<int>(camera.list.offset());
    if (root.block == 0 || (_wholeList && start == 0)) return false;

    camera.setTextures(frame, state, prefix, view.units);
    const auto define = [&](const char* name, bool on)
    {
        state.setDefine(prefix + name, on ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
    };
    for (std::size_t i = 0; i < std::size(MappingRecord::features); ++i)
        define(MappingRecord::features[i], (frame.features & 1u << i) != 0);
    setUniform(state, prefix + "toFrame", osg::Uniform::FLOAT_MAT4, osg::Matrixf(eyeToFrame));
    setUniform(state, prefix + "root", osg::Uniform::FLOAT_VEC4,
               osg::Vec4(osg::Vec4d(root.origin.x(), root.origin.y(), 1.0 / root.size, 0.0)));
    setUniform(state, prefix + "pixel", osg::Uniform::FLOAT_VEC4,
               osg::Vec4(osg::Vec4d(parallel ? 0.0 : span, parallel ? span : 0.0, _opacity, 0.0)));
    state.getOrCreateUniform(prefix + "start", osg::Uniform::INT_VEC2)
        ->set(static_cast<int>(root.block), start);
    // The paper's loop works out each mapping in its turn, too.
    define("IN_TURN", _wholeList || frame.longestList > longList);
    define("LINEAR", _linear);
    define("GROUND_ONLY", _groundOnly);
    setUniform(state, prefix + "quality", osg::Uniform::FLOAT_VEC3,
               osg::Vec3(static_cast<float>(_anisotropy), 1.0f / static_cast<float>(frame.store->pageSide()),
                         1.0f / GpuStore::tableWidth));
    osg::Vec4d globe, curve;
    if (ellipsoid)
    {
        const glsl::geofx_Exaggeration globeFrame = globeOf(*ellipsoid, _origin.latitude);
        globe.set(globeFrame.axis.x, globeFrame.axis.y, globeFrame.axis.z, globeFrame.flattening);
        curve.set(globeFrame.curvature, globeFrame.scale, 0.0, 0.0);
    }
    setUniform(state, prefix + "globe", osg::Uniform::FLOAT_VEC4, osg::Vec4(globe));
    const Graticule graticule(_origin, ellipsoid);
    setUniform(state, prefix + "gridOrigin", osg::Uniform::FLOAT_VEC4, osg::Vec4(graticule.origin));
    setUniform(state, prefix + "gridGlobe", osg::Uniform::FLOAT_VEC4, osg::Vec4(graticule.globe));
    setUniform(state, prefix + "gridDrift", osg::Uniform::FLOAT, static_cast<float>(graticule.drift));
    setUniform(state, prefix + "curve", osg::Uniform::FLOAT_VEC4, osg::Vec4(curve));
    PageFrame& plane = camera.plane;
    camera.sees = true;
    // All effects see the view's eye space, whichever camera draws it.
    plane.toEye = frameToEye;
    plane.fromEye = eyeToFrame;
    plane.globe = ellipsoid != nullptr;
    plane.curvature = ellipsoid ? 1.0 / ellipsoid->getRadiusPolar() : 0.0;
    plane.positionOf = [this, ellipsoid](const osg::Vec3d& place)
    {
        return positionOf(place, ellipsoid);
    };
    plane.placeOf = [this, ellipsoid](const osg::Vec3d& at)
    {
        return placeOfPosition(at, ellipsoid);
    };
    // The shorter side of a pixel.
    const double across =
        2.0 / std::max(std::abs(projection(0, 0)) * std::max(view.viewportWidth, 1.0), 1e-30);
    plane.pixel = parallel ? 0.0 : std::min(span, across);
    plane.pixelAnywhere = parallel ? std::min(span, across) : 0.0;
    if (_caching == OFF)
    {
        camera.pages.stop(state, prefix);
        return true;
    }
    CameraPages::Task task;
    task.gpu = camera.gpu;
    task.frame = frame;
    task.plane = plane;
    task.opacity = _opacity;
    task.anisotropy = _anisotropy;
    task.megabytes = _cacheSize;
    task.pagesPerFrame = _pagesPerFrame;
    if (view.units.size() < 5 || view.units[3] < 0 || view.units[4] < 0)
        task.obstacle = "the scene has no texture units left for pages";
    if (_wholeList) task.obstacle = "wholeList is on";
    if (_linear) task.obstacle = "linear is on";
    camera.pages.begin(std::move(task), state, prefix);
    return true;
}

PassEffect* ProjectiveMappings::asPassEffect()
{
    return _caching == OFF && _rasters.empty() ? nullptr : _pages.get();
}

ProjectiveMappings::CacheStatistics ProjectiveMappings::cacheStatistics() const
{
    CacheStatistics all;
    bool first = true;
    _drawing->cameras.each(
        [&](const Drawing::Camera& camera)
        {
            const CacheStatistics one = camera.pages.statistics();
            all.pages += one.pages;
            all.pagesUsed += one.pagesUsed;
            all.settled = (first || all.settled) && one.settled;
            all.pagesDrawn += one.pagesDrawn;
            all.texelsDrawn += one.texelsDrawn;
            all.pagedFrames += one.pagedFrames;
            all.exactFrames += one.exactFrames;
            if (!one.reason.empty()) all.reason = one.reason;
            first = false;
        });
    return all;
}

void ProjectiveMappings::resizeGLObjectBuffers(unsigned int size)
{
    SurfaceEffect::resizeGLObjectBuffers(size);
    _drawing->cameras.resizeGLObjectBuffers(size);
}

void ProjectiveMappings::releaseGLObjects(osg::State* state) const
{
    _drawing->each([&](GpuMappings& gpu) { gpu.releaseGLObjects(state); });
    _drawing->cameras.releaseGLObjects(state);
}

} // namespace osgGeoFX
