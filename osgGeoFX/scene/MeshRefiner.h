// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/Node>
#include <osg/ref_ptr>

#include <atomic>
#include <cstddef>

namespace osgGeoFX
{

class EffectScene;

/** Splits the large triangles of other engines' terrain, so that a deformation can bend them.

    The GPU deforms the ends of an edge only. The kit's databases have vertices enough, or page finer tiles; others show
    a sea as a few triangles for each tile, which stand out of a bent ground as spikes.

    @code
    osgGeoFX::CameraRange cameras;
    cameras.ground = scene->ground();
    cameras.projection = viewer.getCamera()->getProjectionMatrix();
    cameras.distance = 5000.0; // the camera stays higher than this above the ground
    osg::ref_ptr<osgGeoFX::MeshRefiner> refiner =
        new osgGeoFX::MeshRefiner(osgGeoFX::MeshRefiner::longestEdge(*scene, cameras, 0.001));
    refiner->refine(*terrain);                                     // what is loaded
    osgGeoFX::TileGuard::install(terrain)->addListener(refiner);   // and what a pager reads from now on
    scene->listenTo(*osgGeoFX::TileGuard::install(terrain));       // strokes stand on the split triangles
    @endcode

    **What it does.** An edge is split into 2, 4, 8… equal parts, by its length alone, until none is longer than wished.
    So what shares an edge, in one geometry, in several or in two tiles, splits it at the same points, and no crack opens.
    Tiles with frames of their own stay as closed as they were: floats differ in the last bits.
    New vertices lie on the old triangles: the ground keeps its shape, on a globe, too, where the middle of an edge of
    10 km lies 2 m below the arc. They have the mean of their neighbours in all arrays that are bound per vertex; normals
    keep their length, and integers for shaders (osg::Array::getPreserveDataType()) are those of a neighbour. Arrays with
    other bindings, the number of primitive sets and their order stay as they are. Points and lines stay as they are.

    **What it leaves alone.** Tiles of the kit's databases; geometry that is short enough; what is drawn with a program that
    does not call geofx_vertex(), or below GEOFX_DEFORMATION off; what keeps its shape (RigidReference, billboards, transforms
    that follow the eye); cameras; geometry with instances, of a class derived from osg::Geometry, or with DYNAMIC data;
    vertices whose fourth coordinate is not 1.

    **Threads.** refine() changes geometry, so no other thread may draw or read the subgraph meanwhile: call it before the
    first frame, or while the viewer's threads are stopped. As a TileListener it works on the threads of pagers, on tiles
    that no one else sees yet. Transforms above a tile must not scale. Settings are made before.

    @ingroup scene */
class OSGGEOFX_EXPORT MeshRefiner : public TileListener
{
public:
    /// `longestEdge`: metres, > 0; HUGE_VAL splits nothing, and other numbers are refused with a warning and split nothing.
    explicit MeshRefiner(double longestEdge);

    /// The longest edge that the enabled deformations of a scene allow for these cameras, metres; HUGE_VAL where nothing
    /// bends. `tolerance`: the error that an image of an edge may have, a share of the distance from the eye; that of a pixel
    /// is 2·tan(vertical field of view / 2) / height of the picture, 0.001 in most. Deformations of one's own are asked by
    /// Deformation::longestEdge().
    static double longestEdge(const EffectScene& scene, const CameraRange& cameras, double tolerance);
    double getLongestEdge() const { return _longestEdge; }

    /// The largest number of triangles that are made of one geometry, 1,000…10,000,000; others are refused with a warning.
    /// Where more would be needed, edges inside are split less, edges on its border as ever, and a warning says so once.
    /// Default: 200,000.
    bool setMostTriangles(unsigned int count);
    unsigned int getMostTriangles() const { return static_cast<unsigned int>(_mostTriangles); }

    /// Splits what is at and below a node.
    void refine(osg::Node& node);
    void tileRead(osg::Node& tile) override { refine(tile); }

    /// The number of geometries that were split, and of the triangles that were made of them, since the refiner was made.
    std::size_t refinedGeometries() const { return _geometries; }
    std::size_t refinedTriangles() const { return _triangles; }

protected:
    ~MeshRefiner() override;

private:
    class Visitor;

    double _longestEdge;
    std::size_t _mostTriangles = 200000;
    std::atomic<std::size_t> _geometries{0}, _triangles{0};
    std::atomic<bool> _said{false};
};

} // namespace osgGeoFX
