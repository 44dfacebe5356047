// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/AheadVisitor.h>

#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/detail/TileSight.h>

#include <osg/ClusterCullingCallback>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

/// For as long as a node is visited.
class AheadVisitor::Scope
{
public:
    Scope(AheadVisitor& visitor, const osg::Node& node) : _visitor(visitor), _former(visitor._mode)
    {
        visitor._mode.deformation.meet(node.getStateSet());
        skip = visitor.outOfSight(node);
    }
    ~Scope() { _visitor._mode = _former; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

    bool skip = false;

private:
    AheadVisitor& _visitor;
    const Mode _former;
};

AheadVisitor::AheadVisitor() : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN) {}

AheadVisitor::~AheadVisitor() = default;

void AheadVisitor::begin(const Outlook& outlook, unsigned int frame)
{
    _outlook = outlook;
    _frame = frame;
    _mode = Mode();
    place({});
    const ViewGeometry::Image& image = _outlook.view.image;
    Visibility::Camera camera;
    camera.projection = image.ofView ? _outlook.view.projection : image.projection;
    camera.image = image.ofView ? nullptr : &image;
    camera.viewport = _outlook.viewport.get();
    camera.sides = _outlook.sides;
    // Those of a camera that has not been culled are not known.
    camera.nearPlane = camera.farPlane = false;
    if (_outlook.sides)
    {
        _planes.setToUnitFrustum(false, false);
        _planes.transformProvidingInverse(camera.projection);
        camera.planes = &_planes;
    }
    _sight.set(camera);
    _mode.planes = _sight.all();
}

void AheadVisitor::place(const osg::Matrixd& model)
{
    _mode.model = model;
    _mode.toView = model * _outlook.view.modelView;
    _mode.scale = largestScale(_mode.toView);
}

Ball AheadVisitor::ballOf(const osg::Node& node) const
{
    const osg::BoundingSphere& sphere = node.getBound();
    return {osg::Vec3d(sphere.center()) * _mode.toView, static_cast<double>(sphere.radius()) * _mode.scale};
}

bool AheadVisitor::outOfSight(const osg::Node& node)
{
    if (!node.isCullingActive())
    {
        _mode.planes = _sight.all();
        return false;
    }
    if (!_mode.planes || !node.getBound().valid()) return false;
    const Ball ball = ballOf(node);
    return _sight.hides(chain(), ball) || _sight.outOfSight(chain().bound(ball), _mode.planes, true);
}

bool AheadVisitor::belowHorizon(const osg::Node& node)
{
    const auto* horizon = dynamic_cast<const osg::ClusterCullingCallback*>(node.getCullCallback());
    return horizon && _outlook.horizons && chain().empty() && horizon->cull(this, nullptr, nullptr);
}

double AheadVisitor::rangeFor(const osg::LOD& node) const
{
    const Ball ball = {osg::Vec3d(node.getCenter()) * _mode.toView,
                       static_cast<double>(node.getBound().radius()) * _mode.scale};
    if (node.getRangeMode() != osg::LOD::PIXEL_SIZE_ON_SCREEN)
        return std::min(chain().lodDistance(ball, osg::Vec3d()) * _outlook.lodScale,
                        chain().lodLimit(node, ballOf(node)));
    const Ball whole = ballOf(node);
    const double pixel = std::abs(_sight.radiusOfPixel(chain().bound(whole).center));
    return whole.radius / std::max(pixel, 1e-30) * chain().detail(whole) / _outlook.lodScale;
}

bool AheadVisitor::wants(const Missing& missing)
{
    const Mode former = _mode;
    _mode.planes = _sight.all();
    place(missing.model);
    const bool sees = !outOfSight(missing.group) && !belowHorizon(missing.group) &&
                      !(_outlook.compensates && _mode.planes &&
                        tileOutOfSight(_sight, chain(), missing.group, _mode.toView,
                                       _outlook.view.ground.tileError, _mode.planes));
    const double range = sees ? rangeFor(missing.group) : 0.0;
    _mode = former;
    return sees && static_cast<double>(missing.group.getMinRange(missing.child)) <= range &&
           range < static_cast<double>(missing.group.getMaxRange(missing.child));
}

void AheadVisitor::apply(osg::Node& node)
{
    const Scope scope(*this, node);
    if (!scope.skip) traverse(node);
}

void AheadVisitor::apply(osg::Transform& node)
{
    // A tile of the kit's has meshes alone.
    if (TileInfo::isTile(node) && node.getUserDataContainer()) return;
    const Scope scope(*this, node);
    if (scope.skip) return;
    osg::Matrixd local;
    node.computeLocalToWorldMatrix(local, this);
    place(node.getReferenceFrame() == osg::Transform::RELATIVE_RF
              ? local * _mode.model
              : local * osg::Matrixd::inverse(_outlook.view.modelView));
    traverse(node);
}

void AheadVisitor::apply(osg::LOD& node)
{
    if (TileInfo::meshesOf(node)) return;
    const Scope scope(*this, node);
    if (scope.skip) return;
    const double range = rangeFor(node);
    for (unsigned int i = 0; i < node.getNumChildren() && i < node.getNumRanges(); ++i)
    {
        if (static_cast<double>(node.getMinRange(i)) <= range &&
            range < static_cast<double>(node.getMaxRange(i)))
            node.getChild(i)->accept(*this);
    }
}

void AheadVisitor::apply(osg::PagedLOD& node)
{
    const Scope scope(*this, node);
    if (scope.skip || belowHorizon(node) ||
        (_outlook.compensates && _mode.planes &&
         tileOutOfSight(_sight, chain(), node, _mode.toView, _outlook.view.ground.tileError, _mode.planes)))
        return;
    const double range = rangeFor(node);
    const unsigned int there = node.getNumChildren();
    // As osg::PagedLOD::traverse() has it. The frame's number is enough for the pager; the time stamps tell what has been seen.
    node.setFrameNumberOfLastTraversal(_frame);
    const auto visit = [&](unsigned int child)
    {
        if (child < node.getNumFileNames()) node.setFrameNumber(child, _frame);
        node.getChild(child)->accept(*this);
    };
    bool lacks = false, visitedLast = false;
    for (unsigned int i = 0; i < node.getNumRanges(); ++i)
    {
        if (static_cast<double>(node.getMinRange(i)) > range ||
            range >= static_cast<double>(node.getMaxRange(i)))
            continue;
        if (i >= there)
        {
            lacks = true;
            continue;
        }
        visit(i);
        visitedLast = i + 1 == there;
    }
    if (!lacks) return;
    if (there > 0 && !visitedLast) visit(there - 1);
    if (there >= node.getNumFileNames() || there >= node.getNumRanges() || node.getFileName(there).empty() ||
        node.getDisableExternalChildrenPaging())
        return;
    const auto nearest = static_cast<double>(node.getMinRange(there)),
               farthest = static_cast<double>(node.getMaxRange(there));
    const double share = (farthest - range) / (farthest - nearest);
    const double sign = node.getRangeMode() == osg::LOD::PIXEL_SIZE_ON_SCREEN ? -1.0 : 1.0;
    const float priority =
        node.getPriorityOffset(there) + static_cast<float>(sign * share) * node.getPriorityScale(there);
    found({node, there, priority, _mode.model});
}

osg::Vec3 AheadVisitor::getViewPoint() const
{
    return osg::Matrixd::inverse(_mode.toView).getTrans();
}

float AheadVisitor::getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const
{
    const double distance = chain().lodDistance({osg::Vec3d(position) * _mode.toView, 0.0}, osg::Vec3d());
    return static_cast<float>(withLodScale ? distance * _outlook.lodScale : distance);
}

} // namespace osgGeoFX
