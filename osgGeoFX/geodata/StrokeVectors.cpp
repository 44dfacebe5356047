// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/StrokeVectors.h>

#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace osgGeoFX
{

namespace
{

using Points = std::vector<osg::Vec2d>;

[[noreturn]] void fail(const std::string& file, const std::string& what)
{
    throw BuildError(file + ": " + what + ".");
}

/// Where the ends of lines meet.
struct Before
{
    bool operator()(const osg::Vec2d& a, const osg::Vec2d& b) const
    {
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    }
};

/// Makes one of lines that meet where no other ends, so that strokes go on through it.
std::vector<Points> joined(std::vector<Points> lines)
{
    std::map<osg::Vec2d, std::vector<std::size_t>, Before> ends;
    for (std::size_t i = 0; i < lines.size(); ++i)
    {
        ends[lines[i].front()].push_back(i);
        ends[lines[i].back()].push_back(i);
    }
    std::vector<bool> used(lines.size(), false);
    const auto grow = [&](Points& line)
    {
        for (;;)
        {
            const std::vector<std::size_t>& meeting = ends[line.back()];
            if (meeting.size() != 2) return;
            const std::size_t next = used[meeting[0]] ? meeting[1] : meeting[0];
            if (used[next]) return;
            used[next] = true;
            Points& more = lines[next];
            if (more.front() != line.back()) std::reverse(more.begin(), more.end());
            line.insert(line.end(), more.begin() + 1, more.end());
        }
    };
    std::vector<Points> result;
    for (std::size_t i = 0; i < lines.size(); ++i)
    {
        if (used[i]) continue;
        used[i] = true;
        Points line = std::move(lines[i]);
        grow(line);
        std::reverse(line.begin(), line.end());
        grow(line);
        std::reverse(line.begin(), line.end());
        result.push_back(std::move(line));
    }
    return result;
}

/// The lines or the areas of a file's features.
class Collector
{
public:
    Collector(std::string file, bool areas, const OGRSpatialReference& target, double metresPerUnit,
              bool globe)
        : _file(std::move(file)), _areas(areas), _target(target), _metresPerUnit(metresPerUnit), _globe(globe)
    {
    }

    std::vector<Points> found;

    void collect(OGRLayer& layer)
    {
        forEachFeature(layer, _target, _file,
                       [&](const OGRFeature&, const OGRGeometry& geometry,
                           OGRCoordinateTransformation& toTarget) { take(geometry, toTarget); });
    }

private:
    void take(const OGRGeometry& geometry, OGRCoordinateTransformation& toTarget)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (type == wkbLineString && !_areas)
        {
            for (Points& piece : pieces(*geometry.toLineString(), toTarget))
                if (piece.size() > 1) found.push_back(std::move(piece));
        }
        else if (type == wkbPolygon && _areas)
        {
            takeArea(*geometry.toPolygon(), toTarget);
        }
        else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        {
            for (const OGRGeometry* part : *geometry.toGeometryCollection())
                take(*part, toTarget);
        }
    }

    void takeArea(const OGRPolygon& polygon, OGRCoordinateTransformation& toTarget)
    {
        Points area;
        for (const OGRLinearRing* ring : polygon)
        {
            const std::vector<Points> whole = pieces(*ring, toTarget);
            // A ring that is not all there is none.
            if (whole.size() != 1 || whole.front().size() != static_cast<std::size_t>(ring->getNumPoints()))
                return;
            area.insert(area.end(), whole.front().begin(), whole.front().end());
            area.push_back(area.front());
        }
        if (area.size() > 3) found.push_back(std::move(area));
    }

    /// Parts that have places.
    std::vector<Points> pieces(const OGRSimpleCurve& curve, OGRCoordinateTransformation& toTarget) const
    {
        const auto count = static_cast<std::size_t>(curve.getNumPoints());
        std::vector<double> x(count), y(count);
        std::vector<int> placed(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            x[i] = curve.getX(static_cast<int>(i));
            y[i] = curve.getY(static_cast<int>(i));
        }
        const GdalErrorScope errors; // those that fail do so one by one
        toTarget.Transform(count, x.data(), y.data(), nullptr, nullptr, placed.data());
        std::vector<Points> result(1);
        for (std::size_t i = 0; i < count; ++i)
        {
            const bool there = placed[i] && std::isfinite(x[i]) && std::isfinite(y[i]) &&
                               (!_globe || std::abs(y[i]) <= 90.0);
            if (there)
                result.back().push_back(osg::Vec2d(x[i], y[i]) * _metresPerUnit);
            else if (!result.back().empty())
                result.emplace_back();
        }
        return result;
    }

    const std::string _file;
    const bool _areas;
    const OGRSpatialReference& _target;
    const double _metresPerUnit;
    const bool _globe;
};

void readAll(const std::string& file, const std::string& layer, StrokeLines::Kind kind,
             const MappingFrame& frame, std::vector<StrokeLines::Line>& lines)
{
    const VectorTarget target = vectorTargetOf(frame, file);
    const DatasetPtr dataset = openVectors(file);
    const bool areas = kind == StrokeLines::TOWN;
    Collector collector(file, areas, target.crs, target.metresPerUnit, frame.globe);
    forEachLayer(*dataset, layer, file, [&](OGRLayer& each) { collector.collect(each); });
    if (collector.found.empty())
        fail(file,
             areas ? "it has no areas, which towns are; name another layer or kind, or check it with ogrinfo"
                   : "it has no lines; name another layer or kind, or check it with ogrinfo");
    std::vector<Points> found = areas ? std::move(collector.found) : joined(std::move(collector.found));
    for (Points& points : found)
        lines.push_back({kind, std::move(points)});
}

} // namespace

bool StrokeVectors::read(const std::string& file, const std::string& layer, StrokeLines::Kind kind,
                         const MappingFrame& frame, std::vector<StrokeLines::Line>& lines, std::string& error)
{
    initialiseGdal();
    try
    {
        readAll(file, layer, kind, frame, lines);
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
