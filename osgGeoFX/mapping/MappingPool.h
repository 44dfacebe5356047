// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <functional>
#include <vector>

namespace osgGeoFX
{

/** The mappings that a maker keeps in a ProjectiveMappings, one role to a pool: they are used over again, so that a small
    change of what is made uploads little. Takes them all away in the end.

    @code
    pool.rewind();
    for (const Piece& piece : pieces)
        pool.next().setRectangle(...);
    pool.trim(); // those that were not needed this time
    @endcode
    As all scene data, by the thread of the frame loop between frames. */
class OSGGEOFX_EXPORT MappingPool
{
public:
    using Prepare = std::function<void(ProjectiveMapping&)>;

    /// `prepare` is done once to each new mapping, before it is added.
    MappingPool(ProjectiveMappings& host, Prepare prepare);
    ~MappingPool();
    MappingPool(const MappingPool&) = delete;
    MappingPool& operator=(const MappingPool&) = delete;

    void rewind() { _used = 0; }
    ProjectiveMapping& next();
    void trim();
    void clear();
    /// Does something to all, and to those that are yet to come; in the place of the former `prepare`.
    void prepareAll(Prepare prepare);

    std::size_t size() const { return _mappings.size(); }
    ProjectiveMapping& at(std::size_t i) const { return *_mappings[i]; }
    ProjectiveMappings& host() const { return *_host; }

private:
    osg::ref_ptr<ProjectiveMappings> _host;
    Prepare _prepare;
    std::vector<osg::ref_ptr<ProjectiveMapping>> _mappings;
    std::size_t _used = 0;
};

/// Four mappings of the pool around the rectangle low…high, out to `reach` metres from it, which meet it and each other
/// without a seam. The pool is rewound and trimmed.
OSGGEOFX_EXPORT void surround(MappingPool& pool, const osg::Vec2d& low, const osg::Vec2d& high, double reach);

} // namespace osgGeoFX
