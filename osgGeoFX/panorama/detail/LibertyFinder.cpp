// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/LibertyFinder.h>

#include <osgGeoFX/effect/detail/LibertyInverse.h>

#include <cstdio>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// What the full strength takes: painters make a summit half again as high, a valley half again as wide.
constexpr double mostEnlarge = 0.5, mostWiden = 0.6;
const double mostTurn = osg::DegreesToRadians(20.0);
/// Less is not seen.
constexpr double leastEnlarge = 0.05, leastWiden = 0.08;
const double leastTurn = osg::DegreesToRadians(4.0);
/// A mountain looks small if it takes less than this of the picture's height.
constexpr double suitableSize = 0.24;
/// Summits below this share of the highest prominence are no landmarks; and none that is worth a turn.
constexpr double landmark = 0.04, turnedLandmark = 0.1;
constexpr std::size_t mostSummits = 3;
/// A mountain this much longer than wide has a broad side; which looks away if its length is so far from the picture's.
constexpr double leastLonger = 1.3;
const double looksAway = osg::DegreesToRadians(30.0), looksHere = osg::DegreesToRadians(10.0);
/// Half the longest and shortest side of a region about a summit, in view radii; and how far beside the picture one may reach.
constexpr double largestRegion = 0.5, leastRegion = 0.3, besidePicture = 1.1;
/// Tips stay so far below the sky's lower half, of the sky.
constexpr double tipMargin = 0.02;
/// A valley's sides are looked for so far from its middle, in view radii; and one is narrow below this width.
constexpr double valleySide = 0.25, narrowValley = 0.16;
/// The least depth of a valley, of the relief; and the share of its floor that is too much to be hidden.
constexpr double leastDepth = 0.1, muchHidden = 0.3, mostHidden = 0.7;
constexpr int rings = 24, directions = 48, valleySamples = 9;

double nothing()
{
    return std::numeric_limits<double>::quiet_NaN();
}

std::string whole(double number)
{
    const auto metres = static_cast<long long>(std::llround(std::abs(number)));
    char text[64];
    if (metres >= 1000)
        std::snprintf(text, sizeof(text), "%s%lld,%03lld", number < 0.0 ? "-" : "", metres / 1000,
                      metres % 1000);
    else
        std::snprintf(text, sizeof(text), "%s%lld", number < 0.0 && metres > 0 ? "-" : "", metres);
    return text;
}

std::string lengthOf(double metres)
{
    char text[64];
    std::snprintf(text, sizeof(text),
                  metres < 950.0    ? "%.0f m"
                  : metres < 9500.0 ? "%.1f km"
                                    : "%.0f km",
                  metres < 950.0 ? metres : metres / 1000.0);
    return text;
}

std::string placeOf(const osg::Vec2d& place, bool geocentric)
{
    char text[80];
    std::snprintf(text, sizeof(text), geocentric ? "%.2f, %.2f" : "%.0f, %.0f", place.x(), place.y());
    return text;
}

double rounded(double value, double step)
{
    return std::round(value / step) * step;
}

/// The height of a relief at a place, between its cells; NaN where there is no ground.
double heightAt(const TerrainRelief& relief, const osg::Vec2d& place)
{
    const double x = (place.x() - relief.west) / (relief.east - relief.west) * relief.columns - 0.5;
    const double y = (place.y() - relief.south) / (relief.north - relief.south) * relief.rows - 0.5;
    if (!(x >= -0.5 && y >= -0.5 && x <= relief.columns - 0.5 && y <= relief.rows - 0.5)) return nothing();
    const int column = std::clamp(static_cast<int>(std::floor(x)), 0, std::max(relief.columns - 2, 0));
    const int row = std::clamp(static_cast<int>(std::floor(y)), 0, std::max(relief.rows - 2, 0));
    const double u = std::clamp(x - column, 0.0, 1.0), v = std::clamp(y - row, 0.0, 1.0);
    const auto at = [&](int c, int r)
    {
        return static_cast<double>(
            relief.heights[relief.index(std::min(c, relief.columns - 1), std::min(r, relief.rows - 1))]);
    };
    return (at(column, row) * (1.0 - u) + at(column + 1, row) * u) * (1.0 - v) +
           (at(column, row + 1) * (1.0 - u) + at(column + 1, row + 1) * u) * v;
}

std::size_t cellAt(const TerrainRelief& relief, const osg::Vec2d& place)
{
    const double x = (place.x() - relief.west) / (relief.east - relief.west) * relief.columns;
    const double y = (place.y() - relief.south) / (relief.north - relief.south) * relief.rows;
    return relief.index(std::clamp(static_cast<int>(std::floor(x)), 0, relief.columns - 1),
                        std::clamp(static_cast<int>(std::floor(y)), 0, relief.rows - 1));
}

/// Between places of a relief and a liberty's own, in half widths.
class Region
{
public:
    Region(const TerrainRelief& relief, const PanoramaLiberty& liberty)
        : _liberty(liberty), _unit(relief.metre(liberty.place.y())), _sine(std::sin(liberty.heading)),
          _cosine(std::cos(liberty.heading))
    {
    }

    osg::Vec2d of(const osg::Vec2d& place) const
    {
        const double east = (place.x() - _liberty.place.x()) / _unit.x();
        const double north = (place.y() - _liberty.place.y()) / _unit.y();
        return {(east * _cosine - north * _sine) / _liberty.across,
                (east * _sine + north * _cosine) / _liberty.along};
    }
    osg::Vec2d at(const osg::Vec2d& local) const
    {
        const double x = local.x() * _liberty.across, y = local.y() * _liberty.along;
        return {_liberty.place.x() + (x * _cosine + y * _sine) * _unit.x(),
                _liberty.place.y() + (y * _cosine - x * _sine) * _unit.y()};
    }
    /// Calls `action(cell, column, row, local)` for the cells within.
    template<class Action>
    void forCells(const TerrainRelief& relief, const Action& action) const
    {
        const double reach = std::max(_liberty.across, _liberty.along);
        const auto range =
            [](double middle, double half, double low, double high, int count, int& first, int& last)
        {
            const double scale = count / (high - low);
            first = static_cast<int>(std::clamp(std::floor((middle - half - low) * scale), 0.0, count - 1.0));
            last = static_cast<int>(std::clamp(std::ceil((middle + half - low) * scale), 0.0, count - 1.0));
        };
        int left = 0, right = 0, bottom = 0, top = 0;
        range(_liberty.place.x(), reach * _unit.x(), relief.west, relief.east, relief.columns, left, right);
        range(_liberty.place.y(), reach * _unit.y(), relief.south, relief.north, relief.rows, bottom, top);
        for (int row = bottom; row <= top; ++row)
        {
            for (int column = left; column <= right; ++column)
            {
                const osg::Vec2d local = of(relief.place(column, row));
                if (local.length2() < 1.0) action(relief.index(column, row), column, row, local);
            }
        }
    }

private:
    const PanoramaLiberty& _liberty;
    osg::Vec2d _unit;
    double _sine, _cosine;
};

} // namespace

glsl::geofx_Liberty movementsOf(const PanoramaLiberty& liberty)
{
    glsl::geofx_Liberty view{};
    view.across = {1.0, 0.0, 0.0};
    view.along = {0.0, 1.0, 0.0};
    view.up = {0.0, 0.0, 1.0};
    view.acrossRadius = liberty.across;
    view.alongRadius = liberty.along;
    view.base = liberty.baseHeight;
    view.enlarge = liberty.enlarge - 1.0;
    view.widen = liberty.widen - 1.0;
    view.lengthen = liberty.lengthen - 1.0;
    view.turn = liberty.turn;
    return view;
}

void take(const PanoramaLiberty& liberty, TerrainRelief& relief)
{
    const TerrainRelief before = relief;
    const glsl::geofx_Liberty view = movementsOf(liberty);
    const Region region(relief, liberty);
    region.forCells(before,
                    [&](std::size_t cell, int, int, const osg::Vec2d& local)
                    {
                        const glm::dvec3 own =
                            undoneLiberty(view, {local.x() * liberty.across, local.y() * liberty.along,
                                                 liberty.baseHeight});
                        const osg::Vec2d from = region.at({own.x / liberty.across, own.y / liberty.along});
                        const double height = heightAt(before, from);
                        if (std::isnan(height)) return;
                        const glm::dvec3 way = glsl::geofx_libertyWay(view, {own.x, own.y, height});
                        relief.heights[cell] = static_cast<float>(height + way.z);
                        relief.water[cell] = before.water[cellAt(before, from)];
                    });
}

LibertyFinder::LibertyFinder(const TerrainRelief& relief, const ReliefWorth& worth,
                             const PanoramaComposition& view, double aspect, double strength)
    : _relief(relief), _worth(worth), _view(view), _curve(view, aspect), _place(relief, view),
      _strength(std::clamp(strength, 0.0, 1.0))
{
}

double LibertyFinder::height(double x, double s) const
{
    return heightAt(_relief, _place.at(x, s));
}

double LibertyFinder::tip(double x, double s, double height) const
{
    return _curve.foot(x / _curve.radius, s) + _curve.lifted(height, s);
}

bool LibertyFinder::isSeen(double x, double s, double height) const
{
    constexpr int steps = 96;
    const double own = tip(x, s, height);
    if (std::abs(x) >= _curve.radius || s <= 0.0 || s >= _curve.end || own > 1.0) return false;
    // Not what belongs to the place itself.
    const double last = s - 0.03 * _curve.radius;
    for (int i = 0; i < steps; ++i)
    {
        const double before = -_curve.radius + (last + _curve.radius) * (i + 0.5) / steps;
        const double there = this->height(x, before);
        if (!std::isnan(there) && tip(x, before, there) > own) return false;
    }
    return true;
}

/// Neither the end of the data nor ground that the program did not build comes near.
bool LibertyFinder::fits(const PanoramaLiberty& liberty) const
{
    const Region region(_relief, liberty);
    for (int i = 0; i < directions; ++i)
    {
        const double angle = 2.0 * osg::PI * i / directions;
        const osg::Vec2d place = region.at({1.02 * std::cos(angle), 1.02 * std::sin(angle)});
        const osg::Vec2d at = _place.of(place);
        if (std::isnan(heightAt(_relief, place)) || std::abs(at.x()) > besidePicture * _curve.radius ||
            at.y() < -0.5 * _curve.radius || at.y() > _curve.end)
            return false;
    }
    bool whole = true;
    region.forCells(_relief, [&](std::size_t cell, int, int, const osg::Vec2d&)
                    { whole = whole && !std::isnan(_relief.heights[cell]); });
    return whole;
}

std::optional<LibertyFinder::Mountain> LibertyFinder::mountainAt(const ReliefSummit& summit) const
{
    const osg::Vec2d at = _place.of(summit.place);
    const double farthest = largestRegion * _curve.radius;
    // The mean heights of circles around the summit. At its foot they have fallen by three quarters.
    std::vector<double> means;
    double lowest = HUGE_VAL;
    for (int ring = 1; ring <= rings; ++ring)
    {
        double sum = 0.0;
        int count = 0;
        for (int i = 0; i < directions; ++i)
        {
            const double angle = 2.0 * osg::PI * i / directions, away = farthest * ring / rings;
            const double there = height(at.x() + away * std::cos(angle), at.y() + away * std::sin(angle));
            if (!std::isnan(there)) sum += there, ++count;
        }
        if (2 * count < directions) break;
        means.push_back(sum / count);
        lowest = std::min(lowest, means.back());
    }
    if (means.size() < 4 || !(lowest < summit.height)) return std::nullopt;
    const double foot = summit.height - 0.75 * (summit.height - lowest);
    const auto first = std::find_if(means.begin(), means.end(), [&](double mean) { return mean <= foot; });
    Mountain mountain;
    const double reach = farthest * static_cast<double>(first - means.begin() + 1) / rings;
    // A region much smaller than what is seen beside it would look like a tower.
    mountain.radius = std::clamp(2.0 * reach, leastRegion * _curve.radius, farthest);

    // Lakes and the sea must stay level: if there is water, its height stays. Else that of the lowest tenth.
    PanoramaLiberty region;
    region.place = summit.place;
    region.across = region.along = mountain.radius;
    std::vector<float> all;
    std::vector<float> water;
    double xx = 0.0, xs = 0.0, ss = 0.0;
    Region(_relief, region)
        .forCells(_relief,
                  [&](std::size_t cell, int column, int row, const osg::Vec2d& local)
                  {
                      const float there = _relief.heights[cell];
                      if (std::isnan(there)) return;
                      all.push_back(there);
                      if (_relief.water[cell]) water.push_back(there);
                      const double above = static_cast<double>(there) - foot;
                      if (above <= 0.0) return;
                      const osg::Vec2d away = _place.of(_relief.place(column, row)) - at;
                      const double weight = above * glsl::geofx_libertyShare(local.length2());
                      xx += weight * away.x() * away.x();
                      xs += weight * away.x() * away.y();
                      ss += weight * away.y() * away.y();
                  });
    if (all.size() < 20) return std::nullopt;
    std::vector<float>& level = water.size() * 200 > all.size() ? water : all;
    const auto place = static_cast<std::ptrdiff_t>(level.size() * (&level == &water ? 5 : 1) / 10);
    std::nth_element(level.begin(), level.begin() + place, level.end());
    mountain.foot = static_cast<double>(level[static_cast<std::size_t>(place)]);
    const double mean = 0.5 * (xx + ss), spread = std::hypot(0.5 * (xx - ss), xs);
    mountain.longer = std::sqrt((mean + spread) / std::max(mean - spread, 1e-9 * mean + 1e-30));
    mountain.axis = 0.5 * std::atan2(2.0 * xs, xx - ss);
    return mountain;
}

/// How much of a wish keeps every tip of the region in the sky's lower half.
double LibertyFinder::mostEnlarged(const PanoramaLiberty& liberty, double wanted) const
{
    const double limit = _view.horizonLine + (tipInSky - tipMargin) * (1.0 - _view.horizonLine);
    double most = wanted;
    Region(_relief, liberty)
        .forCells(_relief,
                  [&](std::size_t cell, int column, int row, const osg::Vec2d& local)
                  {
                      const auto there = static_cast<double>(_relief.heights[cell]);
                      const osg::Vec2d at = _place.of(_relief.place(column, row));
                      if (std::isnan(there) || at.y() >= _curve.end) return;
                      const double now = tip(at.x(), at.y(), there);
                      const double gain =
                          _curve.exaggeration(at.y()) *
                          (_curve.raised(there, at.y()) - _curve.raised(liberty.baseHeight, at.y())) *
                          glsl::geofx_libertyShare(local.length2());
                      if (gain > 1e-9) most = std::min(most, std::max(limit - now, 0.0) / gain);
                  });
    return most;
}

std::optional<PanoramaLiberty> LibertyFinder::enlarged(const ReliefSummit& summit,
                                                       const Mountain& mountain) const
{
    const osg::Vec2d at = _place.of(summit.place);
    const double size = tip(at.x(), at.y(), summit.height) - tip(at.x(), at.y(), mountain.foot);
    if (!(size > 1e-3)) return std::nullopt;
    PanoramaLiberty liberty;
    liberty.place = summit.place;
    liberty.across = liberty.along = mountain.radius;
    liberty.baseHeight = std::round(mountain.foot);
    const double wanted = std::clamp(suitableSize / size - 1.0, 0.0, mostEnlarge) * _strength;
    // Rounded down, so that tips stay where they may.
    const double gain = std::floor(100.0 * mostEnlarged(liberty, wanted)) / 100.0;
    if (gain < leastEnlarge) return std::nullopt;
    liberty.enlarge = 1.0 + gain;
    char factor[32];
    std::snprintf(factor, sizeof(factor), "%.2f", liberty.enlarge);
    char share[32];
    std::snprintf(share, sizeof(share), "%.0f", 100.0 * size);
    liberty.why = "The summit at " + placeOf(summit.place, _relief.geocentric) + " (" + whole(summit.height) +
                  " m) is enlarged by " + factor + " within " + lengthOf(mountain.radius) +
                  ", since it is one of the most prominent in sight and stands low in its part of the "
                  "picture: it takes " +
                  share + " % of the picture's height. What lies at " + whole(liberty.baseHeight) +
                  " m stays.";
    return liberty;
}

std::optional<PanoramaLiberty> LibertyFinder::turned(const ReliefSummit& summit,
                                                     const Mountain& mountain) const
{
    if (mountain.longer < leastLonger || std::abs(mountain.axis) < looksAway) return std::nullopt;
    PanoramaLiberty liberty;
    liberty.place = summit.place;
    liberty.across = liberty.along = mountain.radius;
    liberty.baseHeight = std::round(mountain.foot);
    const double turn = std::min(mostTurn * _strength, std::abs(mountain.axis) - looksHere);
    const double degrees = std::floor(osg::RadiansToDegrees(turn));
    if (osg::DegreesToRadians(degrees) < leastTurn) return std::nullopt;
    liberty.turn = std::copysign(osg::DegreesToRadians(degrees), mountain.axis);
    char text[32];
    std::snprintf(text, sizeof(text), "%.0f", degrees);
    char away[32];
    std::snprintf(away, sizeof(away), "%.0f", osg::RadiansToDegrees(std::abs(mountain.axis)));
    liberty.why = "The mountain at " + placeOf(summit.place, _relief.geocentric) + " (" +
                  whole(summit.height) + " m) is turned by " + text + " degrees " +
                  (liberty.turn > 0.0 ? "clockwise" : "counterclockwise") + " within " +
                  lengthOf(mountain.radius) + ", since its broad side looks " + away +
                  " degrees past the viewer.";
    return liberty;
}

std::optional<LibertyFinder::Valley> LibertyFinder::valleyAt(double x, double s, double angle) const
{
    Valley valley;
    valley.x = x;
    valley.s = s;
    valley.angle = angle;
    valley.half = std::min(0.42 * _curve.radius, 0.28 * _curve.horizon);
    const double sine = std::sin(angle), cosine = std::cos(angle), side = valleySide * _curve.radius;
    constexpr int steps = 20;
    double sum = 0.0, squares = 0.0, least = HUGE_VAL;
    for (int i = 0; i < valleySamples; ++i)
    {
        const double along = valley.half * (2.0 * i / (valleySamples - 1) - 1.0);
        double line[2 * steps + 1];
        for (int k = -steps; k <= steps; ++k)
        {
            const double across = side * k / steps;
            line[k + steps] = height(x + along * sine + across * cosine, s + along * cosine - across * sine);
            if (std::isnan(line[k + steps])) return std::nullopt;
        }
        // The floor winds a little.
        const double* const floor = std::min_element(line + steps - 4, line + steps + 5);
        const double left = *std::max_element(line, line + steps),
                     right = *std::max_element(line + steps + 1, line + 2 * steps + 1);
        const double depth = std::min(left, right) - *floor;
        if (depth <= 0.0) return std::nullopt;
        const auto above = [&](double each)
        {
            return each > *floor + 0.5 * depth;
        };
        const double* const rightEnd =
            std::find_if(floor, static_cast<const double*>(line + 2 * steps + 1), above);
        const double* leftEnd = floor;
        while (leftEnd > line && !above(*leftEnd))
            --leftEnd;
        valley.width += static_cast<double>(rightEnd - leftEnd) * side / steps / valleySamples;
        valley.depth += depth / valleySamples;
        least = std::min(least, depth);
        sum += *floor;
        squares += *floor * *floor;
        const double across = side * static_cast<double>(floor - line - steps) / steps;
        if (!isSeen(x + along * sine + across * cosine, s + along * cosine - across * sine, *floor))
            valley.hidden += 1.0 / valleySamples;
    }
    const double relief = std::max(_worth.highest - _worth.lowest, 1.0);
    if (valley.depth < leastDepth * relief || least < 0.35 * valley.depth) return std::nullopt;
    const double mean = sum / valleySamples;
    const double uneven = std::sqrt(std::max(squares / valleySamples - mean * mean, 0.0)) / valley.depth;
    // What is not seen at all gains nothing.
    if (valley.hidden > mostHidden) return std::nullopt;
    valley.worth = valley.depth / relief * cosine * (1.0 - 0.5 * std::abs(x) / _curve.radius) *
                   std::max(1.0 - uneven, 0.0);
    return valley;
}

std::optional<PanoramaLiberty> LibertyFinder::widened() const
{
    std::optional<Valley> best;
    for (double s = 0.3 * _curve.radius; s < 0.7 * _curve.horizon; s += 0.12 * _curve.radius)
    {
        for (int column = -7; column <= 7; ++column)
        {
            for (int turn = -4; turn <= 4; ++turn)
            {
                const std::optional<Valley> valley =
                    valleyAt(0.1 * column * _curve.radius, s, osg::DegreesToRadians(11.0 * turn));
                if (valley && (!best || valley->worth > best->worth)) best = valley;
            }
        }
    }
    if (!best) return std::nullopt;
    const bool narrow = best->width < narrowValley * _curve.radius;
    const bool hidden = best->hidden > muchHidden;
    if (!narrow && !hidden) return std::nullopt;
    PanoramaLiberty liberty;
    liberty.place = _place.at(best->x, best->s);
    liberty.heading = std::remainder(_view.heading + best->angle, 2.0 * osg::PI);
    // The sides are within, and its ridges near the border, where they hardly move.
    liberty.across =
        std::min(std::max(1.5 * best->width, 0.15 * _curve.radius), largestRegion * _curve.radius);
    liberty.along = 1.25 * best->half;
    liberty.widen = 1.0 + rounded(mostWiden * _strength, 0.01);
    if (liberty.widen < 1.0 + leastWiden) return std::nullopt;
    char factor[32];
    std::snprintf(factor, sizeof(factor), "%.2f", liberty.widen);
    char share[96];
    std::snprintf(share, sizeof(share), "mountains hide %.0f %% of its floor", 100.0 * best->hidden);
    liberty.why =
        "The valley at " + placeOf(liberty.place, _relief.geocentric) + " is widened by " + factor +
        " over " + lengthOf(2.0 * best->half) + ", since it leads into the picture and " +
        (narrow ? "is narrow, " + lengthOf(best->width) + " half way up its sides" : std::string()) +
        (narrow && hidden ? ", and " : "") + (hidden ? share : "") + ".";
    return liberty;
}

std::vector<PanoramaLiberty> LibertyFinder::found() const
{
    std::vector<PanoramaLiberty> result;
    if (_strength <= 0.0 || !(_worth.highest > _worth.lowest)) return result;
    std::optional<PanoramaLiberty> turn;
    for (const ReliefSummit& summit : _worth.summits)
    {
        if (summit.weight < landmark) break;
        const osg::Vec2d at = _place.of(summit.place);
        if (std::abs(at.x()) > 0.92 * _curve.radius || !isSeen(at.x(), at.y(), summit.height)) continue;
        // A mountain that has a summit already needs no other.
        const bool taken = std::any_of(result.begin(), result.end(),
                                       [&](const PanoramaLiberty& other) {
                                           return (_place.of(other.place) - at).length() < 0.9 * other.across;
                                       });
        std::optional<Mountain> mountain = mountainAt(summit);
        if (!mountain || taken) continue;
        // Smaller where the whole mountain reaches too far.
        for (int i = 0; i < 3; ++i)
        {
            PanoramaLiberty region;
            region.place = summit.place;
            region.across = region.along = mountain->radius;
            if (fits(region)) break;
            mountain->radius *= i < 2 ? 0.8 : 0.0;
        }
        if (mountain->radius <= 0.0) continue;
        if (!turn && summit.weight >= turnedLandmark) turn = turned(summit, *mountain);
        if (result.size() == mostSummits) continue;
        if (const std::optional<PanoramaLiberty> one = enlarged(summit, *mountain)) result.push_back(*one);
    }
    const std::optional<PanoramaLiberty> valley = widened();
    if (valley && fits(*valley)) result.push_back(*valley);
    if (turn) result.push_back(*turn);
    return result;
}

} // namespace osgGeoFX
