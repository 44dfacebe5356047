// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/RandomViews.h>

#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <sstream>

namespace geofx::test
{

namespace
{

using osgGeoFX::Effect;
using osgGeoFX::Property;

constexpr double pi = 3.14159265358979323846;

const osg::EllipsoidModel* wgs84()
{
    static const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    return ellipsoid;
}

/// Values that people would choose, and now and then the edges of what is taken.
double sensibleValue(const std::string& name, Random& random)
{
    const int die = random.integer(0, 9);
    if (name == "planeHeight") return die < 5 ? 0.0 : random.uniform(-300.0, 3000.0);
    if (name == "tallest") return die < 5 ? -1.0 : random.logarithmic(1.0, 9000.0);
    if (name == "contextTilt") return die < 5 ? 0.0 : random.uniform(0.0, 0.9);
    if (name == "focusDistance") return random.sign() * random.logarithmic(1.0, 2e4);
    if (name == "zoneWidth") return die == 0 ? 0.0 : random.logarithmic(1.0, 2e4);
    if (name == "lowHeight") return random.uniform(0.0, 1000.0);
    if (name == "highHeight") return random.uniform(500.0, 5000.0);
    if (name == "factor") return die < 7 ? random.logarithmic(0.2, 5.0) : random.logarithmic(0.01, 100.0);
    if (name == "baseHeight") return die < 5 ? 0.0 : random.uniform(-100.0, 4000.0);
    if (name == "viewRadius") return die < 6 ? 0.0 : random.logarithmic(100.0, 3e5);
    if (name == "curveDistance") return die == 0 ? 0.0 : random.logarithmic(0.05, 5.0);
    if (name == "horizonDistance") return random.logarithmic(0.3, 20.0);
    if (name == "horizonExaggeration") return die < 5 ? -1.0 : random.logarithmic(0.1, 20.0);
    if (name == "exaggeration") return die == 0 ? 0.0 : random.logarithmic(0.1, 20.0);
    if (name == "strength") return die < 5 ? 1.0 : random.uniform(0.0, 1.0);
    if (name == "horizontalAngle") return die < 5 ? 0.0 : random.uniform(0.05, 2.0 * pi);
    if (name == "baseHeight") return die < 5 ? 0.0 : random.uniform(-500.0, 4000.0);
    if (name.size() > 6 && name.compare(0, 5, "curve") == 0 && name[5] >= '1' && name[5] <= '6')
    {
        // The points of a bending curve, in order; where one is not, it has no distance.
        const double place = (name[5] - '0') / 7.0;
        const bool distance = name.find("Distance") != std::string::npos;
        if (distance) return die < 6 ? 0.0 : place + random.uniform(-0.06, 0.06);
        return std::clamp(place + random.uniform(-0.13, 0.3), 0.001, 1.0);
    }
    return std::nan("");
}

double randomValue(const Property& property, Random& random)
{
    const double sensible = sensibleValue(property.name, random);
    if (!std::isnan(sensible)) return sensible;
    const double value = random.uniform(property.minimum, property.maximum);
    const bool number = property.kind == Property::Kind::Number || property.kind == Property::Kind::Angle;
    return number ? value : std::round(value);
}

} // namespace

osg::Matrixd CameraPose::modelView() const
{
    osg::Matrixd localToWorld;
    if (globe)
    {
        wgs84()->computeLocalToWorldTransformFromLatLongHeight(y, x, height, localToWorld);
    }
    else
    {
        localToWorld.makeTranslate(x, y, height);
    }
    // From OSG's camera, which looks along −z with y up, to one that looks north.
    const osg::Matrixd cameraToLocal = osg::Matrixd::rotate(-roll, 0.0, 0.0, 1.0) *
                                       osg::Matrixd::rotate(pi / 2.0 + pitch, 1.0, 0.0, 0.0) *
                                       osg::Matrixd::rotate(-heading, 0.0, 0.0, 1.0);
    return osg::Matrixd::inverse(cameraToLocal * localToWorld);
}

osg::Matrixd CameraPose::projection() const
{
    if (lens == ORTHOGRAPHIC)
    {
        const double top = pictureSize / 2.0;
        return osg::Matrixd::ortho(-top * aspect, top * aspect, -top, top, -1e5, 1e6);
    }
    const double near = 1.0;
    const double top = near * std::tan(fieldOfView / 2.0);
    const double dx = lens == OFF_AXIS ? shiftX * top * aspect : 0.0;
    const double dy = lens == OFF_AXIS ? shiftY * top : 0.0;
    return osg::Matrixd::frustum(dx - top * aspect, dx + top * aspect, dy - top, dy + top, near, 1e6);
}

osgGeoFX::Ground CameraPose::ground() const
{
    osgGeoFX::Ground ground;
    if (globe) ground.ellipsoid = wgs84();
    ground.minHeight = lowestGround;
    ground.maxHeight = highestGround;
    ground.heightsKnown = lowestGround < highestGround;
    return ground;
}

osgGeoFX::ViewGeometry CameraPose::view() const
{
    return {modelView(), projection(), ground()};
}

std::ostream& operator<<(std::ostream& stream, const CameraPose& pose)
{
    static const char* const lenses[] = {"perspective", "off-axis", "orthographic"};
    return stream << lenses[pose.lens] << (pose.globe ? " on the globe at " : " at ") << pose.x << ", "
                  << pose.y << ", height " << pose.height << ", heading " << pose.heading << ", pitch "
                  << pose.pitch << ", roll " << pose.roll << ", field of view " << pose.fieldOfView
                  << ", picture " << pose.pictureSize << " m, aspect " << pose.aspect << ", shift "
                  << pose.shiftX << ", " << pose.shiftY << ", ground " << pose.lowestGround << " to "
                  << pose.highestGround;
}

CameraPose randomCommonPose(Random& random)
{
    CameraPose pose;
    pose.globe = random.integer(0, 1) == 1;
    pose.x = pose.globe ? random.uniform(-pi, pi) : random.uniform(-1e6, 1e6);
    pose.y = pose.globe ? random.uniform(-1.5, 1.5) : random.uniform(-1e6, 1e6);
    pose.height = random.logarithmic(2.0, 3e4);
    pose.heading = random.uniform(-pi, pi);
    pose.pitch = -random.uniform(0.0, 1.4);
    pose.lens = static_cast<CameraPose::Lens>(random.integer(0, 2));
    pose.fieldOfView = random.uniform(0.3, 1.8);
    pose.pictureSize = random.logarithmic(100.0, 1e5);
    pose.aspect = random.uniform(0.6, 2.5);
    pose.shiftX = random.uniform(-0.5, 0.5);
    pose.shiftY = random.uniform(-0.5, 0.5);
    if (random.integer(0, 3)) // else unknown
    {
        pose.lowestGround = random.uniform(-400.0, 100.0);
        pose.highestGround = pose.lowestGround + random.logarithmic(50.0, 8500.0);
    }
    return pose;
}

CameraPose randomPose(Random& random)
{
    CameraPose pose = randomCommonPose(random);
    switch (random.integer(0, 9))
    {
    case 0:
        pose.pitch = -pi / 2.0; // straight down
        break;
    case 1:
        pose.pitch = random.uniform(-pi / 2.0, pi / 2.0);
        break;
    case 2:
        pose.pitch = -pi / 2.0 - random.uniform(0.0, 1.0); // beyond straight down
        break;
    default:
        break;
    }
    switch (random.integer(0, 5))
    {
    case 0:
        pose.roll = random.uniform(-pi, pi);
        break;
    case 1:
        pose.roll = random.sign() * pi / 2.0 + random.uniform(-0.3, 0.3);
        break;
    case 2:
        pose.roll = random.uniform(-0.6, 0.6);
        break;
    default:
        break;
    }
    switch (random.integer(0, 9))
    {
    case 0:
        pose.height = -random.logarithmic(1.0, 1000.0);
        break;
    case 1:
        pose.height = random.logarithmic(3e4, 3e5);
        break;
    default:
        break;
    }
    return pose;
}

std::vector<osg::Vec2d> randomCurve(Random& random)
{
    std::vector<osg::Vec2d> points(static_cast<std::size_t>(random.integer(1, 6)));
    std::vector<double> heights;
    for (std::size_t i = 0; i < points.size(); ++i)
        heights.push_back(random.uniform(0.01, 1.0));
    std::sort(heights.begin(), heights.end());
    const double width = 0.98 / static_cast<double>(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const bool level = i > 0 && random.integer(0, 9) == 0;
        points[i].set(0.01 + width * (static_cast<double>(i) + random.uniform(0.05, 0.9)),
                      level ? points[i - 1].y() : heights[i]);
    }
    return points;
}

void randomizeProperties(osgGeoFX::PropertyHolder& effect, Random& random)
{
    std::string refusal;
    for (const Property& property : effect.properties())
    {
        // What does not fit the other properties is refused, and the former value, which does, stays.
        if (property.name != "enabled")
            effect.setProperty(property.name, randomValue(property, random), refusal);
    }
    if (effect.getProperty("planeReference") == osgGeoFX::PerspectiveBend::EYE)
        effect.setProperty("planeHeight", -random.logarithmic(1.0, 1e4), refusal);
    for (const osgGeoFX::PropertyHolder::Part& part : effect.parts())
        randomizeProperties(*part.object, random);
}

osg::ref_ptr<osgGeoFX::Deformation> randomDeformation(const std::string& kind, Random& random)
{
    const osg::ref_ptr<Effect> effect = osgGeoFX::createEffect(kind);
    osg::ref_ptr<osgGeoFX::Deformation> deformation = dynamic_cast<osgGeoFX::Deformation*>(effect.get());
    if (deformation) randomizeProperties(*deformation, random);
    return deformation;
}

osg::ref_ptr<osgGeoFX::Deformation> randomDeformation(Random& random)
{
    static const std::vector<std::string> kinds = deformationKinds();
    return randomDeformation(
        kinds[static_cast<std::size_t>(random.integer(0, static_cast<int>(kinds.size()) - 1))], random);
}

void bringNear(osgGeoFX::Deformation& deformation, const CameraPose& pose, Random& random)
{
    auto* liberty = dynamic_cast<osgGeoFX::RegionalLiberty*>(&deformation);
    if (!liberty) return;
    const double across = random.logarithmic(300.0, 1e5), along = across * random.logarithmic(0.3, 3.0);
    liberty->setRadii(across, along);
    const double away = random.uniform(0.0, 1.3) * across, way = random.uniform(-pi, pi);
    const double east = away * std::sin(way), north = away * std::cos(way);
    if (!pose.globe)
    {
        liberty->setCenter({pose.x + east, pose.y + north});
        return;
    }
    const double radius = wgs84()->getRadiusEquator();
    const double latitude = std::clamp(pose.y + north / radius, -0.499 * pi, 0.499 * pi);
    liberty->setGeodeticCenter(std::remainder(pose.x + east / radius / std::cos(latitude), 2.0 * pi),
                               latitude);
}

std::vector<std::string> deformationKinds()
{
    std::vector<std::string> kinds;
    for (const std::string& kind : osgGeoFX::effectKinds())
    {
        if (osgGeoFX::createEffect(kind)->asDeformation()) kinds.push_back(kind);
    }
    return kinds;
}

std::string describe(osgGeoFX::PropertyHolder& effect)
{
    std::ostringstream text;
    text << osgGeoFX::kindOf(effect);
    for (const Property& property : effect.properties())
    {
        const double value = property.get(effect);
        if (value != property.defaultValue) text << " " << property.name << "=" << property.text(value);
    }
    for (const osgGeoFX::PropertyHolder::Part& part : effect.parts())
        text << " {" << part.name << ": " << describe(*part.object) << "}";
    return text.str();
}

osg::Vec3d randomDirection(Random& random)
{
    const double z = random.uniform(-1.0, 1.0);
    const double turn = random.uniform(-pi, pi);
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

osg::Vec3d randomGroundPoint(Random& random, const osgGeoFX::ViewGeometry& view, double reach)
{
    osg::Vec3d across = view.up ^ randomDirection(random);
    across.normalize();
    const double distance = random.logarithmic(1.0, reach);
    double height = random.uniform(-400.0, 9000.0);
    // What is near is near the ground below the eye.
    if (distance < 1e4) height = std::min(height, 100.0 + 0.9 * distance);
    if (view.ground.ellipsoid)
        height -= distance * distance / (2.0 * view.ground.ellipsoid->getRadiusEquator());
    return across * distance + view.up * (height - view.eyeHeight);
}

bool bendNumbers(const osgGeoFX::DeformationSnapshot& snapshot, BendNumbers& numbers)
{
    std::map<std::string, osg::Vec4d> uniforms;
    for (const auto& [name, value] : snapshot.uniforms())
        uniforms[name] = value;
    if (!uniforms.count("bend")) return false;
    const osg::Vec4d plane = uniforms["plane"];
    const osg::Vec4d forward = uniforms["forward"];
    numbers.normal.set(plane.x(), plane.y(), plane.z());
    numbers.forward.set(forward.x(), forward.y(), forward.z());
    numbers.height = plane.w();
    numbers.start = forward.w();
    numbers.size = uniforms["bend"].x();
    numbers.angle = uniforms["bend"].y();
    return true;
}

bool libertyNumbers(const osgGeoFX::DeformationSnapshot& snapshot, LibertyNumbers& numbers)
{
    std::map<std::string, osg::Vec4d> uniforms;
    for (const auto& [name, value] : snapshot.uniforms())
        uniforms[name] = value;
    if (!uniforms.count("taken")) return false;
    const osg::Vec4d up = uniforms["up"];
    numbers.up.set(up.x(), up.y(), up.z());
    numbers.across = uniforms["across"].w();
    numbers.along = uniforms["along"].w();
    return true;
}

double bendCurvature(const BendNumbers& numbers, int curve)
{
    return osgGeoFX::glsl::geofx_bendCurvature(
        osgGeoFX::glsl::geofx_makeBend(curve, numbers.size, numbers.angle));
}

osg::Vec3d randomPointFor(const osgGeoFX::DeformationSnapshot& snapshot, const osgGeoFX::ViewGeometry& view,
                          Random& random)
{
    BendNumbers numbers;
    if (random.integer(0, 3) == 0 || !bendNumbers(snapshot, numbers)) return randomGroundPoint(random, view);
    const double s = random.uniform(-1.0, 2.0) * std::min(numbers.size, 3e5);
    const double across = random.sign() * random.logarithmic(1.0, 1e5);
    return numbers.point(s, random.uniform(-400.0, 9000.0), across);
}

} // namespace geofx::test
