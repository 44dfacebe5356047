// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The osgDB plugin of the scene file. It needs no GDAL: where a scene names rasters, it asks osgdb_geofxdata, and where it has names
// and lines, osgdb_geofxmaps.
#include "SceneFile.h"
#include "SceneNode.h"
#include "SceneReach.h"

#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/ValueObject>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <exception>
#include <istream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class ReaderWriterGeoFX : public osgDB::ReaderWriter
{
public:
    ReaderWriterGeoFX()
    {
        supportsExtension("geofx", "osgGeoFX scene file");
        supportsOption(allowOutside,
                       "the scene may name files outside of its folder, addresses and data bases");
    }

    const char* className() const override { return "osgGeoFX scene reader"; }

    ReadResult readObject(const std::string& file, const Options* options) const override
    {
        return readNode(file, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        if (RemoteFiles::isRemote(file))
        {
            const RemoteFiles::Content content = RemoteFiles::readContent(file, options);
            if (content.fault == RemoteFiles::Fault::None)
                return readText(content.bytes, file, file, options);
            return failure({content.reason + "; " + RemoteFiles::remedyOf(content.fault)});
        }
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;
        // Absolute, so that what is paged later is found from any current folder.
        return readText(readSceneText(path), path, osgDB::getRealPath(path), options);
    }

    /// What osgdb_curl has fetched, when OSG asks that plugin first.
    ReadResult readNode(std::istream& stream, const Options* options) const override
    {
        const std::string url = options ? options->getPluginStringData("filename") : std::string();
        if (!RemoteFiles::isRemote(url)) return ReadResult::FILE_NOT_HANDLED;
        const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
        return readText(text, url, url, options);
    }

private:
    /// `path`: for messages; `real`: the complete path or address.
    static ReadResult readText(const std::string& text, const std::string& path, const std::string& real,
                               const Options* options)
    {
        const std::string folder = osgDB::getFilePath(real);
        const bool anywhere = isAllowedOutside(options);
        std::optional<FilesByOthers::Scope> scope;
        if (!anywhere) scope.emplace(folder);
        SceneResult result = parseScene(text, path, folder);
        if (result.scene) result.errors = faultsOfFiles(*result.scene, folder, options);
        if (!result.errors.empty()) return failure(result.errors);

        std::string error;
        const Nesting nesting(real);
        if (nesting.tooDeep())
            return failure({result.scene->place.message("scenes are read within each other without end, or "
                                                        "more than 16 deep; name a database or rasters in "
                                                        "<terrain>.")});
        if (result.scene->map && nesting.isWithin())
            return failure({result.scene->map->place.message(
                "this scene is the terrain of another one, and names stand over the whole picture; move the "
                "<map> into the outer scene.")});
        result.scene->anywhere = anywhere;
        ScenePath database;
        if (result.scene->database)
            database = *result.scene->database;
        else
            database = builtDatabase(*result.scene->rasters, error);
        if (!error.empty()) return failure({error});
        // A database that was built here lies in the person's cache folder.
        const osg::ref_ptr<FilesByOthers> files =
            anywhere ? nullptr
                     : new FilesByOthers(result.scene->database ? folder : osgDB::getFilePath(database.path));
        const osg::ref_ptr<osg::Node> terrain =
            readTerrain(database, files ? files->addTo(options).get() : options, error);
        if (!terrain) return failure({error});
        TileGuard::install(terrain, files);
        const osg::ref_ptr<osg::Group> node = createSceneNode(*result.scene, terrain, error);
        if (!node) return failure({error});
        return node.get();
    }

    /// A scene's terrain may be a scene; which ones are being read by this thread.
    class Nesting
    {
    public:
        explicit Nesting(const std::string& file)
            : _twice(std::find(open().begin(), open().end(), file) != open().end())
        {
            open().push_back(file);
        }
        ~Nesting() { open().pop_back(); }
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;

        /// Whether another scene is being read.
        bool isWithin() const { return open().size() > 1; }
        bool tooDeep() const { return _twice || open().size() > 16; }

    private:
        static std::vector<std::string>& open()
        {
            static thread_local std::vector<std::string> files;
            return files;
        }
        bool _twice;
    };

    static ReadResult failure(const std::vector<std::string>& errors)
    {
        std::string text;
        for (const std::string& error : errors)
            text += (text.empty() ? "" : "\n") + error;
        return text;
    }

    static ScenePath builtDatabase(const SceneRasters& rasters, std::string& error)
    {
        osgDB::ReaderWriter* builder = osgDB::Registry::instance()->getReaderWriterForExtension("geofxdata");
        if (!builder)
        {
            error = rasters.place.message("rasters are built into a database by the OSG plugin "
                                          "osgdb_geofxdata, which was not found or lacks "
                                          "its libraries (GDAL); put its folder on OSG_LIBRARY_PATH, or "
                                          "build the database elsewhere with "
                                          "osggeofx_build and name it in a <database>.");
            return {};
        }
        osg::ref_ptr<Options> request = new Options;
        request->setPluginStringData("version", GEOFX_VERSION);
        request->setPluginData("rasters", const_cast<SceneRasters*>(&rasters));
        ReadResult result = builder->readObject("terrain", request);
        const auto* path = dynamic_cast<osg::StringValueObject*>(result.getObject());
        if (!path)
        {
            error = rasters.place.message(result.message());
            return {};
        }
        return {path->getValue(), rasters.place, "cache"};
    }

    static osg::ref_ptr<osg::Node> readTerrain(const ScenePath& file, const Options* options,
                                               std::string& error)
    {
        std::string reason;
        if (RemoteFiles::isRemote(file.path) && osgDB::getLowerCaseFileExtension(file.path) != "geofx")
        {
            const RemoteFiles::Node read =
                RemoteFiles::readNode(file.path, options, RemoteFiles::Order::ServerFirst);
            if (read.node) return read.node;
            error = file.place.message("the terrain \"" + file.path + "\" cannot be read (" + read.reason +
                                       "); " + RemoteFiles::remedyOf(read.fault));
            return nullptr;
        }
        try
        {
            ReadResult result = osgDB::Registry::instance()->readNode(file.path, options);
            if (result.validNode()) return result.getNode();
            reason = result.statusMessage();
        }
        catch (const std::exception& exception)
        {
            reason = exception.what();
        }
        error = file.place.message("the terrain \"" + file.path + "\" cannot be read (" + reason +
                                   "); restore the file or build it again.");
        return nullptr;
    }
};

} // namespace osgGeoFX

namespace
{

const osgGeoFX::FilesByOthers::Gate gate;

} // namespace

using osgGeoFX::ReaderWriterGeoFX;
REGISTER_OSGPLUGIN(geofx, ReaderWriterGeoFX)
