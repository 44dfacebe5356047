// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/RasterFile.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/ReadingErrors.h>
#include <osgGeoFX/geodata/detail/Remarks.h>
#include <osgGeoFX/geodata/detail/StepDates.h>
#include <osgGeoFX/geodata/detail/TileAddress.h>
#include <osgGeoFX/geodata/detail/TimeSteps.h>
#include <osgGeoFX/geodata/detail/VirtualRaster.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/paging/ReadingFile.h>

#include <cpl_string.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace osgGeoFX
{

namespace
{

bool endsWith(const std::string& text, const std::string& end)
{
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The last part of a name of GDAL's, such as `NETCDF:"f.nc":t2m` or `HDF5:"f.h5"://group/t2m`.
std::string variableIn(const std::string& name)
{
    const std::size_t end = name.find_last_of(":/");
    return end == std::string::npos ? name : name.substr(end + 1);
}

/// The names by which GDAL opens parts of a file.
std::vector<std::string> partsOf(GDALDataset& dataset)
{
    std::vector<std::string> parts;
    char** items = dataset.GetMetadata("SUBDATASETS");
    for (; items && *items; ++items)
    {
        const std::string item = *items;
        const std::size_t sign = item.find("_NAME=");
        if (sign != std::string::npos) parts.push_back(item.substr(sign + 6));
    }
    return parts;
}

std::string listed(const std::vector<std::string>& parts)
{
    constexpr std::size_t most = 12;
    std::string names;
    for (std::size_t i = 0; i < std::min(most, parts.size()); ++i)
        names += (i > 0 ? ", " : "") + variableIn(parts[i]);
    return names + (parts.size() > most ? " …" : "");
}

DatasetPtr opened(const std::string& name, const char* const* options)
{
    return DatasetPtr(GDALDataset::Open(TileAddress::forGdal(name).c_str(),
                                        GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR, nullptr, options));
}

/// A part of a file with subdatasets.
DatasetChain openPart(const std::string& file, const std::string& variable, const char* const* options)
{
    const DatasetPtr whole = RasterFile::openPlain(file);
    const GdalErrorScope errors;
    DatasetChain chain;
    const std::vector<std::string> parts = partsOf(*whole);
    for (const std::string& part : parts)
        if (variableIn(part) == variable) chain.add(opened(part, options));
    if (chain.empty() && !parts.empty())
        throw BuildError(file + ": it has no raster \"" + variable + "\"; it has " + listed(parts) + ".");
    if (chain.empty())
        throw BuildError(file + ": it has no variables, so \"" + variable +
                         "\" is none of it; name the file alone.");
    return chain;
}

/// The time of a band of netCDF, for people; empty if it has none. `dimension` counts the times.
std::string timeOf(GDALDataset& raster, GDALRasterBand& band, const std::string& dimension)
{
    const char* const number = band.GetMetadataItem(("NETCDF_DIM_" + dimension).c_str());
    const char* const unit = raster.GetMetadataItem((dimension + "#units").c_str());
    const std::optional<TimeUnit> known = number && unit ? TimeUnit::parse(unit) : std::nullopt;
    if (!known || !known->dated) return number ? number : "";
    const osg::ref_ptr<LayerClock> clock = new LayerClock;
    clock->setDated(true);
    return clock->text(known->timeOf(CPLAtof(number)));
}

/// Of bands that are times, levels or fields of one thing, the first one.
void takeFirst(DatasetChain& chain, const std::string& name)
{
    GDALDataset& raster = chain.top();
    const int count = raster.GetRasterCount();
    if (count < 2) return;
    GDALRasterBand& band = *raster.GetRasterBand(1);
    const std::string file = name + ": of its " + std::to_string(count);
    if (const char* const dimensions = raster.GetMetadataItem("NETCDF_DIM_EXTRA"))
    {
        const std::string which = dimensions;
        const CPLStringList names(CSLTokenizeString2(dimensions, "{},", 0));
        const auto* const time = std::find_if(names.List(), names.List() + names.size(),
                                              [](const char* each) { return isTimeDimension(each); });
        const bool timed = time != names.List() + names.size();
        if (timed && names.size() == 1)
            remarkOnce(file + " times the first, " + timeOf(raster, band, *time) +
                       ", is taken; --sequence shows them all.");
        else
            remarkOnce(file + " bands by " + which + " the first is taken; name others as " + name +
                       ":VARIABLE[DIMENSION=VALUE]" + (timed ? "; --sequence shows all times." : "."));
    }
    else if (band.GetMetadataItem("GRIB_ELEMENT"))
    {
        const char* const comment = band.GetMetadataItem("GRIB_COMMENT");
        const auto hourOf = [](GDALRasterBand& field)
        {
            const char* const seconds = field.GetMetadataItem("GRIB_VALID_TIME");
            return std::string(seconds ? seconds : "");
        };
        const bool timed = hourOf(band) != hourOf(*raster.GetRasterBand(count));
        remarkOnce(file + " fields the first, " + (comment ? comment : band.GetDescription()) +
                   ", is taken; cut another one out with gdal_translate -b" +
                   (timed ? ", or show all times with --sequence." : "."));
    }
    else
        return;
    addVirtualRaster(chain, {"-b", "1"}, name);
}

/// Files after the CF conventions that have degrees along their axes need not name a datum. It is taken to be WGS 84.
void assumeDegrees(DatasetChain& chain, const std::string& name)
{
    GDALDataset& raster = chain.top();
    const OGRSpatialReference* const srs = raster.GetSpatialRef();
    double place[6];
    if ((srs && !srs->IsEmpty()) || raster.GetGCPCount() > 0 || raster.GetGeoTransform(place) != CE_None)
        return;
    const auto hasAxis = [&raster](const std::string& unit)
    {
        char** items = raster.GetMetadata();
        for (; items && *items; ++items)
            if (endsWith(*items, "#units=" + unit)) return true;
        return false;
    };
    if (!hasAxis("degrees_east") || !hasAxis("degrees_north")) return;
    RasterFile::remarkDegrees(name);
    addVirtualRaster(chain, {"-a_srs", "EPSG:4326"}, name);
}

} // namespace

void RasterFile::remarkDegrees(const std::string& name)
{
    remarkOnce(name +
               ": it names no coordinate reference system, but has degrees along its axes, so that WGS 84 is "
               "taken.");
}

std::pair<std::string, std::string> RasterFile::parse(const std::string& name)
{
    // What brackets choose may have colons, as a time of day.
    const std::size_t bracket = name.empty() || name.back() != ']' ? name.size() : name.rfind('[');
    const std::size_t colon = name.substr(0, bracket).rfind(':');
    // That of an address, "/vsicurl/https://…", is none.
    const std::size_t slash = name.substr(0, bracket).rfind('/');
    if (colon == std::string::npos || (slash != std::string::npos && colon < slash)) return {name, ""};
    const std::string file = name.substr(0, colon);
    std::error_code fault;
    if (std::filesystem::exists(name, fault)) return {name, ""};
    if (file.rfind("/vsi", 0) != 0 && !std::filesystem::exists(file, fault)) return {name, ""};
    return {file, name.substr(colon + 1)};
}

DatasetPtr RasterFile::openPlain(const std::string& name, const char* const* options)
{
    const GdalErrorScope errors;
    DatasetPtr dataset = opened(name, options);
    if (!dataset && errors.message().find("not recognized") != std::string::npos &&
        GDALIdentifyDriverEx(name.c_str(), GDAL_OF_VECTOR, nullptr, nullptr))
        throw BuildError(name +
                         ": it has vector data and no raster; make a raster of it with gdal_rasterize.");
    if (!dataset)
        throw BuildError(refusalOf(name, "a raster", errors.message(),
                                   "check it with gdalinfo, or convert it to GeoTIFF") +
                         ".");
    // The CF conventions' discrete sampling geometries.
    const GdalErrorScope quiet;
    const char* const places = dataset->GetMetadataItem("NC_GLOBAL#featureType");
    for (const char* const each :
         {"point", "timeSeries", "trajectory", "profile", "timeSeriesProfile", "trajectoryProfile"})
        if (places && EQUAL(places, each))
            throw BuildError(name + ": its values are of single places (featureType " + places +
                             "), not of a raster; bring them to one with gdal_grid.");
    return dataset;
}

DatasetChain RasterFile::open(const std::string& name, const char* const* options)
{
    initialiseGdal();
    const auto [file, variable] = parse(name);
    const ReadingFile reading(name);
    DatasetChain chain;
    if (!variable.empty())
    {
        chain = TimeSteps::first(file, variable);
        return chain.empty() ? openPart(file, variable, options) : std::move(chain);
    }
    chain.add(openPlain(name, options));
    if (chain.top().GetRasterCount() == 0)
    {
        const std::vector<std::string> parts = partsOf(chain.top());
        throw BuildError(name + (parts.empty()
                                     ? ": it holds no raster band; check it with gdalinfo."
                                     : ": it holds several rasters, " + listed(parts) + "; name one as " +
                                           name + ":" + variableIn(parts[0]) + "."));
    }
    const GdalErrorScope quiet; // metadata may be read late
    const char* const only = chain.top().GetRasterBand(1)->GetMetadataItem("NETCDF_VARNAME");
    if (only && TimeSteps::hasColumnsFirst(name, only)) return TimeSteps::first(name, only);
    takeFirst(chain, name);
    assumeDegrees(chain, name);
    return chain;
}

bool RasterFile::isRaster(const std::string& file)
{
    initialiseGdal();
    const GdalErrorScope quiet;
    const ReadingFile reading(file);
    return TileAddress::is(file) || DatasetPtr(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER)) != nullptr;
}

bool RasterFile::hasPlaces(GDALDataset& raster)
{
    return raster.GetMetadata("GEOLOCATION") != nullptr;
}

} // namespace osgGeoFX
