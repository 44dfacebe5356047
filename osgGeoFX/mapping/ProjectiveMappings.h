// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/mapping/ProjectiveMapping.h>

#include <osg/CoordinateSystemNode>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

class PagedRaster;
class RouteMapping;
struct MappingSettings;

/** Projects any number of georeferenced rasters onto everything below its EffectScene, in one pass and at run time.
    This is the system of Trapp and Döllner (2009).

    @code
    osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    mappings->setGeodeticOrigin(longitude, latitude);          // on a globe; radians
    osg::ref_ptr<osgGeoFX::ProjectiveMapping> mapping = new osgGeoFX::ProjectiveMapping;
    mapping->setLayer(new osgGeoFX::DataLayer(osgDB::readImageFile("noise.png")));
    mapping->setRectangle(osg::Vec2d(0.0, 0.0), 500.0, 300.0); // metres about the origin
    mappings->addMapping(mapping);
    scene->addEffect(mappings);
    @endcode

    **Frame.** On a projected terrain, a place is a position minus the origin. On a globe, the frame stands on the
    ellipsoid at the origin's longitude and latitude: x points east, y north, z up. The reference plane is the tangent
    plane there. A place's x and y are those of the point's foot on the ellipsoid: PROJ's `+proj=ortho` at that origin.
    Rasters in that projection therefore lie exactly, for hundreds of kilometres around. The other side of the globe
    cannot be reached.

    **Cost.** Each fragment uses a grid (MappingIndex) to find the few mappings at its place. Mappings elsewhere, even
    thousands, cost it nothing. With `wholeList` each fragment instead tests all mappings that are not too small, as in
    the paper, with the same result. Between frames only changes are uploaded. The effect uses three textures, on units
    that the scene or the program chooses.

    **Limits.** The class itself has no limit. If the GPU cannot hold everything, the least important layers and
    mappings are left out (lowest `importance` first, then the smaller mappings). One warning names the limit, and
    capacity() counts what was left out.

    **Caching.** With AUTOMATIC, what does not change is composed once, into pages of a texture, and a fragment pays for
    one fetch of a page, whatever number of mappings lies over it. Pages are made in a stage before the scene, as many in a
    frame as `pagesPerFrame` says. Until all are there the picture is drawn as without. Mappings that change are drawn into
    the pages below them in the same frame; if that is too much, the frame is drawn as without until they rest. While the
    camera moves, coarser pages may show for some frames. A settled picture is within 2/255 of the one without, edges
    within a pixel, whichever way the camera came. What depends on more than the place (fades, heights, symbols in
    pixels, pinholes), and blends other than a mix with the source's alpha, cannot be composed: a set with such a mapping
    is drawn as without. So are close-ups and other passes. cacheStatistics() tells what is done, and why.

    **With other effects.** Mappings lie on the undeformed ground and bend with it. They color the ground in the
    scene's order of effects. A scene may have several ProjectiveMappings. A subgraph with the define
    GEOFX_MAPPING_CHANNELS 0 shows no mappings. With other bits it shows only mappings of these channels.

    **Threads.** A program changes mappings, layers, tables and transfers between frames. The next frame shows the
    change, in all threading models. Any number of cameras, views and contexts may draw them. Several scenes may share
    one ProjectiveMappings.
    @ingroup mapping */
class OSGGEOFX_EXPORT ProjectiveMappings : public SurfaceEffect, public TextureUser, private PropertyListener
{
public:
    ProjectiveMappings();
    ProjectiveMappings(const ProjectiveMappings& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ProjectiveMappings);

    /// The frame's origin on a projected terrain, metres, ±5e7. Default: (0, 0).
    bool setOrigin(const osg::Vec2d& origin)
    {
        return assign({{"originX", origin.x()}, {"originY", origin.y()}});
    }
    osg::Vec2d getOrigin() const { return _origin.place(); }
    /// The frame's origin on a globe, radians. Default: (0, 0).
    bool setGeodeticOrigin(double longitude, double latitude)
    {
        return assign({{"longitude", longitude}, {"latitude", latitude}});
    }
    double getLongitude() const { return _origin.longitude; }
    double getLatitude() const { return _origin.latitude; }
    /// The same in one value, for both kinds of terrain.
    bool setLocalOrigin(const LocalOrigin& origin)
    {
        return assign({{"originX", origin.x},
                       {"originY", origin.y},
                       {"longitude", origin.longitude},
                       {"latitude", origin.latitude}});
    }
    const LocalOrigin& getLocalOrigin() const { return _origin; }
    /// The matrix from the frame to world coordinates. `ellipsoid` is null on a projected terrain.
    osg::Matrixd frameToWorld(const osg::EllipsoidModel* ellipsoid) const
    {
        return _origin.toWorld(ellipsoid);
    }
    /// The place of a world position: x and y on the plane and the height, metres.
    osg::Vec3d placeOf(const osg::Vec3d& world, const osg::EllipsoidModel* ellipsoid) const;
    /// The position of a place, in the frame, metres. It is the inverse of the shader's computation.
    osg::Vec3d positionOf(const osg::Vec3d& place, const osg::EllipsoidModel* ellipsoid) const;

    /// Adds a mapping on top of all mappings of its order but those of routes. A null pointer and a mapping that was added before are
    /// refused with a warning.
    bool addMapping(ProjectiveMapping* mapping);
    /// Returns false if the mapping is not in the list.
    bool removeMapping(ProjectiveMapping* mapping);
    /// Removes all mappings, rasters and routes.
    void removeMappings();
    /// The mappings that were added; those of routes are not among them.
    unsigned int getNumMappings() const { return static_cast<unsigned int>(_mappings.size()); }
    ProjectiveMapping* getMapping(unsigned int i) { return _mappings[i].get(); }
    const ProjectiveMapping* getMapping(unsigned int i) const { return _mappings[i].get(); }
    /// Shows a raster that is larger than memory, in the place of its mapping (PagedRaster::getMapping()), which is added as by
    /// addMapping() unless it is there. A null pointer and a raster that was added before are refused with a warning. One ProjectiveMappings may have a raster.
    bool addRaster(PagedRaster* raster);
    /// Removes the raster and its mapping. Returns false if the raster is not there.
    bool removeRaster(PagedRaster* raster);
    unsigned int getNumRasters() const { return static_cast<unsigned int>(_rasters.size()); }
    PagedRaster* getRaster(unsigned int i) { return _rasters[i].get(); }
    const PagedRaster* getRaster(unsigned int i) const { return _rasters[i].get(); }
    /// Shows a route. Null, and a route that this or another ProjectiveMappings has, are refused with a warning.
    bool addRoute(RouteMapping* route);
    /// Returns false if the route is not there.
    bool removeRoute(RouteMapping* route);
    unsigned int getNumRoutes() const { return static_cast<unsigned int>(_routes.size()); }
    RouteMapping* getRoute(unsigned int i) { return _routes[i].get(); }
    const RouteMapping* getRoute(unsigned int i) const { return _routes[i].get(); }
    /// The route whose mapping this is, one of mappingsAt() for instance. Null for other mappings.
    RouteMapping* routeOf(const ProjectiveMapping& mapping) const;
    /// All enabled mappings, those of routes among them, of the projector PLANE whose rasters contain this place, the topmost first. Fades are
    /// ignored, and so are sizes in pixels and turned symbols.
    std::vector<ProjectiveMapping*> mappingsAt(const osg::Vec2d& place) const;

    /// The opacity of all mappings together, 0…1. Keys change it in a viewer. Default: 1.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// Whether each fragment tests all mappings except those too small to see, instead of using the grid. This serves
    /// comparisons. Default: false.
    bool setWholeList(bool on) { return assign("wholeList", on ? 1.0 : 0.0); }
    bool getWholeList() const { return _wholeList; }
    /// The largest number of texture probes along the longer side of a pixel's footprint, 1…16. Default: 8.
    bool setAnisotropy(int probes) { return assign("anisotropy", probes); }
    int getAnisotropy() const { return _anisotropy; }
    /// For scenes that are lit in linear light: colors are taken as sRGB and made linear before blending. Default:
    /// false.
    bool setLinear(bool linear) { return assign("linear", linear ? 1.0 : 0.0); }
    bool getLinear() const { return _linear; }
    /// The texture units of the data, the layers and the tables, 4…31, all different. With the default, −1, the scene
    /// chooses a unit: 8, 9 and 10 if they are free.
    bool setUnits(int data, int layers, int tables)
    {
        return assign({{"dataUnit", data}, {"layerUnit", layers}, {"tableUnit", tables}});
    }
    int getDataUnit() const { return _dataUnit; }
    int getLayerUnit() const { return _layerUnit; }
    int getTableUnit() const { return _tableUnit; }
    /// The side of the pages that layers share, texels, a power of two, 64…16384. Larger layers are reduced. A change
    /// uploads everything again. Default: 2048.
    bool setPageSide(int texels) { return assign("pageSide", texels); }
    int getPageSide() const { return _pageSide; }
    /// The largest number of pages, 1…2048. The GPU may allow fewer. Default: 64, which are 1.4 GB.
    bool setMaxPages(int pages) { return assign("maxPages", pages); }
    int getMaxPages() const { return _maxPages; }
    /// Whether things that keep their shape (RigidParts), such as the buildings of a town, show no mappings. Default: false.
    bool setGroundOnly(bool only) { return assign("groundOnly", only); }
    bool getGroundOnly() const { return _groundOnly; }
    /// The largest memory for the parameters of the mappings and for their grid, MiB, 0.001…32000. The GPU may allow
    /// less. Default: 2048.
    bool setMaxDataSize(double megabytes) { return assign("maxDataSize", megabytes); }
    double getMaxDataSize() const { return _maxDataSize; }

    enum Caching
    {
        OFF,
        AUTOMATIC ///< pages of composed mappings, where they can show the same
    };
    /// Whether mappings are composed beforehand. Default: OFF.
    bool setCaching(Caching caching) { return assign("caching", caching); }
    Caching getCaching() const { return static_cast<Caching>(_caching); }
    /// The largest texture of pages, MiB, 1…512, for each camera. A picture that needs more is drawn without pages. A page of
    /// 256² texels has a quarter of a MiB. Default: 128.
    bool setCacheSize(int megabytes) { return assign("cacheSize", megabytes); }
    int getCacheSize() const { return _cacheSize; }
    /// The number of pages that are drawn in a frame at most, 1…64; four times as many while none are shown. Default: 2.
    bool setPagesPerFrame(int pages) { return assign("pagesPerFrame", pages); }
    int getPagesPerFrame() const { return _pagesPerFrame; }
    /// The texture units of the pages and of their table, 4…31, different from all others. With the default, −1, the
    /// scene chooses: 16 and 17 if they are free. Without caching there are none.
    bool setCacheUnits(int pages, int table)
    {
        return assign({{"pageUnit", pages}, {"pageTableUnit", table}});
    }
    int getPageUnit() const { return _pageUnit; }
    int getPageTableUnit() const { return _pageTableUnit; }

    /// What has become of the pages, of all cameras together.
    struct CacheStatistics
    {
        int pages = 0, pagesUsed = 0;  ///< of the textures
        bool settled = false;          ///< the last frame of each camera had all pages that it needs
        std::uint64_t pagesDrawn = 0;  ///< or parts of pages, since the beginning
        std::uint64_t texelsDrawn = 0; ///< the same
        std::uint64_t pagedFrames = 0; ///< frames that showed pages
        std::uint64_t exactFrames = 0; ///< frames that did not
        std::string reason;            ///< why the last frame did not; empty if it did
    };
    CacheStatistics cacheStatistics() const;

    /// The room on the GPU, the part of it in use, and the numbers of mappings and layers that the last frame left
    /// out.
    struct Capacity
    {
        int pages = 0, pagesUsed = 0;   ///< pages of pageSide² texels with their mip levels
        int texels = 0, texelsUsed = 0; ///< texels of the texture buffer, 16 bytes each
        int mappingsLeftOut = 0, layersLeftOut = 0;
        std::uint64_t uploadedBytes = 0; ///< since the beginning, in all contexts together
    };
    Capacity capacity() const;

    /// Processes all changes now. Otherwise the next frame does. `ellipsoid` is the terrain's, or null on a projected
    /// terrain.
    void update(const osg::EllipsoidModel* ellipsoid);

    const Properties& properties() const override;
    std::string vertexFile() const override { return "stages/mappings.vert.glsl"; }
    std::string fragmentFile() const override { return "stages/mappings.frag.glsl"; }
    std::vector<Varying> varyings() const override { return {{"vec3", "position"}, {"vec3", "place"}}; }
    std::vector<TextureUnitWish> textureUnits() const override;
    bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) override;
    using SurfaceEffect::asPassEffect;
    PassEffect* asPassEffect() override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state) const override;

protected:
    ~ProjectiveMappings() override;
    std::string inconsistency() const override;

private:
    friend class RouteMapping;
    class Drawing;
    class Pages;
    using Mappings = std::vector<osg::ref_ptr<ProjectiveMapping>>;
    void propertyChanged(PropertyHolder& mapping) override;
    /// Of routes. `rank`: its place among the mappings of its order.
    void addRanked(ProjectiveMapping& mapping, std::uint64_t rank);
    void removeRanked(std::uint64_t rank);
    void updateRasters();
    osg::Vec3d placeOfPosition(const osg::Vec3d& position, const osg::EllipsoidModel* ellipsoid) const;
    MappingSettings settings(const osg::EllipsoidModel* ellipsoid) const;

    LocalOrigin _origin;
    double _opacity = 1.0;
    bool _wholeList = false;
    int _anisotropy = 8;
    bool _linear = false;
    int _dataUnit = -1, _layerUnit = -1, _tableUnit = -1;
    int _pageSide = 2048, _maxPages = 64;
    double _maxDataSize = 2048.0;
    bool _groundOnly = false;
    int _caching = OFF;
    int _cacheSize = 128;
    int _pagesPerFrame = 2;
    int _pageUnit = -1, _pageTableUnit = -1;
    Mappings _mappings;
    std::vector<osg::ref_ptr<PagedRaster>> _rasters;
    std::vector<osg::ref_ptr<RouteMapping>> _routes;
    std::unique_ptr<Drawing> _drawing;
    osg::ref_ptr<Pages> _pages;
};

} // namespace osgGeoFX
