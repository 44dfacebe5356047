// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An osgDB plugin without a file format: it serves the libraries and plugins of osgGeoFX that do without GDAL
// with what needs it, when they ask.
#include "ProjectedGeoreference.h"
#include "TerrainCache.h"

#include <geofx/CloseUpsLoader.h>
#include <geofx/MappingsLoader.h>
#include <geofx/PanoramasLoader.h>
#include <geofx/SceneReach.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/geodata/LineVectors.h>
#include <osgGeoFX/geodata/NameVectors.h>
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/geodata/PictureRaster.h>
#include <osgGeoFX/geodata/RouteVectors.h>
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/geodata/SldColors.h>
#include <osgGeoFX/geodata/StrokeVectors.h>
#include <osgGeoFX/geodata/SurfaceRaster.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/geodata/TiledVectors.h>
#include <osgGeoFX/labels/NameFile.h>
#include <osgGeoFX/lines/LineFile.h>
#include <osgGeoFX/map/OverlayFile.h>
#include <osgGeoFX/map/RouteFile.h>
#include <osgGeoFX/map/SequenceFile.h>
#include <osgGeoFX/map/SourceFiles.h>
#include <osgGeoFX/raster/ColorRampFile.h>
#include <serializers/LayerRequests.h>

#include <osg/ValueObject>
#include <osgDB/Registry>

#include <iterator>
#include <type_traits>

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
        supportsOption("request", "for the objects \"mappingRaster\", \"surfaceData\", \"strokeVectors\", "
                                  "\"names\", \"lines\", \"overlays\", \"picture\", \"routes\", \"sequence\" "
                                  "and \"sources\": a raster "
                                  "or vector data of a .geofx scene (plugin data)");
        supportsOption("version", "for the objects of scenes: the version of the plugin that asks");
    }

    const char* className() const override { return "osgGeoFX data services"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        if (name == "georeference") return georeference(options ? options->getPluginStringData("wkt") : "");
        if (name == "terrain" && options) return terrain(*options);
        if (name == "mappingRaster" && options) return mappingRaster(*options);
        if (name == "surfaceData" && options) return surfaceData(*options);
        if (name == "strokeVectors" && options) return strokeVectors(*options);
        if (name == "names" && options) return names(*options);
        if (name == "lines" && options) return lines(*options);
        if (name == "overlays" && options) return overlays<OverlayFile>(*options);
        if (name == "picture" && options) return picture(*options);
        if (name == "routes" && options) return routes<RouteFile>(*options);
        if (name == "sequence" && options) return sequence<SequenceFile>(*options);
        if (name == "sceneSequence" && options) return sequence<SceneSequenceRequest>(*options);
        if (name == "sceneOverlays" && options) return overlays<SceneOverlaysRequest>(*options);
        if (name == "sceneRoutes" && options) return routes<SceneRoutesRequest>(*options);
        if (name == "colors" && options) return colors(*options);
        if (name == "layerSteps" && options) return layer<LayerStepsRequest>(*options);
        if (name == "layerTiles" && options) return layer<LayerTilesRequest>(*options);
        if (name == "sources" && options) return sources(*options);
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

    /// The answer is in the request.
    static ReadResult surfaceData(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<SurfaceRequest*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        request->done = addSurface(*request, *request->surface, error);
        if (!request->done) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    static ReadResult strokeVectors(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request =
            static_cast<StrokeVectorsRequest*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        request->done = StrokeVectors::read(request->file, request->layer, request->kind, request->frame,
                                            request->lines, error);
        if (!request->done) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    static ReadResult names(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<NameFile*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        const NameVectors::Options how{request->layer, request->name, request->importance, request->height,
                                       request->style};
        MappingFrame frame;
        frame.globe = request->globe;
        frame.wkt = request->wkt;
        if (!NameVectors::read(request->file, how, frame, request->names, error)) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    static ReadResult lines(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<LineFile*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        MappingFrame frame;
        frame.globe = request->globe;
        frame.wkt = request->wkt;
        if (!LineVectors::read(request->file, {request->layer, request->style}, frame, request->lines, error))
            return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    template<typename Request>
    static ReadResult overlays(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<Request*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        OverlayReader reader;
        reader.globe = request->globe;
        reader.wkt = request->wkt;
        reader.frames = request->frames;
        OverlayReader::Options how;
        if constexpr (std::is_same_v<Request, OverlayFile>)
        {
            how.allowOutside = request->allowOutside;
            how.paged = request->paged;
        }
        else
        {
            how.maxTexels = request->maxTexels;
            how.pictures = request->pictures;
        }
        how.colors = request->colors;
        how.maxSide = request->maxSide;
        how.layer = request->layer;
        how.style = request->style;
        how.bands = request->bands;
        how.ground = request->ground;
        if (!reader.read(request->file, how, error)) return error;
        request->frames = reader.frames;
        if constexpr (std::is_same_v<Request, OverlayFile>) request->files = reader.files;
        std::move(reader.overlays.begin(), reader.overlays.end(), std::back_inserter(request->overlays));
        std::move(reader.notices.begin(), reader.notices.end(), std::back_inserter(request->notices));
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    template<typename Request>
    static ReadResult routes(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<Request*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        std::vector<std::string> files;
        if (!RouteVectors::read(request->file, request->layer, request->routes, error, &files)) return error;
        if constexpr (std::is_same_v<Request, RouteFile>) request->files = files;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// Opens again what OSG's files name. The answer is in the request.
    template<typename Request>
    static ReadResult layer(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<Request*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        const LayerSource& source = request->source;
        MappingFrame frame;
        frame.globe = source.globe;
        frame.wkt = source.wkt;
        frame.origin = source.origin;
        if constexpr (std::is_same_v<Request, LayerTilesRequest>)
        {
            std::optional<DataLayer::Kind> kind;
            if (source.kind) kind = static_cast<DataLayer::Kind>(*source.kind);
            request->tiles = source.vectors ? TiledVectors::open(source, error)
                                            : TiledRaster::open(source.file, frame, kind, error, source.bands,
                                                                source.reach);
            if (!request->tiles) return error;
        }
        else
        {
            const auto [file, variable] = SequenceRaster::parse(source.file);
            const auto raster =
                SequenceRaster::open(file, frame, false, {variable, source.maxSide, source.bands}, error);
            if (!raster) return error;
            request->steps = raster->steps;
        }
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    template<typename Request>
    static ReadResult sequence(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<Request*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        const auto [file, variable] = SequenceRaster::parse(request->file);
        SequenceRaster::Options how;
        how.variable = variable;
        how.maxSide = request->maxSide;
        how.bands = request->bands;
        MappingFrame frame;
        frame.globe = request->globe;
        frame.wkt = request->wkt;
        frame.origin = request->origin;
        const std::optional<SequenceRaster> raster =
            SequenceRaster::open(file, frame, request->moves, how, error);
        if (!raster) return error;
        if constexpr (std::is_same_v<Request, SequenceFile>)
            for (const SequenceRaster::Part& part : raster->others)
                request->others.push_back({part.origin, part.steps, part.low, part.high});
        else if (!raster->others.empty())
            return file + ": it reaches around the globe, which a <projectiveMappings> has no room for; show "
                          "it with "
                          "--sequence, or cut a part out with gdal_translate -projwin, or gdalmdimtranslate "
                          "-subset.";
        request->origin = frame.origin;
        request->steps = raster->steps;
        request->low = raster->low;
        request->high = raster->high;
        request->lowest = raster->lowest;
        request->highest = raster->highest;
        request->variable = raster->variable;
        request->unit = raster->unit;
        if (request->colors.empty()) return ReadResult(ReadResult::FILE_LOADED);
        const ColorRampFile::Range range(raster->lowest, raster->highest);
        request->table = SldColors::isSld(request->colors)
                             ? SldColors::read(request->colors, error)
                             : ColorRampFile::read(request->colors, range, error);
        if (!request->table) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    static ReadResult colors(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<ColorsRequest*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        request->table = SldColors::read(request->file, error);
        if (!request->table) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    static ReadResult picture(const Options& options)
    {
        std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<PictureRequest*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        PictureRaster::Options how;
        how.kind = request->kind;
        if (request->maxSide > 0) how.maxSide = request->maxSide;
        const std::optional<PictureRaster> raster = request->look
                                                        ? PictureRaster::look(request->file, how, error)
                                                        : PictureRaster::read(request->file, how, error);
        if (!raster) return error;
        request->width = raster->width;
        request->height = raster->height;
        request->image = raster->image;
        request->done = true;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    /// The answer is in the request.
    static ReadResult sources(const Options& options)
    {
        const std::string error = otherVersion(options);
        if (!error.empty()) return error;
        auto* request = static_cast<SourceFiles*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        const FileSources found = FileSources::of(request->file);
        request->files = found.files;
        request->service = found.service;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    static bool addSurface(SurfaceRequest& request, const SceneSurface& surface, std::string& error)
    {
        const std::string& file = surface.file.name();
        switch (surface.source)
        {
        case SceneSurface::RASTER:
            return SurfaceRaster::addLayer(*request.data, surface.name, surface.kind, file, request.frame,
                                           error, request.maxSide);
        case SceneSurface::VECTORS:
            return SurfaceRaster::addVectors(*request.data, surface.name, file, surface.width, surface.color,
                                             request.frame, error, request.maxSide);
        case SceneSurface::DEM:
        case SceneSurface::DERIVED:
            break;
        }
        if (request.low == request.high && !MappingRaster::moveToMiddle(file, request.frame, error))
            return false;
        const SurfaceRaster::Options options{request.low, request.high, request.maxSide, request.radius};
        const osg::ref_ptr<SurfaceData> data = SurfaceRaster::fromDem(file, request.frame, options, error);
        if (data) request.data = data;
        return data.valid();
    }
};

} // namespace osgGeoFX

using osgGeoFX::ReaderWriterGeoFXData;
REGISTER_OSGPLUGIN(geofxdata, ReaderWriterGeoFXData)
