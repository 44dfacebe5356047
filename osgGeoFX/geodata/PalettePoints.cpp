// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/PalettePoints.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/CsvLines.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

namespace osgGeoFX
{

namespace
{

constexpr const char* classNames[] = {"field", "hill", "cliff", "snow", "forest", "trees", "town", "bare"};
constexpr int classCount = static_cast<int>(std::size(classNames));

enum Column
{
    CLASS,
    X,
    Y,
    LIGHT_X,
    LIGHT_Y,
    LIGHT,
    COLUMNS
};
constexpr std::array<const char*, COLUMNS> columnNames = {"class", "x", "y", "lightX", "lightY", "light"};

/// One record, by the columns that the file has.
struct Record
{
    std::array<std::string, COLUMNS> cells;
    std::string where;

    int row() const
    {
        const std::string& text = cells[CLASS];
        for (int row = 0; row < classCount; ++row)
            if (text == classNames[row] || text == std::to_string(row)) return row;
        throw BuildError(where + "the column \"class\" holds \"" + text +
                         "\"; write field, hill, cliff, snow, forest, trees, town or bare.");
    }

    double number(Column column) const
    {
        const std::string& text = cells[column];
        char* end = nullptr;
        const double value = CPLStrtod(text.c_str(), &end);
        if (text.empty() || *end != '\0' || !std::isfinite(value))
            throw BuildError(where + "the column \"" + columnNames[column] + "\" holds \"" + text +
                             "\"; write a number.");
        return value;
    }

    std::optional<double> numberIfAny(Column column) const
    {
        return cells[column].empty() ? std::nullopt : std::optional<double>(number(column));
    }
};

PalettePoint pointOf(const Record& record)
{
    PalettePoint point;
    point.row = record.row();
    point.place.set(record.number(X), record.number(Y));
    const auto x = record.numberIfAny(LIGHT_X);
    const auto y = record.numberIfAny(LIGHT_Y);
    if (x.has_value() != y.has_value())
        throw BuildError(record.where + "only one of lightX and lightY is given; give both, or neither.");
    if (x) point.lightPlace = osg::Vec2d(*x, *y);
    point.light = record.numberIfAny(LIGHT);
    if (point.light && std::abs(*point.light) > 1.0)
        throw BuildError(record.where + "the light is " + record.cells[LIGHT] +
                         "; write a number from -1 (turned away) to 1 (facing the light).");
    return point;
}

} // namespace

std::vector<PalettePoint> readPalettePoints(const std::string& file)
{
    initialiseGdal();
    GdalErrorScope errors;
    const char* drivers[] = {"CSV", nullptr};
    const DatasetPtr dataset(
        GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_VERBOSE_ERROR, drivers));
    if (!dataset || dataset->GetLayerCount() == 0)
        throw BuildError(file + ": the sample points cannot be read as CSV" +
                         (errors.failed() ? " (" + errors.message() + ")" : "") +
                         "; the file needs the extension .csv and a first line such as class,x,y.");
    OGRLayer* const layer = dataset->GetLayer(0);
    std::array<int, COLUMNS> index{};
    for (std::size_t i = 0; i < index.size(); ++i)
    {
        index[i] = layer->GetLayerDefn()->GetFieldIndex(columnNames[i]);
        if (index[i] < 0 && i <= Y)
            throw BuildError(file + ": the column \"" + columnNames[i] +
                             "\" is missing; the first line must have class, x and y.");
    }
    std::ifstream text(file);
    const std::vector<int> lines = recordLines(text);
    std::vector<PalettePoint> points;
    for (const auto& feature : layer)
    {
        const std::size_t record = points.size() + 1;
        Record cells;
        cells.where =
            file + ":" + std::to_string(record < lines.size() ? lines[record] : lines.back()) + ": ";
        for (std::size_t i = 0; i < index.size(); ++i)
            if (index[i] >= 0) cells.cells[i] = feature->GetFieldAsString(index[i]);
        points.push_back(pointOf(cells));
    }
    if (points.empty()) throw BuildError(file + ": has no sample points; add a line for each.");
    return points;
}

} // namespace osgGeoFX
