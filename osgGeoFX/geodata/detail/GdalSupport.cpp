// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/DataGuard.h>
#include <osgGeoFX/geodata/detail/ReadingErrors.h>
#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/paging/ReadingFile.h>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <regex>

namespace osgGeoFX
{

BuildError::~BuildError() = default;

bool DatasetChain::add(DatasetPtr dataset)
{
    if (!dataset) return false;
    constexpr int references = 65536; // a virtual dataset takes one away for each band and overview
    for (int i = 0; i < references; ++i)
        dataset->Reference();
    _datasets.push_back(std::move(dataset));
    return true;
}

void DatasetChain::clear()
{
    while (!_datasets.empty())
        _datasets.pop_back();
}

namespace
{

void setUnlessSet(const char* option, const std::string& value)
{
    if (!CPLGetConfigOption(option, nullptr)) CPLSetConfigOption(option, value.c_str());
}

/// GDAL puts the tiles of WMTS and XYZ services into the folder that a program happens to run in, unless it is told another one.
void chooseTileCache()
{
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    const char* const home = std::getenv("HOME");
    std::filesystem::path folder;
    if (cache && std::filesystem::path(cache).is_absolute())
        folder = cache;
    else if (home && *home)
        folder = std::filesystem::path(home) / ".cache";
    else
        return;
    setUnlessSet("GDAL_DEFAULT_WMS_CACHE_PATH", (folder / "osgGeoFX" / "services").string());
}

/// As RemoteFiles: 10 seconds for a connection, and 30 without a byte. GDAL would wait for five minutes.
void limitWaits()
{
    setUnlessSet("GDAL_HTTP_CONNECTTIMEOUT", "10");
    setUnlessSet("GDAL_HTTP_LOW_SPEED_TIME", "30");
    setUnlessSet("GDAL_HTTP_LOW_SPEED_LIMIT", "1");
    // Of files by /vsicurl/, and of documents.
    setUnlessSet("GDAL_HTTP_MAX_RETRY", "2");
    setUnlessSet("GDAL_HTTP_RETRY_DELAY", "0.5");
}

} // namespace

void initialiseGdal()
{
    static std::once_flag once;
    std::call_once(once,
                   []
                   {
                       GDALAllRegister();
                       chooseTileCache();
                       limitWaits();
                   });
    if (FilesByOthers::Scope::folder()) guardGdal();
}

GdalErrorScope::GdalErrorScope()
{
    CPLPushErrorHandlerEx(&GdalErrorScope::handle, this);
}

GdalErrorScope::~GdalErrorScope()
{
    CPLPopErrorHandler();
}

void CPL_STDCALL GdalErrorScope::handle(CPLErr severity, CPLErrorNum number, const char* text)
{
    auto* scope = static_cast<GdalErrorScope*>(CPLGetErrorHandlerUserData());
    if ((severity >= CE_Failure || number == refusedByGuard) && scope->_message.empty())
        scope->_message = text;
}

std::shared_ptr<GdalCacheLimit> GdalCacheLimit::small()
{
    constexpr GIntBig most = 64 << 20; // bytes
    static std::mutex mutex;
    static std::weak_ptr<GdalCacheLimit> limit;
    const std::lock_guard<std::mutex> lock(mutex);
    std::shared_ptr<GdalCacheLimit> result = limit.lock();
    if (!result) result = std::make_shared<GdalCacheLimit>(std::min(most, GDALGetCacheMax64()));
    limit = result;
    return result;
}

OGRSpatialReference gisOrder(OGRSpatialReference srs)
{
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return srs;
}

TransformationPtr createTransformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                                       const std::string& file)
{
    GdalErrorScope errors;
    TransformationPtr result(OGRCreateCoordinateTransformation(&from, &to));
    if (!result)
        throw BuildError(file + ": no transformation is known from the CRS \"" + from.GetName() + "\" to \"" +
                         to.GetName() + "\" (" + errors.message() +
                         "); reproject the file with gdalwarp first.");
    return result;
}

std::string faultOfBlocks(GDALDataset& raster)
{
    constexpr double most = 268435456.0; // bytes
    GDALRasterBand& band = *raster.GetRasterBand(1);
    int columns = 0;
    int rows = 0;
    band.GetBlockSize(&columns, &rows);
    const char* const order = raster.GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
    const int bands = order && EQUAL(order, "PIXEL") ? raster.GetRasterCount() : 1;
    if (static_cast<double>(columns) * rows * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) * bands <=
        most)
        return {};
    return "its pixels lie in blocks of " + std::to_string(columns) + " × " + std::to_string(rows) +
           ", each of which is read at once; convert it to a tiled GeoTIFF";
}

std::string faultOfArchive(const std::string& file)
{
    constexpr double harmless = 8.0 * 1024.0 * 1024.0; // bytes
    constexpr double most = 100.0;                     // times the archive's own
    std::ifstream stream(file, std::ios::binary);
    char start[2] = {};
    if (!stream.read(start, sizeof(start)) || start[0] != 'P' || start[1] != 'K') return {};
    std::error_code fault;
    const auto packed = static_cast<double>(std::filesystem::file_size(file, fault));
    const GdalErrorScope errors;
    const std::unique_ptr<VSIDIR, void (*)(VSIDIR*)> folder(
        VSIOpenDir(("/vsizip/{" + file + "}").c_str(), -1, nullptr), &VSICloseDir);
    double unpacked = 0.0;
    while (const VSIDIREntry* const entry = folder ? VSIGetNextDirEntry(folder.get()) : nullptr)
        unpacked += static_cast<double>(entry->nSize);
    if (fault || unpacked <= std::max(harmless, most * packed)) return {};
    return "it unpacks to " + std::to_string(std::lround(unpacked / 1048576.0)) +
           " MiB, more than a hundred times its own size; unpack it with unzip, and name a file of it";
}

namespace
{

constexpr const char* csvOptions[] = {"X_POSSIBLE_NAMES=longitude,lon,lng,long,x,easting",
                                      "Y_POSSIBLE_NAMES=latitude,lat,y,northing",
                                      "GEOM_POSSIBLE_NAMES=wkt,geom,the_geom,geometry,_WKT", nullptr};

void placeCsv(GDALDataset& dataset, const std::string& file)
{
    for (OGRLayer* const layer : dataset.GetLayers())
    {
        if (layer->GetGeomType() == wkbNone)
            throw BuildError(file +
                             ": it has no columns of places; call them longitude and latitude, lon and "
                             "lat, x and y, or WKT.");
        OGREnvelope box;
        if (layer->GetSpatialRef() || layer->GetExtent(&box, TRUE) != OGRERR_NONE || box.MinX < -360.0 ||
            box.MaxX > 360.0 || box.MinY < -90.0 || box.MaxY > 90.0)
            continue;
        // The layer shares it, and counts who does.
        auto* const degrees = new OGRSpatialReference;
        degrees->importFromEPSG(4326);
        degrees->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        layer->GetLayerDefn()->GetGeomFieldDefn(0)->SetSpatialRef(degrees);
        degrees->Release();
        layer->ResetReading();
    }
}

} // namespace

namespace
{

/// GDAL's layout of OpenStreetMap's layers, which takes heights out of the tags, with them. Empty if there is none.
std::string osmLayout()
{
    static const std::string name = []() -> std::string
    {
        const char* const usual = CPLFindFile("gdal", "osmconf.ini");
        std::ifstream stream(usual ? usual : "");
        std::string text;
        for (std::string line; std::getline(stream, line); text += line + "\n")
        {
            const std::size_t at = line.find(",ele,");
            if (line.rfind("ignore=", 0) == 0 && at != std::string::npos) line.erase(at, 4);
        }
        if (text.empty()) return {};
        const std::string file = "/vsimem/osgGeoFX/osmconf.ini";
        VSILFILE* const written = VSIFOpenL(file.c_str(), "wb");
        if (!written) return {};
        const bool whole = VSIFWriteL(text.data(), 1, text.size(), written) == text.size();
        return VSIFCloseL(written) == 0 && whole ? file : std::string();
    }();
    return name;
}

/// GDAL would read lat="45,5" as 45.
void checkCommas(const std::string& file)
{
    constexpr std::size_t most = 65536; // of the file's beginning
    std::string text(most, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    static const std::regex comma("[ \t\r\n](lat|lon)=[\"'][-+]?[0-9]+,[0-9]");
    if (std::regex_search(text, comma))
        throw BuildError(file +
                         ": its degrees have decimal commas, behind which all would be lost; write points.");
}

/// What GDAL should know of a format.
CPLStringList vectorOptions(const std::string& format, const std::string& file)
{
    CPLStringList options;
    if (format == "CSV")
        for (const char* const* each = csvOptions; *each; ++each)
            options.AddString(*each);
    if (format == "OSM" && !osmLayout().empty()) options.SetNameValue("CONFIG_FILE", osmLayout().c_str());
    // Servers hand out XML in any order; packed extracts are sorted.
    if (format == "OSM" && !EQUAL(CPLGetExtension(file.c_str()), "pbf"))
        options.SetNameValue("USE_CUSTOM_INDEXING", "NO");
    return options;
}

/// For a file that no driver of GDAL takes for vector data.
std::string remedyFor(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::string start(1024, '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    const auto has = [&](const char* words)
    {
        return start.find(words) != std::string::npos;
    };
    const auto gpsBabel = [&](const char* format)
    {
        return std::string("convert it to GPX with gpsbabel -i ") + format + " -f " + file +
               " -o gpx -F FILE.gpx";
    };
    if (has("<TrainingCenterDatabase")) return gpsBabel("gtrnctr");
    if (start.compare(8, 4, ".FIT") == 0) return gpsBabel("garmin_fit");
    // Elements with a prefix, as in <g:gpx>.
    if (has("http://www.topografix.com/GPX/")) return gpsBabel("gpx");
    return "check it with ogrinfo, or convert it with ogr2ogr";
}

} // namespace

DatasetPtr openVectors(const std::string& file)
{
    const ReadingFile reading(file);
    const std::string fault = faultOfArchive(file);
    if (!fault.empty()) throw BuildError(file + ": " + fault + ".");
    const GdalErrorScope errors;
    GDALDriverH const driver = GDALIdentifyDriverEx(file.c_str(), GDAL_OF_VECTOR, nullptr, nullptr);
    const std::string format = driver ? GDALGetDriverShortName(driver) : "";
    DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_VERBOSE_ERROR, nullptr,
                                         vectorOptions(format, file).List()));
    if (dataset && format == "CSV") placeCsv(*dataset, file);
    if (dataset && format == "GPX") checkCommas(file);
    if (!dataset && !driver && GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr))
        throw BuildError(file +
                         ": it is a raster and has no vector data; make areas of it with gdal_polygonize.");
    if (!dataset) throw BuildError(refusalOf(file, "vector data", errors.message(), remedyFor(file)) + ".");
    return dataset;
}

void forEachLayer(GDALDataset& dataset, const std::string& layer, const std::string& file,
                  const std::function<void(OGRLayer&)>& take)
{
    if (layer.empty())
    {
        for (OGRLayer* const each : dataset.GetLayers())
            if (each->GetGeomType() != wkbNone) take(*each);
        return;
    }
    OGRLayer* const named = dataset.GetLayerByName(layer.c_str());
    if (!named) throw BuildError(file + ": it has no layer \"" + layer + "\"; ogrinfo lists those it has.");
    if (named->GetGeomType() == wkbNone)
        throw BuildError(file + ": its layer " + layer + " is a table without places; name another layer.");
    take(*named);
}

bool isGroundOverlay(const OGRFeature& feature)
{
    const OGRFeatureDefn& fields = *feature.GetDefnRef();
    const int icon = fields.GetFieldIndex("icon");
    if (icon < 0 || fields.GetFieldIndex("drawOrder") < 0) return false;
    return *feature.GetFieldAsString(icon) &&
           wkbFlatten(feature.GetGeometryRef()->getGeometryType()) == wkbPolygon;
}

void forEachFeature(
    OGRLayer& layer, const OGRSpatialReference& target, const std::string& file,
    const std::function<void(const OGRFeature&, const OGRGeometry&, OGRCoordinateTransformation&)>& take,
    LongLines longLines)
{
    const OGRSpatialReference* srs = layer.GetSpatialRef();
    if (!srs || srs->IsEmpty() || srs->IsLocal())
        throw BuildError(file + ": its layer " + std::string(layer.GetName()) +
                         " has no coordinate reference system; name it with ogr2ogr -a_srs EPSG:N.");
    const TransformationPtr toTarget = createTransformation(gisOrder(*srs), gisOrder(target), file);
    const ReadingFile reading(file);
    const double part = srs->IsGeographic() ? 0.01 : 1000.0 / srs->GetLinearUnits();
    const GdalErrorScope errors;
    for (const auto& feature : layer)
    {
        if (!feature->GetGeometryRef()) continue;
        const std::unique_ptr<OGRGeometry> geometry(feature->GetGeometryRef()->getLinearGeometry());
        if (!geometry) continue;
        if (longLines == LongLines::DIVIDED) geometry->segmentize(part);
        take(*feature, *geometry, *toTarget);
    }
    if (errors.failed())
        throw BuildError(
            file + ": its features cannot be read" +
            causeAndRemedy(errors.message(), "the file may be cut short: copy or export it again") + ".");
}

} // namespace osgGeoFX
