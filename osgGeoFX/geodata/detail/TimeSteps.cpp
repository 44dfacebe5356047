// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/TimeSteps.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/Lengths.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/Remarks.h>
#include <osgGeoFX/geodata/detail/StepDates.h>
#include <osgGeoFX/geodata/detail/VirtualRaster.h>

#include <cpl_string.h>
#include <gdal_utils.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <utility>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

constexpr std::size_t mostSteps = 1000000;

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// All digits of a number, as GDAL's options have it.
std::string number(double value)
{
    return CPLSPrintf("%.17g", value);
}

/// Times must rise; those that do not are as good as none.
void checkTimes(TimeSteps& steps, const std::string& file)
{
    if (steps.times.empty()) throw BuildError(file + ": it has no steps; check it with gdalinfo.");
    if (steps.times.size() > mostSteps)
        throw BuildError(file + ": it has more than a million steps; split it.");
    // A LayerClock has no others.
    constexpr double most = 1e12;
    bool rising = std::abs(steps.times[0]) <= most;
    for (std::size_t i = 1; i < steps.times.size(); ++i)
        rising = rising && steps.times[i] > steps.times[i - 1] && steps.times[i] <= most;
    if (rising) return;
    remarkOnce(file + ": the times of its steps do not rise, or lie beyond all clocks, so its steps count 0, "
                      "1, 2 …; give each "
                      "a time of its own, in order.");
    steps.dated = false;
    for (std::size_t i = 0; i < steps.times.size(); ++i)
        steps.times[i] = static_cast<double>(i);
}

/// Takes times if all steps have one, else counts.
void setTimes(TimeSteps& steps, const std::vector<std::optional<double>>& times, const std::string& file)
{
    const auto dated =
        std::count_if(times.begin(), times.end(), [](const auto& time) { return time.has_value(); });
    steps.dated = static_cast<std::size_t>(dated) == times.size();
    if (dated > 0 && !steps.dated)
        remarkOnce(file + ": " + std::to_string(dated) + " of its " + std::to_string(times.size()) +
                   " steps have a date, so all count 0, 1, 2 …; give each a date, or none.");
    for (std::size_t i = 0; i < times.size(); ++i)
        steps.times.push_back(steps.dated ? *times[i] : static_cast<double>(i));
}

/// The time dimension of a variable.
class DimensionSteps final : public TimeSteps
{
public:
    /// `timed`: whether it needs a time.
    DimensionSteps(std::string file, DatasetPtr dataset, const std::string& wanted, bool timed = true)
        : _file(std::move(file)), _dataset(std::move(dataset)), _timed(timed)
    {
        const std::shared_ptr<GDALGroup> root = _dataset->GetRootGroup();
        if (!root) throw BuildError(_file + ": it holds no variables; check it with gdalmdiminfo.");
        const std::string name = wanted.substr(0, wanted.find('['));
        _array = find(*root, name);
        if (!_array)
        {
            const std::string names = listed(*root, _timed);
            const std::string parts = _timed ? "a time, rows and columns" : "rows and columns";
            throw BuildError(_file + ": " +
                             (name.empty() ? "no variable of it has " + parts
                                           : "it has no variable \"" + name + "\" with " + parts) +
                             (names.empty()
                                  ? "; look at it with gdalmdiminfo, and show what does not change with "
                                    "--mapping."
                                  : "; it has " + names + "."));
        }
        variable = _array->GetName();
        unit = _array->GetUnit();
        chooseOthers(wanted.substr(std::min(name.size(), wanted.size())));
        if (_timed)
        {
            readTimes();
            checkTimes(*this, _file);
        }
    }

    std::unique_ptr<FrameRaster> step(std::size_t index) override
    {
        return std::make_unique<FrameRaster>(_file, rasterOf(index), DataLayer::VALUE);
    }

    /// The raster of a step; of a variable without a time, the one that there is.
    DatasetChain rasterOf(std::size_t index) const
    {
        const GdalErrorScope errors;
        std::string view = "[";
        const auto& dimensions = _array->GetDimensions();
        for (std::size_t i = 0; i < dimensions.size(); ++i)
        {
            if (i > 0) view += ",";
            if (i == _axes.time)
                view += std::to_string(index);
            else if (i == _axes.x || i == _axes.y)
                view += ":";
            else
                view += std::to_string(_others[i]);
        }
        const std::shared_ptr<GDALMDArray> slice = _array->GetView(view + "]");
        const std::size_t x = _axes.x > _axes.y ? 1 : 0;
        DatasetChain chain;
        if (slice) chain.add(DatasetPtr(slice->AsClassicDataset(x, 1 - x)));
        if (!chain.empty() && hasBounds()) chain.add(withoutInvalid(*slice, chain.top()));
        if (chain.empty())
            throw BuildError(_file + ": step " + std::to_string(index) + " of its variable " + variable +
                             " cannot be used (" + errors.message() + "); check it with gdalmdiminfo.");
        double place[6];
        if (chain.file().GetGeoTransform(place) != CE_None && !bringAround(chain) &&
            !_array->GetCoordinateVariables().empty())
            return curved(index);
        const OGRSpatialReference* srs = chain.file().GetSpatialRef();
        const std::string degrees = lower(dimensions[_axes.x]->GetIndexingVariable()
                                              ? dimensions[_axes.x]->GetIndexingVariable()->GetUnit()
                                              : std::string());
        // The CF conventions' usual latitude and longitude.
        if ((!srs || srs->IsEmpty()) && degrees.compare(0, 6, "degree") == 0)
        {
            if (!_timed) RasterFile::remarkDegrees(_file);
            addVirtualRaster(chain, {"-a_srs", "EPSG:4326"}, _file);
        }
        bringToUnit(chain, dimensions);
        return chain;
    }

    static bool areColumnsFirst(const GDALMDArray& array)
    {
        Axes axes;
        return fits(array, axes, false) && axes.x < axes.y;
    }

private:
    /// A step of a variable whose places are in variables of their own. GDAL's reader of rasters, which is another one, knows these.
    DatasetChain curved(std::size_t index) const
    {
        const GdalErrorScope errors;
        const auto& dimensions = _array->GetDimensions();
        std::size_t band = 0;
        for (std::size_t i = 0; i < dimensions.size(); ++i)
            if (i != _axes.x && i != _axes.y)
                band = band * static_cast<std::size_t>(dimensions[i]->GetSize()) +
                       (i == _axes.time ? index : _others[i]);
        DatasetChain chain;
        chain.add(
            DatasetPtr(GDALDataset::Open(("NETCDF:\"" + _file + "\":" + variable).c_str(), GDAL_OF_RASTER)));
        if (chain.empty() || !RasterFile::hasPlaces(chain.top()) ||
            band >= static_cast<std::size_t>(chain.top().GetRasterCount()))
            throw BuildError(_file + ": the places of its variable " + variable +
                             " lie in variables of their own, as of a curved grid, that GDAL cannot read; "
                             "bring it to an even grid with "
                             "gdalwarp -geoloc, and name the result.");
        addVirtualRaster(chain, {"-b", std::to_string(band + 1)}, _file);
        return chain;
    }

    static bool isEven(const std::vector<double>& values)
    {
        if (values.size() < 2) return false;
        const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!(std::abs(values[i] - values.front() - static_cast<double>(i) * step) <
                  0.01 * std::abs(step)))
                return false;
        return true;
    }

    /// Longitudes may go on at 0 behind 360, or at −180 behind 180, where GDAL sees no even grid. Whether the raster has its place now.
    bool bringAround(DatasetChain& chain) const
    {
        const auto numbers = _array->GetDimensions()[_axes.x]->GetIndexingVariable();
        if (!numbers || lower(numbers->GetUnit()).compare(0, 6, "degree") != 0) return false;
        // Those of a curved grid may be called its axes.
        const auto rows = _array->GetDimensions()[_axes.y]->GetIndexingVariable();
        if (numbers->GetDimensionCount() != 1 || (rows && rows->GetDimensionCount() != 1)) return false;
        std::vector<double> x = numbersOf(_axes.x), y = numbersOf(_axes.y);
        for (std::size_t i = 1; i < x.size(); ++i)
            x[i] = x[i - 1] + std::remainder(x[i] - x[i - 1], 360.0);
        if (!isEven(x) || !isEven(y)) return false;
        // East of 180 degrees the grid lies in the west.
        const double turn = x.front() > 180.0 ? -360.0 : 0.0;
        const double wide = 0.5 * (x[1] - x[0]), high = 0.5 * (y[1] - y[0]);
        addVirtualRaster(chain,
                         {"-a_ullr", number(x.front() + turn - wide), number(y.front() - high),
                          number(x.back() + turn + wide), number(y.back() + high)},
                         _file);
        return true;
    }

    /// Axes may be in another unit than the coordinate system, such as kilometres.
    void bringToUnit(DatasetChain& chain, const std::vector<std::shared_ptr<GDALDimension>>& dimensions) const
    {
        const OGRSpatialReference* const srs = chain.top().GetSpatialRef();
        double place[6];
        if (!srs || !srs->IsProjected() || chain.top().GetGeoTransform(place) != CE_None) return;
        const auto factor = [&](std::size_t axis)
        {
            const auto numbers = dimensions[axis]->GetIndexingVariable();
            const auto metres = Lengths::metresPerUnit(numbers ? numbers->GetUnit() : std::string());
            return metres ? *metres / srs->GetLinearUnits() : 1.0;
        };
        const double wide = factor(_axes.x), high = factor(_axes.y);
        if (std::abs(wide - 1.0) < 1e-6 && std::abs(high - 1.0) < 1e-6) return;
        const double right = place[0] + place[1] * chain.top().GetRasterXSize();
        const double bottom = place[3] + place[5] * chain.top().GetRasterYSize();
        addVirtualRaster(chain,
                         {"-a_ullr", number(place[0] * wide), number(place[3] * high), number(right * wide),
                          number(bottom * high)},
                         _file);
    }

    /// Whether attributes say which values are valid, beside the one value that GDAL's bands can have for none.
    bool hasBounds() const
    {
        for (const char* const name : {"valid_min", "valid_max", "valid_range"})
            if (_array->GetAttribute(name)) return true;
        return _array->GetAttribute("missing_value") && _array->GetAttribute("_FillValue");
    }

    /// The values of a step in memory, with NaN where attributes say that they are none. Throws where these are too many.
    DatasetPtr withoutInvalid(const GDALMDArray& slice, GDALDataset& plain) const
    {
        const GdalErrorScope errors;
        const int columns = plain.GetRasterXSize(), rows = plain.GetRasterYSize();
        constexpr double most = 1 << 27; // a GiB
        if (static_cast<double>(columns) * rows > most)
            throw BuildError(
                _file + ": a step of its variable " + variable + " has " + std::to_string(columns) + " × " +
                std::to_string(rows) +
                " values, and those that are not valid are sorted out in memory; cut a part out with "
                "gdalmdimtranslate -subset.");
        GDALRasterBand& from = *plain.GetRasterBand(1);
        DatasetPtr result(GetGDALDriverManager()->GetDriverByName("MEM")->Create("", columns, rows, 1,
                                                                                 GDT_Float64, nullptr));
        const std::shared_ptr<GDALMDArray> mask = slice.GetMask(nullptr);
        const std::size_t x = _axes.x > _axes.y ? 1 : 0;
        const DatasetPtr valid(mask ? mask->AsClassicDataset(x, 1 - x) : nullptr);
        std::vector<double> values(static_cast<std::size_t>(columns));
        std::vector<unsigned char> kept(values.size());
        bool good = result && valid;
        for (int row = 0; good && row < rows; ++row)
        {
            good = from.RasterIO(GF_Read, 0, row, columns, 1, values.data(), columns, 1, GDT_Float64, 0, 0) ==
                       CE_None &&
                   valid->GetRasterBand(1)->RasterIO(GF_Read, 0, row, columns, 1, kept.data(), columns, 1,
                                                     GDT_Byte, 0, 0) == CE_None;
            for (std::size_t i = 0; i < values.size(); ++i)
                if (kept[i] == 0) values[i] = std::numeric_limits<double>::quiet_NaN();
            good = good && result->GetRasterBand(1)->RasterIO(GF_Write, 0, row, columns, 1, values.data(),
                                                              columns, 1, GDT_Float64, 0, 0) == CE_None;
        }
        if (!good)
            throw BuildError(_file + ": the values of its variable " + variable + " cannot be read (" +
                             errors.message() + "); check it with gdalmdiminfo.");
        double place[6];
        if (plain.GetGeoTransform(place) == CE_None) result->SetGeoTransform(place);
        result->SetSpatialRef(plain.GetSpatialRef());
        GDALRasterBand& to = *result->GetRasterBand(1);
        to.SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
        to.SetScale(from.GetScale());
        to.SetOffset(from.GetOffset());
        to.SetUnitType(from.GetUnitType());
        return result;
    }

    /// Which value of each further dimension is shown. `choice`: empty, or "[name=value,name=value]".
    void chooseOthers(const std::string& choice)
    {
        const auto& dimensions = _array->GetDimensions();
        _others.assign(dimensions.size(), 0);
        std::vector<bool> chosen(dimensions.size());
        const CPLStringList parts(
            CSLTokenizeString2(choice.c_str(), "[],", CSLT_STRIPLEADSPACES | CSLT_STRIPENDSPACES));
        for (int k = 0; k < parts.size(); ++k)
        {
            const std::string part = parts[k];
            const std::size_t sign = part.find('=');
            const std::string name = part.substr(0, sign);
            const auto found = std::find_if(dimensions.begin(), dimensions.end(),
                                            [&](const auto& each) { return each->GetName() == name; });
            const auto i = static_cast<std::size_t>(found - dimensions.begin());
            if (sign == std::string::npos || i == dimensions.size() || i == _axes.time || i == _axes.x ||
                i == _axes.y)
                throw BuildError(_file + ": \"" + part + "\" chooses nothing of its variable " + variable +
                                 "; " +
                                 (others().empty() ? "it has a time, rows and columns alone."
                                                   : "name a value of " + others() + "."));
            choose(i, part.substr(sign + 1));
            chosen[i] = true;
        }
        for (std::size_t i = 0; i < dimensions.size(); ++i)
            if (i != _axes.time && i != _axes.x && i != _axes.y && !chosen[i] && dimensions[i]->GetSize() > 1)
                remarkOnce(_file + ": of its variable " + variable + ", the first value of " +
                           dimensions[i]->GetName() + ", " + valuesOf(i, 1) + ", is shown of " +
                           std::to_string(dimensions[i]->GetSize()) + "; name another one as " + _file + ":" +
                           variable + "[" + dimensions[i]->GetName() + "=" + valuesOf(i, 1) + "]" +
                           (isTime(*dimensions[i]) ? ", or show all of them with --sequence." : "."));
    }

    /// The names of the dimensions that can be chosen of.
    std::string others() const
    {
        std::string names;
        const auto& dimensions = _array->GetDimensions();
        for (std::size_t i = 0; i < dimensions.size(); ++i)
            if (i != _axes.time && i != _axes.x && i != _axes.y)
                names += (names.empty() ? "" : ", ") + dimensions[i]->GetName();
        return names;
    }

    /// A dimension's values, or 0, 1, 2 … if it has none.
    std::vector<double> numbersOf(std::size_t dimension) const
    {
        const auto& axis = _array->GetDimensions()[dimension];
        std::vector<double> values(static_cast<std::size_t>(std::min<GUInt64>(axis->GetSize(), mostSteps)));
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<double>(i);
        const auto numbers = axis->GetIndexingVariable();
        const GUInt64 start = 0;
        const size_t size = values.size();
        const GdalErrorScope errors;
        if (numbers && numbers->GetDimensionCount() == 1 &&
            numbers->GetDataType().GetClass() == GEDTC_NUMERIC)
            numbers->Read(&start, &size, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64),
                          values.data());
        return values;
    }

    std::string valuesOf(std::size_t dimension, std::size_t most) const
    {
        const std::vector<double> values = numbersOf(dimension);
        std::string text;
        for (std::size_t i = 0; i < std::min(most, values.size()); ++i)
            text += (i > 0 ? ", " : "") + std::string(CPLSPrintf("%.9g", values[i]));
        return text + (most > 1 && values.size() > most ? " …" : "");
    }

    void choose(std::size_t dimension, const std::string& wanted)
    {
        const std::vector<double> values = numbersOf(dimension);
        char* end = nullptr;
        const double number = CPLStrtod(wanted.c_str(), &end);
        const bool isNumber = end != wanted.c_str() && *end == 0;
        for (std::size_t i = 0; isNumber && i < values.size(); ++i)
            if (std::abs(values[i] - number) <= 1e-6 * std::max(1.0, std::abs(number)))
            {
                _others[dimension] = i;
                return;
            }
        throw BuildError(_file + ": its dimension " + _array->GetDimensions()[dimension]->GetName() +
                         " has no value " + wanted + "; it has " + valuesOf(dimension, 12) + ".");
    }

    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    /// Of the dimensions; one may be none.
    struct Axes
    {
        std::size_t time = none, x = none, y = none;
    };

    static bool isTime(const GDALDimension& dimension)
    {
        return dimension.GetType() == GDAL_DIM_TYPE_TEMPORAL || isTimeDimension(dimension.GetName());
    }

    /// Whether a variable has an x and a y, and, if it needs one, a time beside them.
    static bool fits(const GDALMDArray& array, Axes& axes, bool timed)
    {
        const auto& dimensions = array.GetDimensions();
        if (dimensions.size() < (timed ? 3 : 2) || array.GetDataType().GetClass() != GEDTC_NUMERIC)
            return false;
        const auto time = std::find_if(dimensions.begin(), dimensions.end(),
                                       [](const auto& each) { return isTime(*each); });
        if (timed && time == dimensions.end()) return false;
        axes.time = timed ? static_cast<std::size_t>(time - dimensions.begin()) : none;
        // As a rule the last two, and y before x.
        axes.y = dimensions.size() - 2;
        axes.x = dimensions.size() - 1;
        for (std::size_t i = 0; i < dimensions.size(); ++i)
        {
            const std::string& type = dimensions[i]->GetType();
            if (type == GDAL_DIM_TYPE_HORIZONTAL_X) axes.x = i;
            if (type == GDAL_DIM_TYPE_HORIZONTAL_Y) axes.y = i;
        }
        return axes.x != axes.y && axes.x != axes.time && axes.y != axes.time;
    }

    std::shared_ptr<GDALMDArray> find(const GDALGroup& group, const std::string& wanted)
    {
        for (const std::string& name : group.GetMDArrayNames())
        {
            std::shared_ptr<GDALMDArray> array = group.OpenMDArray(name);
            if (array && (wanted.empty() || name == wanted) && fits(*array, _axes, _timed)) return array;
        }
        for (const std::string& name : group.GetGroupNames())
        {
            const std::shared_ptr<GDALGroup> child = group.OpenGroup(name);
            if (!child) continue;
            if (std::shared_ptr<GDALMDArray> array = find(*child, wanted)) return array;
        }
        return nullptr;
    }

    static std::string listed(const GDALGroup& root, bool timed)
    {
        std::string names;
        Axes axes;
        for (const std::string& name : root.GetMDArrayNames())
        {
            const std::shared_ptr<GDALMDArray> array = root.OpenMDArray(name);
            if (array && fits(*array, axes, timed)) names += (names.empty() ? "" : ", ") + name;
        }
        return names;
    }

    void readTimes()
    {
        const auto& dimension = _array->GetDimensions()[_axes.time];
        const auto count = static_cast<std::size_t>(dimension->GetSize());
        if (count == 0 || count > mostSteps)
            throw BuildError(_file + ": its variable " + variable + " has " + std::to_string(count) +
                             " steps; give it one to a million.");
        times.resize(count);
        const std::shared_ptr<GDALMDArray> numbers = dimension->GetIndexingVariable();
        const GUInt64 start = 0;
        const size_t size = count;
        const GdalErrorScope errors;
        if (!numbers || numbers->GetDimensionCount() != 1 ||
            !numbers->Read(&start, &size, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64),
                           times.data()))
        {
            for (std::size_t i = 0; i < count; ++i)
                times[i] = static_cast<double>(i);
            return;
        }
        std::string calendar;
        if (const std::shared_ptr<GDALAttribute> attribute = numbers->GetAttribute("calendar"))
        {
            const char* const text = attribute->ReadAsString();
            calendar = lower(text ? text : "");
        }
        const std::optional<TimeUnit> unitOfTime = TimeUnit::parse(numbers->GetUnit());
        const bool usual = calendar.empty() || calendar == "standard" || calendar == "gregorian" ||
                           calendar == "proleptic_gregorian";
        if (!unitOfTime)
        {
            if (numbers->GetUnit().find(" since ") != std::string::npos)
                remarkOnce(_file + ": the unit of its times, \"" + numbers->GetUnit().substr(0, 60) +
                           "\", is not known, so they count as they are; write seconds, minutes, hours, "
                           "days, months or years "
                           "since a date.");
            return;
        }
        // Years of other calendars have other days: their times count from the first one.
        dated = usual && unitOfTime->dated;
        const double first = times.front();
        for (double& time : times)
            time = dated ? unitOfTime->timeOf(time) : (time - first) * unitOfTime->seconds;
    }

    std::string _file;
    DatasetPtr _dataset;
    bool _timed;
    std::shared_ptr<GDALMDArray> _array;
    Axes _axes;
    std::vector<std::size_t>
        _others; ///< for each dimension the value that is shown; of time, rows and columns 0
};

/// The bands of a raster.
class BandSteps final : public TimeSteps
{
public:
    explicit BandSteps(std::string file) : _file(std::move(file))
    {
        const DatasetPtr dataset = RasterFile::openPlain(_file);
        std::vector<std::optional<double>> dates;
        const int last = dataset->GetRasterCount();
        _hasAlpha = last > 0 && dataset->GetRasterBand(last)->GetColorInterpretation() == GCI_AlphaBand;
        for (int i = 1; i <= (_hasAlpha ? last - 1 : last); ++i)
            dates.push_back(dateOf(*dataset->GetRasterBand(i)));
        if (dates.size() < 2)
            throw BuildError(_file +
                             ": it has one band and no time, so it does not change; show it with --mapping, "
                             "or name a folder of rasters.");
        setTimes(*this, dates, _file);
        checkTimes(*this, _file);
    }

    std::unique_ptr<FrameRaster> step(std::size_t index) override
    {
        const GdalErrorScope quiet;
        DatasetChain chain;
        chain.add(RasterFile::openPlain(_file));
        std::vector<std::string> bands{"-b", std::to_string(index + 1)};
        if (_hasAlpha) bands.insert(bands.end(), {"-b", std::to_string(chain.file().GetRasterCount())});
        addVirtualRaster(chain, bands, _file);
        return std::make_unique<FrameRaster>(_file, std::move(chain), DataLayer::VALUE);
    }

private:
    static std::optional<double> dateOf(GDALRasterBand& band)
    {
        // GRIB has seconds since 1970, and their unit behind them.
        const char* const grib = band.GetMetadataItem("GRIB_VALID_TIME");
        if (grib) return std::strtod(grib, nullptr);
        return dateIn(band.GetDescription());
    }

    std::string _file;
    bool _hasAlpha = false; ///< a last band that says which pixels are missing, and is no step
};

/// The rasters of a folder.
class FileSteps final : public TimeSteps
{
public:
    FileSteps(const std::string& folder, const RasterBands& bands) : _bands(bands)
    {
        std::error_code fault;
        for (const auto& each : fs::directory_iterator(folder, fault))
        {
            if (each.is_regular_file(fault) && !isBeside(each.path()) &&
                each.path().filename().string()[0] != '.')
                _files.push_back(each.path().string());
        }
        if (_files.empty())
            throw BuildError(folder + ": the folder has no rasters; put the steps into it, a file for each.");
        std::vector<std::pair<std::optional<double>, std::string>> named;
        for (const std::string& file : _files)
            named.emplace_back(dateIn(fs::path(file).stem().string()), file);
        const bool all =
            std::all_of(named.begin(), named.end(), [](const auto& each) { return each.first.has_value(); });
        std::sort(named.begin(), named.end(),
                  [&](const auto& a, const auto& b) {
                      return all && a.first != b.first ? a.first < b.first : standsBefore(a.second, b.second);
                  });
        std::vector<std::optional<double>> dates;
        for (std::size_t i = 0; i < named.size(); ++i)
        {
            dates.push_back(named[i].first);
            _files[i] = named[i].second;
        }
        setTimes(*this, dates, folder);
        checkTimes(*this, folder);
    }

    std::unique_ptr<FrameRaster> step(std::size_t index) override
    {
        auto raster = std::make_unique<FrameRaster>(_files[index], std::nullopt, true,
                                                    FrameRaster::ANY_FORMAT, -1, _bands);
        // All are as bright as the first.
        if (index == 0)
            for (std::size_t i = 0; i < _bands.channels.size(); ++i)
                _bands.channels[i].range = raster->bands.channels[i].range;
        return raster;
    }

private:
    /// Whether a file belongs to a raster beside it, or is none by its name.
    static bool isBeside(const fs::path& file)
    {
        const std::string ending = lower(file.extension().string());
        for (const char* const each :
             {".xml", ".ovr", ".msk", ".prj",  ".txt", ".json", ".idx", ".qml", ".qmd",
              ".sld", ".wld", ".clr", ".stx",  ".rrd", ".md5",  ".lgo", ".cpt", ".qgs",
              ".qgz", ".pdf", ".md",  ".html", ".py",  ".sh",   ".log"})
            if (ending == each) return true;
        // World files: .tfw, .pgw, .jgw, .tifw …
        if (ending.size() >= 4 && ending.size() <= 6 && ending.back() == 'w' && ending != ".raw") return true;
        // The header of a raster of plain numbers, or what some programs write beside others.
        if (ending != ".hdr") return false;
        for (const char* const each : {".bil", ".bip", ".bsq", ".flt", ".img", ".dat", ".raw", ".dem", ".tif",
                                       ".tiff", ".jpg", ".png", ""})
        {
            std::error_code fault;
            if (fs::is_regular_file(fs::path(file).replace_extension(each), fault)) return true;
        }
        return false;
    }

    std::vector<std::string> _files;
    RasterBands _bands;
};

} // namespace

TimeSteps::~TimeSteps() = default;

DatasetChain TimeSteps::first(const std::string& file, const std::string& variable)
{
    const GdalErrorScope quiet; // metadata may be read late
    DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_MULTIDIM_RASTER));
    if (!dataset) return {};
    return DimensionSteps(file, std::move(dataset), variable, false).rasterOf(0);
}

bool TimeSteps::hasColumnsFirst(const std::string& file, const std::string& variable)
{
    const GdalErrorScope quiet;
    const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_MULTIDIM_RASTER));
    const std::shared_ptr<GDALGroup> root = dataset ? dataset->GetRootGroup() : nullptr;
    const std::shared_ptr<GDALMDArray> array = root ? root->OpenMDArray(variable) : nullptr;
    return array && DimensionSteps::areColumnsFirst(*array);
}

std::unique_ptr<TimeSteps> TimeSteps::open(const std::string& file, const std::string& variable,
                                           const RasterBands& bands)
{
    initialiseGdal();
    std::error_code fault;
    const bool folder = fs::is_directory(file, fault);
    const GdalErrorScope quiet; // metadata may be read late
    DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_MULTIDIM_RASTER));
    // A folder may be a Zarr, too.
    if (dataset) return std::make_unique<DimensionSteps>(file, std::move(dataset), variable);
    if (!variable.empty())
        throw BuildError(file + ": it has no variables, so \"" + variable +
                         "\" is none of it; name the file alone.");
    if (folder) return std::make_unique<FileSteps>(file, bands);
    return std::make_unique<BandSteps>(file);
}

} // namespace osgGeoFX
