// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/NodeVisitor>

namespace osgGeoFX
{

/** Visits the geometry of other people's models whose vertices may be changed: plain and static, and drawn where the effects
    put it. It leaves out what keeps its shape, what follows the eye, cameras, tiles of the kit's databases, and what
    is drawn with a program that knows nothing of effects. */
class PlainGeometry : public osg::NodeVisitor
{
public:
    PlainGeometry();

    using osg::NodeVisitor::apply;
    void apply(osg::Node& node) override;
    void apply(osg::Billboard&) override {}
    void apply(osg::Camera&) override {}
    void apply(osg::Projection&) override {}
    void apply(osg::Group& group) override;
    void apply(osg::Transform& transform) override;
    void apply(osg::Drawable&) override {}
    void apply(osg::Geometry& geometry) override;

protected:
    /// `matrix` leads from the geometry's frame to that of the node where the visit began. Called once for each place.
    virtual void meet(osg::Geometry& geometry, const osg::Matrixd& matrix) = 0;
    /// Whether what is below a transform counts; the matrix is the whole one.
    virtual bool enters(const osg::Matrixd&) const { return true; }

private:
    void descend(osg::Node& node);

    osg::Matrixd _matrix;
    DeformationSwitch _state;
    OwnPrograms _programs;
};

} // namespace osgGeoFX
