// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/lines/LineStyle.h>

#include <cmath>
#include <map>
#include <string>

namespace osgGeoFX
{

/** How the names and lines of a map look: the usual styles, and what style files and fonts change of them. A plain value.

    A style file is JSON, such as `{"names": {"peak": {"size": 16}}, "lines": {"river": {"width": 2}}}`. A style that is new begins as the
    usual one.
    @ingroup map */
struct OSGGEOFXMAPS_EXPORT MapStyles
{
    std::map<std::string, NameStyle> names = usualNameStyles();
    std::map<std::string, LineStyle> lines = usualLineStyles();
    /// The least importance of names in the context of a bend (NameSet::setContextImportance()); −∞: all names.
    double contextImportance = -HUGE_VAL;
    std::string nameField; ///< the field of a name file that has the names; empty: the usual ones
    std::string lineField; ///< the field of a line file that names the style; empty: the usual ones

    /// Changes the styles as a style file says. False, with a sentence in `error`, if it cannot be read or says what is not known; then
    /// nothing is changed.
    bool read(const std::string& file, std::string& error);

    /// Puts font families before those of all names' styles.
    void preferFont(const std::string& families);
    /// The same for the font of a file. False, with a sentence in `error`, if the file has no font. Call it before the first text is laid out.
    bool preferFontFile(const std::string& file, std::string& error);
};

} // namespace osgGeoFX
