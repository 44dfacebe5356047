// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/CoordinateSystemNode>
#include <osg/Image>
#include <osg/Matrixd>
#include <osg/Vec2d>

#include <map>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Several pictures of one part of the ground, all of one size and place: the layers of one texture array (paper:
    interactive close-ups, Section IV.B.2, "surface data"). A close-up names the one that it shows.

    **Frame.** As ProjectiveMappings has it: on a projected terrain its coordinates less the origin; on a globe x east and
    y north about the origin, of a place's foot on the ellipsoid (PROJ's `+proj=ortho` there). The pictures cover the
    rectangle from `low` to `high` in it, metres; row 0 is the southernmost.

    **Layers.** Floats, four for each texel: colours 0…1 with alpha; of values the first is the value and the fourth 1
    where there is one; of NORMAL the first three are the unit normal, x east, y north, z up; of ASPECT the second and the
    third are its sine and cosine, which may be interpolated where angles may not. Texels without data are 0 in all four
    (only colours may stand under an alpha of 0): values and normals that were interpolated between texels are to be divided by
    the fourth. Classes are never interpolated.

    Changed by the thread of the frame loop between frames; reading is thread-safe. */
class OSGGEOFX_EXPORT SurfaceData : public PropertyHolder
{
public:
    SurfaceData() = default;
    SurfaceData(const SurfaceData& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, SurfaceData);

    enum Kind
    {
        COLOR,     ///< a picture
        HEIGHT,    ///< metres
        NORMAL,    ///< unit normals
        SLOPE,     ///< 0…π/2, radians from the horizontal
        ASPECT,    ///< 0…2π, radians clockwise from north, of the way down; none where it is level
        OCCLUSION, ///< 0…1, the share of the sky that is seen
        CLASS,     ///< numbers that name something, such as land cover
        VALUE      ///< any other numbers
    };

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
    /// The rectangle that the pictures cover, metres in the frame. low must be less than high. ±1000 by default.
    bool setRectangle(const osg::Vec2d& low, const osg::Vec2d& high);
    osg::Vec2d getLow() const { return {_lowX, _lowY}; }
    osg::Vec2d getHigh() const { return {_highX, _highY}; }

    /// One more layer. Refused: null, a name that is there already or empty, a size other than the first one's, any format but
    /// GL_RGBA and GL_FLOAT, rows that are not close together or not from below, more than 16384 texels on a side.
    bool addLayer(const std::string& name, Kind kind, osg::Image* image);
    /// One more layer: what follows from the first HEIGHT layer, as derive() tells. Refused where there is none.
    bool addDerived(const std::string& name, Kind kind, double radius = 2000.0);
    /// False where there is none of that name.
    bool removeLayer(const std::string& name);
    int getNumLayers() const { return static_cast<int>(_layers.size()); }
    const std::string& getLayerName(int layer) const { return _layers[static_cast<std::size_t>(layer)].name; }
    Kind getLayerKind(int layer) const { return _layers[static_cast<std::size_t>(layer)].kind; }
    const osg::Image* getLayerImage(int layer) const
    {
        return _layers[static_cast<std::size_t>(layer)].image;
    }
    /// −1 where there is none of that name.
    int findLayer(const std::string& name) const;
    /// Texels along x and y; both 0 without layers.
    int getWidth() const { return _layers.empty() ? 0 : _layers.front().image->s(); }
    int getHeight() const { return _layers.empty() ? 0 : _layers.front().image->t(); }
    /// From texel to texel, metres along x and y; 0 without layers.
    osg::Vec2d getSpacing() const;

    /** Colours from an image of GL_RGB, RGBA, BGR, BGRA, LUMINANCE, LUMINANCE_ALPHA, INTENSITY, ALPHA (white), RED or RG,
        of bytes, shorts, ints (signed or not) or floats; what lies beyond 0…1 is cut. Row 0 is the lowest also of an image
        whose origin is TOP_LEFT. Resampled to a size where one is given: averaged where it shrinks and linear where it
        grows, weighted with alpha. Null, with a warning, for any other image or size. */
    static osg::ref_ptr<osg::Image> toLayer(const osg::Image& image, int width = 0, int height = 0);

    /** What follows from heights: NORMAL, SLOPE, ASPECT and OCCLUSION, of a HEIGHT layer whose texels are `spacing` apart,
        metres. Slopes by central differences (Horn's weights); texels beside holes and at the borders use what there is.
        OCCLUSION is the share of the sky, weighted by the cosine to the vertical, above the horizon in 16 directions, made by
        all that stands within `radius` metres, to a texel; holes and what lies beyond the borders hide nothing. Null, with a
        warning, where the kind is none of these, the image no layer, a spacing not positive or the radius negative.
        OCCLUSION takes a second or two for a million texels, whatever the radius. Thread-safe. */
    static osg::ref_ptr<osg::Image> derive(Kind kind, const osg::Image& heights, const osg::Vec2d& spacing,
                                           double radius = 2000.0);

    /// From the frame to world coordinates: with the ellipsoid on a globe, null on a projected terrain.
    osg::Matrixd frameToWorld(const osg::EllipsoidModel* ellipsoid) const;

    const Properties& properties() const override;

protected:
    ~SurfaceData() override;
    std::string inconsistency() const override;

private:
    struct Layer
    {
        std::string name;
        Kind kind;
        osg::ref_ptr<osg::Image> image;
    };
    double _originX = 0.0, _originY = 0.0, _longitude = 0.0, _latitude = 0.0;
    double _lowX = -1000.0, _lowY = -1000.0, _highX = 1000.0, _highY = 1000.0;
    std::vector<Layer> _layers;
};

} // namespace osgGeoFX
