// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaPose.h>

#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

// Metres above the map's base.
constexpr double lowestEye = 100.0;
constexpr double highestEye = 5e6;
// Where the width does not follow from the eye's height, metres.
constexpr double leastRadius = 25.0;
constexpr double largestRadius = 2e6;
constexpr int mostSteps = 40;
/// Ground is taken hold of up to here, of D2: at the horizon itself a pixel is endless.
constexpr double farthestHold = 0.95;
/// How far up its ground a picture's middle lies at most.
constexpr double highestMiddle = 0.7;
const double lowestPitch = -85.0 * osg::PI / 180.0;
const double defaultPitch = -35.0 * osg::PI / 180.0;

/// The inverse of geofx_panoramaRise, as far as ground is taken hold of.
double distanceOf(const glsl::geofx_Panorama& view, double rise)
{
    double distance = rise;
    if (view.profile.first > 0.0)
        distance = view.horizon * glsl::geofx_profileDistance(view.profile, rise / view.horizon);
    else if (rise > view.curve)
    {
        const double width = std::max(view.horizon - view.curve, 1e-3);
        const double left = std::max(1.0 - 2.0 * (rise - view.curve) / width, 0.0);
        distance = view.curve + width * (1.0 - std::sqrt(left));
    }
    return std::min(distance, farthestHold * view.horizon);
}

/// Where ground of a height, from the base, is first seen so high above the base of the picture, if the scale of heights
/// changes on the way.
double firstAt(const glsl::geofx_Panorama& view, double y, double height)
{
    constexpr int parts = 64;
    const auto seen = [&](double s)
    {
        return view.along * glsl::geofx_panoramaRise(view, s) + glsl::geofx_panoramaLift(view, s) * height;
    };
    const double farthest = farthestHold * view.horizon;
    const double before = view.along * glsl::geofx_panoramaSlope(view, 0.0);
    double near = std::min((y - seen(0.0)) / before, 0.0), far = near;
    for (int part = 1; part <= parts && seen(far) < y; ++part)
    {
        near = far;
        far = farthest * part / parts;
    }
    if (seen(far) < y) return farthest;
    for (int step = 0; step < 60; ++step)
    {
        const double middle = 0.5 * (near + far);
        (seen(middle) < y ? near : far) = middle;
    }
    return far;
}

/// x and s of what appears at a point of the picture and has a height.
glm::dvec2 placeOn(const glsl::geofx_Panorama& view, const osg::Vec2d& picture, double height)
{
    const double above = picture.y() + 1.0 + glsl::geofx_panoramaArch(view, picture.x());
    const double across = picture.x() / view.across;
    if (view.liftGrowth != 0.0 || view.cylinder.ring > 0.0)
        return {across, firstAt(view, above, height - view.base)};
    const double y = above - view.lift * (height - view.base);
    return {across, distanceOf(view, y / view.along)};
}

/// Above or below `place`, as high as `other` is.
osg::Vec3d atHeightOf(const osg::EllipsoidModel& globe, const osg::Vec3d& place, const osg::Vec3d& other)
{
    double latitude = 0.0, longitude = 0.0, height = 0.0, own = 0.0;
    globe.convertXYZToLatLongHeight(other.x(), other.y(), other.z(), latitude, longitude, height);
    globe.convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude, own);
    osg::Vec3d result;
    globe.convertLatLongHeightToXYZ(latitude, longitude, height, result.x(), result.y(), result.z());
    return result;
}

} // namespace

PanoramaPose::PanoramaPose(EffectScene& scene, PanoramaMap& map)
    : _scene(&scene), _map(&map), _ground(scene.ground()),
      _projection(osg::Matrixd::perspective(30.0, 1.6, 1.0, 1e6)), _pitch(defaultPitch)
{
}

/// East, north and up at the eye, and the eye.
osg::Matrixd PanoramaPose::frame() const
{
    osg::Matrixd result = osg::Matrixd::translate(_eye);
    if (_ground.ellipsoid)
        _ground.ellipsoid->computeLocalToWorldTransformFromXYZ(_eye.x(), _eye.y(), _eye.z(), result);
    return result;
}

osg::Vec3d PanoramaPose::up() const
{
    return osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), frame());
}

osg::Matrixd PanoramaPose::matrix() const
{
    const osg::Matrixd local = frame();
    const osg::Vec3d right(std::cos(_heading), -std::sin(_heading), 0.0);
    const osg::Vec3d forward(std::sin(_heading) * std::cos(_pitch), std::cos(_heading) * std::cos(_pitch),
                             std::sin(_pitch));
    const osg::Vec3d rows[] = {right, right ^ forward, -forward};
    osg::Matrixd result = osg::Matrixd::translate(_eye);
    for (int row = 0; row < 3; ++row)
    {
        const osg::Vec3d axis = osg::Matrixd::transform3x3(rows[row], local);
        for (int column = 0; column < 3; ++column)
            result(row, column) = axis[column];
    }
    return result;
}

void PanoramaPose::setMatrix(const osg::Matrixd& matrix)
{
    _eye = matrix.getTrans();
    const osg::Matrixd toLocal = osg::Matrixd::inverse(frame());
    const auto axis = [&](int row)
    {
        return osg::Matrixd::transform3x3(osg::Vec3d(matrix(row, 0), matrix(row, 1), matrix(row, 2)),
                                          toLocal);
    };
    const osg::Vec3d right = axis(0);
    osg::Vec3d forward = -axis(2);
    forward.normalize();
    _heading = std::atan2(-right.y(), right.x());
    setPitch(std::asin(std::clamp(forward.z(), -1.0, 1.0)));
    setRadius(radius());
}

void PanoramaPose::setPitch(double radians)
{
    _pitch = std::clamp(radians, lowestPitch, 0.0);
}

std::optional<glsl::geofx_Panorama> PanoramaPose::panorama() const
{
    return panoramaOf(*_map, ViewGeometry(toEye(), _projection, _ground));
}

double PanoramaPose::radius() const
{
    const auto view = panorama();
    return view ? 1.0 / view->across : leastRadius;
}

void PanoramaPose::setRadius(double metres)
{
    const bool perspective = _projection(3, 3) == 0.0;
    if (!perspective || _map->getViewRadius() > 0.0)
    {
        // A projection's own width stays until somebody zooms.
        if (metres != radius()) _map->setViewRadius(std::clamp(metres, leastRadius, largestRadius));
        return;
    }
    const auto view = panorama();
    if (!view) return;
    const double height = std::clamp(metres * std::abs(_projection(0, 0)), lowestEye, highestEye);
    _eye += up() * (view->base + height - view->globe.height);
}

osg::Vec2d PanoramaPose::middle() const
{
    return {0.0, std::min(0.0, 2.0 * highestMiddle * _map->getHorizonLine() - 1.0)};
}

PanoramaHold PanoramaPose::holdOnBase(const osg::Vec2d& picture) const
{
    const auto view = panorama();
    if (!view) return {_eye, picture};
    const glm::dvec3 place(placeOn(*view, picture, view->base), view->base);
    const glm::dvec3 shown = glsl::geofx_panoramaPicture(*view, place);
    return {toOsg(glsl::geofx_panoramaPosition(*view, place)) * matrix(), {shown.x, shown.y}};
}

/// What the camera shows there, as it is before the map deforms it.
std::optional<osg::Vec3d> PanoramaPose::pick(const osg::Vec2d& picture, const osg::Camera& camera) const
{
    const osg::Viewport* port = camera.getViewport();
    if (!port) return std::nullopt;
    const DeformedView shown(*_scene, camera);
    const auto hit =
        shown.pick((picture.x() + 1.0) / 2.0 * port->width(), (picture.y() + 1.0) / 2.0 * port->height());
    if (!hit) return std::nullopt;
    if (!_map->isActive() || !_map->getProjection()) return hit->world;
    const osg::Matrixd& view = camera.getViewMatrix();
    const auto panorama = panoramaOf(*_map, ViewGeometry(view, camera.getProjectionMatrix(), _ground));
    if (!panorama) return std::nullopt;
    const osg::ref_ptr<const PanoramaSnapshot> map = new PanoramaSnapshot(*panorama, 1.0);
    return map->undeform(shown.deform(hit->world) * view) * osg::Matrixd::inverse(view);
}

PanoramaHold PanoramaPose::holdSeen(const osg::Vec2d& picture, const osg::Camera& camera) const
{
    const auto view = panorama();
    const auto world = view ? pick(picture, camera) : std::nullopt;
    if (!world) return holdOnBase(picture);
    const glm::dvec3 place = glsl::geofx_panoramaPlace(*view, toGlm(*world * toEye()));
    // What stands beyond the horizon moves with the ground before it.
    if (place.y > farthestHold * view->horizon) return holdOnBase(picture);
    const glm::dvec3 shown = glsl::geofx_panoramaPicture(*view, place);
    return {*world, {shown.x, shown.y}};
}

/// Where the eye is after a step, at the same height.
osg::Vec3d PanoramaPose::moved(const osg::Vec3d& step) const
{
    const osg::Vec3d there = _eye + step;
    return _ground.ellipsoid ? atHeightOf(*_ground.ellipsoid, there, _eye) : there;
}

/// By Newton's method, with derivatives from two small steps: on a globe the way to north changes with the eye, too.
bool PanoramaPose::keep(const PanoramaHold& hold)
{
    if (isCylindrical()) return keepAround(hold);
    const osg::Vec3d former = _eye;
    const auto first = panorama();
    if (!first) return false;
    const auto placeFrom = [&](const osg::Vec3d& step)
    {
        const osg::Vec3d eye = _eye;
        _eye = moved(step);
        const auto view = panorama();
        const glm::dvec3 place =
            view ? glsl::geofx_panoramaPlace(*view, toGlm(hold.world * toEye())) : glm::dvec3(std::nan(""));
        _eye = eye;
        return place;
    };
    const glm::dvec2 target = placeOn(*first, hold.picture, placeFrom({}).z);
    const double scale = 1.0 / first->across;
    const double small = 1e-3 * scale;
    const double longest = _ground.ellipsoid ? 0.3 * _ground.ellipsoid->getRadiusEquator() : 1e30;
    for (int i = 0; i < mostSteps; ++i)
    {
        const glm::dvec2 place(placeFrom({}));
        const glm::dvec2 error = target - place;
        if (!std::isfinite(error.x + error.y)) break;
        if (std::hypot(error.x, error.y) < 1e-7 * scale) return true;
        const osg::Matrixd pose = matrix();
        const osg::Vec3d right(pose(0, 0), pose(0, 1), pose(0, 2));
        const osg::Vec3d forward = up() ^ right;
        const glm::dvec2 byRight = (glm::dvec2(placeFrom(right * small)) - place) / small;
        const glm::dvec2 byForward = (glm::dvec2(placeFrom(forward * small)) - place) / small;
        const double area = byRight.x * byForward.y - byRight.y * byForward.x;
        osg::Vec3d step = right * ((error.x * byForward.y - error.y * byForward.x) / area) +
                          forward * ((error.y * byRight.x - error.x * byRight.y) / area);
        if (step.length() > longest) step *= longest / step.length();
        _eye = moved(step);
    }
    _eye = former;
    return false;
}

bool PanoramaPose::keepAround(const PanoramaHold& hold)
{
    const osg::Vec3d formerEye = _eye;
    const double formerHeading = _heading;
    for (int i = 0; i < mostSteps; ++i)
    {
        const auto view = panorama();
        if (!view) break;
        const osg::Vec3d seen = hold.world * toEye();
        const glm::dvec3 place = glsl::geofx_panoramaPlace(*view, toGlm(seen));
        const glm::dvec2 target = placeOn(*view, hold.picture, place.z);
        const double turn = (place.x - target.x) / view->cylinder.ring;
        const double way = place.y - target.y;
        const double scale = 1.0 / view->across;
        if (!std::isfinite(turn + way)) break;
        if (std::abs(way) < 1e-7 * scale && std::abs(turn) < 1e-9) return true;
        osg::Vec3d towards = hold.world - _eye;
        towards -= up() * (towards * up());
        // Right above the place any way leads away from it.
        if (!(towards.normalize() > 1e-6 * scale))
        {
            const osg::Matrixd pose = matrix();
            towards = up() ^ osg::Vec3d(pose(0, 0), pose(0, 1), pose(0, 2));
        }
        _heading += turn;
        _eye = moved(towards * std::clamp(way, -4.0 * scale, 4.0 * scale));
    }
    _eye = formerEye;
    _heading = formerHeading;
    return false;
}

bool PanoramaPose::setCenter(const osg::Vec3d& world)
{
    const osg::Vec3d former = _eye;
    const double heading = _heading;
    if (isCylindrical())
    {
        // From where it looks at the place, at any distance; the heading stays.
        const auto view = panorama();
        if (!view) return false;
        const osg::Matrixd pose = matrix();
        const osg::Vec3d forward = up() ^ osg::Vec3d(pose(0, 0), pose(0, 1), pose(0, 2));
        _eye = world;
        _eye = moved(forward * -(view->cylinder.ring + 0.5 * view->horizon));
        if (_ground.ellipsoid)
            _eye = atHeightOf(*_ground.ellipsoid, _eye, former);
        else
            _eye.z() = former.z();
        if (keep({world, middle()})) return true;
        _eye = former;
        _heading = heading;
        return false;
    }
    // From above the place it is never far.
    _eye = _ground.ellipsoid ? atHeightOf(*_ground.ellipsoid, world, _eye)
                             : osg::Vec3d(world.x(), world.y(), _eye.z());
    if (keep({world, middle()})) return true;
    _eye = former;
    return false;
}

} // namespace osgGeoFX
