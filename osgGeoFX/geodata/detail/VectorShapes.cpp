// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/VectorShapes.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/CoordinateText.h>
#include <osgGeoFX/geodata/detail/FeatureTags.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/OgrStyle.h>
#include <osgGeoFX/geodata/detail/RingCut.h>
#include <osgGeoFX/geodata/detail/SldStyle.h>
#include <osgGeoFX/paging/ReadingFile.h>

#include <osg/Math>
#include <osg/Vec3d>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t mostVertices = 10000000;
constexpr std::size_t mostSymbols = 100000;
constexpr double earthRadius = 6371e3; // metres

/// Of layers without a style, one after the other.
const char* const usualColors[] = {"#1f78b4", "#e31a1c", "#33a02c", "#ff7f00", "#6a3d9a", "#b15928"};

osg::Vec3d directionOf(const osg::Vec2d& degrees)
{
    const double x = osg::DegreesToRadians(degrees.x()), y = osg::DegreesToRadians(degrees.y());
    return {std::cos(y) * std::cos(x), std::cos(y) * std::sin(x), std::sin(y)};
}

/// The border of a part of the world that a file in degrees was cut at: no line of the data.
bool isSeam(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return (std::abs(a.x()) == 180.0 && a.x() == b.x()) || (std::abs(a.y()) == 90.0 && a.y() == b.y());
}

class Reader
{
public:
    Reader(const std::string& file, const VectorShapes::Options& options) : _options(options)
    {
        _result.file = file;
        std::string style = options.style;
        if (style.empty())
        {
            const std::string beside = std::filesystem::path(file).replace_extension(".sld").string();
            std::error_code fault;
            if (std::filesystem::is_regular_file(beside, fault)) style = beside;
        }
        if (style.empty()) return;
        _style = readSldStyle(style, options.allowOutside);
        _result.notices = _style->notices;
    }

    VectorShapes read()
    {
        const ReadingFile reading(_result.file);
        const DatasetPtr dataset = openVectors(_result.file);
        _dataset = dataset.get();
        forEachLayer(*dataset, _options.layer, _result.file, [this](OGRLayer& layer) { readLayer(layer); });
        if (_layers == 0)
            throw BuildError(_result.file +
                             ": it has no layer with areas, lines or points; check it with ogrinfo.");
        if (_result.items.empty() && _result.symbols.empty())
            throw BuildError(_result.file + (_features == 0
                                                 ? ": its features have no geometry; check it with ogrinfo."
                                                 : ": no rule of its style holds for any of its features; "
                                                   "correct the filters of the style."));
        order();
        reach();
        return std::move(_result);
    }

private:
    void readLayer(OGRLayer& layer)
    {
        if (wkbFlatten(layer.GetGeomType()) == wkbNone) return;
        const LayerStyle* style = nullptr;
        if (_style)
        {
            style = _style->of(layer.GetName());
            // A style of several layers leaves out those that it does not name.
            if (!style && _style->layers.size() > 1 && _options.layer.empty()) return;
            if (!style)
                throw BuildError(_style->file + ": it has no layer \"" + layer.GetName() +
                                 "\"; give one of its layers this name.");
            _style->checkFields(*style, *layer.GetLayerDefn(), _result.file);
        }
        const OGRSpatialReference* const srs = layer.GetSpatialRef();
        _geographic = srs && srs->IsGeographic();
        _longest = longestEdge(layer, srs);
        _styles = layer.GetStyleTable() ? layer.GetStyleTable() : _dataset->GetStyleTable();
        _name = layer.GetLayerDefn()->GetFieldIndex("name");
        const GDALDriver* const driver = _dataset->GetDriver();
        _isKml =
            driver && (EQUAL(driver->GetDescription(), "LIBKML") || EQUAL(driver->GetDescription(), "KML"));
        _altitudeMode = layer.GetLayerDefn()->GetFieldIndex("altitudeMode");
        OGRSpatialReference degrees;
        degrees.importFromEPSG(4326);
        forEachFeature(
            layer, degrees, _result.file,
            [&](const OGRFeature& feature, const OGRGeometry& geometry,
                OGRCoordinateTransformation& toDegrees)
            {
                if (geometry.IsEmpty() || isGroundOverlay(feature)) return;
                ++_features;
                _toDegrees = &toDegrees;
                take(const_cast<OGRFeature&>(feature), geometry, style);
            },
            LongLines::KEPT);
        ++_layers;
    }

    /// So that straight lines of the file are straight to a quarter of a texel between the vertices that are put in between; in the file's unit.
    static double longestEdge(OGRLayer& layer, const OGRSpatialReference* srs)
    {
        OGREnvelope box;
        const GdalErrorScope quiet; // who reads the features tells
        if (!srs || layer.GetExtent(&box, TRUE) != OGRERR_NONE) return 0.0;
        const double metres = srs->IsGeographic() ? earthRadius * osg::PI / 180.0 : srs->GetLinearUnits();
        const double size = std::hypot(box.MaxX - box.MinX, box.MaxY - box.MinY) * metres;
        const double texel = std::max(0.02, size / 4194304.0);
        return std::sqrt(2.0 * earthRadius * texel) / metres;
    }

    void take(OGRFeature& feature, const OGRGeometry& geometry, const LayerStyle* style)
    {
        _shape.reset();
        if (style)
        {
            for (std::size_t pass = 0; pass < style->passes.size(); ++pass)
            {
                _pass = pass;
                for (const StyleRule* const rule : FeatureStyle::rulesFor(style->passes[pass], feature))
                    for (const Symbolizer& each : rule->symbolizers)
                    {
                        if (each.kind == Symbolizer::POINT)
                            addSymbols(feature, geometry, _style->symbolOf(each, feature), true);
                        else
                            addShapes(geometry, _style->shapeOf(each, *rule, feature),
                                      each.kind == Symbolizer::AREA);
                    }
            }
            return;
        }
        _pass = 0;
        const OgrStyle own = OgrStyle::of(feature, _styles);
        for (const ShapePaint& each : own.shapes)
            addShapes(geometry, each, each.fill.has_value());
        for (const SymbolPaint& each : own.symbols)
            addSymbols(feature, geometry, each, false);
        if (own.shapes.empty() && own.symbols.empty()) addUsual(feature, geometry);
    }

    void addUsual(OGRFeature& feature, const OGRGeometry& geometry)
    {
        const osg::Vec4 color = *colorOfHex(usualColors[_layers % std::size(usualColors)]);
        ShapePaint paint;
        paint.fill = osg::Vec4(color.r(), color.g(), color.b(), 0.4f);
        paint.stroke = StrokePaint{color, 2.0, StrokePaint::ROUND, StrokePaint::ROUND_CAP, {}, 0.0};
        addShapes(geometry, paint, true);
        SymbolPaint symbol;
        symbol.mark = "circle";
        symbol.fill = color;
        symbol.stroke =
            StrokePaint{{1.0f, 1.0f, 1.0f, 1.0f}, 1.5, StrokePaint::MITRE, StrokePaint::BUTT, {}, 0.0};
        symbol.size = 10.0;
        addSymbols(feature, geometry, symbol, false);
    }

    std::uint32_t paintOf(const ShapePaint& paint)
    {
        const auto [found, isNew] =
            _paints.emplace(paint.key(), static_cast<std::uint32_t>(_result.paints.size()));
        if (isNew) _result.paints.push_back(paint);
        return found->second;
    }

    void add(std::uint32_t shape, const ShapePaint& paint)
    {
        _orders.emplace_back(_layers, _pass);
        _result.items.push_back({shape, paintOf(paint)});
    }

    /// `areas`: areas are filled; else only their borders are drawn.
    void addShapes(const OGRGeometry& geometry, const ShapePaint& paint, bool areas)
    {
        if (!paint.fills() && !paint.stroke) return;
        if (!_shape) _shape = shapesOf(geometry);
        for (const Found& each : *_shape)
        {
            const bool isArea = _result.shapes[each.shape].area;
            // An area's symbolizer closes lines nowhere, but draws them.
            ShapePaint own = paint;
            if (!isArea || !areas) own.keepStroke();
            if (!isArea)
            {
                if (own.stroke) add(each.shape, own);
                continue;
            }
            if (!own.stroke || each.outlines.empty())
            {
                if (own.fills() || own.stroke) add(each.shape, own);
                continue;
            }
            ShapePaint fill = own;
            fill.stroke.reset();
            if (fill.fills()) add(each.shape, fill);
            own.keepStroke();
            for (const std::uint32_t outline : each.outlines)
                add(outline, own);
        }
    }

    struct Found
    {
        std::uint32_t shape = 0;
        std::vector<std::uint32_t>
            outlines; ///< of an area that has borders which are none of the data's; else empty
    };

    std::vector<Found> shapesOf(const OGRGeometry& geometry)
    {
        std::vector<Found> found;
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        {
            for (const OGRGeometry* const part : *geometry.toGeometryCollection())
                for (Found& each : shapesOf(*part))
                    found.push_back(std::move(each));
        }
        else if (type == wkbLineString)
        {
            VectorShape line;
            line.parts = placesOf(*geometry.toLineString(), false);
            if (!line.parts.empty()) found.push_back({addShape(std::move(line)), {}});
        }
        else if (type == wkbPolygon || type == wkbTriangle)
        {
            VectorShape area;
            area.area = true;
            for (const OGRLinearRing* const ring : *geometry.toPolygon())
                for (std::vector<osg::Vec2d>& places : placesOf(*ring, true))
                    area.parts.push_back(std::move(places));
            if (area.parts.empty()) return found;
            Found result;
            std::vector<VectorShape> outlines = outlinesOf(area);
            result.shape = addShape(std::move(area));
            for (VectorShape& outline : outlines)
                result.outlines.push_back(addShape(std::move(outline)));
            found.push_back(std::move(result));
        }
        else if (type == wkbPolyhedralSurface || type == wkbTIN)
        {
            for (const OGRPolygon* const part : *geometry.toPolyhedralSurface())
                for (Found& each : shapesOf(*part))
                    found.push_back(std::move(each));
        }
        return found;
    }

    /// The borders of an area without the seams; nothing of one that has no seam.
    static std::vector<VectorShape> outlinesOf(const VectorShape& area)
    {
        VectorShape lines;
        bool any = false;
        for (const std::vector<osg::Vec2d>& ring : area.parts)
        {
            std::vector<osg::Vec2d> line;
            for (std::size_t i = 0; i + 1 < ring.size(); ++i)
            {
                if (isSeam(ring[i], ring[i + 1]))
                {
                    any = true;
                    if (line.size() > 1) lines.parts.push_back(line);
                    line.clear();
                    continue;
                }
                if (line.empty()) line.push_back(ring[i]);
                line.push_back(ring[i + 1]);
            }
            if (line.size() > 1) lines.parts.push_back(line);
        }
        if (!any) return {};
        return {lines};
    }

    std::uint32_t addShape(VectorShape shape)
    {
        for (const std::vector<osg::Vec2d>& part : shape.parts)
            _vertices += part.size();
        if (_vertices > mostVertices)
            throw BuildError(_result.file +
                             ": it has more than ten million vertices; simplify it with ogr2ogr "
                             "-simplify, or cut out a part with ogr2ogr -clipsrc.");
        _result.shapes.push_back(std::move(shape));
        return static_cast<std::uint32_t>(_result.shapes.size() - 1);
    }

    /// Whether a ring in degrees goes on over the antimeridian, though GeoJSON wants it cut there: its edges go the short way then, close the ring,
    /// and make it narrower.
    static bool goesOnOver(const OGRLineString& ring)
    {
        const int count = ring.getNumPoints();
        double x = count > 0 ? ring.getX(0) : 0.0, west = x, east = x;
        bool any = false;
        for (int i = 1; i < count; ++i)
        {
            const double way = ring.getX(i) - ring.getX(i - 1);
            any = any || std::abs(way) > 180.0;
            x += std::remainder(way, 360.0);
            west = std::min(west, x);
            east = std::max(east, x);
        }
        return any && std::abs(x - ring.getX(0)) < 1e-9 && east > west && east - west < 180.0;
    }

    /// In degrees; pieces, where some vertices have no place.
    std::vector<std::vector<osg::Vec2d>> placesOf(const OGRLineString& line, bool ring)
    {
        std::vector<double> x, y;
        const bool shortWay = _geographic && (!ring || goesOnOver(line));
        for (int i = 0; i < line.getNumPoints(); ++i)
        {
            const osg::Vec2d place(line.getX(i), line.getY(i));
            if (!std::isfinite(place.x()) || !std::isfinite(place.y())) continue;
            if (!x.empty() && _longest > 0.0)
            {
                const osg::Vec2d before(x.back(), y.back());
                osg::Vec2d way = place - before;
                // Across the antimeridian.
                if (shortWay) way.x() = std::remainder(way.x(), 360.0);
                const double parts = std::min(std::ceil(way.length() / _longest), 1e6);
                for (double part = 1.0; part < parts; part += 1.0)
                {
                    x.push_back(before.x() + way.x() * part / parts);
                    y.push_back(before.y() + way.y() * part / parts);
                }
                if (x.size() > mostVertices) break;
            }
            x.push_back(place.x());
            y.push_back(place.y());
        }
        std::vector<int> success(x.size());
        if (!x.empty()) _toDegrees->Transform(x.size(), x.data(), y.data(), nullptr, success.data());
        std::vector<std::vector<osg::Vec2d>> pieces(1);
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            if (!success[i] || !std::isfinite(x[i]) || !(std::abs(y[i]) <= 90.0))
            {
                // The rest of a ring is closed by a straight line.
                if (!ring && !pieces.back().empty()) pieces.emplace_back();
                continue;
            }
            osg::Vec2d here(x[i], y[i]);
            std::vector<osg::Vec2d>& piece = pieces.back();
            // Without jumps: of lines, and of all that a projection has beyond the antimeridian.
            if (!piece.empty() && (shortWay || !_geographic))
                here.x() = piece.back().x() + std::remainder(here.x() - piece.back().x(), 360.0);
            piece.push_back(here);
        }
        if (ring && !pieces[0].empty()) close(pieces[0]);
        const std::size_t least = ring ? 4 : 2;
        pieces.erase(std::remove_if(pieces.begin(), pieces.end(),
                                    [least](const auto& piece) { return piece.size() < least; }),
                     pieces.end());
        return pieces;
    }

    /// A ring around a pole goes on over the pole.
    static void close(std::vector<osg::Vec2d>& ring)
    {
        const osg::Vec2d first = ring.front(), last = ring.back();
        if (std::abs(last.x() - first.x()) > 180.0)
        {
            double sum = 0.0;
            for (const osg::Vec2d& place : ring)
                sum += place.y();
            const double pole = sum > 0.0 ? 90.0 : -90.0;
            ring.emplace_back(last.x(), pole);
            ring.emplace_back(first.x(), pole);
        }
        if (ring.front() != ring.back()) ring.push_back(ring.front());
    }

    void addSymbols(OGRFeature& feature, const OGRGeometry& geometry, const SymbolPaint& paint,
                    bool everywhere)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        {
            for (const OGRGeometry* const part : *geometry.toGeometryCollection())
                addSymbols(feature, *part, paint, everywhere);
            return;
        }
        OGRPoint point;
        if (type != wkbPoint && !everywhere) return;
        // The symbol of an area stands within it, and that of a line at its middle.
        if (type == wkbPoint)
            point = *geometry.toPoint();
        else if (type == wkbLineString)
            geometry.toLineString()->Value(geometry.toLineString()->get_Length() / 2.0, &point);
        else if (geometry.Centroid(&point) != OGRERR_NONE)
            return;
        if (point.IsEmpty()) return;
        double x = point.getX(), y = point.getY();
        if (!_toDegrees->Transform(1, &x, &y) || !std::isfinite(x) || !(std::abs(y) <= 90.0)) return;
        VectorShapes::Symbol symbol;
        symbol.place.set(x, y);
        if (type == wkbPoint && OGR_GT_HasZ(geometry.getGeometryType()) && std::abs(point.getZ()) < 1e4 &&
            hasHeight(feature))
            symbol.height = point.getZ();
        if (_name >= 0 && feature.IsFieldSetAndNotNull(_name))
            symbol.name = cleanText(feature.GetFieldAsString(_name));
        const auto [found, isNew] =
            _symbols.emplace(paint.key(), static_cast<std::uint32_t>(_result.symbolPaints.size()));
        if (isNew) _result.symbolPaints.push_back(paint);
        symbol.paint = found->second;
        _result.symbols.push_back(std::move(symbol));
        if (_result.symbols.size() > mostSymbols)
            throw BuildError(_result.file +
                             ": it has more than 100,000 symbols; choose some with ogr2ogr -where.");
    }

    /// Whether the third number of a feature's places is a height above the sea: in KML it is in one mode alone.
    bool hasHeight(const OGRFeature& feature) const
    {
        return !_isKml || (_altitudeMode >= 0 && EQUAL(feature.GetFieldAsString(_altitudeMode), "absolute"));
    }

    /// By layers and passes, and within them by features.
    void order()
    {
        std::vector<std::size_t> sequence(_result.items.size());
        for (std::size_t i = 0; i < sequence.size(); ++i)
            sequence[i] = i;
        std::stable_sort(sequence.begin(), sequence.end(),
                         [this](std::size_t a, std::size_t b) { return _orders[a] < _orders[b]; });
        std::vector<VectorShapes::Item> items;
        for (const std::size_t i : sequence)
            items.push_back(_result.items[i]);
        _result.items = std::move(items);
    }

    void reach()
    {
        osg::Vec3d sum;
        const auto each = [&](const auto& take)
        {
            for (const VectorShape& shape : _result.shapes)
                for (const std::vector<osg::Vec2d>& part : shape.parts)
                    for (const osg::Vec2d& place : part)
                        take(directionOf(place));
            for (const VectorShapes::Symbol& symbol : _result.symbols)
                take(directionOf(symbol.place));
        };
        each([&](const osg::Vec3d& direction) { sum += direction; });
        if (sum.normalize() < 1e-9) sum.set(1.0, 0.0, 0.0);
        each(
            [&](const osg::Vec3d& direction)
            {
                const double angle = 2.0 * std::asin(std::min(1.0, (direction - sum).length() / 2.0));
                _result.radius = std::max(_result.radius, angle);
            });
        _result.middle.set(osg::RadiansToDegrees(std::atan2(sum.y(), sum.x())),
                           osg::RadiansToDegrees(std::asin(std::clamp(sum.z(), -1.0, 1.0))));
    }

    const VectorShapes::Options& _options;
    std::optional<FeatureStyle> _style;
    VectorShapes _result;
    std::vector<std::pair<std::size_t, std::size_t>> _orders; ///< of the items
    std::map<std::string, std::uint32_t> _paints, _symbols;
    std::size_t _vertices = 0, _layers = 0, _pass = 0, _features = 0;
    // Of the layer and the feature at hand.
    GDALDataset* _dataset = nullptr;
    OGRStyleTable* _styles = nullptr;
    bool _geographic = false;
    double _longest = 0.0;
    int _name = -1, _altitudeMode = -1;
    bool _isKml = false;
    OGRCoordinateTransformation* _toDegrees = nullptr;
    std::optional<std::vector<Found>> _shape;
};

} // namespace

VectorShapes VectorShapes::read(const std::string& file, const Options& options)
{
    initialiseGdal();
    return Reader(file, options).read();
}

bool VectorShapes::isVectors(const std::string& file)
{
    initialiseGdal();
    const GdalErrorScope quiet;
    const ReadingFile reading(file);
    if (!faultOfArchive(file).empty()) return false;
    if (DatasetPtr(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER))) return false;
    const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
    return dataset && dataset->GetLayerCount() > 0;
}

std::optional<DegreeBox> VectorShapes::reachOf(const MappingFrame& frame)
{
    const GdalErrorScope quiet;
    OGRSpatialReference srs;
    if (!setCoordinateSystem(srs, frame.wkt)) return std::nullopt;
    // The text of a coordinate system does not tell its area, but its number does.
    OGRSpatialReference known;
    const char* const code = srs.GetAuthorityCode(nullptr);
    const bool isKnown = code && known.importFromEPSG(std::atoi(code)) == OGRERR_NONE;
    DegreeBox box;
    const char* name = nullptr;
    if (!isKnown || !known.GetAreaOfUse(&box.west, &box.south, &box.east, &box.north, &name))
    {
        OGRErr fault = OGRERR_NONE;
        const double middle = srs.GetProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0, &fault);
        if (fault != OGRERR_NONE) return std::nullopt;
        constexpr double far = 60.0;
        return DegreeBox{middle - far, -89.0, middle + far, 89.0};
    }
    constexpr double margin = 5.0;
    if (box.east < box.west) box.east += 360.0;
    if (box.east - box.west > 300.0) return std::nullopt;
    return DegreeBox{box.west - margin, std::max(box.south - margin, -90.0), box.east + margin,
                     std::min(box.north + margin, 90.0)};
}

std::vector<VectorShape> VectorShapes::placedIn(const MappingFrame& frame,
                                                const std::optional<DegreeBox>& box) const
{
    const FrameCrs crs = crsOf(frame, file);
    OGRSpatialReference degrees, target;
    degrees.importFromEPSG(4326);
    target.SetFromUserInput(crs.definition.c_str());
    const TransformationPtr toFrame = createTransformation(gisOrder(degrees), gisOrder(target), file);
    const GdalErrorScope errors;
    std::vector<VectorShape> result(shapes.size());
    std::vector<double> x, y;
    std::vector<int> success;
    for (std::size_t i = 0; i < shapes.size(); ++i)
    {
        result[i].area = shapes[i].area;
        const std::vector<std::vector<osg::Vec2d>> parts =
            box ? cutToBox(shapes[i].parts, shapes[i].area, *box) : shapes[i].parts;
        for (const std::vector<osg::Vec2d>& part : parts)
        {
            x.resize(part.size());
            y.resize(part.size());
            success.assign(part.size(), FALSE);
            for (std::size_t k = 0; k < part.size(); ++k)
            {
                x[k] = part[k].x();
                y[k] = part[k].y();
            }
            toFrame->Transform(part.size(), x.data(), y.data(), nullptr, success.data());
            std::vector<std::vector<osg::Vec2d>> pieces(1);
            for (std::size_t k = 0; k < part.size(); ++k)
            {
                const osg::Vec2d place = osg::Vec2d(x[k], y[k]) * crs.metresPerUnit - crs.origin;
                constexpr double most = 4e7;
                if (success[k] && std::abs(place.x()) < most && std::abs(place.y()) < most)
                    pieces.back().push_back(place);
                else if (!shapes[i].area && !pieces.back().empty())
                    pieces.emplace_back();
            }
            for (std::vector<osg::Vec2d>& piece : pieces)
                if (piece.size() > 1) result[i].parts.push_back(std::move(piece));
        }
    }
    return result;
}

} // namespace osgGeoFX
