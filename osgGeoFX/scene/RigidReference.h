// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Group>
#include <osg/Vec3d>

namespace osgGeoFX
{

/** A group for objects that keep their shape where the ground below them is deformed: a building, a sign, a label.

    Below an EffectScene, everything in this group moves as one piece, by one reference point for the whole object
    (paper: multi-perspective views, Sections 3 and 4, "rigid reference"). The deformation moves this point, and the
    object turns as the ground there does, unless `turn` is off. Outside an EffectScene it is a plain group.

    It may be shared and used by several threads as any node. Each camera has its own placement.

    @ingroup scene */
class OSGGEOFX_EXPORT RigidReference : public osg::Group
{
public:
    RigidReference() = default;
    RigidReference(const RigidReference& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, RigidReference);

    /// As any group. It tells the cull visitor of an EffectScene that this group keeps its shape.
    void accept(osg::NodeVisitor& visitor) override;

    /// The reference point in the group's own frame; the origin by default.
    void setReference(const osg::Vec3d& point)
    {
        _reference = point;
        dirtyBound();
    }
    const osg::Vec3d& getReference() const { return _reference; }
    /// Whether the center of the bounding sphere is the reference point instead. False by default.
    void setUseBoundCenter(bool use)
    {
        _useBoundCenter = use;
        dirtyBound();
    }
    bool getUseBoundCenter() const { return _useBoundCenter; }
    /// Whether the object turns with the ground. True by default. Signs and labels may look better upright.
    void setTurn(bool turn) { _turn = turn; }
    bool getTurn() const { return _turn; }

    /// The reference point that is used. Where it lies beyond the end of what a deformation shows, as behind the far end of a
    /// panorama map, the object is not drawn and not picked.
    osg::Vec3d referencePoint() const
    {
        return _useBoundCenter ? osg::Vec3d(getBound().center()) : _reference;
    }

    /// The bounding sphere of the content and the reference point, with three times its radius. So bounds above contain
    /// the object wherever the deformation moves it.
    osg::BoundingSphere computeBound() const override;

protected:
    ~RigidReference() override;

private:
    osg::Vec3d _reference;
    bool _useBoundCenter = false;
    bool _turn = true;
};

} // namespace osgGeoFX
