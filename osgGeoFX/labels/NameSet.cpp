// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/NameSet.h>

#include <osgGeoFX/closeup/LiftedPlaces.h>

#include <osg/BoundingBox>

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Texts that are kept, beyond which all are laid out anew.
constexpr std::size_t mostTexts = 5000;
constexpr std::size_t namesOfBranch = 8;
/// Points of a curve in a picture.
constexpr int curvePoints = 64;

/// The part of a curve in the picture's middle as long as a text, with as many points; empty if it is shorter.
std::vector<osg::Vec2d> middleOf(const std::vector<osg::Vec2d>& curve, double length)
{
    std::vector<double> along = {0.0};
    for (std::size_t i = 1; i < curve.size(); ++i)
        along.push_back(along.back() + (curve[i] - curve[i - 1]).length());
    if (curve.size() < 2 || along.back() < length) return {};
    std::vector<osg::Vec2d> result;
    std::size_t i = 1;
    for (int k = 0; k <= curvePoints; ++k)
    {
        const double at = 0.5 * (along.back() - length) + length * k / curvePoints;
        while (i + 1 < along.size() && along[i] < at)
            ++i;
        const double share = (at - along[i - 1]) / std::max(along[i] - along[i - 1], 1e-12);
        result.push_back(curve[i - 1] + (curve[i] - curve[i - 1]) * share);
    }
    return result;
}

/// Without its small bends, which letters could not follow. The ends stay.
void smoothen(std::vector<osg::Vec2d>& curve)
{
    for (int pass = 0; pass < 60; ++pass)
    {
        std::vector<osg::Vec2d> next = curve;
        for (std::size_t i = 1; i + 1 < curve.size(); ++i)
            next[i] = (curve[i - 1] + curve[i] * 2.0 + curve[i + 1]) * 0.25;
        curve = std::move(next);
    }
}

/// Whether a pixel lies outside the picture by more than `room`.
bool isOutside(const osg::Vec2d& pixel, double width, double height, double room)
{
    return !(pixel.x() >= -room && pixel.y() >= -room && pixel.x() <= width + room &&
             pixel.y() <= height + room);
}

} // namespace

std::map<std::string, NameStyle> usualNameStyles()
{
    NameStyle summit, city, town, water, range;
    summit.text.size = 14.0;
    city.text.size = 16.0;
    city.text.bold = true;
    city.manner = town.manner = LabelCandidate::BESIDE;
    city.dot = 3.0;
    town.text.size = 13.0;
    town.dot = 2.2;
    water.text.size = 15.0;
    water.text.italic = true;
    water.text.spacing = 0.08;
    water.text.color.set(0.05f, 0.20f, 0.42f, 1.0f);
    range.text.size = 16.0;
    range.text.spacing = 0.25;
    range.text.color.set(0.22f, 0.17f, 0.12f, 1.0f);
    // A name of one place without a line lies beside it.
    water.manner = range.manner = LabelCandidate::BESIDE;
    std::map<std::string, NameStyle> styles = {{"", summit}, {"city", city}};
    for (const char* const name : {"summit", "peak", "volcano", "mountain", "hill", "saddle"})
        styles[name] = summit;
    for (const char* const name : {"town", "village", "hamlet", "suburb", "locality"})
        styles[name] = town;
    for (const char* const name :
         {"water", "lake", "river", "stream", "bay", "strait", "sea", "glacier", "coastline"})
        styles[name] = water;
    for (const char* const name :
         {"range", "mountain_range", "ridge", "arete", "valley", "plain", "plateau", "island"})
        styles[name] = range;
    return styles;
}

NameSet::NameSet(std::vector<MapName> names)
{
    const auto isGood = [](const MapName& name)
    {
        return !name.text.empty() && name.places.size() >= (name.kind == MapName::LINE ? 2u : 1u) &&
               std::all_of(name.places.begin(), name.places.end(),
                           [](const osg::Vec3d& p) { return p.valid(); });
    };
    for (MapName& name : names)
        if (isGood(name)) _names.push_back(std::move(name));
    const auto importance = [](const MapName& name)
    {
        return std::isnan(name.importance) ? -HUGE_VAL : name.importance;
    };
    std::stable_sort(_names.begin(), _names.end(),
                     [&](const MapName& a, const MapName& b) { return importance(a) > importance(b); });
    if (_names.empty()) return;
    std::vector<std::size_t> all(_names.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = i;
    grow(std::move(all));
}

NameSet::~NameSet() = default;

std::size_t NameSet::grow(std::vector<std::size_t> names)
{
    const std::size_t index = _tree.size();
    _tree.emplace_back();
    osg::BoundingBoxd box;
    for (const std::size_t name : names)
        for (const osg::Vec3d& place : _names[name].places)
            box.expandBy(place);
    _tree[index].ball.set(box.center(), box.radius());
    _tree[index].first = *std::min_element(names.begin(), names.end());
    if (names.size() <= namesOfBranch)
    {
        _tree[index].names = std::move(names);
        return index;
    }
    const osg::Vec3d size = box._max - box._min;
    const int axis = size.x() >= size.y() && size.x() >= size.z() ? 0 : size.y() >= size.z() ? 1 : 2;
    const auto middle = names.begin() + static_cast<std::ptrdiff_t>(names.size() / 2);
    std::nth_element(names.begin(), middle, names.end(),
                     [&](std::size_t a, std::size_t b)
                     {
                         const double x = _names[a].places.front()[axis], y = _names[b].places.front()[axis];
                         return x < y || (x == y && a < b);
                     });
    const std::size_t left = grow({names.begin(), middle});
    const std::size_t right = grow({middle, names.end()});
    _tree[index].left = left;
    _tree[index].right = right;
    return index;
}

void NameSet::setStyle(const std::string& name, const NameStyle& style)
{
    _styles[name] = style;
    _texts.clear();
}

const NameStyle& NameSet::styleOf(const MapName& name) const
{
    static const NameStyle usual;
    auto found = _styles.find(name.style);
    if (found == _styles.end()) found = _styles.find("");
    return found == _styles.end() ? usual : found->second;
}

void NameSet::setScale(double scale)
{
    if (!(scale > 0.0) || scale == _scale) return;
    _scale = scale;
    _texts.clear();
}

const LabelText& NameSet::text(std::size_t name)
{
    std::unique_ptr<LabelText>& text = _texts[name];
    if (!text)
    {
        LabelStyle style = styleOf(_names[name]).text;
        style.size *= _scale;
        text = std::make_unique<LabelText>(_names[name].text, style);
    }
    return *text;
}

bool NameSet::see(std::size_t index, const DeformedView& view, const LiftedPlaces& lifted, double width,
                  double height, Seen& seen)
{
    const MapName& name = _names[index];
    seen.name = seen.label.id = index;
    seen.label.manner = styleOf(name).manner;
    std::vector<osg::Vec2d> pixels;
    // All of a curve, or none of it, is on a close-up.
    for (const osg::Vec3d& place : name.places)
    {
        const std::optional<LiftedPlaces::Place> up = lifted.of(place);
        if (!up) break;
        pixels.emplace_back((up->picture.x() + 1.0) / 2.0 * width, (up->picture.y() + 1.0) / 2.0 * height);
        seen.drawn.push_back(up->drawn);
    }
    const bool onCloseUp = pixels.size() == name.places.size();
    if (!onCloseUp)
    {
        pixels.clear();
        seen.drawn.clear();
        for (const osg::Vec3d& place : name.places)
        {
            osg::Vec2d pixel;
            if (!view.project(place, pixel)) return false;
            pixels.push_back(pixel);
            seen.drawn.push_back(view.deform(place));
        }
    }
    if (name.kind == MapName::POINT)
    {
        // A name that has just left the picture fades out.
        if (isOutside(pixels.front(), width, height, 8.0 * _scale * styleOf(name).text.size)) return false;
        seen.label.anchor = pixels.front();
        const LabelText& laidOut = text(index);
        seen.label.size.set(laidOut.width(), laidOut.height());
    }
    else
    {
        // Text reads from left to right, whichever way the curve goes.
        if (pixels.front().x() > pixels.back().x()) std::reverse(pixels.begin(), pixels.end());
        if (std::all_of(pixels.begin(), pixels.end(),
                        [&](const osg::Vec2d& pixel) { return isOutside(pixel, width, height, 0.0); }))
            return false;
        const LabelText& laidOut = text(index);
        double whole = 0.0;
        for (std::size_t i = 1; i < pixels.size(); ++i)
            whole += (pixels[i] - pixels[i - 1]).length();
        std::vector<osg::Vec2d> even = middleOf(pixels, whole);
        if (even.empty()) return false;
        smoothen(even);
        seen.label.curve = middleOf(even, laidOut.width());
        if (seen.label.curve.empty()) return false;
        osg::Vec2d low = seen.label.curve.front(), high = low;
        for (const osg::Vec2d& point : seen.label.curve)
        {
            low.set(std::min(low.x(), point.x()), std::min(low.y(), point.y()));
            high.set(std::max(high.x(), point.x()), std::max(high.y(), point.y()));
        }
        const osg::Vec2d half(0.5 * laidOut.height(), 0.5 * laidOut.height());
        seen.label.manner = LabelCandidate::CURVE;
        seen.label.thickness = laidOut.height();
        seen.label.anchor = (low + high) * 0.5;
        seen.label.size = high - low + half * 2.0;
    }
    if (!(seen.label.size.x() > 0.0)) return false;
    if (!onCloseUp && _contextImportance > -HUGE_VAL && !(name.importance >= _contextImportance))
    {
        const osg::Vec3d& middle = name.places[name.places.size() / 2];
        seen.label.visible = view.chain().style(middle * view.modelView()) < 0.5;
    }
    return true;
}

std::size_t NameSet::placesShown(const Seen& seen,
                                 const std::vector<std::shared_ptr<const DepthPicture>>& pictures)
{
    const double tolerance = seen.drawn.size() > 1 ? 0.02 : 0.004;
    const auto count =
        std::count_if(seen.drawn.begin(), seen.drawn.end(),
                      [&](const osg::Vec3d& place)
                      {
                          return std::any_of(pictures.begin(), pictures.end(),
                                             [&](const auto& picture)
                                             { return picture->shows(place * picture->view, 1, tolerance); });
                      });
    return static_cast<std::size_t>(count);
}

std::vector<NameSet::Seen> NameSet::inPicture(EffectScene& scene, const osg::Matrixd& viewMatrix,
                                              const osg::Matrixd& projection, double width, double height,
                                              std::size_t most, double time)
{
    const DeformedView view(scene, viewMatrix, projection, width, height);
    const LiftedPlaces lifted(scene, viewMatrix, projection, time);
    std::vector<Seen> found;
    if (_tree.empty()) return found;
    if (_texts.size() > mostTexts) _texts.clear();
    // Branches and names by their first name. What is out of sight is never opened.
    using Entry =
        std::pair<std::size_t, std::size_t>; // the first name, and the branch + 1; 0 for the name itself
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.push({_tree.front().first, 1});
    std::size_t visible = 0;
    // Those that are left out fade, but must not become endless.
    while (!queue.empty() && visible < most && found.size() < 2 * most)
    {
        const auto [first, branchIndex] = queue.top();
        queue.pop();
        if (branchIndex == 0)
        {
            Seen seen;
            if (!see(first, view, lifted, width, height, seen)) continue;
            visible += seen.label.visible ? 1 : 0;
            found.push_back(std::move(seen));
            continue;
        }
        const Branch& branch = _tree[branchIndex - 1];
        if (!view.maySee(branch.ball) && !lifted.mayHave(branch.ball)) continue;
        for (const std::size_t name : branch.names)
            queue.push({name, 0});
        if (!branch.names.empty()) continue;
        queue.push({_tree[branch.left].first, branch.left + 1});
        queue.push({_tree[branch.right].first, branch.right + 1});
    }
    return found;
}

} // namespace osgGeoFX
