// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures of routes: before and after a file, copied, edited, and among other mappings.
#include <osgGeoFX/mapping/MarkImages.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <tools/MappingStage.h>

#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <sstream>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

class RoutePictures : public MappingStage
{
protected:
    static void SetUpTestSuite()
    {
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(GEOFX_BUILD_DIR "/lib");
    }

    void SetUp() override
    {
        MappingStage::SetUp();
        lookDown({0, 0}, 12.0);
    }

    osg::ref_ptr<RouteMapping> add(const std::vector<osg::Vec2d>& places, const osg::Vec4d& color)
    {
        const osg::ref_ptr<RouteMapping> route = new RouteMapping;
        RouteMapping::Style style;
        style.color = color;
        style.halfWidth = 40.0;
        style.casing = 20.0;
        style.dash = 200.0;
        style.gap = 90.0;
        style.pointRadius = 90.0;
        style.surroundings = 150.0;
        style.softness = 100.0;
        route->setStyle(style);
        route->setWayPoints(places);
        _mappings->addRoute(route);
        return route;
    }

    osg::ref_ptr<ProjectiveMappings> throughFile(const ProjectiveMappings& effect)
    {
        osgDB::ReaderWriter* const plugin = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
        std::stringstream stream;
        const osg::ref_ptr<osgDB::Options> plain = new osgDB::Options("Compressor=null");
        EXPECT_TRUE(plugin->writeObject(effect, stream, plain).success());
        osgDB::ReaderWriter::ReadResult result = plugin->readObject(stream);
        return dynamic_cast<ProjectiveMappings*>(result.getObject());
    }

    osg::ref_ptr<osg::Image> drawWith(const osg::ref_ptr<ProjectiveMappings>& effect)
    {
        _scene->removeEffect(_mappings);
        _mappings = effect;
        _scene->addEffect(_mappings);
        return draw();
    }

    static bool equal(const osg::Image& a, const osg::Image& b)
    {
        return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
               std::equal(a.data(), a.data() + a.getTotalSizeInBytes(), b.data());
    }

    /// Two routes with a mapping of their order between them, changed so that they are not as they were added.
    void build()
    {
        const osg::ref_ptr<RouteMapping> first = add({{-700, -300}, {0, -300}}, {0.9, 0.1, 0.1, 1.0});
        draw(); // so that the GPU has it before what comes later
        const osg::ref_ptr<ProjectiveMapping> plain = makeSolid({0, -300}, 250.0, {0.1, 0.8, 0.3});
        plain->setOrder(2);
        _mappings->addMapping(plain);
        const osg::ref_ptr<RouteMapping> second = add({{-300, -800}, {-300, 700}}, {0.1, 0.2, 0.9, 0.6});
        second->setPointLayer(new DataLayer(makeDisc(64, {1, 1, 0, 1}, {0, 0, 0, 1}, 0.5)));
        second->highlight(0);
        first->setWayPoints({{-700, -300}, {0, -300}, {300, 400}, {800, 300}});
        first->highlight(1);
    }
};

} // namespace

TEST_F(RoutePictures, OfAFileAreTheSameToTheBit)
{
    build();
    const osg::ref_ptr<osg::Image> before = draw();
    const osg::ref_ptr<ProjectiveMappings> read = throughFile(*_mappings);
    ASSERT_TRUE(read);
    ASSERT_EQ(read->getNumRoutes(), 2u);
    const osg::ref_ptr<osg::Image> after = drawWith(read);
    EXPECT_TRUE(equal(*after, *before)) << differing(*after, *before);
    // The comparison can tell.
    read->getRoute(0)->highlight(2);
    EXPECT_FALSE(equal(*draw(), *before));
    read->getRoute(0)->highlight(1);
    EXPECT_TRUE(equal(*draw(), *before));
    // Editing after reading is editing before.
    const std::vector<osg::Vec2d> places = {{-600, 600}, {600, -600}, {700, 700}};
    ASSERT_TRUE(read->getRoute(1)->setWayPoints(places));
    const osg::ref_ptr<osg::Image> edited = draw();
    EXPECT_FALSE(equal(*edited, *before));
    const osg::ref_ptr<ProjectiveMappings> again = throughFile(*read);
    ASSERT_TRUE(again);
    EXPECT_TRUE(equal(*drawWith(again), *edited));
}

TEST_F(RoutePictures, OfACopyAreTheSameToTheBit)
{
    build();
    const osg::ref_ptr<osg::Image> before = draw();
    for (const unsigned int flags : {0u, static_cast<unsigned int>(osg::CopyOp::DEEP_COPY_ALL)})
        EXPECT_TRUE(equal(*drawWith(osg::clone(_mappings.get(), osg::CopyOp(flags))), *before));
}

// The ranks on the GPU, as mappingsAt() has them.
TEST_F(RoutePictures, RoutesLieAboveMappingsOfTheirOrderAndBelowLaterOnes)
{
    build();
    const osg::ref_ptr<osg::Image> image = draw();
    const auto colorAt = [&](const osg::Vec2d& place)
    {
        return at(*image, pixelOf(place));
    };
    // The first route's line over the green square, which was added after it, and the square above its outline.
    EXPECT_TRUE(alike(colorAt({-225, -300}), {230 / 255.0, 26 / 255.0, 26 / 255.0}));
    EXPECT_TRUE(alike(colorAt({-225, -350}), {0.1, 0.8, 0.3}));
    EXPECT_TRUE(_mappings->routeOf(*_mappings->mappingsAt({-300, -320}).front()) == _mappings->getRoute(1));
    RouteMapping& first = *_mappings->getRoute(0);
    first.setEnabled(false);
    EXPECT_FALSE(equal(*draw(), *image));
    first.setEnabled(true);
    EXPECT_TRUE(equal(*draw(), *image)) << "as if it had always been there";
    // Longer ones have mappings that were made later than all others.
    const std::vector<osg::Vec2d> places = first.getWayPoints();
    first.setWayPoints({{-700, -300}, {0, -300}});
    first.setWayPoints(places);
    EXPECT_TRUE(equal(*draw(), *image));
}
