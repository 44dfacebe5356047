// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/SurfaceRaster.h>
#include <tools/GeofxPlugins.h>
#include <tools/NotifyWatch.h>
#include <tools/SurfaceLayers.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <osg/Math>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

namespace geofx::test
{

using osgGeoFX::MappingFrame;
using osgGeoFX::SurfaceData;
using osgGeoFX::SurfaceRaster;

inline MappingFrame globeAt(double longitude, double latitude)
{
    MappingFrame frame;
    frame.origin =
        osgGeoFX::LocalOrigin::onGlobe(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude));
    return frame;
}

/// On the ellipsoid, in the frame of a globe.
inline osg::Vec2d placeOf(const MappingFrame& frame, double longitude, double latitude)
{
    double x = 0.0, y = 0.0, z = 0.0;
    GeographicLib::LocalCartesian(osg::RadiansToDegrees(frame.origin.latitude),
                                  osg::RadiansToDegrees(frame.origin.longitude), 0.0)
        .Forward(latitude, longitude, 0.0, x, y, z);
    return {x, y};
}

/// The column and row of a place's texel.
inline std::pair<int, int> texelOf(const SurfaceData& data, const osg::Vec2d& place)
{
    const osg::Vec2d from = place - data.getLow();
    return {static_cast<int>(std::floor(from.x() / data.getSpacing().x())),
            static_cast<int>(std::floor(from.y() / data.getSpacing().y()))};
}

/// A raster of 10 m pixels south-east of the origin of a UTM terrain, in its own coordinate system, and data about it.
class SurfaceRasterFixture : public testing::Test
{
protected:
    SurfaceRasterFixture()
    {
        GDALAllRegister();
        _frame.globe = false;
        _frame.wkt = wktOf(32604);
        _frame.origin = osgGeoFX::LocalOrigin::onPlane(osg::Vec2d(600000.0, 2300000.0));
        _data->setLocalOrigin(_frame.origin);
        _data->setRectangle(osg::Vec2d(0.0, -400.0), osg::Vec2d(600.0, 0.0));
    }

    static TestRaster raster(int columns, int rows, int bands = 1, GDALDataType type = GDT_Float32)
    {
        TestRaster result(columns, rows, bands, type);
        result.placed(600000.0, 2300000.0, 10.0, 10.0).crs("EPSG:32604");
        return result;
    }

    /// A sentence with the file; and nothing new in the data.
    std::string sentenceOf(const std::string& file, const std::function<bool(std::string&)>& action)
    {
        const int layers = _data->getNumLayers();
        const unsigned int revision = _data->revision();
        std::string error;
        EXPECT_FALSE(action(error));
        EXPECT_EQ(error.rfind(file + ": ", 0), 0u) << error;
        EXPECT_EQ(error.empty() ? ' ' : error.back(), '.') << error;
        EXPECT_EQ(_data->getNumLayers(), layers);
        EXPECT_EQ(_data->revision(), revision);
        return error;
    }
    const TempDir _folder;
    NotifyWatch _watch;
    MappingFrame _frame;
    const osg::ref_ptr<SurfaceData> _data = new SurfaceData;
};

inline void holds(const std::string& message, const std::string& words)
{
    EXPECT_NE(message.find(words), std::string::npos) << message;
}

} // namespace geofx::test
