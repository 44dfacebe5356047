// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/CameraPath.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <sstream>

using osgGeoFX::CameraPath;
using osgGeoFX::Georeference;
using osgGeoFX::ViewPoint;

namespace
{

/// A plane: 100 km for each degree, north along y, valid within ten degrees.
class FlatReference : public Georeference
{
public:
    FlatReference() = default;
    FlatReference(const FlatReference& other, const osg::CopyOp& op) : Georeference(other, op) {}
    META_Object(test, FlatReference)

        bool isGeocentric() const override
    {
        return false;
    }
    bool toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const override
    {
        world.set(scale * longitude, scale * latitude, height);
        return std::abs(longitude) < osg::DegreesToRadians(10.0);
    }
    bool toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                    double& height) const override
    {
        longitude = world.x() / scale;
        latitude = world.y() / scale;
        height = world.z();
        return true;
    }
    bool localToWorld(double longitude, double latitude, double height, osg::Matrixd& frame) const override
    {
        osg::Vec3d world;
        if (!toWorld(longitude, latitude, height, world)) return false;
        frame = osg::Matrixd::translate(world);
        return true;
    }

    const double scale = osg::RadiansToDegrees(100000.0);
};

osg::ref_ptr<Georeference> geocentric()
{
    osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode("WKT", "");
    node->setEllipsoidModel(new osg::EllipsoidModel);
    std::string error;
    osg::ref_ptr<Georeference> reference = Georeference::create(node, error);
    EXPECT_TRUE(reference.valid()) << error;
    return reference;
}

ViewPoint parsed(const std::string& text)
{
    std::string error;
    const auto point = ViewPoint::parse(text, error);
    EXPECT_TRUE(point) << error;
    return point.value_or(ViewPoint());
}

/// Eye coordinates (x right, y up, −z forward) of a place given in the camera's frame: east, north, up from it.
osg::Vec3d seen(const Georeference& reference, const ViewPoint& point, const osg::Vec3d& eastNorthUp)
{
    osg::Matrixd frame;
    osg::Matrixd view;
    EXPECT_TRUE(reference.localToWorld(point.longitude, point.latitude, point.height, frame));
    EXPECT_TRUE(point.viewMatrix(reference, view));
    return eastNorthUp * frame * view;
}

void expectNear(const osg::Vec3d& actual, const osg::Vec3d& expected)
{
    EXPECT_LT((actual - expected).length(), 1e-5) << actual.x() << " " << actual.y() << " " << actual.z();
}

class ViewPointOn : public ::testing::TestWithParam<bool>
{
protected:
    osg::ref_ptr<Georeference> _reference =
        GetParam() ? geocentric() : osg::ref_ptr<Georeference>(new FlatReference);
};

std::optional<CameraPath> pathOf(const std::string& text, std::string& error)
{
    std::istringstream stream(text);
    return CameraPath::read(stream, "flight.csv", error);
}

} // namespace

TEST_P(ViewPointOn, HeadingTurnsClockwiseFromNorth)
{
    expectNear(seen(*_reference, parsed("3,40,1000,0,0"), {0.0, 100.0, 0.0}), {0.0, 0.0, -100.0});
    expectNear(seen(*_reference, parsed("3,40,1000,90,0"), {100.0, 0.0, 0.0}), {0.0, 0.0, -100.0});
    expectNear(seen(*_reference, parsed("3,40,1000,0,0"), {100.0, 0.0, 0.0}), {100.0, 0.0, 0.0});
    expectNear(seen(*_reference, parsed("3,40,1000,-90,0"), {0.0, 0.0, 100.0}), {0.0, 100.0, 0.0});
}

TEST_P(ViewPointOn, PitchIsNegativeDownwards)
{
    expectNear(seen(*_reference, parsed("3,40,1000,0,-90"), {0.0, 0.0, -1000.0}), {0.0, 0.0, -1000.0});
    expectNear(seen(*_reference, parsed("3,40,1000,0,-90"), {0.0, 100.0, -1000.0}), {0.0, 100.0, -1000.0});
    expectNear(seen(*_reference, parsed("3,40,1000,0,-45"), {0.0, 100.0, -100.0}),
               {0.0, 0.0, -std::sqrt(20000.0)});
}

TEST_P(ViewPointOn, PositiveRollPutsTheRightWingDown)
{
    // With the right wing down the horizon turns anticlockwise: what is right of the camera rises in the picture.
    const osg::Vec3d right = seen(*_reference, parsed("3,40,1000,0,0,30"), {100.0, 100.0, 0.0});
    EXPECT_NEAR(right.y(), 50.0, 1e-5);
    expectNear(seen(*_reference, parsed("3,40,1000,0,0,90"), {0.0, 0.0, 100.0}), {-100.0, 0.0, 0.0});
}

TEST_P(ViewPointOn, AGroundPointLooksIntoTheImageCenter)
{
    const ViewPoint point = parsed("-2.5,51,5000,123,-37,11");
    // The camera's axis meets the plane 5000 m below it here:
    const double along = 5000.0 / std::tan(osg::DegreesToRadians(37.0));
    const osg::Vec3d target(along * std::sin(osg::DegreesToRadians(123.0)),
                            along * std::cos(osg::DegreesToRadians(123.0)), -5000.0);
    const osg::Vec3d eye = seen(*_reference, point, target);
    const osg::Vec3d image = eye * osg::Matrixd::perspective(30.0, 1.5, 1.0, 1e5);
    EXPECT_NEAR(image.x(), 0.0, 1e-9);
    EXPECT_NEAR(image.y(), 0.0, 1e-9);
    EXPECT_LT(eye.z(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Grounds, ViewPointOn, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Geocentric" : "Flat"; });

TEST(ViewPoint, RefusesWhatIsNoView)
{
    std::string error;
    for (const char* text : {"", "1,2,3,4", "1,2,3,4,5,6,7", "1,2,3,4,x", "1,2,3,4,5,", "1,2,nan,4,5",
                             "1,91,3,4,5", "1,2,3,4,-91", "1 2,3,4,5,6", "1,,3,4,5"})
    {
        error.clear();
        EXPECT_FALSE(ViewPoint::parse(text, error)) << text;
        EXPECT_EQ(error.empty() ? '.' : error.back(), '.');
        EXPECT_FALSE(error.empty()) << text;
    }
}

TEST(ViewPoint, OutsideTheProjectionThereIsNoMatrix)
{
    osg::Matrixd view;
    EXPECT_FALSE(parsed("11,0,0,0,0").viewMatrix(*osg::ref_ptr<Georeference>(new FlatReference), view));
}

TEST(ViewPoint, ViewOfPointsHasThemAllInThePictureAndNotSmall)
{
    const osg::ref_ptr<Georeference> globe = geocentric();
    osg::Matrixd place;
    ASSERT_TRUE(globe->localToWorld(osg::DegreesToRadians(-158.0), osg::DegreesToRadians(21.0), 0.0, place));
    for (const Georeference* reference :
         {static_cast<const Georeference*>(nullptr), static_cast<const Georeference*>(globe.get())})
    {
        const osg::Matrixd frame = reference ? place : osg::Matrixd::translate(6e5, 2e6, 0.0);
        for (const double aspect : {0.5, 1.0, 2.0})
        {
            std::vector<osg::Vec3d> points;
            for (const double x : {-30000.0, 30000.0})
            {
                for (const double y : {-20000.0, 20000.0})
                    points.push_back(osg::Vec3d(x, y, 100.0) * frame);
            }
            const osg::Vec3d center = osg::Vec3d() * frame;
            const osg::Matrixd view =
                osgGeoFX::viewOfPoints(points, center, reference, osg::DegreesToRadians(30.0), aspect);
            const osg::Matrixd projection = osg::Matrixd::perspective(30.0, aspect, 1.0, 1e6);
            double outermost = 0.0;
            for (const osg::Vec3d& point : points)
            {
                const osg::Vec3d image = point * view * projection;
                outermost = std::max({outermost, std::abs(image.x()), std::abs(image.y())});
            }
            EXPECT_LT(outermost, 1.0);
            EXPECT_GT(outermost, 0.9);
            const osg::Vec3d above = osg::Vec3d(0.0, 0.0, 1000.0) * frame * view * projection;
            EXPECT_NEAR(above.x(), 0.0, 1e-9);
            EXPECT_GT(above.y(), 0.0) << "the sky is not up";
            const osg::Vec3d north = osg::Vec3d(0.0, 1000.0, 0.0) * frame * view * projection;
            EXPECT_GT(north.y(), 0.0) << "north is not at the top";
        }
    }
}

TEST(CameraPath, InterpolatesEvenlyInTimeAndAlongTheShorterArc)
{
    std::string error;
    const auto path = pathOf("time,lon,lat,alt,heading,pitch,roll\n"
                             "# a comment, and an empty line\n\n"
                             "10, 179, 20, 1000, 350, -10, 0\r\n"
                             "20, -179, 22, 2000, 20, -20, 10\n"
                             "40, -178, 22, 2000, 20, -20, 10\n",
                             error);
    ASSERT_TRUE(path) << error;
    const ViewPoint middle = path->at(15.0);
    EXPECT_NEAR(osg::RadiansToDegrees(middle.longitude), 180.0, 1e-9);
    EXPECT_NEAR(osg::RadiansToDegrees(middle.latitude), 21.0, 1e-9);
    EXPECT_NEAR(middle.height, 1500.0, 1e-9);
    EXPECT_NEAR(osg::RadiansToDegrees(middle.heading), 365.0, 1e-9);
    EXPECT_NEAR(osg::RadiansToDegrees(middle.pitch), -15.0, 1e-9);
    EXPECT_NEAR(osg::RadiansToDegrees(middle.roll), 5.0, 1e-9);
    EXPECT_NEAR(path->at(0.0).height, 1000.0, 1e-9);
    EXPECT_NEAR(path->at(99.0).height, 2000.0, 1e-9);
    EXPECT_DOUBLE_EQ(path->timeOfFrame(0, 4), 10.0);
    EXPECT_DOUBLE_EQ(path->timeOfFrame(1, 4), 20.0);
    EXPECT_DOUBLE_EQ(path->timeOfFrame(3, 4), 40.0);
    EXPECT_DOUBLE_EQ(path->timeOfFrame(0, 1), 10.0);
}

TEST(CameraPath, NamesFileAndLineOfAnError)
{
    const std::string header = "time,lon,lat,alt,heading,pitch\n";
    const std::pair<std::string, std::string> cases[] = {
        {"lon,lat,time\n1,2,3\n", "line 1"},     {header + "0,1,2,3,4,5\n1,2,3\n", "line 3"},
        {header + "0,1,2,3,4,x\n", "line 2"},    {header + "5,1,2,3,4,5\n5,1,2,3,4,5\n", "line 3"},
        {header + "0,1,95,3,4,5\n", "latitude"}, {header, "no points"},
    };
    for (const auto& [text, part] : cases)
    {
        std::string error;
        EXPECT_FALSE(pathOf(text, error)) << text;
        EXPECT_NE(error.find("flight.csv"), std::string::npos) << error;
        EXPECT_NE(error.find(part), std::string::npos) << error;
    }
    std::string error;
    EXPECT_FALSE(CameraPath::read("no-such-file.csv", error));
    EXPECT_NE(error.find("no-such-file.csv"), std::string::npos) << error;
}
