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
#include <vector>

namespace osgGeoFX
{

/// Counts what builders put into databases of one format: older ones are still read, but have less in them.
constexpr int DATABASE_CONTENT = 8;

/// How the heights of a DEM are to be understood.
enum class VerticalDatum
{
    None,      ///< used as they are: the zero of the DEM is the zero of the database (the default)
    Ellipsoid, ///< metres above the WGS 84 ellipsoid, used as they are
    Egm96      ///< metres above the EGM96 geoid (mean sea level); moved to the ellipsoid by PROJ's grid
};

/// What becomes of voids: places inside the elevation that have none, such as SRTM's steep slopes and lakes.
enum class Voids
{
    FILL, ///< they get heights from those around them
    KEEP  ///< they are holes in the terrain
};

/** What a database is built from and how.

    Levels, tile shapes and every byte of the database follow from the fields above `threads` alone. */
struct BuildOptions
{
    std::vector<std::string> dems;    ///< elevation rasters, metres; where several overlap the later one wins
    std::vector<std::string> imagery; ///< colour rasters (RGB, RGBA, grey or palette); the later one wins
    std::string landCover;            ///< class raster, one byte band; empty for none
    std::string landCoverTable;       ///< what its values mean, for readLandCoverTable()
    std::string treeCover;            ///< raster of the ground's share under trees, percent; empty for none
    int epsg = 0;                     ///< projected database in this CRS; 0 for a geocentric one (WGS 84)
    VerticalDatum vertical = VerticalDatum::None;
    Voids voids = Voids::FILL;
    /// How far from the data voids are filled, samples of the elevation, 1…500: where a square of twice as many on a side fits
    /// into one, it counts as left out, and stays.
    int voidReach = 100;
    int voidSmoothing = 10; ///< how often filled heights become means of those around them, 0…100
    /// Metres above the sea up to which trees are likely where no raster tells; nothing for a line by latitude, from
    /// 3,800 m up to 25° down to 0 at 70°.
    std::optional<double> treeLine;
    /// Least area of level ground that counts as a lake where no land cover tells, square metres, 0 or more.
    double lakeArea = 2e5;
    int tileSize = 128; ///< largest number of grid intervals along a tile's edge, 8…240
    /// Largest number of texture intervals along a tile's edge, 16…4096; 0 for 4 × tileSize on the finest level and, where
    /// that has fewer, 2 × tileSize above.
    int textureSize = 0;
    double pixelError = 1.0; ///< bound of the geometric error on the screen, pixels
    double texelError = 2.0; ///< largest size of a texel on the screen where it would show, pixels
    /// The colours' anisotropic filtering, texels across a pixel at most, 1…16; 0 for 4 with imagery and 1 without: colours of
    /// heights and classes are smooth, and it costs software renderers a third of the frame.
    double anisotropy = 0.0;
    /// Colours in BC1 and normals in BC5, which GPUs read as they are, with mipmaps of the builder: a sixth and half of the memory on
    /// the GPU. What lies on the ground, classes, and normals of three channels stay exact. Textures are up to three texels
    /// wider, since blocks have 4 × 4 texels.
    bool compressTextures = false;
    /// The screen for which the bounds hold: pixels per radian at its centre. The default is that of
    /// plain osgviewer, 1080 lines over a vertical field of view of 29.15°.
    double pixelsPerRadian = 2077.0;
    std::string output; ///< folder of the database; made when missing

    int threads = 0;      ///< worker threads; 0 for one for each core
    int memoryMiB = 1024; ///< what the builder may use for its data, at least 128 MiB
    bool resume = false;  ///< continue a build of the same options that was interrupted
};

/** What a build will take, before it has begun. Samples and levels are exact, tiles an upper bound; the rest is about right for
    terrain of the usual kind: a plain takes a third of the disk, noise twice as much. */
struct BuildEstimate
{
    std::uint64_t samples = 0;   ///< grid posts of the finest level
    std::uint64_t tiles = 0;     ///< of all levels
    int levels = 0;              ///< levels of detail
    std::uint64_t bytes = 0;     ///< of the database
    std::uint64_t workBytes = 0; ///< of work files, which the end of the build removes
    double seconds = 0.0;        ///< on a machine like those of today, if it has nothing else to do

    /// All of it in a line, without a full stop.
    OSGGEOFXDATA_EXPORT std::string text() const;
};

/// What compression has changed in one channel of textures, of 255, over all texels at full size.
struct TextureError
{
    double rootMeanSquare = 0.0;
    int largest = 0;
};

/// The textures of a database.
struct TextureSummary
{
    /// On the GPU, with mipmaps, as the formats have them: many GPUs keep four bytes for a texel of three.
    std::uint64_t bytes = 0;
    std::uint64_t uncompressedBytes = 0;   ///< the same if nothing is compressed
    std::array<TextureError, 3> colors{};  ///< red, green, blue
    std::array<TextureError, 2> normals{}; ///< x and y, of 255 for −1…1

    /// Sizes and errors in a few lines, each ended.
    OSGGEOFXDATA_EXPORT std::string text() const;
};

/// Figures of a finished build.
struct BuildSummary
{
    std::uint64_t tiles = 0;       ///< tiles with geometry, all levels
    std::uint64_t tilesReused = 0; ///< of these, taken over from an interrupted build
    int levels = 0;                ///< levels of detail
    std::uint64_t samples = 0;     ///< grid posts of the finest level
    double filledShare = 0.0;      ///< of the posts that have a height, those in filled voids, 0…1
    double openShare = 0.0;        ///< of all posts, those in voids that were too large to be filled, 0…1
    TextureSummary textures;
    std::uint64_t bytes = 0;           ///< size of the database on disk
    double seconds = 0.0;              ///< wall-clock time
    std::uint64_t peakMemoryBytes = 0; ///< largest resident size of the process
    std::string file;                  ///< the file to open: OUTPUT/terrain.osgb
};

/// Called from any worker, never from two at once: work units done and in all, and what is being done.
/// Return false to cancel; the build then throws BuildError and can be resumed.
using BuildProgress = std::function<bool(std::uint64_t done, std::uint64_t total, const std::string& phase)>;

/** What buildDatabase() would take, from the rasters' headers; writes nothing. Throws BuildError for what buildDatabase() would
    refuse: also for a terrain that the disk of the output folder cannot hold. Safe to call from any thread. */
OSGGEOFXDATA_EXPORT BuildEstimate estimateBuild(const BuildOptions& options);

/** Builds a paged terrain database from rasters.

    The result is `OUTPUT/terrain.osgb` and one `.osgb` file for each group of four tiles below `OUTPUT/tiles`;
    plain OpenSceneGraph reads it. `terrain.osgb` is written last, so a folder without it is not a database.
    The same options give the same bytes, for any number of threads and through any interruptions.
    Throws BuildError. Safe to call from any thread; one build for each output folder at a time. */
OSGGEOFXDATA_EXPORT BuildSummary buildDatabase(const BuildOptions& options,
                                               const BuildProgress& progress = {});

} // namespace osgGeoFX
