// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/PictureStart.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgGeoFX
{

namespace
{

/// Numbers in a file; beyond its end there are zeros.
class Bytes
{
public:
    explicit Bytes(const std::string& content) : _content(content) {}

    std::size_t size() const { return _content.size(); }
    bool startsWith(const std::string& magic) const { return _content.compare(0, magic.size(), magic) == 0; }
    unsigned int at(std::size_t i) const
    {
        return i < _content.size() ? static_cast<unsigned char>(_content[i]) : 0;
    }
    double big(std::size_t i, int count) const
    {
        double value = 0.0;
        for (int k = 0; k < count; ++k)
            value = 256.0 * value + at(i + static_cast<std::size_t>(k));
        return value;
    }
    double little(std::size_t i, int count) const
    {
        double value = 0.0;
        for (int k = count; k-- > 0;)
            value = 256.0 * value + at(i + static_cast<std::size_t>(k));
        return value;
    }

private:
    const std::string& _content;
};

double bytesOfPng(const Bytes& png)
{
    // Palettes and transparent colors become RGBA.
    return png.big(16, 4) * png.big(20, 4) * 4.0 * (png.at(24) == 16 ? 2.0 : 1.0);
}

double bytesOfJpeg(const Bytes& jpeg)
{
    std::size_t i = 2;
    while (i + 9 < jpeg.size())
    {
        if (jpeg.at(i) != 0xff) return HUGE_VAL;
        const unsigned int marker = jpeg.at(i + 1);
        if (marker == 0xff || marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8))
        {
            i += marker == 0xff ? 1 : 2;
            continue;
        }
        const bool isFrame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (isFrame) return jpeg.big(i + 5, 2) * jpeg.big(i + 7, 2) * 4.0;
        if (marker == 0xd9 || marker == 0xda) break;
        i += 2 + static_cast<std::size_t>(std::max(2.0, jpeg.big(i + 2, 2)));
    }
    return HUGE_VAL;
}

/// Of all frames: OSG keeps each of them.
double bytesOfGif(const Bytes& gif)
{
    const auto skipBlocks = [&](std::size_t i)
    {
        while (gif.at(i) != 0)
            i += 1 + gif.at(i);
        return i + 1;
    };
    const auto sizeOfColors = [&](std::size_t i)
    {
        return gif.at(i) & 0x80u ? 3u << ((gif.at(i) & 7u) + 1u) : 0u;
    };
    double wide = gif.little(6, 2), high = gif.little(8, 2);
    double frames = 0.0;
    std::size_t i = 13 + sizeOfColors(10);
    while (i < gif.size())
    {
        if (gif.at(i) == 0x21)
        {
            i = skipBlocks(i + 2);
        }
        else if (gif.at(i) == 0x2c)
        {
            frames += 1.0;
            wide = std::max(wide, gif.little(i + 1, 2) + gif.little(i + 5, 2));
            high = std::max(high, gif.little(i + 3, 2) + gif.little(i + 7, 2));
            i = skipBlocks(i + 11 + sizeOfColors(i + 9));
        }
        else
        {
            break;
        }
    }
    return wide * high * 4.0 * std::max(1.0, frames);
}

double bytesOfBmp(const Bytes& bmp)
{
    const auto side = [&](std::size_t i)
    {
        return std::abs(static_cast<double>(static_cast<std::int32_t>(
            bmp.little(i, 4) < 2147483648.0 ? bmp.little(i, 4) : bmp.little(i, 4) - 4294967296.0)));
    };
    const bool isOld = bmp.little(14, 4) == 12.0; // OS/2
    return isOld ? bmp.little(18, 2) * bmp.little(20, 2) * 4.0 : side(18) * side(22) * 4.0;
}

double bytesOfDds(const Bytes& dds)
{
    const double high = dds.little(12, 4), wide = dds.little(16, 4);
    const double deep = std::max(1.0, dds.little(24, 4));
    // Four floats a texel at most, and as much again for the smaller sizes.
    return wide * high * deep * 16.0 * 2.0 < 64.0 * static_cast<double>(dds.size()) ? wide * high * deep * 4.0
                                                                                    : HUGE_VAL;
}

} // namespace

std::optional<PictureStart> pictureStartOf(const std::string& content)
{
    const Bytes bytes(content);
    if (bytes.startsWith("\x89PNG\r\n\x1a\n")) return PictureStart{"png", bytesOfPng(bytes)};
    if (bytes.startsWith("\xff\xd8\xff")) return PictureStart{"jpeg", bytesOfJpeg(bytes)};
    if (bytes.startsWith("GIF87a") || bytes.startsWith("GIF89a"))
        return PictureStart{"gif", bytesOfGif(bytes)};
    if (bytes.startsWith("BM") && bytes.size() > 26) return PictureStart{"bmp", bytesOfBmp(bytes)};
    if (bytes.startsWith("DDS ") && bytes.little(4, 4) == 124.0)
        return PictureStart{"dds", bytesOfDds(bytes)};
    return std::nullopt;
}

} // namespace osgGeoFX
