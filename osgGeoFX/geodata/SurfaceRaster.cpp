// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/SurfaceRaster.h>

#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <osgGeoFX/closeup/SurfaceDerivation.h>
#include <osgGeoFX/geodata/BuildError.h>

#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace osgGeoFX
{

namespace
{

constexpr int mostTexels = 16384;

/// A rectangle of the frame, metres, in so many texels.
struct Grid
{
    osg::Vec2d low, high;
    int width = 0, height = 0;

    osg::Vec2d size() const { return high - low; }
};

[[noreturn]] void fail(const std::string& file, const std::string& what)
{
    throw BuildError(file + ": " + what + ".");
}

void checkSide(const std::string& file, int maxSide)
{
    if (maxSide < 1 || maxSide > mostTexels)
        fail(file, "a layer cannot have " + std::to_string(maxSide) + " texels on a side; give 1 to " +
                       std::to_string(mostTexels));
}

void checkName(const SurfaceData& data, const std::string& name, const std::string& file)
{
    if (name.empty()) fail(file, "its layer has no name; give it one");
    if (data.findLayer(name) >= 0)
        fail(file, "there is a layer \"" + name + "\" already; give it another name or remove that one");
}

MappingFrame frameOf(const SurfaceData& data, const MappingFrame& frame)
{
    MappingFrame result = frame;
    result.origin = data.getLocalOrigin();
    return result;
}

/// Of the data's layers; where it has none, with texels of a size, metres, and not too many.
Grid gridOf(const SurfaceData& data, double texel, int maxSide)
{
    Grid grid{data.getLow(), data.getHigh(), data.getWidth(), data.getHeight()};
    if (grid.width > 0) return grid;
    const osg::Vec2d size = grid.size();
    texel = std::max(texel, std::max(size.x(), size.y()) / maxSide);
    grid.width = std::clamp(static_cast<int>(std::lround(size.x() / texel)), 1, maxSide);
    grid.height = std::clamp(static_cast<int>(std::lround(size.y() / texel)), 1, maxSide);
    return grid;
}

float* texelOf(osg::Image& image, int column, int row)
{
    return reinterpret_cast<float*>(
        image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row)));
}

void checkAny(const osg::Image& image, const std::string& file)
{
    const auto* texels = reinterpret_cast<const float*>(image.data());
    const std::size_t count = static_cast<std::size_t>(image.s()) * static_cast<std::size_t>(image.t());
    for (std::size_t i = 0; i < count; ++i)
        if (texels[4 * i + 3] > 0.0f) return;
    fail(file, "it has nothing in the rectangle of the surface data; move the rectangle, or check the file's "
               "coordinate system with gdalinfo or ogrinfo");
}

/// What the raster has in a grid.
osg::ref_ptr<osg::Image> imageOf(const FrameRaster& raster, const FrameCrs& crs, const Grid& grid,
                                 const std::string& file)
{
    const DatasetPtr warped =
        raster.warped(crs, crs.fromFrame(grid.low), crs.fromFrame(grid.high), grid.width, grid.height);
    osg::ref_ptr<osg::Image> image;
    if (raster.kind == DataLayer::COLOR)
    {
        osg::ref_ptr<osg::Image> colors = new osg::Image;
        colors->allocateImage(grid.width, grid.height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        raster.readColors(*warped, colors->data());
        image = SurfaceData::toLayer(*colors);
    }
    else
    {
        image = SurfaceDerivation::emptyLayer(grid.width, grid.height);
        std::vector<double> values;
        for (int row = 0; row < grid.height; ++row)
        {
            raster.readValues(*warped, row, values);
            float* out = texelOf(*image, 0, grid.height - 1 - row);
            for (const double value : values)
            {
                if (!std::isnan(value))
                {
                    out[0] = static_cast<float>(value);
                    out[3] = 1.0f;
                }
                out += 4;
            }
        }
    }
    image->setFileName(file);
    return image;
}

DataLayer::Kind rasterKindOf(SurfaceData::Kind kind, const std::string& file)
{
    switch (kind)
    {
    case SurfaceData::COLOR:
        return DataLayer::COLOR;
    case SurfaceData::CLASS:
        return DataLayer::CLASS;
    case SurfaceData::NORMAL:
    case SurfaceData::ASPECT:
        fail(file, "normals and aspect do not come from files; derive them from heights");
    default:
        return DataLayer::VALUE;
    }
}

void addRaster(SurfaceData& data, const std::string& name, SurfaceData::Kind kind, const std::string& file,
               const MappingFrame& frame, int maxSide)
{
    checkSide(file, maxSide);
    checkName(data, name, file);
    const FrameCrs crs = crsOf(frameOf(data, frame), file);
    const FrameRaster raster(file, rasterKindOf(kind, file));
    // The resolution is asked for only where it counts: not every raster has one about every origin.
    const double texel = data.getNumLayers() > 0 ? 0.0 : raster.extent(crs).texel * crs.metresPerUnit;
    const osg::ref_ptr<osg::Image> image = imageOf(raster, crs, gridOf(data, texel, maxSide), file);
    checkAny(*image, file);
    data.addLayer(name, kind, image);
}

osg::ref_ptr<osg::Image> cropped(const osg::Image& image, int left, int below, int width, int height)
{
    osg::ref_ptr<osg::Image> result = SurfaceDerivation::emptyLayer(width, height);
    for (int row = 0; row < height; ++row)
    {
        const auto* from = reinterpret_cast<const float*>(
            image.data(static_cast<unsigned int>(left), static_cast<unsigned int>(below + row)));
        std::copy_n(from, 4 * static_cast<std::size_t>(width), texelOf(*result, 0, row));
    }
    return result;
}

osg::ref_ptr<SurfaceData> readDem(const std::string& file, const MappingFrame& frame,
                                  const SurfaceRaster::Options& options)
{
    checkSide(file, options.maxSide);
    if (!(options.radius >= 0.0)) fail(file, "the radius is not a length; give 0 metres or more");
    const bool whole = options.low == options.high;
    const FrameCrs crs = crsOf(frame, file);
    const FrameRaster raster(file, DataLayer::VALUE);
    const FrameRaster::Extent extent = raster.extent(crs);
    const double unit = crs.metresPerUnit;
    const osg::Vec2d low = whole ? extent.low * unit - crs.origin : options.low;
    const osg::Vec2d high = whole ? extent.high * unit - crs.origin : options.high;

    osg::ref_ptr<SurfaceData> data = new SurfaceData;
    const bool placed = data->setLocalOrigin(frame.origin) && low.x() < high.x() && low.y() < high.y() &&
                        data->setRectangle(low, high);
    if (!placed) fail(file, "the rectangle or its origin is none; give metres, the lower corner first");

    // With a margin as wide as what hides the sky, up to half the rectangle; beyond the whole raster there is nothing.
    const Grid inner = gridOf(*data, extent.texel * unit, options.maxSide);
    const osg::Vec2d texel(inner.size().x() / inner.width, inner.size().y() / inner.height);
    const auto marginOf = [&](double step, int texels)
    {
        return whole ? 0 : 1 + static_cast<int>(std::min(texels / 2.0, std::ceil(options.radius / step)));
    };
    const int besides = marginOf(texel.x(), inner.width);
    const int above = marginOf(texel.y(), inner.height);
    const osg::Vec2d margin(besides * texel.x(), above * texel.y());
    const Grid outer{low - margin, high + margin, inner.width + 2 * besides, inner.height + 2 * above};
    const osg::ref_ptr<osg::Image> heights = imageOf(raster, crs, outer, file);

    const auto add = [&](const char* name, SurfaceData::Kind kind, const osg::Image& image)
    {
        data->addLayer(name, kind, cropped(image, besides, above, inner.width, inner.height));
    };
    add("height", SurfaceData::HEIGHT, *heights);
    checkAny(*data->getLayerImage(0), file);
    // Derived with the margin in place, which addLayer()'s limit is not for.
    const SurfaceDerivation derivation(*heights, texel);
    add("normal", SurfaceData::NORMAL, *derivation.normals());
    add("slope", SurfaceData::SLOPE, *derivation.slopes());
    add("aspect", SurfaceData::ASPECT, *derivation.aspects());
    add("occlusion", SurfaceData::OCCLUSION, *derivation.occlusion(options.radius));
    return data;
}

/// Draws lines into a layer of colors, metres in the frame.
class Pen
{
public:
    Pen(const Grid& grid, double width, const osg::Vec4f& color)
        : _grid(grid), _texel(grid.size().x() / grid.width, grid.size().y() / grid.height),
          _side(std::sqrt(_texel.x() * _texel.y())), _half(width / 2.0), _alpha(color.a()),
          image(SurfaceDerivation::emptyLayer(grid.width, grid.height))
    {
        // The color is everywhere, so that it stays when alpha is interpolated.
        for (int row = 0; row < grid.height; ++row)
            for (int column = 0; column < grid.width; ++column)
                std::copy_n(color.ptr(), 3, texelOf(*image, column, row));
    }

    /// A disc where both are one place.
    void line(osg::Vec2d from, osg::Vec2d to)
    {
        const double reach = _half + _side;
        if (!clip(from, to, reach)) return;
        // In pieces, so that few texels are asked that are far from a slanting line.
        const osg::Vec2d way = to - from;
        const int pieces = 1 + static_cast<int>(way.length() / (reach + 8.0 * _side));
        for (int i = 0; i < pieces; ++i)
            piece(from + way * (static_cast<double>(i) / pieces), way / pieces, reach);
    }

private:
    /// Cuts a line to the grid and what reaches into it. False where nothing is left.
    bool clip(osg::Vec2d& from, osg::Vec2d& to, double reach) const
    {
        double begin = 0.0, end = 1.0;
        const osg::Vec2d way = to - from;
        for (const int axis : {0, 1})
        {
            const double low = _grid.low[axis] - reach - from[axis];
            const double high = _grid.high[axis] + reach - from[axis];
            if (way[axis] == 0.0)
            {
                if (low > 0.0 || high < 0.0) return false;
                continue;
            }
            begin = std::max(begin, std::min(low / way[axis], high / way[axis]));
            end = std::min(end, std::max(low / way[axis], high / way[axis]));
        }
        if (!(begin <= end)) return false;
        to = from + way * end;
        from += way * begin;
        return true;
    }

    void piece(const osg::Vec2d& from, const osg::Vec2d& way, double reach)
    {
        const auto range = [&](int axis, int count)
        {
            const double a = from[axis] - _grid.low[axis];
            const double b = a + way[axis];
            const double first = std::floor((std::min(a, b) - reach) / _texel[axis]);
            const double last = std::floor((std::max(a, b) + reach) / _texel[axis]);
            return std::array<int, 2>{static_cast<int>(std::max(0.0, first)),
                                      static_cast<int>(std::min(count - 1.0, last))};
        };
        const auto [left, right] = range(0, _grid.width);
        const auto [bottom, top] = range(1, _grid.height);
        for (int row = bottom; row <= top; ++row)
            for (int column = left; column <= right; ++column)
            {
                const osg::Vec2d off((column + 0.5) * _texel.x() + _grid.low.x() - from.x(),
                                     (row + 0.5) * _texel.y() + _grid.low.y() - from.y());
                const double length = way.length2();
                const double along = length > 0.0 ? std::clamp(off * way / length, 0.0, 1.0) : 0.0;
                const double distance = (off - way * along).length();
                // The part of a texel's width that the line covers.
                const double covered =
                    std::min(_half, distance + _side / 2.0) - std::max(-_half, distance - _side / 2.0);
                float& alpha = texelOf(*image, column, row)[3];
                alpha = std::max(alpha, _alpha * static_cast<float>(std::max(0.0, covered / _side)));
            }
    }

    Grid _grid;
    osg::Vec2d _texel; ///< metres
    double _side, _half;
    float _alpha;

public:
    const osg::ref_ptr<osg::Image> image;
};

void drawPoints(const OGRSimpleCurve& curve, OGRCoordinateTransformation& toFrame, const FrameCrs& crs,
                Pen& pen)
{
    const auto count = static_cast<std::size_t>(curve.getNumPoints());
    std::vector<double> x(count), y(count);
    std::vector<int> found(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        x[i] = curve.getX(static_cast<int>(i));
        y[i] = curve.getY(static_cast<int>(i));
    }
    // Those on the other side of the globe fail, one by one.
    const GdalErrorScope errors;
    toFrame.Transform(count, x.data(), y.data(), nullptr, nullptr, found.data());
    const auto place = [&](std::size_t i)
    {
        return osg::Vec2d(x[i], y[i]) * crs.metresPerUnit - crs.origin;
    };
    const auto has = [&](std::size_t i)
    {
        return found[i] && std::isfinite(x[i]) && std::isfinite(y[i]);
    };
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t next = std::min(i + 1, count - 1);
        if (has(i) && has(next) && (next > i || count == 1)) pen.line(place(i), place(next));
    }
}

void draw(const OGRGeometry& geometry, OGRCoordinateTransformation& toFrame, const FrameCrs& crs, Pen& pen)
{
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (type == wkbPoint && !geometry.IsEmpty())
    {
        OGRLineString place;
        place.addPoint(geometry.toPoint());
        drawPoints(place, toFrame, crs, pen);
    }
    else if (type == wkbLineString)
        drawPoints(*geometry.toLineString(), toFrame, crs, pen);
    else if (type == wkbPolygon)
        for (const OGRLinearRing* ring : *geometry.toPolygon())
            drawPoints(*ring, toFrame, crs, pen);
    else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        for (const OGRGeometry* part : *geometry.toGeometryCollection())
            draw(*part, toFrame, crs, pen);
}

void addLines(SurfaceData& data, const std::string& name, const std::string& file, double width,
              const osg::Vec4f& color, const MappingFrame& frame, int maxSide)
{
    checkSide(file, maxSide);
    checkName(data, name, file);
    if (!(width > 0.0 && width <= 1e6)) fail(file, "its lines need a width; give metres, up to 1000000");
    for (const float channel : {color.r(), color.g(), color.b(), color.a()})
        if (!(channel >= 0.0f && channel <= 1.0f)) fail(file, "its color is none; give numbers of 0 to 1");
    const FrameCrs crs = crsOf(frameOf(data, frame), file);
    const DatasetPtr dataset = openVectors(file);
    OGRSpatialReference target;
    target.SetFromUserInput(crs.definition.c_str());
    Pen pen(gridOf(data, 0.0, maxSide), width, color);
    forEachLayer(*dataset, {}, file,
                 [&](OGRLayer& layer)
                 {
                     forEachFeature(layer, target, file,
                                    [&](const OGRFeature&, const OGRGeometry& geometry,
                                        OGRCoordinateTransformation& toFrame)
                                    { draw(geometry, toFrame, crs, pen); });
                 });
    checkAny(*pen.image, file);
    pen.image->setFileName(file);
    data.addLayer(name, SurfaceData::COLOR, pen.image);
}

/// Runs what throws BuildError. False, with its sentence, where it does.
template<typename Work>
bool succeeds(const Work& work, std::string& error)
{
    initialiseGdal();
    try
    {
        work();
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace

bool SurfaceRaster::addLayer(SurfaceData& data, const std::string& name, SurfaceData::Kind kind,
                             const std::string& file, const MappingFrame& frame, std::string& error,
                             int maxSide)
{
    return succeeds([&] { addRaster(data, name, kind, file, frame, maxSide); }, error);
}

osg::ref_ptr<SurfaceData> SurfaceRaster::fromDem(const std::string& file, const MappingFrame& frame,
                                                 const Options& options, std::string& error)
{
    osg::ref_ptr<SurfaceData> data;
    succeeds([&] { data = readDem(file, frame, options); }, error);
    return data;
}

bool SurfaceRaster::addVectors(SurfaceData& data, const std::string& name, const std::string& file,
                               double width, const osg::Vec4f& color, const MappingFrame& frame,
                               std::string& error, int maxSide)
{
    return succeeds([&] { addLines(data, name, file, width, color, frame, maxSide); }, error);
}

} // namespace osgGeoFX
