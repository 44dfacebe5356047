// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// No cracks: over a magenta background, no magenta shows inside the terrain's outline, whatever levels stand
// side by side: those of a settled scene, of one that is still being paged, or any at all.
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/Geocentric.hpp>

#include <osg/Polytope>
#include <osgDB/WriteFile>

#include <map>
#include <set>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

const std::string oahu = GEOFX_SOURCE_DIR "/data/oahu/elevation.tif";
constexpr int WIDTH = 640, HEIGHT = 400;
constexpr double FIELD_OF_VIEW = 45.0;

/// A database, all of it in memory.
class LoadedDatabase
{
public:
    explicit LoadedDatabase(const std::string& folder)
    {
        root = std::make_unique<DatabaseRoot>(folder);
        readDatabase(folder, [&](const DatabaseTile& tile) { tiles[{tile.level, tile.x, tile.y}] = tile; });
    }

    std::map<std::tuple<int, int, int>, DatabaseTile> tiles;
    std::unique_ptr<DatabaseRoot> root;
};

/// A database in its folder, and in memory.
class BuiltDatabase
{
public:
    explicit BuiltDatabase(bool geocentric)
    {
        BuildOptions options;
        // The Ko'olau ridge with coast on both sides, or the whole island.
        options.dems = {fullTest() ? oahu : writeCrop(oahu, _folder / "dem.tif", 1750, 1150, 900, 800)};
        options.tileSize = fullTest() ? 64 : 32;
        options.textureSize = 32;
        options.epsg = geocentric ? 0 : 32604;
        options.output = folder();
        // So that at the size of these pictures levels of the range that osgviewer has on a screen stand side
        // by side.
        options.pixelsPerRadian = HEIGHT / osg::DegreesToRadians(FIELD_OF_VIEW);
        buildDatabase(options);
        loaded = std::make_unique<LoadedDatabase>(folder());
    }
    std::string folder() const { return _folder / "db"; }

    std::unique_ptr<LoadedDatabase> loaded;

private:
    TempDir _folder;
};

/// Whether a tile gives way to the four below it.
using Refine = std::function<bool(const DatabaseTile&)>;

struct Cut
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    std::vector<int> levels; ///< of the scene's children

    /// How many levels are in a camera's picture, by the tiles' bounding spheres.
    std::size_t levelsInView(const osg::Camera& camera) const
    {
        osg::Polytope frustum;
        frustum.setToUnitFrustum(false, false);
        frustum.transformProvidingInverse(camera.getViewMatrix() * camera.getProjectionMatrix());
        std::set<int> result;
        for (unsigned int i = 0; i < scene->getNumChildren(); ++i)
            if (frustum.contains(scene->getChild(i)->getBound())) result.insert(levels[i]);
        return result.size();
    }
};

void take(const LoadedDatabase& database, const DatabaseTile& tile, const Refine& refine, Cut& cut)
{
    if (!tile.lod || (tile.geometry && !refine(tile)))
    {
        cut.scene->addChild(tile.transform);
        cut.levels.push_back(tile.level);
        return;
    }
    for (int c = 0; c < 4; ++c)
    {
        const auto child = database.tiles.find({tile.level + 1, 2 * tile.x + (c & 1), 2 * tile.y + (c >> 1)});
        if (child != database.tiles.end()) take(database, child->second, refine, cut);
    }
}

Cut cutOf(const LoadedDatabase& database, const Refine& refine)
{
    Cut cut;
    // As above a database's tiles.
    cut.scene->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    take(database, database.tiles.at({0, 0, 0}), refine, cut);
    return cut;
}

bool isMagenta(const osg::Image& image, int x, int y)
{
    const unsigned char* p = image.data(static_cast<unsigned>(x), static_cast<unsigned>(y));
    return p[0] == 255 && p[1] == 0 && p[2] == 255;
}

/// Magenta pixels that no way through magenta joins to the picture's border: what lies outside the terrain's
/// outline is joined to it.
int countCracks(const osg::Image& image)
{
    const int width = image.s(), height = image.t();
    std::vector<bool> outside(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), false);
    std::vector<std::pair<int, int>> open;
    const auto visit = [&](int x, int y)
    {
        if (x < 0 || y < 0 || x >= width || y >= height || !isMagenta(image, x, y)) return;
        const auto i = static_cast<std::size_t>(y * width + x);
        if (outside[i]) return;
        outside[i] = true;
        open.emplace_back(x, y);
    };
    for (int x = 0; x < width; ++x)
        for (const int y : {0, height - 1})
            visit(x, y);
    for (int y = 0; y < height; ++y)
        for (const int x : {0, width - 1})
            visit(x, y);
    while (!open.empty())
    {
        const auto [x, y] = open.back();
        open.pop_back();
        // Diagonally too: of a silhouette's teeth only the tips may touch.
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                visit(x + dx, y + dy);
    }
    int cracks = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            cracks += isMagenta(image, x, y) && !outside[static_cast<std::size_t>(y * width + x)];
    return cracks;
}

class Cracks : public GlFixture
{
protected:
    Cracks() : GlFixture(WIDTH, HEIGHT) {}

    static void TearDownTestSuite()
    {
        geocentricDatabase.reset();
        projectedDatabase.reset();
    }

    static const BuiltDatabase& built(bool geocentric = true)
    {
        auto& result = geocentric ? geocentricDatabase : projectedDatabase;
        if (!result) result = std::make_unique<BuiltDatabase>(geocentric);
        return *result;
    }
    static const LoadedDatabase& database(bool geocentric = true) { return *built(geocentric).loaded; }

    /// Places the camera somewhere above the terrain, looking down at a slant; returns the eye in the world.
    osg::Vec3d placeCamera(const DatabaseRoot& root, Random& random)
    {
        const osg::Vec3d place(random.uniform(root.west(), root.east()),
                               random.uniform(root.south(), root.north()),
                               root.value<double>("geofx.maxHeight") + random.logarithmic(20.0, 6000.0));
        const osg::Vec3d eye = root.toWorld(place);
        osg::Vec3d east(1, 0, 0), north(0, 1, 0), up(0, 0, 1);
        if (root.geocentric())
        {
            double x = 0, y = 0, z = 0;
            std::vector<double> r(9);
            GeographicLib::Geocentric::WGS84().Forward(place.y(), place.x(), place.z(), x, y, z, r);
            east.set(r[0], r[3], r[6]);
            north.set(r[1], r[4], r[7]);
            up.set(r[2], r[5], r[8]);
        }
        const double heading = random.uniform(0.0, 2.0 * osg::PI), pitch = random.uniform(-1.2, -0.02);
        const osg::Vec3d forward =
            (north * std::cos(heading) + east * std::sin(heading)) * std::cos(pitch) + up * std::sin(pitch);
        osg::Camera* camera = viewer().getCamera();
        camera->setViewMatrixAsLookAt(eye, eye + forward * 1000.0, up);
        camera->setProjectionMatrixAsPerspective(FIELD_OF_VIEW, double(WIDTH) / HEIGHT, 1.0, 1e6);
        camera->setClearColor(osg::Vec4(1, 0, 1, 1));
        return eye;
    }

    /// Draws cuts that `refine` chooses for each camera, and counts the pictures with cracks.
    int picturesWithCracks(const LoadedDatabase& database, const std::string& name, int pictures,
                           const std::function<Refine(const osg::Vec3d& eye, Random& random)>& choose,
                           bool keepPictures = true)
    {
        int bad = 0, mixed = 0;
        for (int picture = 0; picture < pictures; ++picture)
        {
            Random random(static_cast<std::uint64_t>(picture));
            const osg::Vec3d eye = placeCamera(*database.root, random);
            const Cut cut = cutOf(database, choose(eye, random));
            mixed += cut.levelsInView(*viewer().getCamera()) >= 2;
            const osg::ref_ptr<osg::Image> image = render(cut.scene);
            if (!image)
            {
                ADD_FAILURE() << "no picture";
                return pictures;
            }
            const int cracks = countCracks(*image);
            bad += cracks > 0;
            if (!keepPictures || (cracks == 0 && picture > 1)) continue;
            const std::string file =
                (testOutputFolder() / (name + std::to_string(picture) + ".png")).string();
            osgDB::writeImageFile(*image, file);
            if (cracks > 0)
                ADD_FAILURE() << cracks << " pixels of background in the terrain: Random(" << picture << "), "
                              << file;
        }
        EXPECT_GE(mixed, pictures / 2) << "in hardly any picture levels meet";
        return bad;
    }

    static int pictures() { return fullTest() ? 100 : 4; }

private:
    static std::unique_ptr<BuiltDatabase> geocentricDatabase, projectedDatabase;
};

std::unique_ptr<BuiltDatabase> Cracks::geocentricDatabase, Cracks::projectedDatabase;

/// What a PagedLOD does when all its files are there.
Refine settled(const osg::Vec3d& eye)
{
    return [eye](const DatabaseTile& tile)
    {
        return (eye - osg::Vec3d(tile.lod->getCenter())).length() <
               static_cast<double>(tile.lod->getMaxRange(1));
    };
}

/// As settled, but three tiles of ten are still waiting for theirs.
Refine whilePaging(const osg::Vec3d& eye, Random& random)
{
    return [all = settled(eye), &random](const DatabaseTile& tile)
    {
        return all(tile) && (tile.level < 2 || random.uniform(0, 1) < 0.7);
    };
}

/// Without regard to distance.
Refine anyhow(Random& random)
{
    return [&random](const DatabaseTile& tile)
    {
        return tile.level < 1 || random.uniform(0, 1) < 0.8;
    };
}

TEST_F(Cracks, NoneInASettledScene)
{
    picturesWithCracks(database(), "settled", pictures(),
                       [](const osg::Vec3d& eye, Random&) { return settled(eye); });
}

TEST_F(Cracks, NoneWhilePaging)
{
    picturesWithCracks(database(), "paging", pictures(),
                       [](const osg::Vec3d& eye, Random& random) { return whilePaging(eye, random); });
}

TEST_F(Cracks, NoneBetweenAnyLevels)
{
    picturesWithCracks(database(), "any", pictures(),
                       [](const osg::Vec3d&, Random& random) { return anyhow(random); });
}

TEST_F(Cracks, NoneOnAProjectedGrid)
{
    picturesWithCracks(database(false), "projected", pictures(),
                       [](const osg::Vec3d& eye, Random& random) { return whilePaging(eye, random); });
}

/// That these tests can see a crack: without skirts there are many.
TEST_F(Cracks, ManyWithoutSkirts)
{
    LoadedDatabase bare(built().folder());
    for (auto& [key, tile] : bare.tiles)
    {
        for (const auto& mesh : tile.meshes)
        {
            osg::ref_ptr<osg::DrawElementsUInt> elements =
                new osg::DrawElementsUInt(osg::PrimitiveSet::TRIANGLES);
            for (unsigned int i = 0; i < 3 * mesh.ground.size(); ++i)
                elements->push_back(mesh.geometry->getPrimitiveSet(0)->index(i));
            elements->setElementBufferObject(new osg::ElementBufferObject);
            mesh.geometry->setPrimitiveSet(0, elements);
        }
    }
    EXPECT_GE(picturesWithCracks(
                  bare, "bare", pictures(),
                  [](const osg::Vec3d& eye, Random& random) { return whilePaging(eye, random); }, false),
              pictures() / 4);
}

} // namespace
