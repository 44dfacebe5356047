// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The panorama map's projection before any camera: the picture is what the paper's Section 3.1 says, it has an inverse, and
// nothing breaks at the ends of the Earth.
#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace glsl = osgGeoFX::glsl;
namespace glslf = osgGeoFX::glslf;
using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::PanoramaMap;
using osgGeoFX::PanoramaSnapshot;
using osgGeoFX::toOsg;

namespace
{

/// A panorama map before one camera.
struct Case
{
    CameraPose pose;
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    osg::ref_ptr<const PanoramaSnapshot> frame;

    const glsl::geofx_Panorama& panorama() const { return frame->view(); }
    double radius() const { return 1.0 / panorama().across; }
    Vec3d at(double x, double s, double height) const
    {
        const glm::dvec3 position = glsl::geofx_panoramaPosition(panorama(), {x, s, height});
        return {position.x, position.y, position.z};
    }
    /// What the camera makes of a position, −1…1 in the picture.
    Vec3d seen(const Vec3d& position) const { return frame->deform(position) * pose.projection(); }
    /// The angle at the Earth's center from the eye to a position, radians.
    double arc(const Vec3d& position) const
    {
        const Vec3d up = toOsg(panorama().globe.up);
        Vec3d away = position + up * (panorama().globe.height + 1.0 / panorama().globe.curvature);
        away.normalize();
        return std::acos(std::clamp(away * up, -1.0, 1.0));
    }
    Vec3d seen(double x, double s, double height) const { return seen(at(x, s, height)); }
    bool update()
    {
        frame = dynamic_cast<const PanoramaSnapshot*>(map->snapshot(pose.view()).get());
        return frame.valid();
    }
    /// What rounding errors are relative to.
    double scaleOf(const Vec3d& point) const
    {
        return point.length() + frame->deform(point).length() + std::abs(panorama().globe.height) +
               panorama().horizon;
    }
};

/// As people might set it.
void randomizeMap(PanoramaMap& map, Random& random)
{
    map.setHorizonDistance(random.uniform(0.5, 12.0));
    map.setCurveDistance(random.integer(0, 4) ? random.uniform(0.0, 0.9) * map.getHorizonDistance() : 0.0);
    map.setHorizonLine(random.uniform(0.1, 1.0));
    map.setHorizonBend(random.integer(0, 4) ? random.uniform(0.0, 0.3) : 0.0);
    map.setExaggeration(random.logarithmic(0.05, 10.0));
    map.setBaseHeight(random.integer(0, 1) ? 0.0 : random.uniform(-500.0, 3000.0));
    map.setBaseFromTerrain(random.integer(0, 1) != 0);
    if (random.integer(0, 3) == 0) map.setViewRadius(random.logarithmic(100.0, 2e5));
    map.setHorizonExaggeration(random.integer(0, 2) ? -1.0 : random.logarithmic(0.05, 10.0));
    if (random.integer(0, 2) == 0) map.setCurvePoints(randomCurve(random));
}

/// A camera as the map's contract wants it, that looks from straight down to level without a roll, with a map that is partly
/// there.
Case randomMix(Random& random)
{
    for (;;)
    {
        Case found;
        found.pose = randomPose(random);
        found.pose.roll = 0.0;
        found.pose.pitch = random.uniform(-1.5, 0.0);
        found.pose.shiftX = found.pose.shiftY = 0.0;
        randomizeMap(*found.map, random);
        found.map->setViewRadius(0.0);
        found.map->setBaseFromTerrain(false);
        // A map that is flatter than what the camera shows would have to fold on its way.
        found.map->setExaggeration(random.uniform(1.0, 5.0));
        found.map->setHorizonExaggeration(-1.0);
        found.map->setStrength(random.integer(0, 9) ? random.uniform(0.0, 1.0)
                                                    : random.logarithmic(1e-4, 1.0));
        if (found.pose.height < found.map->getBaseHeight() + 100.0 || found.pose.fieldOfView > 1.6) continue;
        if (found.update() && (!found.pose.globe || found.panorama().horizon < 2e6)) return found;
    }
}

Case randomCase(Random& random)
{
    for (;;)
    {
        Case found;
        found.pose = randomPose(random);
        // A camera on its side has no heading.
        found.pose.roll = std::remainder(found.pose.roll, osg::PI);
        if (std::abs(found.pose.roll) > osg::DegreesToRadians(80.0)) continue;
        randomizeMap(*found.map, random);
        // Beyond 60 degrees of arc nothing is promised.
        if (found.update() && (!found.pose.globe || found.panorama().horizon < 2e6)) return found;
    }
}

/// Up to the horizon, on both sides of the base and beside the picture.
Vec3d randomPlace(const Case& found, Random& random)
{
    const double s = random.integer(0, 3) ? random.uniform(0.0, found.panorama().horizon)
                                          : -random.logarithmic(1e-3, 2.0) * found.radius();
    return {random.uniform(-2.0, 2.0) * found.radius(), s, random.uniform(-400.0, 9000.0)};
}

template<class Check>
void forRandom(const Check& check)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Case found = randomCase(random);
        std::ostringstream text;
        text << "sample " << sample << ": " << describe(*found.map) << "; " << found.pose << "; radius "
             << found.radius();
        SCOPED_TRACE(text.str());
        check(found, random);
        if (::testing::Test::HasFailure()) return;
    }
}

glm::vec3 narrowed(const osg::Vec4d& uniform)
{
    return {uniform.x(), uniform.y(), uniform.z()};
}

/// What the GPU gets.
glslf::geofx_Panorama inFloats(const PanoramaSnapshot& frame)
{
    std::map<std::string, osg::Vec4d> all;
    for (const auto& [name, value] : frame.uniforms())
        all[name] = value;
    const auto number = [&](const char* name, int i)
    {
        return static_cast<float>(all[name][i]);
    };
    glslf::geofx_Panorama view{};
    view.globe.up = narrowed(all["up"]);
    view.globe.height = number("up", 3);
    view.globe.axis = narrowed(all["axis"]);
    view.globe.flattening = number("axis", 3);
    view.globe.curvature = number("right", 3);
    view.globe.scale = number("forward", 3);
    view.right = narrowed(all["right"]);
    view.forward = narrowed(all["forward"]);
    view.across = number("scale", 0);
    view.along = number("scale", 1);
    view.lift = number("scale", 2);
    view.base = number("scale", 3);
    view.curve = number("curve", 0);
    view.horizon = number("curve", 1);
    view.end = number("curve", 2);
    view.arch = number("curve", 3);
    view.nearest = number("origin", 3);
    view.origin = narrowed(all["origin"]);
    view.plain = number("originX", 3);
    view.mirrored = number("originY", 3);
    view.water = number("direction", 3);
    view.originX = narrowed(all["originX"]);
    view.originY = narrowed(all["originY"]);
    view.direction = narrowed(all["direction"]);
    view.directionX = narrowed(all["directionX"]);
    view.directionY = narrowed(all["directionY"]);
    view.cylinder.ring = number("cylinder", 0);
    view.cylinder.middle = number("cylinder", 1);
    view.cylinder.halfArc = number("cylinder", 2);
    view.liftGrowth = number("profile", 0);
    view.profile.first = number("profile", 1);
    view.profile.knot1 = narrowed(all["knot1"]);
    view.profile.knot2 = narrowed(all["knot2"]);
    view.profile.knot3 = narrowed(all["knot3"]);
    view.profile.knot4 = narrowed(all["knot4"]);
    view.profile.knot5 = narrowed(all["knot5"]);
    view.profile.knot6 = narrowed(all["knot6"]);
    return view;
}

} // namespace

TEST(Panorama, PlacesAreFoundAgain)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const Vec3d place = randomPlace(found, random);
            const Vec3d position = found.at(place.x(), place.y(), place.z());
            const glm::dvec3 back =
                glsl::geofx_panoramaPlace(found.panorama(), {position.x(), position.y(), position.z()});
            EXPECT_LT((Vec3d(back.x, back.y, back.z) - place).length(), 1e-9 * found.scaleOf(position));
        });
}

TEST(Panorama, IsUndoneByItsInverseUpToTheHorizon)
{
    double worst = 0.0;
    forRandom(
        [&](const Case& found, Random& random)
        {
            const Vec3d place = randomPlace(found, random);
            const Vec3d point = found.at(place.x(), place.y(), place.z());
            const double error =
                (found.frame->undeform(found.frame->deform(point)) - point).length() / found.scaleOf(point);
            worst = std::max(worst, error);
            EXPECT_LT(error, 1e-9) << place.x() << " " << place.y() << " " << place.z();
        });
    RecordProperty("worst_relative_error", std::to_string(worst * 1e12) + "e-12");
}

TEST(Panorama, LosesLittleInFloats)
{
    double worst = 0.0;
    forRandom(
        [&](const Case& found, Random& random)
        {
            const glslf::geofx_Panorama given = inFloats(*found.frame);
            const Vec3d place = randomPlace(found, random);
            const osg::Vec3f point(found.at(place.x(), place.y(), place.z()));
            const glm::vec3 moved = glslf::geofx_panoramaDeform(given, {point.x(), point.y(), point.z()});
            const Vec3d expected = found.frame->deform(point);
            const double least = found.pose.lens == CameraPose::ORTHOGRAPHIC ? found.pose.pictureSize : 0.0;
            const double distance = std::max(
                {Vec3d(point).length(), expected.length(), least, std::abs(found.panorama().globe.height)});
            const double error = (Vec3d(osg::Vec3f(moved.x, moved.y, moved.z)) - expected).length();
            // A rounding of the position grows as the picture does.
            const double stretch = std::max(1.0, found.frame->lipschitz({point, 0.0}) / 10.0);
            if (stretch == 1.0) worst = std::max(worst, error / distance);
            EXPECT_LT(error, 1e-5 * distance * stretch) << place.x() << " " << place.y() << " " << place.z();
        });
    RecordProperty("worst_share_of_distance", std::to_string(worst * 1e6) + "e-6");
}

TEST(Panorama, HasNoKinks)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const glsl::geofx_Panorama& view = found.panorama();
            const double x = random.uniform(-1.5, 1.5) * found.radius();
            const double h = random.uniform(-400.0, 9000.0);
            const double step = 1e-5 * std::min(found.radius(), view.horizon - view.curve);
            const auto picture = [&](double s)
            {
                const glm::dvec3 point = glsl::geofx_panoramaPicture(view, {x, s, h});
                return Vec3d(point.x, point.y, point.z * view.across);
            };
            std::vector<double> borders = {0.0, view.curve, view.horizon, view.end,
                                           2.0 * view.end - view.horizon};
            for (const osg::Vec2d& point : found.map->getCurvePoints())
                borders.push_back(point.x() * view.horizon);
            // The steepest change of the curve's slope, of its mean.
            const double curving = osgGeoFX::ratesOf(view.profile, 0.0, 1.0).second;
            for (const double border : borders)
            {
                const Vec3d here = picture(border);
                const Vec3d before = (here - picture(border - step)) / step * found.radius();
                const Vec3d after = (picture(border + step) - here) / step * found.radius();
                // What the fade, the steepest, changes over a step.
                const double lift = std::max(view.lift, view.lift + view.liftGrowth);
                const double allowed = 1e-3 * (1.0 + std::abs(lift * (h - view.base)) + view.arch);
                const double scale = std::max(
                    1.0, found.radius() / std::min(view.horizon - view.curve, view.end - view.horizon));
                EXPECT_LT((after - before).length(), allowed * scale * scale + 1e-4 * curving)
                    << "at " << border;
            }
        });
}

TEST(Panorama, EdgesThatLeaveThePictureLieNowhereAboveEquationOne)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const glsl::geofx_Panorama& view = found.panorama();
            const auto bent = [&](double x)
            {
                return -glsl::geofx_panoramaArch(view, x);
            };
            const double side = random.sign();
            const double inside = random.uniform(-1.0, 1.0), outside = side * random.logarithmic(1.0, 100.0);
            const double x = inside + random.uniform(0.0, 1.0) * (side - inside);
            const double share = (x - inside) / (outside - inside);
            EXPECT_LE(bent(inside) + share * (bent(outside) - bent(inside)), bent(x) + 1e-9)
                << inside << " to " << outside << ", at " << x;
            EXPECT_NEAR(bent(x), -view.arch * (1.0 - std::cos(x * osg::PI_2)), 1e-12);
        });
}

TEST(Panorama, KeepsOrientation)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const Vec3d place = randomPlace(found, random);
            const Vec3d point = found.at(place.x(), place.y(), place.z());
            // What is raised by thousands of pictures on the way to the horizon leaves no digits for differences.
            if (std::abs(found.panorama().liftGrowth * (place.z() - found.panorama().base)) > 1e3) return;
            // A curve through points may turn within a short way.
            const double fine = found.map->getCurvePoints().empty() ? 1e-5 : 1e-7;
            const double step = std::min(fine * (point.length() + found.radius()),
                                         1e-3 * (found.panorama().horizon - found.panorama().curve));
            // Behind the horizon heights fall, and what falls steeply turns over, out of sight.
            if (place.y() > found.panorama().horizon - 2.0 * step) return;
            Vec3d columns[3];
            for (int axis = 0; axis < 3; ++axis)
            {
                Vec3d offset;
                offset[axis] = step;
                columns[axis] = (found.frame->deform(point + offset) - found.frame->deform(point - offset)) /
                                (2.0 * step);
            }
            EXPECT_GT(columns[0] * (columns[1] ^ columns[2]), 0.0);
        });
}

TEST(Panorama, NeighboursStayAsNearAsTheBoundSays)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const Vec3d place = randomPlace(found, random);
            const Vec3d point = found.at(place.x(), place.y(), place.z());
            const osgGeoFX::Ball ball{point, 1e-4 * found.radius()};
            const Vec3d beside = point + randomDirection(random) * ball.radius;
            const double apart = (found.frame->deform(beside) - found.frame->deform(point)).length();
            EXPECT_LE(apart, found.frame->lipschitz(ball) * ball.radius * (1.0 + 1e-6) +
                                 1e-11 * found.scaleOf(point));
        });
}

TEST(Panorama, SummitsCompareWhereverTheyStand)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            if (found.map->getHorizonExaggeration() >= 0.0) return;
            const double plain = random.uniform(-400.0, 2000.0);
            const double height = random.logarithmic(10.0, 8000.0);
            const double k = random.logarithmic(0.1, 10.0);
            double shown[2] = {};
            double base = 0.0;
            for (int i = 0; i < 2; ++i)
            {
                const Vec3d place = randomPlace(found, random);
                const double top = plain + (i == 0 ? height : k * height);
                const Vec3d foot = found.seen(place.x(), place.y(), plain);
                const Vec3d summit = found.seen(place.x(), place.y(), top);
                shown[i] = summit.y() - foot.y();
                base = std::max({base, std::abs(foot.y()), std::abs(summit.y())});
                EXPECT_NEAR(summit.x(), foot.x(), 1e-9 * (1.0 + std::abs(foot.x())));
            }
            EXPECT_NEAR(shown[1], k * shown[0], 1e-9 * (base + 1.0) * (1.0 + k));
            // Eq. 2: as high as an upright width of the same metres, times the factor.
            const double aspect = found.pose.projection()(1, 1) /
                                  found.pose.projection()(0, 0); // of pixels, not of the picture
            EXPECT_NEAR(shown[0], found.map->getExaggeration() * height / found.radius() * aspect,
                        1e-9 * (base + 1.0));
        });
}

TEST(Panorama, ForegroundAndBackgroundHaveExaggerationsOfTheirOwn)
{
    int scales = 0;
    forRandom(
        [&](const Case& found, Random& random)
        {
            const double near = found.map->getExaggeration();
            const double far = found.map->getHorizonExaggeration();
            if (far < 0.0) return;
            ++scales;
            const double x = random.uniform(-1.0, 1.0) * found.radius();
            const double height = random.logarithmic(10.0, 8000.0);
            const double aspect = found.pose.projection()(1, 1) / found.pose.projection()(0, 0);
            // By how much what is so high is drawn as higher, of D2.
            const auto scaleAt = [&](double share)
            {
                const double s = share * found.panorama().horizon;
                const double shown = found.seen(x, s, found.panorama().base + height).y() -
                                     found.seen(x, s, found.panorama().base).y();
                return shown / (height / found.radius() * aspect);
            };
            const double exact = 1e-8 * (near + far + found.radius() / height);
            EXPECT_NEAR(scaleAt(0.0), near, exact);
            EXPECT_NEAR(scaleAt(-random.uniform(0.0, 1.0)), near, exact);
            EXPECT_NEAR(scaleAt(0.5), 0.5 * (near + far), exact);
            EXPECT_NEAR(scaleAt(1.0), far, exact);
            const double share = random.uniform(0.0, 1.0);
            const double step = scaleAt(std::min(share + 0.05, 1.0)) - scaleAt(share);
            EXPECT_GE(step * (far > near ? 1.0 : -1.0), -2.0 * exact);
        });
    EXPECT_GT(scales, sampleCount() / 10);
}

TEST(Panorama, EqualExaggerationsAreOneToTheBit)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            Case other = found;
            other.map = new PanoramaMap(*found.map);
            ASSERT_TRUE(other.map->setHorizonExaggeration(-1.0));
            ASSERT_TRUE(other.update());
            const Vec3d place = randomPlace(found, random);
            const Vec3d point = other.at(place.x(), place.y(), place.z());
            const Vec3d drawn = other.frame->deform(point);
            ASSERT_TRUE(other.map->setHorizonExaggeration(other.map->getExaggeration()));
            ASSERT_TRUE(other.update());
            EXPECT_EQ(other.frame->deform(point), drawn);
        });
}

TEST(Panorama, TheGroundShownIsARectangle)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const glsl::geofx_Panorama& view = found.panorama();
            const double bend = 2.0 * found.map->getHorizonBend();
            const double line = 2.0 * found.map->getHorizonLine() - 1.0;
            for (const double side : {-1.0, 1.0})
            {
                const double s = random.uniform(0.0, view.horizon);
                EXPECT_NEAR(found.seen(side * found.radius(), s, view.base).x(), side, 1e-9);
                EXPECT_NEAR(found.seen(side * found.radius(), 0.0, view.base).y(), -1.0 - bend, 1e-9);
                EXPECT_NEAR(found.seen(side * found.radius(), view.horizon, view.base).y(), line - bend,
                            1e-9);
            }
            EXPECT_NEAR(found.seen(0.0, 0.0, view.base).y(), -1.0, 1e-9);
        });
}

TEST(Panorama, TheSeaEndsAtTheHorizonLine)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const glsl::geofx_Panorama& view = found.panorama();
            const double line = 2.0 * found.map->getHorizonLine() - 1.0;
            EXPECT_NEAR(found.seen(0.0, view.horizon, view.base).y(), line, 1e-9);
            double last = -1.0;
            for (double s = 0.0; s < 1.5 * view.horizon; s += random.uniform(0.05, 0.4) * view.horizon)
            {
                const double y = found.seen(0.0, s, view.base).y();
                EXPECT_GE(y, last - 1e-9);
                EXPECT_LE(y, line + 1e-9);
                last = y;
            }
            if (!found.map->getCurvePoints().empty()) return;
            // Linear in the distance up to D1, quadratic from there (paper, Figure 5).
            const double scale = 4.0 * found.map->getHorizonLine() / (view.curve + view.horizon);
            const double near = random.uniform(0.0, view.curve);
            EXPECT_NEAR(found.seen(0.0, near, view.base).y(), scale * near - 1.0, 1e-9);
            const double t = random.uniform(0.0, 1.0);
            const double far = view.curve + t * (view.horizon - view.curve);
            EXPECT_NEAR(found.seen(0.0, far, view.base).y(),
                        scale * (view.curve + (t - 0.5 * t * t) * (view.horizon - view.curve)) - 1.0, 1e-9);
        });
}

TEST(Panorama, BendsHorizontalsByEquationOne)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const Vec3d place = randomPlace(found, random);
            const Vec3d middle = found.seen(0.0, place.y(), place.z());
            const Vec3d beside = found.seen(place.x(), place.y(), place.z());
            // Beside the picture the bend goes on straight.
            const double x = std::abs(beside.x()), within = std::min(x, 1.0);
            const double drop = 2.0 * found.map->getHorizonBend() *
                                (1.0 - std::cos(within * osg::PI_2) + (x - within) * osg::PI_2);
            EXPECT_NEAR(beside.y(), middle.y() - drop, 1e-9 * (1.0 + std::abs(middle.y())));
        });
}

TEST(Panorama, ShowsNothingOfWhatItHides)
{
    struct Counts
    {
        int behind = 0, besides = 0, below = 0, above = 0;
    };
    // All at one point of the horizon, or all beyond one of the picture's borders. Around the Earth, where nothing is
    // promised of what lies between two points, each point counts for itself.
    const auto expectHidden =
        [](const Case& found, const osg::Vec2d& room, const auto& randomPoint, Counts& counts)
    {
        const Vec3d point = found.seen(0.0, 3.0 * found.panorama().end, found.panorama().base);
        bool gathered = true;
        bool left = true;
        bool right = true;
        bool under = true;
        bool over = true;
        bool around = found.panorama().globe.curvature > 0.0;
        bool each = true;
        for (int i = 0; i < 20; ++i)
        {
            const Vec3d position = randomPoint(i);
            const Vec3d seen = found.seen(position);
            around = around && found.arc(position) > osg::PI / 3.0;
            const bool atPoint = std::hypot(seen.x() - point.x(), seen.y() - point.y()) < 1e-9;
            each = each &&
                   (atPoint || std::abs(seen.x()) > 1.0 + room.x() || std::abs(seen.y()) > 1.0 + room.y());
            gathered = gathered && atPoint;
            left = left && seen.x() < -1.0 - room.x();
            right = right && seen.x() > 1.0 + room.x();
            under = under && seen.y() < -1.0 - room.y();
            over = over && seen.y() > 1.0 + room.y();
        }
        EXPECT_TRUE(gathered || left || right || under || over || (around && each));
        counts.behind += gathered ? 1 : 0;
        counts.besides += left || right ? 1 : 0;
        counts.below += under && !left && !right ? 1 : 0;
        counts.above += over && !left && !right ? 1 : 0;
    };
    Counts balls, boxes;
    forRandom(
        [&](const Case& found, Random& random)
        {
            const glsl::geofx_Panorama& view = found.panorama();
            osgGeoFX::Ball ball;
            ball.center = found.at(random.sign() * random.logarithmic(0.1, 30.0) * found.radius(),
                                   random.uniform(-3.0, 3.0) * view.end, random.uniform(-400.0, 9000.0));
            ball.radius = random.logarithmic(1e-3, 1.0) * view.horizon;
            const osg::Vec2d room = random.integer(0, 1)
                                        ? osg::Vec2d()
                                        : osg::Vec2d(random.uniform(0.0, 0.5), random.uniform(0.0, 0.5));
            if (found.frame->hides(ball, room))
                expectHidden(
                    found, room, [&](int) { return ball.center + randomDirection(random) * ball.radius; },
                    balls);
            // A tile somewhere around the picture, turned any way.
            osgGeoFX::EyeBox box;
            box.center = found.at(random.uniform(-2.0, 2.0) * found.radius(),
                                  random.uniform(-0.5, 1.6) * view.end, random.uniform(-400.0, 9000.0));
            const double size = random.logarithmic(1e-3, 0.3) * view.horizon;
            const osg::Vec3d up = toOsg(view.globe.up);
            osg::Vec3d across = randomDirection(random) ^ up;
            across.normalize();
            box.half[0] = across * size;
            box.half[1] = (up ^ across) * (size * random.uniform(0.5, 1.0));
            box.half[2] = up * std::min(size, random.logarithmic(1.0, 2000.0));
            if (found.frame->hidesBox(box, room))
                expectHidden(
                    found, room,
                    [&](int i)
                    {
                        // Its corners first.
                        osg::Vec3d at = box.center;
                        for (int axis = 0; axis < 3; ++axis)
                            at += box.half[axis] *
                                  (i < 8 ? (i >> axis) % 2 * 2.0 - 1.0 : random.uniform(-1.0, 1.0));
                        return at;
                    },
                    boxes);
        });
    EXPECT_GT(balls.behind, sampleCount() / 20);
    EXPECT_GT(balls.besides, sampleCount() / 20);
    EXPECT_GT(balls.below, sampleCount() / 100);
    EXPECT_GT(boxes.behind, sampleCount() / 50);
    EXPECT_GT(boxes.besides, sampleCount() / 20);
    EXPECT_GT(boxes.below, sampleCount() / 100);
    EXPECT_GT(boxes.above, sampleCount() / 100);
}

// On the way from the camera's own picture to the map, what the map leaves out may be in the picture.
TEST(Panorama, PartlyThereItHidesNothingThatShows)
{
    int shown = 0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Case found = randomMix(random);
        SCOPED_TRACE(sample);
        osgGeoFX::Ball ball;
        ball.center =
            found.at(random.sign() * random.logarithmic(0.1, 30.0) * found.radius(),
                     random.uniform(-3.0, 3.0) * found.panorama().end, random.uniform(-400.0, 9000.0));
        ball.radius = random.logarithmic(1e-3, 0.1) * found.panorama().horizon;
        const Vec3d deformed = found.frame->deform(ball.center);
        const Vec3d seen = found.seen(ball.center);
        const bool inPicture = deformed.z() < 0.0 && std::abs(seen.x()) < 1.0 && std::abs(seen.y()) < 1.0;
        shown += inPicture ? 1 : 0;
        EXPECT_FALSE(inPicture && found.arc(ball.center) < osg::PI / 3.0 && found.frame->hides(ball, {}));
    }
    EXPECT_GT(shown, sampleCount() / 20);
}

TEST(Panorama, StillWaterMirrorsHeights)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const double level = random.uniform(-100.0, 2000.0);
            const osg::ref_ptr<const PanoramaSnapshot> mirror = found.frame->mirrored(level, 0.5);
            const Vec3d place = randomPlace(found, random);
            const double up = place.z();
            const Vec3d above = mirror->deform(found.at(place.x(), place.y(), level + up));
            const Vec3d below = found.frame->deform(found.at(place.x(), place.y(), level - up));
            EXPECT_LT((above - below).length(),
                      1e-9 * found.scaleOf(found.at(place.x(), place.y(), level + up)) +
                          1e-9 * below.length());
            EXPECT_NEAR(*mirror->viewDistance({}), 2.0 * *found.frame->viewDistance({}),
                        1e-9 * *mirror->viewDistance({}));
        });
}

TEST(Panorama, IsFiniteAtTheEndsOfTheEarth)
{
    int frames = 0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        Case found;
        found.pose = randomPose(random);
        const double latitudes[] = {osg::PI_2, -osg::PI_2, 0.0, found.pose.y};
        const double longitudes[] = {osg::PI, -osg::PI, 0.0, found.pose.x};
        const double heights[] = {0.0, -500.0, -12000.0, 1e-6, 4e7, found.pose.height};
        const double pitches[] = {0.0, -osg::PI_2, osg::PI_2, found.pose.pitch};
        if (found.pose.globe)
        {
            found.pose.y = latitudes[random.integer(0, 3)];
            found.pose.x = longitudes[random.integer(0, 3)];
        }
        found.pose.height = heights[random.integer(0, 5)];
        found.pose.pitch = pitches[random.integer(0, 3)];
        randomizeProperties(*found.map, random);
        found.map->setProjection(true);
        if (random.integer(0, 4) == 0) found.map->setExaggeration(0.0);
        if (random.integer(0, 4) == 0) found.map->setCurveDistance(0.0);
        if (!found.update()) continue;
        ++frames;
        SCOPED_TRACE(::testing::Message()
                     << "sample " << sample << ": " << describe(*found.map) << "; " << found.pose);
        const Vec3d points[] = {{}, // the eye, its foot, the Earth's center, the other side, and anything
                                toOsg(found.panorama().globe.up) * -found.pose.height,
                                toOsg(found.panorama().globe.up) * (-6.4e6 - found.pose.height),
                                toOsg(found.panorama().globe.up) * (-1.28e7 - found.pose.height),
                                toOsg(found.panorama().forward) * 1e7,
                                randomDirection(random) * random.logarithmic(1e-3, 1e8)};
        for (const Vec3d& point : points)
        {
            const Vec3d deformed = found.frame->deform(point);
            EXPECT_TRUE(deformed.valid());
            EXPECT_TRUE(found.frame->undeform(point).valid());
            EXPECT_TRUE(found.frame->undeform(deformed).valid());
            const osgGeoFX::Ball ball{point, random.logarithmic(1e-3, 1e6)};
            EXPECT_TRUE(std::isfinite(found.frame->lipschitz(ball)));
            const auto sag = found.frame->sag(ball, Vec3d(1.0, 2.0, 3.0));
            EXPECT_TRUE(std::isfinite(sag.curve) && std::isfinite(sag.kink));
            found.frame->hides(ball, {});
            EXPECT_GT(found.frame->longestEdge(ball, 1e-3), 0.0);
            const glm::vec3 moved =
                glslf::geofx_panoramaDeform(inFloats(*found.frame), {point.x(), point.y(), point.z()});
            EXPECT_TRUE(std::isfinite(moved.x) && std::isfinite(moved.y) && std::isfinite(moved.z))
                << point.x() << " " << point.y() << " " << point.z();
        }
        for (const auto& [name, value] : found.frame->uniforms())
        {
            for (int i = 0; i < 4; ++i)
                EXPECT_TRUE(std::isfinite(static_cast<float>(value[i]))) << name;
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(frames, sampleCount() / 2);
}

TEST(Panorama, IsAMixOfBothPicturesAtEveryStrength)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(static_cast<std::uint64_t>(sample));
        Case found = randomMix(random);
        const double strength = osgGeoFX::shareOf(found.map->getStrength());
        const Vec3d place = randomPlace(found, random);
        const Vec3d point = found.at(place.x(), place.y(), place.z());
        const Vec3d mixed = found.frame->deform(point);
        const glm::vec3 narrow =
            glslf::geofx_panoramaDeform(inFloats(*found.frame), {point.x(), point.y(), point.z()});
        found.map->setStrength(1.0);
        ASSERT_TRUE(found.update());
        const Vec3d expected = point * (1.0 - strength) + found.frame->deform(point) * strength;
        EXPECT_LT((mixed - expected).length(), 1e-9 * found.scaleOf(point));
        const double stretch = std::max(1.0, found.frame->lipschitz({point, 0.0}) / 10.0);
        EXPECT_LT((Vec3d(osg::Vec3f(narrow.x, narrow.y, narrow.z)) - expected).length(),
                  1e-5 * stretch * (found.scaleOf(point)));
        if (HasFailure()) return;
    }
}

TEST(Panorama, StaysOneToOneAndIsUndoneAtEveryStrength)
{
    double worst = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Case found = randomMix(random);
        Vec3d place = randomPlace(found, random);
        place.y() = random.uniform(0.0, 0.99) * found.panorama().horizon;
        place.x() = random.uniform(-1.0, 1.0) * found.radius();
        const Vec3d point = found.at(place.x(), place.y(), place.z());
        const Vec3d drawn = found.frame->deform(point);
        // What neither picture shows may fold.
        const Vec3d own = point * found.pose.projection();
        const bool before = found.pose.lens == CameraPose::ORTHOGRAPHIC || point.z() < 0.0;
        if (!before || std::max(std::abs(own.x()), std::abs(own.y())) > 1.0) continue;
        const glm::dvec3 onMap =
            glsl::geofx_panoramaPicture(found.panorama(), {place.x(), place.y(), place.z()});
        if (std::max(std::abs(onMap.x), std::abs(onMap.y)) > 1.0) continue;
        // The same for ground so far around the Earth that the camera's axis points away from it.
        const Vec3d above = found.at(place.x(), place.y(), place.z() + 100.0) - point;
        if (-above.z() > 2.0) continue;
        std::ostringstream text;
        text << "sample " << sample << ": " << describe(*found.map) << "; " << found.pose << "; place "
             << place.x() << " " << place.y() << " " << place.z();
        SCOPED_TRACE(text.str());
        const double error = (found.frame->undeform(drawn) - point).length() / found.scaleOf(point);
        worst = std::max(worst, error);
        EXPECT_LT(error, 1e-8);
        const double small = 1e-5 * found.scaleOf(point);
        Vec3d columns[3];
        for (int axis = 0; axis < 3; ++axis)
        {
            Vec3d beside = point;
            beside[axis] += small;
            columns[axis] = (found.frame->deform(beside) - drawn) / small;
        }
        EXPECT_GT(columns[0] * (columns[1] ^ columns[2]), 0.0);
        if (HasFailure()) return;
    }
    RecordProperty("worst_relative_error", std::to_string(worst * 1e12) + "e-12");
}
