// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace geofx::test
{

/// A KML document around some features.
inline std::string kml(const std::string& features)
{
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>)" +
           features + "</Document></kml>\n";
}

/// A GroundOverlay; `more` stands before its place.
inline std::string groundOverlay(const std::string& href, const std::string& place,
                                 const std::string& more = {})
{
    const std::string icon = href.empty() ? "" : "<Icon><href>" + href + "</href></Icon>";
    return "<GroundOverlay><name>" + (href.empty() ? "plain" : href) + "</name>" + more + icon + place +
           "</GroundOverlay>";
}

inline std::string latLonBox(double west, double south, double east, double north, double rotation = 0.0)
{
    return "<LatLonBox><north>" + std::to_string(north) + "</north><south>" + std::to_string(south) +
           "</south><east>" + std::to_string(east) + "</east><west>" + std::to_string(west) +
           "</west><rotation>" + std::to_string(rotation) + "</rotation></LatLonBox>";
}

/// A picture in GDAL's format of the name's kind: RGBA by column and row from the upper left.
inline void writePicture(const std::string& file, int width, int height,
                         const std::function<std::array<int, 4>(int, int)>& color, const char* format = "PNG")
{
    GDALAllRegister();
    GDALDriver* const memory = GetGDALDriverManager()->GetDriverByName("MEM");
    GDALDataset* const source = memory->Create("", width, height, 4, GDT_Byte, nullptr);
    for (int band = 0; band < 4; ++band)
    {
        std::vector<GByte> row(static_cast<std::size_t>(width));
        for (int y = 0; y < height; ++y)
        {
            for (int x = 0; x < width; ++x)
                row[static_cast<std::size_t>(x)] =
                    static_cast<GByte>(color(x, y)[static_cast<std::size_t>(band)]);
            EXPECT_EQ(source->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, y, width, 1, row.data(), width,
                                                                1, GDT_Byte, 0, 0, nullptr),
                      CE_None);
        }
    }
    source->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(format);
    GDALDataset* const written = driver->CreateCopy(file.c_str(), source, FALSE, nullptr, nullptr, nullptr);
    EXPECT_TRUE(written) << file;
    GDALClose(written);
    GDALClose(source);
}

/// Writes an archive with GDAL's own writer of zip files: names and contents.
inline void writeArchive(const std::string& file,
                         const std::vector<std::pair<std::string, std::string>>& entries)
{
    std::filesystem::remove(file);
    // GDAL writes archives of this ending only.
    const std::string zip = (std::filesystem::path(file).parent_path() / "archive.zip").string();
    VSILFILE* const whole = VSIFOpenL(("/vsizip/" + zip).c_str(), "wb");
    ASSERT_TRUE(whole);
    for (const auto& [name, content] : entries)
    {
        VSILFILE* const entry = VSIFOpenL(("/vsizip/" + zip + "/" + name).c_str(), "wb");
        ASSERT_TRUE(entry) << name;
        EXPECT_EQ(VSIFWriteL(content.data(), 1, content.size(), entry), content.size());
        VSIFCloseL(entry);
    }
    VSIFCloseL(whole);
    std::filesystem::rename(zip, file);
}

inline std::string bytesOf(const std::string& file)
{
    std::string content;
    VSILFILE* const stream = VSIFOpenL(file.c_str(), "rb");
    EXPECT_TRUE(stream) << file;
    if (!stream) return content;
    char buffer[65536];
    while (const std::size_t count = VSIFReadL(buffer, 1, sizeof(buffer), stream))
        content.append(buffer, count);
    VSIFCloseL(stream);
    return content;
}

} // namespace geofx::test
