// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ColorTransfer.h>
#include <osgGeoFX/mapping/DataLayer.h>
#include <osgGeoFX/mapping/Footprint.h>
#include <osgGeoFX/raster/ColorTable.h>

#include <glm/mat3x3.hpp>
#include <osg/Vec2d>
#include <osg/Vec3d>

#include <optional>

namespace osgGeoFX
{

/** One raster thrown onto the scene: PM = (O, U, V, M_T, L, C, CM) of the paper's Section 3.2.

    Places are those of the hosting ProjectiveMappings' frame, metres: x and y on its reference plane, heights above it.
    The raster spans the parallelogram O ± U ± V; its left edge lies at −U, its lower one at −V. M_T then moves
    it within, in raster coordinates of 0…1. What a transform makes of the edges is the raster's outline.

    A mapping draws where its layer's picture (or its color transfer's constant or scene colour) is, on everything
    below the EffectScene, along the reference plane's normal; a pinhole mapping along the rays of a camera.

    The layer, mask, table and transfer may be shared by several mappings. Changes count in the next frame. */
class OSGGEOFX_EXPORT ProjectiveMapping : public PropertyHolder, private PropertyListener
{
public:
    ProjectiveMapping();
    ProjectiveMapping(const ProjectiveMapping& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ProjectiveMapping);

    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }
    /// Of two mappings the one with the higher order lies on top, of equal ones the one that was added later. −1000…1000.
    /// (The paper draws its mapping 0 last.)
    bool setOrder(int order) { return assign("order", order); }
    int getOrder() const { return _order; }
    /// 0…1.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// 0…1: which mappings stay where the GPU cannot take all; ½ by default.
    bool setImportance(double importance) { return assign("importance", importance); }
    double getImportance() const { return _importance; }
    /// Bits 0…255: the geometries it is for. A subgraph with the define GEOFX_MAPPING_CHANNELS takes mappings of these
    /// channels only; others take all. 255 by default.
    bool setChannels(int bits) { return assign("channels", bits); }
    int getChannels() const { return _channels; }

    /// O, metres.
    bool setCentre(const osg::Vec2d& place)
    {
        return assign({{"centreX", place.x()}, {"centreY", place.y()}});
    }
    osg::Vec2d getCentre() const { return {_centreX, _centreY}; }
    /// The centre's height, metres, where fades and sizes on the screen are measured; 0 by default. What is drawn does not
    /// depend on it otherwise.
    bool setHeight(double metres) { return assign("height", metres); }
    double getHeight() const { return _height; }
    /// U and V: from the centre to the middles of the right and of the upper edge, metres. They need not be square to each
    /// other, but span an area.
    bool setAxes(const osg::Vec2d& u, const osg::Vec2d& v);
    osg::Vec2d getU() const { return {_uX, _uY}; }
    osg::Vec2d getV() const { return {_vX, _vY}; }
    /// A rectangle: half its width and height, metres, and where its upper edge points, radians clockwise from the
    /// frame's y axis.
    bool setRectangle(const osg::Vec2d& centre, double halfWidth, double halfHeight, double heading = 0.0);
    /// M_T in raster coordinates, projective in general: (u, v, 1) becomes M (u, v, 1). It must have an inverse, and the
    /// outline must not reach infinity.
    bool setTransform(const glm::dmat3& m);
    glm::dmat3 getTransform() const;
    /// The raster's corners (lower left, lower right, upper right, upper left), metres; any convex quadrilateral.
    bool setQuad(const osg::Vec2d (&corners)[4]);

    /// The heights that are covered, metres; everything by default.
    bool setHeights(double lowest, double highest)
    {
        return assign({{"lowest", lowest}, {"highest", highest}});
    }
    double getLowest() const { return _lowest; }
    double getHighest() const { return _highest; }

    /// Shows from `nearest` to `farthest` metres off the eye, and fades out within the share `softness` (0…1) beyond.
    bool setDistances(double nearest, double farthest, double softness = 0.2)
    {
        return assign({{"nearest", nearest}, {"farthest", farthest}, {"softness", softness}});
    }
    double getNearest() const { return _nearest; }
    double getFarthest() const { return _farthest; }
    double getSoftness() const { return _softness; }
    /// Shows in full from `full` pixels on and not at all below `none`: ρ of the paper's Section 4.3, here twice the root
    /// of |U||V| as the eye sees it, pixels. 0 and 0 by default: always.
    bool setPixels(double none, double full) { return assign({{"pixelsNone", none}, {"pixelsFull", full}}); }
    double getPixelsNone() const { return _pixelsNone; }
    double getPixelsFull() const { return _pixelsFull; }
    /// Shows in full up to the slope `full` and not at all above `none`, radians from the horizontal; π/2 both by default.
    bool setSlopes(double full, double none) { return assign({{"slopeFull", full}, {"slopeNone", none}}); }
    double getSlopeFull() const { return _slopeFull; }
    double getSlopeNone() const { return _slopeNone; }
    /// Whether edges are smooth; true by default. Off for tiles that must meet without a seam.
    bool setSoftEdges(bool soft) { return assign("softEdges", soft ? 1.0 : 0.0); }
    bool getSoftEdges() const { return _softEdges; }

    /// For symbols: the size on the screen, pixels; O ± U ± V is the largest that it gets. 0: metres count alone.
    bool setSizeInPixels(double pixels) { return assign("sizeInPixels", pixels); }
    double getSizeInPixels() const { return _sizeInPixels; }
    /// For symbols: the upper edge points away from the eye, whatever the heading. False by default.
    bool setTurned(bool turned) { return assign("turned", turned ? 1.0 : 0.0); }
    bool getTurned() const { return _turned; }

    /// PLANE: along the reference plane's normal. PINHOLE: along the rays of a camera at O and `height`; of U and V
    /// only the footprint that is never left counts.
    enum Projector
    {
        PLANE,
        PINHOLE
    };
    bool setProjector(Projector projector) { return assign("projector", projector); }
    Projector getProjector() const { return static_cast<Projector>(_projector); }

    /// Of a pinhole: place in the frame, metres; where it looks, radians: heading clockwise from the frame's y axis,
    /// pitch up, roll to the right; full angle of view across, radians, and width over height of the picture.
    struct Camera
    {
        osg::Vec3d eye;
        double heading = 0.0;
        double pitch = 0.0;
        double roll = 0.0;
        double fieldOfView = 1.0;
        double aspectRatio = 4.0 / 3.0;
        double k1 = 0.0, k2 = 0.0, k3 = 0.0; ///< radial distortion after Brown, tangents
        double p1 = 0.0, p2 = 0.0;           ///< tangential distortion
        double range = 5000.0;               ///< how far its picture reaches, metres
    };
    bool setCamera(const Camera& camera);
    Camera getCamera() const;

    bool setLayer(DataLayer* layer);
    DataLayer* getLayer() { return _layer.get(); }
    const DataLayer* getLayer() const { return _layer.get(); }
    /// The mask of ColorTransfer::FROM_MASK, in the same coordinates as the layer.
    bool setMask(DataLayer* mask);
    DataLayer* getMask() { return _mask.get(); }
    const DataLayer* getMask() const { return _mask.get(); }
    bool setTable(ColorTable* table);
    ColorTable* getTable() { return _table.get(); }
    const ColorTable* getTable() const { return _table.get(); }
    /// Never null; null is refused.
    bool setTransfer(ColorTransfer* transfer);
    ColorTransfer* getTransfer() { return _transfer.get(); }
    const ColorTransfer* getTransfer() const { return _transfer.get(); }

    std::vector<Part> parts() override { return {{"transfer", _transfer.get()}}; }
    const Properties& properties() const override;

    /// The corners of the raster's outline; nothing where M_T takes it to infinity.
    std::optional<PlaneFootprint> outline() const;
    /// Where it can show at all: the outline, for symbols and cameras what they can reach.
    PlaneFootprint footprint() const;
    /// From places to raster coordinates, homogeneous: (x, y, 1) becomes (u, v, 1).
    glm::dmat3 placeToRaster() const;

protected:
    ~ProjectiveMapping() override;
    std::string inconsistency() const override;

private:
    void propertyChanged(PropertyHolder& transfer) override;

    bool _enabled = true;
    int _order = 0;
    double _opacity = 1.0;
    double _importance = 0.5;
    int _channels = 255;
    double _centreX = 0.0, _centreY = 0.0;
    double _uX = 100.0, _uY = 0.0, _vX = 0.0, _vY = 100.0;
    double _m00 = 1.0, _m01 = 0.0, _m02 = 0.0, _m10 = 0.0, _m11 = 1.0, _m12 = 0.0, _m20 = 0.0, _m21 = 0.0,
           _m22 = 1.0;
    double _lowest = -1e6, _highest = 1e6;
    double _nearest = 0.0, _farthest = 5e7, _softness = 0.2;
    double _pixelsNone = 0.0, _pixelsFull = 0.0;
    double _slopeFull, _slopeNone;
    bool _softEdges = true;
    double _sizeInPixels = 0.0;
    bool _turned = false;
    int _projector = PLANE;
    double _height = 0.0, _heading = 0.0, _pitch = 0.0, _roll = 0.0, _fieldOfView = 1.0,
           _aspectRatio = 4.0 / 3.0;
    double _k1 = 0.0, _k2 = 0.0, _k3 = 0.0, _p1 = 0.0, _p2 = 0.0, _range = 5000.0;
    osg::ref_ptr<DataLayer> _layer, _mask;
    osg::ref_ptr<ColorTable> _table;
    osg::ref_ptr<ColorTransfer> _transfer;
};

} // namespace osgGeoFX
