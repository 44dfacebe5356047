// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures of scenes by others whose tiles would run programs: from a folder and from a web server.
#include <tools/GlFixture.h>
#include <tools/PagedScene.h>
#include <tools/TestServer.h>
#include <tools/WatchedProgram.h>

#include <osg/PagedLOD>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

/// Gives the finer tiles of all PagedLODs another name.
class Renamer : public osg::NodeVisitor
{
public:
    explicit Renamer(std::string name) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _name(std::move(name)) {}
    void apply(osg::PagedLOD& lod) override
    {
        for (unsigned int i = 0; i < lod.getNumFileNames(); ++i)
            if (!lod.getFileName(i).empty()) lod.setFileName(i, _name);
        traverse(lod);
    }

private:
    std::string _name;
};

class HostileTiles : public GlFixture
{
protected:
    /// The folders "scene" and "out".
    void write(const std::string& tile) const
    {
        const fs::path database = PagedScene::write(_place / "scene", PagedScene::Kind::Geocentric);
        const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(database.string());
        Renamer renamer(tile);
        root->accept(renamer);
        ASSERT_TRUE(osgDB::writeNodeFile(*root, database.string()));
        _place.write("scene/l.lua", "os.execute('touch " + (_place / "ran").string() + "')\n");
        _place.write("scene/x.geofx",
                     "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain></geofx>");
        fs::create_directories(_place / "out");
    }

    WatchedProgram draw(const std::string& scene, const std::vector<std::string>& more = {}) const
    {
        ProgramOptions how;
        how.folder = (_place / "scene").string();
        how.seconds = 60.0;
        how.environment = {"DISPLAY="};
        std::vector<std::string> command = {builtProgram("osggeofx_render"),
                                            scene,
                                            "-o",
                                            (_place / "out/a.png").string(),
                                            "--size",
                                            "80x60",
                                            "--view",
                                            "-157.8,21.4,8100,0,-90"};
        command.insert(command.end(), more.begin(), more.end());
        return watchProgram(command, how);
    }

    const TempDir _place;
};

TEST_F(HostileTiles, RunNoProgramAndAreSaidOnce)
{
    write("l.lua");
    const WatchedProgram watched = draw("x.geofx");
    expectHarmless(watched, {_place / "out"});
    EXPECT_FALSE(fs::exists(_place / "ran"));
    EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
    const std::string& said = watched.result.standardError;
    const std::size_t first = said.find("the coarser one stays in its place");
    EXPECT_NE(first, std::string::npos) << said;
    EXPECT_EQ(said.find("the coarser one stays", first + 1), std::string::npos) << said;
    EXPECT_NE(said.find("--allow-outside"), std::string::npos) << said;
    // The picture shows the tile above.
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile((_place / "out/a.png").string());
    ASSERT_TRUE(picture);
    EXPECT_EQ(osg::Vec3(picture->getColor(40u, 30u).r(), picture->getColor(40u, 30u).g(), 0.0f),
              osg::Vec3(1, 0, 0));
}

TEST_F(HostileTiles, AreDrawnAsEverWhereTheyAreTiles)
{
    PagedScene::write(_place / "scene", PagedScene::Kind::Geocentric);
    write("tiles/0_0_0.osgb");
    const WatchedProgram watched = draw("x.geofx");
    expectHarmless(watched, {_place / "out"});
    EXPECT_EQ(watched.result.exitCode, 0);
    EXPECT_EQ(watched.result.standardError, "");
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile((_place / "out/a.png").string());
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->getColor(40u, 30u).b(), 1.0f) << "the finest tiles";
}

TEST_F(HostileTiles, OfAServerRunNoProgram)
{
    write("l.lua");
    const TestServer server(_place / "scene");
    const WatchedProgram watched = draw(server.url("x.geofx"));
    expectHarmless(watched, {_place / "out"}, {"AF_INET", "AF_INET6", "AF_UNIX", "AF_NETLINK"});
    EXPECT_FALSE(fs::exists(_place / "ran"));
    EXPECT_EQ(watched.result.exitCode, 0) << watched.result.standardError;
    EXPECT_NE(watched.result.standardError.find("coarser one stays in its place"), std::string::npos)
        << watched.result.standardError;
}

TEST_F(HostileTiles, RunWhereTheProgramConsents)
{
    write("l.lua");
    draw("x.geofx", {"--allow-outside"});
    EXPECT_TRUE(fs::exists(_place / "ran")) << "what the others are kept from does work";
}

} // namespace
