// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Ways in the air: where their vertices are, against GeographicLib; where bent pictures have them; through OSG's files.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/mapping/PathRibbon.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/MappingStage.h>
#include <tools/TempDir.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

RoutePath flight()
{
    RoutePath path;
    path.name = "flight";
    path.altitude = RoutePath::ABSOLUTE;
    path.places = {{7.0, 45.0, 1000.0}, {7.02, 45.0, 2000.0}, {7.02, 45.02, 1500.0}};
    path.color = osg::Vec4(1, 0, 1, 1);
    return path;
}

osg::ref_ptr<osg::CoordinateSystemNode> globe()
{
    osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode;
    node->setEllipsoidModel(new osg::EllipsoidModel);
    return node;
}

class PathRibbonTest : public MappingStage
{
protected:
    PathRibbonTest() : MappingStage(480, 360) {}

    static osg::ref_ptr<osg::MatrixTransform> make(const PathRibbon& look, const RoutePath& path = flight())
    {
        std::string error;
        const osg::ref_ptr<Georeference> reference = Georeference::create(globe(), error);
        EXPECT_TRUE(reference) << error;
        const osg::ref_ptr<osg::MatrixTransform> node = look.make(path, *reference, error);
        EXPECT_TRUE(node) << error;
        return node;
    }
    /// Longitude and latitude, degrees, and height of each vertex.
    static std::vector<osg::Vec3d> placesOf(const osg::MatrixTransform& node)
    {
        std::vector<osg::Vec3d> places;
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*node.getChild(0)->asGeometry()->getVertexArray());
        for (const osg::Vec3& vertex : vertices)
        {
            const osg::Vec3d world = osg::Vec3d(vertex) * node.getMatrix();
            osg::Vec3d place;
            GeographicLib::Geocentric::WGS84().Reverse(world.x(), world.y(), world.z(), place.y(), place.x(),
                                                       place.z());
            places.push_back(place);
        }
        return places;
    }
};

} // namespace

TEST_F(PathRibbonTest, ARibbonIsLevelAndAsWideAsItShould)
{
    PathRibbon look;
    look.width = 30.0;
    look.step = 100.0;
    const std::vector<osg::Vec3d> places = placesOf(*make(look));
    ASSERT_GE(places.size(), 2u * 36u) << "3.8 km in steps of 100 m";
    const GeographicLib::LocalCartesian frame(45.0, 7.0, 1000.0);
    // The first place: 15 m to the right of the way, which goes east, is south.
    osg::Vec3d left, right;
    frame.Forward(places[0].y(), places[0].x(), places[0].z(), left.x(), left.y(), left.z());
    frame.Forward(places[1].y(), places[1].x(), places[1].z(), right.x(), right.y(), right.z());
    EXPECT_NEAR(left.y(), 15.0, 0.1);
    EXPECT_NEAR(right.y(), -15.0, 0.1);
    EXPECT_NEAR(left.x(), 0.0, 0.1);
    EXPECT_NEAR(left.z(), 0.0, 0.1);
    // Heights grow evenly along each leg.
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
    {
        const osg::Vec3d middle = (places[i] + places[i + 1]) / 2.0;
        if (middle.y() > 45.0005) continue;
        EXPECT_NEAR(middle.z(), 1000.0 + 1000.0 * (middle.x() - 7.0) / 0.02, 3.0);
        EXPECT_NEAR(places[i].z(), places[i + 1].z(), 0.01);
    }
}

TEST_F(PathRibbonTest, ACurtainHangsDownToItsFoot)
{
    PathRibbon look;
    look.shape = PathRibbon::CURTAIN;
    look.foot = 200.0;
    const std::vector<osg::Vec3d> places = placesOf(*make(look));
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
    {
        EXPECT_NEAR(places[i].z(), 200.0, 0.01);
        EXPECT_GE(places[i + 1].z(), 999.9);
        EXPECT_NEAR(places[i].x(), places[i + 1].x(), 1e-7);
        EXPECT_NEAR(places[i].y(), places[i + 1].y(), 1e-7);
    }
}

TEST_F(PathRibbonTest, ATubeIsRound)
{
    RoutePath path = flight();
    path.places = {{7.0, 45.0, 1000.0}, {7.02, 45.0, 1000.0}};
    PathRibbon look;
    look.shape = PathRibbon::TUBE;
    look.width = 40.0;
    const GeographicLib::LocalCartesian frame(45.0, 7.0, 1000.0);
    const std::vector<osg::Vec3d> places = placesOf(*make(look, path));
    double highest = -1e9, widest = 0.0;
    for (std::size_t i = 0; i < 11; ++i)
    {
        osg::Vec3d place;
        frame.Forward(places[i].y(), places[i].x(), places[i].z(), place.x(), place.y(), place.z());
        EXPECT_NEAR(std::hypot(place.y(), place.z()), 20.0, 0.05);
        highest = std::max(highest, place.z());
        widest = std::max(widest, std::abs(place.y()));
    }
    EXPECT_NEAR(highest, 20.0, 1.0);
    EXPECT_NEAR(widest, 20.0, 0.1);
}

// A bent picture has it where it has its places; it comes back from a file; it is picked.
TEST_F(PathRibbonTest, ItBendsWithTheGround)
{
    const TempDir folder;
    PathRibbon look;
    look.shape = PathRibbon::TUBE;
    look.width = 60.0;
    osgDB::writeNodeFile(*make(look), (folder / "flight.osgb").string());
    const osg::ref_ptr<osg::Node> ribbon = osgDB::readRefNodeFile((folder / "flight.osgb").string());
    ASSERT_TRUE(ribbon);
    EXPECT_EQ(ribbon->getName(), "flight");
    const osg::ref_ptr<osg::CoordinateSystemNode> node = globe();
    node->addChild(ribbon);
    _scene->removeEffect(_mappings);
    _scene->removeChildren(0, _scene->getNumChildren());
    _scene->addChild(node);
    const GeographicLib::LocalCartesian frame(45.01, 7.01, 0.0);
    const auto world = [&](double x, double y, double z)
    {
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        frame.Reverse(x, y, z, latitude, longitude, height);
        osg::Vec3d place;
        GeographicLib::Geocentric::WGS84().Forward(latitude, longitude, height, place.x(), place.y(),
                                                   place.z());
        return place;
    };
    const osg::Vec3d eye = world(0.0, -7000.0, 8000.0), at = world(0.0, -2600.0, 0.0);
    osg::Vec3d up = eye;
    up.normalize();
    viewer().getCamera()->setViewMatrixAsLookAt(eye, at, up);
    viewer().getCamera()->setProjectionMatrixAsPerspective(40.0, 480.0 / 360.0, 10.0, 100000.0);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setHorizonLine(0.85);
    bend->setFocusLine(0.35);
    bend->setContextTilt(0.5);
    _scene->addEffect(bend);
    double straight = 0.0;
    for (const bool bent : {false, true})
    {
        bend->setEnabled(bent);
        const osg::ref_ptr<osg::Image> image = draw();
        const DeformedView view(*_scene, *viewer().getCamera());
        int on = 0, all = 0;
        double moved = 0.0;
        for (int i = 1; i < 40; ++i)
        {
            const double share = i / 40.0;
            const bool second = share > 0.5;
            const double part = second ? 2.0 * share - 1.0 : 2.0 * share;
            osg::Vec3d place;
            GeographicLib::Geocentric::WGS84().Forward(
                second ? 45.0 + 0.02 * part : 45.0, second ? 7.02 : 7.0 + 0.02 * part,
                second ? 2000.0 - 500.0 * part : 1000.0 + 1000.0 * part, place.x(), place.y(), place.z());
            osg::Vec2d pixel;
            if (!view.project(place, pixel) || !inside(pixel, 2.0)) continue;
            ++all;
            const osg::Vec3d color = this->at(*image, pixel);
            on += color.x() > 0.5 && color.y() < 0.3 && color.z() > 0.5 ? 1 : 0;
            moved = std::max(moved, pixel.y());
        }
        EXPECT_GT(all, 12) << bent;
        EXPECT_EQ(on, all) << bent;
        if (!bent)
        {
            straight = moved;
            continue;
        }
        EXPECT_GT(std::abs(moved - straight), 5.0) << "nothing is bent";
    }
    osg::Vec3d place;
    GeographicLib::Geocentric::WGS84().Forward(45.0, 7.01, 1500.0, place.x(), place.y(), place.z());
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> picker =
        new osgUtil::LineSegmentIntersector(eye, place + (place - eye) * 0.5);
    osgUtil::IntersectionVisitor visitor(picker);
    _scene->accept(visitor);
    ASSERT_TRUE(picker->containsIntersections());
    EXPECT_EQ(picker->getFirstIntersection().drawable->getName(), "flight");
}

TEST_F(PathRibbonTest, WaysOfNoLengthAreRefused)
{
    std::string error;
    const osg::ref_ptr<Georeference> reference = Georeference::create(globe(), error);
    RoutePath path = flight();
    path.places.resize(1);
    EXPECT_FALSE(PathRibbon().make(path, *reference, error));
    EXPECT_NE(error.find("less than two places"), std::string::npos) << error;
    path.places = {{7.0, 45.0, 10.0}, {7.0, 45.0, 10.0}};
    EXPECT_FALSE(PathRibbon().make(path, *reference, error));
    EXPECT_NE(error.find("at one spot"), std::string::npos) << error;
}

TEST_F(PathRibbonTest, HeightsAboveTheGroundAreThere)
{
    // A slope that rises by 100 m for each hundredth of a degree to the east.
    const auto slope = [](double longitude, double)
    {
        return 300.0 + 1e4 * (longitude - 7.0);
    };
    RoutePath path = flight();
    path.places = {{7.0, 45.0, 100.0}, {7.02, 45.0, 50.0}};
    path.altitude = RoutePath::ABOVE_GROUND;
    PathRibbon look;
    look.ground = slope;
    for (const PathRibbon::Shape shape : {PathRibbon::RIBBON, PathRibbon::CURTAIN})
    {
        look.shape = shape;
        const std::vector<osg::Vec3d> places = placesOf(*make(look, path));
        EXPECT_NEAR(places[1].z(), 400.0, 0.1);
        EXPECT_NEAR(places.back().z(), 550.0, 0.1);
        for (std::size_t i = 0; shape == PathRibbon::CURTAIN && i < places.size(); i += 2)
            EXPECT_NEAR(places[i].z(), slope(places[i].x(), 45.0), 0.1) << "it ends at the ground";
    }
    // Where there is no ground, heights count from zero.
    look.ground = [](double, double)
    {
        return std::nan("");
    };
    EXPECT_NEAR(placesOf(*make(look, path))[1].z(), 100.0, 0.1);
}

// A tube of a tenth of a pixel, from above.
TEST_F(PathRibbonTest, ItIsNeverNarrowerThanItsPixels)
{
    _scene->removeEffect(_mappings);
    RoutePath path = flight();
    path.places = {{7.0, 45.0, 1000.0}, {7.04, 45.0, 1000.0}};
    const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
    osg::Vec3d eye, at;
    earth.Forward(45.0, 7.02, 13000.0, eye.x(), eye.y(), eye.z());
    earth.Forward(45.0, 7.02, 0.0, at.x(), at.y(), at.z());
    viewer().getCamera()->setViewMatrixAsLookAt(eye, at, {0, 0, 1});
    viewer().getCamera()->setProjectionMatrixAsPerspective(40.0, 480.0 / 360.0, 10.0, 100000.0);
    const auto count = [&](double least, double width)
    {
        PathRibbon look;
        look.shape = PathRibbon::TUBE;
        look.width = width;
        look.leastPixels = least;
        const osg::ref_ptr<osg::CoordinateSystemNode> node = globe();
        node->addChild(make(look, path));
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(node);
        const osg::ref_ptr<osg::Image> image = draw();
        int found = 0;
        for (int y = 0; y < 360; ++y)
            for (int x = 0; x < 480; ++x)
            {
                const osg::Vec3d color = this->at(*image, osg::Vec2d(x + 0.5, y + 0.5));
                found += color.x() > 0.5 && color.y() < 0.3 && color.z() > 0.5 ? 1 : 0;
            }
        return found;
    };
    // 3.15 km at 24.3 m for each pixel.
    const double length = 0.04 * 111412.0 * std::cos(osg::DegreesToRadians(45.0)) /
                          (2.0 * 12000.0 * std::tan(osg::DegreesToRadians(20.0)) / 360.0);
    EXPECT_LT(count(0.0, 2.0), 0.6 * length) << "gaps";
    EXPECT_NEAR(count(1.0, 2.0), length, 4.0);
    EXPECT_NEAR(count(3.0, 2.0), 3.0 * length, 8.0);
    // A wide one has its own width.
    EXPECT_NEAR(count(3.0, 243.0), 10.0 * length, 0.5 * length);
    std::string error;
    PathRibbon look;
    look.leastPixels = 11.0;
    EXPECT_FALSE(look.make(path, *Georeference::create(globe(), error), error));
    EXPECT_NE(error.find("give 0 to 10"), std::string::npos) << error;
}

// The same bend on the CPU: every vertex of a finer way is put where the deformation has it, and drawn without an effect.
TEST_F(PathRibbonTest, ItsBentPictureIsThatOfAWayBentOnTheCpu)
{
    _scene->removeEffect(_mappings);
    const GeographicLib::LocalCartesian frame(45.01, 7.01, 0.0);
    const auto world = [&](double x, double y, double z)
    {
        osg::Vec3d place;
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        frame.Reverse(x, y, z, latitude, longitude, height);
        GeographicLib::Geocentric::WGS84().Forward(latitude, longitude, height, place.x(), place.y(),
                                                   place.z());
        return place;
    };
    const osg::Vec3d eye = world(0.0, -7000.0, 8000.0);
    osg::Vec3d up = eye;
    up.normalize();
    viewer().getCamera()->setViewMatrixAsLookAt(eye, world(0.0, -2600.0, 0.0), up);
    viewer().getCamera()->setProjectionMatrixAsPerspective(40.0, 480.0 / 360.0, 10.0, 100000.0);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setHorizonLine(0.85);
    bend->setFocusLine(0.35);
    bend->setContextTilt(0.5);
    _scene->addEffect(bend);
    const auto drawn = [&](osg::Node* ribbon)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> node = globe();
        node->addChild(ribbon);
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(node);
        return draw();
    };
    for (const PathRibbon::Shape shape : {PathRibbon::RIBBON, PathRibbon::CURTAIN, PathRibbon::TUBE})
    {
        PathRibbon look;
        look.shape = shape;
        look.width = 150.0;
        look.leastPixels = 0.0;
        bend->setEnabled(true);
        const osg::ref_ptr<osg::Image> bent = drawn(make(look));
        look.step = 10.0;
        const osg::ref_ptr<osg::MatrixTransform> fine = make(look);
        const DeformedView view(*_scene, *viewer().getCamera());
        auto& vertices = static_cast<osg::Vec3Array&>(*fine->getChild(0)->asGeometry()->getVertexArray());
        double moved = 0.0;
        for (osg::Vec3& vertex : vertices)
        {
            const osg::Vec3d place = osg::Vec3d(vertex) * fine->getMatrix();
            const osg::Vec3d there = view.deform(place);
            moved = std::max(moved, (there - place).length());
            vertex = osg::Vec3(there - fine->getMatrix().getTrans());
        }
        EXPECT_GT(moved, 100.0) << "nothing is bent";
        vertices.dirty();
        fine->getChild(0)->dirtyBound();
        bend->setEnabled(false);
        const osg::ref_ptr<osg::Image> onCpu = drawn(fine);
        int both = 0, one = 0;
        for (int y = 0; y < 360; ++y)
        {
            for (int x = 0; x < 480; ++x)
            {
                const osg::Vec2d pixel(x + 0.5, y + 0.5);
                const auto isWay = [&](const osg::Image& image)
                {
                    const osg::Vec3d color = this->at(image, pixel);
                    return color.x() > color.y() + 0.15;
                };
                const bool a = isWay(*bent), b = isWay(*onCpu);
                both += a && b ? 1 : 0;
                one += a != b ? 1 : 0;
            }
        }
        EXPECT_GT(both, 300) << shape;
        // Pixels at its border: a coarse way is straight between its corners.
        EXPECT_LT(one, 0.05 * both) << shape;
    }
}
