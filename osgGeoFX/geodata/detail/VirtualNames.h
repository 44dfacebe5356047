// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>
#include <vector>

namespace osgGeoFX
{

/// The files that virtual rasters and virtual vector data name in their XML.
struct VirtualNames
{
    /// All names in the XML of `file`, in their order, as GDAL takes them; none if it is no XML.
    static std::vector<std::string> in(const std::string& xml, const std::string& file);
    /// What GDAL makes of a name in `file`. `beside`: whether the name is relative to it. Network addresses and GDAL's own names stay.
    static std::string complete(const std::string& name, bool beside, const std::string& file);
};

} // namespace osgGeoFX
