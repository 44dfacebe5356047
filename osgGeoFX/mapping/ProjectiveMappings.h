// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/mapping/ProjectiveMapping.h>

#include <osg/CoordinateSystemNode>

#include <memory>
#include <vector>

namespace osgGeoFX
{

struct MappingSettings;

/** Throws any number of georeferenced rasters onto everything below its EffectScene, in one pass and at run time: the
    system of Trapp and Döllner (2009).

    @code
    osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    mappings->setGeodeticOrigin(longitude, latitude);          // on a globe; radians
    osg::ref_ptr<osgGeoFX::ProjectiveMapping> mapping = new osgGeoFX::ProjectiveMapping;
    mapping->setLayer(new osgGeoFX::DataLayer(osgDB::readImageFile("noise.png")));
    mapping->setRectangle(osg::Vec2d(0.0, 0.0), 500.0, 300.0); // metres about the origin
    mappings->addMapping(mapping);
    scene->addEffect(mappings);
    @endcode

    **Frame.** On a projected terrain, places are its coordinates less the origin. On a globe, the frame stands on the
    ellipsoid at the origin's longitude and latitude, x east, y north, z up; the reference plane is the tangent plane,
    and a place's x and y are those of its foot on the ellipsoid: PROJ's `+proj=ortho` at that origin. So rasters warped
    to that projection lie exactly, hundreds of kilometres around; the other side of the globe is out of reach.

    **What it costs.** A fragment walks a grid to the few mappings over its place (MappingIndex); thousands elsewhere cost
    it nothing. With `wholeList` each fragment goes through all that are not too small instead, as in the paper; the picture
    is the same. Between frames only what changed is uploaded. Three textures in all, on units that the scene gives them or
    of one's choice.

    **Limits.** There is no limit of its own. What the GPU cannot hold is left out, the least important first
    (`importance`, then the smaller ones), one warning says which limit it is, and capacity() tells how much that is.

    **With other effects.** Mappings lie on the undeformed ground and bend with it. They colour in the scene's order of
    effects, and any number of sets may stand there. A subgraph keeps clear of all with the define GEOFX_MAPPING_CHANNELS 0, and takes some with their bits.

    **Threads.** Mappings, layers, tables and transfers are changed between frames; the next frame has it, in all
    threading models. Any number of cameras, views and contexts draws them. May be hosted by several scenes. */
class OSGGEOFX_EXPORT ProjectiveMappings : public SurfaceEffect, public TextureUser, private PropertyListener
{
public:
    ProjectiveMappings();
    ProjectiveMappings(const ProjectiveMappings& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ProjectiveMappings);

    /// The frame's origin on a projected terrain, metres. (0, 0) by default.
    bool setOrigin(const osg::Vec2d& origin)
    {
        return assign({{"originX", origin.x()}, {"originY", origin.y()}});
    }
    osg::Vec2d getOrigin() const { return {_originX, _originY}; }
    /// The frame's origin on a globe, radians. (0, 0) by default.
    bool setGeodeticOrigin(double longitude, double latitude)
    {
        return assign({{"longitude", longitude}, {"latitude", latitude}});
    }
    double getLongitude() const { return _longitude; }
    double getLatitude() const { return _latitude; }
    /// From the frame to world coordinates: with the ellipsoid on a globe, null on a projected terrain.
    osg::Matrixd frameToWorld(const osg::EllipsoidModel* ellipsoid) const;
    /// The place of a world position: x and y on the plane, and the height, metres.
    osg::Vec3d placeOf(const osg::Vec3d& world, const osg::EllipsoidModel* ellipsoid) const;
    /// The position in the frame of a place; the reverse of what the shader does.
    osg::Vec3d positionOf(const osg::Vec3d& place, const osg::EllipsoidModel* ellipsoid) const;

    /// Null and a mapping that is there already are refused. On top of those of its order.
    bool addMapping(ProjectiveMapping* mapping);
    bool removeMapping(ProjectiveMapping* mapping);
    void removeMappings();
    unsigned int getNumMappings() const { return static_cast<unsigned int>(_mappings.size()); }
    ProjectiveMapping* getMapping(unsigned int i) { return _mappings[i].get(); }
    const ProjectiveMapping* getMapping(unsigned int i) const { return _mappings[i].get(); }
    /// All enabled mappings with this place in their outlines, the topmost first; fades are left out of account.
    std::vector<ProjectiveMapping*> mappingsAt(const osg::Vec2d& place) const;

    /// Of all mappings together, 0…1; what keys turn. 1 by default.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// Whether fragments go through all mappings but those too small to see, instead of the grid. For comparison; false by default.
    bool setWholeList(bool on) { return assign("wholeList", on ? 1.0 : 0.0); }
    bool getWholeList() const { return _wholeList; }
    /// Probes along the longer side of a pixel's footprint at most, 1…16; 8 by default.
    bool setAnisotropy(int probes) { return assign("anisotropy", probes); }
    int getAnisotropy() const { return _anisotropy; }
    /// For scenes that are lit in linear light: colours are taken as sRGB and made linear before blending. False by default.
    bool setLinear(bool linear) { return assign("linear", linear ? 1.0 : 0.0); }
    bool getLinear() const { return _linear; }
    /// Texture units of the data, the layers and the tables, 4…31, all different. −1, the default, leaves one to the scene,
    /// which gives 8, 9 and 10 where they are free.
    bool setUnits(int data, int layers, int tables)
    {
        return assign({{"dataUnit", data}, {"layerUnit", layers}, {"tableUnit", tables}});
    }
    int getDataUnit() const { return _dataUnit; }
    int getLayerUnit() const { return _layerUnit; }
    int getTableUnit() const { return _tableUnit; }
    /// Side of the pages that layers share, texels, a power of two 64…16384; larger layers are reduced. 2048 by default. A
    /// change uploads everything anew.
    bool setPageSide(int texels) { return assign("pageSide", texels); }
    int getPageSide() const { return _pageSide; }
    /// Pages at most, 1…2048: less where the GPU has less. 64 by default, which are 1.4 GB.
    bool setMaxPages(int pages) { return assign("maxPages", pages); }
    int getMaxPages() const { return _maxPages; }
    /// Memory for the parameters of the mappings and their grid at most, MiB, 0.001…32000: less where the GPU has less.
    /// 2048 by default.
    bool setMaxDataSize(double megabytes) { return assign("maxDataSize", megabytes); }
    double getMaxDataSize() const { return _maxDataSize; }

    /// What there is room for, what is in use, and what was left out in the last frame.
    struct Capacity
    {
        int pages = 0, pagesUsed = 0;   ///< of pageSide² texels with their mip levels
        int texels = 0, texelsUsed = 0; ///< of the texture buffer, 16 bytes each
        int mappingsLeftOut = 0, layersLeftOut = 0;
        std::uint64_t uploadedBytes = 0; ///< since the beginning, all contexts together
    };
    Capacity capacity() const;

    /// Works in now what has changed, for the next frame, which does so by itself otherwise. With the terrain's
    /// ellipsoid, null on a projected terrain.
    void update(const osg::EllipsoidModel* ellipsoid);

    const Properties& properties() const override;
    std::string vertexFile() const override { return "stages/mappings.vert.glsl"; }
    std::string fragmentFile() const override { return "stages/mappings.frag.glsl"; }
    std::vector<TextureUnitWish> textureUnits() const override;
    bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) override;
    void releaseGLObjects(osg::State* state) const override;

protected:
    ~ProjectiveMappings() override;
    std::string inconsistency() const override;

private:
    class Drawing;
    using Mappings = std::vector<osg::ref_ptr<ProjectiveMapping>>;
    void propertyChanged(PropertyHolder& mapping) override;
    MappingSettings settings(const osg::EllipsoidModel* ellipsoid) const;

    double _originX = 0.0, _originY = 0.0, _longitude = 0.0, _latitude = 0.0;
    double _opacity = 1.0;
    bool _wholeList = false;
    int _anisotropy = 8;
    bool _linear = false;
    int _dataUnit = -1, _layerUnit = -1, _tableUnit = -1;
    int _pageSide = 2048, _maxPages = 64;
    double _maxDataSize = 2048.0;
    Mappings _mappings;
    std::unique_ptr<Drawing> _drawing;
};

} // namespace osgGeoFX
