// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/UndeclaredVoids.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The CRS of a database's grid: WGS 84 longitude and latitude in degrees, or a projected CRS in its own unit.
    Longitudes of a grid may run beyond ±180° where it crosses the antimeridian. */
struct GridCrs
{
    OGRSpatialReference srs;
    bool geographic = true;
    double metresPerUnit = 1.0; ///< of a projected CRS

    static GridCrs geocentric();
    static GridCrs projected(int epsg); ///< throws BuildError
};

/// Regular grid of points in the grid's CRS; row 0 is the southernmost.
struct Lattice
{
    double x0 = 0.0, y0 = 0.0; ///< the south-western point
    double dx = 0.0, dy = 0.0; ///< spacing
    int columns = 0, rows = 0; ///< points
};

/// What a raster covers, from center to center of its outermost pixels, in the grid's CRS.
struct Footprint
{
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
    double stepX = 0.0, stepY = 0.0; ///< the widest spacing that loses none of the raster's resolution
    bool wholeCircle = false;        ///< all longitudes
};

enum class RasterKind
{
    Elevation, ///< one band of metres
    Imagery,   ///< red, green, blue and alpha, bytes
    LandCover, ///< one band of class values, bytes
    TreeCover  ///< one band of percent
};

/** One raster file, sampled on lattices.

    Any raster that GDAL opens: any CRS, rotated geotransform or ground control points, no-data, masks,
    palettes, scale and offset, feet. Not thread-safe: one object for each thread. All methods throw BuildError. */
class RasterSource
{
public:
    /// `bands`: what imagery shows. `undeclared`: heights of an elevation that are none.
    RasterSource(const std::string& file, RasterKind kind, const RasterBands& bands = {},
                 const UndeclaredVoids& undeclared = {});
    RasterSource(RasterSource&&) = default;
    ~RasterSource();

    Footprint footprint(const GridCrs& crs) const;

    /// Bilinear heights, metres. Points without data are left as they are. `out` has columns × rows values.
    void sampleHeights(const GridCrs& crs, const Lattice& lattice, float* out);

    /// Sets `covered` to 1 at points that lie within the raster's rectangle of pixels, whether these have data or not, and
    /// leaves it elsewhere. Points that are 1 already cost nothing.
    void markCovered(const GridCrs& crs, const Lattice& lattice, unsigned char* covered);

    /// Colors, four planes (red, green, blue, alpha) of columns × rows bytes, averaged where the lattice is
    /// coarser than the raster. Points without data keep their alpha and color.
    void sampleColors(const GridCrs& crs, const Lattice& lattice, unsigned char* planes);

    /// Values, averaged where the lattice is coarser than the raster. Points without data are left as they are.
    void sampleMeans(const GridCrs& crs, const Lattice& lattice, float* out);

    /// Nearest class values. Points without data keep their value.
    void sampleClasses(const GridCrs& crs, const Lattice& lattice, unsigned char* out);

    /// For a LandCover source: draws it in colors from now on (as Imagery), 256 × RGBA by class value.
    void colorize(const std::array<std::array<unsigned char, 4>, 256>& colors);

    const std::string& file() const { return _file; }
    /// Metres in the unit of the file's heights.
    double metresPerHeight() const { return _metresPerHeight; }
    /// What imagery shows, with all that the file and its numbers have decided.
    const RasterBands& bands() const { return _bands; }

private:
    /// Widens the footprint of a raster around a pole, or all around the globe, to every longitude.
    void takePoles(const GridCrs& crs, Footprint& result) const;
    struct WarpRequest;
    void openAs(RasterKind kind, const UndeclaredVoids& undeclared);
    /// By ground control points, or by arrays of places.
    void warpByPlaces(RasterKind kind);
    void translate(const std::vector<std::string>& arguments);
    void warp(const GridCrs& crs, const Lattice& lattice, const WarpRequest& request);
    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void failToUse(const GdalErrorScope& errors) const;

    std::string _file;
    RasterBands _bands;
    OGRSpatialReference _srs;
    std::array<double, 6> _geoTransform{};
    double _metresPerHeight = 1.0;
    bool _colorized = false;
    DatasetChain _chain; ///< the file, then the virtual datasets on top of it; the last is read
};

} // namespace osgGeoFX
