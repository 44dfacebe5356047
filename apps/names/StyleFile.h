// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/lines/LineStyle.h>

#include <map>
#include <string>

namespace geofx::names
{

/// How names and lines look.
struct Styles
{
    std::map<std::string, osgGeoFX::NameStyle> names = osgGeoFX::usualNameStyles();
    std::map<std::string, osgGeoFX::LineStyle> lines = osgGeoFX::usualLineStyles();
    std::string lineField; ///< the field of a line file that names the style; empty: the usual ones
};

/// The styles of a JSON file over the usual ones; the usual ones if `file` is empty. Throws std::runtime_error with a sentence.
Styles readStyles(const std::string& file);

} // namespace geofx::names
