// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A sentence for the person at the keyboard.
class LayerFault : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// One layer's file, written row by row. It is there when it is whole.
class LayerFile
{
public:
    struct Format
    {
        int width = 0, height = 0;
        std::vector<std::string> channels; ///< their names; a fourth one of colors is straight alpha
        OIIO::TypeDesc type = OIIO::TypeDesc::UINT8;
        double dpi = 0.0;
    };

    LayerFile(const std::filesystem::path& file, const Format& format);
    ~LayerFile();
    LayerFile(const LayerFile&) = delete;
    LayerFile& operator=(const LayerFile&) = delete;

    /// Writes the next rows; `data`: of the format's type, from the uppermost row.
    void write(int rows, const void* data);
    void finish();

private:
    LayerFault fault() const;

    const std::filesystem::path _file;
    const std::filesystem::path _unfinished;
    const Format _format;
    std::unique_ptr<OIIO::ImageOutput> _output;
    int _row = 0;
    bool _finished = false;
};

} // namespace osgGeoFX
