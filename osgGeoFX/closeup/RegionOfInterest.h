// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/LocalOrigin.h>
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

/** The part of the ground that a close-up shows: a place, a size, and a mask of any shape (paper: interactive
    close-ups, Section III.A).

    **Frame.** x points right, y to the front and z up, metres. The origin is the region's center at its base height.
    Without a heading, x points east and y north. On a globe x and y lie in the tangent plane at the center. A place in
    the region is given in shares of half its width and half its depth: −1…1 on both axes.

    **Mask.** The mask is 1 where the ground belongs to the region and 0 elsewhere. A soft border has values between
    them. The mask is an image of maskSide² texels, from the shape library or from any grey image. Beside each value it
    stores the distance to the border, so that borders stay sharp at any size.

    Setters refuse values out of range: they return false, warn once and keep the former state. The thread of the frame
    loop changes a region, between frames. Reading is thread-safe.
    @ingroup closeup */
class OSGGEOFX_EXPORT RegionOfInterest : public PropertyHolder
{
public:
    RegionOfInterest();
    RegionOfInterest(const RegionOfInterest& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, RegionOfInterest);

    /// The center on a projected terrain, metres in its coordinate system, ±5e7. Default: (0, 0).
    bool setCenter(const osg::Vec2d& center)
    {
        return assign({{"centerX", center.x()}, {"centerY", center.y()}});
    }
    osg::Vec2d getCenter() const { return _center.place(); }
    /// The center on a globe, radians. Default: (0, 0).
    bool setGeodeticCenter(double longitude, double latitude)
    {
        return assign({{"longitude", longitude}, {"latitude", latitude}});
    }
    double getLongitude() const { return _center.longitude; }
    double getLatitude() const { return _center.latitude; }
    /// The height of the frame's origin, metres above the ellipsoid or above z = 0, −12 000…1e7. Heights are scaled
    /// about it. Default: 0.
    bool setBaseHeight(double height) { return assign("baseHeight", height); }
    double getBaseHeight() const { return _baseHeight; }
    /// The full width and depth, metres, 1…2e6. Default: 2000.
    bool setSize(double width, double depth) { return assign({{"width", width}, {"depth", depth}}); }
    double getWidth() const { return _width; }
    double getDepth() const { return _depth; }
    /// The rotation of the region's y axis clockwise from north, radians, −2π…2π. Default: 0.
    bool setHeading(double heading) { return assign("heading", heading); }
    double getHeading() const { return _heading; }

    enum Shape
    {
        ELLIPSE, ///< a disc if width and depth are equal
        RECTANGLE,
        ROUNDED, ///< a rectangle with round corners
        POLYGON, ///< the polygon of setOutline()
        STAR,
        IMAGE ///< the grey values of setImage()
    };
    /// Default: ELLIPSE.
    bool setShape(Shape shape) { return assign("shape", shape); }
    Shape getShape() const { return static_cast<Shape>(_shape); }
    /// The radius of the corners of ROUNDED, as a share of the smaller half side, 0…1. Default: 0.3.
    bool setRounding(double share) { return assign("rounding", share); }
    double getRounding() const { return _rounding; }
    /// The number of points of a star, 3…64. One of them points to the front. Default: 5.
    bool setPoints(int points) { return assign("points", points); }
    int getPoints() const { return _points; }
    /// The inner radius of a star, as a share of the outer radius, 0.05…1. Default: 0.45.
    bool setInnerRadius(double share) { return assign("innerRadius", share); }
    double getInnerRadius() const { return _innerRadius; }
    /// The width inside the border over which the mask grows from 0 to 1, as a share of the smaller half side, 0…1. An
    /// image's grey values are blurred by this width and grow over it from the region's border. The default, 0, is
    /// sharp.
    bool setSoftness(double share) { return assign("softness", share); }
    double getSoftness() const { return _softness; }
    /// The side of the mask image, texels, 16…1024. Default: 256.
    bool setMaskSide(int texels) { return assign("maskSide", texels); }
    int getMaskSide() const { return _maskSide; }

    /// The corners of a polygon in the region, −1…1, in either direction. The polygon closes itself. At least three
    /// corners with finite values and an area are needed. Where edges cross, the odd-even rule decides what is inside.
    /// A pair of edges to and from a hole between the same corners is no border. Default: a square.
    bool setOutline(const std::vector<osg::Vec2d>& corners);
    const std::vector<osg::Vec2d>& getOutline() const { return _outline; }
    /// Any uncompressed 2D image, stretched over the region. Its luminance, times its alpha if it has one, is the mask
    /// if `softness` is 0. An image beyond 2048 texels on a side is reduced. Without an image the mask of IMAGE is
    /// empty, with one warning. An image that changes (osg::Image::dirty()) is read again. Returns false if it cannot
    /// use the image.
    bool setImage(osg::Image* image);
    osg::Image* getImage() { return _image.get(); }
    const osg::Image* getImage() const { return _image.get(); }

    /** The mask: GL_RG, GL_FLOAT, maskSide² texels, row 0 at y = −1. Red is the mask, 0…1. Green is the signed
        distance, in halves of the smaller side and at least −2, to the line where the mask without its softness is one
        half. It is positive inside. The image is never null. Each change gives a new image, so that an image in use by
        the drawing stays unchanged. The image is made on demand. The place, heading and base do not change it, and a
        size with the same ratio does not either. */
    osg::ref_ptr<const osg::Image> mask() const;
    /// Whether no texel of the mask is 0.5 or more. If so, there is no close-up.
    bool isEmpty() const;
    /// The mask and the distance at a place of the region, as the GPU interpolates them: bilinear between the centers
    /// of texels. Beyond the outermost centers the distance continues to the region's own border. Outside −1…1 they
    /// are 0 and −2.
    osg::Vec2d maskAt(const osg::Vec2d& place) const;
    /// The borders as closed lines in the region, −1…1: the lines where the distance is 0, at the mask's resolution.
    /// The inside is on the left. The last point joins the first. `step` is the largest length of their segments, in
    /// halves of the smaller side, limited to 0.001…1.
    std::vector<std::vector<osg::Vec2d>> contours(double step) const;

    /// The matrix from the region's frame to world coordinates. `ellipsoid` is null on a projected terrain.
    osg::Matrixd frameToWorld(const osg::EllipsoidModel* ellipsoid) const;
    /// The matrix from world coordinates to places in the region (x, y: −1…1; z: metres above the base).
    osg::Matrixd worldToRegion(const osg::EllipsoidModel* ellipsoid) const;

    const Properties& properties() const override;

protected:
    ~RegionOfInterest() override;

private:
    struct Cache; ///< the mask as it was made last, under a mutex
    LocalOrigin _center;
    double _baseHeight = 0.0;
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
