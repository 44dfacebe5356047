// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpItem.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Removes perspective around a point: everything is scaled by the distance of this point. The order of depths stays.
osg::Matrixd withoutPerspective(const osg::Vec3d& about)
{
    const double z = about.z();
    return {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0 / z, 0.0, 0.0, z, 2.0};
}

/// A column of a matrix of OSG, which is a row of the GPU's matrix.
osg::Vec4f column(const osg::Matrixd& matrix, int index)
{
    return osg::Vec4f(osg::Vec4d(matrix(0, index), matrix(1, index), matrix(2, index), matrix(3, index)));
}

/// The GPU's floats may move a place in a region by so much.
constexpr double slack = 1.001;

/// Cuts a convex polygon. The part stays where a coordinate, times ±1, is at most `limit`.
using Polygon = std::vector<osg::Vec3d>;
void cut(Polygon& polygon, int axis, double sign, double limit)
{
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const osg::Vec3d& from = polygon[i];
        const osg::Vec3d& to = polygon[(i + 1) % polygon.size()];
        const double before = limit - sign * from[axis];
        const double after = limit - sign * to[axis];
        if (before >= 0.0) kept.push_back(from);
        if ((before < 0.0) != (after < 0.0)) kept.push_back(from + (to - from) * (before / (before - after)));
    }
    polygon = std::move(kept);
}

} // namespace

CloseUpItem::CloseUpItem(const CloseUp& closeUp, const ViewGeometry& view, const osg::Matrixd& modelView,
                         const DeformationChain& chain, double time)
    : _closeUp(&closeUp), _halfWidth(closeUp.getRegion()->getWidth() / 2.0),
      _halfDepth(closeUp.getRegion()->getDepth() / 2.0)
{
    const RegionOfInterest& region = *closeUp.getRegion();
    const osg::Matrixd frame = region.frameToWorld(view.ground.ellipsoid);
    // A region is a column. It must end, or it would reach the ground on the other side of the planet.
    if (view.ground.ellipsoid) _otherSide = (osg::Vec3d() * osg::Matrixd::inverse(frame)).z();
    _regionToEye = frame * modelView;
    const osg::Matrixd toFrame = osg::Matrixd::inverse(_regionToEye);
    _toRegion = toFrame * osg::Matrixd::scale(1.0 / _halfWidth, 1.0 / _halfDepth, 1.0);
    const osg::Matrixd placed = _regionToEye * rigidPlacement(chain, _regionToEye.getTrans(), true);
    const osg::Matrixd shape = closeUp.shape(time);
    if (closeUp.getOrientation() == CloseUp::SCENE)
    {
        _lift = toFrame * shape * placed;
        return;
    }
    // The offset is in the scene's axes, the shape in the camera's.
    osg::Matrixd turned = shape;
    turned.setTrans(0.0, 0.0, 0.0);
    const osg::Vec3d at = closeUp.getOffset() * placed;
    _lift = toFrame * turned * osg::Matrixd::translate(at);
    const bool perspective = view.projection(3, 3) == 0.0;
    if (closeUp.getOrientation() != CloseUp::BILLBOARD || !perspective) return;
    // Not where the eye may be within the close-up: nothing can be drawn without perspective there.
    const double reach = std::hypot(_halfWidth * closeUp.getScaleX(), _halfDepth * closeUp.getScaleY()) +
                         1e4 * closeUp.getScaleHeight();
    if (at.z() < -reach)
    {
        _lift = _lift * withoutPerspective(at);
        _parallel = true;
    }
}

bool CloseUpItem::outside(const Ball& ball) const
{
    const osg::Vec3d place = ball.center * _toRegion;
    return std::abs(place.x()) > slack + ball.radius / _halfWidth ||
           std::abs(place.y()) > slack + ball.radius / _halfDepth || place.z() + ball.radius < _otherSide;
}

bool CloseUpItem::outside(const EyeBox& box) const
{
    const osg::Vec3d place = box.center * _toRegion;
    osg::Vec3d reach(slack, slack, 0.0);
    for (const osg::Vec3d& half : box.half)
    {
        const osg::Vec3d axis = osg::Matrixd::transform3x3(half, _toRegion);
        reach += osg::Vec3d(std::abs(axis.x()), std::abs(axis.y()), std::abs(axis.z()));
    }
    return std::abs(place.x()) > reach.x() || std::abs(place.y()) > reach.y() ||
           place.z() + reach.z() < _otherSide;
}

void CloseUpItem::includeHeights(const EyeBox& box, double& lowest, double& highest) const
{
    const osg::Vec3d middle = box.center * _toRegion;
    osg::Vec3d half[3], reach;
    for (std::size_t i = 0; i < 3; ++i)
    {
        half[i] = osg::Matrixd::transform3x3(box.half[i], _toRegion);
        for (int axis = 0; axis < 3; ++axis)
            reach[axis] += std::abs(half[i][axis]);
    }
    const bool within = std::abs(middle.x()) + reach.x() <= slack &&
                        std::abs(middle.y()) + reach.y() <= slack && middle.z() - reach.z() >= _otherSide;
    if (within)
    {
        lowest = std::min(lowest, middle.z() - reach.z());
        highest = std::max(highest, middle.z() + reach.z());
        return;
    }
    // On a globe the box of a wide tile is tilted, and most of it lies beside the region. The sides of the box, cut
    // by the region, give its heights there.
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    Polygon side;
    for (std::size_t i = 0; i < 6; ++i)
    {
        const osg::Vec3d& u = half[(i + 1) % 3];
        const osg::Vec3d& v = half[(i + 2) % 3];
        const osg::Vec3d at = middle + half[i % 3] * (i < 3 ? 1.0 : -1.0);
        side = {at - u - v, at + u - v, at + u + v, at - u + v};
        for (const int axis : {0, 1})
        {
            for (const double sign : {-1.0, 1.0})
                cut(side, axis, sign, slack);
        }
        for (const osg::Vec3d& corner : side)
        {
            low = std::min(low, corner.z());
            high = std::max(high, corner.z());
        }
    }
    if (high < _otherSide) return;
    lowest = std::min(lowest, std::max(low, _otherSide));
    highest = std::max(highest, high);
}

std::array<osg::Vec3d, 8> CloseUpItem::liftedCorners(double lowest, double highest) const
{
    const osg::Matrixd frameToLifted = _regionToEye * _lift;
    std::array<osg::Vec3d, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const osg::Vec3d corner((i & 1u) ? _halfWidth : -_halfWidth, (i & 2u) ? _halfDepth : -_halfDepth,
                                (i & 4u) ? highest : lowest);
        corners[i] = corner * frameToLifted;
    }
    return corners;
}

EyeBox CloseUpItem::groundBox(double lowest, double highest, double beyond) const
{
    // The ground falls below the region's plane at most as fast as the Earth's surface does.
    constexpr double earthDiameter = 1.27e7;
    const double reach = std::hypot(_halfWidth, _halfDepth) + beyond;
    if (beyond > 0.0) lowest -= reach * reach / earthDiameter;
    const osg::Vec3d low(-_halfWidth - beyond, -_halfDepth - beyond, lowest);
    const osg::Vec3d high(_halfWidth + beyond, _halfDepth + beyond, highest);
    return EyeBox::of(osg::BoundingBox(osg::Vec3(low), osg::Vec3(high)), _regionToEye);
}

CloseUpItem::Values CloseUpItem::values(const Places& places, const osg::Vec2d& shift, int layer,
                                        int anchorLayer, int samples) const
{
    const auto row = [](double x, double y, double z, double w)
    {
        return osg::Vec4f(osg::Vec4d(x, y, z, w));
    };
    const CloseUp& own = *_closeUp;
    const Anchor& anchor = *own.getAnchor();
    const osg::Vec3d color = own.getColor();
    const bool faded = own.getActivity() == CloseUp::DESATURATED;
    const double span = places.high > places.low ? 1.0 / (places.high - places.low) : 0.0;
    const double smaller = std::min(_halfWidth, _halfDepth);
    Values values;
    for (int i = 0; i < 4; ++i)
        values[static_cast<std::size_t>(i)] = column(_lift, i);
    for (int i = 0; i < 3; ++i)
        values[static_cast<std::size_t>(4 + i)] = column(_toRegion, i);
    values[7] = row(places.sun.x(), places.sun.y(), places.sun.z(), _halfWidth / smaller);
    const bool rectangle = own.getRegion()->getShape() == RegionOfInterest::RECTANGLE;
    values[8] = row(color.x(), color.y(), color.z(), rectangle ? 1.0 : 0.0);
    values[9] = row(places.mask, own.getEdge(), own.getRegion()->getSoftness() > 0.0 ? 1.0 : 0.0,
                    own.getLighting() == CloseUp::SUN ? 1.0 : 0.0);
    values[10] = row(places.surfaceLayer, places.surfaceKind, places.tableRow, own.getSurfaceOpacity());
    values[11] = row(places.low, span, places.maskSide, own.getMappingChannels());
    values[12] = row(faded ? 0.15 * own.getSaturation() : own.getSaturation(), own.getContrast(),
                     own.getBrightness(), own.getOpacity());
    values[13] = row(showsAnchor() ? anchor.getLineWidth() * samples : 0.0, _halfDepth / smaller,
                     places.anchorRow, faded ? 0.5 : 1.0);
    values[14] = row(shift.x(), shift.y(), layer, anchorLayer);
    const bool changes = stretched() || own.getEdge() == CloseUp::PRIMITIVES;
    values[15] =
        row(showsCloseUp() ? 1.0 : 0.0, stretched() ? 1.0 : 0.0, changes ? 1.0 : 0.0, own.getRoundness());
    return values;
}

} // namespace osgGeoFX
