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

/** A region of the ground that is lifted, scaled, rotated and drawn in its own style (paper: interactive close-ups,
    Section II.B).

    **Geometry.** In the region's frame (x right, y to the front, z up, metres, origin at the region's center and base)
    a point v of the ground moves to `offset + R · S · v`. S scales by (scaleX, scaleY, scaleHeight) and R rotates. The
    paper's matrix M multiplies in the opposite order and names no center. The paper's axes are x, height, y. A height
    scale of 0 makes a flat map.

    **Orientation.** With SCENE, R rotates by `turn` about the vertical (counter-clockwise from above), then by `tilt`
    about the x axis, in the region's frame. The viewer then sees the close-up in the same perspective as the scene.
    With FIXED, the same rotation acts in a frame that moves with the camera: without a tilt, the viewer looks straight
    down at the map, and its y axis points up on the screen. BILLBOARD is FIXED without perspective, unless the camera
    is very near.

    **With a bend**, the offset starts at the region's center after the bend and rotates with the ground there. The
    close-up itself is not bent.

    Setters refuse values out of range: they return false, warn once and keep the former state. The thread of the frame
    loop changes a close-up, between frames.
    @ingroup closeup */
class OSGGEOFX_EXPORT CloseUp : public PropertyHolder, private PropertyListener
{
public:
    CloseUp();
    CloseUp(const CloseUp& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, CloseUp);

    /// The region is never null. A null pointer is refused with a warning. Several close-ups may share a region.
    bool setRegion(RegionOfInterest* region);
    RegionOfInterest* getRegion() { return _region.get(); }
    const RegionOfInterest* getRegion() const { return _region.get(); }
    /// The anchor is never null. A null pointer is refused with a warning. Several close-ups may share an anchor.
    bool setAnchor(Anchor* anchor);
    Anchor* getAnchor() { return _anchor.get(); }
    const Anchor* getAnchor() const { return _anchor.get(); }

    /// Whether the close-up is drawn. Default: true.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }

    /// The offset from the region's center along the region's axes x, y and up, metres, ±1e7. Default: (0, 0, 2000).
    bool setOffset(const osg::Vec3d& offset)
    {
        return assign({{"offsetX", offset.x()}, {"offsetY", offset.y()}, {"offsetHeight", offset.z()}});
    }
    osg::Vec3d getOffset() const { return {_offsetX, _offsetY, _offsetHeight}; }
    /// The scales in the plane, 0.001…1000, and of heights, 0…1000. A height scale of 0 makes a flat map. Default: 1.5
    /// for all.
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
    /// Default: SCENE.
    bool setOrientation(Orientation orientation) { return assign("orientation", orientation); }
    Orientation getOrientation() const { return static_cast<Orientation>(_orientation); }
    /// The paper's α: the rotation about the x axis, which lifts the far side, radians, −2π…2π. Default: 0.
    bool setTilt(double tilt) { return assign("tilt", tilt); }
    double getTilt() const { return _tilt; }
    /// The paper's β: the rotation about the vertical, radians, −2π…2π. Default: 0.
    bool setTurn(double turn) { return assign("turn", turn); }
    double getTurn() const { return _turn; }

    enum Edge
    {
        FRAGMENTS, ///< cuts fragments along the mask's border, sharp at any size
        PRIMITIVES ///< keeps the triangles that lie wholly in the mask (the paper)
    };
    /// How the border of the close-up is cut. Default: FRAGMENTS.
    bool setEdge(Edge edge) { return assign("edge", edge); }
    Edge getEdge() const { return static_cast<Edge>(_edge); }

    /// How far the vertices that tessellation adds (CloseUps::setTessellation) move from the flat triangles to the
    /// curved surface that the normals describe, 0…1. Magnified ground then looks round. A usual value is ¾. The
    /// default, 0, is flat.
    bool setRoundness(double share) { return assign("roundness", share); }
    double getRoundness() const { return _roundness; }

    /// The color of the anchor and the lines: red, green and blue, 0…1 each, rounded to eight bits. It ties the close-up to
    /// its region (paper: P2). Default: orange.
    bool setColor(const osg::Vec3d& color) { return assign("color", packedColor(color)); }
    osg::Vec3d getColor() const { return unpackedColor(_color); }

    /// The name of the layer of CloseUps' SurfaceData that replaces the scene's colors. "", the default, and unknown
    /// names mean no layer. A layer of values uses a color table.
    void setSurface(const std::string& layer);
    const std::string& getSurface() const { return _surface; }
    /// The share of the layer in the color, 0…1. The scene's colors are the rest. Default: 1.
    bool setSurfaceOpacity(double opacity) { return assign("surfaceOpacity", opacity); }
    double getSurfaceOpacity() const { return _surfaceOpacity; }
    /// The colors for the layer's values, over the table's own range. With null, the default, a ready table is used.
    bool setTable(ColorTable* table);
    ColorTable* getTable() { return _table.get(); }
    const ColorTable* getTable() const { return _table.get(); }
    enum Lighting
    {
        AS_SCENE, ///< the scene's colors with their light; a layer has no light
        UNLIT,    ///< the layer without light
        SUN       ///< light from the data's NORMAL layer and a sun of the close-up's own
    };
    /// Default: AS_SCENE.
    bool setLighting(Lighting lighting) { return assign("lighting", lighting); }
    Lighting getLighting() const { return static_cast<Lighting>(_lighting); }
    /// The direction of the sun for SUN: azimuth clockwise from the region's y axis, radians, −2π…2π, and elevation,
    /// radians, 0…π/2. Default: 315° and 45°, as on maps.
    bool setSun(double azimuth, double elevation)
    {
        return assign({{"sunAzimuth", azimuth}, {"sunElevation", elevation}});
    }
    double getSunAzimuth() const { return _sunAzimuth; }
    double getSunElevation() const { return _sunElevation; }

    /// The saturation of the colors, 0…4. Default: 1, unchanged.
    bool setSaturation(double saturation) { return assign("saturation", saturation); }
    double getSaturation() const { return _saturation; }
    /// The contrast of the colors, 0…4. Default: 1, unchanged.
    bool setContrast(double contrast) { return assign("contrast", contrast); }
    double getContrast() const { return _contrast; }
    /// A brightness that is added, −1…1. Default: 0.
    bool setBrightness(double brightness) { return assign("brightness", brightness); }
    double getBrightness() const { return _brightness; }
    /// The opacity of the close-up, 0…1. Default: 1.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// The channels of the projective mappings that the close-up shows, as 8 bits, 0…255. A close-up can thus have its
    /// own set of mappings. Default: 255, all. To show only mappings of channel 1 in the overview, a program gives it
    /// the define GEOFX_MAPPING_CHANNELS 1.
    bool setMappingChannels(int channels) { return assign("mappingChannels", channels); }
    int getMappingChannels() const { return _mappingChannels; }

    enum Activity
    {
        ACTIVE,      ///< the whole close-up with anchor and lines
        REGION_ONLY, ///< only the line around the region (paper: Figure 5.a)
        NO_ANCHOR,   ///< the close-up and the line around its region, without the anchor (Figure 5.b)
        DESATURATED  ///< the whole close-up, nearly grey (Figure 5.c)
    };
    /// Default: ACTIVE.
    bool setActivity(Activity activity) { return assign("activity", activity); }
    Activity getActivity() const { return static_cast<Activity>(_activity); }

    /// The growth of `turn`, radians per second of simulation time, −10…10 (paper: Section III.B). Default: 0.
    bool setTurnRate(double rate) { return assign("turnRate", rate); }
    double getTurnRate() const { return _turnRate; }

    /// The matrix of `offset + R · S · v` in the region's frame at a simulation time, seconds. It omits the camera's
    /// part of FIXED and BILLBOARD.
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
    int _color = 0xff8c1a;
    double _surfaceOpacity = 1.0;
    int _lighting = AS_SCENE;
    double _sunAzimuth, _sunElevation;
    double _saturation = 1.0, _contrast = 1.0, _brightness = 0.0, _opacity = 1.0;
    int _mappingChannels = 255;
    int _activity = ACTIVE;
    double _turnRate = 0.0;
};

} // namespace osgGeoFX
