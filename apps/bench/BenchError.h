// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <stdexcept>

namespace geofx::bench
{

/// Why nothing can be measured, as a whole sentence with the remedy.
class BenchError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

} // namespace geofx::bench
