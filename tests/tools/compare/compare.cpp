// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/compare/Compare.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <numeric>
#include <sstream>

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

/// Says what differs, and leaves pictures of it.
class Report
{
public:
    explicit Report(Comparison& comparison) : _comparison(comparison)
    {
        std::filesystem::create_directories(comparison.folder);
    }
    ~Report() { _comparison.message = _text.str(); }
    Report(const Report&) = delete;
    Report& operator=(const Report&) = delete;

    template<class T>
    Report& operator<<(const T& value)
    {
        _text << value;
        return *this;
    }

    void picture(const ImageBuf& image, const std::string& what)
    {
        const std::string path = _comparison.folder / (_comparison.prefix + what + ".png");
        // PNG has 8 or 16 bits; alpha of a difference would hide it, and that of a picture matters little.
        const int colors = std::min(image.nchannels(), 3);
        ImageBuf picture = ImageBufAlgo::channels(image, colors == 2 ? 1 : colors, {});
        picture.set_write_format(OIIO::TypeUInt8);
        const bool written = picture.write(path);
        _text << "\n  " << what << ": " << path
              << (written ? "" : " (not written: " + picture.geterror() + ")");
    }

private:
    Comparison& _comparison;
    std::ostringstream _text;
};

void compare(const ImageBuf& actual, const ImageBuf& expected, Comparison& comparison)
{
    const ImageTolerance& tolerance = comparison.tolerance;
    if (actual.spec().width != expected.spec().width || actual.spec().height != expected.spec().height ||
        actual.nchannels() != expected.nchannels())
    {
        Report report(comparison);
        report << "the image has " << describe(actual) << " instead of " << describe(expected);
        report.picture(actual, "actual");
        report.picture(expected, "expected");
        return;
    }
    const ImageBufAlgo::CompareResults found =
        ImageBufAlgo::compare(actual, expected, tolerance.fail, tolerance.fail);
    const double pixels = static_cast<double>(actual.spec().image_pixels());
    const double share = static_cast<double>(found.nfail) / pixels;
    const OIIO::imagesize_t notANumber = countNotANumber(actual) + countNotANumber(expected);
    if (notANumber == 0 && share <= tolerance.share &&
        (found.nfail == 0 || found.maxerror <= static_cast<double>(tolerance.hardFail)))
    {
        comparison.same = true;
        return;
    }
    Report report(comparison);
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
}

} // namespace

} // namespace geofx::test

using geofx::test::Comparison;

extern "C" __attribute__((visibility("default"))) void
geofx_compareImages(const osg::Image& actual, const osg::Image& expected, Comparison& comparison)
{
    geofx::test::compare(geofx::test::toImageBuf(actual), geofx::test::toImageBuf(expected), comparison);
}

extern "C" __attribute__((visibility("default"))) void
geofx_compareFiles(const std::filesystem::path& actual, const std::filesystem::path& expected,
                   Comparison& comparison)
{
    geofx::test::ImageBuf images[2];
    const std::filesystem::path paths[2] = {actual, expected};
    for (int i = 0; i < 2; ++i)
    {
        images[i].reset(paths[i].string());
        if (images[i].read()) continue;
        comparison.message = "cannot read \"" + paths[i].string() + "\": " + images[i].geterror();
        return;
    }
    geofx::test::compare(images[0], images[1], comparison);
}
