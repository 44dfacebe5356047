// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Who is told of the tiles that a pager brings, and when.
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/panorama/detail/StrokeMaker.h>
#include <tools/NotifyWatch.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <osg/PagedLOD>
#include <osgDB/ReadFile>

#include <atomic>
#include <thread>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

struct Counter : public TileListener
{
    void tileRead(osg::Node& tile) override
    {
        ++count;
        // Not yet below anything.
        if (tile.getNumParents() == 0) ++alone;
        last = &tile;
    }
    std::atomic<int> count{0};
    std::atomic<int> alone{0};
    std::atomic<osg::Node*> last{nullptr};
};

/// A paged terrain and its reading, as a pager does it.
class TileListening : public ::testing::Test
{
protected:
    TileListening()
    {
        const std::filesystem::path file = PagedScene::write(folder.path(), PagedScene::Kind::Flat);
        root = osgDB::readRefNodeFile(file.string());
        guard = TileGuard::install(root);
        lod = dynamic_cast<osg::PagedLOD*>(root->asGroup()->getChild(0));
    }

    osg::ref_ptr<osg::Node> read(const std::string& name) const
    {
        auto* options = static_cast<osgDB::Options*>(lod->getDatabaseOptions());
        return options->getReadFileCallback()->readNode(lod->getDatabasePath() + name, options).getNode();
    }

    TempDir folder;
    osg::ref_ptr<osg::Node> root;
    osg::ref_ptr<TileGuard> guard;
    osg::PagedLOD* lod = nullptr;
};

TEST_F(TileListening, ListenersAreToldOfTilesOnce)
{
    const osg::ref_ptr<Counter> counter = new Counter, other = new Counter;
    guard->addListener(counter);
    guard->addListener(counter);
    guard->addListener(other);
    guard->addListener(nullptr);
    const osg::ref_ptr<osg::Node> tile = read("tiles/0_0_0.osgb");
    ASSERT_TRUE(tile.valid());
    EXPECT_EQ(counter->count, 1);
    EXPECT_EQ(counter->alone, 1);
    EXPECT_EQ(counter->last, tile.get());
    EXPECT_EQ(other->count, 1);
    guard->removeListener(counter);
    read("tiles/1_0_0.osgb");
    EXPECT_EQ(counter->count, 1);
    EXPECT_EQ(other->count, 2);
}

TEST_F(TileListening, FailedTilesAreNotToldOf)
{
    NotifyWatch watch;
    const osg::ref_ptr<Counter> counter = new Counter;
    guard->addListener(counter);
    EXPECT_EQ(watch.messagesOf([&] { read("tiles/none.osgb"); }).size(), 1u);
    EXPECT_EQ(counter->count, 0);
}

TEST_F(TileListening, ListenersAreHeldWeakly)
{
    osg::ref_ptr<Counter> counter = new Counter;
    guard->addListener(counter);
    EXPECT_EQ(counter->referenceCount(), 1);
    const osg::observer_ptr<Counter> observer = counter.get();
    counter = nullptr;
    EXPECT_FALSE(observer.valid());
    EXPECT_TRUE(read("tiles/0_0_0.osgb").valid());
}

TEST_F(TileListening, ListenersComeAndGoWhileTilesAreRead)
{
    std::atomic<bool> done{false};
    std::vector<std::thread> readers;
    for (int i = 0; i < 2; ++i)
    {
        readers.emplace_back(
            [&]
            {
                while (!done)
                    read("tiles/0_0_0.osgb");
            });
    }
    int told = 0;
    for (int turn = 0; turn < 200 || (told == 0 && turn < 20000); ++turn)
    {
        const osg::ref_ptr<Counter> counter = new Counter;
        guard->addListener(counter);
        std::this_thread::yield();
        told += counter->count;
        if (turn % 2) guard->removeListener(counter);
    }
    done = true;
    for (std::thread& reader : readers)
        reader.join();
    EXPECT_GT(told, 0);
}

TEST_F(TileListening, AStrokeMakerFurnishesWhatComes)
{
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    guard->addListener(maker);
    const osg::ref_ptr<osg::Node> tile = read("tiles/0_0_0.osgb");
    struct Find : public osg::NodeVisitor
    {
        Find() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Geometry& geometry) override
        {
            const osg::UserDataContainer* data = geometry.getUserDataContainer();
            furnished += data && dynamic_cast<const TileStrokes*>(data->getUserObject(0)) ? 1 : 0;
            ++geometries;
        }
        int geometries = 0;
        int furnished = 0;
    } find;
    tile->accept(find);
    EXPECT_EQ(find.geometries, 4);
    EXPECT_EQ(find.furnished, 4);
}

} // namespace
