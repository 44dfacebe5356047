// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/NormalMap.h>
#include <osgGeoFX/terrain/detail/TileFile.h>
#include <osgGeoFX/terrain/detail/TileMesh.h>
#include <osgGeoFX/terrain/detail/TilePass.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/CoordinateSystemNode>
#include <osg/Material>
#include <osg/ValueObject>
#include <osgDB/ReadFile>

#include <sys/resource.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* ORIGIN_FILE = "built-from.txt";

std::string readText(const fs::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::uint64_t bytesBelow(const fs::path& folder)
{
    std::uint64_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) bytes += entry.file_size();
    return bytes;
}

/// Empties or adopts the output folder. Returns true where a finished database of the same build lies there.
bool prepareFolder(const BuildPlan& plan)
{
    const fs::path folder = plan.options.output;
    const fs::path origin = folder / ORIGIN_FILE, root = folder / "terrain.osgb";
    std::error_code code;
    fs::create_directories(folder, code);
    if (code || !fs::is_directory(folder))
        throw BuildError(folder.string() + ": the folder cannot be made (" +
                         (code ? code.message() : std::string("a file has this name")) +
                         "); choose another with -o.");
    // A kill in its very first moments leaves only the origin's temporary file.
    fs::remove(origin.string() + ".tmp", code);
    const bool ours = fs::exists(origin);
    if (!ours && !fs::is_empty(folder))
        throw BuildError(
            folder.string() +
            ": the folder holds other files, which a build would mix with its own; choose an empty one "
            "with -o.");
    if (ours && plan.options.resume)
    {
        if (readText(origin) != plan.fingerprint)
            throw BuildError(
                folder.string() +
                ": the build that was begun here has other sources or options; repeat it with those, or "
                "leave out --resume to begin anew.");
        return fs::exists(root);
    }
    // The root first: without it, what is left of an old database does not look whole. Then the work files: with
    // them, tiles that are removed already would count as done when a kill here is followed by --resume.
    for (const fs::path& old : {root, folder / "work", folder / "tiles"})
    {
        fs::remove_all(old, code);
        if (code)
            throw BuildError(old.string() + ": the old database cannot be removed (" + code.message() +
                             "); make the folder writable, or choose another with -o.");
    }
    writeFileAtomically(origin.string(), plan.fingerprint.data(), plan.fingerprint.size());
    return false;
}

double filledShare(const BuildPlan& plan)
{
    if (!plan.voids || plan.voids->filledPosts() == 0) return 0.0;
    const auto filled = static_cast<double>(plan.voids->filledPosts());
    return filled / (filled + static_cast<double>(plan.voids->dataPosts()));
}

double openShare(const BuildPlan& plan)
{
    if (!plan.voids) return 0.0;
    return static_cast<double>(plan.voids->openPosts()) /
           (static_cast<double>(plan.voids->columns()) * static_cast<double>(plan.voids->rows()));
}

/// For a build that is resumed when all is done; and programs may want to know.
void writeTextures(osg::Object& root, const TextureSummary& textures)
{
    root.setUserValue("geofx.textureBytes", static_cast<double>(textures.bytes));
    root.setUserValue("geofx.textureBytesUncompressed", static_cast<double>(textures.uncompressedBytes));
    const auto& [red, green, blue] = textures.colors;
    const auto& [x, y] = textures.normals;
    root.setUserValue("geofx.colorError",
                      osg::Vec3d(red.rootMeanSquare, green.rootMeanSquare, blue.rootMeanSquare));
    root.setUserValue("geofx.colorErrorLargest", osg::Vec3d(red.largest, green.largest, blue.largest));
    root.setUserValue("geofx.normalError", osg::Vec2d(x.rootMeanSquare, y.rootMeanSquare));
    root.setUserValue("geofx.normalErrorLargest", osg::Vec2d(x.largest, y.largest));
}

TextureSummary readTextures(const osg::Object& root)
{
    TextureSummary result;
    double bytes = 0.0, uncompressed = 0.0;
    root.getUserValue("geofx.textureBytes", bytes);
    root.getUserValue("geofx.textureBytesUncompressed", uncompressed);
    result.bytes = static_cast<std::uint64_t>(bytes);
    result.uncompressedBytes = static_cast<std::uint64_t>(uncompressed);
    osg::Vec3d color, colorLargest;
    osg::Vec2d normal, normalLargest;
    root.getUserValue("geofx.colorError", color);
    root.getUserValue("geofx.colorErrorLargest", colorLargest);
    root.getUserValue("geofx.normalError", normal);
    root.getUserValue("geofx.normalErrorLargest", normalLargest);
    for (unsigned int i = 0; i < 3; ++i)
        result.colors[i] = {color[i], static_cast<int>(colorLargest[i])};
    for (unsigned int i = 0; i < 2; ++i)
        result.normals[i] = {normal[i], static_cast<int>(normalLargest[i])};
    return result;
}

osg::ref_ptr<osg::CoordinateSystemNode> createRoot(const BuildPlan& plan, const TilePassResult& result)
{
    char* wkt = nullptr;
    plan.scheme.crs.srs.exportToWkt(&wkt);
    osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode("WKT", wkt);
    CPLFree(wkt);
    if (plan.scheme.crs.geographic) root->setEllipsoidModel(new osg::EllipsoidModel);
    root->setName("osgGeoFX terrain");

    const double unit = plan.scheme.crs.geographic ? 1.0 : plan.scheme.crs.metresPerUnit;
    const char* vertical[] = {"none", "ellipsoid", "egm96"};
    root->setUserValue("geofx.format", TerrainInfo::newestFormat);
    root->setUserValue("geofx.kind", std::string(plan.scheme.crs.geographic ? "geocentric" : "projected"));
    root->setUserValue("geofx.west", plan.scheme.west * unit);
    root->setUserValue("geofx.south", plan.scheme.south * unit);
    root->setUserValue("geofx.east", plan.scheme.east * unit);
    root->setUserValue("geofx.north", plan.scheme.north * unit);
    root->setUserValue("geofx.minHeight", static_cast<double>(plan.whole().minHeight));
    root->setUserValue("geofx.maxHeight", static_cast<double>(plan.whole().maxHeight));
    root->setUserValue("geofx.pixelsPerRadian", plan.options.pixelsPerRadian);
    root->setUserValue("geofx.pixelError", plan.options.pixelError);
    root->setUserValue("geofx.levels", plan.scheme.finestLevel + 1);
    root->setUserValue("geofx.tileCells", leastCells(plan.scheme.intervals));
    root->setUserValue("geofx.tiles", static_cast<double>(result.tiles));
    root->setUserValue("geofx.voids", std::string(plan.options.voids == Voids::FILL ? "filled" : "kept"));
    root->setUserValue("geofx.filledShare", filledShare(plan));
    root->setUserValue("geofx.openShare", openShare(plan));
    if (plan.voids && plan.voids->filledPosts() > 0)
    {
        // An array and not an image: of an image in the user data OSG writes everything but the pixels.
        const std::vector<unsigned char>& cells = plan.voids->mask();
        osg::ref_ptr<osg::UByteArray> mask = new osg::UByteArray(cells.begin(), cells.end());
        mask->setName("geofx.filledMask");
        root->getOrCreateUserDataContainer()->addUserObject(mask);
        root->setUserValue("geofx.filledMaskColumns", plan.voids->maskColumns());
    }
    writeTextures(*root, result.textures.summary());
    root->setUserValue("geofx.vertical", std::string(vertical[static_cast<int>(plan.options.vertical)]));
    if (!plan.options.landCoverTable.empty())
        root->setUserValue("geofx.landCoverTable", landCoverTableText(plan.options.landCoverTable));

    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    root->getOrCreateStateSet()->setAttributeAndModes(material);
    // Not at the root itself, below which applications put other things.
    addTileProgram(*result.root->getOrCreateStateSet());
    root->addChild(result.root);
    return root;
}

} // namespace

BuildSummary buildDatabase(const BuildOptions& options, const BuildProgress& progress)
{
    const auto start = std::chrono::steady_clock::now();
    BuildPlan plan(options);
    plan.progress = progress;
    const GdalCacheLimit cache(static_cast<GIntBig>(options.memoryMiB) * 1024 * 1024 / 4);

    BuildSummary summary;
    summary.file = options.output + "/terrain.osgb";
    summary.levels = plan.scheme.finestLevel + 1;
    summary.samples = plan.estimate.samples;
    if (prepareFolder(plan))
    {
        const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(summary.file);
        double tiles = 0.0;
        if (!root || !root->getUserValue("geofx.tiles", tiles))
            throw BuildError(summary.file +
                             ": the finished database cannot be read; build again without --resume.");
        summary.tiles = summary.tilesReused = static_cast<std::uint64_t>(tiles);
        root->getUserValue("geofx.filledShare", summary.filledShare);
        root->getUserValue("geofx.openShare", summary.openShare);
        summary.textures = readTextures(*root);
    }
    else
    {
        runHeightPass(plan);
        runGroundPass(plan);
        const TilePassResult result = runTilePass(plan);
        writeNodeAtomically(*createRoot(plan, result), summary.file);
        summary.tiles = result.tiles;
        summary.tilesReused = result.tilesReused;
        summary.textures = result.textures.summary();
        summary.filledShare = filledShare(plan);
        summary.openShare = openShare(plan);
    }
    std::error_code code;
    fs::remove_all(plan.workFolder(), code); // what could not be removed does no harm

    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    summary.peakMemoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    summary.bytes = bytesBelow(options.output);
    summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return summary;
}

} // namespace osgGeoFX
