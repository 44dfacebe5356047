// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/CoordinateSystemNode>
#include <osg/Image>
#include <osg/Matrixd>
#include <osg/Vec2d>
#include <osg/ref_ptr>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** A part of the ground that a close-up shows: a place, a size, and a mask of any shape (paper: interactive close-ups,
    Section III.A).

    **Frame.** x to the right, y to the front and z up, metres, about the region's centre at its base height; x points
    east and y north unless the region has a heading. On a globe x and y lie in the plane tangent at the centre. Places in the
    region are given as shares of half its width and depth: −1…1 on both axes.

    **Mask.** 1 where the ground belongs to the region, 0 where it does not, and between where a border is soft. It is a
    picture of maskSide² texels, from the shape library or from any grey image, with the distance to the border beside each
    value, so that borders stay sharp at any size.

    Setters refuse what makes no sense: they return false, warn once and leave the last good state. Changed by the thread
    of the frame loop between frames; reading is thread-safe. */
class OSGGEOFX_EXPORT RegionOfInterest : public PropertyHolder
{
public:
    RegionOfInterest();
    RegionOfInterest(const RegionOfInterest& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, RegionOfInterest);

    /// The centre on a projected terrain, metres in its coordinate system. (0, 0) by default.
    bool setCentre(const osg::Vec2d& centre)
    {
        return assign({{"centreX", centre.x()}, {"centreY", centre.y()}});
    }
    osg::Vec2d getCentre() const { return {_centreX, _centreY}; }
    /// The centre on a globe, radians. (0, 0) by default.
    bool setGeodeticCentre(double longitude, double latitude)
    {
        return assign({{"longitude", longitude}, {"latitude", latitude}});
    }
    double getLongitude() const { return _longitude; }
    double getLatitude() const { return _latitude; }
    /// The height of the frame's origin, metres above the ellipsoid or above z = 0: what heights are scaled about. 0 by
    /// default.
    bool setBase(double height) { return assign("base", height); }
    double getBase() const { return _base; }
    /// Whole width and depth, metres, 1…2e6. 2000 by default.
    bool setSize(double width, double depth) { return assign({{"width", width}, {"depth", depth}}); }
    double getWidth() const { return _width; }
    double getDepth() const { return _depth; }
    /// Clockwise turn of the region's y axis from north, radians, −2π…2π. 0 by default.
    bool setHeading(double heading) { return assign("heading", heading); }
    double getHeading() const { return _heading; }

    enum Shape
    {
        ELLIPSE, ///< a disc where width and depth are equal
        RECTANGLE,
        ROUNDED, ///< a rectangle with round corners
        POLYGON, ///< the outline
        STAR,
        IMAGE ///< the image's grey values
    };
    /// ELLIPSE by default.
    bool setShape(Shape shape) { return assign("shape", shape); }
    Shape getShape() const { return static_cast<Shape>(_shape); }
    /// Radius of a rounded rectangle's corners as a share of the smaller half side, 0…1. 0.3 by default.
    bool setRounding(double share) { return assign("rounding", share); }
    double getRounding() const { return _rounding; }
    /// Of a star, 3…64. 5 by default; one of them points to the front.
    bool setPoints(int points) { return assign("points", points); }
    int getPoints() const { return _points; }
    /// A star's inner radius as a share of the outer one, 0.05…1. 0.45 by default.
    bool setInnerRadius(double share) { return assign("innerRadius", share); }
    double getInnerRadius() const { return _innerRadius; }
    /// How far inside of the border the mask grows from 0 to 1, as a share of the smaller half side, 0…1; an image's own grey
    /// values are blurred as far, and grow as far from the region's border. 0, sharp, by default.
    bool setSoftness(double share) { return assign("softness", share); }
    double getSoftness() const { return _softness; }
    /// Side of the mask's picture, texels, 16…1024. 256 by default.
    bool setMaskSide(int texels) { return assign("maskSide", texels); }
    int getMaskSide() const { return _maskSide; }

    /// A polygon's corners in the region, −1…1, either way round, closed by itself. At least three, finite, within −1…1, with
    /// an area. A square by default. Where it crosses itself, the odd-even rule says what is inside; a way to a hole and back
    /// between the same corners is no border.
    bool setOutline(const std::vector<osg::Vec2d>& corners);
    const std::vector<osg::Vec2d>& getOutline() const { return _outline; }
    /// Any uncompressed 2D image, stretched over the region; its luminance, times its alpha where it has one. It is the mask
    /// where it is sharp; beyond 2048 texels on a side it is reduced. Without an image the mask of IMAGE is empty, with one
    /// warning. An image that changes (osg::Image::dirty()) is read anew.
    bool setImage(osg::Image* image);
    osg::Image* getImage() { return _image.get(); }
    const osg::Image* getImage() const { return _image.get(); }

    /** The mask: GL_RG, GL_FLOAT, maskSide² texels, row 0 at y = −1. Red is the mask, 0…1; green the signed distance to the
        line where the mask without its softness is one half, in halves of the smaller side, positive inside, −2 at least.
        Never null; a new image whenever it changes, so that one that is being drawn stays as it is. Made when it is asked
        for; place, heading and base do not change it, nor does a size with the same ratio. */
    osg::ref_ptr<const osg::Image> mask() const;
    /// Whether no texel of the mask is 0.5 or more: then there is no close-up.
    bool isEmpty() const;
    /// Mask and distance at a place of the region, as the GPU interpolates them: bilinear between the centres of texels, the
    /// distance on to the region's own border beyond the outermost ones; 0 and −2 outside −1…1.
    osg::Vec2d maskAt(const osg::Vec2d& place) const;
    /// The borders as closed lines in the region, −1…1: where the distance is 0, at the mask's resolution. The inside is on the
    /// left; the last place is joined with the first. `step` is the length of their parts at most, in halves of the smaller
    /// side; it is kept within 0.001…1.
    std::vector<std::vector<osg::Vec2d>> contours(double step) const;

    /// From the region's frame to world coordinates: with the ellipsoid on a globe, null on a projected terrain.
    osg::Matrixd frameToWorld(const osg::EllipsoidModel* ellipsoid) const;
    /// From world coordinates to places in the region (x, y: −1…1; z: metres above the base).
    osg::Matrixd worldToRegion(const osg::EllipsoidModel* ellipsoid) const;

    const Properties& properties() const override;

protected:
    ~RegionOfInterest() override;

private:
    struct Cache; ///< the mask as it was made last, under a mutex
    double _centreX = 0.0, _centreY = 0.0, _longitude = 0.0, _latitude = 0.0, _base = 0.0;
    double _width = 2000.0, _depth = 2000.0, _heading = 0.0;
    int _shape = ELLIPSE;
    double _rounding = 0.3;
    int _points = 5;
    double _innerRadius = 0.45, _softness = 0.0;
    int _maskSide = 256;
    std::vector<osg::Vec2d> _outline = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    osg::ref_ptr<osg::Image> _image;
    std::unique_ptr<Cache> _cache;
};

} // namespace osgGeoFX
