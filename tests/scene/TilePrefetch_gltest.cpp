// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is asked for ahead, on flights without a pager's threads: compared with what the tiles themselves say of where the
// camera will be, and with what it asks for when it is there.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/SampledCases.h>

#include <osg/AnimationPath>
#include <osg/PagedLOD>
#include <osg/View>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/TilePrefetch.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 320, HEIGHT = 240;
constexpr double RATE = 30.0, LEAD = 4.0;
/// The test's database has few tiles, for large pictures: a fast flight, and a coarse picture, meet many of them.
constexpr double SPEED = 2500.0, LOD_SCALE = 3.0;

using Requests = std::vector<RequestRecorder::Request>;
using Groups = std::set<const osg::PagedLOD*>;

Groups groupsOf(const Requests& requests)
{
    Groups groups;
    for (const auto& each : requests)
        groups.insert(each.group);
    return groups;
}

/// Over Oahu, along a parallel, at a height above the sea that is at least 500 m above this ground.
class Flight
{
public:
    explicit Flight(const Georeference& reference) : _reference(reference) {}

    osg::Matrixd at(double time) const
    {
        ViewPoint point;
        const double metresPerRadian = 6371000.0 * std::cos(osg::DegreesToRadians(21.45));
        point.longitude = osg::DegreesToRadians(-158.2) + SPEED * time / metresPerRadian;
        point.latitude = osg::DegreesToRadians(21.45);
        point.height = 1200.0;
        point.heading = osg::DegreesToRadians(90.0);
        point.pitch = osg::DegreesToRadians(-10.0);
        osg::Matrixd view;
        EXPECT_TRUE(point.viewMatrix(_reference, view));
        return view;
    }

private:
    const Georeference& _reference;
};

class TilePrefetching : public GlFixture, public ::testing::WithParamInterface<const char*>
{
protected:
    TilePrefetching() : GlFixture(WIDTH, HEIGHT) {}

    /// False after a failure.
    bool open(const std::string& name)
    {
        oahu = loadOahu(name);
        if (!oahu) return false;
        flight.emplace(*oahu->reference);
        harness = std::make_unique<CullHarness>(context(), oahu->node, WIDTH, HEIGHT);
        harness->camera().setLODScale(static_cast<float>(LOD_SCALE));
        prefetch = new TilePrefetch;
        prefetch->setLead(LEAD);
        oahu->effects->setPrefetch(prefetch);
        return true;
    }

    /// Culls a frame at a time of the simulation; what it asks for.
    Requests cull(double time, const osg::Matrixd& view)
    {
        harness->setCamera(view, projection);
        harness->stamp().setSimulationTime(time);
        harness->stamp().setReferenceTime(1000.0 + time);
        Requests requests = harness->frame(true, false).requests;
        harness->forgetRequests();
        return requests;
    }
    Requests cull(double time) { return cull(time, flight->at(time)); }
    /// Updates the next frame, and culls nothing; what is asked for ahead.
    Requests ahead(double time)
    {
        harness->stamp().setFrameNumber(harness->stamp().getFrameNumber() + 1);
        harness->stamp().setSimulationTime(time);
        harness->stamp().setReferenceTime(1000.0 + time);
        harness->forgetRequests();
        prefetch->update(harness->stamp());
        Requests requests = harness->requests();
        harness->forgetRequests();
        // setCamera() counts it.
        harness->stamp().setFrameNumber(harness->stamp().getFrameNumber() - 1);
        return requests;
    }
    /// Draws until nothing more is asked for at a time.
    void settle(double time)
    {
        Random random(0);
        while (CullHarness::load(cull(time), random, 1.0) > 0)
        {
        }
    }
    /// What the camera asks for at some place, with what is loaded now.
    Groups wantedAt(const osg::Matrixd& view)
    {
        oahu->effects->setPrefetch(nullptr);
        harness->setCamera(view, projection);
        const Groups wanted = harness->frame(true, false).requesting();
        harness->forgetRequests();
        oahu->effects->setPrefetch(prefetch);
        return wanted;
    }

    std::optional<Scene> oahu;
    std::optional<Flight> flight;
    std::unique_ptr<CullHarness> harness;
    osg::ref_ptr<TilePrefetch> prefetch;
    osg::Matrixd projection = osg::Matrixd::perspective(50.0, 4.0 / 3.0, 1.0, 1e6);
};

/// A paged child that is not there, and what its tile's metadata say.
struct Tile
{
    const osg::PagedLOD* group;
    osg::Vec3d center; ///< in the world
    double radius, range;
    std::vector<osg::Vec3d> corners; ///< of its box

    /// Places are foretold to a metre or so, hence `within`, a share of the range: of what is beyond it nobody can tell.
    bool isDueAt(const osg::Matrixd& view, double within = 1.0) const
    {
        return (center * view).length() * LOD_SCALE < within * range;
    }
    /// Whether a corner of the box is within the picture, and not at its very border.
    bool showsAt(const osg::Matrixd& view, const osg::Matrixd& projection) const
    {
        return std::any_of(corners.begin(), corners.end(),
                           [&](const osg::Vec3d& corner)
                           {
                               const osg::Vec4d clip = osg::Vec4d(corner * view, 1.0) * projection;
                               const double border = 0.99 * clip.w();
                               return clip.w() > 0.0 && std::abs(clip.x()) < border &&
                                      std::abs(clip.y()) < border;
                           });
    }
    /// Whether no plane through the eye and a side of the picture parts its sphere from the picture.
    bool maySeeAt(const osg::Matrixd& view, const osg::Matrixd& projection) const
    {
        const osg::Vec3d eye = center * view;
        for (const osg::Vec2d& side : {osg::Vec2d(projection(0, 0), 0.0), osg::Vec2d(-projection(0, 0), 0.0),
                                       osg::Vec2d(0.0, projection(1, 1)), osg::Vec2d(0.0, -projection(1, 1))})
        {
            osg::Vec3d inward(side.x(), side.y(), -1.0);
            inward.normalize();
            if (eye * inward < -1.001 * radius) return false;
        }
        return true;
    }
};

class MissingTiles : public osg::NodeVisitor
{
public:
    MissingTiles() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::PagedLOD& node) override
    {
        if (node.getNumChildren() == 1 && node.getNumFileNames() > 1)
        {
            const osg::Matrixd toWorld = osg::computeLocalToWorld(getNodePath());
            Tile tile = {&node,
                         osg::Vec3d(node.getCenter()) * toWorld,
                         static_cast<double>(node.getBound().radius()),
                         static_cast<double>(node.getMaxRange(1)),
                         {}};
            const osg::Node& child = *node.getChild(0);
            const std::optional<TileInfo> info = TileInfo::read(child);
            ASSERT_TRUE(info);
            osg::Matrixd placement;
            child.asTransform()->computeLocalToWorldMatrix(placement, nullptr);
            for (int i = 0; i < 8; ++i)
                tile.corners.push_back(osg::Vec3d(i & 1 ? info->boxMax.x() : info->boxMin.x(),
                                                  i & 2 ? info->boxMax.y() : info->boxMin.y(),
                                                  i & 4 ? info->boxMax.z() : info->boxMin.z()) *
                                       placement * toWorld);
            found.push_back(tile);
        }
        traverse(node);
    }

    std::vector<Tile> found;
};

} // namespace

TEST_P(TilePrefetching, WhatIsAskedForAheadIsThatOfTheFuturePlace)
{
    if (!open(GetParam())) return;
    settle(0.0);
    int due = 0, asked = 0;
    Random random(7);
    for (int frame = 0; frame < 180; ++frame)
    {
        const double time = frame / RATE;
        const Requests present = cull(time);
        const Requests requests = ahead(time + 1.0 / RATE);
        const Groups here = groupsOf(present), there = groupsOf(requests);
        // Three frames tell how it moves.
        EXPECT_TRUE(frame >= 3 || requests.empty());
        if (frame < 4) continue;
        MissingTiles tiles;
        oahu->node->accept(tiles);
        std::map<const osg::PagedLOD*, const Tile*> known;
        for (const Tile& tile : tiles.found)
        {
            known[tile.group] = &tile;
            bool isDue = false;
            for (int step = 1; step <= 4; ++step)
            {
                const osg::Matrixd view = flight->at(time + step * LEAD / 4.0);
                isDue = isDue || (tile.isDueAt(view, 0.999) && tile.showsAt(view, projection));
            }
            if (!isDue) continue;
            ++due;
            // The camera asks for what it lacks now.
            const osg::Matrixd now = flight->at(time);
            const bool isPresent = tile.isDueAt(now, 1.001) && tile.maySeeAt(now, projection);
            EXPECT_TRUE(isPresent || there.count(tile.group)) << frame << ": a tile is not asked for";
        }
        for (const auto& request : requests)
        {
            ++asked;
            EXPECT_FALSE(here.count(request.group)) << "what the camera lacks now is asked for once more";
            ASSERT_TRUE(known.count(request.group));
            const Tile& tile = *known[request.group];
            bool hasReason = false;
            for (int step = 1; step <= 4; ++step)
            {
                // What was asked for goes on for half a second, so the places of those frames count, too.
                for (double ago = 0.0; ago <= 0.6; ago += 1.0 / RATE)
                {
                    const osg::Matrixd view = flight->at(time - ago + step * LEAD / 4.0);
                    hasReason = hasReason || ((tile.center * view).length() * LOD_SCALE < 1.02 * tile.range &&
                                              tile.maySeeAt(view, projection));
                }
            }
            EXPECT_TRUE(hasReason) << frame << ": a tile is asked for that will not be seen";
        }
        // They come one by one.
        CullHarness::load(present, random, 1.0);
        CullHarness::load(requests, random, 0.1);
        if (HasFailure()) return;
    }
    EXPECT_GT(due, 20);
    EXPECT_GT(asked, 20);
}

TEST_P(TilePrefetching, WhatWillBeDrawnHasComeBefore)
{
    // A hundred milliseconds pass until a file comes, and eight are on their way at once. Without a look ahead the
    // camera lacks something in many frames; with it in none.
    int lacking[2] = {0, 0};
    std::uint64_t asked = 0;
    constexpr int frames = 240, latency = 3, atOnce = 8;
    for (const bool looks : {false, true})
    {
        if (!open(GetParam())) return;
        if (!looks) oahu->effects->setPrefetch(nullptr);
        settle(0.0);
        struct Way
        {
            Requests request;
            int arrival;
        };
        std::vector<Way> ways;
        Groups underway;
        std::map<std::string, int> fetched;
        Random random(3);
        for (int frame = 0; frame < frames; ++frame)
        {
            const double time = frame / RATE;
            Requests requests = looks ? ahead(time) : Requests();
            const Requests present = cull(time);
            requests.insert(requests.end(), present.begin(), present.end());
            lacking[looks] += present.empty() ? 0 : 1;
            // As the pager does it: the youngest first, then by priority.
            std::stable_sort(requests.begin(), requests.end(),
                             [](const auto& a, const auto& b)
                             { return std::tie(b.time, b.priority) < std::tie(a.time, a.priority); });
            for (const auto& each : requests)
            {
                if (ways.size() >= atOnce) break;
                if (!underway.insert(each.group).second) continue;
                ways.push_back({{each}, frame + latency});
                ++fetched[each.file];
            }
            for (auto way = ways.begin(); way != ways.end();)
            {
                if (way->arrival > frame)
                {
                    ++way;
                    continue;
                }
                CullHarness::load(way->request, random, 1.0);
                underway.erase(way->request.front().group);
                way = ways.erase(way);
            }
        }
        if (looks) asked = prefetch->counts().asked;
        for (const auto& [file, count] : fetched)
            EXPECT_EQ(count, 1) << file;
    }
    std::cout << "frames that lack a tile: " << lacking[0] << " without, " << lacking[1] << " with; " << asked
              << " tiles asked for ahead\n";
    EXPECT_GT(lacking[0], frames / 20);
    EXPECT_EQ(lacking[1], 0);
    EXPECT_GT(asked, 10u);
}

TEST_P(TilePrefetching, ThePresentComesFirst)
{
    if (!open(GetParam())) return;
    // Nothing but the root is there, so there is much to ask for, now and ahead.
    double last = 0.0;
    Groups lacking; // in the frame before
    int both = 0, steps = 0;
    Random random(5);
    for (int frame = 0; frame < 60; ++frame)
    {
        const double time = frame / RATE;
        const Requests requests = ahead(time);
        // Those of the frame before still wait, with the time of that frame.
        for (const auto& each : requests)
        {
            EXPECT_LT(each.time, last);
            EXPECT_FALSE(lacking.count(each.group)) << "what the camera lacks now gets a lower priority";
            EXPECT_EQ(each.frame, harness->stamp().getFrameNumber()) << "the pager would take it for old";
        }
        const Requests present = cull(time);
        last = 1000.0 + time;
        lacking = groupsOf(present);
        both += !requests.empty() && !present.empty() ? 1 : 0;
        // What will be needed sooner has the greater priority.
        std::map<const osg::PagedLOD*, int> stepOf;
        for (const auto& each : requests)
        {
            const int step = static_cast<int>(std::ceil((-each.priority - 1.0f) / 3.0f));
            stepOf[each.group] = step;
        }
        MissingTiles tiles;
        oahu->node->accept(tiles);
        for (const Tile& tile : tiles.found)
        {
            const auto entry = stepOf.find(tile.group);
            if (entry == stepOf.end() || frame < 5) continue;
            for (int step = 1; step < entry->second; ++step)
            {
                const osg::Matrixd view = flight->at(time - 1.0 / RATE + step * LEAD / 4.0);
                EXPECT_FALSE(tile.isDueAt(view, 0.999) && tile.showsAt(view, projection))
                    << "needed in step " << step << ", asked for as if in step " << entry->second;
            }
            ++steps;
        }
        CullHarness::load(present, random, 0.3);
        CullHarness::load(requests, random, 0.1);
        if (HasFailure()) return;
    }
    EXPECT_GT(both, 3);
    EXPECT_GT(steps, 40);
}

TEST_P(TilePrefetching, ABendAsksForWhatItWillShow)
{
    if (!open(GetParam())) return;
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setFocusLine(0.2);
    bend->setHorizonLine(0.9);
    bend->setTransitionDetail(4.0);
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(2.0);
    oahu->effects->addEffect(high);
    oahu->effects->addEffect(bend);
    settle(0.0);
    int wanted = 0, undeformed = 0;
    Random random(9);
    for (int frame = 0; frame < 160; ++frame)
    {
        const double time = frame / RATE;
        const Requests present = cull(time);
        const Requests requests = ahead(time + 1.0 / RATE);
        const Groups here = groupsOf(present), there = groupsOf(requests);
        for (int step = 1; frame >= 4 && frame % 10 == 0 && step <= 4; ++step)
        {
            const osg::Matrixd view = flight->at(time + step * LEAD / 4.0);
            const Groups then = wantedAt(view);
            wanted += static_cast<int>(then.size());
            // Places are foretold to a metre: the last of them may be on the other side of a range.
            int missed = 0;
            for (const osg::PagedLOD* group : then)
                missed += here.count(group) || there.count(group) ? 0 : 1;
            EXPECT_LE(missed, 1) << frame;
            // Undeformed it would be something else.
            bend->setEnabled(false);
            high->setEnabled(false);
            for (const osg::PagedLOD* group : wantedAt(view))
                undeformed += then.count(group) ? 1 : 0;
            bend->setEnabled(true);
            high->setEnabled(true);
        }
        CullHarness::load(present, random, 1.0);
        CullHarness::load(requests, random, 0.1);
        if (HasFailure()) return;
    }
    EXPECT_GT(wanted, 15);
    EXPECT_LT(undeformed, wanted - 2);
}

TEST_P(TilePrefetching, ACameraThatStandsStillAsksForNothing)
{
    if (!open(GetParam())) return;
    Random random(1);
    for (int frame = 0; frame < 60; ++frame)
    {
        const double time = frame / RATE;
        CullHarness::load(cull(time, flight->at(0.0)), random, 0.5);
        EXPECT_TRUE(ahead(time).empty()) << frame;
    }
    EXPECT_EQ(prefetch->counts().asked, 0u);
}

TEST_P(TilePrefetching, AJumpLeavesTheFormerWay)
{
    if (!open(GetParam())) return;
    settle(0.0);
    for (int frame = 0; frame < 30; ++frame)
    {
        cull(frame / RATE);
        const Requests requests = ahead((frame + 1) / RATE);
        EXPECT_TRUE(frame <= 4 || !requests.empty()) << frame;
    }
    // Away, and standing there: what had been asked for goes on for half a second and no longer.
    const osg::Matrixd away = flight->at(200.0);
    for (int frame = 30; frame < 70; ++frame)
    {
        Random random(2);
        CullHarness::load(cull(frame / RATE, away), random, 1.0);
        const Requests requests = ahead((frame + 1) / RATE);
        EXPECT_EQ(requests.empty(), frame > 30 + 14) << frame;
    }
    EXPECT_EQ(prefetch->counts().waiting, 0u);
}

TEST_P(TilePrefetching, APathIsFollowedToItsEnd)
{
    if (!open(GetParam())) return;
    // The camera is still at the start; only the path tells where it goes.
    settle(0.0);
    const osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->setLoopMode(osg::AnimationPath::NO_LOOPING);
    constexpr double start = 10.0, length = 20.0;
    for (int i = 0; i <= 20; ++i)
    {
        const osg::Matrixd pose = osg::Matrixd::inverse(flight->at(i));
        path->insert(i, osg::AnimationPath::ControlPoint(pose.getTrans(), pose.getRotate()));
    }
    prefetch->setPath(TilePrefetch::along(*path, start));
    cull(start, flight->at(0.0));
    const Groups there = groupsOf(ahead(start + 0.01));
    EXPECT_FALSE(there.empty());
    int wanted = 0;
    for (int step = 1; step <= 4; ++step)
    {
        for (const osg::PagedLOD* group : wantedAt(flight->at(step * LEAD / 4.0)))
        {
            ++wanted;
            EXPECT_TRUE(there.count(group));
        }
    }
    EXPECT_GT(wanted, 3);
    // After its end, and once more without it.
    cull(start + length + 1.0, flight->at(0.0));
    EXPECT_TRUE(groupsOf(ahead(start + length + 1.0)).empty());
    cull(start, flight->at(0.0));
    EXPECT_FALSE(ahead(start).empty());
    osg::ref_ptr<osg::Camera> other = new osg::Camera;
    prefetch->setPath(nullptr);
    prefetch->setPath(TilePrefetch::along(*path, start), other);
    cull(start + 1.0, flight->at(0.0));
    EXPECT_TRUE(ahead(start + 1.0).empty()) << "the path is another camera's";
    // Of two paths that lead a camera, its own one counts.
    prefetch->setPath(TilePrefetch::along(*path, start), &harness->camera());
    prefetch->setPath([](double) -> std::optional<osg::Matrixd> { return std::nullopt; });
    cull(start + 1.0, flight->at(0.0));
    EXPECT_FALSE(ahead(start + 1.0).empty());
}

TEST_P(TilePrefetching, ChannelsLookAheadWithTheirViewsDeformation)
{
    if (!open(GetParam())) return;
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setHorizonLine(0.85);
    oahu->effects->addEffect(bend);
    settle(0.0);
    // The harness' camera draws what is beside another one's picture.
    const osg::Matrixd turn = osg::Matrixd::rotate(osg::DegreesToRadians(55.0), osg::Vec3d(0.0, 1.0, 0.0));
    const osg::ref_ptr<osg::Camera> center = new osg::Camera;
    center->setProjectionMatrix(projection);
    CameraEffects::of(harness->camera()).setRole(CameraRole::like(*center));
    int wanted = 0;
    for (int frame = 0; frame < 60; ++frame)
    {
        const double time = frame / RATE;
        center->setViewMatrix(flight->at(time));
        cull(time, flight->at(time) * turn);
        const Groups there = groupsOf(ahead(time + 1.0 / RATE));
        if (frame != 10 && frame != 50) continue;
        for (int step = 1; step <= 4; ++step)
        {
            const osg::Matrixd then = flight->at(time + step * LEAD / 4.0);
            center->setViewMatrix(then);
            int missed = 0;
            const Groups now = [&]
            {
                center->setViewMatrix(flight->at(time));
                return wantedAt(flight->at(time) * turn);
            }();
            center->setViewMatrix(then);
            for (const osg::PagedLOD* group : wantedAt(then * turn))
            {
                ++wanted;
                missed += there.count(group) || now.count(group) ? 0 : 1;
            }
            EXPECT_LE(missed, 1);
        }
    }
    EXPECT_GT(wanted, 20);
}

TEST_P(TilePrefetching, APathLeadsAChannelWithItsView)
{
    if (!open(GetParam())) return;
    settle(0.0);
    // No effect is active, so the slave has its own matrices alone.
    const osg::ref_ptr<osg::View> view = new osg::View;
    // Slaves take their view's.
    view->getCamera()->setLODScale(static_cast<float>(LOD_SCALE));
    harness->camera().setReferenceFrame(osg::Transform::RELATIVE_RF);
    view->addSlave(&harness->camera(), false);
    const osg::Matrixd turn = osg::Matrixd::rotate(osg::DegreesToRadians(-40.0), osg::Vec3d(0.0, 1.0, 0.0));
    constexpr double lead = 16.0;
    prefetch->setLead(lead);
    view->getCamera()->setViewMatrix(flight->at(0.0));
    prefetch->setPath([&](double time) { return flight->at(time); });
    cull(0.0, flight->at(0.0) * turn);
    const Groups there = groupsOf(ahead(0.01));
    int wanted = 0;
    for (int step = 1; step <= 4; ++step)
    {
        for (const osg::PagedLOD* group : wantedAt(flight->at(step * lead / 4.0) * turn))
        {
            ++wanted;
            EXPECT_TRUE(there.count(group)) << "step " << step;
        }
    }
    EXPECT_GT(wanted, 3);
}

TEST_P(TilePrefetching, APathDoesNotLeadSlavesWithMatricesOfTheirOwn)
{
    if (!open(GetParam())) return;
    settle(0.0);
    const osg::ref_ptr<osg::View> view = new osg::View;
    // Slaves take their view's.
    view->getCamera()->setLODScale(static_cast<float>(LOD_SCALE));
    harness->camera().setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    view->addSlave(&harness->camera(), false);
    view->getCamera()->setViewMatrix(flight->at(50.0));
    prefetch->setPath([&](double time) { return flight->at(time); });
    // It stands where it has always stood.
    for (int frame = 0; frame < 10; ++frame)
    {
        cull(frame / RATE, flight->at(0.0));
        EXPECT_TRUE(ahead((frame + 1) / RATE).empty()) << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Oahu, TilePrefetching,
                         ::testing::ValuesIn(sampledCases<const char*>({"oahu", "oahu_projected"}, 2)),
                         [](const auto& each) { return std::string(each.param); });
