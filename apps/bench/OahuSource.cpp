// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "OahuSource.h"

#include "BenchError.h"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>

namespace geofx::bench
{

namespace
{

// data/oahu/README.md.
constexpr int COLUMNS = 3240, ROWS = 2700;
constexpr double WEST = -158.4, NORTH = 21.85, STEP = 1.0 / 3600.0;
constexpr int NOISE_SIDE = 2048, NOISE_BANDS = 3;
constexpr int WINDOW_COLUMN = 1519, WINDOW_ROW = 900, WINDOW_SIZE = 1621;

struct Window
{
    int column, row, columns, rows;
};

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        switch (c)
        {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

void save(const std::filesystem::path& path, const std::string& text)
{
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw BenchError(path.string() + ": it cannot be written; is the disk full?");
}

/// The beginning of a VRT that shows a window of the raster.
std::string header(const Window& window, int samples)
{
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::setprecision(17) << "<VRTDataset rasterXSize=\"" << samples << "\" rasterYSize=\"" << samples
         << "\">\n"
         << "  <SRS dataAxisToSRSAxisMapping=\"2,1\">EPSG:4326</SRS>\n"
         << "  <GeoTransform>" << WEST + window.column * STEP << ", " << window.columns * STEP / samples
         << ", 0, " << NORTH - window.row * STEP << ", 0, " << -window.rows * STEP / samples
         << "</GeoTransform>\n";
    return text.str();
}

void write(const std::filesystem::path& elevation, const Window& window, int samples, const char* resampling,
           const std::filesystem::path& vrt)
{
    if (!std::filesystem::exists(elevation))
        throw BenchError(elevation.string() + ": it does not exist; name the data folder with --data DIR.");
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << header(window, samples) << "  <VRTRasterBand dataType=\"Float32\" band=\"1\">\n"
         << "    <NoDataValue>-32768</NoDataValue>\n"
         << "    <SimpleSource" << resampling << ">\n"
         << "      <SourceFilename relativeToVRT=\"0\">" << escaped(elevation.string())
         << "</SourceFilename>\n"
         << "      <SourceBand>1</SourceBand>\n"
         << "      <SrcRect xOff=\"" << window.column << "\" yOff=\"" << window.row << "\" xSize=\""
         << window.columns << "\" ySize=\"" << window.rows << "\"/>\n"
         << "      <DstRect xOff=\"0\" yOff=\"0\" xSize=\"" << samples << "\" ySize=\"" << samples << "\"/>\n"
         << "    </SimpleSource>\n"
         << "  </VRTRasterBand>\n"
         << "</VRTDataset>\n";
    save(vrt, text.str());
}

/// A raster of noise in ENVI's format.
void writeNoise(const std::filesystem::path& raster)
{
    std::mt19937 random(21);
    std::string bytes(static_cast<std::size_t>(NOISE_BANDS) * NOISE_SIDE * NOISE_SIDE, '\0');
    for (char& byte : bytes)
        byte = static_cast<char>(60u + random() % 120u);
    save(raster, bytes);
    const std::string side = std::to_string(NOISE_SIDE);
    save(raster.string() + ".hdr", "ENVI\nsamples = " + side + "\nlines = " + side +
                                       "\nbands = " + std::to_string(NOISE_BANDS) +
                                       "\nheader offset = 0\nfile type = ENVI Standard\n"
                                       "data type = 1\ninterleave = bsq\nbyte order = 0\n");
}

} // namespace

void writeResampledOahu(const std::filesystem::path& elevation, int samples, const std::filesystem::path& vrt)
{
    write(elevation, {0, 0, COLUMNS, ROWS}, samples, " resampling=\"cubic\"", vrt);
}

void writeWindowOfOahu(const std::filesystem::path& elevation, int samples, const std::filesystem::path& vrt)
{
    const int margin = (WINDOW_SIZE - samples) / 2;
    write(elevation, {WINDOW_COLUMN + margin, WINDOW_ROW + margin, samples, samples}, samples, "", vrt);
}

void writeNoisyImagery(int samples, const std::filesystem::path& vrt)
{
    writeNoise(vrt.parent_path() / "noise");
    std::ostringstream text;
    text << header({0, 0, COLUMNS, ROWS}, samples);
    for (int band = 1; band <= NOISE_BANDS; ++band)
    {
        text << "  <VRTRasterBand dataType=\"Byte\" band=\"" << band << "\">\n";
        // One raster beside the other, until all is covered.
        for (int row = 0; row < samples; row += NOISE_SIDE)
        {
            for (int column = 0; column < samples; column += NOISE_SIDE)
            {
                const int columns = std::min(NOISE_SIDE, samples - column);
                const int rows = std::min(NOISE_SIDE, samples - row);
                text << "    <SimpleSource>\n"
                     << "      <SourceFilename relativeToVRT=\"1\">noise</SourceFilename>\n"
                     << "      <SourceBand>" << band << "</SourceBand>\n"
                     << "      <SrcRect xOff=\"0\" yOff=\"0\" xSize=\"" << columns << "\" ySize=\"" << rows
                     << "\"/>\n"
                     << "      <DstRect xOff=\"" << column << "\" yOff=\"" << row << "\" xSize=\"" << columns
                     << "\" ySize=\"" << rows << "\"/>\n"
                     << "    </SimpleSource>\n";
            }
        }
        text << "  </VRTRasterBand>\n";
    }
    save(vrt, text.str() + "</VRTDataset>\n");
}

} // namespace geofx::bench
