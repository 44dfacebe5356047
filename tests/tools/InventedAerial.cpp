// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/InventedAerial.h>

#include <osgGeoFX/town/detail/Scatter.h>
#include <tools/OahuRaster.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace geofx::test
{

namespace
{

constexpr std::size_t CLASSES = 256;

/// -1 to 1 at each whole place.
float corner(int x, int y, std::uint32_t seed)
{
    const std::uint32_t bits =
        osgGeoFX::scatteredBits(static_cast<std::uint32_t>(x) * 0x9e3779b9u ^
                                osgGeoFX::scatteredBits(static_cast<std::uint32_t>(y) + seed));
    return static_cast<float>(bits) * (2.0f / 4294967295.0f) - 1.0f;
}

/// The same between them, smooth.
float noise(float x, float y, std::uint32_t seed)
{
    const float column = std::floor(x), row = std::floor(y);
    const int i = static_cast<int>(column), j = static_cast<int>(row);
    const auto smooth = [](float t)
    {
        return t * t * (3.0f - 2.0f * t);
    };
    const float u = smooth(x - column), v = smooth(y - row);
    const float low = corner(i, j, seed) * (1.0f - u) + corner(i + 1, j, seed) * u;
    const float high = corner(i, j + 1, seed) * (1.0f - u) + corner(i + 1, j + 1, seed) * u;
    return low * (1.0f - v) + high * v;
}

/// What a class looks like from above.
struct Look
{
    std::array<float, 3> color{90.0f, 90.0f, 90.0f};
    float fine = 0.06f, coarse = 0.08f; ///< how much its brightness varies, over some 8 m and 150 m
    bool roofs = false;
};

std::array<Look, CLASSES> looks()
{
    std::array<Look, CLASSES> result;
    const std::string file = std::string(GEOFX_SOURCE_DIR) + "/data/oahu/landcover.csv";
    std::ifstream table(file);
    std::string line;
    for (std::getline(table, line); std::getline(table, line);)
    {
        std::istringstream text(line);
        std::array<std::string, 6> cells;
        for (std::string& cell : cells)
            std::getline(text, cell, ',');
        if (cells[5].empty()) throw std::runtime_error(file + " cannot be read.");
        const std::string& name = cells[1];
        Look& look = result.at(static_cast<std::size_t>(std::stoi(cells[0])));
        // Photos are darker than maps, and less colorful.
        const std::array<float, 3> map = {std::stof(cells[3]), std::stof(cells[4]), std::stof(cells[5])};
        const float mean = (map[0] + map[1] + map[2]) / 3.0f;
        for (std::size_t i = 0; i < 3; ++i)
            look.color[i] = 0.72f * (mean + 0.8f * (map[i] - mean));
        look.roofs = name == "town" || name == "urban" || name == "industrial";
        if (name == "mixed_forest" || name == "scrub")
            look.fine = 0.22f, look.coarse = 0.18f;
        else if (name == "sea" || name == "lake" || name == "river")
            look.fine = 0.03f, look.coarse = 0.05f;
        else if (look.roofs)
            look.fine = 0.16f, look.coarse = 0.06f;
    }
    return result;
}

} // namespace

void inventAerial(const std::string& file, int columns)
{
    if (columns < 1 || columns > 65536)
        throw std::runtime_error("An aerial picture has 1 to 65,536 columns.");
    const OahuRaster<unsigned char> cover("landcover.tif", GDT_Byte);
    const std::array<Look, CLASSES> all = looks();
    const int rows =
        std::max(1, static_cast<int>(static_cast<std::int64_t>(columns) * cover.rows() / cover.columns()));
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    char** options = CSLSetNameValue(CSLSetNameValue(nullptr, "INTERLEAVE", "PIXEL"), "PHOTOMETRIC", "RGB");
    std::filesystem::remove(file);
    std::unique_ptr<GDALDataset> data(driver->Create(file.c_str(), columns, rows, 3, GDT_Byte, options));
    CSLDestroy(options);
    if (!data) throw std::runtime_error(file + " cannot be made.");
    std::array<double, 6> transform = cover.transform();
    const float step = static_cast<float>(cover.columns()) / static_cast<float>(columns);
    const float stepDown = static_cast<float>(cover.rows()) / static_cast<float>(rows);
    transform[1] *= static_cast<double>(cover.columns()) / columns;
    transform[5] *= static_cast<double>(cover.rows()) / rows;
    data->SetGeoTransform(transform.data());
    OGRSpatialReference srs;
    srs.importFromEPSG(4326);
    data->SetSpatialRef(&srs);

    std::vector<unsigned char> line(static_cast<std::size_t>(columns) * 3);
    for (int row = 0; row < rows; ++row)
    {
        // In pixels of the land cover, some 30 m.
        const float y = (static_cast<float>(row) + 0.5f) * stepDown;
        for (int column = 0; column < columns; ++column)
        {
            const float x = (static_cast<float>(column) + 0.5f) * step;
            // Borders are ragged over some 10 m, and shores where the waves are.
            const float aside = 0.45f * noise(x * 1.3f, y * 1.3f, 1) + 0.35f * noise(x * 4.0f, y * 4.0f, 2);
            const float along = 0.45f * noise(x * 1.3f, y * 1.3f, 3) + 0.35f * noise(x * 4.0f, y * 4.0f, 4);
            const Look& look = all[cover.pixel(static_cast<int>(x + aside), static_cast<int>(y + along))];
            const float grain = corner(column, row, 5);
            float light = 1.0f + look.coarse * noise(x * 0.2f, y * 0.2f, 6) + look.fine * 0.5f * grain;
            std::array<float, 3> tint = {0.0f, 0.0f, 0.0f};
            if (look.roofs)
            {
                // Lots of some 15 m with roofs of red, grey and white, and gardens.
                const float lot =
                    corner(static_cast<int>(std::floor(x * 2.0f)), static_cast<int>(std::floor(y * 2.0f)), 7);
                if (lot > 0.5f)
                    light += 0.2f;
                else if (lot > 0.1f)
                    tint = {14.0f, -8.0f, -13.0f};
                else if (lot < -0.5f)
                    tint = {-30.0f, -14.0f, -30.0f};
            }
            else
                light += look.fine * noise(x * 3.0f, y * 3.0f, 8);
            for (std::size_t i = 0; i < 3; ++i)
                line[static_cast<std::size_t>(column) * 3 + i] =
                    static_cast<unsigned char>(std::clamp(look.color[i] * light + tint[i], 0.0f, 255.0f));
        }
        if (data->RasterIO(GF_Write, 0, row, columns, 1, line.data(), columns, 1, GDT_Byte, 3, nullptr, 3,
                           static_cast<GSpacing>(columns) * 3, 1, nullptr) != CE_None)
            throw std::runtime_error(file + " cannot be written.");
    }
    data.reset();
    if (!std::filesystem::exists(file)) throw std::runtime_error(file + " cannot be written.");
}

} // namespace geofx::test
