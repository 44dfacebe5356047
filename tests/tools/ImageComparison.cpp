// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/ImageComparison.h>

#include <dlfcn.h>

#include <algorithm>
#include <stdexcept>

namespace geofx::test
{

namespace
{

std::filesystem::path outputFolder()
{
    std::string name = "no-test";
    if (const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info())
    {
        name = std::string(test->test_suite_name()) + "." + test->name();
        std::replace(name.begin(), name.end(), '/', '_');
    }
    return std::filesystem::path(GEOFX_BUILD_DIR) / "test-output" / name;
}

/// A function of the library that compares.
void* functionOf(const char* name)
{
    static void* const library = dlopen(GEOFX_COMPARE_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    void* const function = library ? dlsym(library, name) : nullptr;
    if (!function)
        // dlerror() tells of each failure once, and this library is looked for once.
        throw std::runtime_error(std::string("Images cannot be compared: ") + GEOFX_COMPARE_LIBRARY +
                                 " cannot be loaded, or has no " + name +
                                 "; build the target geofx_compare.");
    return function;
}

Comparison prepared(const ImageTolerance& tolerance, const std::string& name)
{
    Comparison comparison;
    comparison.tolerance = tolerance;
    comparison.folder = outputFolder();
    comparison.prefix = name.empty() ? "" : name + "-";
    return comparison;
}

::testing::AssertionResult resultOf(const Comparison& comparison)
{
    if (comparison.same) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << comparison.message;
}

} // namespace

std::filesystem::path testOutputFolder()
{
    std::filesystem::path folder = outputFolder();
    std::filesystem::create_directories(folder);
    return folder;
}

::testing::AssertionResult imagesMatch(const osg::Image& actual, const osg::Image& expected,
                                       const ImageTolerance& tolerance, const std::string& name)
{
    Comparison comparison = prepared(tolerance, name);
    reinterpret_cast<CompareImages>(functionOf("geofx_compareImages"))(actual, expected, comparison);
    return resultOf(comparison);
}

::testing::AssertionResult imagesMatch(const std::filesystem::path& actual,
                                       const std::filesystem::path& expected, const ImageTolerance& tolerance,
                                       const std::string& name)
{
    Comparison comparison = prepared(tolerance, name);
    reinterpret_cast<CompareFiles>(functionOf("geofx_compareFiles"))(actual, expected, comparison);
    return resultOf(comparison);
}

} // namespace geofx::test
