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
    FILLED   ///< void, but given a height from those around it
};

/** Finds the voids of an elevation: posts without a height that lie inside the data.

    Posts without a height hang together by their sides and corners. Such an area is a void
    - where no square of more than 2 × `reach` posts' side fits into it: a larger one is a region that was left out;
    - and where at most two fifths of its outline run along the edge of the rasters, so that data surround it: corners
      and bands that a turned raster leaves empty have at least a half there;
    - and where, if it touches that edge at all, less than a third of the data around it lies at 1 m or below: that is
      a sea whose heights were left out.

    Two sweeps over the rows, first add() from the first row to the last, then mark() back. Memory grows with the areas
    that one row crosses, and with the number of voids, not with the grid. Not thread-safe. */
class VoidFinder
{
public:
    /// With `wholeCircle` the last column lies on the first, and neither is an edge.
    VoidFinder(int columns, int rows, int reach, bool wholeCircle);

    /// The next row: what its posts are, and the heights of those with data, metres above the sea.
    void add(const std::vector<Post>& posts, const std::vector<float>& heights);

    /// The row before the last one that was marked, at first the last row that was added: makes FILLED of VOID where the
    /// post belongs to a void. Returns whether any does.
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
        std::vector<End> ends;   ///< where mark() must begin: nothing of the area lies ahead of them
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
    std::vector<End> _ends; ///< of voids, by rows as they were met
    bool _sorted = false;
    std::vector<Run> _marked;
};

} // namespace osgGeoFX
