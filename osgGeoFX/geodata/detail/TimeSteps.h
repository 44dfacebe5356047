// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Rasters in time, before they are brought anywhere. All of it throws BuildError. For one thread at a time.
class TimeSteps
{
public:
    virtual ~TimeSteps();
    /// Those of a file, or of a folder of files. `variable`: of a data set of several dimensions; empty for the first that fits.
    static std::unique_ptr<TimeSteps> open(const std::string& file, const std::string& variable);

    virtual std::unique_ptr<FrameRaster> step(std::size_t index) = 0;

    std::vector<double> times;
    bool dated = false; ///< seconds since 1970
    std::string variable;
    std::string unit;
};

/// The factor to seconds and the second of 1970 of a text such as "hours since 2026-01-12 06:00:00"; nothing for other texts.
struct TimeUnit
{
    double seconds = 1.0;
    double start = 0.0;

    static std::optional<TimeUnit> parse(const std::string& text);
};

/// The date in a file's name or in a band's description, seconds since 1970; nothing if there is none.
std::optional<double> dateIn(const std::string& text);

} // namespace osgGeoFX
