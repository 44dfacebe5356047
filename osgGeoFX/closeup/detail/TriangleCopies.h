// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/observer_ptr>

#include <deque>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Copies of geometries with only those triangles that lie over some regions, or with the same as patches for
    tessellation. A copy shares the arrays of its geometry. It is made on demand, and kept while the drawable lives
    and stays in its place. A geometry that a scene has at several places has a copy for each. For one thread at a time.

    The walls of a tile close the cracks to other meshes. A copy has no walls near a region's border: the ground ends
    there, and a wall would hang out below it. */
class TriangleCopies
{
public:
    /// Which triangles a copy has.
    enum Extent
    {
        OVER_REGIONS, ///< those over any of the regions
        EVERYWHERE    ///< all but the walls near borders
    };
    /// One region: its number, the matrix from the drawable's frame to places in it (−1…1; z: metres above its base),
    /// the height below which nothing is wanted, and its shape. Without a shape all walls are wanted.
    struct Region
    {
        std::size_t item;
        osg::Matrixd toPlaces;
        double otherSide = -std::numeric_limits<double>::infinity();
        osg::ref_ptr<const RegionOfInterest> shape = nullptr;
        unsigned int revision = 0; ///< of the shape
    };

    /// The copy of a geometry of triangles. Null if none of it lies over the regions; the geometry itself if most of
    /// it does and no wall is left out. Without regions it has all triangles.
    osg::Geometry* of(osg::Geometry& geometry, const std::vector<Region>& regions, bool patches,
                      Extent extent = OVER_REGIONS);
    /// The longest edge of a geometry's triangles, in its own frame; 0 without triangles.
    double longestEdge(const osg::Geometry& geometry);
    /// Forgets deleted drawables. Call it when none of the copies is on its way to the screen: they may change from here on.
    void startFrame();
    void resizeGLObjectBuffers(unsigned int size);
    /// Releases the objects of the copies alone. The geometries release what they share.
    void releaseGLObjects(osg::State* state) const;

private:
    struct Entry
    {
        osg::observer_ptr<osg::Geometry> geometry;
        GeometryStamp stamp;
        std::vector<Region> regions;
        Extent extent = OVER_REGIONS;
        osg::ref_ptr<osg::Geometry> copy; ///< null if the geometry itself is drawn
        bool empty = false;
        bool used = false; ///< since startFrame()
    };
    static void build(Entry& entry, bool patches);
    struct Measured
    {
        osg::observer_ptr<const osg::Geometry> geometry;
        GeometryStamp stamp;
        double longestEdge = 0.0;
    };

    using Key = std::pair<osg::Geometry*, std::vector<std::size_t>>;
    using Entries = std::map<Key, std::deque<Entry>>; ///< one for each place of a geometry
    static Entry& entryOf(std::deque<Entry>& places, const osg::Geometry& geometry,
                          const std::vector<Region>& regions, Extent extent);

    Entries _triangles, _patches;
    std::map<const osg::Geometry*, Measured> _measured;
};

} // namespace osgGeoFX
