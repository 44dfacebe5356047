// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Small files of scenes by others that become gigabytes, or keep a program busy for hours.
#include <tools/GeofxPlugins.h>
#include <tools/KmlFiles.h>
#include <tools/RandomSamples.h>
#include <tools/TestRasters.h>
#include <tools/WatchedProgram.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Image>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

std::string repeated(const std::string& text, std::size_t count)
{
    std::string all;
    all.reserve(text.size() * count);
    for (std::size_t i = 0; i < count; ++i)
        all += text;
    return all;
}

/// So much of a text, in a file packed by gzip.
void writePacked(const fs::path& file, const std::string& start, const std::string& text, std::size_t count,
                 const std::string& end)
{
    VSILFILE* const stream = VSIFOpenL(("/vsigzip/" + file.string()).c_str(), "wb");
    ASSERT_TRUE(stream);
    const auto write = [&](const std::string& part)
    {
        EXPECT_EQ(VSIFWriteL(part.data(), 1, part.size(), stream), part.size());
    };
    constexpr std::size_t each = 10000;
    const std::string many = repeated(text, each);
    write(start);
    for (std::size_t i = 0; i < count / each; ++i)
        write(many);
    write(end);
    VSIFCloseL(stream);
}

class HostileSizes : public GeofxPlugins
{
protected:
    void SetUp() override
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setEllipsoidModel(new osg::EllipsoidModel);
        root->addChild(osg::createTexturedQuadGeometry(osg::Vec3(6378137, -1000, -1000),
                                                       osg::Vec3(0, 2000, 0), osg::Vec3(0, 0, 2000)));
        fs::create_directories(_place / "scene");
        fs::create_directories(_place / "out");
        ASSERT_TRUE(osgDB::writeNodeFile(*root, in("terrain.osgb")));
        // A way of two places.
        _place.write(
            "scene/v.geojson",
            R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
            R"({"type":"LineString","coordinates":[[0,0],[0.001,0.001]]}}]})");
    }

    std::string in(const std::string& name) const { return (_place / ("scene/" + name)).string(); }
    void writeMappings(const std::string& mappings) const
    {
        writeEffects("<projectiveMappings>" + mappings + "</projectiveMappings>");
    }
    void writeEffects(const std::string& effects) const
    {
        _place.write("scene/x.geofx",
                     "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain><effects>" +
                         effects + "</effects></geofx>");
    }

    /// About the middle of the terrain, 0.02 degrees wide.
    static void place(GDALDataset& raster, int side)
    {
        const double pixel = 0.02 / side;
        double transform[6] = {-0.01, pixel, 0.0, 0.01, 0.0, -pixel};
        ASSERT_EQ(raster.SetGeoTransform(transform), CE_None);
        OGRSpatialReference degrees;
        degrees.SetFromUserInput("EPSG:4326");
        ASSERT_EQ(raster.SetSpatialRef(&degrees), CE_None);
    }
    /// A raster with so many pixels along a side, none of which is stored.
    void writeHollowAt(const std::string& name, int side) const
    {
        writeHollow(in(name), side, side);
        const DatasetPtr raster(GDALDataset::Open(in(name).c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        ASSERT_TRUE(raster);
        place(*raster, side);
    }

    WatchedProgram run(std::vector<std::string> command) const
    {
        ProgramOptions how;
        how.folder = (_place / "scene").string();
        how.seconds = 30.0;
        how.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib", "DISPLAY="};
        command[0] = builtProgram(command[0]);
        WatchedProgram watched = watchProgram(command, how);
        expectHarmless(watched, {_place / "out"});
        return watched;
    }
    /// As any program of OSG's reads it.
    WatchedProgram read() const { return run({"read_scene", "x.geofx"}); }

    /// It ends with a sentence that has these words, within so much memory.
    static void expectSentence(const WatchedProgram& watched, const std::vector<std::string>& words,
                               double mostMiB = 300.0)
    {
        EXPECT_NE(watched.result.exitCode, 0);
        for (const std::string& word : words)
            EXPECT_NE(watched.result.standardError.find(word), std::string::npos)
                << word << ": " << watched.result.standardError;
        expectWithin(watched, mostMiB);
    }
    static void expectWithin(const WatchedProgram& watched, double mostMiB)
    {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        EXPECT_LT(watched.result.peakMiB, mostMiB) << watched.result.standardError;
#endif
    }

    const TempDir _place;
};

/// An SLD whose names are an entity of its document type.
std::string growingStyle(std::size_t layers, std::size_t bytes)
{
    const std::string rule =
        "<Rule><LineSymbolizer><Stroke><CssParameter name='stroke'>#ff0000</CssParameter></Stroke>"
        "</LineSymbolizer></Rule>";
    return "<!DOCTYPE a [<!ENTITY e '" + std::string(bytes, 'a') + "'>]>\n<StyledLayerDescriptor>" +
           repeated("<NamedLayer><Name>&e;</Name></NamedLayer>", layers) +
           "<NamedLayer><Name>v</Name><UserStyle><FeatureTypeStyle>" + rule +
           "</FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>";
}

TEST_F(HostileSizes, StylesWithEntitiesAreRefused)
{
    const std::string style = growingStyle(20000, 150000);
    EXPECT_LT(style.size(), 1100000u);
    _place.write("scene/s.sld", style);
    writeMappings("<overlays file='v.geojson' style='s.sld'/>");
    expectSentence(read(), {"s.sld: it has a document type"});
    writeMappings("<colorTable name='t' file='s.sld'/>");
    expectSentence(read(), {"s.sld: it has a document type"});
    // Beside the data it is read unasked.
    fs::rename(in("s.sld"), in("v.sld"));
    writeMappings("<overlays file='v.geojson'/>");
    expectSentence(read(), {"v.sld: it has a document type"});
    // A value that each element has, and a document type elsewhere.
    for (const std::string& type : {"<!DOCTYPE a [<!ATTLIST Name b CDATA '" + std::string(1000, 'b') + "'>]>",
                                    std::string("<!DOCTYPE a SYSTEM 'b'>")})
    {
        _place.write("scene/v.sld", type + "<StyledLayerDescriptor/>");
        expectSentence(read(), {"v.sld: it has a document type"});
    }
}

TEST_F(HostileSizes, PackedStylesAreRefused)
{
    writePacked(in("v.sld"), "<StyledLayerDescriptor>", "<a/>", 10000000, "</StyledLayerDescriptor>");
    EXPECT_LT(fs::file_size(in("v.sld")), 500000u);
    writeMappings("<overlays file='v.geojson'/>");
    expectSentence(read(), {"v.sld: it is packed by gzip"});
    // What the file itself may have.
    _place.write("scene/v.sld", "<a>" + repeated("<a/>", 4000000) + "</a>");
    expectSentence(read(), {"v.sld: it has no PolygonSymbolizer"}, 1000.0);
    _place.write("scene/v.sld", "<a>" + repeated("<a/>", 4200000) + "</a>");
    expectSentence(read(), {"v.sld: the style cannot be read, or has more than 16 MiB"});
}

TEST_F(HostileSizes, ScenesWithEntitiesAreRefused)
{
    _place.write("scene/x.geofx",
                 "<!DOCTYPE geofx [<!ENTITY e '" + std::string(60000, 'a') +
                     "'>]>\n<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>" +
                     repeated("<a b='&e;'/>", 50000) + "</geofx>");
    expectSentence(read(), {"x.geofx:1: <geofx>: a document type is declared"});
}

TEST_F(HostileSizes, APictureOfManyOverlaysIsReadOnce)
{
    writePicture(in("p.png"), 1024, 1024, [](int, int) { return std::array<int, 4>{0, 128, 0, 255}; });
    std::string overlays, colored;
    for (int i = 0; i < (fullTest() ? 200 : 60); ++i)
    {
        const double west = 0.0001 * i;
        overlays += groundOverlay("p.png", latLonBox(west, 0.0, west + 0.001, 0.001));
        colored += groundOverlay("p.png", latLonBox(west, 0.0, west + 0.001, 0.001),
                                 "<color>ff0000" + std::string(1, "0123456789"[i % 10]) + "0</color>");
    }
    _place.write("scene/a.kml", kml(overlays));
    writeMappings("<overlays file='a.kml'/>");
    const WatchedProgram once = read();
    EXPECT_EQ(once.result.exitCode, 0) << once.result.standardError;
    EXPECT_EQ(once.result.standardError, "");
    expectWithin(once, 180.0);
    // The files of a scene share it.
    std::string files;
    for (int i = 0; i < 40; ++i)
    {
        const std::string name = "a" + std::to_string(i) + ".kml";
        _place.write("scene/" + name,
                     kml(groundOverlay("p.png", latLonBox(0.0, 0.0, 0.001, 0.001 + 0.0001 * i))));
        files += "<overlays file='" + name + "'/>";
    }
    writeMappings(files);
    const WatchedProgram shared = read();
    EXPECT_EQ(shared.result.exitCode, 0) << shared.result.standardError;
    expectWithin(shared, 180.0);
    if (!fullTest()) return;
    // Colors make pictures of their own, up to a limit of all of them.
    _place.write("scene/c.kml", kml(colored));
    writeMappings("<overlays file='c.kml'/><overlays file='a.kml'/>");
    const WatchedProgram many = read();
    EXPECT_NE(many.result.standardError.find("ground overlays are left out"), std::string::npos)
        << many.result.standardError;
    expectWithin(many, 800.0);
}

TEST_F(HostileSizes, APictureOfManyTexturesIsReadOnce)
{
    writePicture(in("p.png"), 1024, 1024, [](int, int) { return std::array<int, 4>{0, 128, 0, 255}; });
    const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
    root->setEllipsoidModel(new osg::EllipsoidModel);
    for (int i = 0; i < 40; ++i)
    {
        const osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry(
            osg::Vec3(6378137, -1000, -1000), osg::Vec3(0, 2000, 0), osg::Vec3(0, 0, 2000));
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        image->setFileName("p.png");
        image->setWriteHint(osg::Image::EXTERNAL_FILE);
        square->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
        root->addChild(square);
    }
    ASSERT_TRUE(osgDB::writeNodeFile(*root, in("terrain.osgb")));
    writeMappings("");
    const WatchedProgram watched = read();
    EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
    expectWithin(watched, 180.0);
}

TEST_F(HostileSizes, RastersOfASceneAreReducedToTheirLimit)
{
    // A texel takes 16 bytes while it is warped. A small raster takes less than it may.
    writeHollowAt("r.tif", fullTest() ? 7000 : 100);
    writeMappings("<raster file='r.tif' maxSide='16384'/>");
    const WatchedProgram watched = read();
    EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
    EXPECT_NE(watched.result.standardError.find("r.tif\" has no more than 5792 texels"), std::string::npos)
        << watched.result.standardError;
}

TEST_F(HostileSizes, BlocksThatBecomeGigabytesAreRefused)
{
    const auto write = [&](const char* name, int side, int bands)
    {
        GDALAllRegister();
        CPLStringList options;
        const std::string block = std::to_string(side);
        options.SetNameValue("SPARSE_OK", "TRUE");
        options.SetNameValue("TILED", "YES");
        options.SetNameValue("BLOCKXSIZE", block.c_str());
        options.SetNameValue("BLOCKYSIZE", block.c_str());
        options.SetNameValue("INTERLEAVE", "PIXEL");
        options.SetNameValue("COMPRESS", "DEFLATE");
        const DatasetPtr raster(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            in(name).c_str(), side, side, bands, GDT_Byte, options.List()));
        ASSERT_TRUE(raster);
        place(*raster, side);
    };
    write("b.tif", 16000, 4);
    for (const char* const mapping :
         {"<raster file='b.tif'/>", "<layer name='a' file='b.tif'/><mapping layer='a'/>",
          "<overlays file='b.tif'/>"})
    {
        SCOPED_TRACE(mapping);
        writeMappings(mapping);
        expectSentence(read(), {"b.tif", "blocks of 16000 × 16000"});
    }
}

TEST_F(HostileSizes, RastersWithoutEndAreRefusedOrEndInTime)
{
    writeHollowAt("h.tif", 300000);
    EXPECT_LT(fs::file_size(in("h.tif")), 20u << 20);
    for (const char* const mapping :
         {"<raster file='h.tif'/>", "<layer name='a' file='h.tif' kind='value'/><mapping layer='a'/>",
          "<overlays file='h.tif'/>"})
    {
        SCOPED_TRACE(mapping);
        writeMappings(mapping);
        expectSentence(read(), {"h.tif", "gdaladdo"});
    }
    // Those that could be read, in minutes, end with the wait.
    writeHollowAt("h.tif", 99000);
    writeMappings("<raster file='h.tif'/>");
    const std::string out = (_place / "out/a.png").string();
    const std::vector<std::string> command = {"osggeofx_render", "x.geofx", "-o", out, "--timeout", "0.2"};
    const WatchedProgram scene = run(command);
    expectSentence(scene, {"h.tif: it was not read within 0.2 s", "--timeout"}, 500.0);
    EXPECT_EQ(scene.result.exitCode, 1);
    EXPECT_LT(scene.result.seconds, 10.0);
}

TEST_F(HostileSizes, TablesWithoutEndEndInTime)
{
    GDALAllRegister();
    {
        const DatasetPtr source(GDALDataset::Open(in("v.geojson").c_str(), GDAL_OF_VECTOR));
        ASSERT_TRUE(source);
        const DatasetPtr table(GetGDALDriverManager()->GetDriverByName("GPKG")->Create(
            in("t.gpkg").c_str(), 0, 0, 0, GDT_Unknown, nullptr));
        ASSERT_TRUE(table);
        ASSERT_TRUE(table->CopyLayer(source->GetLayer(0), "v"));
        // A view that the file makes up while it is read.
        for (const char* const statement :
             {"CREATE VIEW e AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) "
              "SELECT x AS fid, v.geom AS geom FROM c, v",
              "INSERT INTO gpkg_contents(table_name, data_type, identifier, srs_id) "
              "VALUES('e', 'features', 'e', 4326)",
              "INSERT INTO gpkg_geometry_columns VALUES('e', 'geom', 'LINESTRING', 4326, 0, 0)"})
            table->ExecuteSQL(statement, nullptr, nullptr);
    }
    writeMappings("<overlays file='t.gpkg' layer='e'/>");
    const std::string out = (_place / "out/a.png").string();
    const WatchedProgram watched = run({"osggeofx_render", "x.geofx", "-o", out, "--timeout", "0.2"});
    expectSentence(watched, {"t.gpkg: it was not read within 0.2 s"});
    EXPECT_EQ(watched.result.exitCode, 1);
}

TEST_F(HostileSizes, ArchivesThatBecomeGigabytesAreRefused)
{
    const std::string placemarks = kml(repeated("<Placemark/>", 3000000));
    writeArchive(in("z.kmz"), {{"doc.kml", placemarks}});
    EXPECT_LT(fs::file_size(in("z.kmz")), 300000u);
    for (const char* const mapping :
         {"<overlays file='z.kmz'/>", "<route file='z.kmz'/>", "<raster file='z.kmz'/>"})
    {
        SCOPED_TRACE(mapping);
        writeMappings(mapping);
        expectSentence(read(), {"z.kmz"});
    }
    // Linked by another one, or within it.
    _place.write("scene/l.kml", kml("<NetworkLink><Link><href>z.kmz</href></Link></NetworkLink>" +
                                    groundOverlay("", latLonBox(0.0, 0.0, 0.001, 0.001))));
    writeMappings("<overlays file='l.kml'/>");
    expectWithin(read(), 300.0);
    writeArchive(in("n.kmz"), {{"doc.kml", kml("<NetworkLink><Link><href>z.kmz</href></Link></NetworkLink>")},
                               {"z.kmz", bytesOf(in("z.kmz"))}});
    writeMappings("<overlays file='n.kmz'/>");
    expectSentence(read(), {"n.kmz"});
    // Few bytes may be packed well.
    writeArchive(in("s.kmz"), {{"doc.kml", kml(groundOverlay("", latLonBox(0.0, 0.0, 0.001, 0.001)) + "<!--" +
                                               std::string(1000000, ' ') + "-->")}});
    writeMappings("<overlays file='s.kmz'/>");
    const WatchedProgram small = read();
    EXPECT_EQ(small.result.exitCode, 0) << small.result.standardError;
}

} // namespace
