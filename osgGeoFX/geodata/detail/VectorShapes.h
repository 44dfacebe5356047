// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/detail/FeatureStyle.h>

#include <osg/Vec2d>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A line, or an area's rings.
struct VectorShape
{
    bool area = false;
    std::vector<std::vector<osg::Vec2d>> parts;
};

/// A rectangle in degrees; longitudes may go on beyond ±180.
struct DegreeBox
{
    double west = -180.0, south = -90.0, east = 180.0, north = 90.0;
};

/** The features of vector data as they are drawn: shapes, how they look, and their order. Places are degrees, of shapes with so many vertices that
    they may be brought into any frame one by one. A plain value. */
struct VectorShapes
{
    struct Item
    {
        std::uint32_t shape = 0, paint = 0;
    };
    struct Symbol
    {
        osg::Vec2d place;
        std::optional<double> height; ///< metres
        std::uint32_t paint = 0;
        std::string name;
    };

    std::string file;
    std::vector<VectorShape> shapes;
    std::vector<ShapePaint> paints;
    std::vector<Item> items; ///< the lowest first
    std::vector<Symbol> symbols;
    std::vector<SymbolPaint> symbolPaints;
    std::vector<std::string> notices;
    // Of a circle on the globe that has all of it in it.
    osg::Vec2d middle;   ///< degrees
    double radius = 0.0; ///< radians of arc

    struct Options
    {
        std::string layer; ///< empty: all
        std::string style; ///< an SLD file; empty: the one beside the file, or the features' own
        bool allowOutside = false;
    };
    /// Throws BuildError, naming file and remedy.
    static VectorShapes read(const std::string& file, const Options& options);
    /// Whether GDAL opens it as vector data, and as no raster.
    static bool isVectors(const std::string& file);

    /** The shapes in the coordinates of a frame, metres; what has no place there is cut off. `box`: what lies outside of it is cut off
        before. The shapes have the indices that they have here; one that is cut off has no parts. */
    std::vector<VectorShape> placedIn(const MappingFrame& frame, const std::optional<DegreeBox>& box) const;
    /// The part of the Earth that a projected frame has a place for, with some margin; all of it where nobody knows.
    static std::optional<DegreeBox> reachOf(const MappingFrame& frame);
};

} // namespace osgGeoFX
