// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/VoidFinder.h>

#include <algorithm>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr float LOW_RIM = 1.0f; // metres, as in WaterFinder

/// Calls visit(i, j) for each pair of runs of two neighbouring rows that touch, by sides or corners.
template<typename Runs, typename Visit>
void forTouching(Runs& first, Runs& second, const Visit& visit)
{
    std::size_t begin = 0;
    for (auto& run : first)
    {
        while (begin < second.size() && second[begin].end < run.begin)
            ++begin;
        for (std::size_t i = begin; i < second.size() && second[i].begin <= run.end; ++i)
            visit(run, second[i]);
    }
}

} // namespace

VoidFinder::VoidFinder(int columns, int rows, int reach, bool wholeCircle)
    : _columns(columns), _rowCount(rows), _reach(reach), _wholeCircle(wholeCircle),
      _squares(static_cast<std::size_t>(columns))
{
}

std::vector<VoidFinder::Run> VoidFinder::runsOf(const std::vector<Post>& posts) const
{
    std::vector<Run> runs;
    const auto missing = [](Post post)
    {
        return post == Post::VOID || post == Post::FILLED;
    };
    for (int c = 0; c < _columns; ++c)
    {
        if (!missing(posts[static_cast<std::size_t>(c)])) continue;
        if (runs.empty() || runs.back().end != c) runs.push_back({c, c, 0, false, false});
        runs.back().end = c + 1;
    }
    return runs;
}

int VoidFinder::root(int label)
{
    while (_parents[static_cast<std::size_t>(label)] != label)
        label = _parents[static_cast<std::size_t>(label)] =
            _parents[static_cast<std::size_t>(_parents[static_cast<std::size_t>(label)])];
    return label;
}

int VoidFinder::newLabel()
{
    if (_free.empty())
    {
        _free.push_back(static_cast<int>(_parents.size()));
        _parents.push_back(0);
        _areas.emplace_back();
    }
    const int label = _free.back();
    _free.pop_back();
    _parents[static_cast<std::size_t>(label)] = label;
    Area& area = _areas[static_cast<std::size_t>(label)];
    area.rim = area.lowRim = area.edge = 0;
    area.square = 0;
    area.lastRow = _rows;
    area.labels.assign(1, label);
    area.ends.clear();
    return label;
}

void VoidFinder::join(int a, int b)
{
    int keep = root(a), drop = root(b);
    if (keep == drop) return;
    const auto size = [this](int label)
    {
        const Area& area = _areas[static_cast<std::size_t>(label)];
        return area.labels.size() + area.ends.size();
    };
    if (size(keep) < size(drop)) std::swap(keep, drop);
    Area &area = _areas[static_cast<std::size_t>(keep)], &other = _areas[static_cast<std::size_t>(drop)];
    _parents[static_cast<std::size_t>(drop)] = keep;
    area.rim += other.rim;
    area.lowRim += other.lowRim;
    area.edge += other.edge;
    area.square = std::max(area.square, other.square);
    area.lastRow = std::max(area.lastRow, other.lastRow);
    area.labels.insert(area.labels.end(), other.labels.begin(), other.labels.end());
    area.ends.insert(area.ends.end(), other.ends.begin(), other.ends.end());
}

void VoidFinder::look(Area& area, Post post, float height) const
{
    if (post == Post::OUTSIDE) ++area.edge;
    if (post != Post::DATA) return;
    ++area.rim;
    area.lowRim += height <= LOW_RIM ? 1 : 0;
}

/// Counts the posts on the other side of each post of the runs, in a row beside theirs.
void VoidFinder::lookAcross(const std::vector<Run>& runs, const std::vector<Post>& posts,
                            const std::vector<float>& heights)
{
    for (const Run& run : runs)
    {
        Area& area = _areas[static_cast<std::size_t>(root(run.label))];
        for (int c = run.begin; c < run.end; ++c)
            look(area, posts[static_cast<std::size_t>(c)], heights[static_cast<std::size_t>(c)]);
    }
}

/// Finds the largest squares that end at the posts of a new row.
void VoidFinder::grow(const std::vector<Post>& posts, const std::vector<Run>& runs)
{
    int before = 0; // of the row before, one column before
    int last = 0;   // of this row, one column before
    for (std::size_t c = 0; c < _squares.size(); ++c)
    {
        const int above = _squares[c];
        last = posts[c] == Post::VOID ? 1 + std::min({last, above, before}) : 0;
        before = above;
        _squares[c] = last;
    }
    for (const Run& run : runs)
    {
        Area& area = _areas[static_cast<std::size_t>(root(run.label))];
        for (int c = run.begin; c < run.end; ++c)
            area.square = std::max(area.square, _squares[static_cast<std::size_t>(c)]);
    }
}

void VoidFinder::add(const std::vector<Post>& posts, const std::vector<float>& heights)
{
    std::vector<Run> runs = runsOf(posts);
    for (Run& run : runs)
        run.label = newLabel();
    forTouching(_runs, runs,
                [this](Run& before, Run& here)
                {
                    before.goesOn = true;
                    join(before.label, here.label);
                });
    const bool seam = _wholeCircle && !runs.empty() && runs.front().begin == 0 && runs.back().end == _columns;
    if (seam) join(runs.front().label, runs.back().label);

    const std::vector<Post> beyond(_posts.empty() ? posts.size() : 0, Post::OUTSIDE);
    lookAcross(runs, _posts.empty() ? beyond : _posts, _posts.empty() ? heights : _heights);
    lookAcross(_runs, posts, heights);
    for (const Run& run : runs)
    {
        Area& area = _areas[static_cast<std::size_t>(root(run.label))];
        const auto lookAt = [&](int column)
        {
            if (column >= 0 && column < _columns)
                look(area, posts[static_cast<std::size_t>(column)],
                     heights[static_cast<std::size_t>(column)]);
            else if (!_wholeCircle)
                ++area.edge;
        };
        lookAt(run.begin - 1);
        lookAt(run.end);
    }
    grow(posts, runs);
    finishRow();
    _posts = posts;
    _heights = heights;
    _runs = std::move(runs);
    if (++_rows < _rowCount) return;
    lookAcross(_runs, std::vector<Post>(posts.size(), Post::OUTSIDE), heights);
    finishRow();
    _runs.clear();
}

/// Decides about the areas that end with the last row, and notes where their runs end.
void VoidFinder::finishRow()
{
    for (const Run& run : _runs)
        if (!run.goesOn)
            _areas[static_cast<std::size_t>(root(run.label))].ends.push_back({_rows - 1, run.begin});
    for (const Run& run : _runs)
    {
        Area& area = _areas[static_cast<std::size_t>(root(run.label))];
        if (area.lastRow != _rows - 1) continue;
        if (isVoid(area)) _ends.insert(_ends.end(), area.ends.begin(), area.ends.end());
        area.lastRow = -1;
        _free.insert(_free.end(), area.labels.begin(), area.labels.end());
    }
}

bool VoidFinder::isVoid(const Area& area) const
{
    if (area.rim == 0 || area.square > 2 * _reach) return false;
    if (area.edge == 0) return true;
    return 5 * area.edge <= 2 * (area.rim + area.edge) && 3 * area.lowRim < area.rim;
}

bool VoidFinder::mark(std::vector<Post>& posts)
{
    if (!_sorted)
        std::sort(_ends.begin(), _ends.end(),
                  [](const End& a, const End& b)
                  { return std::pair(a.row, -a.column) < std::pair(b.row, -b.column); });
    _sorted = true;
    --_rows;
    std::vector<Run> runs = runsOf(posts);
    for (Run& run : runs)
    {
        run.isVoid = !_ends.empty() && _ends.back().row == _rows && _ends.back().column == run.begin;
        if (run.isVoid) _ends.pop_back();
    }
    forTouching(runs, _marked,
                [](Run& here, const Run& ahead) { here.isVoid = here.isVoid || ahead.isVoid; });
    const bool seam = _wholeCircle && !runs.empty() && runs.front().begin == 0 && runs.back().end == _columns;
    if (seam) runs.front().isVoid = runs.back().isVoid = runs.front().isVoid || runs.back().isVoid;
    bool any = false;
    for (const Run& run : runs)
    {
        if (!run.isVoid) continue;
        any = true;
        std::fill(posts.begin() + run.begin, posts.begin() + run.end, Post::FILLED);
    }
    _marked = std::move(runs);
    return any;
}

} // namespace osgGeoFX
