// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <cpl_error.h>

#include <mutex>

namespace osgGeoFX
{

BuildError::~BuildError() = default;

bool DatasetChain::add(DatasetPtr dataset)
{
    if (!dataset) return false;
    constexpr int references = 65536; // a virtual dataset takes one away for each band and overview
    for (int i = 0; i < references; ++i)
        dataset->Reference();
    _datasets.push_back(std::move(dataset));
    return true;
}

void DatasetChain::clear()
{
    while (!_datasets.empty())
        _datasets.pop_back();
}

void initialiseGdal()
{
    static std::once_flag once;
    std::call_once(once, [] { GDALAllRegister(); });
}

GdalErrorScope::GdalErrorScope()
{
    CPLPushErrorHandlerEx(&GdalErrorScope::handle, this);
}

GdalErrorScope::~GdalErrorScope()
{
    CPLPopErrorHandler();
}

void CPL_STDCALL GdalErrorScope::handle(CPLErr severity, CPLErrorNum, const char* text)
{
    auto* scope = static_cast<GdalErrorScope*>(CPLGetErrorHandlerUserData());
    if (severity >= CE_Failure && scope->_message.empty()) scope->_message = text;
}

OGRSpatialReference gisOrder(OGRSpatialReference srs)
{
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return srs;
}

TransformationPtr createTransformation(const OGRSpatialReference& from, const OGRSpatialReference& to,
                                       const std::string& file)
{
    GdalErrorScope errors;
    TransformationPtr result(OGRCreateCoordinateTransformation(&from, &to));
    if (!result)
        throw BuildError(file + ": no transformation is known from the CRS \"" + from.GetName() + "\" to \"" +
                         to.GetName() + "\" (" + errors.message() +
                         "); reproject the file with gdalwarp first.");
    return result;
}

DatasetPtr openVectors(const std::string& file)
{
    const GdalErrorScope errors;
    DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_VERBOSE_ERROR));
    if (!dataset)
        throw BuildError(file + ": it is not vector data that GDAL can read (" + errors.message() +
                         "); check it with ogrinfo, or convert it with ogr2ogr.");
    return dataset;
}

void forEachLayer(GDALDataset& dataset, const std::string& layer, const std::string& file,
                  const std::function<void(OGRLayer&)>& take)
{
    if (layer.empty())
    {
        for (OGRLayer* const each : dataset.GetLayers())
            take(*each);
        return;
    }
    OGRLayer* const named = dataset.GetLayerByName(layer.c_str());
    if (!named) throw BuildError(file + ": it has no layer \"" + layer + "\"; ogrinfo lists those it has.");
    take(*named);
}

void forEachFeature(
    OGRLayer& layer, const OGRSpatialReference& target, const std::string& file,
    const std::function<void(const OGRFeature&, const OGRGeometry&, OGRCoordinateTransformation&)>& take,
    LongLines longLines)
{
    const OGRSpatialReference* srs = layer.GetSpatialRef();
    if (!srs || srs->IsEmpty() || srs->IsLocal())
        throw BuildError(file + ": its layer " + std::string(layer.GetName()) +
                         " has no coordinate reference system; name it with ogr2ogr -a_srs EPSG:N.");
    const TransformationPtr toTarget = createTransformation(gisOrder(*srs), gisOrder(target), file);
    const double part = srs->IsGeographic() ? 0.01 : 1000.0 / srs->GetLinearUnits();
    const GdalErrorScope errors;
    for (const auto& feature : layer)
    {
        if (!feature->GetGeometryRef()) continue;
        const std::unique_ptr<OGRGeometry> geometry(feature->GetGeometryRef()->getLinearGeometry());
        if (!geometry) continue;
        if (longLines == LongLines::DIVIDED) geometry->segmentize(part);
        take(*feature, *geometry, *toTarget);
    }
    if (errors.failed())
        throw BuildError(file + ": its features cannot be read (" + errors.message() +
                         "); the file may be cut short: copy or export it again.");
}

} // namespace osgGeoFX
