// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/web/detail/TilePyramid.h>

#include <osgGeoFX/raster/PictureFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

/// The light of each sRGB byte, 0…1 (IEC 61966-2-1).
const std::array<float, 256>& lights()
{
    static const std::array<float, 256> table = []
    {
        std::array<float, 256> light{};
        for (std::size_t i = 0; i < light.size(); ++i)
        {
            const double value = static_cast<double>(i) / 255.0;
            light[i] =
                static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
        }
        return light;
    }();
    return table;
}

/// The sRGB byte of a light, 0…1. The table is fine enough that no byte is off by more than a twentieth.
unsigned char byteOf(float light)
{
    static const std::vector<unsigned char> table = []
    {
        std::vector<unsigned char> bytes(65536);
        for (std::size_t i = 0; i < bytes.size(); ++i)
        {
            const double value = static_cast<double>(i) / 65535.0;
            const double code =
                value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
            bytes[i] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(code, 0.0, 1.0)));
        }
        return bytes;
    }();
    return table[static_cast<std::size_t>(std::lround(std::clamp(light, 0.0f, 1.0f) * 65535.0f))];
}

} // namespace

struct TilePyramid::Level
{
    int number = 0;
    int width = 0;
    int height = 0;
    int rows = 0;                     ///< that have come
    int stripNumber = 0;              ///< of the tiles that are being filled
    int stripRows = 0;                ///< of them that are there
    std::vector<unsigned char> strip; ///< these rows
    std::vector<float> upper;         ///< the upper one of two rows that make one of the next level
};

int TilePyramid::levelsOf(int width, int height)
{
    int levels = 0;
    for (int longer = std::max(width, height); longer > side; longer = (longer + 1) / 2)
        ++levels;
    return levels;
}

TilePyramid::TilePyramid(std::string folder, int width, int height, int quality)
    : _folder(std::move(folder)), _quality(quality)
{
    for (int number = levelsOf(width, height); number >= 0; --number)
    {
        Level level;
        level.number = number;
        level.width = width;
        level.height = height;
        level.strip.resize(3 * static_cast<std::size_t>(width) * (side + 1));
        _levels.push_back(std::move(level));
        for (int column = 0; column * side < width; ++column)
        {
            std::error_code fault;
            fs::create_directories(fs::path(_folder) / std::to_string(number) / std::to_string(column),
                                   fault);
            if (fault)
                throw std::runtime_error("The folder \"" + _folder +
                                         "\" cannot be made; check its permissions and the disk's space.");
        }
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    _light.resize(3 * static_cast<std::size_t>(_levels.front().width));
}

TilePyramid::~TilePyramid() = default;

void TilePyramid::add(const unsigned char* row)
{
    std::transform(row, row + _light.size(), _light.begin(),
                   [](unsigned char byte) { return lights()[byte]; });
    add(0, row, _light);
}

void TilePyramid::add(std::size_t index, const unsigned char* bytes, const std::vector<float>& light)
{
    Level& level = _levels[index];
    const std::size_t count = 3 * static_cast<std::size_t>(level.width);
    unsigned char* const to = level.strip.data() + count * static_cast<std::size_t>(level.stripRows);
    if (bytes)
        std::copy(bytes, bytes + count, to);
    else
        std::transform(light.begin(), light.end(), to, byteOf);
    ++level.rows;
    ++level.stripRows;
    const bool last = level.rows == level.height;
    if (level.stripRows > side)
    {
        writeStrip(level);
        // This row is the first one of the next strip, too.
        std::copy(to, to + count, level.strip.data());
        level.stripRows = 1;
        ++level.stripNumber;
    }
    if (last) writeStrip(level);
    if (index + 1 == _levels.size()) return;

    std::vector<float> half(3 * static_cast<std::size_t>((level.width + 1) / 2));
    for (std::size_t x = 0; 3 * x < half.size(); ++x)
    {
        // An odd last column and an odd last row stand for two.
        const std::size_t left = 6 * x, right = std::min(left + 3, count - 3);
        for (std::size_t channel = 0; channel < 3; ++channel)
            half[3 * x + channel] = 0.5f * (light[left + channel] + light[right + channel]);
    }
    const bool upper = level.rows % 2 == 1;
    if (upper && !last)
    {
        level.upper = std::move(half);
        return;
    }
    if (!upper)
        for (std::size_t i = 0; i < half.size(); ++i)
            half[i] = 0.5f * (half[i] + level.upper[i]);
    add(index + 1, nullptr, half);
}

void TilePyramid::writeStrip(const Level& level) const
{
    for (int column = 0; column * side < level.width; ++column)
    {
        const int left = column * side, width = std::min(side + 1, level.width - left);
        const std::string file = (fs::path(_folder) / std::to_string(level.number) / std::to_string(column) /
                                  (std::to_string(level.stripNumber) + ".jpg"))
                                     .string();
        PictureHeader header;
        header.width = width;
        header.height = level.stripRows;
        header.channels = {"R", "G", "B"};
        header.set("oiio:ColorSpace", "sRGB");
        header.set("Compression", "jpeg:" + std::to_string(_quality));
        // Painted strokes are narrow, so colors have all pixels.
        header.set("jpeg:subsampling", "4:4:4");
        const auto output = PictureWriter::create(file);
        bool good = output && output->open(file, header);
        for (int row = 0; good && row < level.stripRows; ++row)
            good = output->write(level.strip.data() + 3 * (static_cast<std::size_t>(row) *
                                                               static_cast<std::size_t>(level.width) +
                                                           static_cast<std::size_t>(left)),
                                 PictureNumber::BYTE);
        if (!good || !output->close())
            throw std::runtime_error(
                "The tile \"" + file +
                "\" cannot be written; check the folder's permissions and the disk's space.");
    }
}

} // namespace osgGeoFX
