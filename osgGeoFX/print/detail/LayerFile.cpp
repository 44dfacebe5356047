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
      _format(format), _output(PictureWriter::create(_unfinished.string()))
{
    PictureHeader header;
    header.width = format.width;
    header.height = format.height;
    header.channels = format.channels;
    header.number = format.number;
    // As image editors have it; the other kind would lose colors to rounding.
    if (format.channels.size() == 4) header.set("oiio:UnassociatedAlpha", 1);
    if (format.number == PictureNumber::BYTE && format.channels.size() > 1)
        header.set("oiio:ColorSpace", "sRGB");
    header.set("compression", "zip");
    if (header.bytes() > 3.9e9) header.set("tiff:bigtiff", 1);
    header.setDpi(format.dpi);
    if (!_output || !_output->open(_unfinished.string(), header)) throw fault();
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
                      (_output ? _output->error() : std::string("no such format")) +
                      "); check the folder, its permissions and the disk's space.");
}

void LayerFile::write(int rows, const void* data)
{
    const auto* bytes = static_cast<const unsigned char*>(data);
    const std::size_t step =
        static_cast<std::size_t>(_format.width) * _format.channels.size() * sizeOf(_format.number);
    for (int i = 0; i < rows; ++i, bytes += step)
        if (!_output->write(bytes, _format.number)) throw fault();
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
