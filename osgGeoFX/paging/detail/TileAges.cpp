// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/TileAges.h>

#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/detail/StandIn.h>

#include <algorithm>
#include <tuple>

namespace osgGeoFX
{

namespace
{

constexpr double FOREVER = 1e12; ///< seconds

} // namespace

osg::Node* TileAges::Child::node() const
{
    osg::Node* child = group->getChild(index);
    auto* standIn = dynamic_cast<StandIn*>(child);
    return standIn && standIn->getNumChildren() > 0 ? standIn->getChild(0) : child;
}

void TileAges::Child::expire() const
{
    free();
    group->setFrameNumber(index, 0);
}

void TileAges::Child::free() const
{
    group->setMinimumExpiryTime(index, 0.0);
    group->setMinimumExpiryFrames(index, 0);
}

TileAges::TileAges(unsigned int frame) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _frame(frame)
{
    setNodeMaskOverride(~0u);
}

void TileAges::apply(osg::Transform& node)
{
    // A tile of the kit's has meshes alone.
    if (!TileInfo::isTile(node) || !node.getUserDataContainer()) traverse(node);
}

void TileAges::apply(osg::LOD& node)
{
    if (!TileInfo::meshesOf(node)) traverse(node);
}

void TileAges::apply(osg::PagedLOD& node)
{
    const Age beside = _below;
    _below = Age();
    ++_depth;
    traverse(node);
    --_depth;
    const unsigned int count = node.getNumChildren();
    if (count > node.getNumChildrenThatCannotBeExpired() && count <= node.getNumFileNames() &&
        !node.getFileName(count - 1).empty())
    {
        Child child;
        child.group = &node;
        child.index = count - 1;
        child.seen = std::max(_below.seen, node.getTimeStamp(child.index));
        child.ahead = _below.ahead || node.getFrameNumber(child.index) + 1 >= _frame;
        child.depth = _depth;
        node.setMinimumExpiryTime(child.index, FOREVER);
        _children.push_back(child);
        _below = {child.seen, child.ahead};
    }
    _below = {std::max(_below.seen, beside.seen), _below.ahead || beside.ahead};
}

std::vector<TileAges::Child> TileAges::sorted()
{
    std::sort(
        _children.begin(), _children.end(),
        [](const Child& a, const Child& b)
        { return std::make_tuple(a.ahead, a.seen, b.depth) < std::make_tuple(b.ahead, b.seen, a.depth); });
    return _children;
}

} // namespace osgGeoFX
