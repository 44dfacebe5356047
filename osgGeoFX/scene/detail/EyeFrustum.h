// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Drawable>
#include <osg/Matrixd>
#include <osg/Polytope>
#include <osg/Vec2d>
#include <osg/Vec4d>

#include <cfloat>
#include <vector>

namespace osgGeoFX
{

/// A camera's frustum in the view's eye space, and what misses it. For one thread at a time.
class EyeFrustum
{
public:
    /// A set of planes, one bit each: those that a thing may still cross.
    using Mask = unsigned int;
    enum class Side
    {
        Outside,
        Crossing,
        Inside
    };

    /// No `planes`: nothing misses it. `projection`: from the view's eye space to clip coordinates. `sides`: whether the
    /// picture's border culls.
    void set(const osg::Polytope* planes, const osg::Matrixd& projection, bool sides);
    Mask all() const { return (1u << _planes.size()) - 1u; }
    /// Positive on the inner side.
    const std::vector<osg::Vec4d>& planes() const { return _planes; }
    const osg::Matrixd& projection() const { return _projection; }

    /// Removes the planes from the mask that have the whole ball on their inner side.
    Side side(const Ball& ball, Mask& mask) const;
    bool holds(const osg::Vec3d& point, Mask mask) const;
    /// Whether a hull lies beyond a plane of the mask, or misses the picture.
    bool misses(const Hull& hull, Mask mask);

private:
    bool missesPicture(const Hull& hull);

    std::vector<osg::Vec4d> _planes; ///< positive on the inner side
    osg::Matrixd _projection;
    bool _sides = false;
    std::vector<osg::Vec2d> _points;
};

/** The range of depths of all that is drawn in one traversal.

    The exact range of a box is computed only where the result depends on it, for a few boxes in a frame. */
class DepthRange
{
public:
    /// Which of the two ends go by triangles. An end that goes by boxes goes by triangles, too, for a box whose farthest depth is more
    /// than a tenth above its nearest one.
    enum class Meshes
    {
        No,      ///< neither, however wide
        Loosely, ///< both go by boxes
        Near,
        NearAndFar
    };
    /// `depths`: what a depth is, as Visibility::depths() has it. `frustum`: within which triangles count; it must live until settle().
    void clear(const osg::Vec4d& depths = {0.0, 0.0, -1.0, 0.0}, Meshes meshes = Meshes::No,
               const EyeFrustum* frustum = nullptr);
    double depthOf(const osg::Vec3d& point) const
    {
        return _depths.x() * point.x() + _depths.y() * point.y() + _depths.z() * point.z() + _depths.w();
    }
    /// Depths that are certain.
    void include(const Ball& ball);
    void include(double nearest, double farthest);
    /// A drawable, and its matrix to the view's eye space. It must live until settle().
    struct Mesh
    {
        const osg::Drawable* drawable = nullptr;
        osg::Matrixd modelView;
    };
    /// Adds a box whose deformed shape lies within a ball. The chain must live until settle(). What the box holds may reach beyond
    /// its image by `margin`, metres. `mesh`: what it is the box of; without a drawable the box counts.
    void add(const EyeBox& box, const Ball& deformed, const DeformationChain& chain, const Mesh& mesh,
             double margin = 0.0);
    /// Whether a ball lies between the depths that are certain so far. It need not be added then.
    bool covers(const Ball& ball) const
    {
        const double depth = depthOf(ball.center);
        return depth - ball.radius >= _nearest && depth + ball.radius <= _farthest;
    }
    void settle();

    double nearest() const { return _nearest; }
    double farthest() const { return _farthest; }

private:
    struct Candidate
    {
        EyeBox box;
        const DeformationChain* chain;
        double nearest, farthest; ///< of the ball, then of the box
        double margin;
        Mesh mesh;
        bool ofBox = false; ///< whether they are those of the box
    };
    void measure(Candidate& candidate);

    std::vector<Candidate> _candidates;
    Hull _hull;
    osg::Vec4d _depths = osg::Vec4d(0.0, 0.0, -1.0, 0.0);
    double _nearest = DBL_MAX;
    double _farthest = -DBL_MAX;
    Meshes _meshes = Meshes::No;
    const EyeFrustum* _frustum = nullptr;
};

} // namespace osgGeoFX
