// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <cstddef>
#include <memory>
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
    /// Behind its name, brackets may choose among levels, members and other dimensions, by their values: "t[level=500,number=2]".
    /// Of a dimension that is not named the first value counts, which a warning states.
    /// `bands`: what the pictures of a folder show.
    static std::unique_ptr<TimeSteps> open(const std::string& file, const std::string& variable,
                                           const RasterBands& bands = {});

    /// The first step of a variable, which needs no time, for readers of single rasters; brackets may choose a time as well. Empty if the
    /// file is no data set of several dimensions.
    static DatasetChain first(const std::string& file, const std::string& variable);

    /// Whether a variable has its columns before its rows. GDAL's readers of rasters take it for turned.
    static bool hasColumnsFirst(const std::string& file, const std::string& variable);

    virtual std::unique_ptr<FrameRaster> step(std::size_t index) = 0;

    std::vector<double> times;
    bool dated = false; ///< seconds since 1970
    std::string variable;
    std::string unit;
};

} // namespace osgGeoFX
