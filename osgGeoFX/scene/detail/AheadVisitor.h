// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/scene/detail/Visibility.h>

#include <osg/NodeVisitor>
#include <osg/PagedLOD>

#include <functional>

namespace osgGeoFX
{

/** Goes down a scene as the cull visitor of some camera would, and finds the paged children that this one would ask for.

    It draws nothing, and looks at nothing but what may have paged nodes below it. For one thread, while no other one uses
    the scene. */
class AheadVisitor : public osg::NodeVisitor
{
public:
    /// A camera, at some time.
    struct Outlook
    {
        ViewGeometry view;
        osg::ref_ptr<const DeformationChain> chain;
        osg::ref_ptr<const osg::Viewport> viewport; ///< may be null
        double lodScale = 1.0;
        bool sides = true; ///< whether the borders of the picture cull
        bool horizons =
            true; ///< whether nodes that know their horizon (osg::ClusterCullingCallback) are left out below it
        bool compensates = true; ///< whether boxes of tiles are looked at, as the kit's visitor does
    };

    /// A paged child that is not there.
    struct Missing
    {
        osg::PagedLOD& group;
        unsigned int child;
        float priority;            ///< as OSG has it
        const osg::Matrixd& model; ///< from the group's frame to that of the scene's children
    };

    AheadVisitor();

    /// Begins a view of a scene's children. `frame`: the number that paged children get which it looks at; so the pager
    /// keeps them.
    void begin(const Outlook& outlook, unsigned int frame);
    /// Whether the view asks for a child by itself, whatever is above it.
    bool wants(const Missing& missing);

    std::function<void(const Missing&)> found;

    using osg::NodeVisitor::apply;
    void apply(osg::Node& node) override;
    void apply(osg::Transform& node) override;
    void apply(osg::LOD& node) override;
    void apply(osg::PagedLOD& node) override;
    // These have pictures of their own, or nothing below them.
    void apply(osg::Camera&) override {}
    void apply(osg::Projection&) override {}
    void apply(osg::Geode&) override {}
    void apply(osg::Billboard&) override {}
    void apply(osg::Drawable&) override {}

    osg::Vec3 getViewPoint() const override;
    float getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const override;

protected:
    ~AheadVisitor() override;

private:
    /// What is in force below a node.
    struct Mode
    {
        osg::Matrixd model, toView;
        double scale = 1.0;
        Visibility::Mask planes = 0;
        DeformationSwitch deformation;
    };
    class Scope;

    const DeformationChain& chain() const { return _mode.deformation.on ? *_outlook.chain : *_nothing; }
    void place(const osg::Matrixd& model);
    Ball ballOf(const osg::Node& node) const;
    /// Narrows the planes for what is below the node.
    bool outOfSight(const osg::Node& node);
    /// Whether the round Earth hides a node that knows its horizon.
    bool belowHorizon(const osg::Node& node);
    /// What the ranges of a node are compared with.
    double rangeFor(const osg::LOD& node) const;

    Outlook _outlook = {ViewGeometry({}, {}, {}), nullptr, nullptr};
    Visibility _sight;
    osg::Polytope _planes;
    Mode _mode;
    const osg::ref_ptr<const DeformationChain> _nothing = new DeformationChain;
    unsigned int _frame = 0;
};

} // namespace osgGeoFX
