// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/BirdsEyeView.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of the eye's height above the lowest ground: so far it is at least above the level from which T's height counts.
constexpr double leastShare = 0.25;

/// Where the plane through a line of the picture and parallel to the axis of the bend meets T.
struct LineOnGround
{
    double distance = 0.0;   ///< s, from the eye's foot
    double depression = 0.0; ///< ν, 0…π
};

std::optional<LineOnGround> unproject(const ViewGeometry& view, const osg::Vec3d& forward, double planeHeight,
                                      double line)
{
    osg::Vec3d origin;
    osg::Vec3d direction;
    view.ray(0.0, 2.0 * line - 1.0, origin, direction);
    // In the profile, the coordinate along the axis is left out.
    const double along = direction * forward;
    const double down = -(direction * view.up);
    if (!(down > 0.0)) return std::nullopt;
    const double height = origin * view.up + planeHeight;
    return LineOnGround{origin * forward + height * along / down, std::atan2(down, along)};
}

/// 0…1 where a value goes from `from` to `to`, without a kink.
double fade(double from, double to, double value)
{
    const double share = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

/// The larger one of a height and a least height, without a kink: the height itself from twice the least one on.
double atLeast(double least, double height)
{
    if (height >= 2.0 * least) return height;
    return least + (height > 0.0 ? height * height / (4.0 * least) : 0.0);
}

/// The bend's share for a camera that sees the ground in a way that a bend of 90° at most cannot serve: beyond straight
/// down the horizon's plane would stand on its head, and lines behind the eye run away to infinity. On an orthographic
/// camera that looks level the zone, as wide as the picture's rays are long, would not fade by itself.
double servedShare(double focusDepression, double horizonDepression, bool perspective)
{
    const double level = perspective ? 1.0 : fade(0.0, osg::DegreesToRadians(3.0), horizonDepression);
    return level * fade(osg::DegreesToRadians(105.0), osg::PI_2, horizonDepression) *
           fade(osg::PI, osg::DegreesToRadians(165.0), focusDepression);
}

/// The angle β of a bend whose tangents meet `reach` metres from its ends and whose curvature is `most`: for the arc
/// tan(β/2)/reach, for the parabola sin(β/2)/(cos²(β/2)·reach).
double angleForCurvature(bool arc, double reach, double most)
{
    const double product = most * reach;
    if (arc) return 2.0 * std::atan(product);
    return 2.0 * std::asin(2.0 * product / (1.0 + std::sqrt(1.0 + 4.0 * product * product)));
}

} // namespace

BirdsEyeView::BirdsEyeView(const BirdsEyeView& other, const osg::CopyOp& copy)
    : PerspectiveBend(other, copy), _focusLine(other._focusLine), _horizonLine(other._horizonLine),
      _contextTilt(other._contextTilt)
{
}

BirdsEyeView::~BirdsEyeView() = default;

const Properties& BirdsEyeView::properties() const
{
    using Self = BirdsEyeView;
    static const Properties all = []
    {
        Properties list = bendProperties();
        list.insert(
            list.end(),
            {Property::number("focusLine",
                              "where the transition zone begins, as a share of the image's height from "
                              "below; less than horizonLine",
                              0.0, 1.0)
                 .of<&Self::_focusLine>(),
             Property::number("horizonLine",
                              "where the horizon lies, as a share of the image's height from below; more "
                              "than focusLine",
                              0.0, 1.0)
                 .of<&Self::_horizonLine>()
                 .turnedBy(0.02),
             Property::number("contextTilt",
                              "how much of the context's ground shows; with 0 it is seen from its edge", 0.0,
                              0.9)
                 .of<&Self::_contextTilt>()});
        return withDefaultsOf(new Self, std::move(list));
    }();
    return all;
}

std::string BirdsEyeView::inconsistency() const
{
    return _focusLine < _horizonLine ? "" : "focusLine must lie below horizonLine.";
}

bool BirdsEyeView::sinks(const Ground& ground) const
{
    return getPlaneReference() == GROUND && ground.minHeight < 0.0;
}

double BirdsEyeView::planeHeight(const ViewGeometry& view) const
{
    const double height = PerspectiveBend::planeHeight(view);
    if (!sinks(view.ground)) return height;
    const double least = leastShare * std::max(view.eyeHeight - view.ground.minHeight, 0.0);
    const double aboveZero = atLeast(least, view.eyeHeight);
    return getPlaneHeight() > 0.0 ? aboveZero - getPlaneHeight() : std::max(height, aboveZero);
}

osg::ref_ptr<const DeformationSnapshot> BirdsEyeView::snapshot(const ViewGeometry& view) const
{
    // What nobody has told of cannot be reckoned with. There is no ground below these depths, but coordinates of another kind.
    constexpr double deepest = -12000.0;
    const bool below = view.eyeHeight <= 0.0 && view.eyeHeight > deepest && !view.ground.heightsKnown &&
                       getPlaneReference() == GROUND && planeHeight(view) <= 0.0 &&
                       view.projection(3, 3) == 0.0;
    if (below && !_saidBelow.exchange(true))
        OSG_WARN
            << "osgGeoFX: a BirdsEyeView bends nothing while the eye is below its reference plane, which is "
               "at "
            << (view.ground.ellipsoid ? "the ellipsoid" : "height 0")
            << " as long as nobody tells that the ground lies lower. State the ground's heights with "
               "EffectScene::setGround(), or set planeHeight."
            << std::endl;
    return PerspectiveBend::snapshot(view);
}

std::optional<BendPlacement> BirdsEyeView::placementOf(Curve curve, const ViewGeometry& view) const
{
    const double height = planeHeight(view);
    const bool perspective = view.projection(3, 3) == 0.0;
    if (perspective && height <= 0.0) return std::nullopt;
    osg::Vec3d forward = heading(view);
    if (forward.normalize() <= 0.0) return std::nullopt;
    const std::optional<LineOnGround> focus = unproject(view, forward, height, _focusLine);
    const std::optional<LineOnGround> horizon = unproject(view, forward, height, _horizonLine);
    if (!focus || !horizon) return std::nullopt;
    const double reach = (horizon->distance - focus->distance) * (1.0 - _contextTilt);
    if (!(reach > 0.0)) return std::nullopt;

    BendPlacement place;
    place.planeHeight = height;
    place.start = focus->distance;
    // A horizon beyond the foot would need more than a right angle.
    const double angle = std::min(horizon->depression, osg::PI_2);
    // Tangents of the curve at its ends meet at the axis.
    const bool arc = curve == CIRCULAR_ARC;
    const auto sizeFor = [&](double bend)
    {
        return arc ? reach * bend / std::tan(bend / 2.0) : 2.0 * reach;
    };
    // Less of a bend where what lies below T would fold.
    place.angle = -std::min(
        angle,
        angleForCurvature(arc, reach, mostCurvature(view, -1.0, std::abs(place.start) + sizeFor(angle))));
    place.size = sizeFor(-place.angle);
    place.angle *= servedShare(focus->depression, horizon->depression, perspective);
    return place;
}

} // namespace osgGeoFX
