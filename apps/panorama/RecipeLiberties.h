// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "panorama/Recipe.h"

#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <map>
#include <string>
#include <vector>

namespace geofx::panorama
{

/// A liberty as a recipe has it.
std::map<std::string, std::string> textsOf(const osgGeoFX::RegionalLiberty& liberty);

/// Throws Failure if a command line's liberties cannot be meant: `strength` of --liberties, and `own` of each --liberty.
void checkLiberties(const std::string& strength, const std::vector<std::string>& own);

/// Puts the liberties that a recipe's view asks for, and a person's own, into the recipe, with the reasons.
/// `strength`: empty for none but the own ones.
void takeLiberties(const std::string& strength, const std::vector<std::string>& own,
                   const osgGeoFX::PanoramaComposer& composer, Recipe& recipe);
void takeOwnLiberties(const std::vector<std::string>& own, Recipe& recipe);

/// Adds a recipe's liberties to a scene, after its effects.
void addLiberties(const Recipe& recipe, osgGeoFX::EffectScene& scene);

} // namespace geofx::panorama
