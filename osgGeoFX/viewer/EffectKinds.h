// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/Effect.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// The names of the kit's effects as scene files and options use them: "birdsEyeView", …
OSGGEOFX_EXPORT std::vector<std::string> effectKinds();

/// Makes an effect with its default values. Returns null if there is no such kind.
OSGGEOFX_EXPORT osg::ref_ptr<Effect> createEffect(const std::string& kind);

/// The name of an object's kind: its class name with a small first letter, also for classes of other programs.
OSGGEOFX_EXPORT std::string kindOf(const osg::Object& object);

/// Why an effect draws nothing, with the remedy: close-ups without a close-up, mappings without a mapping. Empty if
/// nothing keeps it from drawing.
OSGGEOFX_EXPORT std::string whyItDrawsNothing(const Effect& effect);

/// Makes an effect from one line: "birdsEyeView focusLine=0.3 horizonLine=0.9". Returns null, with a sentence in
/// `error`, if the line is wrong or cannot describe the whole effect (whyItDrawsNothing()).
OSGGEOFX_EXPORT osg::ref_ptr<Effect> parseEffect(const std::string& text, std::string& error);

} // namespace osgGeoFX
