// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// What the elevation rasters know of a post of the grid.
enum class Post : std::uint8_t
{
    DATA,    ///< a height
    VOID,    ///< within the rectangle of a raster that has no height there
    OUTSIDE, ///< in no raster's rectangle
    FILLED   ///< a void that got a height from the posts around it
};

/** Finds the voids of an elevation: posts without a height that lie inside the data.

    Posts without a height form areas, which are connected by sides and corners. An area is a void under three
    conditions:
    - No square with a side of more than 2 × `reach` posts fits into it. A larger area is a region that was left out.
    - At most two fifths of its outline run along the edge of the rasters, so data surround it. A turned raster leaves
      corners and bands empty, which have at least a half of their outline there.
    - If it touches that edge at all, less than a third of the data around it lies at 1 m or below. Otherwise it is a
      sea whose heights were left out.

    There are two sweeps over the rows: add() from the first row to the last, then mark() back. Memory grows with the
    areas that one row crosses, and with the number of voids, not with the grid. Not thread-safe. */
class VoidFinder
{
public:
    /// With `wholeCircle` the last column lies on the first, and neither is an edge.
    VoidFinder(int columns, int rows, int reach, bool wholeCircle);

    /// Adds the next row: its posts, and the heights of those with data, metres above the sea.
    void add(const std::vector<Post>& posts, const std::vector<float>& heights);

    /// Marks the row before the last marked one, at first the last row that was added. A VOID that belongs to a void
    /// becomes FILLED. The result says whether there is any.
    bool mark(std::vector<Post>& posts);

private:
    struct Run
    {
        int begin = 0, end = 0; ///< columns, the end excluded
        int label = 0;
        bool isVoid = false, goesOn = false;
    };
    struct End
    {
        int row, column;
    };
    struct Area
    {
        std::int64_t rim = 0, lowRim = 0, edge = 0; ///< sides of its posts: towards data, low data, no raster
        int square = 0;                             ///< the side of the largest square in it
        int lastRow = -1;
        std::vector<int> labels; ///< all that have become one with it
        std::vector<End> ends;   ///< where mark() must begin: the area has nothing in the next rows there
    };

    std::vector<Run> runsOf(const std::vector<Post>& posts) const;
    int root(int label);
    int newLabel();
    void join(int a, int b);
    void look(Area& area, Post post, float height) const;
    void lookAcross(const std::vector<Run>& runs, const std::vector<Post>& posts,
                    const std::vector<float>& heights);
    void grow(const std::vector<Post>& posts, const std::vector<Run>& runs);
    void finishRow();
    bool isVoid(const Area& area) const;

    const int _columns, _rowCount, _reach;
    const bool _wholeCircle;
    int _rows = 0; ///< added so far
    std::vector<Post> _posts;
    std::vector<float> _heights;
    std::vector<Run> _runs;    ///< of the row that was added last
    std::vector<int> _squares; ///< by column: the side of the largest square that ends there
    std::vector<int> _parents, _free;
    std::vector<Area> _areas;
    std::vector<End> _ends; ///< of voids, by row in the order of their discovery
    bool _sorted = false;
    std::vector<Run> _marked;
};

} // namespace osgGeoFX
