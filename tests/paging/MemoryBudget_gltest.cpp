// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Flights over more than fits, with OSG's own pager. The test adds up itself what the tiles in memory take.
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/RandomSamples.h>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Texture2D>
#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/paging/MemoryBudget.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/scene/TilePrefetch.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int SIZE = 128;
constexpr double MIB = 1024.0 * 1024.0;

/// What OpenGL has of all nodes that are in the graph, in sight or not, but for the database's root.
class GraphBytes : public osg::NodeVisitor
{
public:
    GraphBytes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::PagedLOD& node) override
    {
        // The first child comes with the file that has the node.
        if (_depth > 0) traverse(node);
        if (_depth++ == 0)
            for (unsigned int i = 1; i < node.getNumChildren(); ++i)
                node.getChild(i)->accept(*this);
        --_depth;
    }
    void apply(osg::Geometry& mesh) override
    {
        const osg::Array* const arrays[] = {mesh.getVertexArray(), mesh.getNormalArray(),
                                            mesh.getColorArray(), mesh.getTexCoordArray(0)};
        for (const osg::Array* array : arrays)
            if (array && known.insert(array).second) bytes += array->getTotalDataSize();
        for (const auto& primitives : mesh.getPrimitiveSetList())
            if (known.insert(primitives.get()).second) bytes += primitives->getTotalDataSize();
        const osg::StateSet* state = mesh.getStateSet();
        for (unsigned int unit = 0; state && unit < 8; ++unit)
        {
            const auto* texture = dynamic_cast<const osg::Texture2D*>(
                state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE));
            const osg::Image* image = texture ? texture->getImage() : nullptr;
            if (!image || !known.insert(image).second) continue;
            // OpenGL has all levels, down to a single texel.
            const bool levels = texture->getFilter(osg::Texture::MIN_FILTER) != osg::Texture::LINEAR;
            const double texel = image->getPixelSizeInBits() / 8.0;
            for (int side = image->s(); side > 0; side = levels ? side / 2 : 0)
                bytes += texel * side * side;
        }
    }

    double bytes = 0.0;
    std::set<const void*> known;

private:
    int _depth = 0;
};

class Budgets : public GlFixture
{
protected:
    Budgets() : GlFixture(SIZE, SIZE) {}

    bool open()
    {
        oahu = loadOahu("oahu");
        if (!oahu) return false;
        // The pager's threads may give OpenGL's buffers of tiles that go to others in the midst of a frame.
        watch().ignore("to update a GL_STATIC_DRAW buffer");
        oahu->setUpView(viewer());
        viewer().getCamera()->setProjectionMatrixAsPerspective(50.0, 1.0, 1.0, 1e6);
        viewer().getCamera()->setLODScale(2.0f);
        viewer().setSceneData(oahu->node);
        budget = new MemoryBudget(*viewer().getDatabasePager());
        budget->watch(*oahu->node, *oahu->guard);
        return true;
    }
    void look(double longitude, double height = 1500.0, double pitch = -20.0)
    {
        ViewPoint point;
        point.longitude = osg::DegreesToRadians(longitude);
        point.latitude = osg::DegreesToRadians(21.42);
        point.height = height;
        point.heading = osg::DegreesToRadians(80.0);
        point.pitch = osg::DegreesToRadians(pitch);
        osg::Matrixd view;
        EXPECT_TRUE(point.viewMatrix(*oahu->reference, view));
        viewer().getCamera()->setViewMatrix(view);
    }
    void frame(double time = USE_REFERENCE_TIME) { viewer().frame(time); }
    void settle()
    {
        PagerMonitor monitor(viewer().getDatabasePager(), nullptr, 2);
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        for (frame(); !monitor.frameFinished(); frame())
        {
            monitor.waitForReads(10.0);
            ASSERT_LT(std::chrono::steady_clock::now(), end) << "tiles do not come";
        }
    }
    /// Lets what can go do so.
    void rest()
    {
        for (int i = 0; i < 12; ++i)
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            frame();
        }
    }
    double inGraph()
    {
        GraphBytes graph;
        oahu->node->accept(graph);
        return graph.bytes;
    }

    void expectALongFlightWithinTheLimit()
    {
        look(-158.25);
        settle();
        const double limit = 1.5 * inGraph();
        budget->setLimits(0.0, limit / MIB);
        double most = 0.0;
        const int steps = fullTest() ? 24 : 12;
        for (int i = 0; i < steps; ++i)
        {
            look(-158.25 + 0.55 * i / steps);
            settle();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            frame();
            most = std::max(most, inGraph());
        }
        rest();
        const MemoryBudget::Counts counts = budget->counts();
        std::cout << "limit " << limit / MIB << " MiB, at most " << most / MIB << " MiB; " << counts.removed
                  << " of " << oahu->guard->counts().tilesRead << " tiles went\n";
        EXPECT_LE(most, 1.05 * limit);
        EXPECT_GT(counts.removed, 5u);
        EXPECT_EQ(counts.removedAhead, 0u);
        EXPECT_NEAR(static_cast<double>(counts.gpuBytes) / inGraph(), 1.0, 0.02)
            << "what has gone is still in memory";
        EXPECT_GT(inGraph(), 0.5 * limit) << "more went than had to";
    }

    std::optional<Scene> oahu;
    osg::ref_ptr<MemoryBudget> budget;
};

} // namespace

TEST(MemoryBudgetSizes, AreThoseOfArraysAndImages)
{
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(1000);
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(64, 32, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    const osg::ref_ptr<osg::Group> tile = new osg::Group;
    for (int i = 0; i < 2; ++i)
    {
        const osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
        mesh->setVertexArray(vertices);
        mesh->addPrimitiveSet(new osg::DrawElementsUShort(GL_TRIANGLES, 300));
        mesh->getOrCreateStateSet()->setTextureAttribute(1, texture);
        tile->addChild(mesh);
    }
    // Shared vertices and images are there once, indices twice; a third more for mipmaps.
    constexpr std::uint64_t texels = 64 * 32 * 4, own = 1000 * 12 + 2 * 300 * 2;
    const MemoryBudget::Size size = MemoryBudget::sizeOf(*tile);
    EXPECT_EQ(size.gpuBytes, own + texels * 4 / 3);
    EXPECT_GE(size.processBytes, own + texels);
    EXPECT_LE(size.processBytes, own + texels + 10000);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    EXPECT_EQ(MemoryBudget::sizeOf(*tile).gpuBytes, own + texels);
}

TEST_F(Budgets, CountWhatIsInMemory)
{
    if (!open()) return;
    EXPECT_EQ(budget->counts().tiles, 0u);
    look(-158.2);
    settle();
    const MemoryBudget::Counts counts = budget->counts();
    EXPECT_EQ(counts.tiles, oahu->guard->counts().tilesRead);
    EXPECT_NEAR(static_cast<double>(counts.gpuBytes) / inGraph(), 1.0, 0.02);
    EXPECT_GT(counts.processBytes, counts.gpuBytes * 9 / 10);
    // Without a limit OSG's own one holds.
    EXPECT_EQ(counts.removed, 0u);
    EXPECT_LT(viewer().getDatabasePager()->getTargetMaximumNumberOfPageLOD(), 10000u);
    // It may be deleted before the tiles are.
    oahu->node->setUpdateCallback(nullptr);
    budget = nullptr;
}

TEST_F(Budgets, KeepALongFlightWithinTheLimit)
{
    if (!open()) return;
    expectALongFlightWithinTheLimit();
}

// Shadows look at the tiles all around the camera.
TEST_F(Budgets, KeepALongFlightWithShadowsWithinTheLimit)
{
    if (!open()) return;
    const double longitude = osg::DegreesToRadians(-158.0), latitude = osg::DegreesToRadians(21.42);
    const osg::ref_ptr<SunLight> sun = new SunLight;
    osg::Matrixd frame;
    ASSERT_TRUE(oahu->reference->localToWorld(longitude, latitude, 0.0, frame));
    sun->setPlace(longitude, latitude, frame);
    sun->setTime(*readClockTime("2026-06-21T16:00:00-10:00"));
    oahu->effects->addChild(sun);
    const osg::ref_ptr<SunShadows> shadows = new SunShadows;
    // Which tiles shadows look at does not go by texels.
    shadows->setMapSize(256);
    oahu->effects->addEffect(shadows);
    expectALongFlightWithinTheLimit();
    EXPECT_GT(shadows->statistics().drawn, 100u);
}

TEST_F(Budgets, WithoutALimitThePagerDecidesAgain)
{
    if (!open()) return;
    osgDB::DatabasePager& pager = *viewer().getDatabasePager();
    pager.setTargetMaximumNumberOfPageLOD(77);
    look(-158.2);
    settle();
    const auto longest = [&]
    {
        struct Longest : osg::NodeVisitor
        {
            Longest() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
            void apply(osg::PagedLOD& node) override
            {
                for (unsigned int i = 0; i < node.getNumChildren(); ++i)
                    time = std::max(time, node.getMinimumExpiryTime(i));
                traverse(node);
            }
            double time = 0.0;
        } visitor;
        oahu->node->accept(visitor);
        return visitor.time;
    };
    budget->setLimits(0.5, 0.0);
    const std::vector<std::string> heard = watch().messagesOf([&] { rest(); });
    EXPECT_LE(heard.size(), 1u);
    EXPECT_NE(pager.getTargetMaximumNumberOfPageLOD(), 77u);
    EXPECT_GT(longest(), 1e9);
    budget->setLimits(0.0, 0.0);
    frame();
    EXPECT_EQ(pager.getTargetMaximumNumberOfPageLOD(), 77u);
    EXPECT_EQ(longest(), 0.0);
    // A target that the application sets now is left alone.
    pager.setTargetMaximumNumberOfPageLOD(88);
    frame();
    EXPECT_EQ(pager.getTargetMaximumNumberOfPageLOD(), 88u);
    // The scene's end is that of the budget.
    budget->setLimits(1000.0, 0.0);
    frame();
    EXPECT_GT(pager.getTargetMaximumNumberOfPageLOD(), 100000u);
    budget = nullptr;
    oahu->node->setUpdateCallback(nullptr);
    EXPECT_EQ(pager.getTargetMaximumNumberOfPageLOD(), 88u);
    EXPECT_EQ(longest(), 0.0);
}

TEST_F(Budgets, TheLeastRecentlySeenGoFirst)
{
    if (!open()) return;
    // Without a limit that is reached nothing goes, however many nodes there are.
    budget->setLimits(10000.0, 10000.0);
    viewer().getCamera()->setLODScale(6.0f);
    const double places[] = {-158.2, -158.0, -157.8};
    double bytes[3];
    for (int i = 0; i < 3; ++i)
    {
        const double before = i ? inGraph() : 0.0;
        look(places[i], 900.0, -60.0);
        settle();
        rest();
        bytes[i] = inGraph() - before;
        ASSERT_GT(bytes[i], 0.02 * MIB);
    }
    EXPECT_EQ(budget->counts().removed, 0u);
    const std::uint64_t read = oahu->guard->counts().tilesRead;
    look(places[0], 900.0, -60.0);
    settle();
    look(places[2], 900.0, -60.0);
    settle();
    EXPECT_EQ(oahu->guard->counts().tilesRead, read);

    // Now something has to go: of the place in the middle, where it has not been for the longest time.
    const double all = inGraph();
    budget->setLimits(0.0, all / 0.88 / MIB);
    rest();
    EXPECT_EQ(budget->counts().removed, 0u) << "less than nine tenths are taken";
    // From nine tenths to eight: less than what that place has.
    const double limit = all / 0.92;
    ASSERT_GT(bytes[1], all - 0.8 * limit) << "of " << bytes[0] << ", " << bytes[1] << ", " << bytes[2];
    budget->setLimits(0.0, limit / MIB);
    rest();
    EXPECT_GT(budget->counts().removed, 0u);
    EXPECT_LT(inGraph(), all);
    look(places[0], 900.0, -60.0);
    settle();
    EXPECT_EQ(oahu->guard->counts().tilesRead, read) << "another place had to go";
    look(places[1], 900.0, -60.0);
    settle();
    EXPECT_GT(oahu->guard->counts().tilesRead, read);
}

TEST_F(Budgets, WhatIsInSightStaysAndIsToldOnce)
{
    if (!open()) return;
    budget->setLimits(0.5, 0.0);
    const std::vector<std::string> heard = watch().messagesOf(
        [&]
        {
            look(-158.2);
            settle();
            rest();
            rest();
            rest();
        });
    ASSERT_EQ(heard.size(), 1u) << ::testing::PrintToString(heard);
    EXPECT_NE(heard[0].find("The tiles in sight take"), std::string::npos) << heard[0];
    EXPECT_NE(heard[0].find("0.5 MiB"), std::string::npos) << heard[0];
    const std::uint64_t read = oahu->guard->counts().tilesRead;
    settle();
    rest();
    EXPECT_EQ(oahu->guard->counts().tilesRead, read) << "tiles go and come";
}

TEST_F(Budgets, ALookAheadKeepsToTheLimit)
{
    if (!open()) return;
    const osg::ref_ptr<TilePrefetch> prefetch = new TilePrefetch;
    prefetch->setLead(30.0);
    prefetch->setBudget(budget);
    oahu->effects->setPrefetch(prefetch);
    look(-158.25);
    settle();
    const double limit = 1.6 * inGraph();
    budget->setLimits(0.0, limit / MIB);
    // Half a degree in half a minute: some 1.7 km/s.
    double most = 0.0;
    bool shorter = false;
    std::uint64_t removedBefore = 0;
    auto last = std::chrono::steady_clock::now();
    constexpr double duration = 5.0;
    for (double time = 0.0; time < duration;)
    {
        // Where other programs have the processor, the flight is slower, not coarser.
        const auto now = std::chrono::steady_clock::now();
        time += std::min(0.05, std::chrono::duration<double>(now - last).count());
        last = now;
        look(-158.25 + 0.3 * time / duration);
        removedBefore = budget->counts().removedAhead;
        frame(time);
        most = std::max(most, inGraph());
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
        shorter = shorter || prefetch->counts().lead < 30.0;
    }
    const MemoryBudget::Counts counts = budget->counts();
    std::cout << "limit " << limit / MIB << " MiB, at most " << most / MIB << " MiB; "
              << prefetch->counts().asked << " asked ahead, " << counts.removedAhead << " of "
              << counts.removed << " that went were wanted ahead; read " << oahu->guard->counts().tilesRead
              << "\n";
    EXPECT_LE(most, 1.1 * limit);
    EXPECT_GT(prefetch->counts().asked, 5u);
    EXPECT_LT(counts.removedAhead, oahu->guard->counts().tilesRead / 4) << "tiles go and come";
    EXPECT_EQ(shorter, removedBefore > 0) << "it looks less far ahead after tiles had to go, and only then";
}
