// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/Effect.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// The names of the kit's effects as people write them in scene files and options: "birdsEyeView", …
OSGGEOFX_EXPORT std::vector<std::string> effectKinds();

/// A new effect with its defaults; null where there is no such kind.
OSGGEOFX_EXPORT osg::ref_ptr<Effect> createEffect(const std::string& kind);

/// The kind's name of an effect; its class name where it is none of the kit's.
OSGGEOFX_EXPORT std::string kindOf(const osg::Object& object);

/// Why an effect draws nothing as it is, with the remedy: close-ups without one, mappings without one. Empty where nothing
/// keeps it from drawing.
OSGGEOFX_EXPORT std::string whyItDrawsNothing(const Effect& effect);

/// An effect from one line: "birdsEyeView focusLine=0.3 horizonLine=0.9". Null, with a sentence in `error`, where
/// it says something that makes no sense, and for the effects that a line cannot say all of (whyItDrawsNothing()).
OSGGEOFX_EXPORT osg::ref_ptr<Effect> parseEffect(const std::string& text, std::string& error);

} // namespace osgGeoFX
