// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>

#include <osg/Geometry>
#include <osg/observer_ptr>

#include <atomic>
#include <string>

namespace osgGeoFX
{

/** A second base class of a Deformation that has triangles divided while they are drawn (tessellation), where OpenGL 4 is at
    hand. It goes by the contexts that have drawn it: once one of them is older, nothing is divided anywhere, so that all
    views of a scene have the same levels of detail and the same places.
    @ingroup effect */
class Tessellator
{
public:
    /// The shader file with `vec3 SLOT_sag(vec3 from, vec3 to)` for the tessellation control stage. x: how far, at most, the image
    /// of an edge between two positions departs from a straight line, metres. y: the part of x that falls with the square of the
    /// number of parts, over the pixels that are allowed. z: the part that falls with their number, over the same. All are 0
    /// where the edge stays straight. It may use what the vertex shader file has.
    virtual std::string tessellationFile() const = 0;
    /// Whether triangles are to be divided.
    virtual bool wantsTessellation() const = 0;

    /// Tells which OpenGL a context has that draws the deformation; 0 where nobody knows it yet. Any thread.
    void meetContext(float version) const
    {
        if (version <= 0.0f) return;
        if (version < 4.0f)
            _contexts = OLDER;
        else if (_contexts == UNKNOWN)
            _contexts = ABLE;
    }
    /// Whether triangles are divided: it is wanted, and all contexts so far can do it. Any thread.
    bool tessellates() const { return wantsTessellation() && _contexts == ABLE; }

protected:
    Tessellator() = default;
    Tessellator(const Tessellator& other) : _contexts(other._contexts.load()) {}
    Tessellator& operator=(const Tessellator&) = delete;
    ~Tessellator() = default;

private:
    enum Contexts
    {
        UNKNOWN,
        ABLE,
        OLDER
    };
    mutable std::atomic<Contexts> _contexts{UNKNOWN};
};

/// A second base class of the snapshots of a Tessellator.
/// @ingroup effect
class TessellatedSnapshot
{
public:
    /// Into how many parts an edge is divided at most. 15 parts are 225 times as close to the curve as one. Mesa's llvmpipe loses
    /// triangles where there are more: it numbers the vertices of 341 patches, with 192 each, in 16 bits.
    static constexpr double mostParts = 15.0;

    /// Whether triangles are divided at all.
    virtual bool dividesTriangles() const = 0;
    /// Whether some edge in a box may be divided. It leaves room for what floats round: no edge of a box of which this is false
    /// has a sag on the GPU. So a drawable that is not divided has the same edges as a neighbour that is.
    virtual bool divides(const EyeBox& box) const = 0;
    /// How far, at most, the image of a straight edge departs from a straight line, metres: the part that falls with the square
    /// of the number of parts, and the part that falls with their number.
    virtual osg::Vec2d edgeSag(const osg::Vec3d& from, const osg::Vec3d& to) const = 0;

protected:
    ~TessellatedSnapshot() = default;
};

/** What a scene puts into the render graph in the place of a geometry whose triangles are divided. It shares all arrays, and has
    no parents and no state set. Whoever reads render graphs asks originalOf().
    @ingroup effect */
class OSGGEOFX_EXPORT PatchGeometry : public osg::Geometry
{
public:
    /// Without primitives yet.
    explicit PatchGeometry(osg::Geometry& original);

    /// The geometry that a drawable of the render graph stands for; the drawable itself as a rule.
    static osg::Drawable& originalOf(osg::Drawable& drawable);

protected:
    ~PatchGeometry() override;

private:
    osg::observer_ptr<osg::Geometry> _original;
};

} // namespace osgGeoFX
