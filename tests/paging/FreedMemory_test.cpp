// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// That freed memory goes back to the system, although small blocks behind it are in use.
#include <osgGeoFX/paging/FreedMemory.h>
#include <tools/ResidentMemory.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <malloc.h>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using geofx::test::residentMiB;

namespace
{

std::unique_ptr<char[]> filled(std::size_t bytes)
{
    std::unique_ptr<char[]> block(new char[bytes]);
    std::memset(block.get(), 1, bytes);
    return block;
}

/// Why the C library's allocator is not there; null where it is.
const char* replaced()
{
#if defined(__SANITIZE_ADDRESS__)
    return "AddressSanitizer keeps freed memory to find who uses it.";
#elif defined(__SANITIZE_THREAD__)
    return "ThreadSanitizer has an allocator of its own.";
#else
    return nullptr;
#endif
}

/// Arenas that the C library has.
int arenas()
{
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* const file = open_memstream(&text, &size);
    malloc_info(0, file);
    std::fclose(file);
    const std::string all(text, size);
    std::free(text);
    int count = 0;
    for (std::size_t at = all.find("<heap nr"); at != std::string::npos; at = all.find("<heap nr", at + 1))
        ++count;
    return count;
}

/// Arenas that the C library adds for so many threads which allocate at the same time. Those of threads that have ended are used again.
int newArenas(int count)
{
    const int former = arenas();
    std::vector<std::thread> threads;
    std::atomic<int> begun{0};
    for (int i = 0; i < count; ++i)
        threads.emplace_back(
            [&begun, count]
            {
                const auto block = filled(1000);
                for (++begun; begun < count;)
                    std::this_thread::yield();
            });
    for (std::thread& thread : threads)
        thread.join();
    return arenas() - former;
}

/// What stays resident of 100 blocks of 1 MiB that are freed, with small blocks between them that are not, MiB.
double kept()
{
    const double before = residentMiB();
    std::vector<std::unique_ptr<char[]>> large, small;
    for (int i = 0; i < 100; ++i)
    {
        large.push_back(filled(1 << 20));
        small.push_back(filled(1 << 10));
    }
    large.clear();
    return residentMiB() - before;
}

/// What there is before the first FreedMemory of the process.
struct Before
{
    double kept = 0.0;
    int arenas = 0;
};
const Before& before()
{
    static const Before result = []
    {
        Before measured;
        measured.arenas = newArenas(4);
        // The first block of this size that is freed makes glibc put those that follow among the small ones.
        filled(8 << 20);
        measured.kept = kept();
        return measured;
    }();
    return result;
}

} // namespace

TEST(FreedMemory, OfLargeBlocksGoesBackAtOnce)
{
    if (replaced()) GTEST_SKIP() << replaced();
    EXPECT_GT(before().kept, 40.0) << "there is nothing to mend; then the class can go";
    const osgGeoFX::FreedMemory freed(0.0);
    EXPECT_LT(kept(), 10.0);
}

TEST(FreedMemory, BetweenSmallBlocksGoesBackInTime)
{
    if (replaced()) GTEST_SKIP() << replaced();
    std::vector<std::unique_ptr<char[]>> stay, go;
    for (int i = 0; i < 10000; ++i)
        (i % 10 ? go : stay).push_back(filled(16 << 10));
    const double full = residentMiB();
    go.clear();
    EXPECT_GT(residentMiB(), full - 40.0) << "there is nothing to mend; then the thread can go";
    const osgGeoFX::FreedMemory freed(0.05);
    for (int i = 0; i < 200 && residentMiB() > full - 100.0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LT(residentMiB(), full - 100.0);
}

TEST(FreedMemory, ThreadsShareOneArena)
{
    if (replaced()) GTEST_SKIP() << replaced();
    EXPECT_GT(before().arenas, 1) << "there is nothing to mend; then the class may leave arenas alone";
    const osgGeoFX::FreedMemory freed(0.0);
    EXPECT_EQ(newArenas(10), 0);
}

// A program does not wait for the pause.
TEST(FreedMemory, ThreadEndsWithItsObject)
{
    const auto start = std::chrono::steady_clock::now();
    {
        const osgGeoFX::FreedMemory freed(3600.0), another(0.001);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::minutes(1));
}
