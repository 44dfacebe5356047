// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/VerticalExaggeration.h>

#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/effect/detail/GlobeFrame.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGeoFX
{

namespace
{

/// A hull follows from a series if the box's radius is at most this share of its distance from the Earth's center.
constexpr double largestShare = 0.4;
/// And if no part of the box's ball is nearer to this center, in radii of the Earth.
constexpr double leastWay = 0.15;

class ExaggerationSnapshot : public DeformationSnapshot
{
public:
    ExaggerationSnapshot(const glsl::geofx_Exaggeration& view, bool relight) : _view(view), _relight(relight)
    {
    }

    osg::Vec3d deform(const osg::Vec3d& position) const override
    {
        return toOsg(glsl::geofx_exaggerate(_view, toGlm(position)));
    }
    osg::Vec3d undeform(const osg::Vec3d& position) const override
    {
        return toOsg(glsl::geofx_unexaggerate(_view, toGlm(position)));
    }
    osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const override
    {
        return toOsg(glsl::geofx_exaggerationNormal(_view, toGlm(position), toGlm(normal)));
    }
    bool looksAtBoxes() const override { return false; }
    Reach reach(const Ball&) const override { return _view.curvature > 0.0 ? Reach::Curved : Reach::Affine; }
    double lipschitz(const Ball& ball) const override
    {
        // The derivatives of the vertical and of the height are 10 k and 11 at most, as far as they are followed.
        if (deep(ball))
            return 1.0 + std::abs(_view.factor - 1.0) * 11.0 + 10.0 * _view.curvature * farthest(ball);
        return std::max(1.0, _view.factor) * groundStretch(ball);
    }
    double groundStretch(const Ball& ball) const override
    {
        if (deep(ball)) return lipschitz(ball);
        // (R + factor·h)/(R + h) on a globe, and a little for the turn of the vertical.
        const double lift =
            std::abs(_view.factor - 1.0) * (std::abs(height(ball.center) - _view.base) + ball.radius);
        return 1.0 + 1.1 * lift * _view.curvature;
    }
    Ball bound(const Ball& ball) const override
    {
        const osg::Vec3d center = deform(ball.center);
        if (deep(ball)) return {center, ball.radius + 2.0 * farthest(ball)};
        // As above, where the way of the middle tells its height.
        const double lift = (center - ball.center).length() + std::abs(_view.factor - 1.0) * ball.radius;
        return {center, ball.radius * std::max(1.0, _view.factor) * (1.0 + 1.1 * lift * _view.curvature)};
    }
    Sag sag(const Ball& ball, const osg::Vec3d& edge) const override
    {
        if (deep(ball)) return {HUGE_VAL, 0.0, 2.0 * farthest(ball)};
        // lift·up: the height's second derivative is at most the curvature k, its first 1, up's first k and its second
        // 3k²; 1.3 covers the ellipsoid's flattening and heights of a tenth of the radius.
        const double lift = std::abs(height(ball.center) - _view.base) + ball.radius;
        const double k = _view.curvature;
        const double second = std::abs(_view.factor - 1.0) * 1.3 * (3.0 * k + 3.0 * k * k * lift);
        return {second * edge.length2(), 0.0};
    }
    void boundBox(const EyeBox& box, Hull& hull, double fineness) const override
    {
        const Ball ball = box.ball();
        const glm::dvec3 gradient = glsl::geofx_exaggerationGradient(_view, toGlm(box.center));
        // One over the distance from the Earth's center.
        const double k = _view.curvature / std::max(glm::length(gradient), 0.1);
        const double share = k * ball.radius;
        // Near the Earth's center verticals meet, and derivatives bound nothing.
        if (_view.curvature <= 0.0 || share > largestShare || (1.0 - share) * _view.curvature < leastWay * k)
        {
            DeformationSnapshot::boundBox(box, hull, fineness);
            return;
        }
        const osg::Vec3d up = toOsg(glm::normalize(gradient));
        const double along =
            std::abs(box.half[0] * up) + std::abs(box.half[1] * up) + std::abs(box.half[2] * up);
        const double middle = height(box.center);
        // On a sphere a position x from the center goes to x + (factor − 1)·(x − (radius + base)·x/|x|). x/|x| is a series around the
        // box's middle. Its first terms make a box of the box. Its second ones, at a·up + t from the middle with t across up, are
        // −k²·(t²/2·up + a·t); a flattened Earth changes them by a share of about its flattening. The rest is less than
        // share³/(1 − share).
        const double strength = std::abs(_view.factor - 1.0) * (1.0 / k - (middle - _view.base)) * k * k;
        EyeBox image;
        image.center = deform(box.center);
        for (int axis = 0; axis < 3; ++axis)
            image.half[axis] =
                (deform(box.center + box.half[axis]) - deform(box.center - box.half[axis])) * 0.5;
        image.corners(hull.points);
        // t² is convex. So what is between the corners lies between the box and the box whose corners are lifted.
        std::vector<osg::Vec3d>& points = hull.points;
        const std::size_t corners = points.size();
        const osg::Vec3d lift = up * ((_view.factor > 1.0 ? 0.5 : -0.5) * strength);
        for (std::size_t i = 0; i < corners; ++i)
        {
            const osg::Vec3d d = box.half[0] * (i & 4 ? 1.0 : -1.0) + box.half[1] * (i & 2 ? 1.0 : -1.0) +
                                 box.half[2] * (i & 1 ? 1.0 : -1.0);
            points.push_back(points[i] + lift * std::max(d.length2() - (d * up) * (d * up), 0.0));
        }
        const double square = ball.radius * ball.radius;
        hull.margin = std::abs(strength) * (std::min(along, ball.radius) * ball.radius +
                                            2.0 * _view.flattening * square + square * share / (1.0 - share));
    }
    std::optional<double> movedHeight(double height) const override
    {
        return _view.base + _view.factor * (height - _view.base);
    }
    Uniforms uniforms() const override
    {
        const osg::Vec3d up = toOsg(_view.up);
        const osg::Vec3d axis = toOsg(_view.axis);
        return {{"up", {up, _view.height}},
                {"axis", {axis, _view.flattening}},
                {"scale", {_view.curvature, _view.scale, _view.factor, _view.base}},
                {"relight", {_relight ? 1.0 : 0.0, 0.0, 0.0, 0.0}}};
    }

private:
    double height(const osg::Vec3d& position) const
    {
        return glsl::geofx_exaggerationHeight(_view, toGlm(position));
    }

    /// Whether a ball goes deeper than a tenth of the Earth's radius. Verticals meet there, and derivatives bound little.
    bool deep(const Ball& ball) const
    {
        return _view.curvature > 0.0 && (height(ball.center) - ball.radius) * _view.curvature < -0.1;
    }
    /// How far anything in a ball moves at most, metres: no height is larger than the distance from the foot or the radius.
    double farthest(const Ball& ball) const
    {
        const double away = (ball.center + toOsg(_view.up) * _view.height).length() + ball.radius;
        return std::abs(_view.factor - 1.0) *
               (1.1 * std::max(away, 1.0 / _view.curvature) + std::abs(_view.base));
    }

    glsl::geofx_Exaggeration _view;
    bool _relight;
};

} // namespace

VerticalExaggeration::VerticalExaggeration(const VerticalExaggeration& other, const osg::CopyOp& copy)
    : Deformation(other, copy), _factor(other._factor), _baseHeight(other._baseHeight),
      _relight(other._relight)
{
}

VerticalExaggeration::~VerticalExaggeration() = default;

const Properties& VerticalExaggeration::properties() const
{
    using Self = VerticalExaggeration;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            Property::number("factor", "the factor by which heights grow", 0.01, 100.0)
                .of<&Self::_factor>()
                .turnedByFactor(1.15),
            Property::number(
                "baseHeight",
                "the height above the database's zero height at which everything stays in its place",
                -12000.0, 12000.0, "m")
                .of<&Self::_baseHeight>(),
            Property::flag("relight", "whether slopes are lit as steep as they look").of<&Self::_relight>(),
        });
    return all;
}

osg::ref_ptr<const DeformationSnapshot> VerticalExaggeration::snapshot(const ViewGeometry& view) const
{
    if (_factor == 1.0) return nullptr;
    glsl::geofx_Exaggeration globe{};
    globe.up = toGlm(view.up);
    globe.axis = toGlm(view.polarAxis);
    globe.height = view.eyeHeight;
    globe.factor = _factor;
    globe.base = _baseHeight;
    if (view.ground.ellipsoid) setGlobe(globe, *view.ground.ellipsoid, view.up * view.polarAxis);
    // Not a number, or beyond what floats can work with: no camera over a terrain is like this.
    const double sum = std::abs(view.eyeHeight) + std::abs(view.up * view.polarAxis) + globe.curvature;
    if (!(sum < 1e15)) return nullptr;
    return new ExaggerationSnapshot(globe, _relight);
}

void VerticalExaggeration::changeGround(Ground& ground) const
{
    ground.minHeight = _baseHeight + _factor * (ground.minHeight - _baseHeight);
    ground.maxHeight = _baseHeight + _factor * (ground.maxHeight - _baseHeight);
}

} // namespace osgGeoFX
