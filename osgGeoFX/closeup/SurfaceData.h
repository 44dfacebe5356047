// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/LocalOrigin.h>
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

/** Several images of one part of the ground, with one size and one place: the layers of one texture array (paper:
    interactive close-ups, Section IV.B.2, "surface data"). A close-up names the layer that it shows.

    **Frame.** It is the frame of ProjectiveMappings. On a projected terrain its coordinates are positions minus the
    origin. On a globe x points east and y north about the origin, of a point's foot on the ellipsoid (PROJ's
    `+proj=ortho` there). The images cover the rectangle from `low` to `high`, metres. Row 0 is the southernmost.

    **Layers.** A texel has four floats. Colors are 0…1 with alpha. For values the first float is the value, and the
    fourth is 1 where there is a value. For NORMAL the first three are the unit normal: x east, y north, z up. For
    ASPECT the second and third are the sine and cosine of the angle, which may be interpolated although angles may
    not. Texels without data are 0 in all four floats (only colors may have rgb under an alpha of 0). A reader divides
    values and normals that it interpolated between texels by the fourth float. Classes are never interpolated.

    The thread of the frame loop changes the data, between frames. Reading is thread-safe.
    @ingroup closeup */
class OSGGEOFX_EXPORT SurfaceData : public PropertyHolder
{
public:
    SurfaceData() = default;
    SurfaceData(const SurfaceData& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, SurfaceData);

    enum Kind
    {
        COLOR,     ///< colors with alpha
        HEIGHT,    ///< heights, metres
        NORMAL,    ///< unit normals
        SLOPE,     ///< 0…π/2, radians from the horizontal
        ASPECT,    ///< downhill direction, 0…2π, radians clockwise from north; no data on level ground
        OCCLUSION, ///< 0…1, the visible share of the sky
        CLASS,     ///< numbers that stand for something, such as land cover
        VALUE      ///< any other numbers
    };

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
    /// The rectangle that the images cover, metres in the frame. `low` must be less than `high` in x and in y.
    /// Default: ±1000.
    bool setRectangle(const osg::Vec2d& low, const osg::Vec2d& high);
    osg::Vec2d getLow() const { return {_lowX, _lowY}; }
    osg::Vec2d getHigh() const { return {_highX, _highY}; }

    /// Adds a layer. It is refused with false and a warning if the image is null, if the name is empty or in use, if
    /// the size differs from the first layer's or exceeds 16384 texels on a side, if the format is not GL_RGBA and
    /// GL_FLOAT, or if the rows have gaps or run from the top.
    bool addLayer(const std::string& name, Kind kind, osg::Image* image);
    /// Adds a layer that is derived from the first HEIGHT layer; see derive(). It is refused if there is no such
    /// layer.
    bool addDerived(const std::string& name, Kind kind, double radius = 2000.0);
    /// Returns false if no layer has this name.
    bool removeLayer(const std::string& name);
    int getNumLayers() const { return static_cast<int>(_layers.size()); }
    const std::string& getLayerName(int layer) const { return _layers[static_cast<std::size_t>(layer)].name; }
    Kind getLayerKind(int layer) const { return _layers[static_cast<std::size_t>(layer)].kind; }
    const osg::Image* getLayerImage(int layer) const
    {
        return _layers[static_cast<std::size_t>(layer)].image;
    }
    /// The index of the layer, or −1 if no layer has this name.
    int findLayer(const std::string& name) const;
    /// The number of texels along x and y. Both are 0 without layers.
    int getWidth() const { return _layers.empty() ? 0 : _layers.front().image->s(); }
    int getHeight() const { return _layers.empty() ? 0 : _layers.front().image->t(); }
    /// The distance from texel to texel along x and y, metres. 0 without layers.
    osg::Vec2d getSpacing() const;

    /** Makes a layer of colors from an image of GL_RGB, RGBA, BGR, BGRA, LUMINANCE, LUMINANCE_ALPHA, INTENSITY, ALPHA
        (white), RED or RG, with bytes, shorts, ints (signed or not) or floats. Values beyond 0…1 are clamped. Row 0 is
        the lowest, also for an image whose origin is TOP_LEFT. If a size is given, the image is resampled, weighted
        with alpha: averaged where it shrinks, linear where it grows. Any other image or size gives null, with a
        warning. */
    static osg::ref_ptr<osg::Image> toLayer(const osg::Image& image, int width = 0, int height = 0);

    /** Derives NORMAL, SLOPE, ASPECT or OCCLUSION from a HEIGHT layer whose texels are `spacing` apart, metres. Slopes
        are central differences (Horn's weights). Texels beside holes and at the borders use the heights that exist.
        OCCLUSION is the share of the sky above the horizon in 16 directions, weighted by the cosine to the vertical,
        for obstacles within `radius` metres, accurate to a texel. Holes and the area beyond the borders hide nothing.
        The result is null, with a warning, for another kind, for an image that is no layer, and if a spacing is not
        positive or the radius negative. OCCLUSION takes a second or two for a million texels, whatever the radius.
        Thread-safe. */
    static osg::ref_ptr<osg::Image> derive(Kind kind, const osg::Image& heights, const osg::Vec2d& spacing,
                                           double radius = 2000.0);

    /// The matrix from the frame to world coordinates. `ellipsoid` is null on a projected terrain.
    osg::Matrixd frameToWorld(const osg::EllipsoidModel* ellipsoid) const
    {
        return _origin.toWorld(ellipsoid);
    }

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
    LocalOrigin _origin;
    double _lowX = -1000.0, _lowY = -1000.0, _highX = 1000.0, _highY = 1000.0;
    std::vector<Layer> _layers;
};

} // namespace osgGeoFX
