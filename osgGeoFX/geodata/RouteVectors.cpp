// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/RouteVectors.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/KmlOverlays.h>
#include <osgGeoFX/geodata/detail/FeatureTags.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/IgcFlight.h>
#include <osgGeoFX/geodata/detail/KmlFolder.h>
#include <osgGeoFX/geodata/detail/KmlLineReader.h>
#include <osgGeoFX/geodata/detail/LostFixes.h>
#include <osgGeoFX/geodata/detail/ReadingErrors.h>
#include <osgGeoFX/geodata/detail/Remarks.h>

#include <cpl_vsi.h>
#include <ogr_featurestyle.h>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Of a file and what it links.
constexpr std::size_t mostDocuments = 1000;
constexpr std::size_t mostBytes = std::size_t{1} << 30;

class Reader
{
public:
    Reader(const std::string& file, const std::string& layer) : _file(file), _layer(layer) {}

    std::vector<RoutePath> read()
    {
        if (KmlOverlays::isKml(_file))
            readKml();
        else if (isIgcFlight(_file))
            _found.push_back(readIgcFlight(_file, mostRoutePlaces));
        else
            readByGdal();
        for (RoutePath& way : _found)
        {
            const std::size_t all = way.places.size();
            if (const std::size_t lost = takeOutLostFixes(way))
                remarkOnce(
                    _file + ": " + std::to_string(lost) + " of the " + std::to_string(all) +
                    " places of the way \"" + way.name +
                    "\" lie far from the others, as lost fixes of a receiver do, and are left out; take "
                    "them out of the file, or correct them.");
        }
        _found.erase(std::remove_if(_found.begin(), _found.end(),
                                    [](const RoutePath& way) { return way.places.size() < 2; }),
                     _found.end());
        if (_found.empty())
            throw BuildError(
                _file + ": it has no way of two places or more; name another layer, or check the file with "
                        "ogrinfo -al.");
        return std::move(_found);
    }

    const std::vector<std::string>& files() const { return _files; }

private:
    /// With what its network links name within its folder; GDAL writes archives so.
    void readKml()
    {
        const KmlFolder folder(_file, false);
        std::vector<std::string> documents = {folder.document()};
        std::set<std::string> seen(documents.begin(), documents.end());
        std::size_t bytes = 0;
        for (std::size_t next = 0; next < documents.size(); ++next)
        {
            const std::string document = documents[next];
            _files.push_back(KmlFolder::onDisk(document));
            KmlLines content = readKmlLines(document, mostRoutePlaces - _places);
            _places += content.places;
            bytes += content.bytes;
            if (bytes > mostBytes)
                throw BuildError(_file + ": it and the files that it links have more than 1 GiB; open one of "
                                         "its parts instead.");
            std::move(content.routes.begin(), content.routes.end(), std::back_inserter(_found));
            for (const std::string& href : content.links)
            {
                const std::optional<std::string> linked = folder.resolve(document, href);
                VSIStatBufL status;
                if (!linked || VSIStatL(linked->c_str(), &status) != 0)
                {
                    tellMissing(document, href, linked.has_value());
                    continue;
                }
                if (!seen.insert(*linked).second) continue;
                if (seen.size() > mostDocuments)
                    throw BuildError(_file + ": it links more than " + std::to_string(mostDocuments) +
                                     " files; open one of its parts instead.");
                documents.push_back(*linked);
            }
        }
    }

    void tellMissing(const std::string& document, const std::string& href, bool within)
    {
        constexpr int most = 20;
        if (++_missing > most) return;
        OSG_WARN << "osgGeoFX: " << KmlFolder::plain(document) << ": the file \"" << href.substr(0, 200)
                 << "\" that it links " << (within ? "is not there" : "is not in its folder")
                 << ", and is left out." << (_missing == most ? " So are others, which are not named." : "")
                 << std::endl;
    }

    void readByGdal()
    {
        const DatasetPtr dataset = openVectors(_file);
        const bool isGpx = std::strcmp(dataset->GetDriver()->GetDescription(), "GPX") == 0;
        if (!isGpx) return forEachLayer(*dataset, _layer, _file, [&](OGRLayer& layer) { readLines(layer); });
        // GPX's lines have no heights, or 0 where there is none; its points tell.
        if (_layer.empty() || _layer == "routes")
            readPoints(*dataset, "routes", "route_points", "route_fid", nullptr);
        if (_layer.empty() || _layer == "tracks")
            readPoints(*dataset, "tracks", "track_points", "track_fid", "track_seg_id");
        if (!_layer.empty() && _layer != "routes" && _layer != "tracks")
            throw BuildError(_file + ": it has no layer \"" + _layer + "\" of ways; name routes or tracks.");
    }

    void readPoints(GDALDataset& dataset, const char* ways, const char* points, const char* number,
                    const char* segment)
    {
        OGRLayer* const wayLayer = dataset.GetLayerByName(ways);
        OGRLayer* const pointLayer = dataset.GetLayerByName(points);
        if (!wayLayer || !pointLayer) return;
        const GdalErrorScope errors;
        std::map<GIntBig, std::string> names;
        const int name = wayLayer->GetLayerDefn()->GetFieldIndex("name");
        for (const auto& way : *wayLayer)
            names[way->GetFID()] = name >= 0 ? cleanText(way->GetFieldAsString(name)) : std::string();
        const OGRFeatureDefn& fields = *pointLayer->GetLayerDefn();
        const int way = fields.GetFieldIndex(number);
        const int part = segment ? fields.GetFieldIndex(segment) : -1;
        const int height = fields.GetFieldIndex("ele");
        std::pair<GIntBig, int> present{-1, -1};
        std::vector<Segment> segments;
        for (const auto& point : *pointLayer)
        {
            const OGRGeometry* const geometry = point->GetGeometryRef();
            if (!geometry || wkbFlatten(geometry->getGeometryType()) != wkbPoint) continue;
            const osg::Vec2d place(geometry->toPoint()->getX(), geometry->toPoint()->getY());
            if (geometry->IsEmpty() || !(std::abs(place.x()) <= 360.0) || !(std::abs(place.y()) <= 90.0))
                throw BuildError(_file + ": a place of its " + ways + " is none (" +
                                 std::to_string(place.x()) + ", " + std::to_string(place.y()) +
                                 "); write lon and lat in degrees.");
            const std::pair<GIntBig, int> here{point->GetFieldAsInteger64(way),
                                               part < 0 ? 0 : point->GetFieldAsInteger(part)};
            if (here != present)
            {
                present = here;
                segments.push_back({here.first, {}, true});
                segments.back().path.name = names[here.first];
                segments.back().path.wayPoints = !segment;
            }
            const bool hasHeight = height >= 0 && point->IsFieldSetAndNotNull(height) &&
                                   std::isfinite(point->GetFieldAsDouble(height));
            segments.back().haveHeights = segments.back().haveHeights && hasHeight;
            take({place.x(), place.y(), hasHeight ? point->GetFieldAsDouble(height) : 0.0},
                 segments.back().path);
        }
        checkReading(errors);
        joinLonePoints(segments);
        for (Segment& each : segments)
        {
            if (each.haveHeights)
                each.path.altitude = RoutePath::ABSOLUTE;
            else
                for (osg::Vec3d& place : each.path.places)
                    place.z() = 0.0;
            if (each.path.places.size() > 1) _found.push_back(std::move(each.path));
        }
    }

    /// Of a way of GPX, by its number there.
    struct Segment
    {
        GIntBig way;
        RoutePath path;
        bool haveHeights;
    };

    /// Some recorders begin a segment at each point: neighbours of one point each become one segment.
    static void joinLonePoints(std::vector<Segment>& segments)
    {
        std::vector<Segment> joined;
        bool last = false; // whether the last one is made of lone points
        for (Segment& each : segments)
        {
            const bool lone = each.path.places.size() == 1;
            if (lone && last && joined.back().way == each.way)
            {
                joined.back().path.places.push_back(each.path.places.front());
                joined.back().haveHeights = joined.back().haveHeights && each.haveHeights;
            }
            else
                joined.push_back(std::move(each));
            last = lone;
        }
        segments = std::move(joined);
    }

    /// Tables of attributes have no coordinate system, and points and areas hold no lines.
    static bool mayHoldLines(OGRLayer& layer)
    {
        const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
        if (type == wkbUnknown || type == wkbGeometryCollection) return true;
        return OGR_GT_IsCurve(type) || OGR_GT_IsSubClassOf(type, wkbMultiCurve);
    }

    void readLines(OGRLayer& layer)
    {
        if (!mayHoldLines(layer)) return;
        const OGRSpatialReference* srs = layer.GetSpatialRef();
        if (!srs || srs->IsEmpty() || srs->IsLocal())
            throw BuildError(_file + ": its layer " + std::string(layer.GetName()) +
                             " has no coordinate reference system; name it with ogr2ogr -a_srs EPSG:N.");
        OGRSpatialReference degrees;
        degrees.importFromEPSG(4326);
        const TransformationPtr toDegrees = createTransformation(gisOrder(*srs), gisOrder(degrees), _file);
        const FeatureTags name(*layer.GetLayerDefn(), {"name"});
        const GdalErrorScope errors;
        for (const auto& feature : layer)
        {
            if (!feature->GetGeometryRef()) continue;
            RoutePath route;
            route.name = name.of(*feature);
            route.color = colorOf(*feature);
            const std::unique_ptr<OGRGeometry> lines(feature->GetGeometryRef()->getLinearGeometry());
            takeLines(*lines, route, *toDegrees);
        }
        checkReading(errors);
    }

    static std::optional<osg::Vec4> colorOf(OGRFeature& feature)
    {
        OGRStyleMgr style;
        if (!style.InitFromFeature(&feature)) return std::nullopt;
        for (int i = 0; i < style.GetPartCount(); ++i)
        {
            const std::unique_ptr<OGRStyleTool> tool(style.GetPart(i));
            if (!tool || tool->GetType() != OGRSTCPen) continue;
            GBool isNone = FALSE;
            const char* const text = static_cast<OGRStylePen&>(*tool).Color(isNone);
            int red = 0, green = 0, blue = 0, alpha = 255;
            if (isNone || !text || !tool->GetRGBFromString(text, red, green, blue, alpha)) continue;
            return osg::Vec4(osg::Vec4d(red, green, blue, alpha) / 255.0);
        }
        return std::nullopt;
    }

    void takeLines(const OGRGeometry& geometry, const RoutePath& like, OGRCoordinateTransformation& toDegrees)
    {
        const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
        if (type == wkbLineString)
        {
            RoutePath route = like;
            const OGRLineString& line = *geometry.toLineString();
            const bool hasHeights = OGR_GT_HasZ(geometry.getGeometryType());
            if (hasHeights) route.altitude = RoutePath::ABSOLUTE;
            for (int i = 0; i < line.getNumPoints(); ++i)
            {
                double x = line.getX(i);
                double y = line.getY(i);
                if (toDegrees.Transform(1, &x, &y) && std::abs(x) <= 360.0 && std::abs(y) <= 90.0 &&
                    (!hasHeights || std::isfinite(line.getZ(i))))
                    take({x, y, hasHeights ? line.getZ(i) : 0.0}, route);
            }
            if (route.places.size() > 1) _found.push_back(std::move(route));
        }
        else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection))
        {
            for (const OGRGeometry* const part : *geometry.toGeometryCollection())
                takeLines(*part, like, toDegrees);
        }
    }

    void take(const osg::Vec3d& place, RoutePath& route)
    {
        if (++_places > mostRoutePlaces)
            throw BuildError(
                _file + ": it has more than ten million places; simplify its lines with ogr2ogr -simplify.");
        route.places.push_back(place);
    }

    void checkReading(const GdalErrorScope& errors) const
    {
        if (errors.failed())
            throw BuildError(
                _file + ": its features cannot be read" +
                causeAndRemedy(errors.message(), "the file may be cut short: copy or export it again") + ".");
    }

    const std::string& _file;
    const std::string& _layer;
    std::vector<RoutePath> _found;
    std::size_t _places = 0;
    int _missing = 0;
    std::vector<std::string> _files;
};

} // namespace

bool RouteVectors::read(const std::string& file, const std::string& layer, std::vector<RoutePath>& routes,
                        std::string& error, std::vector<std::string>* files)
{
    initialiseGdal();
    try
    {
        Reader reader(file, layer);
        std::vector<RoutePath> found = reader.read();
        if (files) files->insert(files->end(), reader.files().begin(), reader.files().end());
        routes.insert(routes.end(), std::make_move_iterator(found.begin()),
                      std::make_move_iterator(found.end()));
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
