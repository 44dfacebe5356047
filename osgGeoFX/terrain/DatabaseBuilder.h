// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/BuildError.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/// The version of a database's content within one format. Databases of lower versions can be read but contain less.
constexpr int DATABASE_CONTENT = 8;

/// The meaning of the heights of a DEM.
enum class VerticalDatum
{
    None,      ///< unchanged: the DEM's zero is the database's zero (the default)
    Ellipsoid, ///< metres above the WGS 84 ellipsoid, unchanged
    Egm96      ///< metres above the EGM96 geoid (mean sea level); PROJ's grid moves them to the ellipsoid
};

/// The treatment of voids: places within the elevation that have no height, such as SRTM's steep slopes and lakes.
enum class Voids
{
    FILL, ///< they get heights from those around them
    KEEP  ///< they become holes in the terrain
};

/** The sources and settings of a database.

    The fields above `threads` alone determine levels, tile shapes and every byte of the database.
    @ingroup terrain */
struct BuildOptions
{
    /// Elevation rasters, metres. In overlaps the later one wins, so coarse ones come first: a globe, then a region.
    /// Where a later one has no data, those before it show. If its density differs from that of the one before by
    /// half or more, its heights blend into those below over three cells of the coarser one, or a fifth of its own
    /// extent. The quadtree is as deep as the densest source that touches a tile asks for, in blocks of up to 8 × 8
    /// tiles.
    std::vector<std::string> dems;
    /// Color rasters (red, green and blue, with or without alpha and further bands, grey or palette); the later one wins.
    std::vector<std::string> imagery;
    /// The numbers of the imagery that become black and white, with any number of bits. Nothing: bytes stay as they are; of larger
    /// numbers 2 to 98 % go from black to white, for each file, unless they fill half of their type's range already.
    std::optional<std::pair<double, double>> stretch;
    std::string landCover;      ///< class raster, one byte band; empty for none
    std::string landCoverTable; ///< the meaning of its values, for readLandCoverTable()
    std::string treeCover;      ///< raster of the share under trees, percent; empty for none
    /// Takes all values of elevation rasters as heights. Else those that plainly are none count as missing, though their file
    /// does not declare them: a single value far from all others (between −500 and 9,000 m only if it stands along the raster's
    /// border), one that is all around turned data, and heights beyond −12,000 and
    /// 9,500 m. A warning states the first two.
    bool allHeights = false;
    int epsg = 0; ///< EPSG code of a projected database; 0 for a geocentric one (WGS 84)
    VerticalDatum vertical = VerticalDatum::None;
    Voids voids = Voids::FILL;
    /// The distance from the data up to which voids are filled, in samples of the elevation, 1…500. An area into which
    /// a square of twice as many samples fits counts as left out, and is not filled.
    int voidReach = 100;
    int voidSmoothing = 10; ///< how often filled heights are averaged with their neighbours, 0…100
    /// The height above the sea up to which trees are likely if no raster says so, metres, 0 or more. Empty: a line by
    /// latitude, 3,800 m up to 25°, falling to 0 at 70°.
    std::optional<double> treeLine;
    /// The least area of level ground that counts as a lake if no land cover says so, square metres, 0 or more.
    double lakeArea = 2e5;
    /// Grid intervals along a tile's edge at most, a power of two, 8…256. With 64 and 128
    /// about the same meshes are drawn. Larger tiles are fewer files, but a program keeps more in memory that it does not
    /// draw.
    int tileSize = 64;
    /// Texture intervals along a tile's edge at most, 16…4096. 0 stands for 4 × tileSize on the finest level. If the
    /// finest level has fewer, the levels above it keep its texels, up to 2 × tileSize.
    int textureSize = 0;
    double pixelError = 1.0; ///< bound of the geometric error on the screen, pixels, > 0
    double texelError = 2.0; ///< largest size of a texel on the screen where it would show, pixels, > 0
    /// Anisotropic filtering of the colors, texels across a pixel at most, 1…16. 0 stands for 4 with imagery and 1
    /// without: the colors of heights and classes are smooth, and filtering costs software renderers a third of the
    /// frame time.
    double anisotropy = 0.0;
    /// Stores colors in BC1 and normals in BC5, with mipmaps made by the builder. GPUs read these formats directly:
    /// colors then take a sixth of the GPU memory, and normals half. The cover, the classes and normals of three
    /// channels stay exact. Textures are up to three texels wider, since a block has 4 × 4 texels.
    bool compressTextures = false;
    /// The screen for which the bounds hold: pixels per radian at its center, > 0. The default is that of plain
    /// osgviewer: 1080 lines over a vertical field of view of 29.15°.
    double pixelsPerRadian = 2077.0;
    std::string output; ///< folder of the database; made if missing

    int threads = 0;      ///< worker threads; 0 for one per core
    int memoryMiB = 1024; ///< memory limit for the builder's data, MiB, at least 128
    bool resume = false;  ///< continue an interrupted build of the same options
    /// If the folder has a finished database, build only what other sources or options change. The result has the
    /// bytes of a build from nothing. Until all is ready, the former database stays as it is.
    bool update = false;
    /// Leave what later updates need, in `OUTPUT/kept`. Without it the next update builds everything.
    bool keep = false;
};

/** An estimate of a build before it begins. Samples and levels are exact, and tiles are an upper bound. The other
    values are about right for ordinary terrain: a plain takes a third of the disk space, noise twice as much.
    @ingroup terrain */
struct BuildEstimate
{
    std::uint64_t samples = 0;   ///< grid posts of the finest level
    std::uint64_t tiles = 0;     ///< on all levels, at most
    int levels = 0;              ///< levels of detail
    std::uint64_t bytes = 0;     ///< size of the database
    std::uint64_t workBytes = 0; ///< size of the work files, which the build removes at its end
    double seconds = 0.0;        ///< on a machine of today that does nothing else

    /// The estimate as one line, without a full stop.
    OSGGEOFXDATA_EXPORT std::string text() const;
};

/// The error of compression in one channel of textures, on the scale 0…255, over all texels at full size.
/// @ingroup terrain
struct TextureError
{
    double rootMeanSquare = 0.0;
    int largest = 0;
};

/// Sizes and compression errors of a database's textures.
/// @ingroup terrain
struct TextureSummary
{
    /// The size on the GPU, with mipmaps, as the formats specify. Many GPUs store a texel of three bytes in four.
    std::uint64_t bytes = 0;
    std::uint64_t uncompressedBytes = 0;   ///< the same without any compression
    std::array<TextureError, 3> colors{};  ///< red, green, blue
    std::array<TextureError, 2> normals{}; ///< x and y; 255 stands for the range −1…1

    /// Sizes and errors as a few lines, each with a line end.
    OSGGEOFXDATA_EXPORT std::string text() const;
};

/// Figures of a finished build.
/// @ingroup terrain
struct BuildSummary
{
    std::uint64_t tiles = 0;       ///< tiles with geometry, all levels
    std::uint64_t tilesReused = 0; ///< tiles taken over from an interrupted build
    std::uint64_t tilesKept = 0;   ///< tiles of the former database that an update has left as they were
    std::uint64_t units = 0;       ///< blocks of up to 8 × 8 finest tiles, with those above them
    std::uint64_t unitsKept = 0;   ///< those of them that an update had nothing to do for
    bool updated = false;          ///< the folder had a database that this one was made from
    std::string allBecause;        ///< why an update has built everything, as a clause; else empty
    int levels = 0;                ///< levels of detail
    std::uint64_t samples = 0;     ///< grid posts of the finest level
    double lowestHeight = 0.0, highestHeight = 0.0; ///< of all posts, metres
    std::string heightUnits;                        ///< the units of the files' heights, as a clause
    double filledShare = 0.0; ///< of the posts with a height, the share in filled voids, 0…1
    double openShare = 0.0;   ///< of all posts, the share in voids too large to be filled, 0…1
    TextureSummary textures;
    std::uint64_t bytes = 0;           ///< size of the database on disk
    std::uint64_t keptBytes = 0;       ///< size of what is kept for updates, besides
    double seconds = 0.0;              ///< wall-clock time
    std::uint64_t peakMemoryBytes = 0; ///< largest resident size of the process
    std::string file;                  ///< the file to open: OUTPUT/terrain.osgb
};

/// Called from any worker, but never from two at once. The arguments are the finished work units, all work units, and
/// the current phase. Return false to cancel: the build then throws BuildError and can be resumed.
using BuildProgress = std::function<bool(std::uint64_t done, std::uint64_t total, const std::string& phase)>;

/** Estimates a build from the rasters' headers; writes nothing. Throws BuildError for options and rasters that
    buildDatabase() would refuse, and for a terrain that the disk of the output folder cannot hold. It does not check
    for other files in that folder. Any thread may call it. */
OSGGEOFXDATA_EXPORT BuildEstimate estimateBuild(const BuildOptions& options);

/** Builds a paged terrain database from rasters.

    The result is `OUTPUT/terrain.osgb` and, below `OUTPUT/tiles`, one `.osgb` file for each group of four tiles. Plain
    OpenSceneGraph reads it. `terrain.osgb` is written last, so a folder without it is not a database. The same options
    give the same bytes, for any number of threads, through any interruptions and by any updates.

    An update writes new tiles into work files first. When all are ready, it puts them into their places, the deepest
    first, then the root, and removes tiles that no longer belong. If it is interrupted before, the former database
    is as it was. If it is interrupted while it puts files into their places, the next call of any build in the folder
    ends this first. All files are whole at any moment. A program that has the former database open may see tiles of
    both.

    Throws BuildError. Any thread may call it, but only one build at a time may use an output folder. */
OSGGEOFXDATA_EXPORT BuildSummary buildDatabase(const BuildOptions& options,
                                               const BuildProgress& progress = {});

} // namespace osgGeoFX
