// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/compare/Compare.h>

#include <gtest/gtest.h>
#include <osg/Image>

#include <filesystem>
#include <string>

namespace geofx::test
{

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
