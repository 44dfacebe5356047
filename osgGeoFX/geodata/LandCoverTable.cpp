// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/LandCoverTable.h>

#include <osgGeoFX/geodata/detail/BakedLegends.h>
#include <osgGeoFX/geodata/detail/CsvLines.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <ogrsf_frmts.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <iterator>
#include <mutex>
#include <sstream>

namespace osgGeoFX
{

namespace
{

/// A ready legend as a file of GDAL's in memory, any other path as it is.
std::string tableFile(const std::string& file)
{
    const BakedLegend* legend = findLegend(file);
    if (!legend) return file;
    std::string path = "/vsimem/osgGeoFX/legends/" + file + ".csv";
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);
    VSIStatBufL status;
    if (VSIStatL(path.c_str(), &status) != 0)
    {
        auto* bytes = reinterpret_cast<GByte*>(const_cast<char*>(legend->text));
        VSIFCloseL(VSIFileFromMemBuffer(path.c_str(), bytes, std::strlen(legend->text), FALSE));
    }
    return path;
}

double shareField(const std::string& text, const std::string& where, const char* column)
{
    char* end = nullptr;
    const double value = CPLStrtod(text.c_str(), &end);
    if (*end != '\0' || !(value >= 0.0 && value <= 1.0))
        throw BuildError(where + "the column \"" + column + "\" holds \"" + text +
                         "\"; write a number from 0 to 1.");
    return value;
}

bool waterField(const std::string& text, const std::string& where)
{
    if (text != "0" && text != "1")
        throw BuildError(where + "the column \"water\" holds \"" + text + "\"; write 0 or 1.");
    return text == "1";
}

int byteField(const OGRFeature& feature, int field, const std::string& where, const char* column)
{
    const std::string text = feature.GetFieldAsString(field);
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > 255)
        throw BuildError(where + "the column \"" + column + "\" holds \"" + text +
                         "\"; write a whole number from 0 to 255.");
    return value;
}

} // namespace

std::vector<LandCoverClass> readLandCoverTable(const std::string& file)
{
    initialiseGdal();
    GdalErrorScope errors;
    const char* drivers[] = {"CSV", nullptr};
    const DatasetPtr dataset(
        GDALDataset::Open(tableFile(file).c_str(), GDAL_OF_VECTOR | GDAL_OF_VERBOSE_ERROR, drivers));
    if (!dataset || dataset->GetLayerCount() == 0)
    {
        std::string names;
        for (const std::string& name : readyLegends())
            names += (names.empty() ? "" : ", ") + name;
        throw BuildError(
            file + ": the land-cover table cannot be read as CSV" +
            (errors.failed() ? " (" + errors.message() + ")" : "") +
            "; it needs the extension .csv and a first line value,class,name,red,green,blue, or is "
            "one of the ready legends " +
            names + ".");
    }
    OGRLayer* layer = dataset->GetLayer(0);
    const char* columns[] = {"value", "class", "name", "red", "green", "blue"};
    std::array<int, 6> index{};
    for (std::size_t i = 0; i < index.size(); ++i)
    {
        index[i] = layer->GetLayerDefn()->GetFieldIndex(columns[i]);
        if (index[i] < 0)
            throw BuildError(file + ": the column \"" + columns[i] +
                             "\" is missing; the first line must be value,class,name,red,green,blue.");
    }

    const char* optionalColumns[] = {"trees", "town", "bare", "water"};
    std::array<int, 4> optionalIndex{};
    for (std::size_t i = 0; i < optionalIndex.size(); ++i)
        optionalIndex[i] = layer->GetLayerDefn()->GetFieldIndex(optionalColumns[i]);

    std::vector<LandCoverClass> classes;
    std::istringstream stream(landCoverTableText(file));
    const std::vector<int> lines = recordLines(stream);
    std::size_t record = 0;
    for (const auto& feature : layer)
    {
        ++record;
        const std::string where =
            file + ":" + std::to_string(record < lines.size() ? lines[record] : lines.back()) + ": ";
        LandCoverClass entry;
        entry.value = byteField(*feature, index[0], where, columns[0]);
        entry.id = feature->GetFieldAsString(index[1]);
        entry.name = feature->GetFieldAsString(index[2]);
        for (std::size_t channel = 0; channel < 3; ++channel)
            entry.color[channel] = static_cast<unsigned char>(
                byteField(*feature, index[3 + channel], where, columns[3 + channel]));
        std::array<std::string, 4> cover;
        for (std::size_t i = 0; i < cover.size(); ++i)
            if (optionalIndex[i] >= 0) cover[i] = feature->GetFieldAsString(optionalIndex[i]);
        // Legends have all of it, and are what the other tables' classes are looked up in.
        if (std::any_of(cover.begin(), cover.end(), [](const auto& text) { return text.empty(); }))
            coverOfClass(entry);
        double* const shares[] = {&entry.trees, &entry.town, &entry.bare};
        for (std::size_t i = 0; i < std::size(shares); ++i)
            if (!cover[i].empty()) *shares[i] = shareField(cover[i], where, optionalColumns[i]);
        if (!cover[3].empty()) entry.water = waterField(cover[3], where);
        if (entry.value == 0)
            throw BuildError(where + "the value 0 is kept for \"no data\"; give the class another value.");
        if (std::any_of(classes.begin(), classes.end(),
                        [&](const auto& c) { return c.value == entry.value; }))
            throw BuildError(where + "the value " + std::to_string(entry.value) +
                             " stands in the table twice; remove one of the lines.");
        classes.push_back(std::move(entry));
    }
    if (classes.empty())
        throw BuildError(file + ": the land-cover table has no classes; add a line for each value.");
    return classes;
}

} // namespace osgGeoFX
