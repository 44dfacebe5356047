// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An osgDB plugin without a file format: it serves the libraries and plugins of osgGeoFX that do without GDAL
// with what needs it, when they ask.
#include "ProjectedGeoreference.h"
#include "TerrainCache.h"

#include <geofx/MappingsLoader.h>
#include <osgGeoFX/geodata/BuildError.h>

#include <osg/ValueObject>
#include <osgDB/Registry>

namespace osgGeoFX
{

class ReaderWriterGeoFXData : public osgDB::ReaderWriter
{
public:
    ReaderWriterGeoFXData()
    {
        supportsExtension("geofxdata", "osgGeoFX's services that need GDAL; not a file format");
        supportsOption("wkt", "for the object \"georeference\": the projected coordinate system, as WKT");
        supportsOption("rasters", "for the object \"terrain\": the rasters of a .geofx scene (plugin data)");
        supportsOption("request",
                       "for the object \"mappingRaster\": a raster of a .geofx scene (plugin data)");
        supportsOption("version", "for the objects of scenes: the version of the plugin that asks");
    }

    const char* className() const override { return "osgGeoFX data services"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        if (name == "georeference") return georeference(options ? options->getPluginStringData("wkt") : "");
        if (name == "terrain" && options) return terrain(*options);
        if (name == "mappingRaster" && options) return mappingRaster(*options);
        return ReadResult::FILE_NOT_HANDLED;
    }

private:
    static ReadResult georeference(const std::string& wkt)
    {
        std::string error;
        const osg::ref_ptr<ProjectedGeoreference> reference = ProjectedGeoreference::create(wkt, error);
        if (!reference) return ReadResult(error);
        return reference.get();
    }

    /// Requests are C++ objects, which both plugins must lay out alike. Empty where they do.
    static std::string otherVersion(const Options& options)
    {
        if (options.getPluginStringData("version") == GEOFX_VERSION) return {};
        return "The OSG plugins osgdb_geofx and osgdb_geofxdata are of different versions; put the "
               "folder of one osgGeoFX on OSG_LIBRARY_PATH.";
    }

    static ReadResult terrain(const Options& options)
    {
        const std::string fault = otherVersion(options);
        if (!fault.empty()) return fault;
        const auto* rasters = static_cast<const SceneRasters*>(options.getPluginData("rasters"));
        if (!rasters) return ReadResult::FILE_NOT_HANDLED;
        try
        {
            return new osg::StringValueObject(cachedTerrain(*rasters));
        }
        catch (const std::exception& error)
        {
            return std::string(error.what());
        }
    }

    /// The answer is in the request.
    static ReadResult mappingRaster(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request =
            static_cast<MappingRasterRequest*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        if (!request->hasOrigin && !MappingRaster::moveToMiddle(request->file, request->frame, error))
            return error;
        const std::optional<MappingRaster> raster =
            MappingRaster::read(request->file, request->frame, request->options, error);
        if (!raster) return error;
        request->raster = *raster;
        return ReadResult(ReadResult::FILE_LOADED);
    }
};

} // namespace osgGeoFX

using osgGeoFX::ReaderWriterGeoFXData;
REGISTER_OSGPLUGIN(geofxdata, ReaderWriterGeoFXData)
