// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "GdalSupport.h"

#include <osgGeoFX/geodata/BuildError.h>

#include <cpl_error.h>

#include <mutex>

namespace osgGeoFX
{

BuildError::~BuildError() = default;

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

} // namespace osgGeoFX
