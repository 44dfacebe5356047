// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/StandIn.h>

namespace osgGeoFX
{

StandIn::StandIn(osg::Node* shown) : _shown(shown) {}

StandIn::~StandIn() = default;

void StandIn::askAgain(const std::string& file, const osgDB::Options* options, Clock::time_point time)
{
    _file = file;
    _options = options;
    _time = time;
}

void StandIn::askLater(Clock::time_point time)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _time = time;
}

osg::BoundingSphere StandIn::computeBound() const
{
    osg::BoundingSphere bound = osg::Group::computeBound();
    if (_shown) bound.expandBy(_shown->getBound());
    return bound;
}

void StandIn::traverse(osg::NodeVisitor& visitor)
{
    // Visitors of all children (compiling, optimising, writing) reach the parent's child through the parent.
    if (getNumChildren() > 0 || visitor.getTraversalMode() != osg::NodeVisitor::TRAVERSE_ACTIVE_CHILDREN)
    {
        osg::Group::traverse(visitor);
        return;
    }
    if (_shown) _shown->accept(visitor);
    if (visitor.getVisitorType() == osg::NodeVisitor::CULL_VISITOR && visitor.getDatabaseRequestHandler())
        ask(visitor);
}

void StandIn::ask(osg::NodeVisitor& visitor)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_file.empty() || Clock::now() < _time) return;
    // In each frame, as a PagedLOD does: the pager forgets what nobody asks for any more.
    visitor.getDatabaseRequestHandler()->requestNodeFile(_file, visitor.getNodePath(), 0.0f,
                                                         visitor.getFrameStamp(), _request, _options);
}

} // namespace osgGeoFX
