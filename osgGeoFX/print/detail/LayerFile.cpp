// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/detail/LayerFile.h>

#include <system_error>
#include <utility>

namespace fs = std::filesystem;

namespace osgGeoFX
{

LayerFile::LayerFile(const fs::path& file, const Format& format)
    : _file(file),
      _unfinished(file.parent_path() / (file.stem().string() + ".unfinished" + file.extension().string())),
      _format(format), _output(OIIO::ImageOutput::create(_unfinished.string()))
{
    const auto channels = static_cast<int>(format.channels.size());
    OIIO::ImageSpec spec(format.width, format.height, channels, format.type);
    spec.channelnames = format.channels;
    spec.alpha_channel = channels == 4 ? 3 : -1;
    // As image editors have it; the other kind would lose colors to rounding.
    if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format.type == OIIO::TypeDesc::UINT8 && channels > 1) spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("compression", "zip");
    if (static_cast<double>(spec.image_bytes()) > 3.9e9) spec.attribute("tiff:bigtiff", 1);
    if (format.dpi > 0.0)
    {
        spec.attribute("XResolution", static_cast<float>(format.dpi));
        spec.attribute("YResolution", static_cast<float>(format.dpi));
        spec.attribute("ResolutionUnit", "in");
    }
    if (!_output || !_output->open(_unfinished.string(), spec)) throw fault();
}

LayerFile::~LayerFile()
{
    if (_finished) return;
    _output.reset();
    std::error_code ignored;
    fs::remove(_unfinished, ignored);
}

LayerFault LayerFile::fault() const
{
    return LayerFault("\"" + _file.string() + "\" cannot be written (" +
                      (_output ? _output->geterror() : std::string("no such format")) +
                      "); check the folder, its permissions and the disk's space.");
}

void LayerFile::write(int rows, const void* data)
{
    const auto* bytes = static_cast<const unsigned char*>(data);
    const std::size_t step =
        static_cast<std::size_t>(_format.width) * _format.channels.size() * _format.type.size();
    for (int i = 0; i < rows; ++i, bytes += step)
        if (!_output->write_scanline(_row++, 0, _format.type, bytes)) throw fault();
}

void LayerFile::finish()
{
    std::error_code failed;
    if (!_output->close()) throw fault();
    fs::rename(_unfinished, _file, failed);
    if (failed) throw fault();
    _finished = true;
}

} // namespace osgGeoFX
