// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An osgDB plugin without a file format: it puts the names and lines of a scene file onto the scene when osgdb_geofx asks, which so
// needs no Pango.
#include <geofx/MapLoader.h>
#include <osgGeoFX/map/MapReader.h>
#include <osgGeoFX/map/SceneRoutes.h>

#include <osgDB/Registry>

namespace osgGeoFX
{

class ReaderWriterGeoFXMaps : public osgDB::ReaderWriter
{
public:
    ReaderWriterGeoFXMaps()
    {
        supportsExtension("geofxmaps", "osgGeoFX's names and lines for scenes; not a file format");
        supportsOption("request",
                       "for the object \"map\": the names and lines of a .geofx scene (plugin data)");
        supportsOption("version", "the version of the plugin that asks");
    }

    const char* className() const override { return "osgGeoFX names and lines of scenes"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        if ((name != "map" && name != "wayInAir") || !options) return ReadResult::FILE_NOT_HANDLED;
        // Requests are C++ objects, which both plugins must lay out alike.
        if (options->getPluginStringData("version") != GEOFX_VERSION)
            return std::string(
                "The OSG plugins osgdb_geofx and osgdb_geofxmaps are of different versions; put the "
                "folder of one osgGeoFX on OSG_LIBRARY_PATH.");
        if (name == "wayInAir") return wayInAir(*options);
        auto* const request = static_cast<MapRequest*>(const_cast<void*>(options->getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        std::string error;
        request->done = answer(*request, error);
        if (!request->done) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

private:
    static ReadResult wayInAir(const Options& options)
    {
        auto* const request =
            static_cast<WayInAirRequest*>(const_cast<void*>(options.getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        SceneRoutes routes(*request->scene, *request->scene);
        SceneRoutes::Options how;
        how.look = request->look;
        how.onGround = false;
        std::string error;
        request->done = routes.add(request->path, how, error);
        if (!request->done) return error;
        return ReadResult(ReadResult::FILE_LOADED);
    }

    static bool answer(MapRequest& request, std::string& error)
    {
        const SceneMap& map = *request.map;
        MapContents contents;
        if (map.style && !contents.styles.read(map.style->path, error)) return false;
        if (!map.font.empty()) contents.styles.preferFont(map.font);
        if (map.fontFile && !contents.styles.preferFontFile(map.fontFile->path, error)) return false;
        MapReader reader(*request.scene, *request.scene);
        for (const SceneMap::Vectors& names : map.names)
        {
            request.fault = names.file.place;
            if (!reader.readNames(names.file.path, names.layer, contents.styles.nameField, error))
                return false;
        }
        for (const SceneMap::Vectors& lines : map.lines)
        {
            request.fault = lines.file.place;
            if (!reader.readLines(lines.file.path, lines.layer, contents.styles.lineField, error))
                return false;
        }
        request.fault = map.place;
        if (!reader.place(contents, request.notices, error)) return false;
        contents.addLinesTo(*request.scene);
        if (!contents.names.empty()) request.names = new MapLabels(*request.scene, contents.makeNames());
        return true;
    }
};

} // namespace osgGeoFX

using osgGeoFX::ReaderWriterGeoFXMaps;
REGISTER_OSGPLUGIN(geofxmaps, ReaderWriterGeoFXMaps)
