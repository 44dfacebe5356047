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

    Two cells side by side belong to one area if both have no data, if both are at 0 or below, or if both have the same
    height. There are three kinds of areas:
    - An area at 0 or below is sea if it reaches the raster's border or cells without data. It is also sea if at least
      half of it lies at 0 and it is as large as a lake. Other depressions are land.
    - An area without data is sea if at least a third of the cells around it are no higher than 1 m.
    - An area of one height is a lake if it has at least 32 cells and `lakeArea`, and if at most a fifth of the cells
      around it lie lower. There must be such cells around it. Terraces and summits are level, too, but lie higher.
    Cells that were not measured, such as filled voids, belong to the water of their area, but do not make water: they
    do not count for its size, and an area of nothing else is land.

    There are two sweeps over the rows: add() from the first row to the last, then mark() back. Memory grows with the
    areas that one row crosses, and with the shores' bays, not with the raster. Not thread-safe. */
class WaterFinder
{
public:
    /// `cellArea` by row, square metres.
    WaterFinder(int columns, std::vector<double> cellArea, double lakeArea);

    void add(const std::vector<float>& heights);
    void add(const std::vector<float>& heights, const std::vector<bool>& measured);

    /// The kinds of the row before the last marked one, at first of the last row that was added.
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
        std::vector<End> ends;   ///< where mark() must begin: the area has nothing in the next rows there
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
    std::vector<float> _behind, _here, _ahead; ///< three rows; the one that is counted is in the middle
    std::vector<bool> _hereMeasured, _aheadMeasured;
    std::vector<int> _hereLabels, _aheadLabels;
    std::vector<int> _parents, _free;
    std::vector<Area> _areas;
    std::vector<End> _ends; ///< of water, by row in the order of their discovery
    bool _sorted = false;
    std::vector<float> _markedHeights;
    std::vector<GroundKind> _marked;
};

} // namespace osgGeoFX
