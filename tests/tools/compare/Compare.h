// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>

#include <filesystem>
#include <string>

namespace geofx::test
{

/** How different two images may be, after OpenImageIO's idiff. Values are channel values, 0…1 for 8 bits. By
    default not at all. Say in a comment at the test why a tolerance is what it is. */
struct ImageTolerance
{
    float fail = 0.0f;     ///< a pixel with a channel further off than this has failed
    double share = 0.0;    ///< the share 0…1 of the pixels that may fail
    float hardFail = 0.0f; ///< no channel of any pixel may be further off than this
};

/** The comparison by OpenImageIO is a library that is loaded when a test compares its first pictures: OpenImageIO takes a fifth of a second to load,
    in each of a thousand tests' processes. */
struct Comparison
{
    ImageTolerance tolerance;
    std::filesystem::path folder; ///< for pictures of what differs
    std::string prefix;           ///< of their names
    bool same = false;            ///< the result, within the tolerance
    std::string message;          ///< where it is not
};

/// The types of the library's functions, geofx_compareImages and geofx_compareFiles.
using CompareImages = void (*)(const osg::Image& actual, const osg::Image& expected, Comparison& comparison);
using CompareFiles = void (*)(const std::filesystem::path& actual, const std::filesystem::path& expected,
                              Comparison& comparison);

} // namespace geofx::test
