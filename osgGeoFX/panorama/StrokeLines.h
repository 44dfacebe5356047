// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Object>
#include <osg/Vec2d>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/** Roads, rivers and towns from vector data for the brush strokes of a panorama map. Brown and Samavati (2017) name
    them as future work.

    A line is painted as a row of strokes at marks. A line has a mark at each multiple of a step from its first point,
    and one at its end. The marks depend on the line alone, so all tiles have the same marks. Each mark has a level,
    the power of two in its multiple. Coarser tiles and smaller pictures use only the higher levels.

    Fill the object once, before a map or another thread has it. All other methods are thread-safe.
    @ingroup panorama */
class OSGGEOFX_EXPORT StrokeLines : public osg::Object
{
public:
    enum Kind
    {
        ROAD,
        RIVER,
        TOWN ///< an area with houses
    };
    enum Units
    {
        DEGREES, ///< longitude and latitude, for globes
        METRES   ///< x and y of the world, for projected terrain
    };
    struct Line
    {
        Kind kind = ROAD;
        /// At least two points. A town starts with its outer ring; holes follow. Each ring is closed and followed by
        /// the town's first point.
        std::vector<osg::Vec2d> points;
    };
    /// The place of one stroke.
    struct Mark
    {
        osg::Vec2d place;       ///< in the units of the lines
        osg::Vec2d along;       ///< the line's direction there, of any length, in the same units
        std::int64_t index = 0; ///< the multiple of the step; −1 at the line's end
        int level = 0;          ///< the power of two in the multiple, 0 or more
        std::uint32_t line = 0; ///< the line's index in getLines()
    };

    StrokeLines() = default;
    StrokeLines(const StrokeLines& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, StrokeLines);

    /// Replaces the lines. Returns false, and changes nothing, if a line has fewer than two points, a point is not
    /// finite, or a latitude lies beyond ±90.
    bool set(Units units, std::vector<Line> lines);
    Units getUnits() const { return _units; }
    /// The lines as given, except that longitudes of consecutive points differ by at most 180°.
    const std::vector<Line>& getLines() const { return _lines; }

    /// The marks of roads and rivers in a box of the map, of a level and above. The same box gives the same order.
    /// `step` is in metres, > 0.
    std::vector<Mark> marks(const osg::Vec2d& low, const osg::Vec2d& high, double step, int level) const;

    /// Tells which places of a box lie in a town. The lines must outlive this object.
    class OSGGEOFX_EXPORT Towns
    {
    public:
        Towns(const StrokeLines& lines, const osg::Vec2d& low, const osg::Vec2d& high);
        bool empty() const { return _rows.empty(); }
        /// Only for places in the box; elsewhere the result is undefined.
        bool contain(const osg::Vec2d& place) const;

    private:
        struct Edge
        {
            std::uint32_t town;
            osg::Vec2d from, to;
        };
        std::size_t rowOf(double y) const;

        double _south = 0.0, _rowHeight = 1.0;
        std::vector<std::vector<Edge>>
            _rows; ///< each edge in all rows that it touches; those of a town together
    };

protected:
    ~StrokeLines() override = default;

private:
    struct Segment
    {
        std::uint32_t line, first; ///< point of the line
    };
    struct Cells
    {
        int left, right, below, above;
    };
    double metres(const osg::Vec2d& from, const osg::Vec2d& to) const;
    void index();
    Cells cells(const osg::Vec2d& low, const osg::Vec2d& high) const;

    Units _units = DEGREES;
    std::vector<Line> _lines;
    std::vector<std::vector<double>> _lengths; ///< from the first point of each line to each, metres
    std::vector<osg::Vec2d> _lows, _highs;     ///< of each line
    osg::Vec2d _low, _cell;                    ///< of the grid
    int _side = 0;                             ///< cells of the grid along each side
    std::vector<std::uint32_t> _firsts;        ///< of each cell, in _segments
    std::vector<Segment> _segments;            ///< of roads and rivers, by cells
};

} // namespace osgGeoFX
