// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/TimeSteps.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/mapping/LayerClock.h>

#include <cpl_string.h>
#include <gdal_utils.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
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

DatasetPtr openRaster(const std::string& file)
{
    const GdalErrorScope errors;
    DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
    if (!dataset)
        throw BuildError(file + ": it is not a raster that GDAL can read (" + errors.message() +
                         "); check it with gdalinfo.");
    return dataset;
}

/// A virtual dataset above the last one.
void addVirtual(DatasetChain& chain, const std::vector<std::string>& arguments, const std::string& file)
{
    CPLStringList list;
    list.AddString("-of");
    list.AddString("VRT");
    for (const std::string& each : arguments)
        list.AddString(each.c_str());
    const GdalErrorScope errors;
    GDALTranslateOptions* options = GDALTranslateOptionsNew(list.List(), nullptr);
    GDALDatasetH result = GDALTranslate("", GDALDataset::ToHandle(&chain.top()), options, nullptr);
    GDALTranslateOptionsFree(options);
    if (!result)
        throw BuildError(file + ": a step of it cannot be used (" + errors.message() +
                         "); check it with gdalinfo.");
    chain.add(DatasetPtr(GDALDataset::FromHandle(result)));
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
    steps.dated = false;
    for (std::size_t i = 0; i < steps.times.size(); ++i)
        steps.times[i] = static_cast<double>(i);
}

/// Takes times if all steps have one, else counts.
void setTimes(TimeSteps& steps, const std::vector<std::optional<double>>& times)
{
    steps.dated = std::all_of(times.begin(), times.end(), [](const auto& time) { return time.has_value(); });
    for (std::size_t i = 0; i < times.size(); ++i)
        steps.times.push_back(steps.dated ? *times[i] : static_cast<double>(i));
}

/// The time dimension of a variable.
class DimensionSteps final : public TimeSteps
{
public:
    DimensionSteps(std::string file, DatasetPtr dataset, const std::string& wanted)
        : _file(std::move(file)), _dataset(std::move(dataset))
    {
        const std::shared_ptr<GDALGroup> root = _dataset->GetRootGroup();
        if (!root) throw BuildError(_file + ": it holds no variables; check it with gdalmdiminfo.");
        _array = find(*root, wanted);
        if (!_array)
        {
            const std::string names = listed(*root);
            throw BuildError(_file + ": " +
                             (wanted.empty()
                                  ? std::string("no variable of it has a time, rows and columns")
                                  : "it has no variable \"" + wanted + "\" with a time, rows and columns") +
                             (names.empty() ? "; check it with gdalmdiminfo." : "; it has " + names + "."));
        }
        variable = _array->GetName();
        unit = _array->GetUnit();
        readTimes();
        checkTimes(*this, _file);
    }

    std::unique_ptr<FrameRaster> step(std::size_t index) override
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
                view += "0"; // the first level, or member
        }
        const std::shared_ptr<GDALMDArray> slice = _array->GetView(view + "]");
        const std::size_t x = _axes.x > _axes.y ? 1 : 0;
        DatasetChain chain;
        if (slice) chain.add(DatasetPtr(slice->AsClassicDataset(x, 1 - x)));
        if (chain.empty())
            throw BuildError(_file + ": step " + std::to_string(index) + " of its variable " + variable +
                             " cannot be used (" + errors.message() + "); check it with gdalmdiminfo.");
        const OGRSpatialReference* srs = chain.file().GetSpatialRef();
        const std::string degrees = lower(dimensions[_axes.x]->GetIndexingVariable()
                                              ? dimensions[_axes.x]->GetIndexingVariable()->GetUnit()
                                              : std::string());
        // The CF conventions' usual latitude and longitude.
        if ((!srs || srs->IsEmpty()) && degrees.compare(0, 6, "degree") == 0)
            addVirtual(chain, {"-a_srs", "EPSG:4326"}, _file);
        return std::make_unique<FrameRaster>(_file, std::move(chain), DataLayer::VALUE);
    }

private:
    struct Axes
    {
        std::size_t time = 0, x = 0, y = 0;
    };

    static bool isTime(const GDALDimension& dimension)
    {
        const std::string name = lower(dimension.GetName());
        return dimension.GetType() == GDAL_DIM_TYPE_TEMPORAL || name == "time" || name == "valid_time";
    }

    /// Whether a variable has a time, and an x and a y beside it.
    static bool fits(const GDALMDArray& array, Axes& axes)
    {
        const auto& dimensions = array.GetDimensions();
        if (dimensions.size() < 3 || array.GetDataType().GetClass() != GEDTC_NUMERIC) return false;
        const auto time = std::find_if(dimensions.begin(), dimensions.end(),
                                       [](const auto& each) { return isTime(*each); });
        if (time == dimensions.end()) return false;
        axes.time = static_cast<std::size_t>(time - dimensions.begin());
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
            if (array && (wanted.empty() || name == wanted) && fits(*array, _axes)) return array;
        }
        for (const std::string& name : group.GetGroupNames())
        {
            const std::shared_ptr<GDALGroup> child = group.OpenGroup(name);
            if (!child) continue;
            if (std::shared_ptr<GDALMDArray> array = find(*child, wanted)) return array;
        }
        return nullptr;
    }

    static std::string listed(const GDALGroup& root)
    {
        std::string names;
        Axes axes;
        for (const std::string& name : root.GetMDArrayNames())
        {
            const std::shared_ptr<GDALMDArray> array = root.OpenMDArray(name);
            if (array && fits(*array, axes)) names += (names.empty() ? "" : ", ") + name;
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
        if (!unitOfTime) return;
        // Years of other calendars have other days: their times count from the first one.
        dated = usual;
        const double first = usual ? 0.0 : times.front();
        for (double& time : times)
            time = (time - first) * unitOfTime->seconds + (usual ? unitOfTime->start : 0.0);
    }

    std::string _file;
    DatasetPtr _dataset;
    std::shared_ptr<GDALMDArray> _array;
    Axes _axes;
};

/// The bands of a raster.
class BandSteps final : public TimeSteps
{
public:
    explicit BandSteps(std::string file) : _file(std::move(file))
    {
        const DatasetPtr dataset = openRaster(_file);
        std::vector<std::optional<double>> dates;
        for (int i = 1; i <= dataset->GetRasterCount(); ++i)
            dates.push_back(dateOf(*dataset->GetRasterBand(i)));
        if (dates.size() < 2)
            throw BuildError(_file +
                             ": it has one band and no time, so it does not change; show it with --mapping, "
                             "or name a folder of rasters.");
        setTimes(*this, dates);
        checkTimes(*this, _file);
    }

    std::unique_ptr<FrameRaster> step(std::size_t index) override
    {
        DatasetChain chain;
        chain.add(openRaster(_file));
        addVirtual(chain, {"-b", std::to_string(index + 1)}, _file);
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
};

/// The rasters of a folder.
class FileSteps final : public TimeSteps
{
public:
    explicit FileSteps(const std::string& folder)
    {
        std::error_code fault;
        for (const auto& each : fs::directory_iterator(folder, fault))
        {
            const std::string ending = lower(each.path().extension().string());
            const bool beside = ending == ".xml" || ending == ".ovr" || ending == ".msk" ||
                                ending == ".prj" || ending == ".tfw" || ending == ".txt" ||
                                ending == ".json" || ending == ".idx";
            if (each.is_regular_file(fault) && !beside && each.path().filename().string()[0] != '.')
                _files.push_back(each.path().string());
        }
        if (_files.empty())
            throw BuildError(folder + ": the folder has no rasters; put the steps into it, a file for each.");
        std::sort(_files.begin(), _files.end());
        std::vector<std::optional<double>> dates;
        for (const std::string& file : _files)
            dates.push_back(dateIn(fs::path(file).stem().string()));
        setTimes(*this, dates);
        checkTimes(*this, folder);
    }

    std::unique_ptr<FrameRaster> step(std::size_t index) override
    {
        return std::make_unique<FrameRaster>(_files[index], std::nullopt);
    }

private:
    std::vector<std::string> _files;
};

} // namespace

TimeSteps::~TimeSteps() = default;

std::optional<TimeUnit> TimeUnit::parse(const std::string& text)
{
    const std::string all = lower(text);
    TimeUnit unit;
    if (all == "sec utc") return unit;
    const std::size_t since = all.find(" since ");
    const std::string word = all.substr(0, since);
    const std::pair<const char*, double> units[] = {{"ns", 1e-9},
                                                    {"nanosecond", 1e-9},
                                                    {"nanoseconds", 1e-9},
                                                    {"us", 1e-6},
                                                    {"microsecond", 1e-6},
                                                    {"microseconds", 1e-6},
                                                    {"ms", 1e-3},
                                                    {"msec", 1e-3},
                                                    {"millisecond", 1e-3},
                                                    {"milliseconds", 1e-3},
                                                    {"s", 1.0},
                                                    {"sec", 1.0},
                                                    {"second", 1.0},
                                                    {"seconds", 1.0},
                                                    {"min", 60.0},
                                                    {"minute", 60.0},
                                                    {"minutes", 60.0},
                                                    {"h", 3600.0},
                                                    {"hr", 3600.0},
                                                    {"hour", 3600.0},
                                                    {"hours", 3600.0},
                                                    {"d", 86400.0},
                                                    {"day", 86400.0},
                                                    {"days", 86400.0}};
    const auto* const known = std::find_if(std::begin(units), std::end(units),
                                           [&](const auto& each) { return word == each.first; });
    if (known == std::end(units) || since == std::string::npos) return std::nullopt;
    unit.seconds = known->second;
    const std::optional<double> start = LayerClock::parseDate(text.substr(since + 7));
    if (!start) return std::nullopt;
    unit.start = *start;
    return unit;
}

std::optional<double> dateIn(const std::string& text)
{
    // Digits alone, whatever stands between them: year, month, day, and perhaps hour, minute and second.
    for (std::size_t at = 0; at < text.size(); ++at)
    {
        if (!std::isdigit(static_cast<unsigned char>(text[at]))) continue;
        if (at > 0 && std::isdigit(static_cast<unsigned char>(text[at - 1]))) continue;
        std::string digits;
        std::size_t next = at;
        while (next < text.size() && digits.size() < 14)
        {
            const auto c = static_cast<unsigned char>(text[next]);
            const bool gap = c == '-' || c == ':' || c == '_' || c == ' ' || c == 'T' || c == 't';
            if (!std::isdigit(c) && !(gap && digits.size() >= 4 && digits.size() % 2 == 0)) break;
            if (std::isdigit(c)) digits += static_cast<char>(c);
            ++next;
        }
        if (digits.size() < 8) continue;
        const auto number = [&](std::size_t from, std::size_t count)
        {
            return from + count <= digits.size() ? std::atoi(digits.substr(from, count).c_str()) : 0;
        };
        const std::string date = digits.substr(0, 4) + "-" + digits.substr(4, 2) + "-" + digits.substr(6, 2);
        const std::optional<double> day = LayerClock::parseDate(date);
        if (!day || number(8, 2) > 23 || number(10, 2) > 59 || number(12, 2) > 59) continue;
        return *day + number(8, 2) * 3600.0 + number(10, 2) * 60.0 + number(12, 2);
    }
    return std::nullopt;
}

std::unique_ptr<TimeSteps> TimeSteps::open(const std::string& file, const std::string& variable)
{
    initialiseGdal();
    std::error_code fault;
    const bool folder = fs::is_directory(file, fault);
    DatasetPtr dataset;
    {
        const GdalErrorScope errors;
        dataset.reset(GDALDataset::Open(file.c_str(), GDAL_OF_MULTIDIM_RASTER));
    }
    // A folder may be a Zarr, too.
    if (dataset) return std::make_unique<DimensionSteps>(file, std::move(dataset), variable);
    if (!variable.empty())
        throw BuildError(file + ": it has no variables, so \"" + variable +
                         "\" is none of it; name the file alone.");
    if (folder) return std::make_unique<FileSteps>(file);
    return std::make_unique<BandSteps>(file);
}

} // namespace osgGeoFX
