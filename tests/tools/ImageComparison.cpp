// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/ImageComparison.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <numeric>

namespace geofx::test
{

namespace
{

using OIIO::ImageBuf;
using OIIO::ImageSpec;
namespace ImageBufAlgo = OIIO::ImageBufAlgo;

/// As OpenImageIO has it: the first row is the upper one.
ImageBuf toImageBuf(const osg::Image& image)
{
    const OIIO::TypeDesc type = image.getDataType() == GL_FLOAT            ? OIIO::TypeFloat
                                : image.getDataType() == GL_UNSIGNED_SHORT ? OIIO::TypeUInt16
                                                                           : OIIO::TypeUInt8;
    const int channels = static_cast<int>(osg::Image::computeNumComponents(image.getPixelFormat()));
    ImageBuf result(ImageSpec(image.s(), image.t(), channels, type));
    const auto width = static_cast<OIIO::stride_t>(image.getRowSizeInBytes());
    result.set_pixels(OIIO::ROI::All(), type, image.data(0, image.t() - 1), OIIO::AutoStride, -width);
    return result;
}

std::string describe(const ImageBuf& image)
{
    const ImageSpec& spec = image.spec();
    return std::to_string(spec.width) + "x" + std::to_string(spec.height) + " pixels, " +
           std::to_string(spec.nchannels) + " channels";
}

/// OpenImageIO's comparison overlooks what is not a number.
OIIO::imagesize_t countNotANumber(const ImageBuf& image)
{
    const ImageBufAlgo::PixelStats stats = ImageBufAlgo::computePixelStats(image);
    return std::accumulate(stats.nancount.begin(), stats.nancount.end(), OIIO::imagesize_t(0));
}

class Report
{
public:
    explicit Report(const std::string& name)
        : _folder(testOutputFolder()), _prefix(name.empty() ? "" : name + "-"),
          _result(::testing::AssertionFailure())
    {
    }

    template<class T>
    Report& operator<<(const T& value)
    {
        _result << value;
        return *this;
    }

    void picture(const ImageBuf& image, const std::string& what)
    {
        const std::string path = _folder / (_prefix + what + ".png");
        // PNG has 8 or 16 bits; alpha of a difference would hide it, and that of a picture matters little.
        const int colors = std::min(image.nchannels(), 3);
        ImageBuf picture = ImageBufAlgo::channels(image, colors == 2 ? 1 : colors, {});
        picture.set_write_format(OIIO::TypeUInt8);
        const bool written = picture.write(path);
        _result << "\n  " << what << ": " << path
                << (written ? "" : " (not written: " + picture.geterror() + ")");
    }

    ::testing::AssertionResult result() const { return _result; }

private:
    std::filesystem::path _folder;
    std::string _prefix;
    ::testing::AssertionResult _result;
};

::testing::AssertionResult compare(const ImageBuf& actual, const ImageBuf& expected,
                                   const ImageTolerance& tolerance, const std::string& name)
{
    if (actual.spec().width != expected.spec().width || actual.spec().height != expected.spec().height ||
        actual.nchannels() != expected.nchannels())
    {
        Report report(name);
        report << "the image has " << describe(actual) << " instead of " << describe(expected);
        report.picture(actual, "actual");
        report.picture(expected, "expected");
        return report.result();
    }
    const ImageBufAlgo::CompareResults found =
        ImageBufAlgo::compare(actual, expected, tolerance.fail, tolerance.fail);
    const double pixels = static_cast<double>(actual.spec().image_pixels());
    const double share = static_cast<double>(found.nfail) / pixels;
    const OIIO::imagesize_t notANumber = countNotANumber(actual) + countNotANumber(expected);
    if (notANumber == 0 && share <= tolerance.share &&
        (found.nfail == 0 || found.maxerror <= static_cast<double>(tolerance.hardFail)))
    {
        return ::testing::AssertionSuccess();
    }
    Report report(name);
    if (notANumber > 0)
    {
        report << notANumber << " values are not a number; ";
    }
    report << found.nfail << " of " << pixels << " pixels are off by more than " << tolerance.fail
           << " (allowed: " << tolerance.share * pixels << " pixels, none by more than " << tolerance.hardFail
           << "); the worst is pixel (" << found.maxx << ", " << found.maxy
           << ") from the upper left, channel " << found.maxc << ", off by " << found.maxerror << ": "
           << actual.getchannel(found.maxx, found.maxy, 0, found.maxc) << " instead of "
           << expected.getchannel(found.maxx, found.maxy, 0, found.maxc);
    report.picture(actual, "actual");
    report.picture(expected, "expected");
    const ImageBuf difference = ImageBufAlgo::absdiff(actual, expected);
    const float gain = found.maxerror > 0 ? static_cast<float>(1.0 / found.maxerror) : 1.0f;
    report.picture(ImageBufAlgo::mul(difference, gain), "difference");
    return report.result();
}

} // namespace

std::filesystem::path testOutputFolder()
{
    std::string name = "no-test";
    if (const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info())
    {
        name = std::string(test->test_suite_name()) + "." + test->name();
        std::replace(name.begin(), name.end(), '/', '_');
    }
    std::filesystem::path folder = std::filesystem::path(GEOFX_BUILD_DIR) / "test-output" / name;
    std::filesystem::create_directories(folder);
    return folder;
}

::testing::AssertionResult imagesMatch(const osg::Image& actual, const osg::Image& expected,
                                       const ImageTolerance& tolerance, const std::string& name)
{
    return compare(toImageBuf(actual), toImageBuf(expected), tolerance, name);
}

::testing::AssertionResult imagesMatch(const std::filesystem::path& actual,
                                       const std::filesystem::path& expected, const ImageTolerance& tolerance,
                                       const std::string& name)
{
    ImageBuf images[2];
    const std::filesystem::path paths[2] = {actual, expected};
    for (int i = 0; i < 2; ++i)
    {
        images[i].reset(paths[i].string());
        if (!images[i].read())
        {
            return ::testing::AssertionFailure()
                   << "cannot read " << paths[i] << ": " << images[i].geterror();
        }
    }
    return compare(images[0], images[1], tolerance, name);
}

} // namespace geofx::test
