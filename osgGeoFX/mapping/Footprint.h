// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Vec2d>

#include <array>

namespace osgGeoFX
{

/// A square of the plane, from `origin` on towards larger x and y; metres.
struct PlaneSquare
{
    osg::Vec2d origin;
    double size = 0.0;

    /// One of its 8 x 8 cells, counted along x first.
    PlaneSquare cell(unsigned int index) const
    {
        const double side = size / 8;
        const unsigned int row = index / 8;
        return {origin + osg::Vec2d(side * (index % 8), side * row), side};
    }
};

/// Where a mapping lies on the plane: the four corners of a convex quadrilateral, one after the other in either
/// direction; metres.
struct OSGGEOFX_EXPORT PlaneFootprint
{
    std::array<osg::Vec2d, 4> corners;

    /// A rectangle along the axes, for instance around something round.
    static PlaneFootprint box(const osg::Vec2d& low, const osg::Vec2d& high);

    /// Half the sum of the corners' cross products, so it has the sign of their direction.
    double signedArea() const;
    /// Whether it is finite, within 10^15 m, convex, and has an area.
    bool valid() const;
};

/// A valid footprint made ready to be compared with many squares.
class OSGGEOFX_EXPORT FootprintShape
{
public:
    explicit FootprintShape(const PlaneFootprint& footprint);

    const osg::Vec2d& low() const { return _low; }
    const osg::Vec2d& high() const { return _high; }
    /// The side of a square with the same area.
    double width() const { return _width; }

    /// False only when it stays away from a square by more than the margin.
    bool overlaps(const PlaneSquare& square, double margin) const;
    /// True only when the square is inside by the margin or more.
    bool covers(const PlaneSquare& square, double margin) const;

private:
    /// The half-plane that the footprint is in: normal * place <= limit.
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
