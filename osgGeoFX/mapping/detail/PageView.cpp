// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/PageView.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Things on the ground are at most so much higher than the ground is stated to be, metres.
constexpr double ofThings = 500.0;
constexpr double nearest = 0.01; // metres

void include(const osg::Vec3d& point, osg::Vec3d& low, osg::Vec3d& high)
{
    for (int i = 0; i < 3; ++i)
    {
        low[i] = std::min(low[i], point[i]);
        high[i] = std::max(high[i], point[i]);
    }
}

/// The least distance from the eye of what is in a ball, as it is drawn, metres: one at which a plain view shows it no smaller. It is that of
/// DeformationChain::lodDistance() without the factors of Deformation::detail(), which are for meshes.
double leastDistance(const DeformationChain& chain, const Ball& ball, const osg::Vec3d& eye)
{
    Ball current = ball;
    double stretch = 1.0;
    for (const auto& snapshot : chain.snapshots())
    {
        if (snapshot->reach(current) == DeformationSnapshot::Reach::Identity) continue;
        if (const std::optional<double> distance = snapshot->viewDistance(current))
            return std::max(*distance, 0.0) / stretch;
        stretch *= snapshot->lipschitz(current);
        current = snapshot->bound(current);
    }
    return std::max((current.center - eye).length() - current.radius, 0.0) / stretch;
}

/// Balls so much smaller than their distance tell it well enough.
constexpr double smallBall = 0.1;
constexpr int mostCuts = 10;

} // namespace

osg::Drawable* PageWatch::companion(osg::Drawable& drawable, const osg::Matrixd& modelView)
{
    const osg::BoundingBox& box = drawable.getBoundingBox();
    if (box.valid())
        _boxes.push_back(EyeBox::of(box, modelView));
    else
        _boundless = true;
    return nullptr;
}

PageView::PageView(const PlaneBox& mapped, IsEmpty isEmpty, const ScenePass& pass, const PageFrame& frame)
    : _mapped(mapped), _isEmpty(std::move(isEmpty)), _pass(pass), _frame(frame)
{
    const ViewGeometry::Image& image = pass.view.image;
    Visibility::Camera camera;
    camera.projection = image.projection;
    if (!image.ofView) camera.image = &image;
    camera.viewport = pass.outer.getViewport();
    osg::Polytope planes;
    // Near and far are not known yet.
    planes.setToUnitFrustum(false, false);
    planes.transformProvidingInverse(camera.projection);
    camera.planes = &planes;
    camera.nearPlane = camera.farPlane = false;
    _visibility.set(camera);
    _eye = image.toView.getTrans();
}

std::vector<SeenGround> PageView::groundBelow(const std::vector<EyeBox>& boxes)
{
    std::vector<SeenGround> seen;
    std::vector<osg::Vec3d> corners;
    for (const EyeBox& box : boxes)
    {
        box.corners(corners);
        osg::Vec3d low(DBL_MAX, DBL_MAX, DBL_MAX), high(-DBL_MAX, -DBL_MAX, -DBL_MAX);
        for (const osg::Vec3d& corner : corners)
            include(_frame.placeOf(corner * _frame.fromEye), low, high);
        if (_frame.globe)
        {
            // Sides of a box may bulge beyond its corners.
            const double size = 2.0 * box.ball().radius;
            const double bulge = size * size * _frame.curvature / 8.0;
            low -= osg::Vec3d(bulge, bulge, bulge);
            high += osg::Vec3d(bulge, bulge, bulge);
            const Ground& ground = _pass.view.ground;
            const double lowest = ground.minHeight - ofThings, highest = ground.maxHeight + ofThings;
            // What flies or lies deep is where it is.
            if (ground.heightsKnown && low.z() <= highest && high.z() >= lowest)
            {
                low.z() = std::max(low.z(), lowest);
                high.z() = std::min(high.z(), highest);
            }
        }
        const PlaneBox whole = {{low.x(), low.y()}, {high.x(), high.y()}};
        const PlaneBox plane = whole.within(_mapped);
        _beyond = _beyond || !_mapped.contains(whole);
        if (!plane.empty()) seen.push_back({plane, low.z(), high.z()});
    }
    return seen;
}

void PageView::bound(const SeenGround& ground, osg::Vec3d& low, osg::Vec3d& high) const
{
    const PlaneBox& box = ground.box;
    if (!_frame.globe)
    {
        low.set(box.low.x(), box.low.y(), ground.lowest);
        high.set(box.high.x(), box.high.y(), ground.highest);
        return;
    }
    low.set(DBL_MAX, DBL_MAX, DBL_MAX);
    high = -low;
    for (const double x : {box.low.x(), box.high.x()})
    {
        for (const double y : {box.low.y(), box.high.y()})
        {
            for (const double z : {ground.lowest, ground.highest})
                include(_frame.positionOf({x, y, z}), low, high);
        }
    }
    // The ground is higher in the middle than between its corners.
    const osg::Vec2d size = box.high - box.low;
    high.z() += size.length2() * _frame.curvature / 4.0;
}

EyeBox PageView::eyeBox(const osg::Vec3d& low, const osg::Vec3d& high) const
{
    EyeBox box;
    box.center = (low + high) * 0.5 * _frame.toEye;
    for (int i = 0; i < 3; ++i)
    {
        osg::Vec3d half;
        half[i] = 0.5 * (high[i] - low[i]);
        box.half[i] = osg::Matrixd::transform3x3(half, _frame.toEye);
    }
    return box;
}

bool PageView::shows(const SeenGround& ground)
{
    osg::Vec3d low, high;
    bound(ground, low, high);
    return !_visibility.outOfSight(_pass.chain, eyeBox(low, high), _visibility.all());
}

void PageView::approach(const osg::Vec3d& low, const osg::Vec3d& high, int cuts, double& least) const
{
    // A large box's ball reaches far beyond it, and comes much nearer.
    const Ball ball = eyeBox(low, high).ball();
    const double distance = leastDistance(_pass.chain, ball, _eye);
    if (distance >= least) return;
    if (cuts == 0 || ball.radius <= smallBall * distance)
    {
        least = distance;
        return;
    }
    const osg::Vec3d size = high - low;
    const int axis = size.x() >= size.y() && size.x() >= size.z() ? 0 : size.y() >= size.z() ? 1 : 2;
    osg::Vec3d end = high, start = low;
    end[axis] = start[axis] = (low[axis] + high[axis]) / 2.0;
    // The nearer half first, which may spare the other one.
    const bool firstIsNearer = leastDistance(_pass.chain, eyeBox(low, end).ball(), _eye) <
                               leastDistance(_pass.chain, eyeBox(start, high).ball(), _eye);
    if (firstIsNearer) approach(low, end, cuts - 1, least);
    approach(start, high, cuts - 1, least);
    if (!firstIsNearer) approach(low, end, cuts - 1, least);
}

double PageView::texel(const SeenGround& ground)
{
    if (_frame.pixel <= 0.0) return _frame.pixelAnywhere;
    osg::Vec3d low, high;
    bound(ground, low, high);
    double distance = DBL_MAX;
    if (_pass.chain.empty())
    {
        const osg::Vec3d eye = _eye * _frame.fromEye;
        osg::Vec3d to;
        for (int i = 0; i < 3; ++i)
            to[i] = std::max({low[i] - eye[i], eye[i] - high[i], 0.0});
        distance = to.length();
    }
    else
        approach(low, high, mostCuts, distance);
    return std::max(distance, nearest) * _frame.pixel + _frame.pixelAnywhere;
}

} // namespace osgGeoFX
