// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>

#include <osg/Billboard>
#include <osg/LOD>
#include <osg/StateSet>

#include <vector>

namespace osgGeoFX
{

/** All deformations of one camera and frame, one after the other. Immutable; every thread may use it.

    The bounds are safe: nothing that the deformations make of a ball or a box lies outside of them. */
class OSGGEOFX_EXPORT DeformationChain : public osg::Referenced
{
public:
    void add(osg::ref_ptr<const DeformationFrame> frame)
    {
        _looksAtBoxes = _looksAtBoxes || frame->looksAtBoxes();
        _frames.push_back(std::move(frame));
    }
    /// Ground::tileEdge and Ground::tileError.
    void setTiles(double edge, double error)
    {
        _tileEdge = edge;
        _tileError = error;
    }
    bool empty() const { return _frames.empty(); }
    const std::vector<osg::ref_ptr<const DeformationFrame>>& frames() const { return _frames; }

    osg::Vec3d deform(const osg::Vec3d& position) const;
    /// The middle of bound(): near deform(), and faster.
    osg::Vec3d roughly(const osg::Vec3d& position) const;
    osg::Vec3d undeform(const osg::Vec3d& position) const;
    osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const;
    double style(const osg::Vec3d& position) const;
    /// What takes an object that keeps its shape to its deformed place: eye space to eye space.
    osg::Matrixd placement(const osg::Vec3d& reference) const;

    /// Whether nothing happens to any point of a ball.
    bool leavesAlone(const Ball& ball) const;
    /// Whether nothing of a ball is to be drawn.
    bool hides(const Ball& ball, const osg::Vec2d& room) const;
    bool hides(const EyeBox& box, const osg::Vec2d& room) const;
    /// Whether hides() or a frame's complaint() can ever say anything.
    bool looksAtBoxes() const { return _looksAtBoxes; }
    /// A ball around what becomes of a ball.
    Ball bound(const Ball& ball) const;
    /// A hull around what becomes of a box. `hull` is reused for speed. Its margin is to be no larger than `fineness`,
    /// a share of the box's radius, for each of the box's axes, as far as some tens of points allow.
    void bound(const EyeBox& box, Hull& hull, double fineness = 0.02) const;

    /// The distance, metres, at which an undeformed ball would deserve the level of detail that the deformed one does:
    /// what LOD ranges are compared with. `viewPoint` is in eye space. `bound`: what bound() gives for the ball, by those who
    /// have it.
    double lodDistance(const Ball& ball, const osg::Vec3d& viewPoint, const Ball* bound = nullptr) const;
    /// What is to be taken in the place of distances that are larger, LOD scale included, for the levels of detail of a node with
    /// this ball: where the triangles of a tile, or of a mesh of one of its blocks, are too large for the deformation, one at
    /// which finer ones are due, else infinite.
    double lodLimit(const osg::LOD& node, const Ball& ball) const;
    /// By how much lodDistance() asks for more detail than the distance to the deformed ball alone.
    double detail(const Ball& ball) const;

protected:
    ~DeformationChain() override;

private:
    double blockLimit(const osg::LOD& node, const Ball& ball) const;
    double longestEdge(const Ball& ball) const;

    std::vector<osg::ref_ptr<const DeformationFrame>> _frames;
    bool _looksAtBoxes = false;
    double _tileEdge = 0.0;
    double _tileError = 0.0;
};

/// Whether a subgraph is deformed: the define GEOFX_DEFORMATION of the state sets down to it, and the program, by OSG's rules of
/// inheritance, which are the GPU's.
struct OSGGEOFX_EXPORT DeformationSwitch
{
    bool on = true;
    bool overridden = false;
    const osg::StateAttribute* program = nullptr; ///< the one in force, of whatever class
    bool programOverridden = false;
    /// Goes down into a state set; null is nothing.
    void meet(const osg::StateSet* state);
};

/// By how much a matrix lengthens any vector at most (its spectral norm), rounded up, so that bounds do not shrink.
OSGGEOFX_EXPORT double largestScale(const osg::Matrixd& matrix);

/// Where an object that keeps its shape goes: eye space to eye space; upright where it does not `turn`.
osg::Matrixd rigidPlacement(const DeformationChain& chain, const osg::Vec3d& reference, bool turn);

/// The modelview matrix of one of a billboard's drawables, from that of the billboard: it turns to where the eye is as seen from its
/// deformed place. It is still to be deformed itself.
osg::Matrixd billboardModelView(const DeformationChain& chain, const osg::Billboard& billboard,
                                unsigned int drawable, const osg::Matrixd& modelView);

} // namespace osgGeoFX
