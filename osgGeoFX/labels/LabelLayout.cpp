// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/LabelLayout.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

struct Box
{
    osg::Vec2d low, high;

    bool meets(const Box& other) const
    {
        return low.x() < other.high.x() && other.low.x() < high.x() && low.y() < other.high.y() &&
               other.low.y() < high.y();
    }
    Box grown(double by) const { return {low - osg::Vec2d(by, by), high + osg::Vec2d(by, by)}; }
};

Box boxOf(const osg::Vec2d& corner, const osg::Vec2d& size)
{
    return {corner, corner + size};
}

/// What a name takes of the picture: its box, or small ones along its curve.
std::vector<Box> boxesOf(const LabelCandidate& label, const osg::Vec2d& corner)
{
    if (label.manner != LabelCandidate::CURVE || label.curve.empty()) return {boxOf(corner, label.size)};
    std::vector<Box> boxes;
    const osg::Vec2d half(0.5 * label.thickness, 0.5 * label.thickness);
    osg::Vec2d last;
    for (std::size_t i = 0; i < label.curve.size(); ++i)
    {
        // No farther from each other than half of their sides.
        const bool end = i == 0 || i + 1 == label.curve.size();
        if (!end && i + 1 < label.curve.size() &&
            (label.curve[i + 1] - last).length() < 0.5 * label.thickness)
            continue;
        last = label.curve[i];
        boxes.push_back({last - half, last + half});
    }
    return boxes;
}

/// The line below a box, as wide as it is drawn.
Box lineOf(const osg::Vec2d& anchor, const osg::Vec2d& corner)
{
    return {{anchor.x() - 1.0, std::min(anchor.y(), corner.y())},
            {anchor.x() + 1.0, std::max(anchor.y(), corner.y())}};
}

/// What is taken of a picture. Cells make the search short.
class Taken
{
public:
    Taken(double width, double height)
        : _columns(std::clamp(static_cast<int>(width / cell) + 1, 1, 4096)),
          _rows(std::clamp(static_cast<int>(height / cell) + 1, 1, 4096)),
          _cells(static_cast<std::size_t>(_columns) * static_cast<std::size_t>(_rows))
    {
    }

    bool meets(const std::vector<Box>& boxes, double room, bool linesToo) const
    {
        return std::any_of(boxes.begin(), boxes.end(),
                           [&](const Box& box) { return meets(box.grown(room), linesToo); });
    }
    bool meets(const Box& box, bool linesToo) const
    {
        return any(box,
                   [&](const Entry& entry) { return (linesToo || !entry.line) && entry.box.meets(box); });
    }
    void take(const std::vector<Box>& boxes)
    {
        for (const Box& box : boxes)
            take(box, false);
    }
    void take(const Box& box, bool line)
    {
        const auto [left, right, bottom, top] = range(box);
        for (int row = bottom; row <= top; ++row)
            for (int column = left; column <= right; ++column)
                _cells[index(column, row)].push_back({box, line});
    }

private:
    static constexpr double cell = 64.0;
    struct Entry
    {
        Box box;
        bool line;
    };
    struct Range
    {
        int left, right, bottom, top;
    };

    Range range(const Box& box) const
    {
        const auto at = [](double place, int count)
        {
            return static_cast<int>(std::clamp(std::floor(place / cell), 0.0, count - 1.0));
        };
        return {at(box.low.x(), _columns), at(box.high.x(), _columns), at(box.low.y(), _rows),
                at(box.high.y(), _rows)};
    }
    std::size_t index(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(_columns) +
               static_cast<std::size_t>(column);
    }
    template<class Test>
    bool any(const Box& box, const Test& test) const
    {
        const auto [left, right, bottom, top] = range(box);
        for (int row = bottom; row <= top; ++row)
            for (int column = left; column <= right; ++column)
                for (const Entry& entry : _cells[index(column, row)])
                    if (test(entry)) return true;
        return false;
    }

    int _columns, _rows;
    std::vector<std::vector<Entry>> _cells;
};

/// Places of a box beside its anchor, the best one first.
std::vector<osg::Vec2d> offsetsOf(const LabelCandidate& label, const LabelLayout::Rules& rules)
{
    const double w = label.size.x(), h = label.size.y(), gap = rules.gap;
    if (label.manner == LabelCandidate::CURVE) return {{-0.5 * w, -0.5 * h}};
    if (label.manner == LabelCandidate::BESIDE)
        return {{gap, -0.5 * h},
                {-gap - w, -0.5 * h},
                {-0.5 * w, gap},
                {-0.5 * w, -gap - h},
                {0.7 * gap, 0.5 * gap},
                {0.7 * gap, -0.5 * gap - h},
                {-0.7 * gap - w, 0.5 * gap},
                {-0.7 * gap - w, -0.5 * gap - h}};
    std::vector<osg::Vec2d> offsets;
    for (int row = 0; row < std::max(rules.rows, 1); ++row)
        for (const double side : {-0.5, -0.22, -0.78})
            offsets.emplace_back(side * w, gap + row * (h + 2.0));
    return offsets;
}

/// Whether a line comes nearer to a box than it is wide.
bool meets(const LabelBand& band, const Box& inner)
{
    const Box box = inner.grown(band.halfWidth);
    // The part of the line between the box's sides (Liang and Barsky 1984).
    double first = 0.0, last = 1.0;
    for (int axis = 0; axis < 2; ++axis)
    {
        const double way = band.to[axis] - band.from[axis], low = box.low[axis] - band.from[axis],
                     high = box.high[axis] - band.from[axis];
        if (way == 0.0)
        {
            if (low > 0.0 || high < 0.0) return false;
            continue;
        }
        first = std::max(first, std::min(low / way, high / way));
        last = std::min(last, std::max(low / way, high / way));
    }
    return first <= last;
}

bool isWhole(const Box& box, double width, double height)
{
    return box.low.x() >= 0.0 && box.low.y() >= 0.0 && box.high.x() <= width && box.high.y() <= height;
}

} // namespace

std::vector<PlacedLabel> LabelLayout::place(const std::vector<LabelCandidate>& candidates, double width,
                                            double height, double time, const std::vector<LabelBand>& bands)
{
    // A clock that goes back, or has stood for long, tells nothing of what was seen before.
    const double passed = _time < 0.0 ? 0.0 : std::clamp(time - _time, 0.0, 1.0);
    _time = time;
    ++_picture;
    const double step = _rules.fading > 0.0 ? passed / _rules.fading : 1.0;

    // What the names to come must keep off, and what is in the picture already.
    Taken taken(width, height), drawn(width, height);
    std::vector<std::pair<Shown*, std::size_t>> order;
    std::size_t count = 0;
    for (const LabelCandidate& label : candidates)
    {
        const bool within = isWhole({label.anchor, label.anchor}, width, height);
        const auto known = _shown.find(label.id);
        if (known == _shown.end() && !(label.visible && within)) continue;
        Shown& shown = known != _shown.end() ? known->second : _shown[label.id];
        if (shown.picture == _picture) continue; // named twice
        shown.picture = _picture;
        shown.last = label;
        order.emplace_back(&shown, label.id);
        const bool visible = label.visible && within;
        shown.seen = visible ? shown.seen + passed : 0.0;
        shown.hidden = visible ? 0.0 : shown.hidden + passed;
        const bool wanted = shown.placed ? shown.hidden <= _rules.patience && within
                                         : visible && (shown.seen >= _rules.patience || _rules.fading <= 0.0);
        const auto free = [&](const osg::Vec2d& offset, double room)
        {
            const Box box = boxOf(label.anchor + offset, label.size);
            if (!isWhole(box, width, height) || taken.meets(boxesOf(label, box.low), room, true))
                return false;
            return label.manner != LabelCandidate::LEADER ||
                   !taken.meets(lineOf(label.anchor, box.low), false);
        };
        // The box of a curve changes with the view.
        if (label.manner == LabelCandidate::CURVE) shown.offset = label.size * -0.5;
        bool placed = false;
        if (wanted && count < _rules.most)
        {
            // It goes before it would touch another one, or it would not have the time to fade.
            if (shown.placed) placed = free(shown.offset, 0.5 * _rules.room);
            // A name that is still to be seen must be gone before it shows elsewhere.
            if (!placed && shown.alpha <= 0.0)
            {
                const auto isOff = [&](const osg::Vec2d& offset)
                {
                    // Names of summits stand in the sky, and the ways behind them are hidden.
                    if (label.manner == LabelCandidate::LEADER) return true;
                    const Box box = boxOf(label.anchor + offset, label.size);
                    return std::none_of(bands.begin(), bands.end(),
                                        [&](const LabelBand& band) { return meets(band, box); });
                };
                for (const osg::Vec2d& offset : offsetsOf(label, _rules))
                {
                    if (!free(offset, _rules.room)) continue;
                    const bool off = isOff(offset);
                    if (!placed || off) shown.offset = offset;
                    placed = true;
                    if (off) break;
                }
            }
        }
        shown.placed = placed;
        if (!placed) continue;
        ++count;
        const Box box = boxOf(label.anchor + shown.offset, label.size);
        for (Taken* const each : {&taken, shown.alpha > 0.0 ? &drawn : nullptr})
        {
            if (!each) continue;
            each->take(boxesOf(label, box.low));
            if (label.manner == LabelCandidate::LEADER) each->take(lineOf(label.anchor, box.low), true);
        }
    }
    // What has no place fades where it is, unless that would be over a name.
    Taken fading(width, height);
    for (auto entry = _shown.begin(); entry != _shown.end();)
    {
        Shown& shown = entry->second;
        const bool gone = shown.picture != _picture;
        if (gone) shown.placed = false;
        if (!shown.placed)
        {
            const osg::Vec2d corner = shown.last.anchor + shown.offset;
            const std::vector<Box> boxes = boxesOf(shown.last, corner);
            const bool line = shown.last.manner == LabelCandidate::LEADER;
            const Box leader = lineOf(shown.last.anchor, corner);
            const bool over = drawn.meets(boxes, 0.0, true) || fading.meets(boxes, 0.0, true) ||
                              (line && (drawn.meets(leader, false) || fading.meets(leader, false)));
            shown.alpha = over ? 0.0 : std::max(shown.alpha - step, 0.0);
            if (shown.alpha > 0.0)
            {
                fading.take(boxes);
                if (line) fading.take(leader, true);
            }
        }
        const bool forgotten = gone && shown.alpha <= 0.0;
        if (gone && !forgotten) order.emplace_back(&shown, entry->first);
        entry = forgotten ? _shown.erase(entry) : std::next(entry);
    }
    std::vector<PlacedLabel> result;
    for (const auto& [shown, id] : order)
    {
        const LabelCandidate& label = shown->last;
        const osg::Vec2d corner = label.anchor + shown->offset;
        const bool leader = label.manner == LabelCandidate::LEADER;
        if (shown->placed)
        {
            // Others that fade are in the way until they are gone.
            const bool waits = fading.meets(boxesOf(label, corner), 0.0, true) ||
                               (leader && fading.meets(lineOf(label.anchor, corner), false));
            if (!waits) shown->alpha = std::min(shown->alpha + step, 1.0);
        }
        if (shown->alpha > 0.0)
            result.push_back({id, label.anchor, corner, label.size, shown->alpha, leader});
    }
    return result;
}

std::vector<PlacedLabel> LabelLayout::placeOnce(const std::vector<LabelCandidate>& candidates, double width,
                                                double height, const Rules& rules,
                                                const std::vector<LabelBand>& bands)
{
    Rules once = rules;
    once.fading = once.patience = 0.0;
    LabelLayout layout(once);
    return layout.place(candidates, width, height, 0.0, bands);
}

} // namespace osgGeoFX
