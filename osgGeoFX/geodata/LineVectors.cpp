// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/LineVectors.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/FeatureTags.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

namespace osgGeoFX
{

namespace
{

class Collector
{
public:
    Collector(const std::string& file, const LineVectors::Options& options, const VectorTarget& target,
              bool globe)
        : _file(file), _style(options.style), _target(target), _globe(globe)
    {
    }

    std::vector<MapLine> found;

    void collect(OGRLayer& layer)
    {
        const FeatureTags style = styleTags(*layer.GetLayerDefn());
        const FeatureTags name(*layer.GetLayerDefn(), {"name"});
        forEachFeature(
            layer, _target.crs, _file,
            [&](const OGRFeature& feature, const OGRGeometry&, OGRCoordinateTransformation& toTarget)
            {
                if (isGroundOverlay(feature)) return;
                MapLine line;
                line.name = name.of(feature);
                line.style = style.of(feature);
                // As it was drawn: lifts have pylons at its places and nowhere else.
                const std::unique_ptr<OGRGeometry> geometry(feature.GetGeometryRef()->getLinearGeometry());
                take(*geometry, line, toTarget);
            });
    }

private:
    FeatureTags styleTags(const OGRFeatureDefn& definition) const
    {
        if (_style.empty())
            return FeatureTags(definition,
                               {"style", "highway", "railway", "aerialway", "piste:type", "waterway", "route",
                                "boundary", "natural", "fclass", "class", "kind", "type"});
        FeatureTags named(definition, {_style});
        if (!named.any())
            throw BuildError(_file + ": its layer " + std::string(definition.GetName()) + " has no field \"" +
                             _style + "\"; ogrinfo -so -al lists those it has.");
        return named;
    }

    void take(const OGRGeometry& geometry, const MapLine& line, OGRCoordinateTransformation& toTarget)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (type == wkbLineString)
            takeCurve(*geometry.toLineString(), line, toTarget);
        else if (type == wkbPolygon)
        {
            for (const OGRLinearRing* const ring : *geometry.toPolygon())
                takeCurve(*ring, line, toTarget);
        }
        else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        {
            for (const OGRGeometry* const part : *geometry.toGeometryCollection())
                take(*part, line, toTarget);
        }
    }

    void takeCurve(const OGRSimpleCurve& curve, const MapLine& line, OGRCoordinateTransformation& toTarget)
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
        MapLine part = line;
        const auto finish = [&]
        {
            if (part.places.size() > 1) found.push_back(part);
            part.places.clear();
        };
        for (std::size_t i = 0; i < count; ++i)
        {
            const bool there = placed[i] && std::isfinite(x[i]) && std::isfinite(y[i]) &&
                               (!_globe || std::abs(y[i]) <= 90.0);
            if (!there)
            {
                finish();
                continue;
            }
            const osg::Vec3d place(x[i] * _target.metresPerUnit, y[i] * _target.metresPerUnit, 0.0);
            if (part.places.empty() || part.places.back() != place) part.places.push_back(place);
        }
        finish();
    }

    const std::string& _file;
    const std::string& _style;
    const VectorTarget& _target;
    const bool _globe;
};

void readAll(const std::string& file, const LineVectors::Options& options, const MappingFrame& frame,
             std::vector<MapLine>& lines)
{
    const VectorTarget target = vectorTargetOf(frame, file);
    const DatasetPtr dataset = openVectors(file);
    Collector collector(file, options, target, frame.globe);
    forEachLayer(*dataset, options.layer, file, [&](OGRLayer& layer) { collector.collect(layer); });
    if (collector.found.empty())
        throw BuildError(file + ": it has no lines; name another layer, or check the file with ogrinfo -al.");
    lines.insert(lines.end(), std::make_move_iterator(collector.found.begin()),
                 std::make_move_iterator(collector.found.end()));
}

} // namespace

bool LineVectors::read(const std::string& file, const Options& options, const MappingFrame& frame,
                       std::vector<MapLine>& lines, std::string& error)
{
    initialiseGdal();
    try
    {
        readAll(file, options, frame, lines);
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
