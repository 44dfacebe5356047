// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Raster and vector data of scenes by others: which of GDAL's formats are read, and that nothing is fetched, written, run or read outside
// the folder, also while pixels and features are read.
#include <tools/FolderContents.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <tools/TestServer.h>
#include <tools/WatchedProgram.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osgDB/WriteFile>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/paging/FilesByOthers.h>

#include <cpl_conv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <set>
#include <tuple>

using namespace geofx::test;
using osgGeoFX::FilesByOthers;
namespace fs = std::filesystem;

namespace
{

// How a format could lead outside of a scene's folder.
const char* const server = "its data lie on a server or in a data base";
const char* const library = "a library of its own opens the file, past GDAL's file systems";
const char* const names = "its file names others, and little data is of this kind";
const char* const rare = "little data is of this kind";
const char* const beside = "by links in the place of files beside it";

struct Verdict
{
    const char* format; ///< GDAL's short name
    bool isRead;        ///< in scenes by others
    const char* reach;  ///< how it could lead outside
};

/// All formats of Debian's GDAL.
const Verdict verdicts[] = {
    {"AAIGrid", true, beside},
    {"ACE2", false, names},
    {"ADRG", false, names},
    {"AIG", true, beside},
    {"AirSAR", false, names},
    {"AmigoCloud", false, server},
    {"ARG", false, rare},
    {"AVCBin", false, names},
    {"AVCE00", false, rare},
    {"BAG", false, "HDF's library opens the file, and external links and storage name others"},
    {"BIGGIF", true, beside},
    {"BLX", false, rare},
    {"BMP", true, beside},
    {"BSB", false, rare},
    {"BT", true, beside},
    {"BYN", false, names},
    {"CAD", false, "references to other drawings"},
    {"CALS", false, rare},
    {"Carto", false, server},
    {"CEOS", false, rare},
    {"COASP", false, names},
    {"COG", false, "it only writes"},
    {"COSAR", false, names},
    {"CPG", false, names},
    {"CSV", true, beside},
    {"CSW", false, server},
    {"CTable2", false, rare},
    {"CTG", false, names},
    {"DAAS", false, server},
    {"DERIVED", false, "its name holds another name"},
    {"DGN", false, rare},
    {"DIMAP", false, names},
    {"DIPEx", false, names},
    {"DOQ1", false, rare},
    {"DOQ2", false, rare},
    {"DTED", true, beside},
    {"DXF", true, beside},
    {"ECRGTOC", false, names},
    {"EDIGEO", false, names},
    {"EEDA", false, server},
    {"EEDAI", false, server},
    {"EHdr", true, beside},
    {"EIR", false, names},
    {"ELAS", false, rare},
    {"Elasticsearch", false, server},
    {"ENVI", true, beside},
    {"ERS", true, "its file names parts, which GDAL's file systems open"},
    {"ESAT", false, rare},
    {"ESRI Shapefile", true, beside},
    {"ESRIC", false, names},
    {"ESRIJSON", true, "its name may be an address, which is not fetched"},
    {"FAST", false, names},
    {"FIT", false, rare},
    {"FITS", false, "CFITSIO opens the file, whose extended names are addresses, filters and files to write"},
    {"FlatGeobuf", true, beside},
    {"GenBin", false, names},
    {"Geoconcept", false, names},
    {"GeoJSON", true, "its name may be an address, which is not fetched"},
    {"GeoJSONSeq", true, beside},
    {"GeoRSS", false, rare},
    {"GFF", false, names},
    {"GIF", true, beside},
    {"GML", false,
     "schemas and links of XML are files and addresses, and it writes what it has found beside the file"},
    {"GMLAS", false,
     "schemas and links of XML are files and addresses, and it writes what it has found beside the file"},
    {"GPKG", true, "virtual tables, views and SQL, without Spatialite and by GDAL's file systems"},
    {"GPSBabel", false, "it runs the program gpsbabel"},
    {"GPX", true, beside},
    {"GRASSASCIIGrid", true, beside},
    {"GRIB", true, beside},
    {"GS7BG", true, beside},
    {"GSAG", true, beside},
    {"GSBG", true, beside},
    {"GSC", false, rare},
    {"GTiff", true, "metadata name a file of overviews"},
    {"GTX", false, rare},
    {"GXF", false, rare},
    {"HDF4", false, "HDF's library opens the file, and external links and storage name others"},
    {"HDF4Image", false, "HDF's library opens the file, and external links and storage name others"},
    {"HDF5", false, "HDF's library opens the file, and external links and storage name others"},
    {"HDF5Image", false, "HDF's library opens the file, and external links and storage name others"},
    {"HEIF", false, library},
    {"HF2", false, rare},
    {"HFA", true, "its file names parts, which GDAL's file systems open"},
    {"HTTP", false, server},
    {"Idrisi", false, names},
    {"ILWIS", false, names},
    {"Interlis 1", false,
     "schemas and links of XML are files and addresses, and it writes what it has found beside the file"},
    {"Interlis 2", false,
     "schemas and links of XML are files and addresses, and it writes what it has found beside the file"},
    {"IRIS", false, rare},
    {"ISCE", false, names},
    {"ISG", false, rare},
    {"ISIS2", false, names},
    {"ISIS3", false, names},
    {"JAXAPALSAR", false, names},
    {"JDEM", false, rare},
    {"JML", false, rare},
    {"JP2OpenJPEG", true, beside},
    {"JPEG", true, beside},
    {"KML", true, beside},
    {"KMLSUPEROVERLAY", false, "its NetworkLinks are files and addresses"},
    {"KRO", false, names},
    {"L1B", false, rare},
    {"LAN", false, rare},
    {"LCP", false, names},
    {"Leveller", false, rare},
    {"LIBKML", true, "links, which it does not follow"},
    {"LOSLAS", false, rare},
    {"LVBAG", false,
     "schemas and links of XML are files and addresses, and it writes what it has found beside the file"},
    {"MAP", false, names},
    {"MapInfo File", true, "its file names parts, which GDAL's file systems open"},
    {"MapML", false, names},
    {"MBTiles", true, "virtual tables, views and SQL, without Spatialite and by GDAL's file systems"},
    {"MEM", false, "its name is an address in the program's memory"},
    {"GNMDatabase", false, server},
    {"GNMFile", false, names},
    {"Memory", false, "it has no files"},
    {"MFF", false, names},
    {"MFF2", false, names},
    {"MRF", false, "its CachedSource is any raster or address, and it writes its DataFile"},
    {"MSGN", false, rare},
    {"MSSQLSpatial", false, server},
    {"MVT", true, "its name may be an address, which is not fetched"},
    {"MySQL", false, server},
    {"NAS", false,
     "schemas and links of XML are files and addresses, and it writes what it has found beside the file"},
    {"NDF", false, names},
    {"netCDF", true, "classic files name no others; those upon HDF5 are not read"},
    {"NGSGEOID", false, rare},
    {"NGW", false, server},
    {"NITF", false, names},
    {"NTv2", false, rare},
    {"NWT_GRC", false, names},
    {"NWT_GRD", false, names},
    {"OAPIF", false, server},
    {"ODBC", false, "a driver of ODBC runs, which the connection's text chooses"},
    {"ODS", false, library},
    {"OGCAPI", false, server},
    {"OGR_GMT", true, beside},
    {"OGR_OGDI", false, "it loads libraries by the name in the address"},
    {"OGR_PDS", false, names},
    {"OGR_SDTS", false, names},
    {"OGR_VRT", false,
     "its sources are any files and addresses, and SrcSQL is SQL with functions that set GDAL's options"},
    {"OpenFileGDB", true, beside},
    {"OSM", false, "it writes a data base of its own beside the file or among the temporary files"},
    {"OZI", false, names},
    {"PAux", false, names},
    {"PCIDSK", false, names},
    {"PCRaster", false, library},
    {"PDF", false, "a whole library of documents, with scripts and links"},
    {"PDS", false, names},
    {"PDS4", false, names},
    {"PGDUMP", false, "it only writes"},
    {"PGeo", false, "a driver of ODBC runs, which the connection's text chooses"},
    {"PLMOSAIC", false, server},
    {"PLSCENES", false, server},
    {"PNG", true, beside},
    {"PNM", true, beside},
    {"PostGISRaster", false, server},
    {"PostgreSQL", false, server},
    {"PRF", false, names},
    {"R", false, rare},
    {"Rasterlite", false, "a data base that names others"},
    {"RIK", false, rare},
    {"RMF", false, names},
    {"ROI_PAC", false, names},
    {"RPFTOC", false, names},
    {"RRASTER", false, names},
    {"RS2", false, names},
    {"RST", true, beside},
    {"S57", false, names},
    {"SAFE", false, names},
    {"SAGA", true, beside},
    {"SAR_CEOS", false, names},
    {"SDTS", false, names},
    {"Selafin", false, names},
    {"SENTINEL2", false, names},
    {"SGI", false, rare},
    {"SIGDEM", false, rare},
    {"SNODAS", false, names},
    {"SOSI", false, library},
    {"SQLite", true, "virtual tables, views and SQL, without Spatialite and by GDAL's file systems"},
    {"SRP", false, names},
    {"SRTMHGT", true, beside},
    {"STACIT", false, server},
    {"STACTA", false, server},
    {"SVG", false, library},
    {"SXF", false, rare},
    {"Terragen", false, rare},
    {"TGA", true, beside},
    {"TIGER", false, names},
    {"TIL", false, names},
    {"TopoJSON", true, "its name may be an address, which is not fetched"},
    {"TSX", false, names},
    {"UK .NTF", false, names},
    {"USGSDEM", true, beside},
    {"VDV", false, names},
    {"VFK", false, "it writes a data base of its own beside the file or among the temporary files"},
    {"VICAR", false, names},
    {"VRT", true, "its sources are any files and addresses, and its functions may be Python"},
    {"WAsP", false, rare},
    {"WCS", false, server},
    {"WEBP", true, beside},
    {"WFS", false, server},
    {"WMS", false, server},
    {"WMTS", false, server},
    {"XLS", false, library},
    {"XLSX", false, library},
    {"XPM", false, rare},
    {"XYZ", true, beside},
    {"Zarr", true, beside},
    {"ZMap", false, rare},
};

TEST(HostileFormats, EachOfGdalsFormatsHasItsVerdict)
{
    GDALAllRegister();
    std::map<std::string, bool> known;
    for (const Verdict& verdict : verdicts)
        EXPECT_TRUE(known.emplace(verdict.format, verdict.isRead).second)
            << verdict.format << " is there twice";
    for (int i = 0; i < GetGDALDriverManager()->GetDriverCount(); ++i)
    {
        const std::string format = GetGDALDriverManager()->GetDriver(i)->GetDescription();
        const auto found = known.find(format);
        if (found == known.end())
            ADD_FAILURE() << format << ": find out how it could lead outside, and add it to the table";
        else
            EXPECT_EQ(osgGeoFX::FileSources::isFormatByOthers(format), found->second) << format;
    }
}

/// What the files outside hold.
constexpr double secret = 77.0;

/// A folder "scene" of somebody else's, a folder "home" that it must not reach, and a server.
class HostileData : public testing::Test
{
protected:
    HostileData() : _server(_place / "home")
    {
        fs::create_directories(_place / "scene");
        fs::create_directories(_place / "home");
        raster("scene/in.tif", 5.0);
        for (const std::string name : {"a", "b"})
        {
            raster("home/" + name + ".tif", secret);
            _place.write(
                "home/" + name + ".geojson",
                R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"secret"},
                             "geometry":{"type":"Point","coordinates":[1,2]}}]})");
            _place.write("home/" + name + ".csv", "name,longitude\nsecret,1\n");
            _place.write("home/" + name + ".raw", std::string(64, static_cast<char>(secret)));
        }
        // The limits begin with the first scene by others.
        const FilesByOthers::Scope scope((_place / "scene").string());
        osgGeoFX::FileSources::of(in("in.tif"));
    }

    std::string in(const std::string& name) const { return (_place / "scene" / name).string(); }
    std::string out(const std::string& name) const { return (_place / "home" / name).string(); }
    std::string write(const std::string& name, const std::string& text) const
    {
        return _place.write("scene/" + name, text).string();
    }
    void raster(const std::string& name, double value) const
    {
        TestRaster(8, 8, 1, GDT_Byte)
            .placed(0, 8, 1, 1)
            .crs("EPSG:4326")
            .fill([value](int, int, int) { return value; })
            .write(_place / name);
    }
    /// A virtual raster with what stands in its band.
    std::string virtualRaster(const std::string& name, const std::string& band,
                              const std::string& kind = "") const
    {
        return write(name, "<VRTDataset rasterXSize='8' "
                           "rasterYSize='8'><SRS>EPSG:4326</SRS><GeoTransform>0,1,0,8,0,-1</GeoTransform>"
                           "<VRTRasterBand dataType='Byte' band='1'" +
                               kind + ">" + band + "</VRTRasterBand></VRTDataset>");
    }
    std::string source(const std::string& file, const std::string& options = "") const
    {
        return "<SimpleSource><SourceFilename relativeToVRT='0'>" + file + "</SourceFilename>" + options +
               "<SourceBand>1</SourceBand></SimpleSource>";
    }

    /// All pixels and attributes, as any of our readers gets them: whether the secret is among them.
    static bool readsSecret(const std::string& file)
    {
        const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
        bool isSecret = false;
        if (const DatasetPtr dataset{GDALDataset::Open(file.c_str(), GDAL_OF_RASTER)})
        {
            for (int band = 1; band <= dataset->GetRasterCount(); ++band)
            {
                const int columns = std::min(dataset->GetRasterXSize(), 64),
                          rows = std::min(dataset->GetRasterYSize(), 64);
                std::vector<double> pixels(static_cast<std::size_t>(columns) *
                                           static_cast<std::size_t>(rows));
                // Smaller, so that overviews are read, and in full.
                for (const int divisor : {2, 1})
                {
                    if (dataset->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, columns, rows, pixels.data(),
                                                               columns / divisor, rows / divisor, GDT_Float64,
                                                               0, 0, nullptr) != CE_None)
                        continue;
                    isSecret = isSecret || std::count(pixels.begin(), pixels.end(), secret) > 0;
                }
                // Masks are files, too.
                std::ignore = dataset->GetRasterBand(band)->GetMaskBand()->RasterIO(
                    GF_Read, 0, 0, 1, 1, pixels.data(), 1, 1, GDT_Float64, 0, 0, nullptr);
            }
        }
        if (const DatasetPtr dataset{GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR)})
        {
            for (OGRLayer* const layer : dataset->GetLayers())
                for (const auto& feature : *layer)
                    for (int field = 0; field < feature->GetFieldCount(); ++field)
                        isSecret = isSecret || std::string(feature->GetFieldAsString(field)).find("secret") !=
                                                   std::string::npos;
        }
        return isSecret;
    }

    /// Whether reading a file leads outside, written in one word; nothing if it does not.
    std::string wayOut(const std::string& file)
    {
        _server.forgetRequests();
        const std::map<std::string, std::string> before = contents(_place.path());
        const bool isSecret = readsSecret(file);
        const std::map<std::string, std::string> after = contents(_place.path());
        if (!_server.requests().empty()) return "fetched";
        if (isSecret) return "read";
        return before == after ? "" : "written";
    }

    /** A file that names others leads nowhere where it is by somebody else; where it is trusted, it does what is said. `make` writes it for
        files outside of a name, and returns its path. (GDAL remembers what it could not open.) */
    void expectHeld(const std::function<std::string(const std::string& name)>& make,
                    const std::string& trusted)
    {
        const std::string file = make("a");
        SCOPED_TRACE(file);
        {
            const FilesByOthers::Scope scope((_place / "scene").string());
            EXPECT_EQ(wayOut(file), "");
        }
        EXPECT_EQ(wayOut(make("b")), trusted)
            << "the test is none where GDAL does not lead outside by itself";
    }

    const TempDir _place;
    TestServer _server;
};

TEST_F(HostileData, VirtualRastersReachNothingOutside)
{
    const auto expectNamed = [&](const std::function<std::string(const std::string& outside)>& nameOf)
    {
        expectHeld([&](const std::string& name)
                   { return virtualRaster(name + ".vrt", source(nameOf(out(name + ".tif")))); },
                   "read");
    };
    expectNamed([](const std::string& outside) { return outside; });
    expectNamed([&](const std::string& outside)
                { return in("../home/" + fs::path(outside).filename().string()); });
    expectNamed([&](const std::string& outside)
                { return virtualRaster("upon-" + fs::path(outside).stem().string(), source(outside)); });
    expectNamed(
        [](const std::string& outside)
        {
            return "&lt;VRTDataset rasterXSize='8' rasterYSize='8'&gt;&lt;VRTRasterBand dataType='Byte' "
                   "band='1'&gt;&lt;SimpleSource&gt;"
                   "&lt;SourceFilename&gt;" +
                   outside +
                   "&lt;/SourceFilename&gt;&lt;/SimpleSource&gt;&lt;/VRTRasterBand&gt;&lt;/VRTDataset&gt;";
        });
    expectNamed([](const std::string& outside) { return "vrt://" + outside + "?bands=1"; });
    expectNamed([](const std::string& outside) { return "GTIFF_DIR:1:" + outside; });
    expectNamed([](const std::string& outside) { return "DERIVED_SUBDATASET:AMPLITUDE:" + outside; });
    expectNamed([](const std::string& outside) { return "/vsisubfile/0," + outside; });
    expectNamed(
        [&](const std::string& outside)
        {
            const std::string size = std::to_string(fs::file_size(outside));
            return "/vsisparse/" +
                   write(
                       fs::path(outside).stem().string() + ".xml",
                       "<VSISparseFile><Length>" + size + "</Length><SubfileRegion><Filename relative='0'>" +
                           outside +
                           "</Filename><DestinationOffset>0</DestinationOffset><SourceOffset>0</SourceOffset>"
                           "<RegionLength>" +
                           size + "</RegionLength></SubfileRegion></VSISparseFile>");
        });
    expectHeld(
        [&](const std::string& name)
        {
            return virtualRaster(name + ".vrt",
                                 "<SourceFilename relativeToVRT='0'>" + out(name + ".raw") +
                                     "</SourceFilename>",
                                 " subClass='VRTRawRasterBand'");
        },
        "read");
}

TEST_F(HostileData, LinksAndFilesBesideARasterLeadNowhere)
{
    const auto copy = [&](const std::string& name)
    {
        fs::copy_file(in("in.tif"), in(name), fs::copy_options::overwrite_existing);
        return in(name);
    };
    expectHeld(
        [&](const std::string& name)
        {
            fs::create_symlink(out(name + ".tif"), in("link-" + name));
            return in("link-" + name);
        },
        "read");
    expectHeld(
        [&](const std::string& name)
        {
            fs::create_symlink(out(name + ".tif"), in(name + ".tif.ovr"));
            return copy(name + ".tif");
        },
        "read");
    const auto overviews = [&](const std::string& name, const std::string& file)
    {
        write(name + ".aux.xml", "<PAMDataset><Metadata domain='OVERVIEWS'><MDI key='OVERVIEW_FILE'>" + file +
                                     "</MDI></Metadata></PAMDataset>");
        return copy(name);
    };
    expectHeld([&](const std::string& name) { return overviews("o" + name + ".tif", out(name + ".tif")); },
               "read");
    expectHeld([&](const std::string& name)
               { return overviews("w" + name + ".tif", "/vsicurl/" + _server.url(name + ".tif")); },
               "fetched");
}

TEST_F(HostileData, NothingIsFetched)
{
    const std::function<std::string(const std::string&)> rasters[] = {
        [&](const std::string& name) { return _server.url(name + ".tif"); },
        [&](const std::string& name) { return "/vsicurl/" + _server.url(name + ".tif"); },
        [&](const std::string& name) { return "/vsicurl_streaming/" + _server.url(name + ".png"); },
        [&](const std::string& name) { return "/vsicurl?max_retry=0&amp;url=" + _server.url(name + ".jpg"); },
        [&](const std::string& name) { return "/vsizip//vsicurl/" + _server.url(name + ".zip") + "/a.tif"; },
        [&](const std::string& name) { return "/vsigzip//vsicurl/" + _server.url(name + ".gz"); },
        [&](const std::string& name) { return "/vsitar//vsicurl/" + _server.url(name + ".tar") + "/a.tif"; },
        [&](const std::string& name) { return "/vsisubfile/0_64,/vsicurl/" + _server.url(name + ".gif"); },
        [&](const std::string& name) { return "WMTS:" + _server.url(name + "?SERVICE=WMTS"); },
        [&](const std::string& name)
        {
            return write(
                name + ".xml",
                "<GDAL_WMS><Service name='TMS'><ServerUrl>" + _server.url(name + "-${z}-${x}-${y}.png") +
                    "</ServerUrl></Service><DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>8</UpperLeftY>"
                    "<LowerRightX>8</LowerRightX><LowerRightY>0</LowerRightY><SizeX>256</SizeX><SizeY>256</"
                    "SizeY>"
                    "</DataWindow><BandsCount>1</BandsCount></GDAL_WMS>");
        }};
    for (const auto& nameOf : rasters)
        expectHeld([&](const std::string& name)
                   { return virtualRaster("web-" + name + ".vrt", source(nameOf(name))); },
                   "fetched");
    const std::function<std::string(const std::string&)> vectors[] = {
        [&](const std::string& name) { return "/vsicurl/" + _server.url(name + ".geojson"); },
        [&](const std::string& name) { return _server.url(name + ".csv"); },
        [&](const std::string& name) { return "WFS:" + _server.url(name); },
        [&](const std::string& name) { return "CSW:" + _server.url(name); },
        [&](const std::string& name) { return "OAPIF:" + _server.url(name); },
        [&](const std::string& name)
        {
            return "GMLAS:/vsicurl/" + _server.url(name + ".gml");
        }};
    for (const auto& nameOf : vectors)
    {
        SCOPED_TRACE(nameOf("a"));
        const FilesByOthers::Scope scope((_place / "scene").string());
        EXPECT_EQ(wayOut(nameOf("a")), "");
        EXPECT_EQ(
            wayOut(write("web.vrt", "<OGRVRTDataSource><OGRVRTLayer name='out'><SrcDataSource>" +
                                        nameOf("a") + "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>")),
            "");
    }
    expectHeld(
        [&](const std::string& name)
        {
            const std::string box = "<Region><LatLonAltBox><north>8</north><south>0</south><east>8</"
                                    "east><west>0</west></LatLonAltBox>"
                                    "</Region>";
            return write(name + ".kml",
                         "<?xml version='1.0'?><kml xmlns='http://www.opengis.net/kml/2.2'><Document>" + box +
                             "<NetworkLink>" + box + "<Link><href>" + _server.url(name + "-0.kml") +
                             "</href></Link></NetworkLink></Document></kml>");
        },
        "fetched");
}

TEST_F(HostileData, MrfIsNotRead)
{
    // The bytes of the sender's raster go to the end of any file.
    const auto writing = [&](const std::string& name)
    {
        return write(
            name + ".mrf",
            "<MRF_META><CachedSource><Source>" + in("in.tif") +
                "</Source></CachedSource><Raster><Size x='8' y='8' c='1'/><PageSize x='8' y='8' c='1'/>"
                "<Compression>NONE</Compression><DataFile>" +
                out(name + ".csv") + "</DataFile><IndexFile>" + in(name + ".idx") +
                "</IndexFile></Raster></MRF_META>");
    };
    expectHeld(writing, "written");
    expectHeld([&](const std::string& name) { return virtualRaster("mrf.vrt", source(writing("m" + name))); },
               "written");
    expectHeld(
        [&](const std::string& name)
        {
            return write(
                "r" + name + ".mrf",
                "<MRF_META><CachedSource><Source>" + out(name + ".tif") +
                    "</Source></CachedSource><Raster><Size x='8' y='8' c='1'/><PageSize x='8' y='8' c='1'/>"
                    "</Raster></MRF_META>");
        },
        "read");
}

TEST_F(HostileData, NoSqlOfAFileRuns)
{
    const auto layer = [&](const std::string& name, const std::string& what)
    {
        return write("v.vrt", "<OGRVRTDataSource><OGRVRTLayer name='" + name + "'>" + what +
                                  "</OGRVRTLayer></OGRVRTDataSource>");
    };
    expectHeld([&](const std::string& name)
               { return layer(name, "<SrcDataSource>" + out(name + ".geojson") + "</SrcDataSource>"); },
               "read");
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    DatasetPtr(driver->Create(in("d.gpkg").c_str(), 0, 0, 0, GDT_Unknown, nullptr))->CreateLayer("a");
    expectHeld(
        [&](const std::string& name)
        {
            return layer("a", "<SrcDataSource>" + in("d.gpkg") + "</SrcDataSource><SrcSQL>VACUUM INTO '" +
                                  out(name + ".gpkg") + "'</SrcSQL>");
        },
        "written");
    // A virtual raster gives such options, too.
    {
        const DatasetPtr dataset(GDALDataset::Open(in("in.tif").c_str(), GDAL_OF_RASTER));
        DatasetPtr(driver->CreateCopy(in("r.gpkg").c_str(), dataset.get(), FALSE, nullptr, nullptr, nullptr));
    }
    expectHeld(
        [&](const std::string& name)
        {
            return virtualRaster(
                "sql.vrt", source(in("r.gpkg"), "<OpenOptions><OOI key='PRELUDE_STATEMENTS'>VACUUM INTO '" +
                                                    out("r" + name + ".gpkg") + "'</OOI></OpenOptions>"));
        },
        "written");
}

TEST_F(HostileData, DataBasesHaveNoOtherFiles)
{
    // GDAL's virtual tables, and those of Spatialite.
    const std::function<std::string(const std::string&)> modules[] = {
        [&](const std::string& name) { return "VirtualOGR('" + out(name + ".geojson") + "')"; },
        [&](const std::string& name)
        {
            const DatasetPtr from(GDALDataset::Open(out(name + ".geojson").c_str(), GDAL_OF_VECTOR));
            DatasetPtr(
                GetGDALDriverManager()
                    ->GetDriverByName("ESRI Shapefile")
                    ->CreateCopy(out(name + ".shp").c_str(), from.get(), FALSE, nullptr, nullptr, nullptr));
            return "VirtualShape('" + out(name) + "', 'UTF-8', 4326)";
        }};
    const CPLConfigOptionSetter listed("OGR_SQLITE_LIST_VIRTUAL_OGR", "YES", false);
    for (const auto& moduleOf : modules)
        expectHeld(
            [&](const std::string& name)
            {
                const std::string file = in(name + std::to_string(&moduleOf - modules) + ".sqlite");
                GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("SQLite");
                char* options[] = {const_cast<char*>("SPATIALITE=YES"),
                                   const_cast<char*>("INIT_WITH_EPSG=NO"), nullptr};
                const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
                const DatasetPtr dataset(driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, options));
                EXPECT_TRUE(dataset);
                dataset->ExecuteSQL(("CREATE VIRTUAL TABLE stolen USING " + moduleOf(name)).c_str(), nullptr,
                                    nullptr);
                return file;
            },
            "read");
}

TEST_F(HostileData, NothingIsWrittenBesideTheFilesEither)
{
    // A data base with a log of its own, as programs leave it.
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    const CPLConfigOptionSetter journal("OGR_SQLITE_JOURNAL", "WAL", false);
    const DatasetPtr open(driver->Create(in("d.gpkg").c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    open->CreateLayer("a");
    open->FlushCache();
    fs::copy_file(in("d.gpkg"), in("wal.gpkg"));
    write("a.gml", "<a xmlns='http://www.opengis.net/gml' "
                   "xmlns:gml='http://www.opengis.net/gml'><gml:featureMember><b gml:id='1'>"
                   "<c>1</c></b></gml:featureMember></a>");
    {
        const FilesByOthers::Scope scope((_place / "scene").string());
        EXPECT_EQ(wayOut(in("wal.gpkg")), "");
        EXPECT_EQ(wayOut(in("a.gml")), "");
    }
    EXPECT_EQ(wayOut(in("a.gml")), "written") << "GDAL leaves what it has found beside the file";
}

TEST_F(HostileData, NoProgramRuns)
{
    const CPLConfigOptionSetter python("GDAL_VRT_ENABLE_PYTHON", "YES", false);
    const std::string code = "<![CDATA[\nimport os\ndef f(i, o, x, y, w, h, W, H, r, g, **k):\n    open('" +
                             out("ran") + "', 'w').close()\n]]>";
    const std::string kind = " subClass='VRTDerivedRasterBand'";
    const auto band = [&](const std::string& language)
    {
        return "<PixelFunctionType>f</PixelFunctionType><PixelFunctionLanguage>" + language +
               "</PixelFunctionLanguage><PixelFunctionCode>" + code + "</PixelFunctionCode>" +
               source(in("in.tif"));
    };
    for (const char* language : {"Python", "python", "Pyth&#111;n"})
    {
        virtualRaster("p.vrt", band(language), kind);
        const FilesByOthers::Scope scope((_place / "scene").string());
        EXPECT_EQ(wayOut(in("p.vrt")), "") << language;
    }
    // And none of GDAL's names that lead into memory, a pipe or a program.
    std::vector<unsigned char> memory(64, static_cast<unsigned char>(secret));
    const std::string address = testing::PrintToString(static_cast<const void*>(memory.data()));
    expectHeld(
        [&](const std::string& name)
        {
            return virtualRaster("memory.vrt", source("MEM:::DATAPOINTER=" + address +
                                                      ",PIXELS=8,LINES=8,DATATYPE=Byte,NAME=" + name));
        },
        "read");
    const FilesByOthers::Scope scope((_place / "scene").string());
    for (const std::string& name : {std::string("/vsistdin/"), std::string("GPSBabel:gpx:") + in("a.gpx")})
        EXPECT_EQ(wayOut(virtualRaster("name.vrt", source(name))), "");
}

TEST_F(HostileData, NoThreadOfGdalsReadsOutside)
{
    // Those that warp have their own files of heights.
    const std::string warped = "<VRTDataset rasterXSize='8' rasterYSize='8' "
                               "subClass='VRTWarpedDataset'><GeoTransform>0,1,0,8,0,-1</GeoTransform>"
                               "<VRTRasterBand dataType='Byte' band='1' "
                               "subClass='VRTWarpedRasterBand'/><GDALWarpOptions><WarpMemoryLimit>1e6"
                               "</WarpMemoryLimit><Option name='NUM_THREADS'>4</Option><SourceDataset "
                               "relativeToVRT='1'>in.tif</SourceDataset>"
                               "</GDALWarpOptions></VRTDataset>";
    const FilesByOthers::Scope scope((_place / "scene").string());
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    EXPECT_FALSE(DatasetPtr(GDALDataset::Open(write("warped.vrt", warped).c_str(), GDAL_OF_RASTER)));
    std::string error;
    EXPECT_FALSE(osgGeoFX::MappingRaster::read(in("warped.vrt"), {}, {}, error));
    EXPECT_NE(error.find("VRT is not read in files by others"), std::string::npos) << error;
}

TEST_F(HostileData, NetcdfIsReadInItsClassicFormat)
{
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("netCDF");
    const DatasetPtr from(GDALDataset::Open(in("in.tif").c_str(), GDAL_OF_RASTER));
    char* classic[] = {const_cast<char*>("FORMAT=NC2"), nullptr};
    char* hdf[] = {const_cast<char*>("FORMAT=NC4"), nullptr};
    DatasetPtr(driver->CreateCopy(in("c.nc").c_str(), from.get(), FALSE, classic, nullptr, nullptr));
    DatasetPtr(driver->CreateCopy(in("h.nc").c_str(), from.get(), FALSE, hdf, nullptr, nullptr));
    const FilesByOthers::Scope scope((_place / "scene").string());
    std::string error;
    osgGeoFX::MappingFrame frame;
    EXPECT_TRUE(osgGeoFX::MappingRaster::moveToMiddle(in("c.nc"), frame, error)) << error;
    EXPECT_FALSE(osgGeoFX::MappingRaster::moveToMiddle(in("h.nc"), frame, error));
    EXPECT_NE(error.find("netCDF is not read in files by others"), std::string::npos) << error;
    EXPECT_NE(error.find("--allow-outside"), std::string::npos) << error;
}

TEST_F(HostileData, TilesAreReadWithinTheirScopeInAnyThread)
{
    std::string error;
    osgGeoFX::MappingFrame frame;
    for (const std::string& name : {in("in.tif"), virtualRaster("out.vrt", source(out("a.tif")))})
    {
        ASSERT_TRUE(osgGeoFX::MappingRaster::moveToMiddle(in("in.tif"), frame, error)) << error;
        const auto read = [&]
        {
            const osg::ref_ptr<osgGeoFX::RasterTiles> tiles =
                osgGeoFX::TiledRaster::open(name, frame, osgGeoFX::DataLayer::VALUE, error);
            EXPECT_TRUE(tiles) << error;
            return tiles;
        };
        const auto valueIn = [&](const osg::ref_ptr<osgGeoFX::RasterTiles>& tiles)
        {
            return std::async(std::launch::async,
                              [&]
                              {
                                  const osg::ref_ptr<osg::Image> image =
                                      tiles->read(tiles->low(), tiles->high(), 8, 8, error);
                                  return image ? image->getColor(4u, 4u).r() : -1.0f;
                              })
                .get();
        };
        const float value = name == in("in.tif") ? 5.0f : static_cast<float>(secret);
        EXPECT_EQ(valueIn(read()), value) << error;
        osg::ref_ptr<osgGeoFX::RasterTiles> limited;
        {
            const FilesByOthers::Scope scope((_place / "scene").string());
            limited = read();
        }
        const float seen = valueIn(limited);
        if (name == in("in.tif"))
            EXPECT_EQ(seen, 5.0f) << error;
        else
            EXPECT_EQ(seen, -1.0f) << error;
    }
}

TEST_F(HostileData, TheFormatsThatAreReadAreReadAlike)
{
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    const DatasetPtr from(GDALDataset::Open(in("in.tif").c_str(), GDAL_OF_RASTER));
    const auto pixelsOf = [](const std::string& file)
    {
        const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
        std::vector<float> pixels(64, -1.0f);
        if (dataset)
        {
            EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, dataset->GetRasterXSize(),
                                                          dataset->GetRasterYSize(), pixels.data(), 8, 8,
                                                          GDT_Float32, 0, 0, nullptr),
                      CE_None);
        }
        return pixels;
    };
    int count = 0;
    for (const char* format :
         {"GTiff", "PNG",  "JPEG",   "GIF",     "BMP",  "WEBP", "JP2OpenJPEG", "PNM", "HFA",
          "ENVI",  "EHdr", "ERS",    "AAIGrid", "GSAG", "GSBG", "GS7BG",       "RST", "SAGA",
          "BT",    "GRIB", "netCDF", "Zarr",    "VRT",  "GPKG", "MBTiles",     "XYZ"})
    {
        SCOPED_TRACE(format);
        GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(format);
        ASSERT_TRUE(driver);
        const char* const extension = driver->GetMetadataItem(GDAL_DMD_EXTENSION);
        const std::string file = in("f" + std::to_string(count) + "." + (extension ? extension : "zarr"));
        if (!DatasetPtr(driver->CreateCopy(file.c_str(), from.get(), FALSE, nullptr, nullptr, nullptr)))
            continue;
        const std::vector<float> plain = pixelsOf(file);
        if (plain[0] < 0.0f) continue;
        const FilesByOthers::Scope scope((_place / "scene").string());
        EXPECT_EQ(pixelsOf(file), plain);
        ++count;
    }
    EXPECT_GE(count, 22) << "few formats can be written";
    const auto namesOf = [](const std::string& file)
    {
        const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
        std::set<std::string> found;
        if (!dataset) return found;
        for (OGRLayer* const layer : dataset->GetLayers())
            for (const auto& feature : *layer)
                for (int field = 0; field < feature->GetFieldCount(); ++field)
                    found.insert(feature->GetFieldAsString(field));
        return found;
    };
    const DatasetPtr vectors(GDALDataset::Open(out("a.geojson").c_str(), GDAL_OF_VECTOR));
    for (const char* format : {"ESRI Shapefile", "MapInfo File", "CSV", "GPX", "KML", "LIBKML", "GeoJSON",
                               "GeoJSONSeq", "FlatGeobuf", "GPKG", "SQLite", "OGR_GMT", "MBTiles"})
    {
        SCOPED_TRACE(format);
        GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(format);
        ASSERT_TRUE(driver);
        const char* const extension = driver->GetMetadataItem(GDAL_DMD_EXTENSION);
        const std::string file =
            in(std::string("v") + std::to_string(count++) + "." + (extension ? extension : "shp"));
        if (!DatasetPtr(driver->CreateCopy(file.c_str(), vectors.get(), FALSE, nullptr, nullptr, nullptr)))
            continue;
        const std::set<std::string> plain = namesOf(file);
        const FilesByOthers::Scope scope((_place / "scene").string());
        EXPECT_EQ(namesOf(file), plain);
        EXPECT_EQ(plain.count("secret"), 1u) << "the format keeps names";
    }
}

/// The same through scenes, in a process of its own.
class HostileRasters : public HostileData
{
protected:
    void SetUp() override
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setEllipsoidModel(new osg::EllipsoidModel);
        root->addChild(osg::createTexturedQuadGeometry(osg::Vec3(6378137, -1000, -1000),
                                                       osg::Vec3(0, 2000, 0), osg::Vec3(0, 0, 2000)));
        ASSERT_TRUE(osgDB::writeNodeFile(*root, in("terrain.osgb")));
    }

    WatchedProgram readScene(const std::string& raster) const
    {
        write("x.geofx", "<geofx version='1'><terrain><database "
                         "file='terrain.osgb'/></terrain><effects><projectiveMappings><raster file='" +
                             raster + "'/></projectiveMappings></effects></geofx>");
        ProgramOptions how;
        how.folder = (_place / "scene").string();
        how.seconds = 20.0;
        how.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
        WatchedProgram watched = watchProgram({builtProgram("read_scene"), "x.geofx"}, how);
        expectHarmless(watched, {});
        EXPECT_EQ(watched.log.find("\"" + out("a")), std::string::npos) << watched.log;
        return watched;
    }
};

TEST_F(HostileRasters, LeadNowhereFromScenes)
{
    EXPECT_EQ(readScene("in.tif").result.exitCode, 0);
    write("w.mrf", "<MRF_META><CachedSource><Source>" + out("a.tif") +
                       "</Source></CachedSource><Raster><Size x='8' y='8' c='1'/><PageSize x='8' y='8' "
                       "c='1'/><DataFile>" +
                       out("a.csv") + "</DataFile></Raster></MRF_META>");
    const WatchedProgram mrf = readScene("w.mrf");
    EXPECT_EQ(mrf.result.exitCode, 1);
    EXPECT_NE(mrf.result.standardError.find("MRF is not read in files by others"), std::string::npos)
        << mrf.result.standardError;
    EXPECT_NE(mrf.result.standardError.find("--allow-outside"), std::string::npos)
        << mrf.result.standardError;
    // A name that looks like one in the folder.
    virtualRaster("directory.vrt", source("GTIFF_DIR:1:" + out("a.tif")));
    EXPECT_EQ(readScene("directory.vrt").result.exitCode, 1);
}

TEST_F(HostileRasters, AreBuiltWithinTheirFolderByAllThreads)
{
    // Large enough for several units of work.
    write(
        "directory.vrt",
        "<VRTDataset rasterXSize='1200' "
        "rasterYSize='1200'><SRS>EPSG:4326</SRS><GeoTransform>0,0.001,0,1.2,0,-0.001"
        "</GeoTransform><VRTRasterBand dataType='Byte' band='1'><SimpleSource><SourceFilename>GTIFF_DIR:1:" +
            out("a.tif") +
            "</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff='0' yOff='0' xSize='8' ySize='8'/>"
            "<DstRect xOff='0' yOff='0' xSize='1200' ySize='1200'/></SimpleSource></VRTRasterBand>"
            "</VRTDataset>");
    write("x.geofx", "<geofx version='1'><terrain><rasters cache='cache'><dem "
                     "file='directory.vrt'/></rasters></terrain></geofx>");
    ProgramOptions how;
    how.folder = (_place / "scene").string();
    how.seconds = 20.0;
    how.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
    const WatchedProgram watched = watchProgram({builtProgram("read_scene"), "x.geofx"}, how);
    expectHarmless(watched, {_place / "scene/cache"});
    EXPECT_EQ(watched.log.find("\"" + out("a")), std::string::npos) << watched.log;
}

} // namespace
