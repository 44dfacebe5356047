// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/CoordinateSystemNode>
#include <osg/Node>
#include <osg/ref_ptr>

#include <atomic>
#include <cstddef>

namespace osgGeoFX
{

/** Lets the buildings of other people's city models keep their shape where a deformation bends the ground below them.

    A model from elsewhere (.osgb, 3D Tiles, CityGML, whatever OSG reads) has thousands of buildings in some geometries, or one
    building in several. This class finds which triangles belong together, and gives each such thing one reference point, as
    RigidParts has it (paper: multi-perspective views, Sections 3 and 4, "rigid reference"). The towns of osggeofx_build
    have these already.

    @code
    osg::ref_ptr<osg::Node> city = osgDB::readRefNodeFile("city.osgb");
    osg::ref_ptr<osgGeoFX::RigidModel> rigid = new osgGeoFX::RigidModel(scene->ground().ellipsoid);
    rigid->prepare(*city);                                     // what is loaded
    osgGeoFX::TileGuard::install(city)->addListener(rigid);    // and what a pager reads from now on
    scene->addChild(city);
    @endcode

    **What is one thing.** Triangles that share a corner, in one geometry or in several, within 1 cm. A whole row of houses that
    share walls is one thing, too. The reference point is the middle of the thing's bottom. What is larger than getLargest() is
    no building: it bends as it did, as do points and lines. So ground in the model stays ground; but houses that share corners
    with the ground are part of it.

    **What it leaves alone.** Groups that are rigid already (RigidReference, RigidParts), billboards, transforms that follow the eye,
    cameras, tiles of the kit's databases; geometry below a transform that scales, with instances, of a class derived from
    osg::Geometry, with DYNAMIC data, or whose vertices are no osg::Vec3Array; what is drawn with a program that does not call
    geofx_vertex(), or below GEOFX_DEFORMATION off. A geometry that stands in several places has the things of its first one.

    **Threads.** prepare() changes geometry and its state sets, so no other thread may draw or read the subgraph meanwhile: call it
    before the first frame, or while the viewer's threads are stopped. As a TileListener it works on the threads of pagers, on
    tiles that no one else sees yet. Things do not reach across tiles. On a globe, transforms above a tile must be the
    identity. Settings are made before.

    @ingroup scene */
class OSGGEOFX_EXPORT RigidModel : public TileListener
{
public:
    /// `ellipsoid`: of the globe that the model stands on; null where z is up.
    explicit RigidModel(const osg::EllipsoidModel* ellipsoid = nullptr);

    /// The diagonal of the largest box around a thing that is still a building, metres, > 0; others are refused with a warning.
    /// Default: 500.
    bool setLargest(double metres);
    double getLargest() const { return _largest; }

    /// Finds the things at and below a node. Doing it twice changes nothing more.
    void prepare(osg::Node& node);
    void tileRead(osg::Node& tile) override { prepare(tile); }

    /// How many things were found, in how many geometries, since this object was made.
    std::size_t things() const { return _things; }
    std::size_t geometries() const { return _geometries; }

protected:
    ~RigidModel() override;

private:
    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    double _largest = 500.0;
    std::atomic<std::size_t> _things{0}, _geometries{0};
};

} // namespace osgGeoFX
