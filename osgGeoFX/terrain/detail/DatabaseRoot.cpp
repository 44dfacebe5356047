// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/DatabaseRoot.h>

#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>
#include <osgGeoFX/terrain/detail/NormalMap.h>
#include <osgGeoFX/terrain/detail/TileFile.h>
#include <osgGeoFX/terrain/detail/TileMesh.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/Material>
#include <osg/ValueObject>

#include <cstdio>
#include <filesystem>
#include <optional>

namespace osgGeoFX
{

namespace
{

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

/// The tile whose children a file of the folder `tiles` has; empty if the name is no tile's.
std::optional<TileKey> parentOf(const std::filesystem::path& file)
{
    TileKey key;
    char rest = 0;
    if (std::sscanf(file.generic_string().c_str(), "%d/%d/%d.osg%c", &key.level, &key.x, &key.y, &rest) !=
            4 ||
        rest != 'b' || file.generic_string() != key.path() + ".osgb")
        return {};
    return key;
}

/// The files of the former database that do not belong to this one any more.
std::vector<std::string> obsoleteFiles(BuildPlan& plan)
{
    // The facts of so many units at most, if they are read from files.
    constexpr std::size_t batch = 10000;
    namespace fs = std::filesystem;
    std::vector<std::string> result;
    const fs::path tiles = fs::path(plan.options.output) / "tiles";
    std::error_code code;
    std::size_t count = 0;
    for (fs::recursive_directory_iterator entry(tiles, code), end; !code && entry != end;
         entry.increment(code))
    {
        if (!entry->is_regular_file(code)) continue;
        const fs::path name = fs::relative(entry->path(), tiles);
        const auto parent = parentOf(name);
        if (!parent || !plan.has(*parent) || plan.isLeaf(*parent) || !plan.fact(*parent).any)
            result.push_back("tiles/" + name.generic_string());
        if (++count % batch == 0) plan.forgetFacts();
    }
    return result;
}

/// Writes terrain.osgb, and makes the folder a finished database.
class Finish : public BuildStage
{
public:
    Finish(BuildPlan& plan, TilePassResult& result)
        : BuildStage("finish", "tiles"), _plan(plan), _result(result)
    {
    }
    std::size_t units() const override { return 1; }
    void begin() override
    {
        if (VoidRaster::isNeeded(_plan) && !_plan.voids) _plan.voids = std::make_shared<VoidRaster>(_plan);
    }
    bool takeOver(std::size_t) override { return false; }
    void run(int, std::size_t) override
    {
        readTilePassResult(_plan, _result);
        writeNodeAtomically(*createRoot(_plan, _result),
                            (stagedFolderOf(_plan.options.output) / "terrain.osgb").string());
        finishFolder(_plan, _plan.staged ? obsoleteFiles(_plan) : std::vector<std::string>());
    }

private:
    BuildPlan& _plan;
    TilePassResult& _result;
};

} // namespace

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
    osg::StateSet& tiles = *result.root->getOrCreateStateSet();
    addTileProgram(tiles);
    // Ground and walls are seen from outside alone. Mountains at the skyline show as many backs as fronts.
    tiles.setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    root->addChild(result.root);
    return root;
}

BuildStages createStages(BuildPlan& plan, TilePassResult& result)
{
    BuildStages stages;
    addHeightStages(plan, stages);
    addGroundStages(plan, stages);
    addTileStages(plan, stages, result);
    stages.push_back(std::make_unique<Finish>(plan, result));
    return stages;
}

} // namespace osgGeoFX
