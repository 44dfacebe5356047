// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A camera's list: what it writes, and that no arena but its own has its texels back.
#include <osgGeoFX/mapping/detail/CameraList.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <numeric>
#include <vector>

using osgGeoFX::CameraList;
using osgGeoFX::TexelArena;

namespace
{

std::vector<std::uint32_t> recordsTo(std::size_t count)
{
    std::vector<std::uint32_t> records(count);
    std::iota(records.begin(), records.end(), 100u);
    return records;
}

} // namespace

TEST(CameraList, HasTheNumberOfRecordsThenThese)
{
    const auto arena = std::make_shared<TexelArena>();
    for (const std::size_t count : {1u, 2u, 3u, 4u, 7u, 8u, 100u})
    {
        CameraList list;
        const std::vector<std::uint32_t> records = recordsTo(count);
        list.write(arena, records);
        ASSERT_GT(list.offset(), 0u);
        EXPECT_EQ(arena->used(), (count + 4) / 4);
        std::vector<std::uint32_t> expected = {static_cast<std::uint32_t>(count)};
        expected.insert(expected.end(), records.begin(), records.end());
        expected.resize(4 * arena->used());
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(arena->texels()[list.offset() + i / 4][i % 4], expected[i]) << count << ", " << i;
        list.release(arena);
        EXPECT_EQ(list.offset(), 0u);
        EXPECT_EQ(arena->used(), 0u);
    }
}

TEST(CameraList, IsEmptyWithoutRecordsAndWithoutRoom)
{
    const auto arena = std::make_shared<TexelArena>();
    arena->setLimit(4);
    CameraList list;
    list.write(arena, {});
    EXPECT_EQ(list.offset(), 0u);
    list.write(arena, recordsTo(100));
    EXPECT_EQ(list.offset(), 0u);
    EXPECT_EQ(arena->used(), 0u);
    list.release(arena);
    EXPECT_EQ(arena->used(), 0u);
}

TEST(CameraList, IsGivenBackOnceAndToItsOwnArenaOnly)
{
    auto own = std::make_shared<TexelArena>();
    const auto other = std::make_shared<TexelArena>();
    const std::uint32_t taken = 100;
    ASSERT_GT(other->allocate(taken), 0u);
    CameraList list;
    list.write(own, recordsTo(20));
    const std::uint32_t used = own->used();
    list.release(other);
    EXPECT_EQ(other->used(), taken);
    EXPECT_EQ(own->used(), used) << "it was told of another one";
    EXPECT_EQ(list.offset(), 0u);

    list.write(own, recordsTo(20));
    list.release(own);
    list.release(own);
    EXPECT_EQ(own->used(), used);

    // The arena ends, and another one has texels in the same place.
    list.write(own, recordsTo(20));
    own = std::make_shared<TexelArena>();
    ASSERT_GT(own->allocate(taken), 0u);
    list.release(own);
    EXPECT_EQ(own->used(), taken);
    EXPECT_EQ(list.offset(), 0u);
    list.write(own, recordsTo(20));
    EXPECT_GT(list.offset(), 0u) << "it can be filled again";
}
