// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/TownBuilder.h>

#include <osgGeoFX/batch/detail/WorkQueue.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/TileFile.h>
#include <osgGeoFX/town/detail/BuildingReader.h>
#include <osgGeoFX/town/detail/BuildingSpool.h>
#include <osgGeoFX/town/detail/TownCells.h>
#include <osgGeoFX/town/detail/WindowPicture.h>

#include <osg/CoordinateSystemNode>
#include <osg/ValueObject>
#include <osgDB/Registry>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <locale>
#include <mutex>
#include <sstream>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// The folder of a town's files, and those of one that is being made and of one that makes room.
constexpr const char *FOLDER = "buildings", *NEXT = "buildings.new", *FORMER = "buildings.old";
constexpr const char* COUNT = "geofx.buildings";
/// The file in each of these folders that says that they are a town's.
constexpr const char* MARK = "town.txt";
constexpr const char* MARK_TEXT =
    "A town of osggeofx_build. It is removed and made anew with the next one; keep nothing else here.\n";

bool isOurs(const fs::path& folder)
{
    return fs::exists(folder / MARK);
}

void mark(const fs::path& folder)
{
    writeFileAtomically((folder / MARK).string(), MARK_TEXT, std::char_traits<char>::length(MARK_TEXT));
}

/// Throws if a folder that a town takes has other files.
void refuseForeign(const fs::path& folder)
{
    if (fs::exists(folder) && !isOurs(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
        throw BuildError(folder.string() +
                         ": something else has the name that the town takes; move it elsewhere.");
}

/// Whether a file lies in a folder or below it.
bool isBelow(const fs::path& file, const fs::path& folder)
{
    std::error_code code;
    const fs::path inner = fs::weakly_canonical(file, code), outer = fs::weakly_canonical(folder, code);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void removeOurs(const fs::path& folder)
{
    std::error_code code;
    if (isOurs(folder)) fs::remove_all(folder, code);
}

/// Puts a town back whose exchange was interrupted.
void putBack(const fs::path& folder)
{
    std::error_code code;
    if (isOurs(folder / FORMER) && !fs::exists(folder / FOLDER))
        fs::rename(folder / FORMER, folder / FOLDER, code);
}

/// Without a path in the options, OSG leaves file names as they were written.
osg::ref_ptr<osg::CoordinateSystemNode> readRoot(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw BuildError(file.string() +
                         ": there is no finished terrain database for the buildings; build one with "
                         "osggeofx_build --dem FILE -o DIR.");
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    const osg::ref_ptr<osgDB::Options> withoutPath = new osgDB::Options;
    osg::ref_ptr<osg::Node> node;
    if (reader) node = reader->readNode(stream, withoutPath).getNode();
    auto* root = dynamic_cast<osg::CoordinateSystemNode*>(node.get());
    if (!root) throw BuildError(file.string() + ": it cannot be read; build the terrain again with --anew.");
    return root;
}

void removeTownOf(osg::Group& root)
{
    for (unsigned int i = root.getNumChildren(); i-- > 0;)
        if (root.getChild(i)->getName() == FOLDER) root.removeChild(i);
}

void moveFolder(const fs::path& from, const fs::path& to)
{
    std::error_code code;
    fs::rename(from, to, code);
    if (code)
        throw BuildError(to.string() + ": the folder cannot be put there (" + code.message() +
                         "); make the database's folder writable, and build the town again.");
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Removes its folder at the end of its life.
struct WorkFolder
{
    explicit WorkFolder(fs::path folder) : path(std::move(folder))
    {
        std::error_code code;
        removeOurs(path);
        fs::create_directories(path, code);
        if (!fs::is_directory(path))
            throw BuildError(path.string() + ": the folder cannot be made (" + code.message() +
                             "); make the database's folder writable.");
        mark(path);
        mark(path / FOLDER);
    }
    ~WorkFolder() { removeOurs(path); }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    const fs::path path;
};

} // namespace

std::string TownSummary::text() const
{
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.setf(std::ios::fixed);
    out.precision(1);
    out << buildings << " buildings, " << gabled << " of them with gabled roofs, in " << files << " files of "
        << static_cast<double>(bytes) * 1e-6 << " MB; read in " << readSeconds << " s, built in "
        << seconds - readSeconds << " s ("
        << static_cast<std::uint64_t>(static_cast<double>(buildings) / std::max(seconds, 1e-3))
        << " buildings a second), peak memory " << peakMemoryBytes / (1024 * 1024) << " MiB.\n";
    const auto tell = [&](std::uint64_t count, const char* what)
    {
        if (count > 0) out << count << " " << what << "\n";
    };
    tell(byStoreys, "have their height from their storeys.");
    tell(byArea, "have a height that was guessed from their area, since nothing tells it.");
    tell(badHeights, "heights were no numbers from 1 to 1500 m, and were not used.");
    tell(repaired, "had an invalid outline, which was mended.");
    tell(leftOut, "were left out: their outlines cannot be used.");
    tell(outside, "were left out: they stand where the terrain has no ground.");
    tell(parts, "are parts of buildings.");
    tell(inParts, "outlines are not drawn, since parts stand in their place.");
    tell(otherFeatures, "features are no polygons or no buildings.");
    return out.str();
}

TownSummary buildTown(const TownOptions& options, const TownProgress& progress)
{
    const auto start = std::chrono::steady_clock::now();
    TownSummary summary;
    const fs::path folder = options.database, file = folder / "terrain.osgb";
    const std::shared_ptr<const FolderLock> folderLock = lockFolder(folder, FolderLock::ALONE);
    // An update of the terrain that is ready ends first.
    if (fs::exists(folder)) completeFolder(folder);
    const osg::ref_ptr<osg::CoordinateSystemNode> root = readRoot(file);
    std::string error;
    const std::optional<TerrainInfo> terrain = TerrainInfo::read(root, error);
    if (!terrain)
        throw BuildError(file.string() + ": " +
                         (error.empty() ? "it is no database of osggeofx_build." : error));
    removeTownOf(*root);
    const TownGrid grid(*terrain);

    for (const char* name : {FOLDER, NEXT, FORMER})
    {
        if (isBelow(options.buildings, folder / name))
            throw BuildError(options.buildings +
                             ": it lies in a folder that the town takes; move it elsewhere.");
        refuseForeign(folder / name);
    }
    putBack(folder);
    const WorkFolder next(folder / NEXT);
    TownCells cells(grid, *terrain, *root, folder.string(), next.path.string(), options.ambientOcclusion);
    {
        readBuildings(options, grid, root->getCoordinateSystem(), summary, progress,
                      [&](Building&& building)
                      {
                          if (!cells.add(building)) ++summary.outside;
                      });
        cells.finishReading();
    }
    summary.readSeconds = secondsSince(start);

    const int wanted = options.threads > 0
                           ? options.threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::mutex mutex;
    std::uint64_t done = 0;
    runOnWorkers(wanted, cells.units(),
                 [&](int worker, std::size_t unit)
                 {
                     cells.build(worker, unit);
                     const std::lock_guard<std::mutex> lock(mutex);
                     if (progress && !progress(++done, cells.units(), "town"))
                         throw BuildError(options.database +
                                          ": the town was stopped; the database is as it was.");
                 });
    const osg::ref_ptr<osg::Group> town = cells.finish();
    summary.buildings = cells.buildings();
    summary.outside += cells.outside();
    summary.gabled = cells.noted(Building::GABLED);
    summary.byStoreys = cells.noted(Building::BY_STOREYS);
    summary.byArea = cells.noted(Building::BY_AREA);
    summary.badHeights = cells.noted(Building::BAD_HEIGHT);
    summary.repaired = cells.noted(Building::REPAIRED);
    if (summary.buildings == 0)
        throw BuildError(options.buildings + ": none of its " +
                         std::to_string(summary.leftOut + summary.outside + summary.otherFeatures) +
                         " features is a building that stands on this terrain; check its CRS and its extent "
                         "with ogrinfo.");
    town->setName(FOLDER);
    town->setStateSet(createTownState());
    root->addChild(town);
    root->setUserValue(COUNT, static_cast<double>(summary.buildings));

    std::error_code code;
    removeOurs(folder / FORMER);
    if (fs::exists(folder / FOLDER)) moveFolder(folder / FOLDER, folder / FORMER);
    try
    {
        moveFolder(next.path / FOLDER, folder / FOLDER);
        writeNodeAtomically(*root, file.string());
    }
    catch (...)
    {
        // The former town stays, or none.
        removeOurs(folder / FOLDER);
        putBack(folder);
        throw;
    }
    removeOurs(folder / FORMER);

    for (fs::recursive_directory_iterator entry(folder / FOLDER, code), end; !code && entry != end;
         entry.increment(code))
        if (entry->is_regular_file(code)) ++summary.files;
    summary.bytes = bytesBelow(folder / FOLDER);
    summary.seconds = secondsSince(start);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    summary.peakMemoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return summary;
}

bool removeStrayTown(const std::string& database)
{
    const fs::path folder = database;
    putBack(folder);
    if (!isOurs(folder / FOLDER) && !isOurs(folder / FORMER) && !isOurs(folder / NEXT)) return false;
    const osg::ref_ptr<osg::CoordinateSystemNode> root = readRoot(folder / "terrain.osgb");
    bool used = false;
    for (unsigned int i = 0; i < root->getNumChildren(); ++i)
        used = used || root->getChild(i)->getName() == FOLDER;
    const bool stray = !used && isOurs(folder / FOLDER);
    if (stray) removeOurs(folder / FOLDER);
    removeOurs(folder / FORMER);
    removeOurs(folder / NEXT);
    return stray;
}

} // namespace osgGeoFX
