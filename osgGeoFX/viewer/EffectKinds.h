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

/// The kinds of all objects with properties: the effects, and what mappings and close-ups are made of
/// ("projectiveMapping", "closeUp", …).
OSGGEOFX_EXPORT std::vector<std::string> propertyHolderKinds();

/// Makes an object of such a kind with its default values. Returns null if there is no such kind.
OSGGEOFX_EXPORT osg::ref_ptr<PropertyHolder> createPropertyHolder(const std::string& kind);

/// What an object of a kind does or is, in a sentence or two. Empty if there is no such kind.
OSGGEOFX_EXPORT std::string describeKind(const std::string& kind);

/// What a program's help says of effects: each with its description and its properties, a line for each.
OSGGEOFX_EXPORT std::string effectsHelp();

/// The name of an object's kind: its class name with a small first letter, also for classes of other programs.
OSGGEOFX_EXPORT std::string kindOf(const osg::Object& object);

/// Why an effect draws nothing, with the remedy: close-ups without a close-up, mappings without a mapping. Empty if
/// nothing keeps it from drawing.
OSGGEOFX_EXPORT std::string whyItDrawsNothing(const Effect& effect);

/// Makes an effect from one line: "birdsEyeView focusLine=0.3 horizonLine=0.9". Returns null, with a sentence in
/// `error`, if the line is wrong or cannot describe the whole effect (whyItDrawsNothing()).
OSGGEOFX_EXPORT osg::ref_ptr<Effect> parseEffect(const std::string& text, std::string& error);

} // namespace osgGeoFX
