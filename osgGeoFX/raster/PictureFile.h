// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace osgGeoFX
{

/// A number in the files of pictures. BYTE and SHORT have no sign.
enum class PictureNumber
{
    BYTE,
    SHORT,
    HALF,
    FLOAT,
    DOUBLE
};

/// The size of a number, bytes.
constexpr std::size_t sizeOf(PictureNumber number)
{
    constexpr std::size_t sizes[] = {1, 2, 2, 4, 8};
    return sizes[static_cast<std::size_t>(number)];
}

/// What the file of a picture says of itself.
/// @ingroup raster
struct PictureHeader
{
    using Attribute = std::variant<int, float, std::string, std::vector<unsigned char>>;

    int width = 0, height = 0;         ///< pixels
    std::vector<std::string> channels; ///< their names, such as R, G and B; the fourth one of four is opacity
    PictureNumber number = PictureNumber::BYTE;
    bool tiled = false;                          ///< stored in tiles, not in rows
    std::map<std::string, Attribute> attributes; ///< by OpenImageIO's names

    /// The size of the pixels, bytes.
    double bytes() const
    {
        return static_cast<double>(sizeOf(number)) * width * height * static_cast<double>(channels.size());
    }
    /// Sets an attribute by OpenImageIO's name.
    OSGGEOFX_EXPORT void set(const std::string& name, Attribute value);
    /// Sets the resolution, pixels for each inch. 0 or less: not said.
    OSGGEOFX_EXPORT void setDpi(double dpi);
};

/** Reads a picture's file row by row, in any format that OpenImageIO reads. One thread at a time.

    OpenImageIO takes long to load, with the libraries of all its formats. So it is in an OSG plugin, `osgdb_geofxpictures`, which is loaded
    with the first picture.
    @ingroup raster */
class PictureReader
{
public:
    /// Null if it is no picture that can be read. Throws std::runtime_error with a sentence if the plugin was not found.
    OSGGEOFX_EXPORT static std::unique_ptr<PictureReader> open(const std::string& file);
    virtual ~PictureReader() = default;

    virtual const PictureHeader& header() const = 0;
    /// Reads the next row, from the uppermost one, as numbers of this kind: all channels of a pixel, then the next pixel. False if it cannot.
    virtual bool read(void* row, PictureNumber number) = 0;
    /// Why something has failed.
    virtual std::string error() = 0;
};

/** Writes a picture's file row by row, in any format that OpenImageIO writes (see PictureReader). One thread at a time.
    @ingroup raster */
class PictureWriter
{
public:
    /// `name`: a file or an extension that names the format. Null if there is no such format. Throws std::runtime_error with a sentence if
    /// the plugin was not found.
    OSGGEOFX_EXPORT static std::unique_ptr<PictureWriter> create(const std::string& name);
    virtual ~PictureWriter() = default;

    /// The format by OpenImageIO's name, such as "tiff" or "openexr".
    virtual std::string format() const = 0;
    /// Begins the file. False if it cannot. `header`: its `tiled` does not count.
    virtual bool open(const std::string& file, const PictureHeader& header) = 0;
    /// Whether the file that is open has numbers of this kind. Formats that do not know the wanted kind take another one.
    virtual bool has(PictureNumber number) const = 0;
    /// Writes the next row, from the uppermost one, of numbers of this kind: all channels of a pixel, then the next pixel. False if it cannot.
    virtual bool write(const void* row, PictureNumber number) = 0;
    /// Ends the file. False if it cannot.
    virtual bool close() = 0;
    /// Why something has failed.
    virtual std::string error() = 0;
};

/// What osgdb_geofxpictures is asked for under the name "picture", and its answer.
struct PictureFileRequest
{
    std::string read;  ///< the file for a reader, or empty
    std::string write; ///< the name for a writer, or empty
    std::unique_ptr<PictureReader> reader;
    std::unique_ptr<PictureWriter> writer;
};

} // namespace osgGeoFX
