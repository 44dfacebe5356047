// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/Visibility.h>

#include <osg/LOD>

namespace osgGeoFX
{

/** Whether a paged tile of the kit's databases, with all that is finer, is out of sight. False for other nodes.

    The sphere of a flat tile is wide; this looks at its box. `toView`: from the node's frame to the view's eye space. `tileError`:
    Ground::tileError; where it is 0, nothing is known of finer tiles. */
bool tileOutOfSight(Visibility& sight, const DeformationChain& chain, const osg::LOD& node,
                    const osg::Matrixd& toView, double tileError, Visibility::Mask planes);

} // namespace osgGeoFX
