// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Levels of detail, and the tiles of the kit's databases.
#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

#include <osgGeoFX/scene/detail/ProxyFrustum.h>
#include <osgGeoFX/scene/detail/TileSight.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/ClusterCullingCallback>
#include <osg/PagedLOD>

#include <algorithm>
#include <cmath>
#include <typeinfo>

namespace osgGeoFX
{

namespace
{

/// A block of a tile with nothing that OSG's own traversal would have to look at: with many of them in a view, what
/// a visitor does for any node is most of the time.
bool isPlain(const osg::LOD& block)
{
    return TileInfo::meshesOf(block) && block.isCullingActive() && !block.getStateSet() &&
           !block.getCullCallback() && block.getRangeMode() == osg::LOD::DISTANCE_FROM_EYE_POINT;
}

/// A node with tiles that goes on by its ranges alone. A horizon does not cull in passes.
bool isPlainPaged(const osg::LOD& node)
{
    const osg::Callback* callback = node.getCullCallback();
    return typeid(node) == typeid(osg::PagedLOD) &&
           (!callback ||
            (typeid(*callback) == typeid(osg::ClusterCullingCallback) && !callback->getNestedCallback()));
}

/// A group that does nothing but hold its children.
bool isPlain(const osg::Node& node)
{
    return typeid(node) == typeid(osg::Group) && node.isCullingActive() && !node.getStateSet() &&
           !node.getCullCallback();
}

} // namespace

void CompensatingCullVisitor::applyTile(osg::Transform& node)
{
    // Its geometry is tested by boxes, which are tighter than its sphere, and asks for no more than a matrix: what the
    // base class would also work out, culling sets and eye points, no one would look at.
    const Mode former = _mode;
    osg::StateSet* state = node.getStateSet();
    meet(state);
    if (!node.isCullingActive())
    {
        _mode.planes = _sight.all();
    }
    else if (_sight.cullsSmall() && node.getNumChildren() > 1)
    {
        // OSG leaves out nodes that are too small, never single drawables.
        Visibility::Mask planes = _mode.planes;
        const osg::BoundingSphere& sphere = node.getBound();
        if (sphere.valid() && _sight.outOfSight(_mode.chain->bound(eyeBall(sphere)), planes) &&
            !partsInSight(node, eyeBall(sphere)))
        {
            _mode = former;
            return;
        }
    }
    _mode.tile = node.isCullingActive() && node.getNumChildren() == 1;
    if (state) pushStateSet(state);
    osg::RefMatrix* matrix = createOrReuseMatrix(*getModelViewMatrix());
    node.computeLocalToWorldMatrix(*matrix, this);
    _modelviewStack.push_back(matrix);
    node.traverse(*this);
    _modelviewStack.pop_back();
    if (state) popStateSet();
    _mode = former;
}

void CompensatingCullVisitor::applyBlock(osg::LOD& block)
{
    const Visibility::Mask formerPlanes = _mode.planes;
    const Ball ball = eyeBall(block.getBound());
    const Ball deformed = _mode.chain->bound(ball);
    // Never left out for being small: a deformation may squeeze many of them into a few pixels.
    const bool out =
        formerPlanes && (_sight.hides(*_mode.chain, ball) || _sight.outOfSight(deformed, _mode.planes, true));
    if (!out || partsInSight(block, ball))
    {
        const double distance = _mode.chain->lodDistance(ball, viewPoint(), &deformed);
        auto told = static_cast<float>(distance * static_cast<double>(getLODScale()));
        // A limit makes nothing finer than the finest mesh.
        if (block.getNumRanges() > 0 && told >= block.getMaxRange(0))
            told = std::min(told, static_cast<float>(_mode.chain->lodLimit(block, ball)));
        for (unsigned int i = 0; i < block.getNumChildren(); ++i)
        {
            if (block.getMinRange(i) <= told && told < block.getMaxRange(i)) applyPart(*block.getChild(i));
        }
    }
    _mode.planes = formerPlanes;
}

void CompensatingCullVisitor::applyPart(osg::Node& part)
{
    if (!isPlain(part))
    {
        part.accept(*this);
        return;
    }
    if (!validNodeMask(part)) return;
    pushOntoNodePath(&part);
    part.traverse(*this);
    popFromNodePath();
}

void CompensatingCullVisitor::apply(osg::LOD& node)
{
    if (_mode.ours && _task.compensate && cullsByPicture() && isPlain(node))
    {
        applyBlock(node);
        return;
    }
    // As in applyBlock(): a part of a tile is never left out for being small.
    _mayBeSmall = _sight.cullsSmall() && TileInfo::meshesOf(node);
    const Scope scope(*this, node);
    _mayBeSmall = false;
    if (scope.skip()) return;
    if (!_mode.ours || !_task.compensate)
    {
        CullVisitor::apply(node);
        return;
    }
    if (belowHorizon(node)) return;
    meetLevels(node);
    // The mesh and its box lie elsewhere in memory; where the middle shows they have nothing to tell.
    if (_mode.planes && !_sight.holds(_middle, _mode.planes) &&
        tileOutOfSight(_sight, *_mode.chain, node, viewMatrix(), _task.tileError, _mode.planes))
        return;
    _mode.lodRadius = static_cast<double>(node.getBound().radius()) * _scale;
    _mode.lodLimit = _mode.chain->lodLimit(node, eyeBall(node.getBound()));
    if (node.getRangeMode() != osg::LOD::PIXEL_SIZE_ON_SCREEN)
    {
        applyLevels(node);
        return;
    }
    // OSG divides the undeformed size in pixels by the LOD scale; the scale makes it the deformed one.
    const float former = getLODScale();
    const Ball ball = eyeBall(node.getBound());
    const Ball deformed = _mode.chain->bound(ball);
    const double undeformedSize = static_cast<double>(clampedPixelSize(node.getBound()));
    const double deformedSize =
        std::abs(ball.radius / _sight.radiusOfPixel(deformed.center)) * _mode.chain->detail(ball);
    if (deformedSize > 0.0 && std::isfinite(undeformedSize / deformedSize))
    {
        setLODScale(static_cast<float>(static_cast<double>(former) * undeformedSize / deformedSize));
    }
    applyLevels(node);
    setLODScale(former);
}

bool CompensatingCullVisitor::belowHorizon(const osg::LOD& node)
{
    if (!_horizon || _mode.chain != _task.chain) return false;
    const auto* callback = dynamic_cast<const osg::ClusterCullingCallback*>(node.getCullCallback());
    return callback && _horizon.hides(*callback, viewMatrix(), eyeBall(node.getBound())) &&
           !_undeformedParts.below(node, _programs, _frame);
}

void CompensatingCullVisitor::applyLevels(osg::LOD& node)
{
    if (_task.asksForTiles || !isPlainPaged(node))
    {
        CullVisitor::apply(node);
        return;
    }
    // As the base class and osg::PagedLOD have it, but for the time at which a tile was seen: by that, it would be kept in memory.
    pushCurrentMask();
    osg::StateSet* state = node.getStateSet();
    if (state) pushStateSet(state);
    const bool byDistance = node.getRangeMode() == osg::LOD::DISTANCE_FROM_EYE_POINT;
    const float range = byDistance ? getDistanceToViewPoint(node.getCenter(), true)
                                   : clampedPixelSize(node.getBound()) / getLODScale();
    const unsigned int count = node.getNumChildren();
    unsigned int last = count;
    bool lacks = false;
    for (unsigned int i = 0; i < node.getNumRanges(); ++i)
    {
        if (range < node.getMinRange(i) || range >= node.getMaxRange(i)) continue;
        lacks = lacks || i >= count;
        if (i >= count) continue;
        node.getChild(i)->accept(*this);
        last = i;
    }
    if (lacks && count > 0 && last != count - 1) node.getChild(count - 1)->accept(*this);
    if (state) popStateSet();
    popCurrentMask();
}

osg::Vec3 CompensatingCullVisitor::raisedViewPoint() const
{
    // As far above the eye as a thousand Earths are wide: all of the globe's side below is in sight.
    constexpr double high = 1e10;
    const osg::Vec3d& up = _task.view->up;
    return osg::Vec3((_task.image ? osg::Matrixd::transform3x3(up, _task.image->toEye) : up) * high);
}

bool CompensatingCullVisitor::boxOutOfSight(const EyeBox& box)
{
    return _horizon.hides(box.ball()) || _sight.outOfSight(*_task.chain, box, _sight.all());
}

std::array<double, 4> CompensatingCullVisitor::pictureSides() const
{
    std::array<double, 4> sides;
    sides.fill(HUGE_VAL);
    const osg::Matrixd& p = _sight.picture().projection();
    const bool upright = p(0, 1) == 0.0 && p(1, 0) == 0.0 && p(0, 3) == 0.0 && p(1, 3) == 0.0 &&
                         p(2, 3) < 0.0 && p(3, 3) == 0.0 && p(3, 0) == 0.0 && p(3, 1) == 0.0;
    if (_task.image || !upright || !cullsByPicture()) return sides;
    for (int axis = 0; axis < 2; ++axis)
    {
        const double scale = std::abs(p(axis, axis));
        const double low = (-p(2, 3) - p(2, axis)) / scale, high = (-p(2, 3) + p(2, axis)) / scale;
        sides[static_cast<std::size_t>(2 * axis)] = p(axis, axis) > 0.0 ? low : high;
        sides[static_cast<std::size_t>(2 * axis + 1)] = p(axis, axis) > 0.0 ? high : low;
    }
    return sides;
}

osg::Vec3 CompensatingCullVisitor::setProxy(const osg::Matrixd& modelView)
{
    const ViewGeometry& view = *_task.view;
    const osg::Vec3d up = _task.image ? osg::Matrixd::transform3x3(view.up, _task.image->toEye) : view.up;
    const Ground& ground = view.ground;
    const double movement =
        ground.heightsKnown ? _task.chain->verticalMovement(ground.minHeight, ground.maxHeight) : HUGE_VAL;
    const ProxyFrustum::Terrain terrain = {
        _task.bound,    modelView, _task.image ? _task.image->toView : osg::Matrixd(), up, view.ground,
        pictureSides(), movement};
    const ProxyFrustum proxy(
        terrain, [this](const EyeBox& box) { return boxOutOfSight(box); },
        [this](const EyeBox& box) { return _sight.depthsOf(*_task.chain, box); },
        [this](const EyeBox& box) { return _task.chain->movesVertically(box.ball()); });
    _proxy = createOrReuseMatrix(proxy.projection());
    _proxyDepths = proxy.depths();
    _farthestGround = proxy.farthestGround();
    // Bounds of large boxes are loose. No deformation makes a globe larger than some Earths.
    constexpr double earths = 4.0;
    if (view.ground.ellipsoid)
        _proxyDepths.second = std::min(_proxyDepths.second,
                                       earths * view.ground.ellipsoid->getRadiusEquator() + view.eyeHeight);
    return proxy.viewPoint() ? osg::Vec3(*proxy.viewPoint()) : raisedViewPoint();
}

osg::Vec3d CompensatingCullVisitor::viewPoint() const
{
    // In eye space: the origin but for cameras that inherit another one's. All images of a view have the view's own
    // levels of detail.
    return _task.image ? osg::Vec3d() : _outerViewPoint;
}

float CompensatingCullVisitor::getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const
{
    if (!_mode.ours || !_task.compensate) return CullVisitor::getDistanceToViewPoint(position, withLodScale);
    const Ball ball = {inView(osg::Vec3d(position)), _mode.lodRadius};
    const double distance = _mode.chain->lodDistance(ball, viewPoint());
    return static_cast<float>(
        std::min(withLodScale ? distance * static_cast<double>(getLODScale()) : distance, _mode.lodLimit));
}

float CompensatingCullVisitor::getDistanceToEyePoint(const osg::Vec3& position, bool withLodScale) const
{
    if (!_mode.ours || !_task.compensate) return CullVisitor::getDistanceToEyePoint(position, withLodScale);
    const Ball ball = {inView(osg::Vec3d(position)), _mode.lodRadius};
    const double distance = _mode.chain->lodDistance(ball, osg::Vec3d());
    return static_cast<float>(withLodScale ? distance * static_cast<double>(getLODScale()) : distance);
}

float CompensatingCullVisitor::getDistanceFromEyePoint(const osg::Vec3& position, bool withLodScale) const
{
    if (!_mode.ours || !_task.compensate) return CullVisitor::getDistanceFromEyePoint(position, withLodScale);
    const osg::Vec3d deformed = _mode.chain->deform(inView(osg::Vec3d(position)));
    return static_cast<float>(withLodScale ? -deformed.z() * static_cast<double>(getLODScale())
                                           : -deformed.z());
}

} // namespace osgGeoFX
