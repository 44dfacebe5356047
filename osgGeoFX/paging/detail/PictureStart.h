// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <optional>
#include <string>

namespace osgGeoFX
{

/// What the first bytes of a picture say.
struct PictureStart
{
    const char* reader = ""; ///< the extension for which OSG's plugin is asked
    double bytes = 0.0;      ///< of all pixels when they are unpacked, at most
};

/// Nothing where the content is not PNG, JPEG, GIF, BMP or DDS.
std::optional<PictureStart> pictureStartOf(const std::string& content);

} // namespace osgGeoFX
