// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/FreedMemory.h>

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace osgGeoFX
{

void giveBackLargeBlocks()
{
#ifdef __GLIBC__
    // A threshold that is set does not move any more.
    mallopt(M_MMAP_THRESHOLD, 256 * 1024);
#endif
}

} // namespace osgGeoFX
