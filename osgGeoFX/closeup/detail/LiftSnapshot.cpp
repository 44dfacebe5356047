// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/LiftSnapshot.h>

#include <algorithm>

namespace osgGeoFX
{

LiftSnapshot::LiftSnapshot(const CloseUpItem& item) : _lift(item.lift())
{
    const CloseUp& closeUp = item.closeUp();
    _stretch = std::max({closeUp.getScaleX(), closeUp.getScaleY(), closeUp.getScaleHeight()});
    // The lift of a flat map has no inverse. Without one, levels of detail take its heights as its plane's scale
    // would make them.
    if (closeUp.getScaleHeight() > 0.0) _back = osg::Matrixd::inverse(_lift);
}

LiftSnapshot::~LiftSnapshot() = default;

} // namespace osgGeoFX
