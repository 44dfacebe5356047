// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// Prints a warning, "osgGeoFX: " and the sentence, if no sentence of these words was printed before. For odd data with which a
/// reader goes on. Thread-safe.
void remarkOnce(const std::string& sentence);

} // namespace osgGeoFX
