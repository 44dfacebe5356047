// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

namespace osgGeoFX
{

class PassFilter;

/** Culls for a pass that draws parts of the scene again. A PassFilter chooses the parts, wherever they are in the
    picture. Cameras below are left out, and so are drawables whose program does not call the effects' functions. */
class PassCullVisitor : public CompensatingCullVisitor
{
public:
    void run(osgUtil::CullVisitor& outer, const Task& task, PassFilter& filter);

    using CompensatingCullVisitor::apply;
    void apply(osg::Camera&) override {}
    void apply(osg::Projection&) override {}

protected:
    ~PassCullVisitor() override;

    bool cullsByPicture() const override { return false; }
    bool boxOutOfSight(const EyeBox& box) override;
    bool outOfSight(const osg::Node& node) override;
    void meetLevels(const osg::LOD& node) override;
    void place(osg::Drawable& drawable) override;
    void adopt(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph, osgUtil::RenderLeaf& leaf,
               const osg::BoundingBox& bounds, osg::StateSet* look, osg::StateSet* above) override;
    /// A pass lifts what stands on the ground. Its billboards turn to the eye as they do there, undeformed.
    const DeformationChain& turningChain() const override { return *_nothing; }

private:
    using CompensatingCullVisitor::run;

    /// From a drawable's frame to where it stands on the undeformed ground, in eye space.
    osg::Matrixd standing(const osg::Matrixd& modelView) const;
    /// Whether a program of the application is in force.
    bool drawsItself() const;
    /// The drawable that is drawn in place of another one; null for none.
    osg::Drawable* drawn(osg::Drawable& drawable, const std::vector<osg::StateSet*>& states);

    PassFilter* _filter = nullptr;
};

} // namespace osgGeoFX
