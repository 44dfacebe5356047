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

/** One raster that is projected onto the scene: PM = (O, U, V, M_T, L, C, CM) of the paper's Section 3.2.

    Places are in the frame of the hosting ProjectiveMappings, metres: x and y on its reference plane, and heights
    above the plane. The raster covers the parallelogram O ± U ± V. Its left edge lies at −U and its lower edge at −V.
    The transform M_T then changes the raster coordinates 0…1. The transformed edges are the raster's outline.

    A mapping draws the layer's image, a constant color or the changed scene color, as its color transfer says. It
    draws on everything below the EffectScene. The projector PLANE projects along the normal of the reference plane,
    the projector PINHOLE along the rays of a camera.

    Several mappings may share a layer, mask, table or transfer. A change takes effect in the next frame. Setters
    refuse values out of range: they return false, warn once and keep the former value.
    @ingroup mapping */
class OSGGEOFX_EXPORT ProjectiveMapping : public PropertyHolder, private PropertyListener
{
public:
    ProjectiveMapping();
    ProjectiveMapping(const ProjectiveMapping& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, ProjectiveMapping);

    /// Whether the mapping is drawn. Default: true.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }
    /// The mapping of higher order lies on top, −1000…1000. Of equal orders the mapping that was added later lies on
    /// top. (The paper draws its mapping 0 last.) Default: 0.
    bool setOrder(int order) { return assign("order", order); }
    int getOrder() const { return _order; }
    /// 0…1. Default: 1.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// The mappings of higher importance, 0…1, stay if the GPU has no room for all mappings. Default: 0.5.
    bool setImportance(double importance) { return assign("importance", importance); }
    double getImportance() const { return _importance; }
    /// The geometries that show the mapping, as 8 bits, 0…255. A subgraph with the define GEOFX_MAPPING_CHANNELS shows
    /// only the mappings that share a bit with the define. All other geometry shows all mappings. Default: 255.
    bool setChannels(int bits) { return assign("channels", bits); }
    int getChannels() const { return _channels; }

    /// O, metres, ±5e7. Default: (0, 0).
    bool setCenter(const osg::Vec2d& place)
    {
        return assign({{"centerX", place.x()}, {"centerY", place.y()}});
    }
    osg::Vec2d getCenter() const { return {_centerX, _centerY}; }
    /// The height of the center, metres, −12 000…1e7. Fades and sizes on the screen are measured there, and it is the
    /// height of a pinhole camera. Nothing else depends on it. Default: 0.
    bool setHeight(double metres) { return assign("height", metres); }
    double getHeight() const { return _height; }
    /// U and V: from the center to the middle of the right edge and to the middle of the upper edge, metres. They need
    /// not be perpendicular, but must span an area. Default: (100, 0) and (0, 100).
    bool setAxes(const osg::Vec2d& u, const osg::Vec2d& v);
    osg::Vec2d getU() const { return {_uX, _uY}; }
    osg::Vec2d getV() const { return {_vX, _vY}; }
    /// A rectangle with half the width and half the height, metres. `heading` is the direction of the upper edge,
    /// radians clockwise from the frame's y axis.
    bool setRectangle(const osg::Vec2d& center, double halfWidth, double halfHeight, double heading = 0.0);
    /// M_T in raster coordinates, in general projective: (u, v, 1) becomes M (u, v, 1). It must have an inverse, and
    /// the outline must not reach infinity. Default: identity.
    bool setTransform(const glm::dmat3& m);
    glm::dmat3 getTransform() const;
    /// Sets O, U, V and M_T from the raster's corners, metres: lower left, lower right, upper right, upper left. They
    /// may form any convex quadrilateral.
    bool setQuad(const osg::Vec2d (&corners)[4]);

    /// The range of heights that shows the mapping, metres, ±1e6. Default: all heights.
    bool setHeights(double lowest, double highest)
    {
        return assign({{"lowest", lowest}, {"highest", highest}});
    }
    double getLowest() const { return _lowest; }
    double getHighest() const { return _highest; }

    /// The mapping shows at distances of `nearest`…`farthest` metres from the eye, 0…5e7. It fades out beyond both
    /// limits, within the share `softness` (0…1) of each. Default: all distances.
    bool setDistances(double nearest, double farthest, double softness = 0.2)
    {
        return assign({{"nearest", nearest}, {"farthest", farthest}, {"softness", softness}});
    }
    double getNearest() const { return _nearest; }
    double getFarthest() const { return _farthest; }
    double getSoftness() const { return _softness; }
    /// The mapping shows fully if its size on the screen is at least `full` pixels, and not at all below `none`. The
    /// size is ρ of the paper's Section 4.3, here twice the root of |U||V| as the eye sees it, or, for a PINHOLE, twice its range. Default: 0 and 0, so
    /// that it always shows.
    bool setPixels(double none, double full) { return assign({{"pixelsNone", none}, {"pixelsFull", full}}); }
    double getPixelsNone() const { return _pixelsNone; }
    double getPixelsFull() const { return _pixelsFull; }
    /// The mapping shows fully up to the slope `full` and not at all above `none`, radians from the horizontal, 0…π/2.
    /// Default: π/2 for both, all slopes.
    bool setSlopes(double full, double none) { return assign({{"slopeFull", full}, {"slopeNone", none}}); }
    double getSlopeFull() const { return _slopeFull; }
    double getSlopeNone() const { return _slopeNone; }
    /// Whether edges are smooth. A program turns it off for tiles that must meet without a seam. Default: true.
    bool setSoftEdges(bool soft) { return assign("softEdges", soft ? 1.0 : 0.0); }
    bool getSoftEdges() const { return _softEdges; }

    /// For symbols: the size on the screen, pixels, measured as in setPixels(). The symbol never becomes larger than O
    /// ± U ± V. The default, 0, means that the size is in metres.
    bool setSizeInPixels(double pixels) { return assign("sizeInPixels", pixels); }
    double getSizeInPixels() const { return _sizeInPixels; }
    /// For symbols: whether the upper edge points away from the eye, whatever the heading. Default: false.
    bool setTurned(bool turned) { return assign("turned", turned ? 1.0 : 0.0); }
    bool getTurned() const { return _turned; }

    /// PLANE projects along the normal of the reference plane. PINHOLE projects along the rays of a camera at O and
    /// `height`. U and V then do not place the raster.
    enum Projector
    {
        PLANE,
        PINHOLE
    };
    /// Default: PLANE.
    bool setProjector(Projector projector) { return assign("projector", projector); }
    Projector getProjector() const { return static_cast<Projector>(_projector); }

    /// A pinhole camera: its place in the frame, metres, and its direction, radians. The heading is clockwise from the
    /// frame's y axis (±2π), the pitch is upwards (±π/2) and the roll is to the right (±π). fieldOfView is the full
    /// horizontal angle of view, 0.1 to 170 degrees in radians; 60 degrees by default. aspectRatio is the image's width over its height, 0.01…100.
    struct Camera
    {
        osg::Vec3d eye;
        double heading = 0.0;
        double pitch = 0.0;
        double roll = 0.0;
        double fieldOfView = osg::PI / 3.0;
        double aspectRatio = 4.0 / 3.0;
        double k1 = 0.0, k2 = 0.0, k3 = 0.0; ///< radial distortion after Brown, in tangents, ±10
        double p1 = 0.0, p2 = 0.0;           ///< tangential distortion, ±1
        double range = 5000.0; ///< distance from the camera to which its image reaches, metres, 0.1…1e6
    };
    /// Sets the camera and the projector PINHOLE.
    bool setCamera(const Camera& camera);
    Camera getCamera() const;

    /// The raster. Null for none.
    bool setLayer(DataLayer* layer);
    DataLayer* getLayer() { return _layer.get(); }
    const DataLayer* getLayer() const { return _layer.get(); }
    /// The mask for ColorTransfer::FROM_MASK, in the same coordinates as the layer. Null for none.
    bool setMask(DataLayer* mask);
    DataLayer* getMask() { return _mask.get(); }
    const DataLayer* getMask() const { return _mask.get(); }
    /// The color table for ColorTransfer::TABLE. Null for none.
    bool setTable(ColorTable* table);
    ColorTable* getTable() { return _table.get(); }
    const ColorTable* getTable() const { return _table.get(); }
    /// The transfer is never null. A null pointer is refused with a warning: the setter returns false.
    bool setTransfer(ColorTransfer* transfer);
    ColorTransfer* getTransfer() { return _transfer.get(); }
    const ColorTransfer* getTransfer() const { return _transfer.get(); }

    std::vector<Part> parts() override { return {{"transfer", _transfer.get()}}; }
    const Properties& properties() const override;

    /// The corners of the raster's outline. Empty if M_T takes it to infinity.
    std::optional<PlaneFootprint> outline() const;
    /// The area that the mapping can cover: the outline, or for symbols and pinhole cameras a square around everything
    /// they reach.
    PlaneFootprint footprint() const;
    /// The matrix from places to homogeneous raster coordinates: (x, y, 1) becomes (u, v, 1).
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
    double _centerX = 0.0, _centerY = 0.0;
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
    double _height = 0.0, _heading = 0.0, _pitch = 0.0, _roll = 0.0, _fieldOfView = osg::PI / 3.0,
           _aspectRatio = 4.0 / 3.0;
    double _k1 = 0.0, _k2 = 0.0, _k3 = 0.0, _p1 = 0.0, _p2 = 0.0, _range = 5000.0;
    osg::ref_ptr<DataLayer> _layer, _mask;
    osg::ref_ptr<ColorTable> _table;
    osg::ref_ptr<ColorTransfer> _transfer;
};

} // namespace osgGeoFX
