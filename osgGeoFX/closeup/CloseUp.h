// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/Anchor.h>
#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/raster/ColorTable.h>

#include <osg/ref_ptr>

#include <string>

namespace osgGeoFX
{

/** A region of the ground, lifted out, scaled, turned and drawn in a style of its own (paper: interactive close-ups,
    Section II.B).

    **Geometry.** In the region's frame (x right, y to the front, z up, metres about its centre at its base), a point v of the
    ground goes to `offset + R · S · v`: S scales by (scaleX, scaleY, scaleHeight), R turns. The paper's M multiplies the
    other way round and does not say about which point; its axes are x, height, y. A height scale of 0 makes a flat map.

    **Orientation.** SCENE: R is `turn` about the vertical, counter-clockwise from above, then `tilt` about the x axis, in the
    region's frame, so the close-up is seen as everything else in the scene. FIXED: the same in a frame that goes with the
    camera: without a tilt, the map is seen from straight above with its y axis up in the picture. BILLBOARD: as FIXED, and
    without perspective.

    **With a bend** the offset starts at the region's centre as the bend has moved it, and turns with the ground there; the
    close-up itself is not bent.

    Setters refuse what makes no sense: they return false, warn once and leave the last good state. Changed by the thread
    of the frame loop between frames. */
class OSGGEOFX_EXPORT CloseUp : public PropertyHolder, private PropertyListener
{
public:
    CloseUp();
    CloseUp(const CloseUp& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, CloseUp);

    /// Never null; null is refused. May be shared with other close-ups.
    bool setRegion(RegionOfInterest* region);
    RegionOfInterest* getRegion() { return _region.get(); }
    const RegionOfInterest* getRegion() const { return _region.get(); }
    /// Never null; null is refused. May be shared.
    bool setAnchor(Anchor* anchor);
    Anchor* getAnchor() { return _anchor.get(); }
    const Anchor* getAnchor() const { return _anchor.get(); }

    /// Whether it is drawn at all. True by default.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }

    /// From the region's centre, metres: east and north as the region's axes, and up; ±1e7. (0, 0, 2000) by default.
    bool setOffset(const osg::Vec3d& offset)
    {
        return assign({{"offsetX", offset.x()}, {"offsetY", offset.y()}, {"offsetHeight", offset.z()}});
    }
    osg::Vec3d getOffset() const { return {_offsetX, _offsetY, _offsetHeight}; }
    /// 0.001…1000 in the plane; 0…1000 for heights, where 0 is a flat map. All 1.5 by default.
    bool setScale(double x, double y, double height)
    {
        return assign({{"scaleX", x}, {"scaleY", y}, {"scaleHeight", height}});
    }
    double getScaleX() const { return _scaleX; }
    double getScaleY() const { return _scaleY; }
    double getScaleHeight() const { return _scaleHeight; }
    enum Orientation
    {
        SCENE,
        FIXED,
        BILLBOARD
    };
    /// SCENE by default.
    bool setOrientation(Orientation orientation) { return assign("orientation", orientation); }
    Orientation getOrientation() const { return static_cast<Orientation>(_orientation); }
    /// The paper's α and β: about the x axis, the far side rising, and about the vertical; radians, −2π…2π. 0 by default.
    bool setTilt(double tilt) { return assign("tilt", tilt); }
    double getTilt() const { return _tilt; }
    bool setTurn(double turn) { return assign("turn", turn); }
    double getTurn() const { return _turn; }

    enum Edge
    {
        FRAGMENTS, ///< cut along the mask's border, sharp at any size
        PRIMITIVES ///< the triangles that lie in the mask wholly (the paper)
    };
    /// FRAGMENTS by default.
    bool setEdge(Edge edge) { return assign("edge", edge); }
    Edge getEdge() const { return static_cast<Edge>(_edge); }

    /// How far vertices that tessellation adds (CloseUps::setTessellation) leave the flat triangles for the curved surface that
    /// the normals tell of, 0…1; so magnified ground is round. 0, flat, by default; ¾ is usual.
    bool setRoundness(double share) { return assign("roundness", share); }
    double getRoundness() const { return _roundness; }

    /// The colour of anchor and lines, which ties the close-up to its region (paper: P2). Orange by default.
    bool setColor(const osg::Vec3d& color)
    {
        return assign({{"red", color.x()}, {"green", color.y()}, {"blue", color.z()}});
    }
    osg::Vec3d getColor() const { return {_red, _green, _blue}; }

    /// The layer of CloseUps' SurfaceData that it shows in the place of the scene's colours; "" for none, which is the default,
    /// as is any name that the data has not. Values need a table.
    void setSurface(const std::string& layer);
    const std::string& getSurface() const { return _surface; }
    /// How much of the layer shows over the scene's colours, 0…1. 1 by default.
    bool setSurfaceOpacity(double opacity) { return assign("surfaceOpacity", opacity); }
    double getSurfaceOpacity() const { return _surfaceOpacity; }
    /// Colours for the layer's values, over the table's own range. Null, the default, takes a ready one.
    bool setTable(ColorTable* table);
    ColorTable* getTable() { return _table.get(); }
    const ColorTable* getTable() const { return _table.get(); }
    enum Lighting
    {
        AS_SCENE, ///< the scene's colours with their light; layers get none
        UNLIT,    ///< the layer as it is
        SUN       ///< by the data's NORMAL layer and a sun of the close-up's own
    };
    /// AS_SCENE by default.
    bool setLighting(Lighting lighting) { return assign("lighting", lighting); }
    Lighting getLighting() const { return static_cast<Lighting>(_lighting); }
    /// Where SUN stands: azimuth clockwise from the region's y axis, radians −2π…2π, and elevation 0…π/2. 315° and 45° by
    /// default, as on maps.
    bool setSun(double azimuth, double elevation)
    {
        return assign({{"sunAzimuth", azimuth}, {"sunElevation", elevation}});
    }
    double getSunAzimuth() const { return _sunAzimuth; }
    double getSunElevation() const { return _sunElevation; }

    /// Styles: saturation and contrast 0…4, 1 leaves colours alone; brightness −1…1 is added; opacity 0…1.
    bool setSaturation(double saturation) { return assign("saturation", saturation); }
    double getSaturation() const { return _saturation; }
    bool setContrast(double contrast) { return assign("contrast", contrast); }
    double getContrast() const { return _contrast; }
    bool setBrightness(double brightness) { return assign("brightness", brightness); }
    double getBrightness() const { return _brightness; }
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// Bits 0…255: the projective mappings that it shows, by their channels; so a close-up has a set of its own. 255, all,
    /// by default. The overview shows those of channel 1 where a program gives it the define GEOFX_MAPPING_CHANNELS 1.
    bool setMappingChannels(int channels) { return assign("mappingChannels", channels); }
    int getMappingChannels() const { return _mappingChannels; }

    enum Activity
    {
        ACTIVE,
        REGION_ONLY, ///< the line around the region (paper: Figure 5.a)
        NO_ANCHOR,   ///< (5.b)
        DESATURATED  ///< (5.c)
    };
    /// ACTIVE by default.
    bool setActivity(Activity activity) { return assign("activity", activity); }
    Activity getActivity() const { return static_cast<Activity>(_activity); }

    /// How fast `turn` grows by itself, radians a second of the simulation time, −10…10; 0 by default. (Paper: III.B)
    bool setTurnRate(double rate) { return assign("turnRate", rate); }
    double getTurnRate() const { return _turnRate; }

    /// `offset + R · S · v` in the region's frame for a simulation time, seconds; of SCENE, else without the camera's part.
    osg::Matrixd shape(double time) const;

    const Properties& properties() const override;
    std::vector<Part> parts() override;

protected:
    ~CloseUp() override;

private:
    void propertyChanged(PropertyHolder& part) override;

    osg::ref_ptr<RegionOfInterest> _region;
    osg::ref_ptr<Anchor> _anchor;
    osg::ref_ptr<ColorTable> _table;
    std::string _surface;
    bool _enabled = true;
    double _offsetX = 0.0, _offsetY = 0.0, _offsetHeight = 2000.0;
    double _scaleX = 1.5, _scaleY = 1.5, _scaleHeight = 1.5;
    int _orientation = SCENE;
    double _tilt = 0.0, _turn = 0.0;
    int _edge = FRAGMENTS;
    double _roundness = 0.0;
    double _red = 1.0, _green = 0.55, _blue = 0.1;
    double _surfaceOpacity = 1.0;
    int _lighting = AS_SCENE;
    double _sunAzimuth, _sunElevation;
    double _saturation = 1.0, _contrast = 1.0, _brightness = 0.0, _opacity = 1.0;
    int _mappingChannels = 255;
    int _activity = ACTIVE;
    double _turnRate = 0.0;
};

} // namespace osgGeoFX
