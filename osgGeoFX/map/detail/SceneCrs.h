// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>

#include <string>

namespace osgGeoFX
{

/// The coordinate system of a projected scene, as WKT; empty if it states none. Paged files are not looked into.
std::string crsOfScene(osg::Node& node);

} // namespace osgGeoFX
