// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which tiles deserve to be drawn, and how fine, told by the tiles themselves and by where their vertices go: no cull visitor
// is asked. A database says how far each tile's mesh is from the ground (its LOD range beyond its radius); where a deformed vertex is so
// near, or so stretched, that this could be seen, the tile's finer ones are due.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/SampledCases.h>

#include <osg/Geometry>
#include <osg/PagedLOD>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

class DeservedTiles : public GlFixture, public ::testing::WithParamInterface<const char*>
{
protected:
    DeservedTiles() : GlFixture(WIDTH, HEIGHT) {}
};

/// The effects of a picture and the detail that they wish for.
struct Wishes
{
    double transition = 1.0;
    double context = 1.0;
    bool stretchAlone = true; ///< no bend

    double at(double style) const { return style <= 0.0 ? 1.0 : style >= 1.0 ? context : transition; }
};

Wishes addEffects(EffectScene& scene, Random& random)
{
    while (scene.getNumEffects())
        scene.removeEffect(scene.getEffect(0));
    Wishes wishes;
    const int kind = random.integer(0, 3);
    if (kind == 0 || kind == 3)
    {
        const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
        high->setFactor(random.logarithmic(1.5, 6.0));
        scene.addEffect(high);
    }
    if (kind == 0) return wishes;
    osg::ref_ptr<PerspectiveBend> bend;
    if (kind == 1)
    {
        const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
        pedestrian->setBendAngle(random.uniform(0.3, 1.5));
        pedestrian->setFocusDistance(random.logarithmic(500.0, 8000.0));
        pedestrian->setZoneWidth(random.logarithmic(1000.0, 8000.0));
        bend = pedestrian;
    }
    else
    {
        const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
        bird->setHorizonLine(random.uniform(0.6, 0.98));
        bird->setFocusLine(random.uniform(0.0, 0.8) * bird->getHorizonLine());
        bend = bird;
    }
    // A tile that reaches into the zone gets the zone's detail as a whole, so the zone must not wish for less.
    wishes.stretchAlone = false;
    wishes.transition = random.uniform(1.0, 4.0);
    wishes.context = random.uniform(0.5, 1.0);
    bend->setTransitionDetail(wishes.transition);
    bend->setContextDetail(wishes.context);
    scene.addEffect(bend);
    return wishes;
}

/// A tile of which finer ones exist, and those of its geometries that are in memory.
struct Tile
{
    const osg::PagedLOD* group = nullptr;
    const osg::Transform* node = nullptr;
    osg::ref_ptr<osg::Geometry> mesh; ///< its ground
    osg::Matrixd toWorld;
    double error = 0.0; ///< the length that a pixel may cover, times pixels per radian
    double radius = 0.0;
    std::vector<const osg::Transform*> above;
    bool finerHere = false;
};

/// All vertices of a tile, those of its walls among them.
class Vertices : public osg::NodeVisitor
{
public:
    Vertices() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Geometry& mesh) override
    {
        if (!_seen.insert(mesh.getVertexArray()).second) return;
        const auto& vertices = dynamic_cast<const osg::Vec3Array&>(*mesh.getVertexArray());
        all.insert(all.end(), vertices.begin(), vertices.end());
    }

    std::vector<osg::Vec3> all;

private:
    std::set<const osg::Array*> _seen;
};

/// Takes down all tiles that are in memory, drawn or not.
class Tiles : public osg::NodeVisitor
{
public:
    Tiles() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override
    {
        const std::optional<TileInfo> info = TileInfo::read(node);
        if (!info || node.getNumChildren() == 0)
        {
            traverse(node);
            return;
        }
        Tile tile;
        tile.node = &node;
        tile.mesh = TileInfo::ground(node);
        if (!tile.mesh) return;
        tile.toWorld = osg::computeLocalToWorld(getNodePath());
        tile.above = _above;
        auto* group = dynamic_cast<osg::PagedLOD*>(node.getNumParents() ? node.getParent(0) : nullptr);
        if (group && group->getNumRanges() > 1)
        {
            tile.group = group;
            tile.finerHere = group->getNumChildren() > 1;
            // The radius is that of the mesh about its box's middle, as the builder has it.
            const osg::Vec3d middle = (info->boxMin + info->boxMax) * 0.5;
            Vertices vertices;
            node.traverse(vertices);
            for (const osg::Vec3& vertex : vertices.all)
                tile.radius = std::max(tile.radius, (osg::Vec3d(vertex) - middle).length());
            tile.error = std::max(0.0, static_cast<double>(group->getMaxRange(1)) - tile.radius);
        }
        found.push_back(tile);
        if (group) _pending = tile.node;
    }
    void apply(osg::PagedLOD& node) override
    {
        _pending = nullptr;
        if (node.getNumChildren() == 0) return;
        node.getChild(0)->accept(*this);
        const osg::Transform* own = _pending;
        if (own) _above.push_back(own);
        for (unsigned int i = 1; i < node.getNumChildren(); ++i)
            node.getChild(i)->accept(*this);
        if (own) _above.pop_back();
    }

    std::vector<Tile> found;

private:
    std::vector<const osg::Transform*> _above;
    const osg::Transform* _pending = nullptr;
};

/// By how much a point's neighbourhood is stretched, in some directions at least.
double stretchAt(const DeformationChain& chain, const osg::Vec3d& eye, const osg::Vec3d& up)
{
    double most = 0.0;
    for (const osg::Vec3d& direction : {up, osg::Vec3d(1, 0, 0), osg::Vec3d(0, 1, 0), osg::Vec3d(0, 0, 1)})
        most = std::max(most, (chain.deform(eye + direction) - chain.deform(eye - direction)).length() / 2.0);
    return most;
}

/// How many times its tolerance a tile's error may cover without finer tiles being due. OSG's LOD scale multiplies the whole
/// distance, of which the range has the tile's radius unscaled.
double allowed(const Tile& tile, double scale)
{
    if (scale <= 1.0) return scale;
    const double left = tile.error + tile.radius * (1.0 - scale);
    return left > 0.0 ? scale * tile.error / left : HUGE_VAL;
}

struct Need
{
    bool inSight = false;
    double due = 0.0; ///< how many times its tolerance a tile's error covers, at the vertex where most
};

Need needOf(const Tile& tile, const DeformationChain& chain, const Wishes& wishes, const osg::Matrixd& view,
            const osg::Matrixd& projection, const osg::Vec3d& up)
{
    Need need;
    const auto& vertices = dynamic_cast<const osg::Vec3Array&>(*tile.mesh->getVertexArray());
    const osg::Matrixd toEye = tile.toWorld * view;
    // Some hundreds of vertices tell enough: what is true of one of them is true of the tile.
    const std::size_t stride = 1 + vertices.size() / 300;
    for (std::size_t i = 0; i < vertices.size(); i += stride)
    {
        const osg::Vec3d eye = osg::Vec3d(vertices[i]) * toEye;
        const osg::Vec3d place = chain.deform(eye);
        const osg::Vec4d clip = osg::Vec4d(place, 1.0) * projection;
        if (place.z() < 0.0 && std::abs(clip.x()) < clip.w() && std::abs(clip.y()) < clip.w())
            need.inSight = true;
        const double pixels = tile.error / place.length();
        const double least = pixels * wishes.at(chain.style(eye));
        if (least * 8.0 < need.due) continue;
        need.due = std::max(need.due, least * std::max(1.0, stretchAt(chain, eye, up)));
    }
    return need;
}

} // namespace

TEST_P(DeservedTiles, NoTileIsMissingAndNoneIsCoarserThanItsErrorAllows)
{
    std::optional<Scene> oahu = loadOahu(GetParam());
    if (!oahu) return;
    CullHarness harness(context(), oahu->node, WIDTH, HEIGHT);
    const int cameras = fullTest() ? 200 : 24;
    int inSight = 0;
    int due = 0;
    int asking = 0;
    int idle = 0;
    for (int camera = 0; camera < cameras; ++camera)
    {
        SCOPED_TRACE("camera " + std::to_string(camera));
        Random random(static_cast<std::uint64_t>(camera) + 13000);
        if (camera % 4 == 0)
        {
            // The terrain again, with no tile loaded beyond the root.
            oahu = loadOahu(GetParam());
            if (!oahu) return;
            harness.setScene(oahu->node);
        }
        EffectScene& scene = *oahu->effects;
        const Wishes wishes = addEffects(scene, random);
        const osg::Matrixd view = randomOahuView(random, *oahu->reference);
        const osg::Matrixd projection = randomProjection(random);
        // What a camera asks for whose pixels are smaller or larger than the database's.
        const double scale = random.integer(0, 1) ? 1.0 : random.logarithmic(0.3, 3.0);
        harness.camera().setLODScale(static_cast<float>(scale));
        harness.setCamera(view, projection);
        for (int step = random.integer(1, 3); step > 0; --step)
            CullHarness::load(harness.frame(true, false).requests, random, 0.6);
        const Culled culled = harness.frame(true, false);
        std::set<const osg::Transform*> drawn;
        for (const osg::Drawable* drawable : culled.drawables())
            if (const osg::Geometry* mesh = drawable->asGeometry()) drawn.insert(TileInfo::tileOf(*mesh));
        const std::set<const osg::PagedLOD*> requesting = culled.requesting();
        const osg::ref_ptr<const DeformationChain> chain = scene.deformation(view, projection);
        const osg::Vec3d up = ViewGeometry(view, projection, scene.ground()).up;
        Tiles tiles;
        oahu->node->accept(tiles);
        for (const Tile& tile : tiles.found)
        {
            const Need need = needOf(tile, *chain, wishes, view, projection, up);
            if (!need.inSight) continue;
            // The ground below each of the finest tiles in memory is drawn by it or by one of those above it.
            if (!tile.finerHere)
            {
                ++inSight;
                const bool covered =
                    drawn.count(tile.node) ||
                    std::any_of(tile.above.begin(), tile.above.end(),
                                [&](const osg::Transform* each) { return drawn.count(each) > 0; });
                EXPECT_TRUE(covered) << "nothing is drawn in the place of a tile in sight";
            }
            if (!tile.group || !drawn.count(tile.node)) continue;
            // Drawn though finer ones are due: only while they are on their way.
            const bool asks = requesting.count(tile.group) > 0;
            if (need.due > 1.001 * allowed(tile, scale))
            {
                ++due;
                EXPECT_TRUE(asks) << "a tile is drawn whose error covers " << need.due / scale
                                  << " times its tolerance";
            }
            // A bend asks for smaller triangles, too, where the ground needs none.
            if (!wishes.stretchAlone) continue;
            asking += asks ? 1 : 0;
            idle += asks && need.due < 0.1 * scale ? 1 : 0;
        }
        if (HasFailure()) return;
    }
    std::cout << inSight << " tiles in sight, " << due << " due to be refined, " << asking << " asking, "
              << idle << " of them for a tenth of what the tolerance allows\n";
    EXPECT_GT(inSight, 5 * cameras);
    EXPECT_GT(due, cameras);
    EXPECT_GT(asking, 3);
    // Bounds are wider than what is in them; most that ask have a reason.
    EXPECT_LT(idle, asking / 2);
}

INSTANTIATE_TEST_SUITE_P(Oahu, DeservedTiles,
                         ::testing::ValuesIn(sampledCases<const char*>({"oahu", "oahu_projected"}, 2)),
                         [](const auto& each) { return std::string(each.param); });
