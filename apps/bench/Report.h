// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Figure.h"
#include "Machine.h"
#include "Suite.h"

#include <ostream>
#include <string>
#include <vector>

namespace geofx::bench
{

struct SuiteResult
{
    std::string suite;
    std::vector<Figure> figures;
};

/// Whether each figure that is asked for has been reached.
bool allReached(const std::vector<SuiteResult>& results);

void printTable(std::ostream& out, const Machine& machine, const std::vector<SuiteResult>& results);

/// The same as JSON. Nothing in it tells when or where it was measured, so two files can be compared.
nlohmann::ordered_json toJson(const Machine& machine, const Settings& settings,
                              const std::vector<SuiteResult>& results);

} // namespace geofx::bench
