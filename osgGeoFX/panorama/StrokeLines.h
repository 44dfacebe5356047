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

/** Roads, rivers and towns from vector data, for the brush strokes of a panorama map; the future work of Brown and Samavati
    (2017).

    Lines are painted as strokes one behind the other, at marks that a line has at all multiples of a step from its first point,
    and one at its end: they follow from the line alone, and so every tile has the same. A mark has a level, the power of two
    in its multiple, so that coarser tiles and smaller pictures do with fewer.

    Filled once, before a map or a thread has it; all else is thread-safe. */
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
        /// Two at least. Of a town the ring around it; holes follow, each ring closed and followed by the first point.
        std::vector<osg::Vec2d> points;
    };
    /// Where a stroke stands.
    struct Mark
    {
        osg::Vec2d place;       ///< of the map, in its units
        osg::Vec2d along;       ///< the way on from there, of any length, in its units
        std::int64_t index = 0; ///< the multiple of the step; −1 at the line's end
        int level = 0;          ///< of the step, 0 at least
        std::uint32_t line = 0; ///< its number
    };

    StrokeLines() = default;
    StrokeLines(const StrokeLines& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, StrokeLines);

    /// Takes the place of what there is. False, with no change, where a line has less than two points, or one that is no
    /// place: not finite, or latitudes beyond ±90.
    bool set(Units units, std::vector<Line> lines);
    Units getUnits() const { return _units; }
    /// As given, but for longitudes: of each two points that follow each other they differ by half a turn at most.
    const std::vector<Line>& getLines() const { return _lines; }

    /// The marks of roads and rivers in a box of the map, of a level and above, in an order that follows from the box. `step` is in
    /// metres, > 0.
    std::vector<Mark> marks(const osg::Vec2d& low, const osg::Vec2d& high, double step, int level) const;

    /// Tells which places of a box lie in a town. The lines must outlive it.
    class OSGGEOFX_EXPORT Towns
    {
    public:
        Towns(const StrokeLines& lines, const osg::Vec2d& low, const osg::Vec2d& high);
        bool empty() const { return _rows.empty(); }
        /// Of places in the box; elsewhere the answer means nothing.
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
