// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <optional>
#include <string>
#include <vector>

struct _cairo; // NOLINT(bugprone-reserved-identifier)

namespace osgGeoFX
{

/// The marks that SLD files name: those of the standard, of GeoServer (shape://…) and of QGIS.
struct MarkShapes
{
    /// The own name of a mark's well-known name; nothing for one that is not known.
    static std::optional<std::string> named(const std::string& wellKnownName);
    /// Whether a mark is a line, which is stroked and has no area. By its own name, as the next one.
    static bool isLine(const std::string& mark);
    /// The directions of the lines that a mark becomes when it fills an area, degrees, counter-clockwise from the right; none for marks that stay marks.
    static std::vector<double> hatches(const std::string& mark);
    /// A path of a mark, one unit high about the origin, y downwards.
    static void add(_cairo* context, const std::string& mark);
};

} // namespace osgGeoFX
