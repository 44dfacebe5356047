// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <cstdint>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A work file of buildings. First all are written, by one thread; then any thread may read.
class BuildingSpool
{
public:
    /// Makes the file. Throws BuildError, as all methods do, if the disk does not take it.
    explicit BuildingSpool(std::string path);
    ~BuildingSpool();
    BuildingSpool(const BuildingSpool&) = delete;
    BuildingSpool& operator=(const BuildingSpool&) = delete;

    /// Returns where it is.
    std::uint64_t add(const Building& building);
    /// Ends the writing.
    void finish();
    Building read(std::uint64_t place) const;

private:
    void flush();

    const std::string _path;
    int _file = -1;
    std::uint64_t _size = 0;
    std::vector<char> _buffer;
};

} // namespace osgGeoFX
