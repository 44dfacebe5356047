// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/RouteMapping.h>

#include <osgGeoFX/mapping/MarkImages.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr int mostMaskTexels = 1024; ///< along one side

double distanceToLeg(const osg::Vec2d& place, const osg::Vec2d& from, const osg::Vec2d& to)
{
    const osg::Vec2d along = to - from;
    const double length2 = along.length2();
    const double share = length2 > 0.0 ? std::clamp((place - from) * along / length2, 0.0, 1.0) : 0.0;
    return (place - from - along * share).length();
}

/// A pool whose mappings lie that much above the route's lowest.
MappingPool::Prepare prepared(int order, ColorTransfer* transfer)
{
    return [order, keep = osg::ref_ptr<ColorTransfer>(transfer)](ProjectiveMapping& mapping)
    {
        mapping.setOrder(order);
        if (keep) mapping.setTransfer(keep);
    };
}

osg::ref_ptr<ColorTransfer> makeTransfer(ColorTransfer::Source source, ColorTransfer::Alpha alpha)
{
    osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
    transfer->setSource(source);
    transfer->setAlpha(alpha);
    return transfer;
}

bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

bool makesSense(const RouteMapping::Style& style)
{
    for (const osg::Vec4& color : {style.color, style.casingColor, style.highlightColor})
    {
        for (int i = 0; i < 4; ++i)
        {
            if (!within(static_cast<double>(color[i]), 0.0, 1.0)) return false;
        }
    }
    const double lengths[] = {style.halfWidth,   style.casing,       style.dash,     style.gap,
                              style.pointRadius, style.surroundings, style.softness, style.contextReach};
    return std::all_of(std::begin(lengths), std::end(lengths),
                       [](double length) { return within(length, 0.0, 1e7); }) &&
           within(style.pointPixels, 0.0, 1e4) && within(style.brightness, 0.0, 4.0) &&
           within(style.saturation, 0.0, 4.0);
}

} // namespace

RouteMapping::RouteMapping(ProjectiveMappings& mappings, int order)
    : _disc(new DataLayer(makeDisc(256, {1, 1, 1, 1}, {1, 1, 1, 1}, 1.0))), _mark(new DataLayer),
      _distances(new DataLayer),
      _contextTransfer(makeTransfer(ColorTransfer::SCENE, ColorTransfer::FROM_MASK)),
      _beyondTransfer(makeTransfer(ColorTransfer::SCENE, ColorTransfer::OPAQUE)),
      _casingTransfer(makeTransfer(ColorTransfer::CONSTANT, ColorTransfer::FROM_SOURCE)),
      _lineTransfer(makeTransfer(ColorTransfer::CONSTANT, ColorTransfer::FROM_SOURCE)),
      _highlightTransfer(makeTransfer(ColorTransfer::CONSTANT, ColorTransfer::FROM_SOURCE)),
      _pools{{{mappings, prepared(order, _contextTransfer)},
              {mappings, prepared(order, _beyondTransfer)},
              {mappings, prepared(order + 1, _casingTransfer)},
              {mappings, prepared(order + 2, _lineTransfer)},
              {mappings, prepared(order + 3, _highlightTransfer)},
              {mappings, prepared(order + 5, nullptr)}}}
{
    _distances->setKind(DataLayer::VALUE);
    makeColors();
}

RouteMapping::~RouteMapping() = default;

bool RouteMapping::setWayPoints(const std::vector<osg::Vec2d>& places)
{
    std::vector<osg::Vec2d> points;
    for (const osg::Vec2d& place : places)
    {
        if (!within(place.x(), -5e7, 5e7) || !within(place.y(), -5e7, 5e7))
        {
            OSG_WARN << "osgGeoFX: RouteMapping got a way point at " << place.x() << ", " << place.y()
                     << "; the route stays as it is." << std::endl;
            return false;
        }
        if (points.empty() || (place - points.back()).length() > 1e-3) points.push_back(place);
    }
    _points = points;
    makeContext();
    make();
    return true;
}

double RouteMapping::length() const
{
    double sum = 0.0;
    for (std::size_t i = 0; i < legs(); ++i)
        sum += (_points[i + 1] - _points[i]).length();
    return sum;
}

bool RouteMapping::setStyle(const Style& style)
{
    if (!makesSense(style))
    {
        OSG_WARN
            << "osgGeoFX: RouteMapping got a style with lengths, colors or factors out of range; the former "
               "one stays."
            << std::endl;
        return false;
    }
    _style = style;
    makeColors();
    makeContext();
    make();
    return true;
}

void RouteMapping::setPointLayer(DataLayer* layer)
{
    _ownMark = layer;
    make();
}

void RouteMapping::highlight(std::optional<std::size_t> leg)
{
    _highlighted = leg;
    make();
}

std::optional<std::size_t> RouteMapping::legAt(const osg::Vec2d& place) const
{
    std::optional<std::size_t> nearest;
    double least = _style.halfWidth + _style.casing;
    for (std::size_t i = 0; i < legs(); ++i)
    {
        const double distance = distanceToLeg(place, _points[i], _points[i + 1]);
        if (distance > least) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

void RouteMapping::leave(const std::string& name)
{
    for (MappingPool& each : _pools)
    {
        for (std::size_t i = 0; i < each.size(); ++i)
            each.at(i).setName(name);
        each.leave();
    }
    _points.clear();
}

void RouteMapping::makeColors()
{
    _casingTransfer->setConstant(_style.casingColor);
    _lineTransfer->setConstant(_style.color);
    _highlightTransfer->setConstant(_style.highlightColor);
    for (ColorTransfer* transfer : {_contextTransfer.get(), _beyondTransfer.get()})
    {
        transfer->setBrightness(_style.brightness);
        transfer->setSaturation(_style.saturation);
    }
    // Distances, metres: nothing to be seen of the context near the route, all of it far away.
    _contextTransfer->setRamp(_style.surroundings, _style.surroundings + _style.softness);
    _mark->setImage(makeDisc(128, _style.casingColor, _style.color, 0.62));
}

void RouteMapping::makeContext()
{
    if (_points.empty() || !_style.context)
    {
        pool(CONTEXT_MASKED).clear();
        pool(CONTEXT_BEYOND).clear();
        return;
    }
    osg::Vec2d low = _points.front();
    osg::Vec2d high = low;
    for (const osg::Vec2d& point : _points)
    {
        low.set(std::min(low.x(), point.x()), std::min(low.y(), point.y()));
        high.set(std::max(high.x(), point.x()), std::max(high.y(), point.y()));
    }
    const double reach = std::max(_style.surroundings + _style.softness, 1.0);
    const double extent = std::max(high.x() - low.x(), high.y() - low.y()) + 2.0 * reach;
    // Distances are mixed between texels, so that these may be large against the line.
    const double texel = std::max(extent / (mostMaskTexels - 8), reach / 24.0);
    const double margin = reach + 2.0 * texel;
    low -= osg::Vec2d(margin, margin);
    const int width = static_cast<int>(std::ceil((high.x() + margin - low.x()) / texel));
    const int height = static_cast<int>(std::ceil((high.y() + margin - low.y()) / texel));
    high = low + osg::Vec2d(width, height) * texel;

    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_LUMINANCE, GL_FLOAT);
    _distances->setImage(image);
    drawDistances(low, texel);

    MappingPool& masked = pool(CONTEXT_MASKED);
    masked.rewind();
    ProjectiveMapping& mapping = masked.next();
    if (!mapping.getMask()) mapping.setMask(_distances);
    mapping.setRectangle((low + high) / 2.0, (high.x() - low.x()) / 2.0, (high.y() - low.y()) / 2.0);
    mapping.setSoftEdges(false);
    masked.trim();
    surround(pool(CONTEXT_BEYOND), low, high, std::max(_style.contextReach, texel));
}

void RouteMapping::drawDistances(const osg::Vec2d& low, double texel)
{
    osg::Image& image = *_distances->getImage();
    const double reach = std::max(_style.surroundings + _style.softness, 1.0) + 2.0 * texel;
    auto* distances = reinterpret_cast<float*>(image.data());
    std::fill(distances, distances + image.s() * image.t(), static_cast<float>(reach));
    const auto draw = [&](const osg::Vec2d& from, const osg::Vec2d& to)
    {
        const auto first = [&](double a, double b, double origin)
        {
            return std::max(static_cast<int>((std::min(a, b) - reach - origin) / texel), 0);
        };
        const auto last = [&](double a, double b, double origin, int count)
        {
            return std::min(static_cast<int>((std::max(a, b) + reach - origin) / texel) + 1, count);
        };
        const int right = last(from.x(), to.x(), low.x(), image.s());
        const int top = last(from.y(), to.y(), low.y(), image.t());
        for (int row = first(from.y(), to.y(), low.y()); row < top; ++row)
        {
            for (int column = first(from.x(), to.x(), low.x()); column < right; ++column)
            {
                const osg::Vec2d place = low + osg::Vec2d(column + 0.5, row + 0.5) * texel;
                float& distance = distances[row * image.s() + column];
                distance = std::min(distance, static_cast<float>(distanceToLeg(place, from, to)));
            }
        }
    };
    if (_points.size() == 1) draw(_points[0], _points[0]);
    for (std::size_t i = 0; i < legs(); ++i)
    {
        // In short parts: slanting ones have large boxes.
        const osg::Vec2d leg = _points[i + 1] - _points[i];
        const int parts = static_cast<int>(std::ceil(leg.length() / (2.0 * reach)));
        for (int part = 0; part < parts; ++part)
            draw(_points[i] + leg * (part / static_cast<double>(parts)),
                 _points[i] + leg * ((part + 1) / static_cast<double>(parts)));
    }
    image.dirty();
}

std::vector<RouteMapping::Piece> RouteMapping::pieces() const
{
    std::vector<Piece> result;
    // No more dashes than anyone can tell apart.
    const double period = _style.dash + _style.gap;
    const bool dashed = _style.dash > 0.0 && _style.gap > 0.0 && length() / period < 1e5;
    double phase = 0.0; // metres into the period
    for (std::size_t i = 0; i < legs(); ++i)
    {
        const osg::Vec2d leg = _points[i + 1] - _points[i];
        const double legLength = leg.length();
        const bool more = i + 1 < legs();
        if (!dashed)
        {
            result.push_back({i, _points[i], _points[i + 1], more});
            continue;
        }
        const auto at = [&](double metres)
        {
            return _points[i] + leg * (std::clamp(metres, 0.0, legLength) / legLength);
        };
        for (double start = -phase; start < legLength; start += period)
        {
            const double end = start + _style.dash;
            if (end > 1e-6) result.push_back({i, at(start), at(end), more && end > legLength});
        }
        phase = std::fmod(phase + legLength, period);
    }
    return result;
}

void RouteMapping::addStrip(Role role, const osg::Vec2d& from, const osg::Vec2d& to, double halfWidth)
{
    const osg::Vec2d way = to - from;
    ProjectiveMapping& mapping = pool(role).next();
    if (mapping.getLayer()) mapping.setLayer(nullptr);
    // U to the right of the way, V along it.
    mapping.setRectangle((from + to) / 2.0, halfWidth, way.length() / 2.0, std::atan2(way.x(), way.y()));
}

void RouteMapping::addDisc(Role role, const osg::Vec2d& center, double radius)
{
    ProjectiveMapping& mapping = pool(role).next();
    if (mapping.getLayer() != _disc) mapping.setLayer(_disc);
    mapping.setRectangle(center, radius / markReach, radius / markReach);
}

void RouteMapping::make()
{
    for (const Role role : {CASING, LINE, LINE_HIGHLIGHTED, POINTS})
        pool(role).rewind();
    const double outer = _style.halfWidth + _style.casing;
    if (_style.halfWidth > 0.0)
    {
        const std::vector<Piece> all = pieces();
        for (const Piece& piece : all)
        {
            const Role role = _highlighted == piece.leg ? LINE_HIGHLIGHTED : LINE;
            addStrip(role, piece.from, piece.to, _style.halfWidth);
            if (piece.join) addDisc(role, piece.to, _style.halfWidth);
        }
        for (std::size_t i = 0; i < legs() && _style.casing > 0.0; ++i)
            addStrip(CASING, _points[i], _points[i + 1], outer);
        // Both ends are round, too.
        for (std::size_t i = 0; i < _points.size() && legs() > 0; ++i)
        {
            if (_style.casing > 0.0) addDisc(CASING, _points[i], outer);
        }
        if (!all.empty())
        {
            const auto cap = [&](const Piece& piece, const osg::Vec2d& place)
            {
                addDisc(_highlighted == piece.leg ? LINE_HIGHLIGHTED : LINE, place, _style.halfWidth);
            };
            cap(all.front(), all.front().from);
            if ((all.back().to - _points.back()).length() < 1e-6) cap(all.back(), all.back().to);
        }
    }
    for (std::size_t i = 0; i < _points.size() && _style.pointRadius > 0.0; ++i)
    {
        ProjectiveMapping& mapping = pool(POINTS).next();
        DataLayer* mark = _ownMark ? _ownMark.get() : _mark.get();
        if (mapping.getLayer() != mark) mapping.setLayer(mark);
        mapping.setRectangle(_points[i], _style.pointRadius / markReach, _style.pointRadius / markReach);
        mapping.setSizeInPixels(_style.pointPixels);
        mapping.setTurned(_ownMark.valid());
    }
    for (const Role role : {CASING, LINE, LINE_HIGHLIGHTED, POINTS})
        pool(role).trim();
}

} // namespace osgGeoFX
