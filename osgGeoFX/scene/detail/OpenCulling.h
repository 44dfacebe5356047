// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/CullVisitor>

namespace osgGeoFX
{

/** Keeps a host's clamp callback from cutting off what lies between two depths, metres, for the rest of a visitor's frame.

    Hosts that know the horizon of an undeformed globe clamp the far plane to it. The callback still gets to set near and
    far, but never within these depths. */
void keepFromBeingCut(osgUtil::CullVisitor& visitor, double nearest, double farthest);

} // namespace osgGeoFX
