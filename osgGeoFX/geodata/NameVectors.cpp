// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/NameVectors.h>

#include <osgGeoFX/geodata/detail/FeatureTags.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>
#include <osgGeoFX/geodata/detail/Lengths.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <osg/Math>
#include <osg/Vec2d>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace osgGeoFX
{

namespace
{

using Places = std::vector<osg::Vec3d>;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Which fields of a layer tell what.
struct Fields
{
    FeatureTags name, importance, height, style, altitudeMode;

    Fields(const OGRFeatureDefn& layer, const NameVectors::Options& options, const std::string& file)
        : name(tagsOf(layer, file, options.name, {"name", "label", "title"})),
          importance(tagsOf(layer, file, options.importance, {"importance", "rank_score", "prominence"})),
          height(tagsOf(layer, file, options.height, {"ele", "elevation", "height"})),
          style(tagsOf(layer, file, options.style,
                       {"style", "natural", "place", "water", "waterway", "class"})),
          altitudeMode(layer, {"altitudeMode"})
    {
    }

private:
    static FeatureTags tagsOf(const OGRFeatureDefn& layer, const std::string& file, const std::string& wanted,
                              const std::vector<std::string>& usual)
    {
        FeatureTags tags(layer, wanted.empty() ? usual : std::vector<std::string>{wanted});
        if (!wanted.empty() && !tags.any())
            throw BuildError(file + ": its layer " + std::string(layer.GetName()) + " has no field \"" +
                             wanted + "\"; ogrinfo -so -al lists those it has.");
        return tags;
    }
};

/// A number at the beginning of a text.
std::optional<double> numberOf(const std::string& text)
{
    char* end = nullptr;
    const double number = CPLStrtod(text.c_str(), &end);
    if (end == text.c_str() || !std::isfinite(number)) return std::nullopt;
    return number;
}

double heightOf(const std::string& text)
{
    if (text.empty()) return unknown;
    if (const auto metres = Lengths::read(text); metres && std::isfinite(*metres)) return *metres;
    // Words that are no unit, such as "müM".
    return numberOf(text).value_or(unknown);
}

/// Whether a point's third number is its height above the sea. In KML it is so in one mode alone; elsewhere it counts from the ground, or is
/// nothing. But heights that others have put there are known by not being 0.
bool isHeight(double z, const std::string& altitudeMode)
{
    return altitudeMode == "absolute" ||
           (z != 0.0 && (altitudeMode.empty() || altitudeMode == "clampToGround"));
}

/// The middle of an area along its longer axis, with places where the area is at its widest: the means of slices across the axis.
Places spineOf(Places ring, bool globe)
{
    constexpr std::size_t slices = 16;
    // Degrees of longitude are shorter than those of latitude.
    const double narrow = globe ? std::max(std::cos(osg::DegreesToRadians(ring.front().y())), 0.01) : 1.0;
    for (osg::Vec3d& place : ring)
        place.x() *= narrow;
    osg::Vec2d middle;
    for (const osg::Vec3d& place : ring)
        middle += osg::Vec2d(place.x(), place.y()) / static_cast<double>(ring.size());
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const osg::Vec3d& place : ring)
    {
        const double x = place.x() - middle.x(), y = place.y() - middle.y();
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const osg::Vec2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const osg::Vec3d& place : ring)
    {
        const double a = (osg::Vec2d(place.x(), place.y()) - middle) * along;
        low = std::min(low, a);
        high = std::max(high, a);
    }
    Places spine;
    for (std::size_t i = 1; i < slices; ++i)
    {
        const double at = low + (high - low) * static_cast<double>(i) / slices;
        // Where the border crosses the slice; the widest part between crossings holds the name.
        std::vector<double> crossings;
        for (std::size_t k = 0; k < ring.size(); ++k)
        {
            const osg::Vec3d &p = ring[k], &q = ring[(k + 1) % ring.size()];
            const osg::Vec2d from = osg::Vec2d(p.x(), p.y()) - middle, to = osg::Vec2d(q.x(), q.y()) - middle;
            const double a = from * along - at, b = to * along - at;
            if ((a < 0.0) == (b < 0.0)) continue;
            const double share = a / (a - b);
            crossings.push_back(from * across + (to * across - from * across) * share);
        }
        std::sort(crossings.begin(), crossings.end());
        double best = -1.0, place = 0.0;
        for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
        {
            if (crossings[k + 1] - crossings[k] <= best) continue;
            best = crossings[k + 1] - crossings[k];
            place = 0.5 * (crossings[k] + crossings[k + 1]);
        }
        if (best < 0.0) continue;
        const osg::Vec2d point = middle + along * at + across * place;
        spine.emplace_back(point.x() / narrow, point.y(), unknown);
    }
    return spine;
}

double lengthOf(const Places& places)
{
    double length = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i)
        length += std::hypot(places[i].x() - places[i - 1].x(), places[i].y() - places[i - 1].y());
    return length;
}

/// The points of a geometry and the longest curve that a name can follow.
class Shapes
{
public:
    Shapes(OGRCoordinateTransformation& toTarget, double metresPerUnit, bool globe)
        : _toTarget(toTarget), _metresPerUnit(metresPerUnit), _globe(globe)
    {
    }

    Places points;
    Places curve;

    void take(const OGRGeometry& geometry)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (type == wkbPoint)
        {
            const OGRPoint& point = *geometry.toPoint();
            if (point.IsEmpty()) return;
            const Places placed =
                place({point.getX()}, {point.getY()}, {point.Is3D() ? point.getZ() : unknown});
            points.insert(points.end(), placed.begin(), placed.end());
        }
        else if (type == wkbLineString)
            keepLonger(placesOf(*geometry.toLineString()));
        else if (type == wkbPolygon)
        {
            if (const OGRLinearRing* const ring = geometry.toPolygon()->getExteriorRing())
            {
                const Places border = placesOf(*ring);
                if (border.size() > 3) keepLonger(spineOf(border, _globe));
            }
        }
        else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        {
            for (const OGRGeometry* const part : *geometry.toGeometryCollection())
                take(*part);
        }
    }

private:
    void keepLonger(Places candidate)
    {
        if (candidate.size() > 1 && lengthOf(candidate) > lengthOf(curve)) curve = std::move(candidate);
    }

    Places placesOf(const OGRSimpleCurve& line) const
    {
        std::vector<double> x, y, z;
        for (int i = 0; i < line.getNumPoints(); ++i)
        {
            x.push_back(line.getX(i));
            y.push_back(line.getY(i));
            z.push_back(line.Is3D() ? line.getZ(i) : unknown);
        }
        return place(std::move(x), std::move(y), z);
    }

    /// Those that have a place in the target.
    Places place(std::vector<double> x, std::vector<double> y, const std::vector<double>& z) const
    {
        std::vector<int> placed(x.size());
        const GdalErrorScope errors; // those that fail do so one by one
        _toTarget.Transform(x.size(), x.data(), y.data(), nullptr, nullptr, placed.data());
        Places result;
        for (std::size_t i = 0; i < x.size(); ++i)
            if (placed[i] && std::isfinite(x[i]) && std::isfinite(y[i]) &&
                (!_globe || std::abs(y[i]) <= 90.0))
                result.emplace_back(x[i] * _metresPerUnit, y[i] * _metresPerUnit, z[i]);
        return result;
    }

    OGRCoordinateTransformation& _toTarget;
    const double _metresPerUnit;
    const bool _globe;
};

void collect(OGRLayer& layer, const NameVectors::Options& options, const OGRSpatialReference& target,
             double metresPerUnit, bool globe, bool kml, const std::string& file, std::vector<MapName>& names,
             std::set<std::string>& others)
{
    const Fields fields(*layer.GetLayerDefn(), options, file);
    if (!fields.name.any())
    {
        for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i)
            if (const OGRFieldDefn& field = *layer.GetLayerDefn()->GetFieldDefn(i);
                field.GetType() == OFTString)
                others.insert(cleanText(field.GetNameRef()));
        return;
    }
    forEachFeature(
        layer, target, file,
        [&](const OGRFeature& feature, const OGRGeometry& geometry, OGRCoordinateTransformation& toTarget)
        {
            MapName name;
            name.text = fields.name.of(feature);
            if (name.text.empty()) return;
            name.importance = numberOf(fields.importance.of(feature)).value_or(unknown);
            name.style = fields.style.of(feature);
            Shapes shapes(toTarget, metresPerUnit, globe);
            shapes.take(geometry);
            const double height = heightOf(fields.height.of(feature));
            for (osg::Vec3d& place : shapes.points)
            {
                if (kml && !isHeight(place.z(), fields.altitudeMode.of(feature))) place.z() = unknown;
                if (!std::isnan(height)) place.z() = height;
                name.places = {place};
                names.push_back(name);
            }
            if (shapes.curve.empty()) return;
            name.kind = MapName::LINE;
            name.places = std::move(shapes.curve);
            names.push_back(std::move(name));
        });
}

void readAll(const std::string& file, const NameVectors::Options& options, const MappingFrame& frame,
             std::vector<MapName>& names)
{
    const VectorTarget target = vectorTargetOf(frame, file);
    const DatasetPtr dataset = openVectors(file);
    std::vector<MapName> found;
    std::set<std::string> others; // fields of text in layers without names
    const std::string format = dataset->GetDriver() ? dataset->GetDriver()->GetDescription() : "";
    const bool kml = format == "LIBKML" || format == "KML";
    forEachLayer(*dataset, options.layer, file,
                 [&](OGRLayer& layer) {
                     collect(layer, options, target.crs, target.metresPerUnit, frame.globe, kml, file, found,
                             others);
                 });
    if (found.empty() && !others.empty())
    {
        std::string list;
        for (const std::string& each : others)
            list += (list.empty() ? "" : ", ") + each;
        throw BuildError(file + ": it has no field name, label or title; give the field that has names, of " +
                         list + ", by --label-field, or as \"nameField\" of a style file.");
    }
    if (found.empty())
        throw BuildError(file +
                         ": it has no feature with a name and a place; check the file with ogrinfo -al.");
    names.insert(names.end(), std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
}

} // namespace

bool NameVectors::read(const std::string& file, const Options& options, const MappingFrame& frame,
                       std::vector<MapName>& names, std::string& error)
{
    initialiseGdal();
    try
    {
        readAll(file, options, frame, names);
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
