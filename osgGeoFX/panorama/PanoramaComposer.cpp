// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaComposer.h>

#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/LibertyFinder.h>
#include <osgGeoFX/panorama/detail/PictureCurve.h>
#include <osgGeoFX/panorama/detail/ReliefWorth.h>

#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <random>

namespace osgGeoFX
{

namespace
{

/// Land is not drawn so much higher than it is that a tenth of it would be steeper than this.
constexpr double mostSlope = 1.6;
/// An exaggeration suits a terrain if a tenth of the land then seems steeper than this.
constexpr double suitableSlope = 0.9;
constexpr double leastExaggeration = 0.3, modestExaggeration = 1.2, mostExaggeration = 6.0;
constexpr double leastSuitable = 1.0, mostSuitable = 4.0;
/// The share of water in the picture that is not too much.
constexpr double muchWater = 0.45;
/// So much of a picture may lie beyond the data before a view is changed.
constexpr double littleBlank = 0.0003;
/// Liberties may hide so much more of the picture's ground, and of the summits.
constexpr double littleHidden = 0.03;
/// Columns and steps of a judgement.
constexpr int fineColumns = 96, fineSteps = 192;
/// Horizons are no lower and no higher in the picture.
constexpr double lowestLine = 0.64, highestLine = 0.84;
constexpr double leastSky = 0.12, mostSky = 0.30;
/// Where a wish for a focus puts it, of the horizon's distance.
constexpr double focusAt = 0.4;
/// The horizon of a map lies no farther than 60 degrees of arc.
constexpr double farthest = 6e6;

/// What lies at a place of the terrain.
struct Sample
{
    double height = 0.0, worth = 0.0;
    bool ground = false, water = false;
};

/// Walks over a relief as the columns of a picture do, from its base to its horizon.
class Walk
{
public:
    Walk(const TerrainRelief& relief, const ReliefWorth& worth, int columns, int steps)
        : _relief(relief), _worth(worth), _columns(columns), _steps(steps),
          _columnsPerUnit(relief.columns / (relief.east - relief.west)),
          _rowsPerUnit(relief.rows / (relief.north - relief.south))
    {
        const osg::Vec2d size = relief.size();
        _cellSize = std::min(size.x() / relief.columns, size.y() / relief.rows);
        _cells.reserve(relief.heights.size());
        for (std::size_t i = 0; i < relief.heights.size(); ++i)
            _cells.push_back({relief.heights[i], worth.inside[i], worth.worth[i], relief.water[i] != 0});
    }

    /// Whether most of the picture's rectangle has ground; for a first choice among many views.
    bool hasGround(const PanoramaComposition& view) const
    {
        const PicturePlace place(_relief, view);
        int ground = 0;
        for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0})
        {
            for (const double x : {-0.95, -0.5, 0.0, 0.5, 0.95})
            {
                const osg::Vec2d there =
                    place.at(x * view.viewRadius, s * view.horizonDistance * view.viewRadius);
                ground += at(there, 0.0).ground ? 1 : 0;
            }
        }
        return ground >= 22;
    }

    /// The height that lies on the curve: the lowest of the ground along the picture's base.
    double baseOf(const PanoramaComposition& view) const
    {
        double lowest = HUGE_VAL;
        const PicturePlace place(_relief, view);
        for (int step = 0; step < 8; ++step)
        {
            for (int column = 0; column < _columns; ++column)
            {
                const Sample sample =
                    at(place.at(xOf(column) * view.viewRadius, 0.5 * step / 8.0 * view.viewRadius), 0.0);
                if (sample.ground) lowest = std::min(lowest, sample.height);
            }
        }
        return std::isfinite(lowest) ? lowest : _worth.lowest;
    }

    /// The exaggeration that puts the tip of the highest summit into the sky's lower half, within reason.
    double exaggerationOf(const PanoramaComposition& view, double aspect, double steep) const
    {
        const PictureCurve curve(view, aspect);
        const double tip = view.horizonLine + tipInSky * (1.0 - view.horizonLine);
        double most = std::clamp(mostSlope / std::max(steep, 1e-3), modestExaggeration, mostExaggeration);
        const std::vector<double> dips = dipsOf(curve);
        const auto fit = [&](double dip, const PictureCurve::Reach& there, double height)
        {
            const double part = there.share;
            const double raised = curve.raised(height, there);
            const double room = tip - curve.foot(dip, there) - part * curve.far * raised;
            if ((1.0 - part) * raised > 1e-6) most = std::min(most, room / ((1.0 - part) * raised));
        };
        const PicturePlace place(_relief, view);
        for (int step = 0; step < _steps; ++step)
        {
            const double s = curve.end * (step + 0.5) / _steps;
            const PictureCurve::Reach there = curve.at(s);
            for (int column = 0; column < _columns; ++column)
            {
                const Sample sample = at(place.at(xOf(column) * view.viewRadius, s), 0.0);
                if (sample.ground) fit(dips[static_cast<std::size_t>(column)], there, sample.height);
            }
        }
        for (const ReliefSummit& summit : _worth.summits)
        {
            const osg::Vec2d at = place.of(summit.place);
            const double x = at.x() / view.viewRadius;
            if (std::abs(x) < 1.0 && at.y() > 0.0 && at.y() < curve.end)
                fit(curve.dip(x), curve.at(at.y()), summit.height);
        }
        return std::max(most, leastExaggeration);
    }

    PanoramaJudgement judge(const PanoramaComposition& view, double aspect) const
    {
        const PictureCurve curve(view, aspect);
        const PicturePlace place(_relief, view);
        PanoramaJudgement result;
        double shown = 0.0, worth = 0.0, water = 0.0, walked = 0.0, seen = 0.0, blank = 0.0, sky = 0.0,
               cut = 0.0;
        double skylines = 0.0, squares = 0.0, covered = 0.0;
        double nearHeight = 0.0, nearCount = 0.0, farHeight = 0.0, farCount = 0.0;
        const double stretch = curve.end + curve.before;
        const double stepArea = (stretch / _steps) * (2.0 * curve.radius / _columns);
        // The same in all columns.
        struct Step
        {
            double s, area;
            PictureCurve::Reach reach;
        };
        std::vector<Step> steps;
        for (int step = 0; step < _steps; ++step)
        {
            const double s = stretch * (step + 0.5) / _steps - curve.before;
            steps.push_back({s, stepArea * curve.widening(s), curve.at(s)});
        }
        std::vector<float> tops(static_cast<std::size_t>(_columns) * static_cast<std::size_t>(_steps));
        for (int column = 0; column < _columns; ++column)
        {
            const double x = xOf(column), dip = curve.dip(x);
            double top = 0.0, known = view.baseHeight;
            bool begun = false; // Where the ground begins above the picture's base, what lies below is blank.
            for (int step = 0; step < _steps; ++step)
            {
                const auto& [s, ground, there] = steps[static_cast<std::size_t>(step)];
                const Sample sample = at(place.at(x * curve.radius, s), view.edgeWidth * curve.radius);
                if (sample.ground) known = sample.height;
                const double y = curve.foot(dip, there) + curve.lifted(known, there);
                const double area = std::min(y, 1.0) - top;
                const bool inPicture = s >= 0.0 && s < curve.horizon;
                walked += inPicture ? 1.0 : 0.0;
                if (area > 0.0)
                {
                    top = std::min(y, 1.0);
                    if (!sample.ground || !begun)
                    {
                        // Beyond the horizon only what rises above it is seen.
                        if (s < curve.horizon) blank += area;
                    }
                    else
                    {
                        shown += area;
                        worth += area * sample.worth;
                        covered += sample.worth * ground;
                        if (sample.water) water += area;
                        const double height = area * sample.height;
                        if (top < 0.35 * view.horizonLine) nearHeight += height, nearCount += area;
                        if (s > 0.6 * curve.horizon) farHeight += height, farCount += area;
                    }
                    seen += inPicture ? 1.0 : 0.0;
                }
                begun = begun || sample.ground;
                if (y > 1.0) cut += 1.0 / _steps;
                tops[static_cast<std::size_t>(column) * static_cast<std::size_t>(_steps) +
                     static_cast<std::size_t>(step)] = static_cast<float>(top);
                result.top = std::max(result.top, y);
            }
            sky += 1.0 - top;
            skylines += top;
            squares += top * top;
        }
        double weights = 0.0, squaredWeights = 0.0;
        for (const ReliefSummit& summit : _worth.summits)
        {
            const double square = summit.weight * summit.weight;
            weights += summit.weight;
            squaredWeights += square;
            const osg::Vec2d at = place.of(summit.place);
            const double share = seenShare(summit, at, curve, tops, stretch);
            if (!(share > 0.0)) continue;
            result.summits += summit.weight * share;
            const double x = at.x() / curve.radius;
            const double tip = curve.foot(x, at.y()) + curve.lifted(summit.height, at.y());
            const double above = (tip - curve.foot(x, curve.horizon)) / (0.25 * (1.0 - view.horizonLine));
            result.crown +=
                square * std::clamp(above, 0.0, 1.0) * std::clamp((0.95 - std::abs(x)) / 0.4, 0.0, 1.0);
        }
        if (weights > 0.0) result.summits /= weights, result.crown /= squaredWeights;

        const double relief = _worth.highest - _worth.lowest;
        const osg::Vec2d size = _relief.size();
        const double cellArea = size.x() * size.y() / static_cast<double>(_relief.heights.size());
        result.detail = shown > 0.0 ? worth / shown : 0.0;
        result.water = shown > 0.0 ? water / shown : 0.0;
        result.sky = sky / _columns;
        result.blank = blank / _columns;
        result.cut = std::min(cut * 8.0 / _columns, 1.0);
        result.hidden = walked > 0.0 ? 1.0 - seen / walked : 0.0;
        result.coverage = _worth.total > 0.0 ? std::min(covered / (_worth.total * cellArea), 1.0) : 0.0;
        if (relief > 0.0 && nearCount > 0.0 && farCount > 0.0)
            result.rise = (farHeight / farCount - nearHeight / nearCount) / relief;
        const double mean = skylines / _columns;
        const double spread = std::sqrt(std::max(squares / _columns - mean * mean, 0.0));
        result.skyline = std::min(spread / (0.25 * (1.0 - view.horizonLine)), 1.0);
        const double skyFault = std::max({leastSky - result.sky, result.sky - mostSky, 0.0});
        const double suitable =
            std::clamp(suitableSlope / std::max(_worth.steep, 1e-3), leastSuitable, mostSuitable);
        result.flatness = std::max(std::log(suitable / std::max(view.exaggeration, 0.05)), 0.0);
        result.worth = result.detail + result.summits + 1.5 * result.crown + 0.8 * result.rise +
                       0.8 * result.coverage + 0.3 * result.skyline - 10.0 * result.blank -
                       2.0 * std::min(result.blank / 0.005, 1.0) - 3.0 * result.cut - 0.5 * result.hidden -
                       0.8 * std::max(result.water - muchWater, 0.0) - 3.0 * skyFault - 0.6 * result.flatness;
        return result;
    }

private:
    /// What counts of a cell of the relief, together, since a walk goes from cell to cell at random.
    struct Cell
    {
        float height, inside, worth;
        bool water;
    };

    std::vector<double> dipsOf(const PictureCurve& curve) const
    {
        std::vector<double> result;
        for (int column = 0; column < _columns; ++column)
            result.push_back(curve.dip(xOf(column)));
        return result;
    }
    double xOf(int column) const { return (2.0 * column + 1.0) / _columns - 1.0; }

    /// Ground nearer to the end of the data than `margin` does not count.
    Sample at(const osg::Vec2d& place, double margin) const
    {
        const double x = (place.x() - _relief.west) * _columnsPerUnit;
        const double y = (place.y() - _relief.south) * _rowsPerUnit;
        const int column = static_cast<int>(std::min(std::max(0.0, x), _relief.columns - 1.0));
        const int row = static_cast<int>(std::min(std::max(0.0, y), _relief.rows - 1.0));
        const std::size_t cell = _relief.index(column, row);
        const bool outside = x < 0.0 || y < 0.0 || x >= _relief.columns || y >= _relief.rows;
        const Cell& there = _cells[cell];
        const double away = static_cast<double>(there.inside);
        Sample sample;
        if (std::isnan(there.height)) return sample;
        sample.height = static_cast<double>(there.height);
        sample.water = there.water;
        // Beyond a border of sea there is more of it.
        sample.ground = away >= margin && (!outside || (sample.water && away > _cellSize));
        sample.worth = outside ? 0.0 : static_cast<double>(there.worth);
        return sample;
    }

    /// 1 if a summit is in sight and not at the picture's sides; 0 if it is not.
    double seenShare(const ReliefSummit& summit, const osg::Vec2d& at, const PictureCurve& curve,
                     const std::vector<float>& tops, double stretch) const
    {
        const double x = at.x() / curve.radius;
        if (std::abs(x) >= 1.0 || at.y() <= 0.0 || at.y() >= curve.end) return 0.0;
        const int column = std::clamp(static_cast<int>(0.5 * (x + 1.0) * _columns), 0, _columns - 1);
        // Its own foot does not hide it.
        const int step = static_cast<int>((at.y() + curve.before) / stretch * _steps) - 2;
        const double y = curve.foot(x, at.y()) + curve.lifted(summit.height, at.y());
        const double hidden =
            step < 0 ? 0.0
                     : static_cast<double>(
                           tops[static_cast<std::size_t>(column) * static_cast<std::size_t>(_steps) +
                                static_cast<std::size_t>(std::min(step, _steps - 1))]);
        if (y < hidden || y > 1.0) return 0.0;
        return std::clamp((1.0 - std::abs(x)) / 0.15, 0.0, 1.0);
    }

    const TerrainRelief& _relief;
    const ReliefWorth& _worth;
    int _columns, _steps;
    double _columnsPerUnit, _rowsPerUnit; ///< of the relief's cells
    double _cellSize;                     ///< the shorter side, metres
    std::vector<Cell> _cells;
};

const char* directionOf(double heading)
{
    static const std::array<const char*, 16> names = {
        "north",      "north-north-east", "north-east", "east-north-east",  "east",       "east-south-east",
        "south-east", "south-south-east", "south",      "south-south-west", "south-west", "west-south-west",
        "west",       "west-north-west",  "north-west", "north-north-west"};
    const double turn = heading / (2.0 * osg::PI) * static_cast<double>(names.size());
    const long index = std::lround(turn) % static_cast<long>(names.size());
    return names[static_cast<std::size_t>(index < 0 ? index + static_cast<long>(names.size()) : index)];
}

#ifdef __GNUC__
__attribute__((format(printf, 1, 2)))
#endif
std::string
text(const char* format, ...)
{
    char buffer[512];
    va_list values;
    va_start(values, format);
    std::vsnprintf(buffer, sizeof(buffer), format, values);
    va_end(values);
    return buffer;
}

/// A length with a sensible unit.
std::string metres(double length)
{
    return std::abs(length) < 10000.0 ? text("%.0f m", length) : text("%.1f km", length / 1000.0);
}

} // namespace

void PanoramaComposition::applyTo(PanoramaMap& map) const
{
    map.setProjection(true);
    map.setHorizontalAngle(horizontalAngle);
    map.setViewRadius(viewRadius);
    map.setHorizonLine(horizonLine);
    // D2 exceeds D1 at each step.
    map.setCurveDistance(0.0);
    map.setHorizonDistance(horizonDistance);
    map.setCurveDistance(curveDistance);
    map.setHorizonBend(horizonBend);
    map.setExaggeration(exaggeration);
    map.setHorizonExaggeration(horizonExaggeration);
    map.setCurvePoints(curvePoints);
    map.setBaseHeight(baseHeight);
    map.setBaseFromTerrain(false);
    map.setEdgeWidth(edgeWidth);
}

osg::Matrixd PanoramaComposition::viewMatrix(const TerrainRelief& relief) const
{
    osg::Matrixd frame;
    const double height = baseHeight + 2.0 * viewRadius;
    if (relief.geocentric)
        osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
            osg::DegreesToRadians(place.y()), osg::DegreesToRadians(place.x()), height, frame);
    else
        frame.makeTranslate(place.x(), place.y(), height);
    // Only the heading counts; this pitch shows much of the ground where the map is switched off.
    const double pitch = osg::DegreesToRadians(-35.0);
    return osg::Matrixd::inverse(osg::Matrixd::rotate(osg::PI_2 + pitch, osg::X_AXIS) *
                                 osg::Matrixd::rotate(-heading, osg::Z_AXIS) * frame);
}

class PanoramaComposer::Parts
{
public:
    Parts(const TerrainRelief& given, const PanoramaWishes& wished)
        : relief(given), rough(given.coarser(std::max(std::max(given.columns, given.rows) / 128, 1))),
          worth(relief), roughWorth(rough), wishes(wished), finest(relief, worth, fineColumns, fineSteps),
          coarsest(rough, roughWorth, 16, 40), medium(rough, roughWorth, 40, 80)
    {
        wishes.aspect = std::clamp(wishes.aspect, 0.1, 10.0);
        wishes.horizontalAngle = std::clamp(wishes.horizontalAngle, 0.0, 2.0 * osg::PI);
    }

    /// Fills in what follows from a view's place, heading and radius.
    void complete(PanoramaComposition& view, const Walk& walk) const
    {
        view.horizonExaggeration = wishes.horizonExaggeration;
        view.curvePoints = wishes.curvePoints;
        view.baseHeight = walk.baseOf(view);
        view.exaggeration = wishes.exaggeration ? *wishes.exaggeration
                                                : walk.exaggerationOf(view, wishes.aspect, worth.steep);
    }

    /// Whether the wishes leave nothing to choose but what follows from the place.
    bool isFixed() const
    {
        return wishes.heading && wishes.viewRadius && wishes.horizonLine && wishes.horizonDistance &&
               (wishes.place || wishes.focus);
    }
    /// Whether the picture shows so much of the horizon that its sides have little to do with its middle.
    bool isWide() const { return wishes.horizontalAngle > osg::PI_2; }
    std::vector<double> headings() const
    {
        if (wishes.heading) return {*wishes.heading};
        std::vector<double> result;
        // A wide arc shows much the same from any of them.
        const int count = isWide() ? 8 : 24;
        for (int i = 0; i < count; ++i)
            result.push_back(i * 2.0 * osg::PI / count);
        return result;
    }
    std::vector<double> radii() const
    {
        if (wishes.viewRadius) return {*wishes.viewRadius};
        const osg::Vec2d size = relief.size();
        const double side = std::sqrt(size.x() * size.y());
        std::vector<double> result;
        // The ground of a cylindrical map lies all around its place.
        const std::vector<double> shares = wishes.horizontalAngle > 0.0
                                               ? std::vector<double>{0.2, 0.16, 0.13, 0.1, 0.08, 0.06}
                                               : std::vector<double>{0.46, 0.4, 0.34, 0.29, 0.24, 0.2};
        for (const double share : shares)
            result.push_back(std::min(share * side, farthest / 5.0));
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }
    std::vector<double> horizons() const
    {
        if (wishes.horizonLine) return {*wishes.horizonLine};
        return {0.8, 0.74, 0.68};
    }
    std::vector<double> distances() const
    {
        if (wishes.horizonDistance) return {*wishes.horizonDistance};
        if (isWide()) return {1.2, 1.6, 2.2};
        return {2.2, 2.8, 3.6};
    }
    std::vector<osg::Vec2d> places(const PanoramaComposition& view) const
    {
        if (wishes.place) return {*wishes.place};
        if (wishes.focus) return {behind(*wishes.focus, view)};
        std::vector<osg::Vec2d> result;
        constexpr int steps = 9;
        for (int row = 0; row < steps; ++row)
            for (int column = 0; column < steps; ++column)
                result.emplace_back(relief.west + (column + 0.5) / steps * (relief.east - relief.west),
                                    relief.south + (row + 0.5) / steps * (relief.north - relief.south));
        return result;
    }
    /// The base from which a view has a place before it.
    osg::Vec2d behind(const osg::Vec2d& focus, const PanoramaComposition& view) const
    {
        const double ring = view.horizontalAngle > 0.0 ? 2.0 * view.viewRadius / view.horizontalAngle : 0.0;
        const double away = focusAt * view.horizonDistance * view.viewRadius + ring;
        const osg::Vec2d unit = relief.metre(focus.y());
        return {focus.x() - away * std::sin(view.heading) * unit.x(),
                focus.y() - away * std::cos(view.heading) * unit.y()};
    }

    struct Candidate
    {
        PanoramaComposition view;
        double worth;
    };

    void addCandidates(PanoramaComposition view, std::vector<Candidate>& result) const
    {
        for (const double line : horizons())
        {
            view.horizonLine = line;
            complete(view, coarsest);
            const PanoramaJudgement judgement = coarsest.judge(view, wishes.aspect);
            result.push_back({view, judgement.worth});
            // A lower horizon does not bring ground where there is none.
            if (judgement.blank > 0.05) return;
        }
    }

    /// `all`: also those of which much would be blank.
    std::vector<Candidate> candidates(bool all) const
    {
        std::vector<Candidate> result;
        PanoramaComposition view;
        view.horizontalAngle = wishes.horizontalAngle;
        // Horizontals of a whole turn must meet where it ends.
        if (isWide()) view.horizonBend = 0.0;
        for (const double distance : distances())
        {
            view.horizonDistance = distance;
            view.curveDistance = std::min(view.curveDistance, 0.5 * distance);
            for (const double radius : radii())
            {
                view.viewRadius = radius;
                for (const double heading : headings())
                {
                    view.heading = heading;
                    for (const osg::Vec2d& place : places(view))
                    {
                        view.place = place;
                        if (!all && !coarsest.hasGround(view)) continue;
                        addCandidates(view, result);
                    }
                }
            }
        }
        std::stable_sort(result.begin(), result.end(),
                         [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
        return result;
    }

    /// Small steps that improve a view.
    Candidate improved(Candidate best, std::mt19937& random) const
    {
        complete(best.view, medium);
        best.worth = medium.judge(best.view, wishes.aspect).worth;
        const auto step = [&](double size)
        {
            return size *
                   (2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.0);
        };
        for (int i = 0; i < 60; ++i)
        {
            const double scale = i < 30 ? 1.0 : 0.3;
            Candidate next = best;
            const double turn = step(0.2 * scale), zoom = step(0.12 * scale), farther = step(0.4 * scale);
            const double right = step(0.4 * scale), ahead = step(0.4 * scale), higher = step(0.04 * scale);
            if (!wishes.horizonLine)
                next.view.horizonLine = std::clamp(next.view.horizonLine + higher, lowestLine, highestLine);
            if (!wishes.heading) next.view.heading += turn;
            if (!wishes.viewRadius)
                next.view.viewRadius = std::min(next.view.viewRadius * (1.0 + zoom), farthest / 5.0);
            if (!wishes.horizonDistance)
                next.view.horizonDistance =
                    std::clamp(next.view.horizonDistance + farther, isWide() ? 1.0 : 1.8, 4.5);
            if (wishes.focus && !wishes.place)
                next.view.place = behind(*wishes.focus, next.view);
            else if (!wishes.place)
            {
                const osg::Vec2d unit = relief.metre(next.view.place.y());
                const double sine = std::sin(next.view.heading), cosine = std::cos(next.view.heading);
                next.view.place.x() += next.view.viewRadius * (right * cosine + ahead * sine) * unit.x();
                next.view.place.y() += next.view.viewRadius * (ahead * cosine - right * sine) * unit.y();
            }
            complete(next.view, medium);
            next.worth = medium.judge(next.view, wishes.aspect).worth;
            if (next.worth > best.worth) best = next;
        }
        complete(best.view, finest);
        PanoramaJudgement judgement = finest.judge(best.view, wishes.aspect);
        // The coarse relief does not see the last of a border.
        for (int i = 0; i < 10 && judgement.blank > littleBlank && !wishes.viewRadius && !wishes.place; ++i)
        {
            if (!wishes.focus)
            {
                const osg::Vec2d unit = relief.metre(best.view.place.y());
                const double ahead = 0.03 * best.view.viewRadius;
                best.view.place.x() += ahead * std::sin(best.view.heading) * unit.x();
                best.view.place.y() += ahead * std::cos(best.view.heading) * unit.y();
            }
            best.view.viewRadius *= 0.97;
            if (wishes.focus) best.view.place = behind(*wishes.focus, best.view);
            complete(best.view, finest);
            judgement = finest.judge(best.view, wishes.aspect);
        }
        best.worth = judgement.worth;
        return best;
    }

    TerrainRelief relief, rough;
    ReliefWorth worth, roughWorth;
    PanoramaWishes wishes;
    Walk finest, coarsest, medium;
};

PanoramaComposer::PanoramaComposer(const TerrainRelief& relief, const PanoramaWishes& wishes)
    : _parts(std::make_unique<Parts>(relief, wishes))
{
}

PanoramaComposer::~PanoramaComposer() = default;

PanoramaComposition PanoramaComposer::compose() const
{
    std::vector<Parts::Candidate> all = _parts->candidates(false);
    if (all.empty()) all = _parts->candidates(true);
    // The best of different views, so that not all begin at the same hill.
    std::vector<Parts::Candidate> begun;
    for (const Parts::Candidate& candidate : all)
    {
        const bool known =
            std::any_of(begun.begin(), begun.end(),
                        [&](const Parts::Candidate& other)
                        {
                            const double turn =
                                std::remainder(candidate.view.heading - other.view.heading, 2.0 * osg::PI);
                            return std::abs(turn) < 0.3 &&
                                   candidate.view.viewRadius == other.view.viewRadius &&
                                   candidate.view.horizonDistance == other.view.horizonDistance;
                        });
        if (!known) begun.push_back(candidate);
        if (begun.size() == 24) break;
    }
    if (_parts->isFixed())
    {
        PanoramaComposition only = begun.front().view;
        _parts->complete(only, _parts->finest);
        return only;
    }
    std::mt19937 random(1);
    Parts::Candidate best = _parts->improved(begun.front(), random);
    for (std::size_t i = 1; i < begun.size(); ++i)
    {
        const Parts::Candidate next = _parts->improved(begun[i], random);
        if (next.worth > best.worth) best = next;
    }
    best.view.heading = std::remainder(best.view.heading, 2.0 * osg::PI);
    return best.view;
}

PanoramaJudgement PanoramaComposer::judge(const PanoramaComposition& composition) const
{
    return _parts->finest.judge(composition, _parts->wishes.aspect);
}

PanoramaJudgement PanoramaComposer::judge(const PanoramaComposition& composition,
                                          const std::vector<PanoramaLiberty>& liberties) const
{
    TerrainRelief relief = _parts->relief;
    for (const PanoramaLiberty& liberty : liberties)
        take(liberty, relief);
    const ReliefWorth worth(relief);
    return Walk(relief, worth, fineColumns, fineSteps).judge(composition, _parts->wishes.aspect);
}

std::vector<PanoramaLiberty> PanoramaComposer::liberties(const PanoramaComposition& composition,
                                                         double strength) const
{
    const LibertyFinder finder(_parts->relief, _parts->worth, composition, _parts->wishes.aspect, strength);
    std::vector<PanoramaLiberty> taken;
    const PanoramaJudgement before = judge(composition);
    const double sky = std::max({leastSky - before.sky, before.sky - mostSky, 0.0});
    for (const PanoramaLiberty& liberty : finder.found())
    {
        taken.push_back(liberty);
        const PanoramaJudgement now = judge(composition, taken);
        const bool suits = now.cut <= before.cut && now.blank <= before.blank + littleBlank &&
                           now.hidden <= before.hidden + littleHidden &&
                           now.summits >= before.summits - littleHidden &&
                           std::max({leastSky - now.sky, now.sky - mostSky, 0.0}) <= sky + 1e-9;
        if (!suits) taken.pop_back();
    }
    return taken;
}

std::vector<std::string> PanoramaComposer::explain(const PanoramaComposition& view) const
{
    const PanoramaJudgement seen = judge(view);
    const PanoramaWishes& wishes = _parts->wishes;
    const ReliefWorth& worth = _parts->worth;
    std::vector<std::string> lines;
    const char* asked = " (as you asked)";
    lines.push_back(
        text("View: towards the %s (heading %.1f degrees)%s, from lowland to highland: the land below the "
             "horizon is %.0f %% of the relief higher than at the picture's base.",
             directionOf(view.heading), osg::RadiansToDegrees(view.heading), wishes.heading ? asked : "",
             100.0 * seen.rise));
    if (view.horizontalAngle > 0.0)
        lines.push_back(
            text("Around: the picture shows %.0f degrees of the horizon. Its base is a circle of ",
                 osg::RadiansToDegrees(view.horizontalAngle)) +
            metres(2.0 * view.viewRadius / view.horizontalAngle) +
            " around the place, and heights get smaller with the distance as widths do.");
    lines.push_back(
        text("Place: the %s at %.6g, %.6g%s.",
             view.horizontalAngle > 0.0 ? "eye stands above the ground" : "middle of the picture's base is",
             view.place.x(), view.place.y(),
             wishes.place   ? asked
             : wishes.focus ? ", so that your focus lies before it"
                            : ""));
    lines.push_back(
        "Width: " + metres(2.0 * view.viewRadius) + " of ground at the base" +
        (wishes.viewRadius ? asked : "") +
        text("; the picture shows %.0f %% of what is worth seeing, and %.0f %% of the summits by their "
             "prominence.",
             100.0 * seen.coverage, 100.0 * seen.summits));
    lines.push_back("Depth: the horizon (D2) lies " + metres(view.horizonDistance * view.viewRadius) +
                    " away" + (wishes.horizonDistance ? asked : "") +
                    ", the ground begins to curve (D1) after " +
                    metres(view.curveDistance * view.viewRadius) +
                    text("; mountains hide %.0f %% of the ground between.", 100.0 * seen.hidden));
    lines.push_back(text("Horizon: at %.0f %% of the picture's height%s; sky takes %.0f %% of the picture.",
                         100.0 * view.horizonLine, wishes.horizonLine ? asked : "", 100.0 * seen.sky));
    lines.push_back(
        text("Exaggeration: %.2f%s; the highest tip stands at %.0f %% of the picture's height. Heights reach "
             "from %.0f to %.0f m; nine tenths of the land are less steep than %.2f.",
             view.exaggeration, wishes.exaggeration ? asked : "", 100.0 * seen.top, worth.lowest,
             worth.highest, worth.steep));
    lines.push_back(text("Base: %.0f m, the lowest ground along the picture's base, lies on the curve.",
                         view.baseHeight));
    lines.push_back(
        seen.blank > 0.002
            ? text("Edges: %.1f %% of the picture lie beyond the data, since no better view avoids it.",
                   100.0 * seen.blank)
            : std::string("Edges: none of the data's edges is in the picture."));
    if (seen.cut > 0.0)
        lines.emplace_back("Summits go beyond the picture's upper edge; lower the exaggeration.");
    return lines;
}

} // namespace osgGeoFX
