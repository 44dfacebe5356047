// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Figure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace geofx::bench
{

/// What the command line says to all suites. Paths are complete when a suite gets them.
struct Settings
{
    std::filesystem::path builder;  ///< osggeofx_build; empty where there is none
    std::filesystem::path inventor; ///< geofx_invent; empty where there is none
    std::filesystem::path data;     ///< the folder with oahu/
    std::filesystem::path work;     ///< where temporary folders are made
    std::filesystem::path terrain;  ///< a database to draw instead of one built for it; may be empty
    std::filesystem::path pictures; ///< where pictures of what was measured are written; empty for none
    std::filesystem::path osgEarth; ///< where osgEarth is installed; empty where it is not measured
    std::filesystem::path fuji;     ///< an elevation raster of Mount Fuji; may be empty
    std::vector<std::string> only;  ///< the groups of figures to measure; empty for all
    bool quick = false;             ///< smaller cases, for figures whose full case takes minutes
    bool smoke = false; ///< cases so small that the figures mean nothing; shows that the program works

    /// Whether a group of figures is to be measured.
    bool wants(const std::string& group) const;
};

/** One file for each suite; a suite is entered into the list in Suites.cpp.

    Its function measures one figure after the other and says on standard error what it is about. It throws
    BenchError where it cannot go on. */
struct Suite
{
    std::string name;
    std::string summary;
    std::vector<std::string> groups; ///< what --only may name
    std::vector<Figure> (*run)(const Settings& settings);
};

const std::vector<Suite>& suites();

/// Null where there is no such suite.
const Suite* findSuite(const std::string& name);

/// Tells people, on standard error, what is being done.
void announce(const std::string& text);

} // namespace geofx::bench
