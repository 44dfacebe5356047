// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// All that read rasters, alike: each makes a picture of the same raster.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/geodata/PictureRaster.h>
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/geodata/SurfaceRaster.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <osgGeoFX/terrain/ThinnedRaster.h>
#include <tools/GeofxPlugins.h>
#include <tools/TempDir.h>

#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace geofx::test::readers
{

using namespace osgGeoFX;
namespace fs = std::filesystem;

/// The raster that all of them read, in EPSG:32604.
constexpr int columns = 256, rows = 192;
constexpr double west = 600000.0, north = 2300000.0, pixel = 10.0;

/// What a reader makes of all of a raster: red, green, blue and alpha, or a value and alpha, by column and row from the north-west.
struct Picture
{
    using Texel = std::array<double, 4>;
    int width = 0, height = 0;
    std::function<Texel(int, int)> at;
    /// Of a value or class: alpha is 0 where it is missing.
    static Texel ofValue(double value) { return {value, 0.0, 0.0, std::isnan(value) ? 0.0 : 255.0}; }
};

inline Picture pictureOf(const osg::ref_ptr<osg::Image>& image)
{
    const bool colors = image->getPixelFormat() == GL_RGBA && image->getDataType() == GL_UNSIGNED_BYTE;
    return {image->s(), image->t(),
            [image, colors](int column, int row) -> Picture::Texel
            {
                const unsigned char* const texel = image->data(
                    static_cast<unsigned int>(column), static_cast<unsigned int>(image->t() - 1 - row));
                if (colors) return {texel[0] * 1.0, texel[1] * 1.0, texel[2] * 1.0, texel[3] * 1.0};
                return Picture::ofValue(static_cast<double>(*reinterpret_cast<const float*>(texel)));
            }};
}

inline MappingFrame frame()
{
    MappingFrame result;
    result.globe = false;
    result.wkt = wktOf(32604);
    result.origin = LocalOrigin::onPlane(osg::Vec2d(west, north));
    return result;
}

/// A reader of all of a raster, with so many texels along the longer side at most.
///
/// A picture of no size, with a sentence in `error`, if it cannot.
using Reader =
    std::function<Picture(const std::string& file, DataLayer::Kind kind, int side, std::string& error)>;

inline Picture mapping(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    const auto read = MappingRaster::read(file, frame(), {kind, side}, error);
    return read ? pictureOf(read->layer->getImage()) : Picture();
}

inline Picture tiled(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    const osg::ref_ptr<RasterTiles> tiles = TiledRaster::open(file, frame(), kind, error);
    if (!tiles) return Picture();
    const int width = std::min(side, columns);
    const osg::ref_ptr<osg::Image> image =
        tiles->read(tiles->low(), tiles->high(), width, width * rows / columns, error);
    return image ? pictureOf(image) : Picture();
}

inline Picture sequence(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    // Colors are the files of a folder, values the bands of a file.
    const bool colors = kind == DataLayer::COLOR;
    MappingFrame place = frame();
    SequenceRaster::Options options;
    options.maxSide = side;
    const auto read = SequenceRaster::open(colors ? fs::path(file).parent_path().string() : file, place,
                                           false, options, error);
    if (!read) return Picture();
    const osg::ref_ptr<osg::Image> image = read->steps->read(0, error);
    return image ? pictureOf(image) : Picture();
}

inline Picture picture(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    const auto read = PictureRaster::read(file, {kind, side}, error);
    return read ? pictureOf(read->image) : Picture();
}

/// A ground overlay of KML, so small that it stays as it is.
inline Picture overlay(const std::string& file, DataLayer::Kind, int side, std::string& error)
{
    constexpr double x = -158.0, y = 21.4, step = 1e-6;
    KmlOverlay place;
    place.image = file;
    place.corners = {osg::Vec2d(x, y), osg::Vec2d(x + step * columns, y),
                     osg::Vec2d(x + step * columns, y + step * rows), osg::Vec2d(x, y + step * rows)};
    MappingFrame there;
    there.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(x), osg::DegreesToRadians(y));
    OverlayRaster::Options options;
    options.maxSide = side;
    options.anyFormat = true;
    const auto read = OverlayRaster::read(place, there, options, error);
    return read ? pictureOf(read->layer->getImage()) : Picture();
}

inline Picture surface(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    data->setLocalOrigin(frame().origin);
    data->setRectangle(osg::Vec2d(0.0, -rows * pixel), osg::Vec2d(columns * pixel, 0.0));
    const SurfaceData::Kind layer = kind == DataLayer::COLOR   ? SurfaceData::COLOR
                                    : kind == DataLayer::CLASS ? SurfaceData::CLASS
                                                               : SurfaceData::HEIGHT;
    if (!SurfaceRaster::addLayer(*data, "layer", layer, file, frame(), error, side)) return Picture();
    const osg::ref_ptr<const osg::Image> image = data->getLayerImage(0);
    const bool colors = kind == DataLayer::COLOR;
    return {image->s(), image->t(),
            [image, colors](int column, int row) -> Picture::Texel
            {
                const auto* const texel = reinterpret_cast<const float*>(image->data(
                    static_cast<unsigned int>(column), static_cast<unsigned int>(image->t() - 1 - row)));
                const auto byte = [&](int channel)
                {
                    return std::round(255.0 * static_cast<double>(texel[channel]));
                };
                if (colors) return {byte(0), byte(1), byte(2), byte(3)};
                return {static_cast<double>(texel[0]), 0.0, 0.0, byte(3)};
            }};
}

inline Lattice lattice(int side)
{
    const int width = std::min(side, columns), height = width * rows / columns;
    const double step = pixel * columns / width;
    return {west + step / 2.0, north - pixel * rows + step / 2.0, step, step, width, height};
}

/// The builder's readers.
inline Picture built(const std::string& file, DataLayer::Kind kind, int side)
{
    const Lattice points = lattice(side);
    const GridCrs crs = GridCrs::projected(32604);
    const auto count = static_cast<std::size_t>(points.columns) * static_cast<std::size_t>(points.rows);
    const auto index = [points](int column, int row)
    {
        return static_cast<std::size_t>(points.rows - 1 - row) * static_cast<std::size_t>(points.columns) +
               static_cast<std::size_t>(column);
    };
    if (kind == DataLayer::VALUE)
    {
        std::vector<float> heights(count, std::numeric_limits<float>::quiet_NaN());
        RasterSource(file, RasterKind::Elevation).sampleHeights(crs, points, heights.data());
        return {points.columns, points.rows,
                [=](int column, int row)
                {
                    return Picture::ofValue(static_cast<double>(heights[index(column, row)]));
                }};
    }
    if (kind == DataLayer::CLASS)
    {
        std::vector<unsigned char> classes(count, 255);
        RasterSource(file, RasterKind::LandCover).sampleClasses(crs, points, classes.data());
        return {points.columns, points.rows,
                [=](int column, int row) -> Picture::Texel
                {
                    const unsigned char each = classes[index(column, row)];
                    return {each * 1.0, 0.0, 0.0, each == 255 ? 0.0 : 255.0};
                }};
    }
    std::vector<unsigned char> planes(4 * count, 0);
    RasterSource(file, RasterKind::Imagery).sampleColors(crs, points, planes.data());
    return {points.columns, points.rows,
            [=](int column, int row) -> Picture::Texel
            {
                const std::size_t i = index(column, row);
                return {planes[i] * 1.0, planes[count + i] * 1.0, planes[2 * count + i] * 1.0,
                        planes[3 * count + i] * 1.0};
            }};
}

/// Runs what throws BuildError.
template<typename Work>
Picture caught(const Work& work, std::string& error)
{
    try
    {
        return work();
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return {};
    }
}

inline Picture builder(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    return caught([&] { return built(file, kind, side); }, error);
}

/// The classes in colors, as the builder paints land cover: class c has the color {10 c, 10 c, 10 c}.
inline Picture colorized(const std::string& file, DataLayer::Kind, int side, std::string& error)
{
    std::array<std::array<unsigned char, 4>, 256> colors{};
    for (unsigned int i = 0; i < 8; ++i)
        colors[i].fill(static_cast<unsigned char>(10 * i));
    for (auto& color : colors)
        color[3] = 255;
    const Lattice points = lattice(side);
    const auto count = static_cast<std::size_t>(points.columns) * static_cast<std::size_t>(points.rows);
    std::vector<unsigned char> planes(4 * count, 0);
    const auto read = [&]() -> Picture
    {
        RasterSource source(file, RasterKind::LandCover);
        source.colorize(colors);
        source.sampleColors(GridCrs::projected(32604), points, planes.data());
        return {points.columns, points.rows,
                [=](int column, int row) -> Picture::Texel
                {
                    const std::size_t i = static_cast<std::size_t>(points.rows - 1 - row) *
                                              static_cast<std::size_t>(points.columns) +
                                          static_cast<std::size_t>(column);
                    return {planes[i] / 10.0, 0.0, 0.0, planes[3 * count + i] * 1.0};
                }};
    };
    return caught(read, error);
}

/// The coarser copy that a panorama is made of, and the builder's reading of it.
inline Picture thinned(const std::string& file, DataLayer::Kind kind, int side, std::string& error)
{
    const TempDir folder;
    const std::string copy = (folder / "thinned.tif").string();
    const auto read = [&]
    {
        ThinnedRaster::write(file, ThinnedRaster::cut(file, {}, std::max(1, columns / side)), copy);
        return built(copy, kind, side);
    };
    return caught(read, error);
}

} // namespace geofx::test::readers
