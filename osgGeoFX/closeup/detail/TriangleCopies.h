// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/observer_ptr>

#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Those triangles of a geometry that lie over some regions, as triangles or as the patches that tessellation asks for:
    geometries that share the arrays of what they copy. Made when first asked for, and kept while the drawable lives and
    lies where it is. For one thread at a time.

    A tile's walls close the cracks between its meshes and those beside them. A wall near a region's border is left out:
    the ground ends there, and the wall would hang out below it. */
class TriangleCopies
{
public:
    /// Which triangles a copy has.
    enum Extent
    {
        OVER_REGIONS, ///< those over any of the regions
        EVERYWHERE    ///< all but the walls near borders
    };
    /// One region: which it is, the matrix from the drawable's frame to places in it (−1…1; z: metres above its base),
    /// the height below which nothing is wanted, and its shape. Without a shape, all walls are wanted.
    struct Region
    {
        std::size_t item;
        osg::Matrixd toPlaces;
        double otherSide = -std::numeric_limits<double>::infinity();
        osg::ref_ptr<const RegionOfInterest> shape = nullptr;
        unsigned int revision = 0; ///< of the shape
    };

    /// Of a geometry that is made of triangles. Null where there is nothing over the regions; the geometry itself where most
    /// of it is, and no wall is left out. Without regions, all of it.
    osg::Geometry* of(osg::Geometry& geometry, const std::vector<Region>& regions, bool patches,
                      Extent extent = OVER_REGIONS);
    /// Of a geometry's triangles, in its own frame; 0 where it has none.
    double longestEdge(const osg::Geometry& geometry);
    /// Forgets what has been deleted; to be called now and then, when nothing of it is on its way to the screen.
    void purge();
    void resizeGLObjectBuffers(unsigned int size);
    /// Of the copies alone: what they share with the geometries is released with these.
    void releaseGLObjects(osg::State* state) const;

private:
    struct Entry
    {
        osg::observer_ptr<osg::Geometry> geometry;
        GeometryStamp stamp;
        std::vector<Region> regions;
        Extent extent = OVER_REGIONS;
        osg::ref_ptr<osg::Geometry> copy; ///< null where the geometry itself is as good
        bool empty = false;
    };
    static void build(Entry& entry, bool patches);
    struct Measured
    {
        osg::observer_ptr<const osg::Geometry> geometry;
        GeometryStamp stamp;
        double longestEdge = 0.0;
    };

    using Key = std::pair<osg::Geometry*, std::vector<std::size_t>>;
    std::map<Key, Entry> _triangles, _patches;
    std::map<const osg::Geometry*, Measured> _measured;
};

} // namespace osgGeoFX
