// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "OahuSource.h"

#include "BenchError.h"

#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>

namespace geofx::bench
{

namespace
{

// data/oahu/README.md.
constexpr int COLUMNS = 3240, ROWS = 2700;
constexpr double WEST = -158.4, NORTH = 21.85, STEP = 1.0 / 3600.0;
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

void write(const std::filesystem::path& elevation, const Window& window, int samples, const char* resampling,
           const std::filesystem::path& vrt)
{
    if (!std::filesystem::exists(elevation))
        throw BenchError(elevation.string() + ": it does not exist; name the data folder with --data DIR.");
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::setprecision(17) << "<VRTDataset rasterXSize=\"" << samples << "\" rasterYSize=\"" << samples
         << "\">\n"
         << "  <SRS dataAxisToSRSAxisMapping=\"2,1\">EPSG:4326</SRS>\n"
         << "  <GeoTransform>" << WEST + window.column * STEP << ", " << window.columns * STEP / samples
         << ", 0, " << NORTH - window.row * STEP << ", 0, " << -window.rows * STEP / samples
         << "</GeoTransform>\n"
         << "  <VRTRasterBand dataType=\"Float32\" band=\"1\">\n"
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
    std::ofstream file(vrt);
    file << text.str();
    file.close();
    if (!file) throw BenchError(vrt.string() + ": it cannot be written; is the disk full?");
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

} // namespace geofx::bench
