// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/BirdsEyeView.h>

#include <osgGeoFX/scene/GlslFunctions.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

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

double curvature(int curve, double size, double angle)
{
    return std::abs(glsl::geofx_bendCurvature(glsl::geofx_makeBend(curve, size, angle)));
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
        list.push_back(Property::number("focusLine", 0.4, 0.0, 1.0).of<&Self::_focusLine>());
        list.push_back(Property::number("horizonLine", 0.85, 0.0, 1.0).of<&Self::_horizonLine>());
        list.push_back(Property::number("contextTilt", 0.0, 0.0, 0.9).of<&Self::_contextTilt>());
        return list;
    }();
    return all;
}

std::string BirdsEyeView::inconsistency() const
{
    return _focusLine < _horizonLine ? "" : "focusLine must lie below horizonLine.";
}

std::optional<BendPlacement> BirdsEyeView::placement(const ViewGeometry& view) const
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
    // A horizon beyond the foot would need more than a right angle.
    if (!(reach > 0.0) || !(horizon->depression < osg::PI_2)) return std::nullopt;

    BendPlacement place;
    place.planeHeight = height;
    place.start = focus->distance;
    const double angle = horizon->depression;
    // Tangents of the curve at its ends meet at the axis.
    const bool arc = getCurve() == CIRCULAR_ARC;
    const auto sizeFor = [&](double bend)
    {
        return arc ? reach * bend / std::tan(bend / 2.0) : 2.0 * reach;
    };
    place.size = sizeFor(angle);
    place.angle = -angle;
    const double most = mostCurvature(view, -1.0, std::abs(place.start) + place.size);
    if (curvature(getCurve(), place.size, angle) > most)
    {
        // Less of a bend, as much as what lies below T allows. The curvature grows with the angle.
        double low = 0.0;
        double high = angle;
        for (int i = 0; i < 50; ++i)
        {
            const double middle = (low + high) / 2.0;
            (curvature(getCurve(), sizeFor(std::max(middle, 1e-12)), middle) > most ? high : low) = middle;
        }
        place.angle = -low;
        if (low > 1e-12) place.size = sizeFor(low);
    }
    return place;
}

} // namespace osgGeoFX
