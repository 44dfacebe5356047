// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Vec2d>

#include <array>

namespace osgGeoFX
{

/// An axis-aligned square of the plane, metres. `origin` is its corner of smallest x and y.
struct PlaneSquare
{
    osg::Vec2d origin;
    double size = 0.0;

    /// One of its 8 x 8 cells. The index counts along x first.
    PlaneSquare cell(unsigned int index) const
    {
        const double side = size / 8;
        const unsigned int row = index / 8;
        return {origin + osg::Vec2d(side * (index % 8), side * row), side};
    }
};

/// The outline of a mapping on the plane, metres: the four corners of a convex quadrilateral, in either direction of
/// rotation.
/// @ingroup mapping
struct OSGGEOFX_EXPORT PlaneFootprint
{
    std::array<osg::Vec2d, 4> corners;

    /// An axis-aligned rectangle, for instance the bounding box of a round shape.
    static PlaneFootprint box(const osg::Vec2d& low, const osg::Vec2d& high);

    /// The area, metres². It is positive if the corners run counter-clockwise.
    double signedArea() const;
    /// Whether the quadrilateral is convex, has an area, and lies within 10^15 m of the origin along both axes.
    bool valid() const;
};

/// A valid footprint that is prepared for comparison with many squares.
/// @ingroup mapping
class OSGGEOFX_EXPORT FootprintShape
{
public:
    explicit FootprintShape(const PlaneFootprint& footprint);

    const osg::Vec2d& low() const { return _low; }
    const osg::Vec2d& high() const { return _high; }
    /// The side of a square with the same area, metres.
    double width() const { return _width; }

    /// False only if the footprint is farther from the square than the margin. It may be true for other squares, too.
    bool overlaps(const PlaneSquare& square, double margin) const;
    /// True only if the square lies inside the footprint, at least the margin away from its border.
    bool covers(const PlaneSquare& square, double margin) const;

private:
    /// The half-plane normal * place <= limit, which contains the footprint.
    struct Edge
    {
        osg::Vec2d normal; ///< of length 1, outwards
        double limit = 0.0;
        double reach = 0.0; ///< how far a square of half-size 1 reaches along the normal
    };

    std::array<Edge, 4> _edges;
    unsigned int _edgeCount = 0; ///< none for a box
    osg::Vec2d _low;
    osg::Vec2d _high;
    double _width = 0.0;
};

} // namespace osgGeoFX
