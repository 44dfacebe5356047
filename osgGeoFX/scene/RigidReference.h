// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Group>
#include <osg/Vec3d>

namespace osgGeoFX
{

/** Something that keeps its shape where the ground below it is deformed: a building, a sign, a label.

    Below an EffectScene everything in this group moves as one piece, with one reference point for the whole object
    (paper: multi-perspective views, Section 3 and 4, "rigid reference"): to where the deformation takes that point, and
    turned as the ground there is, unless `turn` is off. Elsewhere it is a plain group.

    Shared and threaded as any node; the placement is each camera's own. */
class OSGGEOFX_EXPORT RigidReference : public osg::Group
{
public:
    RigidReference() = default;
    RigidReference(const RigidReference& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGeoFX, RigidReference);

    /// The reference point in the group's own frame; the origin by default.
    void setReference(const osg::Vec3d& point)
    {
        _reference = point;
        dirtyBound();
    }
    const osg::Vec3d& getReference() const { return _reference; }
    /// Whether the middle of the bound is the reference point instead. False by default.
    void setUseBoundCenter(bool use)
    {
        _useBoundCenter = use;
        dirtyBound();
    }
    bool getUseBoundCenter() const { return _useBoundCenter; }
    /// Whether it turns with the ground; true by default. Signs and labels may better stay upright.
    void setTurn(bool turn) { _turn = turn; }
    bool getTurn() const { return _turn; }

    /// The point that is in force.
    osg::Vec3d referencePoint() const
    {
        return _useBoundCenter ? osg::Vec3d(getBound().center()) : _reference;
    }

    /// Three times as wide as what is in it: so the bounds above contain it wherever the deformation takes it.
    osg::BoundingSphere computeBound() const override;

protected:
    ~RigidReference() override;

private:
    osg::Vec3d _reference;
    bool _useBoundCenter = false;
    bool _turn = true;
};

} // namespace osgGeoFX
