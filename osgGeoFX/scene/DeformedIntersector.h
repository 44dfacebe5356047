// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/scene/OwnPrograms.h>

#include <osg/Geode>
#include <osgUtil/IntersectionVisitor>

#include <vector>

namespace osgGeoFX
{

class RigidReference;

/** A ray through the picture, against the terrain as the deformation shows it.

    The ray is straight in eye space. Where it meets a deformed triangle, which the GPU draws straight between its
    deformed corners, is the point that the pixel shows; the place on the ground follows from it by the inverse of the
    deformation. To be used with a DeformedIntersectionVisitor, on a thread that may read the scene graph. */
class OSGGEOFX_EXPORT DeformedLineIntersector : public osgUtil::Intersector
{
public:
    struct Intersection
    {
        double distance = 0.0; ///< from the ray's origin, metres
        osg::Vec3d deformed;   ///< eye space, as drawn
        osg::Vec3d world;      ///< the frame of the scene's children, as the ground lies
        osg::Vec3d normal;     ///< of the undeformed triangle, unit length, in the world
        osg::NodePath path;    ///< from the scene's child to the drawable
        osg::Drawable* drawable = nullptr;
        unsigned int triangle = 0; ///< its number in the drawable

        bool operator<(const Intersection& other) const { return distance < other.distance; }
    };

    /// A ray in eye space, metres; the direction need not be of unit length.
    DeformedLineIntersector(const osg::Vec3d& origin, const osg::Vec3d& direction);

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
    /// Whether the ray certainly misses what becomes of a box.
    bool missesBox(const osg::BoundingBox& box) const;

    osg::Vec3d _origin;
    osg::Vec3d _direction;
    // Of a clone: the intersector that collects, and what is in force below its node.
    DeformedLineIntersector* _root = nullptr;
    osg::ref_ptr<const DeformationChain> _chain;
    OwnPrograms* _programs = nullptr;
    osg::Matrixd _modelView;
    double _scale = 1.0;
    std::vector<Intersection> _found;
    bool _sorted = true;
};

/** Visits the terrain as one camera draws it: with its deformation, at the levels of detail that it chose.

    Nothing is loaded: tiles that are not there yet are represented by those that are drawn in their place. Cameras and
    projections in the scene are left out, since they have pictures of their own. */
class OSGGEOFX_EXPORT DeformedIntersectionVisitor : public osgUtil::IntersectionVisitor
{
public:
    /// `modelView` from the frame of the visited node to eye space; `lodScale` is the camera's.
    DeformedIntersectionVisitor(osgUtil::Intersector* intersector, const DeformationChain& chain,
                                const osg::Matrixd& modelView, double lodScale);

    /// What is in force where the visitor is.
    const DeformationChain& chain() const { return *_chain; }
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
    /// The chain that the state so far asks for.
    void choose();

    osg::ref_ptr<const DeformationChain> _chain;
    osg::ref_ptr<const DeformationChain> _whole;
    osg::ref_ptr<const DeformationChain> _nothing;
    DeformationSwitch _deformation;
    OwnPrograms _programs;
    osg::Matrixd _view;
    double _lodScale;
    double _lodRadius = 0.0;
    double _lodLimit;
};

} // namespace osgGeoFX
