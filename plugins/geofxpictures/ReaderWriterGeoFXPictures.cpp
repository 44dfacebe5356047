// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An osgDB plugin without a file format: it reads and writes the files of pictures when PictureReader and PictureWriter ask, so that
// OpenImageIO is loaded for them alone.
#include <osgGeoFX/raster/PictureFile.h>

#include <OpenImageIO/imageio.h>
#include <osgDB/Registry>

#include <utility>

namespace osgGeoFX
{

namespace
{

OIIO::TypeDesc typeOf(PictureNumber number)
{
    switch (number)
    {
    case PictureNumber::BYTE:
        return OIIO::TypeDesc::UINT8;
    case PictureNumber::SHORT:
        return OIIO::TypeDesc::UINT16;
    case PictureNumber::HALF:
        return OIIO::TypeDesc::HALF;
    case PictureNumber::FLOAT:
        return OIIO::TypeDesc::FLOAT;
    case PictureNumber::DOUBLE:
        return OIIO::TypeDesc::DOUBLE;
    }
    return OIIO::TypeDesc::UNKNOWN;
}

PictureNumber numberOf(const OIIO::TypeDesc& type)
{
    for (const PictureNumber number :
         {PictureNumber::BYTE, PictureNumber::SHORT, PictureNumber::HALF, PictureNumber::DOUBLE})
        if (type == typeOf(number)) return number;
    return PictureNumber::FLOAT;
}

class Reader : public PictureReader
{
public:
    explicit Reader(std::unique_ptr<OIIO::ImageInput> input) : _input(std::move(input))
    {
        const OIIO::ImageSpec& spec = _input->spec();
        _header.width = spec.width;
        _header.height = spec.height;
        _header.channels = spec.channelnames;
        _header.number = numberOf(spec.format);
        _header.tiled = spec.tile_width > 0;
        for (const OIIO::ParamValue& attribute : spec.extra_attribs)
            if (attribute.type() == OIIO::TypeDesc::STRING)
                _header.set(attribute.name().string(), attribute.get_string());
    }

    const PictureHeader& header() const override { return _header; }
    bool read(void* row, PictureNumber number) override
    {
        return _input->read_scanline(_input->spec().y + _row++, 0, typeOf(number), row);
    }
    std::string error() override { return _input->geterror(); }

private:
    const std::unique_ptr<OIIO::ImageInput> _input;
    PictureHeader _header;
    int _row = 0;
};

class Writer : public PictureWriter
{
public:
    explicit Writer(std::unique_ptr<OIIO::ImageOutput> output) : _output(std::move(output)) {}

    std::string format() const override { return _output->format_name(); }
    bool open(const std::string& file, const PictureHeader& header) override
    {
        const auto channels = static_cast<int>(header.channels.size());
        OIIO::ImageSpec spec(header.width, header.height, channels, typeOf(header.number));
        spec.channelnames = header.channels;
        spec.alpha_channel = channels == 4 ? 3 : -1;
        for (const auto& [key, attribute] : header.attributes)
        {
            const std::string& name = key;
            std::visit([&](const auto& value) { set(spec, name, value); }, attribute);
        }
        return _output->open(file, spec);
    }
    bool has(PictureNumber number) const override { return _output->spec().format == typeOf(number); }
    bool write(const void* row, PictureNumber number) override
    {
        return _output->write_scanline(_row++, 0, typeOf(number), row);
    }
    bool close() override { return _output->close(); }
    std::string error() override { return _output->geterror(); }

private:
    template<class Value>
    static void set(OIIO::ImageSpec& spec, const std::string& name, const Value& value)
    {
        spec.attribute(name, value);
    }
    static void set(OIIO::ImageSpec& spec, const std::string& name, const std::vector<unsigned char>& value)
    {
        spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(value.size())),
                       value.data());
    }

    const std::unique_ptr<OIIO::ImageOutput> _output;
    int _row = 0;
};

} // namespace

class ReaderWriterGeoFXPictures : public osgDB::ReaderWriter
{
public:
    ReaderWriterGeoFXPictures()
    {
        supportsExtension("geofxpictures", "osgGeoFX's files of pictures; not a file format");
        supportsOption("request",
                       "for the object \"picture\": a picture to be read or written (plugin data)");
        supportsOption("version", "the version of the library that asks");
    }

    const char* className() const override { return "osgGeoFX files of pictures"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        if (name != "picture" || !options) return ReadResult::FILE_NOT_HANDLED;
        // Requests are C++ objects, which the library and the plugin must lay out alike.
        if (options->getPluginStringData("version") != GEOFX_VERSION)
            return std::string("The library osgGeoFX and the OSG plugin osgdb_geofxpictures are of different "
                               "versions; put the folder of one osgGeoFX on OSG_LIBRARY_PATH.");
        auto* const request =
            static_cast<PictureFileRequest*>(const_cast<void*>(options->getPluginData("request")));
        if (!request) return ReadResult::FILE_NOT_HANDLED;
        if (!request->read.empty())
            if (auto input = OIIO::ImageInput::open(request->read))
                request->reader = std::make_unique<Reader>(std::move(input));
        if (!request->write.empty())
            if (auto output = OIIO::ImageOutput::create(request->write))
                request->writer = std::make_unique<Writer>(std::move(output));
        // OpenImageIO keeps the message of a failure until somebody asks.
        OIIO::geterror();
        return ReadResult(ReadResult::FILE_LOADED);
    }
};

} // namespace osgGeoFX

using osgGeoFX::ReaderWriterGeoFXPictures;
REGISTER_OSGPLUGIN(geofxpictures, ReaderWriterGeoFXPictures)
