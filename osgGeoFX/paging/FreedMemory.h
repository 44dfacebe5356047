// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

namespace osgGeoFX
{

/** From now on the C library gives blocks of 256 KiB and more back to the system as soon as they are freed: the arrays and images of
    tiles.

    Without this, glibc puts larger and larger blocks, up to 32 MiB, among the small ones once the first of them have been freed. What
    is freed there can be given back only if all behind it is free. A program that pages terrain for long then keeps half as much again
    as it uses, or more. Call it once at the beginning of a program, from any thread. It is a setting of the whole process, so the
    kit's viewer, renderer and benchmarks call it and its libraries do not. With another C library it does nothing.
    @ingroup paging */
OSGGEOFX_EXPORT void giveBackLargeBlocks();

} // namespace osgGeoFX
