// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the guard keeps and what it forgets; files that are away for a moment, and files that are damaged; loaders that page under one name; listeners that throw; bounds.
#include <osgGeoFX/paging/TileGuard.h>
#include <tools/NotifyWatch.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <osg/PagedLOD>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using ReadResult = osgDB::ReaderWriter::ReadResult;

/// Answers instead of the file system.
struct Answer : public osgDB::ReadFileCallback
{
    explicit Answer(std::function<ReadResult()> function) : answer(std::move(function)) {}
    ReadResult readNode(const std::string&, const osgDB::Options*) override
    {
        ++asked;
        return answer();
    }
    std::function<ReadResult()> answer;
    std::atomic<int> asked{0};
};

osg::ref_ptr<osg::PagedLOD> pagedLod(osgDB::Options* options)
{
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setDatabaseOptions(options);
    return lod;
}

/// Reads as a pager does.
osg::ref_ptr<osg::Node> read(const osg::PagedLOD& lod, const std::string& file)
{
    const auto* options = static_cast<const osgDB::Options*>(lod.getDatabaseOptions());
    return osgDB::Registry::instance()->readNode(file, options, false).getNode();
}

TEST(TileGuardMemory, OptionsLiveAsLongAsTheirNodes)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(pagedLod(new osgDB::Options("first")));
    const osg::ref_ptr<TileGuard> guard = TileGuard::install(root);
    std::vector<osg::observer_ptr<osgDB::Options>> originals, guarded;
    for (int i = 0; i < 300; ++i)
    {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("tile " + std::to_string(i));
        const osg::ref_ptr<osg::PagedLOD> lod = pagedLod(options);
        root->addChild(lod);
        EXPECT_EQ(TileGuard::install(root), guard);
        auto* own = static_cast<osgDB::Options*>(lod->getDatabaseOptions());
        EXPECT_EQ(own->getOptionString(), "tile " + std::to_string(i));
        originals.emplace_back(options.get());
        guarded.emplace_back(own);
        root->removeChild(lod);
    }
    for (std::size_t i = 0; i < originals.size(); ++i)
    {
        EXPECT_FALSE(originals[i].valid()) << i;
        EXPECT_FALSE(guarded[i].valid()) << i;
    }
}

TEST(TileGuardMemory, NodesWithTheSameOptionsKeepTheSameOnes)
{
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("shared");
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int i = 0; i < 3; ++i)
        root->addChild(pagedLod(options));
    TileGuard::install(root);
    const auto of = [&](unsigned int i)
    {
        return static_cast<osg::PagedLOD*>(root->getChild(i))->getDatabaseOptions();
    };
    EXPECT_NE(of(0), options);
    EXPECT_EQ(of(0), of(1));
    EXPECT_EQ(of(0), of(2));
}

TEST(TileGuardNames, OneNameForManyTiles)
{
    NotifyWatch watch;
    const osg::ref_ptr<Answer> bad = new Answer([] { return ReadResult("the tile is broken"); });
    const osg::ref_ptr<Answer> good = new Answer([] { return ReadResult(new osg::Group); });
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (const auto& answer : {bad, good, bad})
    {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
        options->setReadFileCallback(answer);
        root->addChild(pagedLod(options));
    }
    const osg::ref_ptr<TileGuard> guard = TileGuard::install(root);
    const auto readChild = [&](unsigned int i)
    {
        return read(*static_cast<osg::PagedLOD*>(root->getChild(i)), "dummy");
    };
    const auto warnings = watch.messagesOf(
        [&]
        {
            for (int turn = 0; turn < 2; ++turn)
                for (unsigned int i = 0; i < 3; ++i)
                    EXPECT_TRUE(readChild(i).valid());
        });
    EXPECT_EQ(good->asked, 2) << "the failure of one tile is that of another";
    EXPECT_EQ(bad->asked, 2) << "each of the two once, and not again";
    EXPECT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    EXPECT_EQ(guard->counts().tilesRead, 2u);
    EXPECT_EQ(guard->counts().tilesFailed, 2u);
    EXPECT_EQ(guard->failedFiles(), std::set<std::string>{"dummy"});
}

/// Makes nodes of names alone.
struct Pseudo : public osgDB::ReaderWriter
{
    Pseudo() { supportsExtension("geofxpseudo", "for this test"); }
    ReadResult readNode(const std::string& file, const Options*) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        return new osg::Group;
    }
};

TEST(TileGuardNames, ANameWithoutAFileIsThePluginsMatter)
{
    const osg::ref_ptr<Pseudo> plugin = new Pseudo;
    osgDB::Registry::instance()->addReaderWriter(plugin);
    const osg::ref_ptr<osg::PagedLOD> lod = pagedLod(new osgDB::Options);
    const osg::ref_ptr<TileGuard> guard = TileGuard::install(lod);
    EXPECT_TRUE(read(*lod, "3/4/5.geofxpseudo").valid());
    EXPECT_EQ(guard->counts().tilesRead, 1u);
    EXPECT_EQ(guard->counts().tilesFailed, 0u);
    osgDB::Registry::instance()->removeReaderWriter(plugin);
}

/// Reads files that have one of these extensions as it is told to, and counts.
struct Reader : public osgDB::ReaderWriter
{
    explicit Reader(std::function<ReadResult(int)> function) : answer(std::move(function))
    {
        supportsExtension("geofxtold", "for this test");
        osgDB::Registry::instance()->addReaderWriter(this);
    }
    void remove() { osgDB::Registry::instance()->removeReaderWriter(this); }
    ReadResult readNode(const std::string& file, const Options*) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        return answer(++reads);
    }
    std::function<ReadResult(int)> answer;
    mutable std::atomic<int> reads{0};
};

using Seconds = std::chrono::duration<double>;

/// The guard of a PagedLOD, and what a pager gets that asks for a file again and again.
class TileGuardRetry : public ::testing::Test
{
protected:
    /// Asks for some time, and ends as soon as there is a tile, which has children here. Returns whether there is one.
    bool comesWithin(double seconds, const std::string& file)
    {
        const auto end = std::chrono::steady_clock::now() + Seconds(seconds);
        do
        {
            const osg::ref_ptr<osg::Node> node = read(*lod, file);
            if (node && node->asGroup()->getNumChildren() > 0) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        } while (std::chrono::steady_clock::now() < end);
        return false;
    }
    static ReadResult tile()
    {
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        group->addChild(new osg::Group);
        return ReadResult(group.get());
    }

    NotifyWatch watch;
    TempDir folder;
    const osg::ref_ptr<osg::PagedLOD> lod = pagedLod(new osgDB::Options);
    const osg::ref_ptr<TileGuard> guard = TileGuard::install(lod);
};

/// As OSG does, which asks for a file in each frame.
TEST_F(TileGuardRetry, AFolderThatIsAwayForAMomentComesBackInTwoSeconds)
{
    namespace fs = std::filesystem;
    PagedScene::write(folder.path(), PagedScene::Kind::Flat);
    const fs::path tiles = folder / "tiles", away = folder / "away";
    const std::vector<std::string> files = {"0_0_0.osgb", "1_0_0.osgb", "1_1_0.osgb", "1_0_1.osgb",
                                            "1_1_1.osgb"};
    for (int turn = 0; turn < 2; ++turn)
    {
        fs::rename(tiles, away);
        const auto start = std::chrono::steady_clock::now();
        const auto warnings = watch.messagesOf(
            [&]
            {
                while (std::chrono::steady_clock::now() < start + Seconds(0.8))
                    for (const std::string& file : files)
                        EXPECT_FALSE(comesWithin(0.0, (tiles / file).string()));
            });
        ASSERT_EQ(warnings.size(), 1u) << "one cause, one warning: " << ::testing::PrintToString(warnings);
        EXPECT_NE(warnings[0].find("\"" + tiles.string() + "\""), std::string::npos) << warnings[0];
        EXPECT_NE(warnings[0].find("tried again"), std::string::npos) << warnings[0];
        EXPECT_EQ(guard->failedFiles().size(), files.size());
        fs::rename(away, tiles);
        for (const std::string& file : files)
            EXPECT_TRUE(comesWithin(2.0 - Seconds(std::chrono::steady_clock::now() - start).count(),
                                    (tiles / file).string()))
                << file;
        EXPECT_TRUE(guard->failedFiles().empty());
    }
    EXPECT_EQ(guard->counts().tilesRead, 10u);
    EXPECT_EQ(guard->counts().tilesFailed, 10u);
}

/// It costs a look for each second that it is missing, and not one for each frame.
TEST_F(TileGuardRetry, AFileThatStaysAwayIsLookedForLessAndLess)
{
    const osg::ref_ptr<Answer> none = new Answer([] { return ReadResult(ReadResult::FILE_NOT_FOUND); });
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setReadFileCallback(none);
    lod->setDatabaseOptions(options);
    TileGuard::install(lod)->setRetryDelay(0.8);
    const auto warnings = watch.messagesOf([&] { EXPECT_FALSE(comesWithin(2.5, "none.osgb")); });
    EXPECT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    // At 0, 0.5, 1.3 and 2.1 s.
    EXPECT_GE(none->asked, 3);
    EXPECT_LE(none->asked, 4);
}

TEST_F(TileGuardRetry, ADamagedFileIsLeftAloneUntilItChanges)
{
    const std::string file = folder.write("a.geofxtold", "damaged").string();
    bool whole = false;
    const osg::ref_ptr<Reader> reader =
        new Reader([&](int) { return whole ? tile() : ReadResult("bad sum"); });
    guard->setRetryDelay(0.1);
    const auto warnings = watch.messagesOf([&] { EXPECT_FALSE(comesWithin(1.0, file)); });
    EXPECT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    EXPECT_EQ(reader->reads, 2) << "the second time tells that it is not the disk";
    whole = true;
    EXPECT_FALSE(comesWithin(0.3, file)) << "it is the same file";
    // As long as before.
    folder.write("a.geofxtold", "mended.");
    EXPECT_TRUE(comesWithin(1.0, file));
    EXPECT_EQ(reader->reads, 3);
    EXPECT_TRUE(guard->failedFiles().empty());
    reader->remove();
}

/// The file is whole again when the guard looks, and has not changed.
TEST_F(TileGuardRetry, AReadThatFailsOnceIsTheDisksFault)
{
    const std::string file = folder.write("a.geofxtold", "whole").string();
    const osg::ref_ptr<Reader> reader =
        new Reader([](int time) { return time == 1 ? ReadResult("cannot read") : tile(); });
    const auto warnings = watch.messagesOf([&] { EXPECT_TRUE(comesWithin(2.0, file)); });
    EXPECT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    EXPECT_EQ(reader->reads, 2);
    reader->remove();
}

struct Thrower : public TileListener
{
    explicit Thrower(bool exception) : std(exception) {}
    void tileRead(osg::Node&) override
    {
        ++told;
        if (std) throw std::runtime_error("no memory for strokes");
        throw 5;
    }
    const bool std;
    std::atomic<int> told{0};
};

TEST(TileGuardListeners, OneThatThrowsTakesNoTileAway)
{
    NotifyWatch watch;
    const TempDir folder;
    const osg::ref_ptr<osg::Node> root =
        osgDB::readRefNodeFile(PagedScene::write(folder.path(), PagedScene::Kind::Flat).string());
    const osg::ref_ptr<TileGuard> guard = TileGuard::install(root);
    const auto* lod = dynamic_cast<osg::PagedLOD*>(root->asGroup()->getChild(0));
    ASSERT_NE(lod, nullptr);
    const osg::ref_ptr<Thrower> standard = new Thrower(true), other = new Thrower(false);
    guard->addListener(standard);
    guard->addListener(other);
    osg::ref_ptr<osg::Node> tile;
    const auto warnings = watch.messagesOf(
        [&] { EXPECT_NO_THROW(tile = read(*lod, lod->getDatabasePath() + "tiles/0_0_0.osgb")); });
    ASSERT_TRUE(tile.valid());
    EXPECT_EQ(tile->asGroup()->getNumChildren(), 4u);
    EXPECT_EQ(standard->told, 1);
    EXPECT_EQ(other->told, 1) << "one listener's fault is not another's";
    ASSERT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    EXPECT_NE(warnings[0].find("no memory for strokes"), std::string::npos) << warnings[0];
    EXPECT_EQ(guard->counts().tilesFailed, 0u);
}

/// Counts how often its bounding sphere is computed.
struct Counting : public osg::Group
{
    osg::BoundingSphere computeBound() const override
    {
        ++computed;
        return {osg::Vec3(1.0f, 2.0f, 3.0f), 4.0f};
    }
    mutable std::atomic<int> computed{0};
};

/// Cull threads must not do it: two at once would be a race. A node with bounds of its own does not ask those below.
TEST(TileGuardBounds, AreComputedByTheThreadThatReads)
{
    const osg::ref_ptr<Counting> below = new Counting, beside = new Counting;
    const osg::ref_ptr<Answer> answer = new Answer(
        [&]
        {
            const osg::ref_ptr<osg::PagedLOD> tile = new osg::PagedLOD;
            tile->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
            tile->setCenter(osg::Vec3());
            tile->setRadius(100.0f);
            tile->addChild(below, 0.0f, 1e9f);
            const osg::ref_ptr<osg::Group> group = new osg::Group;
            group->addChild(tile);
            group->addChild(beside);
            return ReadResult(group.get());
        });
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setReadFileCallback(answer);
    const osg::ref_ptr<osg::PagedLOD> lod = pagedLod(options);
    TileGuard::install(lod);
    const osg::ref_ptr<osg::Node> tile = read(*lod, "dummy");
    ASSERT_TRUE(tile.valid());
    EXPECT_EQ(below->computed, 1);
    EXPECT_EQ(beside->computed, 1);
    EXPECT_EQ(below->getBound().radius(), 4.0f);
    EXPECT_EQ(tile->getBound().valid(), true);
    EXPECT_EQ(below->computed, 1) << "it is computed again, by whoever asks first";
}

} // namespace
