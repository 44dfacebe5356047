// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Scenes by others that would run programs, write files, or take all memory, in a program of OSG's kind (read_scene) and in our own.
#include <tools/DatabaseReader.h>
#include <tools/GeofxPlugins.h>
#include <tools/NotifyWatch.h>
#include <tools/PagedScene.h>
#include <tools/TestRasters.h>
#include <tools/TestServer.h>
#include <tools/WatchedProgram.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/Image>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/ProxyNode>
#include <osg/ScriptEngine>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <sys/wait.h>
#include <unistd.h>

#include <sstream>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

/// Four bytes a number, the most significant first.
std::string big(std::uint32_t number)
{
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>((number >> shift) & 0xffu);
    return bytes;
}

std::uint32_t crcOf(const std::string& bytes)
{
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes)
    {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    return ~crc;
}

std::string chunk(const std::string& name, const std::string& content)
{
    return big(static_cast<std::uint32_t>(content.size())) + name + content + big(crcOf(name + content));
}

/// A PNG of black pixels as OSG writes it, with another size in its header: a decoder makes room for all of it before it finds out.
std::string hugePng(std::uint32_t side)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(8, 8, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::ostringstream stream;
    osgDB::Registry::instance()->getReaderWriterForExtension("png")->writeImage(*image, stream);
    std::string png = stream.str();
    const std::string header = big(side) + big(side) + png.substr(24, 5);
    return png.substr(0, 8) + chunk("IHDR", header) + png.substr(33);
}

class HostileScenes : public GeofxPlugins
{
protected:
    void SetUp() override
    {
        // The program lies beside the scene and says so where it ran.
        _place.write("scene/l.lua", "os.execute('touch " + mark().string() + "')\n");
        save(*ground(), "terrain.osgb");
    }

    fs::path mark() const { return _place / "ran"; }
    fs::path in(const std::string& name) const { return _place / ("scene/" + name); }

    static osg::ref_ptr<osg::CoordinateSystemNode> ground()
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setEllipsoidModel(new osg::EllipsoidModel);
        const osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry(
            osg::Vec3(6378137, -1000, -1000), osg::Vec3(0, 2000, 0), osg::Vec3(0, 0, 2000));
        root->addChild(square);
        return root;
    }
    void save(const osg::Node& node, const std::string& name) const
    {
        ASSERT_TRUE(osgDB::writeNodeFile(node, in(name).string()));
    }
    /// Of a file that another one names; relative names are looked for beside it.
    void saveText(const std::string& name, const std::string& child) const
    {
        _place.write("scene/" + name,
                     "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\n" + child);
    }
    void writeScene(const std::string& effects,
                    const std::string& terrain = "<database file='terrain.osgb'/>") const
    {
        _place.write("scene/x.geofx", "<geofx version='1'>\n<terrain>" + terrain + "</terrain>\n<effects>" +
                                          effects + "</effects>\n</geofx>\n");
    }

    /// Reads the scene as any program of OSG's does, from its own folder.
    WatchedProgram read(const std::string& file = "x.geofx", const std::string& options = "") const
    {
        ProgramOptions how;
        how.folder = (_place / "scene").string();
        how.seconds = 20.0;
        how.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
        std::vector<std::string> command = {builtProgram("read_scene"), file};
        if (!options.empty()) command.push_back(options);
        return watchProgram(command, how);
    }

    WatchedProgram expectRefused(const std::string& word) const
    {
        WatchedProgram watched = read();
        expectHarmless(watched, {});
        EXPECT_FALSE(fs::exists(mark())) << "the scene has run a program";
        EXPECT_EQ(watched.result.exitCode, 1) << watched.result.standardError;
        EXPECT_NE(watched.result.standardError.find(word), std::string::npos) << watched.result.standardError;
        EXPECT_NE(watched.result.standardError.find("x.geofx:"), std::string::npos)
            << watched.result.standardError;
        return watched;
    }

    const TempDir _place;
};

TEST_F(HostileScenes, PicturesRunNoProgram)
{
    const std::string mapping = "<mapping layer='a' centerX='0' centerY='0' halfWidth='10' halfHeight='10'/>";
    for (const std::string& effect :
         {std::string("<projectiveMappings><layer name='a' file='l.lua'/></projectiveMappings>"),
          std::string("<projectiveMappings><layer name='a' kind='value' file='l.lua'/></projectiveMappings>"),
          std::string("<projectiveMappings><layer name='a' kind='class' file='l.lua'/></projectiveMappings>"),
          std::string("<panoramaMap palette='l.lua'/>"), std::string("<panoramaMap skyImage='l.lua'/>"),
          std::string(
              "<closeUps><closeUp><region longitude='0' latitude='0' width='100' depth='100' shape='image' "
              "image='l.lua'/></closeUp></closeUps>")})
    {
        SCOPED_TRACE(effect);
        writeScene(effect);
        expectRefused("--allow-outside");
    }
}

TEST_F(HostileScenes, APictureIsWhatItHoldsAndNotWhatItIsCalled)
{
    // Programs by the names of pictures, of pseudo loaders, and of what no longer is a picture.
    const std::string program = "os.execute('touch " + mark().string() + "')\n";
    for (const char* name : {"a.png", "a.png.lua", "a.tif.curl", "a.png.1,2,3.trans", "a.gz", "a.png.gz",
                             "a.osga", "a.svg", "a.pdf", "a.p3d", "a.view", "a.ive", "a"})
    {
        SCOPED_TRACE(name);
        _place.write(std::string("scene/") + name, program);
        writeScene("<projectiveMappings><layer name='a' file='" + std::string(name) +
                   "'/></projectiveMappings>");
        expectRefused("cannot be read");
    }
    // And a picture by the name of a program is a picture.
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    ASSERT_TRUE(osgDB::writeImageFile(*image, in("b.png").string()));
    fs::rename(in("b.png"), in("b.lua"));
    writeScene("<projectiveMappings><layer name='a' file='b.lua'/></projectiveMappings>");
    const WatchedProgram watched = read();
    expectHarmless(watched, {});
    EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
}

TEST_F(HostileScenes, DatabasesRunNoProgram)
{
    _place.write("scene/a.osgb", "os.execute('touch " + mark().string() + "')\n");
    save(*ground(), "t.osgt");
    save(*ground(), "t.ive");
    for (const char* name : {"l.lua", "a.osgb", "t.osgt.1,2,3.trans", "t.ive", "t.osgt.lua"})
    {
        SCOPED_TRACE(name);
        if (!fs::exists(in(name))) fs::copy_file(in("t.osgt"), in(name));
        writeScene("", "<database file='" + std::string(name) + "'/>");
        if (std::string(name).find("t.osgt.") == 0)
        {
            // By its content it is a database.
            const WatchedProgram watched = read();
            expectHarmless(watched, {});
            EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
            continue;
        }
        expectRefused("--allow-outside");
    }
}

TEST_F(HostileScenes, DatabasesHoldNoScripts)
{
    const osg::ref_ptr<osg::Group> root = ground();
    root->addUpdateCallback(
        new osg::ScriptNodeCallback(new osg::Script("lua", "os.execute('touch ran')"), "update"));
    for (const char* name : {"s.osgb", "s.osgt"})
    {
        SCOPED_TRACE(name);
        save(*root, name);
        writeScene("", "<database file='" + std::string(name) + "'/>");
        expectRefused("osg::Script");
    }
    const osg::ref_ptr<osgDB::Options> packed = new osgDB::Options("Compressor=zlib");
    ASSERT_TRUE(osgDB::writeNodeFile(*root, in("p.osgb").string(), packed));
    writeScene("", "<database file='p.osgb'/>");
    expectRefused("osg::Script");
    // Of a library that reads files by itself: a font would be the program.
    saveText("f.osgt", "osgText::Text {\n  UniqueID 1\n  Font TRUE \"l.lua\" \n}\n");
    writeScene("", "<database file='f.osgt'/>");
    expectRefused("osgText::Text");
}

TEST_F(HostileScenes, NoLibraryIsLoadedByTheNameOfAClass)
{
    // OSG tries "libevil.so" for a class "evil::Node", in the current folder, too. So may a library of OSG be one that is not installed.
    for (const char* kit : {"evil", "osgShadow"})
    {
        SCOPED_TRACE(kit);
        const std::string library = osgDB::Registry::instance()->createLibraryNameForNodeKit(kit);
        _place.write("scene/" + library, "not a library, but it would be opened");
        saveText("e.osgt", std::string(kit) + "::Node {\n  UniqueID 1\n}\n");
        writeScene("", "<database file='e.osgt'/>");
        const WatchedProgram watched = expectRefused(kit);
        EXPECT_EQ(watched.log.find(library + "\", O_RDONLY|O_CLOEXEC"), std::string::npos) << watched.log;
    }
}

TEST_F(HostileScenes, WhatADatabaseNamesIsLookedAtAlike)
{
    // A tile, a part of it, and pictures: as files, within it, and outside of the folder.
    _place.write("outside.png", "no picture");
    const auto textureOf = [&](const std::string& file, osg::Image::WriteHint hint)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = ground();
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        image->setFileName(file);
        image->setWriteHint(hint);
        root->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
        return root;
    };
    save(*textureOf("l.lua", osg::Image::EXTERNAL_FILE), "picture.osgb");
    save(*textureOf(in("l.lua").string(), osg::Image::EXTERNAL_FILE), "absolute.osgt");
    save(*textureOf((_place / "outside.png").string(), osg::Image::EXTERNAL_FILE), "outside.osgb");
    save(*textureOf("http://127.0.0.1:9/a.png", osg::Image::EXTERNAL_FILE), "address.osgb");
    const osg::ref_ptr<osg::CoordinateSystemNode> root = ground();
    const osg::ref_ptr<osg::ProxyNode> proxy = new osg::ProxyNode;
    proxy->setFileName(0, "l.lua");
    root->addChild(proxy);
    save(*root, "proxy.osgb");
    for (const char* name : {"picture.osgb", "absolute.osgt", "outside.osgb", "address.osgb", "proxy.osgb"})
    {
        SCOPED_TRACE(name);
        writeScene("", "<database file='" + std::string(name) + "'/>");
        const WatchedProgram watched = read();
        expectHarmless(watched, {});
        EXPECT_FALSE(fs::exists(mark()));
        EXPECT_EQ(watched.log.find("outside.png"), std::string::npos) << "a file outside was opened";
        // The ground is there, without what it names.
        EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
    }
}

TEST_F(HostileScenes, TilesRunNoProgramAndTheirParentsStay)
{
    _place.write("outside.osgb", "");
    fs::copy_file(in("terrain.osgb"), _place / "outside.osgb", fs::copy_options::overwrite_existing);
    save(*ground(), "t.osgt");
    struct Tile
    {
        std::string file, folder;
    };
    for (const Tile& each : {Tile{"l.lua", ""}, Tile{"l.lua", in("").string()}, Tile{"t.osgt.lua", ""},
                             Tile{"../outside.osgb", ""}, Tile{"outside.osgb", (_place / "").string()},
                             Tile{"a.osgb", "http://127.0.0.1:9/"}, Tile{"terrain.osgb.1,2,3.trans", ""}})
    {
        const std::string& tile = each.file;
        SCOPED_TRACE(each.folder + tile);
        const osg::ref_ptr<osg::CoordinateSystemNode> root = ground();
        const osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
        lod->addChild(root->getChild(0), 1000.0f, 1e10f);
        lod->setFileName(1, tile);
        lod->setDatabasePath(each.folder);
        lod->setRange(1, 0.0f, 1000.0f);
        root->removeChild(0u, 1);
        root->addChild(lod);
        save(*root, "paged.osgb");
        writeScene("", "<database file='paged.osgb'/>");
        NotifyWatch watch;
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(in("x.geofx").string());
        ASSERT_TRUE(scene);
        struct Finder : osg::NodeVisitor
        {
            Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
            void apply(osg::PagedLOD& node) override { found = &node; }
            osg::PagedLOD* found = nullptr;
        } finder;
        scene->accept(finder);
        ASSERT_TRUE(finder.found);
        // As a pager does.
        const auto* options = static_cast<const osgDB::Options*>(finder.found->getDatabaseOptions());
        osg::observer_ptr<osg::Group> parent = finder.found;
        const osg::ref_ptr<osgDB::Options> request = options->cloneOptions();
        request->setParentGroup(parent);
        osg::ref_ptr<osg::Node> read;
        const std::string said = testing::PrintToString(watch.messagesOf(
            [&]
            {
                read = osgDB::Registry::instance()
                           ->readNode(finder.found->getDatabasePath() + tile, request, false)
                           .getNode();
            }));
        EXPECT_FALSE(fs::exists(mark()));
        ASSERT_TRUE(read) << "the coarser one stands in";
        EXPECT_EQ(read->getBound().center(), finder.found->getChild(0)->getBound().center());
        EXPECT_NE(said.find("the coarser one stays in its place"), std::string::npos) << said;
        // Other ways than a pager's hold to the limits, too.
        const osg::ref_ptr<osgDB::Options> other = osgGeoFX::TileGuard::readingOptions(*scene);
        ASSERT_TRUE(other);
        watch.messagesOf(
            [&] { read = osgDB::readRefNodeFile(finder.found->getDatabasePath() + tile, other.get()); });
        EXPECT_FALSE(read);
        EXPECT_FALSE(fs::exists(mark()));
    }
}

TEST_F(HostileScenes, PicturesThatBecomeGigabytesAreRefused)
{
    _place.write("scene/huge.png", hugePng(32000));
    std::string layers;
    for (int i = 0; i < 4; ++i)
        layers += "<layer name='a" + std::to_string(i) + "' file='huge.png'/>";
    for (const std::string& effect : {"<projectiveMappings>" + layers + "</projectiveMappings>",
                                      std::string("<panoramaMap palette='huge.png'/>"),
                                      std::string("<panoramaMap skyImage='huge.png'/>")})
    {
        SCOPED_TRACE(effect);
        writeScene(effect);
        expectHarmless(read(), {});
    }
    // Within a database, by any name.
    const osg::ref_ptr<osg::CoordinateSystemNode> root = ground();
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setFileName("huge.png");
    image->setWriteHint(osg::Image::EXTERNAL_FILE);
    root->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    save(*root, "t.osgb");
    writeScene("", "<database file='t.osgb'/>");
    const WatchedProgram external = read();
    expectHarmless(external, {});
    EXPECT_LT(external.result.peakMiB, 400.0);
    const osg::ref_ptr<osgDB::Options> within = new osgDB::Options("WriteImageHint=IncludeFile");
    fs::copy_file(in("huge.png"), _place / "huge.png");
    image->setFileName((_place / "huge.png").string());
    ASSERT_TRUE(osgDB::writeNodeFile(*root, in("t.osgb").string(), within));
    fs::remove(_place / "huge.png");
    const WatchedProgram inside = read();
    expectHarmless(inside, {});
    EXPECT_LT(inside.result.peakMiB, 400.0);
    EXPECT_NE(inside.result.standardError.find("its pixels take more than"), std::string::npos)
        << inside.result.standardError;
}

TEST_F(HostileScenes, PackedDatabasesThatBecomeGigabytesAreRefused)
{
    // In a process of its own, as what we take is counted in what a program takes.
    const pid_t child = fork();
    if (child == 0)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = ground();
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setColorArray(new osg::Vec4Array(20u << 20), osg::Array::BIND_PER_VERTEX); // 320 MiB
        root->addChild(geometry);
        const osg::ref_ptr<osgDB::Options> packed = new osgDB::Options("Compressor=zlib");
        _exit(osgDB::writeNodeFile(*root, in("t.osgb").string(), packed) ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    EXPECT_LT(fs::file_size(in("t.osgb")), 2u << 20);
    writeScene("", "<database file='t.osgb'/>");
    EXPECT_LT(expectRefused("256 MiB").result.peakMiB, 200.0);
    // Its end tells a lie about its size.
    fs::resize_file(in("t.osgb"), fs::file_size(in("t.osgb")) - 4);
    std::ofstream(in("t.osgb"), std::ios::binary | std::ios::app).write("\1\0\0\0", 4);
    expectRefused("256 MiB");
}

TEST_F(HostileScenes, APictureThatManyNameIsReadOnce)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    ASSERT_TRUE(osgDB::writeImageFile(*image, in("b.png").string()));
    std::string layers;
    for (int i = 0; i < 50; ++i)
        layers += "<layer name='a" + std::to_string(i) + "' file='" + (i % 2 ? "./" : "") + "b.png'/>";
    writeScene("<projectiveMappings>" + layers + "</projectiveMappings>");
    const WatchedProgram watched = read();
    expectHarmless(watched, {});
    EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
    std::size_t opened = 0;
    for (std::size_t i = watched.log.find("/b.png\""); i != std::string::npos;
         i = watched.log.find("/b.png\"", i + 1))
        ++opened;
    // GDAL looks at it before OSG reads it.
    EXPECT_LE(opened, 8u) << watched.log;
}

TEST_F(HostileScenes, RastersThatADatabaseNamesByItselfAreNotOpened)
{
    const std::string file = writeRelief(_place / "outside.tif", 8, 8, 0.0, 0.01, 0.001);
    osgGeoFX::MappingFrame frame;
    std::string error;
    ASSERT_TRUE(osgGeoFX::MappingRaster::moveToMiddle(file, frame, error)) << error;
    const osg::ref_ptr<osgGeoFX::PagedRaster> raster = osgGeoFX::PagedRaster::create(
        osgGeoFX::TiledRaster::open(file, frame, osgGeoFX::DataLayer::VALUE, error), {}, error);
    ASSERT_TRUE(raster) << error;
    const osg::ref_ptr<osgGeoFX::ProjectiveMappings> effect = new osgGeoFX::ProjectiveMappings;
    ASSERT_TRUE(effect->addRaster(raster));
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(effect);
    scene->addChild(ground());
    save(*scene, "e.osgb");
    writeScene("", "<database file='e.osgb'/>");
    const WatchedProgram watched = read();
    expectHarmless(watched, {});
    EXPECT_EQ(watched.log.find("outside.tif"), std::string::npos) << watched.log;
    EXPECT_NE(watched.result.standardError.find("names a raster by itself"), std::string::npos)
        << watched.result.standardError;
    EXPECT_NE(read("x.geofx", "allowOutside").log.find("outside.tif"), std::string::npos);
}

TEST_F(HostileScenes, ConsentReadsAllThatOsgReads)
{
    save(*ground(), "t.ive");
    writeScene("", "<database file='t.ive'/>");
    EXPECT_EQ(read("x.geofx", "allowOutside").result.exitCode, 0);
    writeScene("<projectiveMappings><layer name='a' file='l.lua'/></projectiveMappings>");
    read("x.geofx", "allowOutside");
    EXPECT_TRUE(fs::exists(mark())) << "the program that others were kept from running does run";
}

TEST_F(HostileScenes, OverHttpTheSameHolds)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> root = ground();
    root->addUpdateCallback(
        new osg::ScriptNodeCallback(new osg::Script("lua", "os.execute('touch ran')"), "update"));
    save(*root, "s.osgb");
    const TestServer server(_place / "scene");
    for (const char* name : {"l.lua", "s.osgb"})
    {
        SCOPED_TRACE(name);
        writeScene("", "<database file='" + std::string(name) + "'/>");
        const WatchedProgram watched = read(server.url("x.geofx"));
        expectHarmless(watched, {}, {"AF_INET", "AF_INET6", "AF_UNIX", "AF_NETLINK"});
        EXPECT_FALSE(fs::exists(mark()));
        EXPECT_EQ(watched.result.exitCode, 1);
        EXPECT_NE(watched.result.standardError.find("--allow-outside"), std::string::npos)
            << watched.result.standardError;
    }
}

TEST_F(HostileScenes, CoordinateSystemsAreNotFetched)
{
    const TestServer server(_place / "scene");
    _place.write("scene/wkt.txt", wktOf(32604));
    for (const std::string& system :
         {server.url("wkt.txt"), in("wkt.txt").string(), std::string("wkt.txt"),
          "/vsicurl/" + server.url("wkt.txt"), "urn:ogc:def:crs:EPSG::" + server.url("wkt.txt"),
          std::string("IGNF:../x")})
    {
        SCOPED_TRACE(system);
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode("WKT", system);
        std::string error;
        EXPECT_FALSE(osgGeoFX::Georeference::create(root, error));
        EXPECT_NE(error.find("EPSG:"), std::string::npos) << error;
    }
    EXPECT_EQ(server.requests(), std::vector<std::string>());
    for (const std::string& system :
         {wktOf(32604), std::string("EPSG:32604"), std::string("epsg:32604"), std::string("ESRI:102007"),
          std::string("+proj=utm +zone=4 +datum=WGS84"), std::string("EPSG:32604+5773")})
    {
        SCOPED_TRACE(system);
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode("WKT", system);
        std::string error;
        EXPECT_TRUE(osgGeoFX::Georeference::create(root, error)) << error;
    }
}

} // namespace
