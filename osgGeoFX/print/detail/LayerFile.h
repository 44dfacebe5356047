// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/raster/PictureFile.h>

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
        PictureNumber number = PictureNumber::BYTE;
        double dpi = 0.0;
    };

    LayerFile(const std::filesystem::path& file, const Format& format);
    ~LayerFile();
    LayerFile(const LayerFile&) = delete;
    LayerFile& operator=(const LayerFile&) = delete;

    /// Writes the next rows; `data`: of the format's numbers, from the uppermost row.
    void write(int rows, const void* data);
    void finish();

private:
    LayerFault fault() const;

    const std::filesystem::path _file;
    const std::filesystem::path _unfinished;
    const Format _format;
    std::unique_ptr<PictureWriter> _output;
    bool _finished = false;
};

} // namespace osgGeoFX
