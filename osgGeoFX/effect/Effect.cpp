// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/Effect.h>

#include <osgGeoFX/effect/SurfaceEffect.h>

namespace osgGeoFX
{

Effect::~Effect() = default;

SurfaceEffect::~SurfaceEffect() = default;

Property Effect::enabledProperty()
{
    return Property::flag("enabled", "whether the effect is in force").of<&Effect::_enabled>();
}

} // namespace osgGeoFX
