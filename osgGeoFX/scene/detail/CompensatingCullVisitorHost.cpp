// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Cull visitors of hosts, which do more than OSG's: what they do for their own nodes and drawables goes on.
#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

#include <osgGeoFX/scene/detail/CullVisitorAccess.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iterator>
#include <typeinfo>

namespace osgGeoFX
{

bool CompensatingCullVisitor::comesWithOsg(const osg::Object* object)
{
    static const char* const libraries[] = {"osg",         "osgText", "osgSim",       "osgTerrain",
                                            "osgParticle", "osgFX",   "osgAnimation", "osgGeoFX"};
    const char* const own = object->libraryName();
    const auto library = std::find_if(std::begin(libraries), std::end(libraries),
                                      [own](const char* each) { return std::strcmp(own, each) == 0; });
    if (library == std::end(libraries)) return false;
    // A class of a host's that does not say its library has that of its base class, but not its namespace. A name between
    // letters is part of another one, as in osgEarth.
    const char* const name = typeid(*object).name();
    const char* const found = std::strstr(name, *library);
    return found && !std::isalpha(static_cast<unsigned char>(found[std::strlen(*library)]));
}

void CompensatingCullVisitor::setHost(osgUtil::CullVisitor& outer)
{
    _host = typeid(outer) == typeid(osgUtil::CullVisitor) ? nullptr : &outer;
}

template<typename NodeType>
void CompensatingCullVisitor::lend(NodeType& node, bool traverses, bool culls)
{
    osgUtil::CullVisitor& host = *_host;
    osgUtil::StateGraph* const graph = CullVisitorAccess::graph(host);
    osgUtil::RenderBin* const bin = CullVisitorAccess::bin(host);
    const std::vector<osgUtil::RenderBin*> bins = CullVisitorAccess::bins(host);
    const unsigned int overrides = CullVisitorAccess::overrides(host);
    const osg::NodePath path = host.getNodePath();
    const ComputeNearFarMode nearFar = host.getComputeNearFarMode();
    const TraversalMode mode = host.getTraversalMode();

    CullVisitorAccess::graph(host) = _currentStateGraph;
    CullVisitorAccess::bin(host) = _currentRenderBin;
    CullVisitorAccess::bins(host) = _renderBinStack;
    CullVisitorAccess::overrides(host) = _numberOfEncloseOverrideRenderBinDetails;
    CullVisitorAccess::order(host) = _traversalOrderNumber;
    host.getNodePath() = getNodePath();
    host.pushModelViewMatrix(getModelViewMatrix(), osg::Transform::RELATIVE_RF);
    if (!culls)
    {
        // It would cull what is drawn elsewhere, and take its depth.
        host.getCurrentCullingSet().setCullingMask(NO_CULLING);
        CullVisitorAccess::nearFarMode(host) = DO_NOT_COMPUTE_NEAR_FAR;
    }
    if (!traverses) host.setTraversalMode(TRAVERSE_NONE);

    host.apply(node);

    _traversalOrderNumber = CullVisitorAccess::order(host);
    host.setTraversalMode(mode);
    host.popModelViewMatrix();
    CullVisitorAccess::nearFarMode(host) = nearFar;
    host.getNodePath() = path;
    CullVisitorAccess::overrides(host) = overrides;
    CullVisitorAccess::bins(host) = bins;
    CullVisitorAccess::bin(host) = bin;
    CullVisitorAccess::graph(host) = graph;
}

template<typename NodeType>
bool CompensatingCullVisitor::drawByHost(NodeType& node)
{
    if (!_host || !_mode.ours || comesWithOsg(&node)) return false;
    // Below a state of its own, so that its leaves are told from ours.
    pushStateSet(_ofHost);
    lend(node, true, false);
    popStateSet();
    return true;
}

template<typename NodeType>
void CompensatingCullVisitor::tellHost(NodeType& node)
{
    // Once in a frame: what a host collects there it would collect again in each pass.
    if (_host && _mode.ours && _task.findsNearAndFar && !comesWithOsg(&node)) lend(node, false, false);
}

template<typename NodeType>
void CompensatingCullVisitor::passToHost(NodeType& node)
{
    if (_host)
        lend(node, true, true);
    else
        CullVisitor::apply(node);
}

template bool CompensatingCullVisitor::drawByHost(osg::Node&);
template bool CompensatingCullVisitor::drawByHost(osg::Geode&);
template bool CompensatingCullVisitor::drawByHost(osg::Drawable&);
template void CompensatingCullVisitor::tellHost(osg::Group&);
template void CompensatingCullVisitor::passToHost(osg::Camera&);
template void CompensatingCullVisitor::passToHost(osg::Projection&);

} // namespace osgGeoFX
