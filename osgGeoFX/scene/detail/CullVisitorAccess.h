// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/CullVisitor>

#include <vector>

namespace osgGeoFX
{

/// Members of OSG's cull visitor that have no accessors, or whose setters keep the visitor from inheriting the camera's settings in
/// later frames. A pointer to member may be formed in a derived class.
struct CullVisitorAccess : public osgUtil::CullVisitor
{
    static unsigned int& order(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_traversalOrderNumber);
    }
    static unsigned int& overrides(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_numberOfEncloseOverrideRenderBinDetails);
    }
    static std::vector<osgUtil::RenderBin*>& bins(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_renderBinStack);
    }
    static osgUtil::StateGraph*& graph(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_currentStateGraph);
    }
    static osg::ref_ptr<ClampProjectionMatrixCallback>& clampCallback(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_clampProjectionMatrixCallback);
    }
    static ComputeNearFarMode& nearFarMode(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_computeNearFar);
    }
    static osgUtil::RenderBin*& bin(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_currentRenderBin);
    }
};

} // namespace osgGeoFX
