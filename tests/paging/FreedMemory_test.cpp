// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// That freed blocks go back to the system, although small ones behind them are in use.
#include <osgGeoFX/paging/FreedMemory.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <memory>
#include <unistd.h>
#include <vector>

namespace
{

double residentMiB()
{
    std::ifstream file("/proc/self/statm");
    double size = 0.0, resident = 0.0;
    file >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

std::unique_ptr<char[]> filled(std::size_t bytes)
{
    std::unique_ptr<char[]> block(new char[bytes]);
    std::memset(block.get(), 1, bytes);
    return block;
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

} // namespace

TEST(FreedMemory, OfLargeBlocksGoesBackAtOnce)
{
    // The first block of this size that is freed makes glibc put those that follow among the small ones.
    filled(8 << 20);
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "AddressSanitizer keeps freed memory to find who uses it.";
#endif
#ifdef __SANITIZE_THREAD__
    GTEST_SKIP() << "ThreadSanitizer has an allocator of its own.";
#endif
    EXPECT_GT(kept(), 40.0) << "there is nothing to mend; then the function can go";
    osgGeoFX::giveBackLargeBlocks();
    EXPECT_LT(kept(), 10.0);
}
