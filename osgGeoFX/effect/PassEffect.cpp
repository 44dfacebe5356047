// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/PassEffect.h>

#include <osgGeoFX/paging/TileGuard.h>

namespace osgGeoFX
{

PassEffect::~PassEffect() = default;

void PassEffect::forget(const osg::Group&) {}

osg::ref_ptr<TileListener> PassEffect::tileListener(const Ground&)
{
    return nullptr;
}

} // namespace osgGeoFX
