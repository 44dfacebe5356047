// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/RegionalLiberty.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/effect/detail/LibertyInverse.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of the share (1 − r²)², over 0 ≤ r ≤ 1: its largest slope, second derivative, and product with r.
constexpr double shareSlope = 1.54, shareSecond = 8.0, shareReach = 0.2863;

osg::Vec4d vec4(const glm::dvec3& vector, double w)
{
    return {vector.x, vector.y, vector.z, w};
}

/// What the movements do at most to places with heights up to `height` above or below the one that stays.
struct Most
{
    double growth;     ///< of a distance
    double second;     ///< of the deformed place, 1/metre
    double horizontal; ///< movement, metres
    double vertical;

    Most(const glsl::geofx_Liberty& view, double height)
    {
        const double wide = view.acrossRadius, deep = view.alongRadius;
        const double small = std::min(wide, deep), large = std::max(wide, deep);
        const double turn = std::abs(view.turn), widen = std::abs(view.widen);
        const double lengthen = std::abs(view.lengthen), enlarge = std::abs(view.enlarge);
        const double k = view.curvature;
        // One movement after the other: first and second derivatives.
        const double first1 = turn > 0.0 ? large / small * (1.0 + turn) : 1.0;
        const double second1 =
            large / (small * small) *
            (turn * (2.0 * shareSlope + shareSecond) + turn * turn * shareSlope * shareSlope);
        const double first2 = 1.0 + widen * (1.0 + 0.5 * wide / deep);
        const double second2 = widen * wide / (small * small) * (2.0 * shareSlope + shareSecond);
        const double first3 = 1.0 + lengthen * (1.0 + 0.5 * deep / wide);
        const double second3 = lengthen * deep / (small * small) * (2.0 * shareSlope + shareSecond);
        const double flat = first1 * first2 * first3;
        const double flatSecond = second3 * first2 * first2 * first1 * first1 +
                                  first3 * (second2 * first1 * first1 + first2 * second1);
        const double up = std::max(1.0, 1.0 + view.enlarge);
        const double slope = enlarge * height * shareSlope / small;
        growth = std::max(flat, up) + slope + k * large * (up + flat);
        second = flatSecond +
                 enlarge *
                     (height * shareSecond / (small * small) + 2.0 * shareSlope / small * (1.0 + k * large)) +
                 k * (up + flat * flat + large * flatSecond);
        horizontal = shareReach * (std::min(turn, 2.0) * large + first1 * (widen * wide + lengthen * deep));
        vertical = enlarge * height + k * large * horizontal;
    }
};

class LibertySnapshot : public DeformationSnapshot
{
public:
    explicit LibertySnapshot(const glsl::geofx_Liberty& view) : _view(view) {}

    osg::Vec3d deform(const osg::Vec3d& position) const override
    {
        return toOsg(glsl::geofx_liberty(_view, toGlm(position)));
    }
    osg::Vec3d undeform(const osg::Vec3d& position) const override;
    osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const override
    {
        return toOsg(glsl::geofx_libertyNormal(_view, toGlm(position), toGlm(normal)));
    }
    osg::Matrixd turn(const osg::Vec3d& position) const override;
    bool looksAtBoxes() const override { return false; }
    Reach reach(const Ball& ball) const override
    {
        const glm::dvec3 local = glsl::geofx_libertyLocal(_view, toGlm(ball.center));
        const double away = std::hypot(local.x / _view.acrossRadius, local.y / _view.alongRadius);
        const double small = std::min(_view.acrossRadius, _view.alongRadius);
        const bool apart = away - ball.radius / small >= 1.0;
        const bool behind = _view.curvature * (local.z + ball.radius) < -0.5;
        return apart || behind ? Reach::Identity : Reach::Curved;
    }
    double lipschitz(const Ball& ball) const override
    {
        return reach(ball) == Reach::Identity ? 1.0 : most(ball).growth;
    }
    Ball bound(const Ball& ball) const override
    {
        if (reach(ball) == Reach::Identity) return ball;
        const Most all = most(ball);
        const double moved = std::hypot(all.horizontal, all.vertical);
        if (ball.radius * (all.growth - 1.0) < moved) return {deform(ball.center), ball.radius * all.growth};
        return {ball.center, ball.radius + moved};
    }
    Sag sag(const Ball& ball, const osg::Vec3d& edge) const override
    {
        if (reach(ball) == Reach::Identity) return {};
        const Most all = most(ball);
        return {all.second * edge.length2(), 0.0, 2.0 * std::hypot(all.horizontal, all.vertical)};
    }
    double longestEdge(const Ball& ball, double tolerance) const override
    {
        if (reach(ball) == Reach::Identity) return HUGE_VAL;
        const double distance = std::max(ball.center.length() - ball.radius, 1.0);
        return std::sqrt(8.0 * tolerance * distance / std::max(most(ball).second, 1e-30));
    }
    Uniforms uniforms() const override
    {
        return {{"center", vec4(_view.center, _view.curvature)},
                {"across", vec4(_view.across, _view.acrossRadius)},
                {"along", vec4(_view.along, _view.alongRadius)},
                {"up", vec4(_view.up, _view.base)},
                {"taken", {_view.enlarge, _view.widen, _view.lengthen, _view.turn}}};
    }

private:
    Most most(const Ball& ball) const
    {
        const glm::dvec3 local = glsl::geofx_libertyLocal(_view, toGlm(ball.center));
        // Only what lies above the region moves.
        const double beside = std::min(std::hypot(local.x, local.y) + ball.radius,
                                       std::max(_view.acrossRadius, _view.alongRadius));
        const double height =
            std::abs(local.z - _view.base) + ball.radius + _view.curvature / 2.0 * beside * beside;
        return {_view, height};
    }

    glsl::geofx_Liberty _view;
};

osg::Vec3d LibertySnapshot::undeform(const osg::Vec3d& position) const
{
    const glm::dvec3 drawn = glsl::geofx_libertyLocal(_view, toGlm(position));
    const glm::dvec3 way = undoneLiberty(_view, drawn) - drawn;
    if (way == glm::dvec3(0.0)) return position;
    return position + toOsg(way.x * _view.across + way.y * _view.along + way.z * _view.up);
}

/// What stands on the ground stays upright, and turns as the ground does about it: by the rotation of the derivative's
/// horizontal part.
osg::Matrixd LibertySnapshot::turn(const osg::Vec3d& position) const
{
    if (reach({position, 0.0}) == Reach::Identity) return osg::Matrixd::identity();
    return osg::Matrixd::rotate(glsl::geofx_libertyTurn(_view, toGlm(position)), toOsg(_view.up));
}

/// The movements of a liberty, without a place.
glsl::geofx_Liberty movements(const RegionalLiberty& liberty)
{
    glsl::geofx_Liberty view{};
    view.acrossRadius = liberty.getAcross();
    view.alongRadius = liberty.getAlong();
    view.base = liberty.getBaseHeight();
    const double strength = liberty.getStrength();
    view.enlarge = strength * (liberty.getEnlarge() - 1.0);
    view.widen = strength * (liberty.getWiden() - 1.0);
    view.lengthen = strength * (liberty.getLengthen() - 1.0);
    view.turn = strength * liberty.getTurn();
    return view;
}

/// The curvature of the sphere that fits an ellipsoid best at a latitude, 1/metre.
double curvatureAt(const osg::EllipsoidModel& ellipsoid, double latitude)
{
    const double a = ellipsoid.getRadiusEquator(), b = ellipsoid.getRadiusPolar();
    const double c = std::cos(latitude), s = std::sin(latitude);
    return (a * a * c * c + b * b * s * s) / (a * a * b);
}

Most mostOf(const RegionalLiberty& liberty, const Ground& ground)
{
    glsl::geofx_Liberty view = movements(liberty);
    if (ground.ellipsoid) view.curvature = curvatureAt(*ground.ellipsoid, liberty.getLatitude());
    return {view, std::max(std::abs(ground.minHeight - view.base), std::abs(ground.maxHeight - view.base))};
}

} // namespace

RegionalLiberty::RegionalLiberty(const RegionalLiberty& other, const osg::CopyOp& copy)
    : Deformation(other, copy), _center(other._center), _strength(other._strength), _across(other._across),
      _along(other._along), _heading(other._heading), _enlarge(other._enlarge),
      _baseHeight(other._baseHeight), _widen(other._widen), _lengthen(other._lengthen), _turn(other._turn)
{
}

RegionalLiberty::~RegionalLiberty() = default;

const Properties& RegionalLiberty::properties() const
{
    using Self = RegionalLiberty;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            Property::number("strength", "how much of the liberty is taken", 0.0, 1.0).of<&Self::_strength>(),
            Property::number("centerX", "the center on a projected terrain, to the east", -5e7, 5e7, "m")
                .of<&Self::_center, &LocalOrigin::x>(),
            Property::number("centerY", "the center on a projected terrain, to the north", -5e7, 5e7, "m")
                .of<&Self::_center, &LocalOrigin::y>(),
            Property::angle("longitude", "the longitude of the center on a globe, to the east", -osg::PI,
                            osg::PI)
                .of<&Self::_center, &LocalOrigin::longitude>(),
            Property::angle("latitude", "the latitude of the center on a globe, to the north", -osg::PI_2,
                            osg::PI_2)
                .of<&Self::_center, &LocalOrigin::latitude>(),
            Property::number("across", "half the region's width across its heading", 10.0, 3e5, "m")
                .of<&Self::_across>(),
            Property::number("along", "half the region's width along its heading", 10.0, 3e5, "m")
                .of<&Self::_along>(),
            Property::angle("heading", "the direction of the region, clockwise from north", -2.0 * osg::PI,
                            2.0 * osg::PI)
                .of<&Self::_heading>(),
            Property::number("enlarge", "the factor of heights in the middle", 0.1, 5.0)
                .of<&Self::_enlarge>()
                .turnedByFactor(1.15),
            Property::number("baseHeight", "the height above the database's zero height that stays", -12000.0,
                             12000.0, "m")
                .of<&Self::_baseHeight>(),
            Property::number("widen", "the factor of widths across the heading in the middle", 0.25, 2.0)
                .of<&Self::_widen>(),
            Property::number("lengthen", "the factor of widths along the heading in the middle", 0.25, 2.0)
                .of<&Self::_lengthen>(),
            Property::angle("turn", "how far the middle turns, clockwise seen from above", -osg::PI_2,
                            osg::PI_2)
                .of<&Self::_turn>(),
        });
    return all;
}

osg::ref_ptr<const DeformationSnapshot> RegionalLiberty::snapshot(const ViewGeometry& view) const
{
    glsl::geofx_Liberty liberty = movements(*this);
    if (liberty.enlarge == 0.0 && liberty.widen == 0.0 && liberty.lengthen == 0.0 && liberty.turn == 0.0)
        return nullptr;
    const osg::EllipsoidModel* ellipsoid = view.ground.ellipsoid;
    if (ellipsoid) liberty.curvature = curvatureAt(*ellipsoid, _center.latitude);
    const osg::Matrixd toEye = _center.toWorld(ellipsoid, 0.0) * view.modelView;
    const auto axis = [&](const osg::Vec3d& local)
    {
        return toGlm(osg::Matrixd::transform3x3(local, toEye));
    };
    const double c = std::cos(_heading), s = std::sin(_heading);
    liberty.across = axis({c, -s, 0.0});
    liberty.along = axis({s, c, 0.0});
    liberty.up = axis({0.0, 0.0, 1.0});
    liberty.center = toGlm(toEye.getTrans());
    // Not a number, or beyond what floats can work with.
    const double largest = toEye.getTrans().length() + glm::length(liberty.across) +
                           glm::length(liberty.along) + glm::length(liberty.up);
    if (!(largest < 1e15)) return nullptr;
    return new LibertySnapshot(liberty);
}

void RegionalLiberty::changeGround(Ground& ground) const
{
    const double factor = 1.0 + movements(*this).enlarge;
    ground.minHeight = std::min(ground.minHeight, _baseHeight + factor * (ground.minHeight - _baseHeight));
    ground.maxHeight = std::max(ground.maxHeight, _baseHeight + factor * (ground.maxHeight - _baseHeight));
}

double RegionalLiberty::longestEdge(const CameraRange& cameras, double tolerance) const
{
    const double second = mostOf(*this, cameras.ground).second;
    return std::sqrt(8.0 * tolerance * cameras.distance / std::max(second, 1e-30));
}

double RegionalLiberty::mostGrowth(const Ground& ground) const
{
    return mostOf(*this, ground).growth;
}

} // namespace osgGeoFX
