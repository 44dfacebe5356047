// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/RouteMapping.h>

#include <osgGeoFX/mapping/MarkImages.h>
#include <osgGeoFX/mapping/detail/RankOfRoute.h>
#include <osgGeoFX/mapping/detail/RouteGround.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// So that strips have a length.
constexpr double nearest = 1e-3;
constexpr double farthest = 5e7;
constexpr double longest = 1e7;
constexpr std::size_t mostLegs = 1000000;

bool isPlace(const osg::Vec2d& place)
{
    return within(place.x(), -farthest, farthest) && within(place.y(), -farthest, farthest);
}

osg::Vec4d colorOf(int rgb, double alpha)
{
    return {unpackedColor(rgb), alpha};
}

int packed(const osg::Vec4d& color)
{
    return packedColor({color.r(), color.g(), color.b()});
}

/// All routes have the same.
osg::Image* whiteDisc()
{
    static const osg::ref_ptr<osg::Image> disc = makeDisc(256, {1, 1, 1, 1}, {1, 1, 1, 1}, 1.0);
    return disc;
}

} // namespace

bool RouteMapping::Context::operator==(const Context& other) const
{
    return on == other.on && surroundings == other.surroundings && softness == other.softness &&
           reach == other.reach && line == other.line;
}

MappingPool RouteMapping::makePool(Role role, int above, ColorTransfer* transfer)
{
    return {[this, role](ProjectiveMapping& mapping, std::size_t index)
            {
                if (_host) _host->addRanked(mapping, RankOfRoute::of(_number, role, index));
            },
            [this, role](ProjectiveMapping&, std::size_t index)
            {
                if (_host) _host->removeRanked(RankOfRoute::of(_number, role, index));
            },
            [this, above, transfer](ProjectiveMapping& mapping)
            {
                mapping.setName(getName());
                mapping.setOrder(_order + above);
                mapping.setOpacity(_opacity);
                if (transfer && mapping.getTransfer() != transfer) mapping.setTransfer(transfer);
            }};
}

RouteMapping::RouteMapping()
    : _color(packed(_style.color)), _casingColor(packed(_style.casingColor)),
      _highlightColor(packed(_style.highlightColor)), _colorAlpha(_style.color.a()),
      _casingAlpha(_style.casingColor.a()), _highlightAlpha(_style.highlightColor.a()),
      _disc(new DataLayer(whiteDisc())), _mark(new DataLayer), _distances(new DataLayer),
      _contextTransfer(makeTransfer(ColorTransfer::SCENE, ColorTransfer::FROM_MASK)),
      _beyondTransfer(makeTransfer(ColorTransfer::SCENE, ColorTransfer::OPAQUE)),
      _casingTransfer(makeTransfer(ColorTransfer::CONSTANT, ColorTransfer::FROM_SOURCE)),
      _lineTransfer(makeTransfer(ColorTransfer::CONSTANT, ColorTransfer::FROM_SOURCE)),
      _highlightTransfer(makeTransfer(ColorTransfer::CONSTANT, ColorTransfer::FROM_SOURCE)),
      _pools{{makePool(CONTEXT_MASKED, 0, _contextTransfer), makePool(CONTEXT_BEYOND, 0, _beyondTransfer),
              makePool(CASING, 1, _casingTransfer), makePool(LINE, 2, _lineTransfer),
              makePool(LINE_HIGHLIGHTED, 3, _highlightTransfer), makePool(POINTS, 5, nullptr)}}
{
    _distances->setKind(DataLayer::VALUE);
    addListener(*this);
}

RouteMapping::RouteMapping(const RouteMapping& other, const osg::CopyOp& copy) : RouteMapping()
{
    setName(other.getName());
    setDataVariance(other.getDataVariance());
    if (auto* data = const_cast<osg::UserDataContainer*>(other.getUserDataContainer()))
        setUserDataContainer(copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_USERDATA ? osg::clone(data, copy)
                                                                                   : data);
    for (const Property& property : RouteMapping::properties())
        property.put(*this, property.get(other));
    _way = other._way;
    _legs = other._legs;
    const bool deep = (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS) != 0;
    _ownMark = deep && other._ownMark ? osg::clone(other._ownMark.get(), copy) : other._ownMark.get();
}

RouteMapping::~RouteMapping() = default;

const Properties& RouteMapping::properties() const
{
    using Self = RouteMapping;
    const auto metres = [](const char* name, const char* what)
    {
        return Property::number(name, what, 0.0, longest, "m");
    };
    const auto alpha = [](const char* name, const char* what)
    {
        return Property::number(name, what, 0.0, 1.0);
    };
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::flag("enabled", "whether it is drawn").of<&Self::_enabled>(),
            Property::integer("order", "the order of its lowest mappings", -1000, 995).of<&Self::_order>(),
            Property::number("opacity", "the opacity of all of it", 0.0, 1.0)
                .of<&Self::_opacity>()
                .turnedBy(0.05),
            metres("halfWidth", "half the width of the line; 0 is no line")
                .of<&Self::_style, &Style::halfWidth>(),
            metres("casing", "the width of the outline on each side; 0 is none")
                .of<&Self::_style, &Style::casing>(),
            Property::color("color", "the color of the line").of<&Self::_color>(),
            alpha("colorAlpha", "the alpha of the line").of<&Self::_colorAlpha>(),
            Property::color("casingColor", "the color of the outline").of<&Self::_casingColor>(),
            alpha("casingAlpha", "the alpha of the outline").of<&Self::_casingAlpha>(),
            Property::color("highlightColor", "the color of the highlighted leg")
                .of<&Self::_highlightColor>(),
            alpha("highlightAlpha", "the alpha of the highlighted leg").of<&Self::_highlightAlpha>(),
            Property::integer("highlightedLeg", "the highlighted leg, counted from 0; -1 is none", -1,
                              1000000)
                .of<&Self::_highlighted>(),
            metres("dash", "the length of a dash; 0 is no gaps").of<&Self::_style, &Style::dash>(),
            metres("gap", "the length of a gap between dashes; 0 is no gaps")
                .of<&Self::_style, &Style::gap>(),
            metres("pointRadius", "the radius of the marks at way points; 0 is no marks")
                .of<&Self::_style, &Style::pointRadius>(),
            Property::number("pointPixels", "the size of the marks on the screen; 0 is their size in metres",
                             0.0, 1e4, "px")
                .of<&Self::_style, &Style::pointPixels>(),
            Property::flag("context", "whether the surroundings lose brightness and saturation")
                .of<&Self::_style, &Style::context>(),
            metres("surroundings", "the distance from the route up to which nothing changes")
                .of<&Self::_style, &Style::surroundings>(),
            metres("softness", "the width of the transition beyond the surroundings")
                .of<&Self::_style, &Style::softness>(),
            Property::number("brightness", "the brightness beyond the transition", 0.0, 4.0)
                .of<&Self::_style, &Style::brightness>(),
            Property::number("saturation", "the saturation beyond the transition", 0.0, 4.0)
                .of<&Self::_style, &Style::saturation>(),
            metres("contextReach", "how far the context reaches around the route")
                .of<&Self::_style, &Style::contextReach>(),
        });
    return all;
}

bool RouteMapping::setStyle(const Style& style)
{
    return assign({{"halfWidth", style.halfWidth},
                   {"casing", style.casing},
                   {"color", packed(style.color)},
                   {"colorAlpha", style.color.a()},
                   {"casingColor", packed(style.casingColor)},
                   {"casingAlpha", style.casingColor.a()},
                   {"highlightColor", packed(style.highlightColor)},
                   {"highlightAlpha", style.highlightColor.a()},
                   {"dash", style.dash},
                   {"gap", style.gap},
                   {"pointRadius", style.pointRadius},
                   {"pointPixels", style.pointPixels},
                   {"context", style.context ? 1.0 : 0.0},
                   {"surroundings", style.surroundings},
                   {"softness", style.softness},
                   {"brightness", style.brightness},
                   {"saturation", style.saturation},
                   {"contextReach", style.contextReach}});
}

RouteMapping::Style RouteMapping::getStyle() const
{
    Style style = _style;
    style.color = colorOf(_color, _colorAlpha);
    style.casingColor = colorOf(_casingColor, _casingAlpha);
    style.highlightColor = colorOf(_highlightColor, _highlightAlpha);
    return style;
}

bool RouteMapping::setWayPoints(const std::vector<osg::Vec2d>& places)
{
    Way way;
    for (const osg::Vec2d& place : places)
    {
        // What is no place goes on to its refusal.
        if (!way.line.empty() && (place - way.line.back()).length() <= nearest) continue;
        way.wayPoints.push_back(static_cast<unsigned int>(way.line.size()));
        way.line.push_back(place);
    }
    return setWay(way);
}

std::vector<osg::Vec2d> RouteMapping::getWayPoints() const
{
    std::vector<osg::Vec2d> places;
    for (const unsigned int i : _way.wayPoints)
        places.push_back(_way.line[i]);
    return places;
}

bool RouteMapping::setGeographicWayPoints(const std::vector<osg::Vec2d>& degrees,
                                          const osg::EllipsoidModel* ellipsoid, const Georeference* reference,
                                          std::string& error)
{
    Way way;
    if (!_host)
        error =
            "a route with geographic way points must be in a ProjectiveMappings, whose frame they are in; "
            "add it first.";
    else if (RouteGround(*_host, ellipsoid, reference).lay(degrees, way, error) && setWay(way))
        return true;
    if (error.empty()) error = "it lies too far from its frame's origin; give another one.";
    return false;
}

bool RouteMapping::setWay(const Way& way)
{
    std::string fault;
    std::vector<std::size_t> legs;
    for (std::size_t i = 0; i < way.line.size(); ++i)
    {
        if (!isPlace(way.line[i]))
            fault =
                "a way point at " + std::to_string(way.line[i].x()) + ", " + std::to_string(way.line[i].y());
        else if (i > 0 && (way.line[i] - way.line[i - 1]).length() <= nearest)
            fault = "two neighbours at one place";
    }
    const std::vector<unsigned int>& points = way.wayPoints;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        if (points[i] >= way.line.size() || (i > 0 && points[i] <= points[i - 1]))
            fault = "way points that are not on its line in their order";
        else if (i > 0)
            legs.resize(points[i], i - 1);
    }
    if (way.line.empty() != points.empty() ||
        (fault.empty() && !points.empty() && (points.front() != 0 || points.back() + 1 != way.line.size())))
        fault = "a line that does not go from the first way point to the last one";
    if (!way.degrees.empty() && way.degrees.size() != points.size())
        fault = "another number of geographic way points";
    if (!fault.empty())
    {
        OSG_WARN << "osgGeoFX: RouteMapping got " << fault << "; the route stays as it is." << std::endl;
        return false;
    }
    _way = way;
    _legs = std::move(legs);
    touch();
    return true;
}

double RouteMapping::length() const
{
    double sum = 0.0;
    for (std::size_t i = 0; i < _legs.size(); ++i)
        sum += (_way.line[i + 1] - _way.line[i]).length();
    return sum;
}

void RouteMapping::setPointLayer(DataLayer* layer)
{
    if (_ownMark == layer) return;
    _ownMark = layer;
    touch();
}

void RouteMapping::highlight(std::optional<std::size_t> leg)
{
    setHighlightedLeg(leg ? static_cast<int>(std::min(*leg, mostLegs)) : -1);
}

std::optional<std::size_t> RouteMapping::highlighted() const
{
    if (_highlighted < 0) return std::nullopt;
    return static_cast<std::size_t>(_highlighted);
}

std::optional<std::size_t> RouteMapping::legAt(const osg::Vec2d& place) const
{
    std::optional<std::size_t> nearestLeg;
    double least = _style.halfWidth + _style.casing;
    for (std::size_t i = 0; i < _legs.size(); ++i)
    {
        const double distance = distanceToLeg(place, _way.line[i], _way.line[i + 1]);
        if (distance > least) continue;
        least = distance;
        nearestLeg = _legs[i];
    }
    return nearestLeg;
}

std::size_t RouteMapping::getNumMappings() const
{
    std::size_t count = 0;
    for (const MappingPool& each : _pools)
        count += each.size();
    return count;
}

void RouteMapping::show(ProjectiveMappings* host, std::uint64_t number)
{
    // From the former one.
    for (MappingPool& each : _pools)
        each.clear();
    _context.reset();
    _host = host;
    _number = number;
    make();
}

void RouteMapping::forget()
{
    _host = nullptr;
    show(nullptr, 0);
}

void RouteMapping::propertyChanged(PropertyHolder&)
{
    make();
}

void RouteMapping::make()
{
    if (!_host) return;
    for (MappingPool& each : _pools)
        each.prepareAll();
    makeColors();
    makeContext();
    makeLine();
    makePoints();
}

void RouteMapping::makeColors()
{
    const Style style = getStyle();
    _casingTransfer->setConstant(style.casingColor);
    _lineTransfer->setConstant(style.color);
    _highlightTransfer->setConstant(style.highlightColor);
    for (ColorTransfer* transfer : {_contextTransfer.get(), _beyondTransfer.get()})
    {
        transfer->setBrightness(style.brightness);
        transfer->setSaturation(style.saturation);
    }
    // Distances, metres: nothing to be seen of the context near the route, all of it far away.
    _contextTransfer->setRamp(style.surroundings, style.surroundings + style.softness);
    const std::pair<osg::Vec4d, osg::Vec4d> mark(style.casingColor, style.color);
    if (_marked == mark) return;
    _marked = mark;
    _mark->setImage(makeDisc(128, osg::Vec4(mark.first), osg::Vec4(mark.second), 0.62));
}

void RouteMapping::makeContext()
{
    const Context now{_way.line, _enabled && _style.context, _style.surroundings, _style.softness,
                      _style.contextReach};
    if (_context == now) return;
    _context = now;
    const std::vector<osg::Vec2d>& line = _way.line;
    if (line.empty() || !now.on)
    {
        pool(CONTEXT_MASKED).clear();
        pool(CONTEXT_BEYOND).clear();
        return;
    }
    osg::Vec2d low = line.front();
    osg::Vec2d high = low;
    for (const osg::Vec2d& point : line)
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
    if (_way.line.size() == 1) draw(_way.line[0], _way.line[0]);
    for (std::size_t i = 0; i < _legs.size(); ++i)
    {
        // In short parts: slanting ones have large boxes.
        const osg::Vec2d leg = _way.line[i + 1] - _way.line[i];
        const int parts = static_cast<int>(std::ceil(leg.length() / (2.0 * reach)));
        for (int part = 0; part < parts; ++part)
            draw(_way.line[i] + leg * (part / static_cast<double>(parts)),
                 _way.line[i] + leg * ((part + 1) / static_cast<double>(parts)));
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
    for (std::size_t i = 0; i < _legs.size(); ++i)
    {
        const osg::Vec2d leg = _way.line[i + 1] - _way.line[i];
        const double legLength = leg.length();
        const bool more = i + 1 < _legs.size();
        if (!dashed)
        {
            result.push_back({_legs[i], _way.line[i], _way.line[i + 1], more});
            continue;
        }
        const auto at = [&](double metres)
        {
            return _way.line[i] + leg * (std::clamp(metres, 0.0, legLength) / legLength);
        };
        for (double start = -phase; start < legLength; start += period)
        {
            const double end = start + _style.dash;
            if (end > 1e-6) result.push_back({_legs[i], at(start), at(end), more && end > legLength});
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

void RouteMapping::makeLine()
{
    for (const Role role : {CASING, LINE, LINE_HIGHLIGHTED})
        pool(role).rewind();
    const double outer = _style.halfWidth + _style.casing;
    if (_enabled && _style.halfWidth > 0.0)
    {
        const std::vector<Piece> all = pieces();
        const auto roleOf = [&](const Piece& piece)
        {
            return highlighted() == piece.leg ? LINE_HIGHLIGHTED : LINE;
        };
        for (const Piece& piece : all)
        {
            addStrip(roleOf(piece), piece.from, piece.to, _style.halfWidth);
            if (piece.join) addDisc(roleOf(piece), piece.to, _style.halfWidth);
        }
        for (std::size_t i = 0; i < _legs.size() && _style.casing > 0.0; ++i)
            addStrip(CASING, _way.line[i], _way.line[i + 1], outer);
        // Both ends are round, too.
        for (std::size_t i = 0; i < _way.line.size() && !_legs.empty() && _style.casing > 0.0; ++i)
            addDisc(CASING, _way.line[i], outer);
        if (!all.empty())
        {
            addDisc(roleOf(all.front()), all.front().from, _style.halfWidth);
            if ((all.back().to - _way.line.back()).length() < 1e-6)
                addDisc(roleOf(all.back()), all.back().to, _style.halfWidth);
        }
    }
    for (const Role role : {CASING, LINE, LINE_HIGHLIGHTED})
        pool(role).trim();
}

void RouteMapping::makePoints()
{
    pool(POINTS).rewind();
    const double half = _style.pointRadius / markReach;
    for (std::size_t i = 0; i < _way.wayPoints.size() && _enabled && half > 0.0; ++i)
    {
        ProjectiveMapping& mapping = pool(POINTS).next();
        DataLayer* mark = _ownMark ? _ownMark.get() : _mark.get();
        if (mapping.getLayer() != mark) mapping.setLayer(mark);
        mapping.setRectangle(_way.line[_way.wayPoints[i]], half, half);
        mapping.setSizeInPixels(_style.pointPixels);
        mapping.setTurned(_ownMark.valid());
    }
    pool(POINTS).trim();
}

} // namespace osgGeoFX
