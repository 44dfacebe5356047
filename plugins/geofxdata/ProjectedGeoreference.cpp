// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "ProjectedGeoreference.h"

#include <osgGeoFX/geodata/CoordinateText.h>

#include <cpl_error.h>

#include <osg/Math>

#include <algorithm>

namespace osgGeoFX
{

osg::ref_ptr<ProjectedGeoreference> ProjectedGeoreference::create(const std::string& wkt, std::string& error)
{
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    OGRSpatialReference grid;
    if (!setCoordinateSystem(grid, wkt))
    {
        error =
            "The coordinate system of the database is not understood; build it again with --srs EPSG:N (a "
            "coordinate system is WKT, a PROJ string, or a code such as EPSG:32604).";
        return nullptr;
    }
    grid.StripVertical();
    if (!grid.IsProjected())
    {
        error = "The coordinate system \"" + std::string(grid.GetName()) +
                "\" is not a projected one; build the database again with --geocentric or with --srs EPSG:N.";
        return nullptr;
    }
    grid.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference degrees;
    degrees.importFromEPSG(4326);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    Transformation toGrid(OGRCreateCoordinateTransformation(&degrees, &grid));
    Transformation fromGrid(OGRCreateCoordinateTransformation(&grid, &degrees));
    if (!toGrid || !fromGrid)
    {
        error = "No transformation is known between the coordinate system \"" + std::string(grid.GetName()) +
                "\" and WGS 84 (" + CPLGetLastErrorMsg() +
                "); build the database again with --srs EPSG:N of another.";
        return nullptr;
    }
    return new ProjectedGeoreference(std::move(toGrid), std::move(fromGrid), grid.GetLinearUnits());
}

ProjectedGeoreference::ProjectedGeoreference(Transformation toGrid, Transformation fromGrid,
                                             double metresPerUnit)
    : _toGrid(std::move(toGrid)), _fromGrid(std::move(fromGrid)), _metresPerUnit(metresPerUnit)
{
}

ProjectedGeoreference::ProjectedGeoreference(const ProjectedGeoreference& other, const osg::CopyOp& op)
    : Georeference(other, op), _metresPerUnit(other._metresPerUnit)
{
    const std::lock_guard<std::mutex> lock(other._mutex);
    _toGrid.reset(other._toGrid->Clone());
    _fromGrid.reset(other._fromGrid->Clone());
}

osg::Object* ProjectedGeoreference::clone(const osg::CopyOp& op) const
{
    return new ProjectedGeoreference(*this, op);
}

bool ProjectedGeoreference::transform(OGRCoordinateTransformation& transformation, double& x, double& y) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
    int success = FALSE;
    transformation.Transform(1, &x, &y, nullptr, &success);
    return success != FALSE;
}

bool ProjectedGeoreference::toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const
{
    double x = osg::RadiansToDegrees(longitude), y = osg::RadiansToDegrees(latitude);
    if (!transform(*_toGrid, x, y)) return false;
    world.set(x * _metresPerUnit, y * _metresPerUnit, height);
    return true;
}

bool ProjectedGeoreference::toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                                       double& height) const
{
    double x = world.x() / _metresPerUnit, y = world.y() / _metresPerUnit;
    if (!transform(*_fromGrid, x, y)) return false;
    longitude = osg::DegreesToRadians(x);
    latitude = osg::DegreesToRadians(y);
    height = world.z();
    return true;
}

bool ProjectedGeoreference::localToWorld(double longitude, double latitude, double height,
                                         osg::Matrixd& frame) const
{
    // True north is the direction of a short piece of the meridian; 64 m keep both rounding and curvature
    // below 1e-9 radians. At a pole half of it is there.
    constexpr double step = 1e-5;
    osg::Vec3d place, north, south;
    if (!toWorld(longitude, latitude, height, place) ||
        !toWorld(longitude, std::min(latitude + step, osg::PI_2), height, north) ||
        !toWorld(longitude, std::max(latitude - step, -osg::PI_2), height, south))
        return false;
    osg::Vec3d y = north - south;
    if (y.normalize() == 0.0) return false;
    frame.set(y.y(), -y.x(), 0.0, 0.0, //
              y.x(), y.y(), 0.0, 0.0,  //
              0.0, 0.0, 1.0, 0.0,      //
              place.x(), place.y(), place.z(), 1.0);
    return true;
}

} // namespace osgGeoFX
