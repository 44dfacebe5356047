// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A scene's sun in a viewer that has a headlight, as osgviewer's has.
#include <tools/GlFixture.h>
#include <tools/TempDir.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

namespace
{

class SceneSun : public geofx::test::GlFixture
{
protected:
    SceneSun()
    {
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(GEOFX_BUILD_DIR "/lib");
        // A white square that faces up, where the equator meets the zero meridian.
        osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry(
            osg::Vec3(6378137, -1e5, -1e5), osg::Vec3(0, 2e5, 0), osg::Vec3(0, 0, 2e5));
        osg::ref_ptr<osg::Material> white = new osg::Material;
        white->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
        white->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
        osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setEllipsoidModel(new osg::EllipsoidModel);
        root->getOrCreateStateSet()->setAttributeAndModes(white);
        root->addChild(square);
        osgDB::writeNodeFile(*root, (_folder / "terrain.osgb").string());
    }

    /// What the middle of the picture shows from straight above, 0…255.
    osg::Vec3 middle(const std::string& sun)
    {
        const auto file =
            _folder.write("a.geofx", "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>" +
                                         sun + "</geofx>");
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
        EXPECT_TRUE(scene);
        viewer().setLightingMode(osg::View::HEADLIGHT);
        viewer().getCamera()->setViewMatrixAsLookAt(osg::Vec3d(6478137, 0, 0), osg::Vec3d(),
                                                    osg::Vec3d(0, 0, 1));
        viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, 1.0, 1e3, 1e6);
        const osg::ref_ptr<osg::Image> image = render(scene);
        const osg::Vec4 color = image->getColor(image->s() / 2, image->t() / 2) * 255.0f;
        return osg::Vec3(color.r(), color.g(), color.b());
    }

private:
    geofx::test::TempDir _folder;
};

TEST_F(SceneSun, TakesThePlaceOfTheHeadlight)
{
    // The headlight shines on the square from straight above: 0.8, and 0.1 of OSG's own ambient light.
    EXPECT_NEAR(middle("").x(), 229.5f, 2.0f);
    // A sun below the horizon, and nothing else, leaves it in the dark.
    EXPECT_LT(middle("<sun azimuth='0' elevation='-30' ambient='#000000'/>").length(), 1.0f);
    EXPECT_LT(
        (middle("<sun azimuth='0' elevation='-30' ambient='#204060'/>") - osg::Vec3(32, 64, 96)).length(),
        2.0f);
    // One at 30 degrees gives sin 30° of its light.
    EXPECT_LT((middle("<sun azimuth='123' elevation='30' color='#ff8040' ambient='#000000'/>") -
               osg::Vec3(127.5f, 64, 32))
                  .length(),
              2.0f);
}

// A square that faces up where the equator meets the zero meridian, so the sun's height is its light.
TEST_F(SceneSun, FollowsAClock)
{
    const auto by = [&](const std::string& time)
    {
        return middle("<sun time='" + time + "' color='#ffffff' ambient='#000000'/>");
    };
    // At noon of an equinox it stands in the zenith, two hours earlier 60° high.
    EXPECT_LT((by("2026-03-20T12:07:30Z") - osg::Vec3(255, 255, 255)).length(), 3.0f);
    const osg::Vec3 morning = by("2026-03-20T10:07:30Z");
    EXPECT_NEAR(morning.x(), 255.0 * std::sin(osg::DegreesToRadians(60.0)), 4.0);
    EXPECT_GT(morning.x(), morning.z() + 2.0f);
    EXPECT_LT(by("2026-03-20T23:00:00Z").length(), 1.0f);
    // The same moment by another clock.
    EXPECT_LT((by("2026-03-20T00:07:30-10:00") - morning).length(), 1.0f);
}

} // namespace
