// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>

#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/effect/detail/GlobeFrame.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/CylinderBounds.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double leastRadius = 1e-3;
/// The border of the picture, of its half width and height, with room for rounding.
constexpr double beside = 1.0 + 1e-4;
/// The distance where the ground falls away behind the Earth, of its radius.
constexpr double mostTurned = 1.3;
/// The largest growth of x and s there: 20 for what lies behind, and the rest for the projection, which goes on.
constexpr double stretchBehind = 30.0;
/// The least distance from the Earth's center, of its radius. Verticals meet there, and are followed no deeper.
constexpr double leastDepth = 0.1;
/// Without any exaggeration the picture would not tell heights.
constexpr double leastExaggeration = 1e-6;
/// Room beside the part of a cylindrical map that a camera draws, of the map's angle; and the largest half of such a part.
constexpr double roomBeside = 0.01;
const double largestHalf = 0.95 * osg::PI;
/// The least distance of seen ground from the eye, of that of the picture's base.
constexpr double leastDistance = 1e-6;

osg::Vec4d vec4(const glm::dvec3& vector, double w)
{
    return {vector.x, vector.y, vector.z, w};
}

/// Sets the lines of the picture for geofx_panoramaEye. They begin in the plane of the eye.
void setRays(glsl::geofx_Panorama& panorama, const ViewGeometry& view)
{
    const auto line = [&](double x, double y, glm::dvec3& origin, glm::dvec3& direction)
    {
        osg::Vec3d from, along;
        view.ray(x, y, from, along);
        along /= -along.z();
        from += along * from.z();
        origin = toGlm(from);
        direction = toGlm(along);
    };
    line(0.0, 0.0, panorama.origin, panorama.direction);
    line(1.0, 0.0, panorama.originX, panorama.directionX);
    line(0.0, 1.0, panorama.originY, panorama.directionY);
    panorama.originX -= panorama.origin;
    panorama.originY -= panorama.origin;
    panorama.directionX -= panorama.direction;
    panorama.directionY -= panorama.direction;
}

/// The circle that is the base of a cylindrical map, and the part of the map that the camera draws.
glsl::geofx_Cylinder cylinderOf(const PanoramaMap& map, const ViewGeometry& view, double radius)
{
    glsl::geofx_Cylinder cylinder{};
    const double angle = map.getHorizontalAngle();
    if (!(angle > 0.0) || !map.getProjection()) return cylinder;
    osg::Vec2d low, high;
    view.picturePart(low, high);
    cylinder.ring = 2.0 * radius / angle;
    cylinder.middle = 0.25 * angle * (low.x() + high.x());
    cylinder.halfArc = std::min(0.25 * angle * (high.x() - low.x()) + roomBeside * angle, largestHalf);
    return cylinder;
}

bool finite(const glsl::geofx_Panorama& panorama)
{
    double sum = 0.0;
    for (const double each :
         {panorama.across, panorama.along, panorama.lift, panorama.base, panorama.end, panorama.nearest,
          panorama.globe.height, panorama.cylinder.ring, panorama.liftGrowth})
        sum += std::abs(each);
    for (const glm::dvec3& each : {panorama.right, panorama.forward, panorama.origin, panorama.originX,
                                   panorama.originY, panorama.direction, panorama.directionX,
                                   panorama.directionY, panorama.globe.up, panorama.globe.axis})
        sum += std::abs(each.x) + std::abs(each.y) + std::abs(each.z);
    return sum < 1e12;
}

} // namespace

std::optional<glsl::geofx_Panorama> panoramaOf(const PanoramaMap& map, const ViewGeometry& view)
{
    glsl::geofx_Panorama panorama{};
    panorama.globe.up = toGlm(view.up);
    panorama.globe.axis = toGlm(view.polarAxis);
    panorama.globe.height = view.eyeHeight;
    if (view.ground.ellipsoid) setGlobe(panorama.globe, *view.ground.ellipsoid, view.up * view.polarAxis);
    osg::Vec3d right = osg::Vec3d(1.0, 0.0, 0.0) - view.up * view.up.x();
    if (!(right.normalize() > 1e-6)) return std::nullopt;
    panorama.right = toGlm(right);
    panorama.forward = toGlm(view.up ^ right);

    panorama.base = map.getBaseHeight();
    if (map.getBaseFromTerrain() && view.ground.heightsKnown)
        panorama.base = std::max(panorama.base, view.ground.minHeight);
    const bool perspective = view.projection(3, 3) == 0.0;
    const double wide = std::abs(view.projection(0, 0));
    const double high = std::abs(view.projection(1, 1));
    double radius = map.getViewRadius();
    if (radius == 0.0)
        radius = perspective ? std::max(view.eyeHeight - panorama.base, 1.0) / wide : 1.0 / wide;
    radius = std::max(radius, leastRadius);

    panorama.across = 1.0 / radius;
    panorama.curve = map.getCurveDistance() * radius;
    panorama.horizon = map.getHorizonDistance() * radius;
    panorama.end = endOfHeights * panorama.horizon;
    panorama.profile = profileThrough(map.getCurvePoints());
    panorama.along = panorama.profile.first > 0.0
                         ? 2.0 * map.getHorizonLine() / panorama.horizon
                         : 4.0 * map.getHorizonLine() / (panorama.curve + panorama.horizon);
    panorama.lift = std::max(map.getExaggeration(), leastExaggeration) * high / wide / radius;
    if (map.getHorizonExaggeration() >= 0.0)
        panorama.liftGrowth =
            std::max(map.getHorizonExaggeration(), leastExaggeration) * high / wide / radius - panorama.lift;
    panorama.arch = 2.0 * map.getHorizonBend();
    panorama.nearest = radius * (perspective ? wide : 1.0);
    setRays(panorama, view);
    panorama.cylinder = cylinderOf(map, view, radius);
    panorama.plain = 1.0 - shareOf(map.getStrength());
    if (!finite(panorama)) return std::nullopt;
    return panorama;
}

PanoramaSnapshot::PanoramaSnapshot(const glsl::geofx_Panorama& view, double viewDistance)
    : _view(view), _viewDistance(viewDistance)
{
}

PanoramaSnapshot::~PanoramaSnapshot() = default;

osg::Vec3d PanoramaSnapshot::deform(const osg::Vec3d& position) const
{
    return toOsg(glsl::geofx_panoramaDeform(_view, toGlm(position)));
}

osg::Vec3d PanoramaSnapshot::undeform(const osg::Vec3d& position) const
{
    if (_view.plain > 0.0) return undeformMixed(position);
    // Nothing is seen at the eye or behind it.
    osg::Vec3d before = position;
    before.z() = std::min(before.z(), _view.origin.z - leastDistance * _view.nearest);
    return toOsg(glsl::geofx_panoramaUndeform(_view, toGlm(before)));
}

/// By Newton's method. Between the map and the camera's own perspective the shares change in small steps, so that each
/// solution is near the next. Far from what either shows, two places may be drawn at one: then the one that the map shows is
/// meant, and else the one from the nearer end.
osg::Vec3d PanoramaSnapshot::undeformMixed(const osg::Vec3d& position) const
{
    const double small = 1e-9 * std::max(position.length(), 1.0);
    glsl::geofx_Panorama whole = _view;
    whole.plain = 0.0;
    const osg::ref_ptr<const PanoramaSnapshot> map = new PanoramaSnapshot(whole, _viewDistance);
    const double nearer = _view.plain < 0.5 ? 0.0 : 1.0;
    osg::Vec3d best;
    double least = HUGE_VAL;
    for (const double from : {nearer, 1.0 - nearer})
    {
        osg::Vec3d found = from == 1.0 ? position : map->undeform(position);
        const double error = follow(position, from, found);
        const glm::dvec3 place = glsl::geofx_panoramaPlace(_view, toGlm(found));
        const glm::dvec3 picture = glsl::geofx_panoramaPicture(_view, place);
        const bool shown = std::abs(picture.x) <= beside && std::abs(picture.y) <= beside && place.y >= 0.0 &&
                           place.y <= _view.horizon;
        if (error < small && shown) return found;
        if (!(error < least) || least < small) continue;
        best = found;
        least = error;
    }
    return best;
}

/// Changes `found`, which lies at a position with the plain share `from`, to what lies there with the view's own. Returns how
/// far it misses.
double PanoramaSnapshot::follow(const osg::Vec3d& position, double from, osg::Vec3d& found) const
{
    constexpr int shares = 16;
    constexpr int steps = 8;
    constexpr int lastSteps = 40;
    const double scale = std::max(position.length(), 1.0);
    glsl::geofx_Panorama view = _view;
    const auto missed = [&](const osg::Vec3d& at)
    {
        return position - toOsg(glsl::geofx_panoramaDeform(view, toGlm(at)));
    };
    osg::Vec3d error;
    for (int share = 1; share <= shares; ++share)
    {
        view.plain = from + (_view.plain - from) * share / shares;
        error = missed(found);
        for (int step = 0; step < (share < shares ? steps : lastSteps); ++step)
        {
            if (error.length() < 1e-12 * scale) break;
            const double small = 1e-6 * std::max(found.length(), scale);
            osg::Vec3d columns[3];
            for (int axis = 0; axis < 3; ++axis)
            {
                osg::Vec3d before = found, after = found;
                before[axis] -= small;
                after[axis] += small;
                columns[axis] = (missed(before) - missed(after)) / (2.0 * small);
            }
            const osg::Vec3d normal = columns[1] ^ columns[2];
            const double volume = columns[0] * normal;
            if (!(std::abs(volume) > 0.0)) break;
            osg::Vec3d move(error * normal / volume, error * (columns[2] ^ columns[0]) / volume,
                            error * (columns[0] ^ columns[1]) / volume);
            // A step too far is halved.
            osg::Vec3d left = missed(found + move);
            for (int half = 0; half < 20 && !(left.length2() < error.length2()); ++half)
            {
                move *= 0.5;
                left = missed(found + move);
            }
            if (!(left.length2() < error.length2())) break;
            found += move;
            error = left;
        }
    }
    return error.length();
}

/// What bounds need of a ball: its place, and the largest change of the place over a metre within it.
struct PanoramaSnapshot::Extent
{
    explicit Extent(const CylinderBounds& bounds) : cylinder(bounds) {}

    CylinderBounds cylinder;
    glm::dvec3 place;  ///< of the middle
    double away;       ///< of the middle from the eye's foot, metres
    double reach;      ///< of x and s on the ground, metres: the radius, stretched
    double stretch;    ///< of x and s for each metre
    double curvature;  ///< of x, s and height: second derivatives, 1/metre
    double height;     ///< above or below the base at most
    double slope;      ///< of the curve, at most
    double slopeRate;  ///< its derivative, 1/metre
    double fadeRate;   ///< of heights and of x beyond the horizon, 1/metre
    double fadeSecond; ///< 1/metre²
    double lift;       ///< of the picture's y for each metre of height, at most
    double liftRate;   ///< its derivative by s, faded heights included, 1/metre²
    double liftSecond; ///< 1/metre³
    double x;          ///< of the picture, at most
    double n;          ///< at most
    double nSecond;    ///< of n by s, 1/metre
    double turned;     ///< share of the ground's radius that the ball reaches to from the eye
};

PanoramaSnapshot::Extent PanoramaSnapshot::extentOf(const Ball& ball) const
{
    const glm::dvec3 ground = glsl::geofx_panoramaGround(_view, toGlm(ball.center));
    const double k = _view.globe.curvature;
    const double tallest = std::abs(ground.z) + ball.radius;
    // The angle of arc that the ball reaches. The equidistant projection stretches by this angle over its sine.
    const double arc = k * (std::hypot(ground.x, ground.y) + ball.radius);
    const double turned = k * (glm::length(toGlm(ball.center)) + ball.radius);
    double stretch = 1.0 + 0.5 * arc * arc;
    // Points deep below the ground are nearer to each other than their feet.
    const double deepest = std::min(ground.z - ball.radius, 0.0);
    stretch /= std::max(1.0 + k * deepest, leastDepth);
    if (turned > mostTurned) stretch = std::max(stretch, stretchBehind);
    const double reach = ball.radius * stretch;
    Extent extent(CylinderBounds(_view.cylinder, glm::dvec2(ground), reach));
    extent.place = glsl::geofx_panoramaPlace(_view, toGlm(ball.center));
    extent.turned = turned;
    extent.stretch = stretch;
    extent.reach = reach;
    extent.curvature = 2.1 * (4.0 * k + 3.0 * k * k * tallest) * stretch;
    extent.away = std::hypot(ground.x, ground.y);
    extent.height = std::abs(extent.place.z - _view.base) + ball.radius;
    const double nearS = extent.place.y - extent.reach;
    const double farS = extent.place.y + extent.reach;
    const double width = std::max(_view.horizon - _view.curve, 1e-3);
    extent.slope = std::clamp((_view.horizon - nearS) / width, 0.0, 1.0);
    extent.slopeRate = nearS < _view.horizon && farS > _view.curve ? 1.0 / width : 0.0;
    if (_view.profile.first > 0.0)
    {
        const ProfileRates rates = ratesOf(_view.profile, nearS / _view.horizon, farS / _view.horizon);
        extent.slope = rates.slope;
        extent.slopeRate = rates.second / _view.horizon;
    }
    const double fading = _view.end - _view.horizon;
    const bool fades = nearS < _view.end + fading && farS > _view.horizon;
    extent.fadeRate = fades ? 1.5 / fading : 0.0;
    extent.fadeSecond = fades ? 6.0 / (fading * fading) : 0.0;
    // Heights fade only where their scale no longer changes. Around a cylinder they shrink everywhere.
    const double bare =
        std::max(std::abs(glsl::geofx_profileLift(_view.lift, _view.liftGrowth, nearS / _view.horizon)),
                 std::abs(glsl::geofx_profileLift(_view.lift, _view.liftGrowth, farS / _view.horizon)));
    const bool grows = nearS < _view.horizon && farS > 0.0;
    const double growth = grows ? std::abs(_view.liftGrowth) / _view.horizon : 0.0;
    const double rate = std::max(1.5 * growth, bare * extent.fadeRate);
    const double second = std::max(6.0 * growth / _view.horizon, bare * extent.fadeSecond);
    const CylinderBounds& cylinder = extent.cylinder;
    extent.lift = bare * cylinder.width;
    extent.liftRate = rate * cylinder.width + bare * cylinder.widthRate;
    extent.liftSecond =
        second * cylinder.width + 2.0 * rate * cylinder.widthRate + bare * cylinder.widthSecond;
    // What is kept out of a cylinder's picture goes back to the middle of the part that is drawn.
    extent.x = _view.across * std::max(std::abs(extent.place.x) + cylinder.sideReach,
                                       std::abs(_view.cylinder.ring * _view.cylinder.middle));
    extent.n = _view.nearest + std::max(farS, 0.0);
    extent.nSecond = nearS < 0.0 ? 2.0 / _view.nearest : 0.0;
    return extent;
}

/// The largest factor by which a distance grows in the camera's own perspective. Turning over at a curved surface stretches.
double PanoramaSnapshot::ownStretch(const Extent& extent) const
{
    if (!(_view.mirrored > 0.0)) return 1.0;
    return 1.0 + 2.0 * _view.globe.curvature * (extent.height + std::abs(_view.base - _view.water));
}

double PanoramaSnapshot::lipschitz(const Ball& ball) const
{
    const Extent extent = extentOf(ball);
    const CylinderBounds& cylinder = extent.cylinder;
    const double x = (_view.across * cylinder.sideStretch + extent.x * extent.fadeRate) * extent.stretch;
    const double arch = _view.arch * 1.5708 * x;
    const double bySide =
        _view.along * extent.slope * extent.stretch + extent.liftRate * extent.height * extent.stretch;
    const double y = std::hypot(bySide, extent.lift) + arch;
    const double reachY = std::abs(glsl::geofx_panoramaPicture(_view, extent.place).y) + y * ball.radius;
    const double acrossEye = x * (glm::length(_view.originX) + extent.n * glm::length(_view.directionX));
    const double upEye = y * (glm::length(_view.originY) + extent.n * glm::length(_view.directionY));
    const double awayEye = extent.stretch * (1.0 + extent.n * cylinder.shownRate) *
                           (glm::length(_view.direction) + extent.x * glm::length(_view.directionX) +
                            reachY * glm::length(_view.directionY));
    const double map = std::hypot(acrossEye, upEye) + awayEye;
    return std::max(1.0, _view.plain * ownStretch(extent) + (1.0 - _view.plain) * map);
}

DeformationSnapshot::Sag PanoramaSnapshot::sag(const Ball& ball, const osg::Vec3d& edge) const
{
    const Extent extent = extentOf(ball);
    const double length = edge.length();
    const CylinderBounds& cylinder = extent.cylinder;
    if (cylinder.leavesPicture) return {0.0, 2.0 * lipschitz(ball) * length};
    const bool round = _view.cylinder.ring > 0.0;
    const double up = edge * toOsg(_view.globe.up);
    // A flat edge changes its height little: by its slope below the eye, and by the ground's curve.
    const double turned = _view.globe.curvature * (extent.away + extent.reach);
    const double rise = std::min(length, std::abs(up) + 1.1 * turned * length);
    // On a cylinder, an edge may lead anywhere.
    const double side =
        round ? length * extent.stretch * cylinder.sideStretch
              : std::min(1.0, std::abs(edge * toOsg(_view.right)) / std::max(length, 1e-30) + 1.1 * turned) *
                    length * extent.stretch;
    const double ahead =
        round
            ? length * extent.stretch
            : std::min(1.0, std::abs(edge * toOsg(_view.forward)) / std::max(length, 1e-30) + 1.1 * turned) *
                  length * extent.stretch;
    const double way2 = extent.stretch * extent.stretch * length * length;
    const double ground =
        extent.curvature * length * length; // the second derivative of x and s on the ground
    const double second = ground + cylinder.curvature * way2;
    const double sideSecond = cylinder.sideStretch * ground + cylinder.sideCurvature * way2;

    const double x1 = _view.across * side + extent.x * extent.fadeRate * ahead;
    const double x2 = _view.across * (sideSecond + 2.0 * side * extent.fadeRate * ahead) +
                      extent.x * (extent.fadeSecond * ahead * ahead + extent.fadeRate * second);
    const double y1 = _view.along * extent.slope * ahead + extent.liftRate * extent.height * ahead +
                      extent.lift * rise + _view.arch * 1.5708 * x1;
    const double y2 = _view.along * (extent.slopeRate * ahead * ahead + extent.slope * second) +
                      extent.liftSecond * ahead * ahead * extent.height +
                      extent.liftRate * (second * extent.height + 2.0 * ahead * rise) + extent.lift * second +
                      _view.arch * (2.4675 * x1 * x1 + 1.5708 * x2);
    const double n1 = ahead;
    const double n2 = extent.nSecond * ahead * ahead + second;

    const double reachY = std::abs(glsl::geofx_panoramaPicture(_view, extent.place).y) + y1;
    const double sideX = glm::length(_view.originX) + extent.n * glm::length(_view.directionX);
    const double sideY = glm::length(_view.originY) + extent.n * glm::length(_view.directionY);
    const double away = glm::length(_view.direction) + extent.x * glm::length(_view.directionX) +
                        reachY * glm::length(_view.directionY);
    const double own = _view.plain * _view.mirrored * 2.0 * extent.curvature * length * length;
    const double map = 1.0 - _view.plain;
    const double curve =
        own + map * (x2 * sideX + y2 * sideY + n2 * away +
                     2.0 * n1 * (x1 * glm::length(_view.directionX) + y1 * glm::length(_view.directionY)));
    // Where the ground falls away behind the Earth, the projection has a kink.
    if (extent.turned > mostTurned) return {curve, lipschitz(ball) * length};
    // The error is nowhere larger than the ball's size in the picture.
    const double nearS = extent.place.y - extent.reach;
    const double farS = extent.place.y + extent.reach;
    const double apartX = farS > _view.end ? 2.0 * extent.x : 2.0 * _view.across * cylinder.sideReach;
    const double apartY =
        _view.along * (glsl::geofx_panoramaRise(_view, farS) - glsl::geofx_panoramaRise(_view, nearS)) +
        2.0 * extent.lift * (round || farS > _view.horizon ? extent.height : ball.radius * extent.stretch) +
        std::abs(glsl::geofx_panoramaLift(_view, farS) - glsl::geofx_panoramaLift(_view, nearS)) *
            extent.height +
        _view.arch * 1.5708 * apartX;
    const double apartN = 2.0 * extent.reach;
    const double mostY = std::abs(glsl::geofx_panoramaPicture(_view, extent.place).y) + apartY;
    const double most = apartX * sideX + apartY * sideY +
                        apartN * (glm::length(_view.direction) + extent.x * glm::length(_view.directionX) +
                                  mostY * glm::length(_view.directionY));
    return {curve, map * extent.lift * cylinder.widthKink * extent.height * ahead * sideY, own + map * most};
}

osg::ref_ptr<const PanoramaSnapshot> PanoramaSnapshot::mirrored(double level, double detail) const
{
    glsl::geofx_Panorama view = _view;
    view.lift = -view.lift;
    view.liftGrowth = -view.liftGrowth;
    view.base = 2.0 * level - view.base;
    view.mirrored = 1.0;
    view.water = level;
    return new PanoramaSnapshot(view, _viewDistance / detail);
}

double PanoramaSnapshot::longestEdge(const Ball& ball, double tolerance) const
{
    const Extent extent = extentOf(ball);
    if (extent.place.y - extent.reach > _view.end) return HUGE_VAL;
    // The second derivative of the picture's y: that of the curve, that of the scale of heights, and that of Eq. 1.
    const double growth = extent.place.y - extent.reach < _view.horizon && extent.place.y + extent.reach > 0.0
                              ? 6.0 * std::abs(_view.liftGrowth) / (_view.horizon * _view.horizon)
                              : 0.0;
    const double second = _view.along * extent.slopeRate + growth * extent.height +
                          std::abs(_view.arch) * 2.4675 * _view.across * _view.across;
    const double flat = std::sqrt(8.0 * tolerance * _viewDistance * _view.along / std::max(second, 1e-30));
    if (!(_view.cylinder.ring > 0.0)) return flat;
    const CylinderBounds& cylinder = extent.cylinder;
    const double least = 8.0 * tolerance * _viewDistance;
    return std::min({flat, std::sqrt(least / cylinder.sideCurvature),
                     std::sqrt(least / std::max(extent.slope * cylinder.curvature, 1e-30))});
}

bool PanoramaSnapshot::isAroundTheEarth(const Ball& ball, const osg::Vec2d& room) const
{
    const double k = _view.globe.curvature;
    if (!(k > 0.0)) return false;
    const glm::dvec3 center = -(_view.globe.height + 1.0 / k) * _view.globe.up;
    const glm::dvec3 away = toGlm(ball.center) - center;
    const double distance = glm::length(away);
    if (ball.radius >= distance) return false;
    // Verticals of the ellipsoid miss the center by a little. The projection is equidistant, so an arc is a distance.
    constexpr double flat = 0.02;
    const double angle = std::acos(std::clamp(glm::dot(away, _view.globe.up) / distance, -1.0, 1.0));
    const double least = angle - (1.0 + flat) * std::asin(ball.radius / distance) - flat * angle;
    // What stands before the base may rise into the picture, by its height above the base.
    constexpr double bulge = 22e3; // of the equator above the poles
    const double height = std::abs(distance - 1.0 / k) + ball.radius + std::abs(_view.base) + bulge;
    const double before =
        (std::abs(_view.lift) * height + room.y()) / (_view.along * glsl::geofx_panoramaSlope(_view, 0.0));
    const double along = std::max(faded(), before) + _view.cylinder.ring;
    const double shown = std::hypot((beside + room.x()) / _view.across, along) * k * (1.0 + flat);
    // Nearer, what is beside the picture and what is behind it count each for itself: a triangle may reach from one to the other.
    const double promised = osg::PI / 3.0;
    return least > std::max(shown, promised);
}

double PanoramaSnapshot::faded() const
{
    return 2.0 * _view.end - _view.horizon;
}

bool PanoramaSnapshot::isBeyond(const osg::Vec3d& position) const
{
    if (isAroundTheEarth({position, 0.0}, {})) return true;
    return !(_view.plain > 0.0) && glsl::geofx_panoramaPlace(_view, toGlm(position)).y > faded();
}

bool PanoramaSnapshot::hides(const Ball& ball, const osg::Vec2d& room) const
{
    if (isAroundTheEarth(ball, room)) return true;
    // What the map's picture leaves out may be in the camera's.
    if (_view.plain > 0.0) return false;
    const Extent extent = extentOf(ball);
    const double nearS = extent.place.y - extent.reach;
    const double farS = extent.place.y + extent.reach;
    if (nearS > faded()) return true;
    // A ball with known x and s is beside or below the picture as its ground is. Its bounds in eye space may not tell
    // this, since everything is stretched there.
    if (extent.turned > mostTurned || farS > _view.end) return false;
    if (_view.cylinder.ring > 0.0)
    {
        const double way = _view.cylinder.ring * (extent.cylinder.turned - _view.cylinder.halfArc);
        if (extent.cylinder.belowEye || _view.across * way > room.x()) return true;
    }
    else if (_view.across * (std::abs(extent.place.x) - extent.reach) > beside + room.x())
        return true;
    return farS < 0.0 &&
           _view.along * glsl::geofx_panoramaRise(_view, farS) + std::abs(_view.lift) * extent.height <
               1.0 - beside - room.y();
}

bool PanoramaSnapshot::isAside(const Ball& ball) const
{
    if (_view.plain > 0.0 || _view.cylinder.ring > 0.0 || !(glm::length(_view.directionX) > 1e-4))
        return false;
    const Extent extent = extentOf(ball);
    // The GPU computes in single precision.
    constexpr double room = 1.02;
    return !(extent.turned > mostTurned) &&
           std::abs(extent.place.x) - extent.reach > room * glsl::geofx_panoramaAside(_view);
}

bool PanoramaSnapshot::placesOf(const EyeBox& box, const Extent& extent, Places& places) const
{
    if (extent.turned > mostTurned || extent.cylinder.leavesPicture) return false;
    // Places within the box lie between those of its corners, except for the ground's curve.
    places.bent = glm::dvec3(0.0);
    const double stretched = extent.stretch * extent.stretch;
    for (const osg::Vec3d& half : box.half)
    {
        const double ground = extent.curvature, square = half.length2() / 2.0;
        places.bent.x +=
            (extent.cylinder.sideStretch * ground + extent.cylinder.sideCurvature * stretched) * square;
        places.bent.y += (ground + extent.cylinder.curvature * stretched) * square;
        places.bent.z += ground * square;
    }
    places.low = glm::dvec3(HUGE_VAL);
    places.high = glm::dvec3(-HUGE_VAL);
    for (int corner = 0; corner < 8; ++corner)
    {
        osg::Vec3d position = box.center;
        for (int axis = 0; axis < 3; ++axis)
            position += box.half[axis] * (corner & (1 << axis) ? 1.0 : -1.0);
        const glm::dvec3 place = glsl::geofx_panoramaPlace(_view, toGlm(position));
        places.low = glm::min(places.low, place - places.bent);
        places.high = glm::max(places.high, place + places.bent);
    }
    return true;
}

void PanoramaSnapshot::pictureOf(const Places& places, glm::dvec3& low, glm::dvec3& high) const
{
    // Beyond the end, places go to the middle.
    const double before = glsl::geofx_panoramaFadeFrom(_view, _view.end, places.low.y);
    const double behind = glsl::geofx_panoramaFadeFrom(_view, _view.end, places.high.y);
    low.x = _view.across * places.low.x * (places.low.x < 0.0 ? before : behind);
    high.x = _view.across * places.high.x * (places.high.x > 0.0 ? before : behind);
    // Heights and Eq. 1 move a place up or down in the picture.
    // Their scale changes one way up to the horizon, and falls behind it.
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const double s :
         {places.low.y, std::clamp(_view.horizon, places.low.y, places.high.y), places.high.y})
    {
        for (const double widthAt : {places.low.y, places.high.y})
        {
            const double lift = glsl::geofx_profileLift(_view.lift, _view.liftGrowth, s / _view.horizon) *
                                glsl::geofx_cylinderWidth(_view.cylinder, widthAt) *
                                glsl::geofx_panoramaFade(_view, s);
            for (const double height : {places.low.z, places.high.z})
            {
                least = std::min(least, lift * (height - _view.base));
                most = std::max(most, lift * (height - _view.base));
            }
        }
    }
    const double farthest = std::max(std::abs(low.x), std::abs(high.x));
    const double nearest = low.x * high.x <= 0.0 ? 0.0 : std::min(std::abs(low.x), std::abs(high.x));
    double lowered = glsl::geofx_panoramaArch(_view, nearest);
    double lowest = glsl::geofx_panoramaArch(_view, farthest);
    if (lowered > lowest) std::swap(lowered, lowest);
    low.y = _view.along * glsl::geofx_panoramaRise(_view, places.low.y) - 1.0 + least - lowest;
    high.y = _view.along * glsl::geofx_panoramaRise(_view, places.high.y) - 1.0 + most - lowered;
    low.z = glsl::geofx_panoramaDepth(_view, places.low.y);
    high.z = glsl::geofx_panoramaDepth(_view, places.high.y);
}

bool PanoramaSnapshot::hidesBox(const EyeBox& box, const osg::Vec2d& room) const
{
    const Ball ball = box.ball();
    if (hides(ball, room)) return true;
    if (_view.plain > 0.0) return false;
    Places places;
    if (!placesOf(box, extentOf(ball), places)) return false;
    if (places.low.y > faded()) return true;
    const double middle = _view.cylinder.ring * _view.cylinder.middle;
    const double side =
        (_view.cylinder.ring > 0.0 ? _view.across * _view.cylinder.ring * _view.cylinder.halfArc : beside) +
        room.x();
    glm::dvec3 low, high;
    pictureOf(places, low, high);
    return low.x - _view.across * middle > side || high.x - _view.across * middle < -side ||
           high.y < -beside - room.y() || low.y > beside + room.y();
}

void PanoramaSnapshot::boundBox(const EyeBox& box, Hull& hull, double fineness) const
{
    Places places;
    if (_view.plain * _view.mirrored > 0.0 || !placesOf(box, extentOf(box.ball()), places))
    {
        DeformationSnapshot::boundBox(box, hull, fineness);
        return;
    }
    glm::dvec3 low, high;
    pictureOf(places, low, high);
    hull.points.clear();
    hull.margin = 0.0;
    hull.slack = glm::length(places.bent);
    // A point of eye space is linear in each of a picture's x, y and n, so the ends of their ranges bound it.
    for (const double x : {low.x, high.x})
    {
        for (const double y : {low.y, high.y})
        {
            for (const double n : {low.z, high.z})
                hull.points.push_back(toOsg(glsl::geofx_panoramaEye(_view, {x, y, n})));
        }
    }
    if (!(_view.plain > 0.0)) return;
    // A mean of two points, each within a hull, lies within the hull of the means of their points.
    std::vector<osg::Vec3d> corners;
    box.corners(corners);
    const std::vector<osg::Vec3d> drawn = hull.points;
    hull.points.clear();
    for (const osg::Vec3d& point : drawn)
    {
        for (const osg::Vec3d& corner : corners)
            hull.points.push_back(point + (corner - point) * _view.plain);
    }
}

/// Widths get smaller with the distance. Ways from the base to the horizon do so by the curve alone.
double PanoramaSnapshot::distanceAround(const Extent& extent) const
{
    const double n = _view.nearest;
    const double high = glm::length(_view.originY + n * _view.directionY);
    const double wide = glm::length(_view.originX + n * _view.directionX);
    const double deep = extent.slope * _view.along * high / (_view.across * wide);
    return _viewDistance / std::max(extent.cylinder.width, std::min(deep, 1.0));
}

std::string PanoramaSnapshot::complaint(const EyeBox& box) const
{
    if (!(_view.cylinder.halfArc >= largestHalf) || !extentOf(box.ball()).cylinder.leavesPicture) return {};
    return "A camera that draws a PanoramaMap with a horizontalAngle of more than 330 degrees leaves a gap "
           "opposite of its heading. Let two cameras draw parts of the picture side by side "
           "(osgGeoFX::drawInParts), as osggeofx_render and osggeofx_viewer do.";
}

std::optional<double> PanoramaSnapshot::viewDistance(const Ball& ball) const
{
    if (_view.cylinder.ring > 0.0) return distanceAround(extentOf(ball));
    if (!(_view.plain > 0.0)) return _viewDistance;
    // Both pictures mix as their places in eye space do: the sizes by their shares, and so the distances.
    const double own = std::max(ball.center.length() - ball.radius, 0.0);
    const Extent extent = extentOf(ball);
    const double map = 1.0 - _view.plain;
    const double away = _view.plain * own + map * extent.n;
    return away / (_view.plain + map * extent.n / _viewDistance);
}

DeformationSnapshot::Uniforms PanoramaSnapshot::uniforms() const
{
    const glsl::geofx_Exaggeration& globe = _view.globe;
    Uniforms all = {
        {"up", vec4(globe.up, globe.height)},
        {"axis", vec4(globe.axis, globe.flattening)},
        {"right", vec4(_view.right, globe.curvature)},
        {"forward", vec4(_view.forward, globe.scale)},
        {"scale", {_view.across, _view.along, _view.lift, _view.base}},
        {"curve", {_view.curve, _view.horizon, _view.end, _view.arch}},
        {"origin", vec4(_view.origin, _view.nearest)},
        {"originX", vec4(_view.originX, _view.plain)},
        {"originY", vec4(_view.originY, _view.mirrored)},
        {"direction", vec4(_view.direction, _view.water)},
        {"directionX", vec4(_view.directionX, 0.0)},
        {"directionY", vec4(_view.directionY, 0.0)},
        {"cylinder", {_view.cylinder.ring, _view.cylinder.middle, _view.cylinder.halfArc, 0.0}},
        {"profile", {_view.liftGrowth, _view.profile.first, 0.0, 0.0}},
    };
    int number = 0;
    for (const osg::Vec3d& knot : knotsOf(_view.profile))
        all.emplace_back("knot" + std::to_string(++number), osg::Vec4d(knot, 0.0));
    return all;
}

} // namespace osgGeoFX
