// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cpl_conv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <osg/Node>
#include <osg/ValueObject>
#include <osgDB/Registry>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <filesystem>
#include <string>

namespace geofx::test
{

inline std::string wktOf(int epsg)
{
    OGRSpatialReference srs;
    EXPECT_EQ(srs.importFromEPSG(epsg), OGRERR_NONE);
    char* text = nullptr;
    srs.exportToWkt(&text);
    std::string wkt = text;
    CPLFree(text);
    return wkt;
}

/// Gives a node what a terrain database says about itself: its extent in degrees, or in metres of a projected one.
inline void describeTerrain(osg::Node& root, bool geocentric, double west, double south, double east,
                            double north)
{
    root.setName("osgGeoFX terrain");
    root.setUserValue("geofx.format", osgGeoFX::TerrainInfo::newestFormat);
    root.setUserValue("geofx.kind", std::string(geocentric ? "geocentric" : "projected"));
    root.setUserValue("geofx.west", west);
    root.setUserValue("geofx.south", south);
    root.setUserValue("geofx.east", east);
    root.setUserValue("geofx.north", north);
    root.setUserValue("geofx.minHeight", 0.0);
    root.setUserValue("geofx.maxHeight", 1000.0);
    root.setUserValue("geofx.pixelsPerRadian", 2000.0);
    root.setUserValue("geofx.pixelError", 1.0);
    root.setUserValue("geofx.levels", 1);
    root.setUserValue("geofx.vertical", std::string("none"));
}

/// Tests of the osgDB plugins of this build.
class GeofxPlugins : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        // Before the folders of an installed osgGeoFX.
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(GEOFX_BUILD_DIR "/lib");
    }

    /// The message of a scene that cannot be read.
    static std::string messageOf(const std::filesystem::path& scene)
    {
        const osgDB::ReaderWriter::ReadResult result =
            osgDB::Registry::instance()->readNode(scene.string(), nullptr);
        EXPECT_EQ(result.status(), osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
        return result.message();
    }
};

} // namespace geofx::test
