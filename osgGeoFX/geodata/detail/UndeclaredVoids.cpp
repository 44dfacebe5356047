// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/UndeclaredVoids.h>

#include <osgGeoFX/geodata/detail/Lengths.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/RasterMask.h>
#include <osgGeoFX/geodata/detail/Remarks.h>

#include <osg/BoundingBox>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

namespace osgGeoFX
{

namespace
{

// A value that is no height is so far from all heights, metres.
constexpr double LEAST_GAP = 500.0;
// Ground that is dry has heights between these, metres. A value between them may be a tower's, unless the raster ends in it.
constexpr double LEAST_DRY = -500.0, MOST_DRY = 9000.0;
// Fewer other pixels show nothing.
constexpr std::uint64_t LEAST_PIXELS = 256;
// So many values at each end of all are known: several kinds of missing heights, and the first true one.
constexpr std::size_t ENDS = 6;
// Along a quadrilateral's side, pixels; and how far the corners of the box around it lie beyond it.
constexpr double LEAST_SIDE = 16.0, LEAST_CORNER = 2.5;
// So much of a quadrilateral is within the data's hull, and so much of it is data; the rest are lakes, and pixels along the sides.
constexpr double FULL_OF_HULL = 0.97, FULL_OF_DATA = 0.95;
// A margin along the sides, of the square root of the area: a reprojected survey has slightly curved sides.
constexpr double MARGIN = 0.02;
// The step at the data's end, in steps from one pixel to the next within them.
constexpr double LEAST_STEP = 4.0;

double cross(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

/// Twice the area, positive if it goes around from x to y.
template<typename Points>
double area(const Points& points)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += cross(points[i], points[(i + 1) % points.size()]);
    return sum;
}

/// The convex hull, going around from x to y.
std::vector<osg::Vec2d> hullOf(std::vector<osg::Vec2d> points)
{
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<osg::Vec2d> hull;
    const auto half = [&](auto begin, auto end)
    {
        const std::size_t first = hull.size();
        for (auto point = begin; point != end; ++point)
        {
            while (hull.size() >= first + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], *point - hull.back()) <= 0.0)
                hull.pop_back();
            hull.push_back(*point);
        }
        hull.pop_back();
    };
    if (points.size() < 3) return points;
    half(points.begin(), points.end());
    half(points.rbegin(), points.rend());
    return hull;
}

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::string inWords(double value)
{
    std::string text = CPLSPrintf(std::abs(value) < 1e7 ? "%.10g" : "%.7g", value);
    if (text[0] == '-') text.replace(0, 1, "−");
    return text;
}

} // namespace

/// The pixels of a raster, once over.
struct UndeclaredVoids::Look
{
    /// A row of a block: where pixels differ from the value at the raster's corners.
    struct Run
    {
        int row, left, right; ///< the block's columns: `left` up to the one before `right`
        int first, last;      ///< the first and the last that differ
        int count;            ///< how many differ
    };

    explicit Look(GDALDataset& raster) : band(*raster.GetRasterBand(1)), mask(raster, {1})
    {
        columns = raster.GetRasterXSize();
        rows = raster.GetRasterYSize();
    }

    /// False where the raster cannot be read.
    bool read(double most)
    {
        if (!readCorners()) return false;
        int width = 0, height = 0;
        band.GetBlockSize(&width, &height);
        const int across = (columns - 1) / width + 1, down = (rows - 1) / height + 1;
        // Every n-th block in both directions, or of rows.
        const double share = static_cast<double>(columns) * rows / most;
        const double step = std::max(1.0, across > 1 ? std::sqrt(share) : share);
        const auto chosen = [&](int count)
        {
            std::vector<int> result;
            for (double at = 0.0; at < count - 1.0; at += step)
                result.push_back(static_cast<int>(at));
            // The last one, too.
            result.push_back(count - 1);
            return result;
        };
        for (const int y : chosen(down))
            for (const int x : chosen(across))
                if (!readBlock(x * width, y * height, std::min(width, columns - x * width),
                               std::min(height, rows - y * height)))
                    return false;
        return true;
    }

    GDALRasterBand& band;
    RasterMask mask;
    int columns = 0, rows = 0;
    /// Pixels of one value.
    struct Pixels
    {
        std::uint64_t count = 0;
        bool isAtBorder = false; ///< whether one of them is among the raster's outermost pixels
    };
    using Ends = std::map<double, Pixels>;
    Ends lowest, highest;         ///< the outermost values
    std::uint64_t heights = 0;    ///< pixels that are not missing
    std::optional<double> corner; ///< the value of all four corners
    std::vector<Run> runs;
    std::vector<double> steps, slopes; ///< at the ends of runs, and next to them within

private:
    bool readCorners()
    {
        for (const int row : {0, rows - 1})
            for (const int column : {0, columns - 1})
            {
                double value = 0.0;
                unsigned char there = 255;
                if (band.RasterIO(GF_Read, column, row, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr) !=
                        CE_None ||
                    !mask.read(column, row, 1, 1, &there))
                    return false;
                if (row == 0 && column == 0 && there) corner = value;
                if (!there || !corner || !(*corner == value))
                {
                    corner.reset();
                    return true;
                }
            }
        return true;
    }

    bool readBlock(int left, int top, int width, int height)
    {
        const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        _values.resize(count);
        if (band.RasterIO(GF_Read, left, top, width, height, _values.data(), width, height, GDT_Float64, 0, 0,
                          nullptr) != CE_None)
            return false;
        _there.assign(count, 255);
        if (!mask.isEmpty() && !mask.read(left, top, width, height, _there.data())) return false;
        for (std::size_t i = 0, next = 0; i < count; i = next)
        {
            for (next = i + 1; next < count && _there[next] == _there[i] && _values[next] == _values[i];)
                ++next;
            if (!_there[i] || std::isnan(_values[i])) continue;
            heights += next - i;
            const auto rowOf = [&](std::size_t at)
            {
                return static_cast<int>(at / static_cast<std::size_t>(width));
            };
            const int first = rowOf(i), last = rowOf(next - 1);
            const bool startsRow = last > first || i % static_cast<std::size_t>(width) == 0;
            const bool endsRow = last > first || next % static_cast<std::size_t>(width) == 0;
            const Pixels more{next - i, top + first == 0 || top + last == rows - 1 ||
                                            (left == 0 && startsRow) || (left + width == columns && endsRow)};
            take(lowest, _values[i], more, std::less<>(), [](auto& ends) { return std::prev(ends.end()); });
            take(highest, _values[i], more, std::greater<>(), [](auto& ends) { return ends.begin(); });
        }
        if (corner)
            for (int row = 0; row < height; ++row)
                takeRun(left, top + row, width,
                        static_cast<std::size_t>(row) * static_cast<std::size_t>(width));
        return true;
    }

    /// Counts a value if it is among the outermost ones.
    template<typename IsOuter, typename Inmost>
    static void take(Ends& ends, double value, const Pixels& more, IsOuter isOuter, Inmost inmost)
    {
        if (ends.size() == ENDS && isOuter(inmost(ends)->first, value)) return;
        Pixels& pixels = ends[value];
        pixels.count += more.count;
        pixels.isAtBorder = pixels.isAtBorder || more.isAtBorder;
        if (ends.size() > ENDS) ends.erase(inmost(ends));
    }

    void takeRun(int left, int row, int width, std::size_t at)
    {
        const auto differs = [&](int i)
        {
            return _there[at + static_cast<std::size_t>(i)] &&
                   _values[at + static_cast<std::size_t>(i)] != *corner;
        };
        Run run{row, left, left + width, -1, -1, 0};
        for (int i = 0; i < width; ++i)
            if (differs(i))
            {
                if (run.count++ == 0) run.first = left + i;
                run.last = left + i;
            }
        runs.push_back(run);
        if (run.count < 2) return;
        const auto value = [&](int column)
        {
            return _values[at + static_cast<std::size_t>(column - left)];
        };
        const auto takeEnd = [&](int end, int within)
        {
            if (!differs(within - left)) return;
            steps.push_back(std::abs(value(end) - *corner));
            slopes.push_back(std::abs(value(end) - value(within)));
        };
        if (run.first > left) takeEnd(run.first, run.first + 1);
        if (run.last < left + width - 1) takeEnd(run.last, run.last - 1);
    }

    std::vector<double> _values;
    std::vector<unsigned char> _there;
};

/// The least quadrilateral around points, if their hull fills most of it.
std::optional<UndeclaredVoids::Quadrilateral>
UndeclaredVoids::quadrilateralAround(std::vector<osg::Vec2d> points)
{
    std::vector<osg::Vec2d> hull = hullOf(std::move(points));
    if (hull.size() < 4) return {};
    const double filled = area(hull);
    // The side whose neighbours, prolonged until they meet, add least to the area is left out, until four are left.
    while (hull.size() > 4)
    {
        const std::size_t n = hull.size();
        double least = std::numeric_limits<double>::max();
        std::size_t side = n;
        osg::Vec2d meeting;
        for (std::size_t i = 0; i < n; ++i)
        {
            const osg::Vec2d &start = hull[i], &end = hull[(i + 1) % n];
            const osg::Vec2d before = start - hull[(i + n - 1) % n], after = end - hull[(i + 2) % n];
            const double across = cross(before, after);
            if (!(across < 0.0)) continue; // they part
            const osg::Vec2d place = start + before * (cross(end - start, after) / across);
            const double more = std::abs(cross(end - start, place - start));
            if (more >= least) continue;
            least = more;
            side = i;
            meeting = place;
        }
        if (side == n) return {};
        hull[side] = meeting;
        hull.erase(hull.begin() + static_cast<std::ptrdiff_t>((side + 1) % n));
    }
    const Quadrilateral result{hull[0], hull[1], hull[2], hull[3]};
    for (std::size_t i = 0; i < 4; ++i)
        if ((result[(i + 1) % 4] - result[i]).length() < LEAST_SIDE) return {};
    if (filled < FULL_OF_HULL * area(result)) return {};
    return result;
}

/// How far a place is inside of the nearest side, pixels; negative outside.
double UndeclaredVoids::depthIn(const Quadrilateral& area, const osg::Vec2d& place)
{
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < 4; ++i)
    {
        const osg::Vec2d along = area[(i + 1) % 4] - area[i];
        least = std::min(least, cross(along, place - area[i]) / along.length());
    }
    return least;
}

UndeclaredVoids UndeclaredVoids::of(const std::string& file, double most)
{
    initialiseGdal();
    UndeclaredVoids result;
    const GdalErrorScope quiet;
    const DatasetChain chain = RasterFile::open(file);
    GDALDataset* const raster = &chain.top();
    if (!faultOfBlocks(*raster).empty()) return result;
    GDALRasterBand& band = *raster->GetRasterBand(1);
    if (GDALDataTypeIsComplex(band.GetRasterDataType())) return result;
    const OGRSpatialReference* const srs = raster->GetSpatialRef();
    const double metres =
        std::abs(band.GetScale()) * Lengths::metresPerHeight(band, srs ? *srs : OGRSpatialReference(), file);
    Look look(*raster);
    if (!(metres > 0.0) || !look.read(most)) return result;

    // One end after the other, as long as its value is far from the rest.
    auto &lowest = look.lowest, &highest = look.highest;
    const auto isAlone = [&](double value, double next, const Look::Pixels& pixels)
    {
        const bool isDry = value * metres > LEAST_DRY && value * metres < MOST_DRY;
        if (isDry && !pixels.isAtBorder) return false;
        const double rest = value < next ? highest.rbegin()->first - next : next - lowest.begin()->first;
        const double gap = std::abs(next - value);
        return rest > 0.0 && gap >= rest && gap * metres >= LEAST_GAP &&
               look.heights - pixels.count >= LEAST_PIXELS;
    };
    const auto leaveOut = [&](double value, std::uint64_t count)
    {
        result._values.push_back(value);
        look.heights -= count;
        lowest.erase(value);
        highest.erase(value);
    };
    while (lowest.size() > 1 && highest.size() > 1)
    {
        const auto low = lowest.begin(), high = std::prev(highest.end());
        if (isAlone(high->first, std::prev(high)->first, high->second))
            leaveOut(high->first, high->second.count);
        else if (isAlone(low->first, std::next(low)->first, low->second))
            leaveOut(low->first, low->second.count);
        else
            break;
    }

    if (look.corner &&
        std::find(result._values.begin(), result._values.end(), *look.corner) == result._values.end() &&
        median(look.steps) > LEAST_STEP * median(look.slopes))
    {
        std::vector<osg::Vec2d> points;
        double data = 0.0;
        for (const Look::Run& run : look.runs)
        {
            if (run.count == 0) continue;
            data += run.count;
            for (const int x : {run.first, run.last + 1})
                for (const int y : {run.row, run.row + 1})
                    points.emplace_back(x, y);
        }
        const auto inside = quadrilateralAround(std::move(points));
        // A box along the grid may be ground that stands in the sea.
        osg::BoundingBoxd box;
        for (std::size_t i = 0; inside && i < 4; ++i)
            box.expandBy(osg::Vec3d((*inside)[i], 0.0));
        bool turned = inside.has_value();
        for (const double x : {box.xMin(), box.xMax()})
            for (const double y : {box.yMin(), box.yMax()})
                turned = turned && depthIn(*inside, osg::Vec2d(x, y)) < -LEAST_CORNER;
        if (turned)
        {
            // The pixels of the quadrilateral that were looked at.
            double all = 0.0;
            for (const Look::Run& run : look.runs)
            {
                double from = run.left, to = run.right;
                for (std::size_t i = 0; i < 4; ++i)
                {
                    const osg::Vec2d along = (*inside)[(i + 1) % 4] - (*inside)[i];
                    const double slope = -along.y();
                    const double at = cross(along, osg::Vec2d(0.0, run.row + 0.5) - (*inside)[i]);
                    if (slope > 0.0)
                        from = std::max(from, -at / slope);
                    else if (slope < 0.0)
                        to = std::min(to, -at / slope);
                    else if (at < 0.0)
                        to = from;
                }
                all += std::max(0.0, to - from);
            }
            if (data >= FULL_OF_DATA * all)
                result._around = Surroundings{*look.corner, *inside,
                                              std::max(2.0, MARGIN * std::sqrt(0.5 * area(*inside)))};
        }
    }
    if (!result.isEmpty())
        remarkOnce(
            file + ": " + result.text() +
            ", though the file does not declare it as no-data. Such places count as missing; --all-heights "
            "takes them as heights.");
    return result;
}

bool UndeclaredVoids::has(double value, int column, int row) const
{
    if (std::find(_values.begin(), _values.end(), value) != _values.end()) return true;
    return _around && value == _around->value &&
           depthIn(_around->inside, osg::Vec2d(column + 0.5, row + 0.5)) < _around->margin;
}

std::string UndeclaredVoids::text() const
{
    std::string result;
    for (const double value : _values)
        result += (result.empty() ? "" : " and ") + inWords(value);
    if (!_values.empty())
        result += std::string(_values.size() > 1 ? " are" : " is") + " far from all other heights";
    if (_around)
        result += (result.empty() ? "" : ", and ") + inWords(_around->value) + " is all around turned data";
    return result;
}

} // namespace osgGeoFX
