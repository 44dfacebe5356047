// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/PictureFile.h>

#include <osgGeoFX/paging/PluginFolder.h>

#include <osgDB/Options>
#include <osgDB/Registry>

#include <stdexcept>
#include <utility>

namespace osgGeoFX
{

namespace
{

void ask(PictureFileRequest& request)
{
    addPluginFolder();
    osgDB::ReaderWriter* const plugin =
        osgDB::Registry::instance()->getReaderWriterForExtension("geofxpictures");
    if (!plugin)
        throw std::runtime_error(
            "The OSG plugin osgdb_geofxpictures, which reads and writes pictures, was not found or lacks its "
            "libraries (OpenImageIO); put its folder on OSG_LIBRARY_PATH.");
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("version", GEOFX_VERSION);
    options->setPluginData("request", &request);
    const osgDB::ReaderWriter::ReadResult result = plugin->readObject("picture", options.get());
    if (result.error()) throw std::runtime_error(result.message());
}

} // namespace

void PictureHeader::set(const std::string& name, Attribute value)
{
    attributes.insert_or_assign(name, std::move(value));
}

void PictureHeader::setDpi(double dpi)
{
    if (dpi <= 0.0) return;
    set("XResolution", static_cast<float>(dpi));
    set("YResolution", static_cast<float>(dpi));
    set("ResolutionUnit", "in");
}

std::unique_ptr<PictureReader> PictureReader::open(const std::string& file)
{
    PictureFileRequest request;
    request.read = file;
    ask(request);
    return std::move(request.reader);
}

std::unique_ptr<PictureWriter> PictureWriter::create(const std::string& name)
{
    PictureFileRequest request;
    request.write = name;
    ask(request);
    return std::move(request.writer);
}

} // namespace osgGeoFX
