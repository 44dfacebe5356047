// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/FolderLock.h>
#include <osgGeoFX/batch/detail/ContentHash.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/terrain/detail/BlendMask.h>
#include <osgGeoFX/terrain/detail/GroundRaster.h>
#include <osgGeoFX/terrain/detail/HeightGrid.h>
#include <osgGeoFX/terrain/detail/TilingScheme.h>
#include <osgGeoFX/terrain/detail/VoidRaster.h>

#include <osgGeoFX/geodata/LandCoverTable.h>

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/// What both passes know of a tile.
struct TileFacts
{
    float minHeight = 0.0f, maxHeight = 0.0f; ///< of the finest posts below it, metres
    float latticeError =
        0.0f; ///< the error of the lattice that its mesh is made from, against the finest heights, metres
    float rootError =
        0.0f; ///< of a unit's root: the error of its own posts against the finest heights, metres
    float error =
        0.0f; ///< bound of the vertical distance between its finest mesh and the finest of all, metres
    float skirtBelow =
        0.0f; ///< the deepest wall of the tile and all below it, below the lowest ground, metres
    std::int32_t voids =
        0; ///< of a unit's root: whether posts have no height within a raster's rectangle (VoidState)
    std::array<float, 2>
        ends{}; ///< mean heights along the extent's southern and northern end, as far as they are the tile's, metres
    std::int32_t any = 0;   ///< it has at least one post with data
    std::int32_t holes = 0; ///< it has at least one post without

    enum VoidState : std::int32_t
    {
        NO_VOIDS,
        HAS_VOIDS,
        FILLED_VOIDS ///< what can be filled is filled
    };
};

/// A square block of tiles that one worker builds at a time: `root` and the `depth` levels below it. Its arrays are
/// lattices of the level root.level + depth.
struct Unit
{
    TileKey root;
    int depth = 0;
    bool sampled = true; ///< it samples rasters; else it uses the roots of the units below it

    int latticeLevel() const { return root.level + depth; }
    int span() const { return 1 << depth; }
};

class KeptFiles;

/** Everything that follows from the options and the rasters' headers, and everything that the passes hand on.

    There are two passes. A skirt must reach the coarsest neighbour that can ever stand beside it, and the error of
    this neighbour is known only after all heights have been seen. */
class BuildPlan
{
public:
    /// Who builds: one process that knows all facts, or any number of them that read what they need from work files.
    enum class Workers
    {
        ONE_PROCESS,
        MANY_PROCESSES
    };
    explicit BuildPlan(const BuildOptions& options, Workers workers = Workers::ONE_PROCESS);

    BuildOptions options;
    const Workers workers;
    TilingScheme scheme;
    /// The units of the deepest root level first. Those of a tier may use the roots of the tier before.
    std::vector<std::vector<Unit>> tiers;
    /// Units that cover the lattice of voids. If all data have the same density, these are the units that sample.
    std::vector<Unit> voidUnits;
    int voidLevel = 0; ///< the level whose posts voids are filled on: that of the coarsest elevation
    std::vector<LandCoverClass> classes;
    std::array<std::array<unsigned char, 4>, 256> classColors{};
    /// The land cover's class of a value; null if the table has none.
    const LandCoverClass* classOf(unsigned char value) const { return _classByValue[value]; }
    /// Elevation files of about the same density that follow each other in the list. Their heights cover those of
    /// the layers before; at the end of their data they blend into them.
    struct Layer
    {
        std::size_t first = 0, last = 0; ///< files: `first` up to the one before `last`
        double west = 0.0, south = 0.0, east = 0.0, north = 0.0; ///< in the grid's CRS
        double stepX = 0.0, stepY = 0.0;                         ///< of its densest file
        /// Across this width heights blend into those below, in the grid's CRS. 0 in the first layer.
        double blendX = 0.0, blendY = 0.0;
    };
    std::vector<Layer> layers;
    /// The rasters of shores. The first covers the extent, and denser ones follow.
    std::vector<GroundPatch> groundPatches;
    std::shared_ptr<const GroundRaster> ground; ///< from the ground pass on
    std::shared_ptr<const VoidRaster> voids;    ///< null until the voids are filled, and if there are none
    /// Keeps others out of the database's folder, from prepareFolder() on.
    std::shared_ptr<const FolderLock> folderLock;
    std::string fingerprint; ///< what the database's bytes depend on, in words
    /// What all units depend on, in words: the fingerprint without the sources of a part, and the grid.
    std::string common;

    /// A raster: what tells its content from that of another one, in words, and where it is.
    struct Source
    {
        std::string identity;
        Footprint print;
        RasterBands bands; ///< of imagery: what is shown
    };
    std::vector<UndeclaredVoids> demVoids; ///< by file of the elevation
    std::string heightUnits;               ///< of the files of the elevation, as a clause
    std::vector<Source> demSources, imagerySources;
    std::optional<Source> landCoverSource, treeCoverSource;

    /// What former units are known by, if this is an update and they can be used; else null.
    std::shared_ptr<const KeptFiles> kept;
    /// Whether new tiles wait among the work files until all are ready, since the folder has a finished database.
    bool staged = false;
    int threads = 1;
    BuildEstimate estimate;

    /// The facts of a tile. Those of a tile that the quadtree lacks are empty, and must not be changed. If many
    /// processes build, they come from the work file of the tile's unit. Throws BuildError if it is missing.
    TileFacts& fact(const TileKey& key);
    const TileFacts& fact(const TileKey& key) const;
    bool has(const TileKey& key) const;
    /// Whether a tile has no finer ones below it. The sources that touch it have no more to show.
    bool isLeaf(const TileKey& key) const;
    /// The unit whose lattice has a unit's root; empty for that of the whole.
    std::optional<Unit> unitAbove(const Unit& unit) const;
    /// The square that a sampled unit is cut out of: the unit itself, or, for a single tile that only stands alone since a
    /// neighbour goes deeper, the unit that it would be a part of otherwise. The last bits of GDAL's samples depend on
    /// the points beside them. Thus tiles do not change when others go deeper.
    Unit sampledSquare(const Unit& unit) const;
    /// Whether any of the four tiles beside a tile, on its level, has finer ones below it.
    bool isBesideDenser(const TileKey& key) const;
    const TileFacts& whole() const { return fact({0, 0, 0}); }
    /// Whether there is ground all around the Earth, but for a few degrees at the poles, which caps close. The facts of all
    /// units must be known.
    bool isWholeEarth() const;
    /// The height of the pole beyond a tile's side (0 south, 2 north), metres: the mean along the end of the ground there. The
    /// tile has a part of the cap that closes the Earth. Empty for other tiles and sides.
    std::optional<double> poleHeight(const TileKey& key, int side) const;
    /// Empty facts for a unit whose heights come next. Facts count as a unit's from here on.
    void startFacts(const Unit& unit);
    /// Takes a unit's facts from its work file. Returns false if there is none, or a damaged one.
    bool loadFacts(const Unit& unit) const;
    /// Writes the work file of a unit's facts. `key` stands for what they were made from.
    void writeFacts(const Unit& unit, const Digest& key) const;
    /// The facts of a unit's tiles, what their walls must reach, and which are leaves. For this the facts of all units must
    /// be known.
    Digest factsDigest(const Unit& unit) const;
    /// Drops facts that can be read again. No other thread may use the plan. It does nothing for one process.
    void forgetFacts();
    /// The work file of a unit's heights, roots or facts: that of the filled ones if its voids are filled.
    std::string heightFile(const char* pass, const Unit& unit) const;
    /// How far the walls on a tile's side (0 south, 1 east, 2 north, 3 west) reach at least below a mesh's own error,
    /// metres. They reach the finest meshes of all tiles that can stand there while finer ones are loaded. 0 if no
    /// tile can.
    double skirt(const TileKey& key, int side) const;
    double leastSkirt(int level) const; ///< on even ground, metres

    /// The vertical error that the finest meshes of a level are made with, metres. Those of the finest level have all
    /// posts instead, except on plains.
    double tolerance(int level) const;
    /// Bounds of the vertical error of a level's finest meshes and of all its meshes, metres, against their own
    /// lattice.
    double finestError(int level) const;
    double largestError(int level) const;

    /// The points of a unit's lattice on the extent. Points beyond repeat the last of them.
    int validColumns(const Unit& unit) const;
    int validRows(const Unit& unit) const;
    /// The posts of a unit's lattice on the extent, with one more on each side.
    Lattice postsWithApron(const Unit& unit) const;

    /// The file with the children of `parent`, of the finished database.
    std::string tileFile(const TileKey& parent) const;
    /// Where this build writes it.
    std::string newTileFile(const TileKey& parent) const;
    std::string workFile(const char* pass, const Unit& unit) const;
    std::string workFolder() const;

    /// Counts a finished unit. Throws BuildError if the caller's progress function says stop.
    void advance(const std::string& phase);
    BuildProgress progress;
    std::uint64_t unitsDone = 0, unitsTotal = 0;

private:
    /// Along x and y, in the grid's CRS.
    struct Spacing
    {
        double x, y;
    };
    /// What asks for levels: a source's rectangle, and the level that shows all of it.
    struct Demand
    {
        double west, south, east, north;
        int level;
    };
    void chooseGrid();
    void chooseExtent();
    /// `units`: of the elevation's files, metres.
    void lookAtHeights(const std::vector<double>& units);
    void chooseLayers(const std::vector<Footprint>& dems);
    void chooseDemands();
    void chooseGround();
    /// The coarsest level whose posts are about as dense, or denser.
    int levelFor(double stepX, double stepY) const;
    int demand(const TileKey& key) const; ///< the deepest level that any source asks for there
    bool uniform() const;                 ///< whether all tiles reach the finest level
    void addUnits(const TileKey& root, std::size_t ladder);
    void countTiles(const Unit& unit);
    /// The facts of a unit's tiles, level after level from its root on. Empty if they are not known.
    struct Block
    {
        std::size_t unit = 0; ///< its number in its tier
        mutable std::vector<TileFacts> facts;
    };
    /// Where a tile's facts are.
    struct Place
    {
        const Block* block = nullptr; ///< null if the quadtree lacks the tile
        const Unit* unit = nullptr;
        std::size_t index = 0;
    };
    Place placeOf(const TileKey& key) const;
    /// The sources that the texels' spacing follows from: the imagery, or else the land cover.
    std::vector<const Footprint*> colorPrints() const;
    void checkColors();
    void chooseLevels();
    void chooseTexels();
    /// Adds a level below all.
    void deepen();
    void chooseEstimate();
    void chooseUnits();
    void chooseFingerprint();
    std::array<const LandCoverClass*, 256> _classByValue{};
    std::vector<int> _roots, _lattices; ///< the levels of roots and lattices, by tier
    std::vector<std::unordered_map<std::uint64_t, Block>> _blocks; ///< by tier and the root's place
    mutable std::mutex _factsMutex;
    std::vector<Footprint> _dems;
    std::vector<Demand> _demands;
    std::uint64_t _tiles = 0, _units = 0;
    std::mutex _progressMutex;
};

/// The place of a tile on its level, as one number.
inline std::uint64_t placeNumber(int x, int y)
{
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32) | static_cast<std::uint32_t>(x);
}

/// The number of the machine's cores, at least 1.
int coreCount();

/// A number of bytes in words: "12 MB".
std::string sizeInWords(double bytes);

/// The rasters of a plan, opened for one worker.
class RasterStack
{
public:
    explicit RasterStack(const BuildPlan& plan);

    /// Heights on a lattice, metres; NaN for none.
    std::vector<float> heights(const Lattice& lattice);
    /// Those of a unit's posts with an apron (BuildPlan::postsWithApron), from those of its square.
    std::vector<float> unitHeights(const Unit& unit);

    /// The heights of the files, not moved to the ellipsoid: level water is level, and the sea is at 0. Voids are
    /// filled once the plan knows their heights. `filled` then gets a byte for each point, 1 for a filled one.
    std::vector<float> heightsAboveSea(const Lattice& lattice, std::vector<unsigned char>* filled = nullptr);

    /// The same without filled voids.
    std::vector<float> measuredHeights(const Lattice& lattice);

    /// One byte for each point: 1 if it has a height, or if it lies within the rectangle of a raster that has none
    /// there.
    std::vector<unsigned char> covered(const Lattice& lattice, const std::vector<float>& heights);

    /// Classes on a lattice; 0 for none. Empty without land cover.
    std::vector<unsigned char> classes(const Lattice& lattice);

    /// Base colors on a lattice: red, green, blue for each texel.
    std::vector<unsigned char> colors(const Lattice& lattice);

    /// What lies on the ground: four bytes for each texel, coded as in shaders/lib/cover.glsl. `ground` is the plan's
    /// at the same texels. It has the shores, and counts where no other raster says more.
    std::vector<unsigned char> cover(const Lattice& lattice, const std::vector<GroundCell>& ground);

private:
    void moveToEllipsoid(const Lattice& lattice, std::vector<float>& heights);
    std::vector<float> layerHeights(const BuildPlan::Layer& layer, const Lattice& lattice);

    const BuildPlan& _plan;
    std::vector<RasterSource> _dems, _imagery, _landCover, _landCoverColors, _landCoverShares, _treeCover;
    std::vector<std::unique_ptr<BlendMask>> _blends; ///< by layer; null until it is needed, and for the first
    TransformationPtr _geoid;
    std::optional<TileKey> _square; ///< the root of the square whose heights come next
    std::vector<float> _squareHeights;
    bool _squareFilled = false; ///< whether the plan knew filled voids
};

/// The lattice of an upper tier's unit, made of the roots of the units below it. The stages of heights left these.
HeightGrid gatherRoots(const BuildPlan& plan, const Unit& unit);

} // namespace osgGeoFX
