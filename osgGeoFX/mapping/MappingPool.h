// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <functional>
#include <vector>

namespace osgGeoFX
{

/** A pool of mappings that one maker, for instance a LensMapping, keeps in a ProjectiveMappings. The pool reuses its
    mappings, so that a small change uploads little. The destructor removes all of them.

    @code
    pool.rewind();
    for (const Piece& piece : pieces)
        pool.next().setRectangle(...);
    pool.trim(); // removes the mappings that were not needed this time
    @endcode
    The thread of the frame loop uses a pool, between frames, as all scene data.
    @ingroup mapping */
class OSGGEOFX_EXPORT MappingPool
{
public:
    using Prepare = std::function<void(ProjectiveMapping&)>;

    /// `prepare` is called once for each new mapping, before the mapping is added.
    MappingPool(ProjectiveMappings& host, Prepare prepare);
    /// Puts mappings where a program wants them: each is given with its number in the pool.
    using Put = std::function<void(ProjectiveMapping&, std::size_t)>;
    MappingPool(Put add, Put remove, Prepare prepare);
    ~MappingPool();
    MappingPool(const MappingPool&) = delete;
    MappingPool& operator=(const MappingPool&) = delete;

    /// Starts again: next() returns the pool's first mapping.
    void rewind() { _used = 0; }
    /// The next mapping of the pool, or a new one if all are in use.
    ProjectiveMapping& next();
    /// Removes the mappings that next() has not returned since rewind().
    void trim();
    /// Removes all mappings.
    void clear();
    /// Calls `prepare` for all mappings of the pool, and later for each new one in place of the former `prepare`.
    void prepareAll(Prepare prepare);
    /// Calls the present one again for all mappings.
    void prepareAll();

    std::size_t size() const { return _mappings.size(); }
    ProjectiveMapping& at(std::size_t i) const { return *_mappings[i]; }

private:
    Put _add, _remove;
    Prepare _prepare;
    std::vector<osg::ref_ptr<ProjectiveMapping>> _mappings;
    std::size_t _used = 0;
};

/// Places four mappings of the pool around the rectangle low…high. They reach `reach` metres beyond the rectangle.
/// They meet the rectangle and each other without a seam. The function rewinds and trims the pool.
OSGGEOFX_EXPORT void surround(MappingPool& pool, const osg::Vec2d& low, const osg::Vec2d& high, double reach);

} // namespace osgGeoFX
