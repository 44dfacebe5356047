// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// What a cell of an elevation raster is.
enum class GroundKind : unsigned char
{
    LAND,
    SEA,
    LAKE
};

/** Finds water in heights alone, metres above the sea, NaN where there are none.

    Cells hang together by their sides where both have no data, both are at 0 or below, or both have the same height. Of
    such areas
    - those at 0 or below are sea where they reach the raster's border or cells without data, or where at least half
      of them lies at 0 and they are as large as a lake: other depressions are land;
    - those without data are sea where at least a third of the cells around them are no higher than 1 m;
    - those of one height are lakes where they have at least 32 cells and `lakeArea`, and at most a fifth of the
      cells around them, of which there must be some, lie lower: terraces and summits are level, too.
    Cells that were not measured, such as filled voids, go with the water that they hang together with, but do not
    make any: they count for no size, and an area of nothing else is land.

    Two sweeps over the rows, first add() from the first row to the last, then mark() back. Memory grows with the areas
    that one row crosses, and with the shores' bays, not with the raster. Not thread-safe. */
class WaterFinder
{
public:
    /// `cellArea` by row, square metres.
    WaterFinder(int columns, std::vector<double> cellArea, double lakeArea);

    void add(const std::vector<float>& heights);
    void add(const std::vector<float>& heights, const std::vector<bool>& measured);

    /// The row before the last one that was marked, at first the last row that was added.
    std::vector<GroundKind> mark(const std::vector<float>& heights);

private:
    struct End
    {
        int row, column;
        GroundKind ground;
    };
    struct Area
    {
        std::int64_t cells = 0, zeros = 0, rim = 0, lowerRim = 0, lowRim = 0;
        double squareMetres = 0.0;
        float height = 0.0f; ///< of one of its cells
        int lastRow = -1;
        bool open = false;       ///< reaches the border or cells without data
        std::vector<int> labels; ///< all that have become one with it
        std::vector<End> ends;   ///< where mark() must begin: nothing of the area lies ahead of them
    };

    int root(int label);
    int newLabel(float height, int row);
    void join(int& a, int& b, float height, int row);
    void count(int row);
    void decide(int label);
    GroundKind groundOf(const Area& area) const;

    int _columns;
    std::vector<double> _cellArea;
    double _lakeArea;
    int _rows = 0;                             ///< added so far
    std::vector<float> _behind, _here, _ahead; ///< three rows, the one that is counted in the middle
    std::vector<bool> _hereMeasured, _aheadMeasured;
    std::vector<int> _hereLabels, _aheadLabels;
    std::vector<int> _parents, _free;
    std::vector<Area> _areas;
    std::vector<End> _ends; ///< of water, by rows as they were met
    bool _sorted = false;
    std::vector<float> _markedHeights;
    std::vector<GroundKind> _marked;
};

} // namespace osgGeoFX
