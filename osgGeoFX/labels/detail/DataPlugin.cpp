// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/detail/DataPlugin.h>

#include <osgGeoFX/paging/PluginFolder.h>

#include <osgDB/Options>
#include <osgDB/Registry>

namespace osgGeoFX
{

bool askDataPlugin(const std::string& service, void* request, const std::string& file, std::string& error)
{
    addPluginFolder();
    osgDB::ReaderWriter* const plugin = osgDB::Registry::instance()->getReaderWriterForExtension("geofxdata");
    if (!plugin)
    {
        error = "\"" + file +
                "\" cannot be read: the OSG plugin osgdb_geofxdata, which reads vector data, was not found; "
                "put its folder on "
                "OSG_LIBRARY_PATH.";
        return false;
    }
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("version", GEOFX_VERSION);
    options->setPluginData("request", request);
    const osgDB::ReaderWriter::ReadResult result = plugin->readObject(service, options.get());
    if (result.status() == osgDB::ReaderWriter::ReadResult::FILE_LOADED) return true;
    error = result.message().empty()
                ? "\"" + file + "\" cannot be read: the OSG plugin osgdb_geofxdata is too old."
                : result.message();
    return false;
}

} // namespace osgGeoFX
