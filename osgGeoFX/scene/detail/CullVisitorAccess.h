// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/CullVisitor>

#include <vector>

namespace osgGeoFX
{

/// Members of OSG's cull visitor that have no accessors; a pointer to member may be formed in a derived class.
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
    static osgUtil::RenderBin*& bin(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&CullVisitorAccess::_currentRenderBin);
    }
};

} // namespace osgGeoFX
