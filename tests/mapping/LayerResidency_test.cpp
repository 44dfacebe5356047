// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Which layers have a place on the pages: what is used once for many, what has to go, and what comes back.
#include <osgGeoFX/mapping/detail/LayerResidency.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

using namespace osgGeoFX;
using geofx::test::Random;

namespace
{

using MappingRef = osg::ref_ptr<ProjectiveMapping>;
using LayerRef = osg::ref_ptr<DataLayer>;
using Place = std::tuple<int, int, int>; ///< page, x, y

Place placeOf(const LayerAtlas::Slot& slot)
{
    return {slot.page, slot.x, slot.y};
}

void resize(osg::Image& image, int side)
{
    image.allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::fill(image.data(), image.data() + image.getTotalSizeInBytes(), static_cast<unsigned char>(100));
    image.dirty();
}

LayerRef makeLayer(int side, double importance = 0.5)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    resize(*image, side);
    LayerRef layer = new DataLayer(image);
    layer->setImportance(importance);
    return layer;
}

} // namespace

/// A page with room for four layers of half its side.
class LayerResidencyTest : public ::testing::Test
{
protected:
    static constexpr int pageSide = 64;
    static constexpr int quarter = 32;

    void SetUp() override { _layers.reset(pageSide, 1); }

    /// A mapping of its own that shows the layer.
    MappingRef show(const LayerRef& layer)
    {
        MappingRef user = new ProjectiveMapping;
        use(user, {layer, nullptr});
        return user;
    }
    void use(const MappingRef& user, const LayerResidency::Pair& next)
    {
        LayerResidency::Pair& former = _used[user];
        _layers.use(*user, next, former);
        former = next;
    }
    void leave(const MappingRef& user) { use(user, {}); }

    /// As a commit does it: what it tells is forgotten then.
    MappingChanges update()
    {
        _layers.update();
        MappingChanges told;
        std::swap(told, _changes);
        for (const GpuStore::Layer& upload : told.uploads.layers)
        {
            if (upload.pixels)
                _onGpu[placeOf(upload.slot)] = upload.pixels->side;
            else
                EXPECT_EQ(_onGpu.erase(placeOf(upload.slot)), 1u) << "was not there";
        }
        return told;
    }
    bool isPlaced(const LayerRef& layer) const { return _layers.placed(layer).has_value(); }
    Place placeOfLayer(const LayerRef& layer) const { return placeOf(_layers.placed(layer)->slot); }

    MappingChanges _changes;
    LayerResidency _layers{_changes};
    std::map<MappingRef, LayerResidency::Pair> _used;
    std::map<Place, int> _onGpu; ///< sides, as the uploads say
};

TEST_F(LayerResidencyTest, HasAPlaceForWhatMappingsUseOnly)
{
    const LayerRef layer = makeLayer(quarter), empty = new DataLayer;
    EXPECT_FALSE(_layers.placed(nullptr));
    EXPECT_FALSE(isPlaced(layer));
    const MappingRef user = show(layer);
    show(empty);
    EXPECT_FALSE(isPlaced(layer)) << "before the commit";
    update();
    ASSERT_TRUE(isPlaced(layer));
    EXPECT_EQ(_layers.placed(layer)->slot.side, quarter);
    EXPECT_EQ(_layers.placed(layer)->width, quarter);
    EXPECT_EQ(_layers.placed(layer)->height, quarter);
    EXPECT_FALSE(isPlaced(empty));
    EXPECT_EQ(_layers.count(), 2u);
    EXPECT_EQ(_layers.leftOut(), 0) << "a layer without a picture needs no room";
    EXPECT_EQ(_layers.pagesUsed(), 1);
}

TEST_F(LayerResidencyTest, UsersShareALayer)
{
    const LayerRef layer = makeLayer(quarter);
    const MappingRef first = show(layer), second = show(layer);
    const MappingChanges added = update();
    EXPECT_EQ(_layers.count(), 1u);
    EXPECT_EQ(added.uploads.layers.size(), 1u) << "once for both";
    EXPECT_EQ(added.mappings.count(first), 1u);
    EXPECT_EQ(added.mappings.count(second), 1u);
    EXPECT_FALSE(added.roomMade);
    const Place place = placeOfLayer(layer);

    const MappingRef third = show(layer);
    leave(first);
    const MappingChanges changed = update();
    EXPECT_EQ(placeOfLayer(layer), place);
    EXPECT_TRUE(changed.uploads.layers.empty());
    EXPECT_TRUE(changed.mappings.empty());
    EXPECT_FALSE(changed.roomMade);

    leave(second);
    leave(third);
    const MappingChanges left = update();
    EXPECT_FALSE(isPlaced(layer));
    EXPECT_EQ(_layers.count(), 0u);
    EXPECT_TRUE(left.roomMade);
    EXPECT_TRUE(_onGpu.empty());
}

TEST_F(LayerResidencyTest, ALayerThatGoesOnBeingUsedKeepsItsPlace)
{
    const LayerRef picture = makeLayer(quarter), other = makeLayer(quarter);
    const MappingRef user = show(picture);
    update();
    const Place place = placeOfLayer(picture);
    // From picture to mask, then both at once, and back.
    const std::vector<LayerResidency::Pair> pairs = {
        {other, picture}, {picture, other}, {picture, picture}, {picture, nullptr}};
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        use(user, pairs[i]);
        const MappingChanges told = update();
        ASSERT_TRUE(isPlaced(picture)) << i;
        EXPECT_EQ(placeOfLayer(picture), place) << i;
        EXPECT_EQ(isPlaced(other), pairs[i].layer == other || pairs[i].mask == other) << i;
        for (const GpuStore::Layer& upload : told.uploads.layers)
            EXPECT_NE(placeOf(upload.slot), place) << i;
    }
    EXPECT_EQ(_onGpu.size(), 1u);
}

TEST_F(LayerResidencyTest, TheLeastImportantOneGoes)
{
    const std::vector<LayerRef> layers = {makeLayer(quarter, 0.4), makeLayer(quarter, 0.2),
                                          makeLayer(quarter, 0.3), makeLayer(quarter, 0.5)};
    std::vector<MappingRef> users;
    for (const LayerRef& layer : layers)
        users.push_back(show(layer));
    update();
    std::vector<Place> places;
    for (const LayerRef& layer : layers)
        places.push_back(placeOfLayer(layer));
    EXPECT_EQ(_onGpu.size(), 4u);

    const LayerRef better = makeLayer(quarter, 0.6);
    const MappingRef user = show(better);
    const MappingChanges told = update();
    EXPECT_FALSE(isPlaced(layers[1]));
    EXPECT_EQ(placeOfLayer(better), places[1]);
    for (const std::size_t i : {0u, 2u, 3u})
    {
        ASSERT_TRUE(isPlaced(layers[i])) << i;
        EXPECT_EQ(placeOfLayer(layers[i]), places[i]) << i;
        EXPECT_EQ(told.mappings.count(users[i]), 0u) << i;
    }
    EXPECT_EQ(told.mappings.count(users[1]), 1u);
    EXPECT_EQ(told.mappings.count(user), 1u);
    EXPECT_EQ(_layers.leftOut(), 1);
    EXPECT_EQ(_onGpu.size(), 4u);
    // First it is free, then it is another's.
    ASSERT_EQ(told.uploads.layers.size(), 2u);
    EXPECT_EQ(placeOf(told.uploads.layers[0].slot), places[1]);
    EXPECT_FALSE(told.uploads.layers[0].pixels);
    EXPECT_EQ(placeOf(told.uploads.layers[1].slot), places[1]);
    EXPECT_TRUE(told.uploads.layers[1].pixels);
}

TEST_F(LayerResidencyTest, NoneGoesForOneThatIsNotMoreImportant)
{
    std::vector<LayerRef> layers;
    for (int i = 0; i < 4; ++i)
    {
        layers.push_back(makeLayer(quarter, 0.3));
        show(layers.back());
    }
    update();
    int leftOut = 0;
    for (const double importance : {0.3, 0.1})
    {
        const LayerRef late = makeLayer(quarter, importance);
        show(late);
        const MappingChanges told = update();
        EXPECT_FALSE(isPlaced(late)) << importance;
        EXPECT_EQ(_layers.leftOut(), ++leftOut);
        EXPECT_TRUE(told.uploads.layers.empty());
        for (const LayerRef& layer : layers)
            EXPECT_TRUE(isPlaced(layer)) << importance;
    }
}

TEST_F(LayerResidencyTest, SeveralGoForALargeOne)
{
    std::vector<LayerRef> small;
    for (int i = 0; i < 4; ++i)
    {
        small.push_back(makeLayer(quarter, 0.1 + 0.1 * i));
        show(small.back());
    }
    update();
    const LayerRef large = makeLayer(pageSide, 0.9);
    show(large);
    update();
    ASSERT_TRUE(isPlaced(large));
    EXPECT_EQ(_layers.placed(large)->slot.side, pageSide);
    for (const LayerRef& layer : small)
        EXPECT_FALSE(isPlaced(layer));
    EXPECT_EQ(_layers.leftOut(), 4);
    EXPECT_EQ(_onGpu.size(), 1u);
}

TEST_F(LayerResidencyTest, WhatHadToGoHasTheRoomThatIsLeft)
{
    _layers.reset(pageSide, 2);
    const LayerRef least = makeLayer(quarter, 0.1), second = makeLayer(quarter, 0.2);
    for (const LayerRef& layer :
         {least, makeLayer(quarter, 0.4), makeLayer(quarter, 0.4), makeLayer(quarter, 0.4)})
        show(layer);
    update();
    show(second);
    update();
    ASSERT_EQ(std::get<0>(placeOfLayer(second)), 1) << "alone on the other page";
    // Both go for a whole page, and a quarter of the first one is free then.
    const Place hole = placeOfLayer(least);
    const LayerRef large = makeLayer(pageSide, 0.9);
    show(large);
    update();
    ASSERT_TRUE(isPlaced(large));
    ASSERT_TRUE(isPlaced(second));
    EXPECT_EQ(placeOfLayer(second), hole);
    EXPECT_FALSE(isPlaced(least));
    EXPECT_EQ(_layers.leftOut(), 1);
}

TEST_F(LayerResidencyTest, WhatIsLeftOutComesBackWhenRoomIsMade)
{
    std::vector<LayerRef> layers;
    std::vector<MappingRef> users;
    for (int i = 0; i < 6; ++i)
    {
        layers.push_back(makeLayer(quarter, 0.1 * (i + 1)));
        users.push_back(show(layers.back()));
    }
    update();
    EXPECT_EQ(_layers.leftOut(), 2);
    EXPECT_FALSE(isPlaced(layers[0]));
    EXPECT_FALSE(isPlaced(layers[1]));
    EXPECT_TRUE(update().uploads.layers.empty()) << "nothing has changed";
    EXPECT_EQ(_layers.leftOut(), 2);

    // The more important one of them has the room of one.
    leave(users[5]);
    const MappingChanges told = update();
    EXPECT_TRUE(isPlaced(layers[1]));
    EXPECT_EQ(told.mappings.count(users[1]), 1u);
    EXPECT_FALSE(isPlaced(layers[0]));
    EXPECT_EQ(_layers.leftOut(), 1);
    // One that is left out and goes is counted no more.
    leave(users[0]);
    update();
    EXPECT_EQ(_layers.leftOut(), 0);
    EXPECT_EQ(_layers.count(), 4u);
    EXPECT_EQ(_onGpu.size(), 4u);
}

TEST_F(LayerResidencyTest, AnotherPictureIsUploadedWhereItHasRoom)
{
    const LayerRef layer = makeLayer(quarter);
    const MappingRef user = show(layer);
    show(makeLayer(quarter));
    update();
    const Place place = placeOfLayer(layer);
    // The same picture is there already.
    layer->getImage()->dirty();
    MappingChanges told = update();
    EXPECT_TRUE(told.uploads.layers.empty());
    EXPECT_TRUE(told.repainted.empty());
    // In its place, and no record is the worse for it.
    *layer->getImage()->data(3, 20) = 7;
    layer->getImage()->dirty();
    told = update();
    ASSERT_EQ(told.uploads.layers.size(), 1u);
    EXPECT_EQ(placeOf(told.uploads.layers[0].slot), place);
    ASSERT_TRUE(told.uploads.layers[0].rows);
    EXPECT_EQ(told.uploads.layers[0].rows->first, 20);
    EXPECT_EQ(told.uploads.layers[0].rows->end, 21);
    EXPECT_EQ(told.repainted.count(user), 1u);
    EXPECT_TRUE(told.mappings.empty());
    // Of another size, in another place.
    resize(*layer->getImage(), quarter / 2);
    told = update();
    ASSERT_TRUE(isPlaced(layer));
    EXPECT_EQ(_layers.placed(layer)->slot.side, quarter / 2);
    EXPECT_EQ(told.mappings.count(user), 1u);
    EXPECT_TRUE(told.roomMade);
    EXPECT_EQ(_onGpu.size(), 2u);
    // And without one, in none.
    layer->setImage(nullptr);
    told = update();
    EXPECT_FALSE(isPlaced(layer));
    EXPECT_EQ(told.mappings.count(user), 1u);
    EXPECT_EQ(_layers.leftOut(), 0);
    EXPECT_EQ(_onGpu.size(), 1u);
}

TEST_F(LayerResidencyTest, OtherPagesTakeAllAnew)
{
    std::vector<LayerRef> layers;
    std::vector<MappingRef> users;
    for (int i = 0; i < 6; ++i)
    {
        layers.push_back(makeLayer(quarter));
        users.push_back(show(layers.back()));
    }
    update();
    EXPECT_EQ(_layers.leftOut(), 2);
    _layers.reset(pageSide, 2);
    for (const LayerRef& layer : layers)
        EXPECT_FALSE(isPlaced(layer));
    const MappingChanges told = update();
    EXPECT_EQ(told.uploads.layers.size(), 6u);
    EXPECT_EQ(_layers.leftOut(), 0);
    EXPECT_EQ(_layers.pagesUsed(), 2);
    for (std::size_t i = 0; i < layers.size(); ++i)
    {
        EXPECT_TRUE(isPlaced(layers[i])) << i;
        EXPECT_EQ(told.mappings.count(users[i]), 1u) << i;
    }
}

TEST_F(LayerResidencyTest, SaysOnceThatALayerIsReduced)
{
    geofx::test::NotifyWatch watch;
    const LayerRef layer = makeLayer(2 * pageSide, 0.7);
    show(layer);
    EXPECT_EQ(watch.messagesOf([&] { update(); }).size(), 1u);
    ASSERT_TRUE(isPlaced(layer));
    EXPECT_EQ(_layers.placed(layer)->slot.side, pageSide);
    // A film that plays does not say it for each of its pictures.
    layer->getImage()->dirty();
    EXPECT_EQ(update().uploads.layers.size(), 1u);
}

TEST_F(LayerResidencyTest, RandomUseNeverOverlapsAndLeavesNothingBehind)
{
    for (int sample = 0; sample < 20; ++sample)
    {
        Random random(sample);
        _layers.reset(pageSide, 2);
        std::vector<LayerRef> layers;
        for (int i = 0; i < 12; ++i)
            layers.push_back(makeLayer(8 << random.integer(0, 3), random.uniform(0.0, 1.0)));
        std::vector<MappingRef> users;
        for (int i = 0; i < 8; ++i)
            users.emplace_back(new ProjectiveMapping);
        const auto any = [&]() -> LayerRef
        {
            const int which = random.integer(-2, static_cast<int>(layers.size()) - 1);
            return which < 0 ? nullptr : layers[static_cast<std::size_t>(which)];
        };
        for (int step = 0; step < 100; ++step)
        {
            for (int i = random.integer(1, 3); i > 0; --i)
                use(users[static_cast<std::size_t>(random.integer(0, 7))], {any(), any()});
            update();
            std::map<LayerRef, int> used;
            for (const auto& [user, pair] : _used)
            {
                for (const LayerRef& layer : {pair.layer, pair.mask})
                    if (layer) ++used[layer];
            }
            ASSERT_EQ(_layers.count(), used.size());
            // All that has a place has been uploaded, and nothing else is there.
            std::map<Place, int> expected;
            for (const LayerRef& layer : layers)
            {
                const auto placed = _layers.placed(layer);
                ASSERT_TRUE(!placed || used.count(layer));
                if (placed) expected[placeOf(placed->slot)] = placed->slot.side;
            }
            ASSERT_EQ(_onGpu, expected);
            ASSERT_EQ(_layers.leftOut(), static_cast<int>(used.size() - expected.size()));
        }
        for (const MappingRef& user : users)
            leave(user);
        update();
        ASSERT_EQ(_layers.count(), 0u);
        ASSERT_EQ(_layers.leftOut(), 0);
        ASSERT_TRUE(_onGpu.empty());
        _used.clear();
    }
}
