// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <gtest/gtest.h>
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

/** Compares two images. Where they differ by more than the tolerance the result is a failure whose
    message tells the worst pixel (counted from the upper left) and where actual, expected and difference
    lie as pictures: below GEOFX_BUILD_DIR/test-output/, in a folder named after the running test. The
    difference is amplified so that its largest value is white. `name` tells several comparisons of one
    test apart. Both must have the same size and channels. */
::testing::AssertionResult imagesMatch(const osg::Image& actual, const osg::Image& expected,
                                       const ImageTolerance& tolerance = {}, const std::string& name = "");

/// The same for two files of any kind that OpenImageIO reads.
::testing::AssertionResult imagesMatch(const std::filesystem::path& actual,
                                       const std::filesystem::path& expected,
                                       const ImageTolerance& tolerance = {}, const std::string& name = "");

/// The folder for what the running test leaves to be looked at; made if need be.
std::filesystem::path testOutputFolder();

} // namespace geofx::test
