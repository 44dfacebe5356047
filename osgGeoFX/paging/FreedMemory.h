// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <memory>

namespace osgGeoFX
{

/** While an object lives, memory that has been freed goes back to the system. A program that pages terrain for long has one in
    its main(), before it has threads.

    The C library gives blocks of 256 KiB and more back as soon as they are freed: the arrays and images of tiles. Without this, glibc
    puts larger and larger blocks, up to 32 MiB, among the small ones once the first of them have been freed. What is freed there can be
    given back only if all behind it is free, and the program keeps half as much again as it uses, or more.

    All threads that begin later share one arena of glibc. A thread would have one of its own otherwise, and what the pager's threads
    allocate and the drawing thread frees is free in other arenas than where the next tile looks for room.

    A thread of its own gives back the free pages between smaller blocks from time to time. Without that they grow by some 60 MiB in
    10,000 frames of flight. It takes some 20 ms for each GiB of smaller blocks; other threads that allocate may wait for a part of that.

    All three are matters of the whole process, so the kit's viewer, renderer and benchmarks have such an object and its libraries do not. What
    is said of large blocks and of arenas outlasts it. From any thread; several objects do no harm. With another C library it does nothing.
    @ingroup paging */
class OSGGEOFX_EXPORT FreedMemory
{
public:
    /// `seconds`: the time from one return of free pages to the next; 0 and less: only large blocks, without a thread.
    explicit FreedMemory(double seconds = 30.0);
    ~FreedMemory();
    FreedMemory(const FreedMemory&) = delete;
    FreedMemory& operator=(const FreedMemory&) = delete;

private:
    class Thread;
    std::unique_ptr<Thread> _thread;
};

} // namespace osgGeoFX
