// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec4>

#include <optional>
#include <string>

namespace osgGeoFX
{

/** The colors of words in files. Thread-safe.

    @ingroup raster */
class ColorNames
{
public:
    /// The names of the X Window System, as GMT has them: "darkgreen", "tomato3", "gray50". Case and spaces do not
    /// matter. Opaque, 0…1; empty for other words.
    static std::optional<osg::Vec4> x11(const std::string& name);

    /// "#rgb", "#rrggbb" or "#rrggbbaa"; empty for other words.
    static std::optional<osg::Vec4> hexadecimal(const std::string& word);
};

} // namespace osgGeoFX
