// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Geode>
#include <osgUtil/IntersectionVisitor>

#include <memory>
#include <vector>

namespace osgGeoFX
{

class OwnPrograms;
class RigidReference;

/** Intersects a ray through the image with the terrain as the deformation shows it.

    The ray is straight in eye space. The GPU draws a deformed triangle straight between its deformed corners, so the
    point where the ray meets this triangle is the point that the pixel shows. The inverse of the deformation gives
    the place on the ground. Use it with a DeformedIntersectionVisitor, on a thread that may read the scene graph.

    @ingroup scene */
class OSGGEOFX_EXPORT DeformedLineIntersector : public osgUtil::Intersector
{
public:
    /// A point where the ray meets a triangle.
    struct Intersection
    {
        double distance = 0.0; ///< distance from the ray's origin, metres
        osg::Vec3d deformed;   ///< the point as drawn, eye space, metres
        osg::Vec3d world;      ///< the place on the undeformed ground, in the frame of the scene's children
        osg::Vec3d normal;     ///< normal of the undeformed triangle, unit length, same frame as `world`
        osg::NodePath path;    ///< path from the scene's child to the drawable
        osg::Drawable* drawable = nullptr;
        unsigned int triangle = 0; ///< index of the triangle in the drawable

        bool operator<(const Intersection& other) const { return distance < other.distance; }
    };

    /// A ray in eye space, metres. The direction need not have unit length.
    DeformedLineIntersector(const osg::Vec3d& origin, const osg::Vec3d& direction);

    /// Whether it meets triangles as bends curve them, within a thousandth of the distance from the eye, not straight between their
    /// deformed corners: where a coarse tile spans a bend, these straight triangles are kilometres from all ground. So it finds the
    /// ground where finer tiles will show it. False by default.
    void setCurved(bool on) { _curved = on; }

    /// All intersections, the nearest first.
    const std::vector<Intersection>& intersections() const;

    osgUtil::Intersector* clone(osgUtil::IntersectionVisitor& visitor) override;
    bool enter(const osg::Node& node) override;
    void leave() override {}
    void intersect(osgUtil::IntersectionVisitor& visitor, osg::Drawable* drawable) override;
    void reset() override;
    bool containsIntersections() override { return !intersections().empty(); }

protected:
    ~DeformedLineIntersector() override;

private:
    DeformedLineIntersector* root() { return _root ? _root : this; }
    bool meets(const Ball& ball) const;
    /// Whether the ray certainly misses what becomes of a box, even if that moves by `reach` metres more.
    bool misses(const EyeBox& box, double reach = 0.0) const;

    osg::Vec3d _origin;
    osg::Vec3d _direction;
    // Of a clone: the intersector that collects, and what is in force below its node.
    DeformedLineIntersector* _root = nullptr;
    osg::ref_ptr<const DeformationChain> _chain;
    OwnPrograms* _programs = nullptr;
    osg::Matrixd _modelView;
    double _scale = 1.0;
    bool _curved = false;
    std::vector<Intersection> _found;
    bool _sorted = true;
};

/** Visits the terrain as one camera draws it: with its deformation, and at the levels of detail that the camera
    chose.

    It loads nothing. Where a tile is not loaded yet, it visits the tile that is drawn instead. It leaves out cameras
    and projections in the scene, because they have images of their own.

    @ingroup scene */
class OSGGEOFX_EXPORT DeformedIntersectionVisitor : public osgUtil::IntersectionVisitor
{
public:
    /// `modelView`: from the frame of the visited node to eye space. `lodScale`: the camera's LOD scale.
    DeformedIntersectionVisitor(osgUtil::Intersector* intersector, const DeformationChain& chain,
                                const osg::Matrixd& modelView, double lodScale);

    /// The deformation at the node that is visited; empty where nothing is deformed.
    const DeformationChain& chain() const { return *_chain; }
    /// The matrix from the frame of the node that is visited to eye space.
    osg::Matrixd modelView() const;

    using osgUtil::IntersectionVisitor::apply;
    void apply(osg::Node& node) override;
    void apply(osg::Geode& node) override;
    void apply(osg::Group& node) override;
    void apply(osg::Transform& node) override;
    void apply(osg::Billboard& node) override;
    void apply(osg::LOD& node) override;
    void apply(osg::PagedLOD& node) override;
    void apply(osg::Drawable& drawable) override;
    void apply(osg::Camera&) override {}
    void apply(osg::Projection&) override {}
    float getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const override;

protected:
    ~DeformedIntersectionVisitor() override;

private:
    friend class DeformedLineIntersector;
    class Scope;
    void applyRigid(RigidReference& node);
    const DeformationChain& definedChain() const { return _deformation.on ? *_whole : *_nothing; }
    /// Selects the chain that the state sets so far ask for.
    void choose();

    osg::ref_ptr<const DeformationChain> _chain;
    osg::ref_ptr<const DeformationChain> _whole;
    osg::ref_ptr<const DeformationChain> _nothing;
    DeformationSwitch _deformation;
    std::unique_ptr<OwnPrograms> _programs;
    osg::Matrixd _view;
    double _lodScale;
    double _lodRadius = 0.0;
    double _lodLimit;
};

} // namespace osgGeoFX
