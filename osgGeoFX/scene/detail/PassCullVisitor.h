// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

namespace osgGeoFX
{

class PassFilter;

/** Culls for a pass that draws parts of the scene again: a PassFilter says which, whatever is in the picture. Cameras below are left out,
    and so is what is drawn by a program that does not call the effects' functions. */
class PassCullVisitor : public CompensatingCullVisitor
{
public:
    void run(osgUtil::CullVisitor& outer, osg::Group& scene, const Task& task, PassFilter& filter);

    using CompensatingCullVisitor::apply;
    void apply(osg::Camera&) override {}
    void apply(osg::Projection&) override {}

protected:
    ~PassCullVisitor() override;

    bool cullsByPicture() const override { return false; }
    bool outOfSight(const osg::Node& node) override;
    void meetLevels(const osg::LOD& node) override;
    void place(osg::Drawable& drawable) override;
    void adopt(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph, osgUtil::RenderLeaf& leaf,
               const osg::BoundingBox& bounds, osg::StateSet* look, osg::StateSet* above) override;
    /// A pass lifts what stands on the ground, undeformed.
    const DeformationChain& turningChain() const override { return *_nothing; }

private:
    using CompensatingCullVisitor::run;

    /// What is drawn in a drawable's place; null for nothing.
    osg::Drawable* drawn(osg::Drawable& drawable, const std::vector<osg::StateSet*>& states);

    PassFilter* _filter = nullptr;
};

} // namespace osgGeoFX
