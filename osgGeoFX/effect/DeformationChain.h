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

/** All deformations of one camera and frame, applied one after the other. Positions are in eye space, metres.

    A chain does not change once it is filled, so every thread may use it. The bounds are conservative: nothing that
    a sphere or a box becomes lies outside its bound.

    @ingroup effect */
class OSGGEOFX_EXPORT DeformationChain : public osg::Referenced
{
public:
    /// Adds a deformation at the end of the chain.
    void add(osg::ref_ptr<const DeformationSnapshot> snapshot)
    {
        _looksAtBoxes = _looksAtBoxes || snapshot->looksAtBoxes();
        _snapshots.push_back(std::move(snapshot));
    }
    /// Sets the values of Ground::tileEdge and Ground::tileError, which lodLimit() needs. `ownTiles`: whether they are
    /// those of the kit's tiles only; otherwise they hold for any node with two levels. The kit's tiles have levels by the errors of
    /// their heights. Those of other engines have them by the sizes of their textures, which vertical movements do not change.
    void setTiles(double edge, double error, bool ownTiles = true)
    {
        _tileEdge = edge;
        _tileError = error;
        _ownTiles = ownTiles;
    }
    /// Whether hides() is true of what an engine's coarse tiles do not draw (DeformationSnapshot::isAside()). False by default.
    void setCoarseTiles(bool coarse) { _coarseTiles = coarse; }
    bool empty() const { return _snapshots.empty(); }
    const std::vector<osg::ref_ptr<const DeformationSnapshot>>& snapshots() const { return _snapshots; }

    osg::Vec3d deform(const osg::Vec3d& position) const;
    /// A faster approximation of deform(): the center of bound() for a sphere at this position.
    osg::Vec3d roughly(const osg::Vec3d& position) const;
    osg::Vec3d undeform(const osg::Vec3d& position) const;
    osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const;
    /// The largest style of the deformations: 0 in the focus, 1 in the context.
    double style(const osg::Vec3d& position) const;
    /// The matrix that moves a rigid object to its deformed place, from eye space to eye space. `reference` is the
    /// object's reference point.
    osg::Matrixd placement(const osg::Vec3d& reference) const;

    /// Whether no point of a sphere moves.
    bool leavesAlone(const Ball& ball) const;
    /// Whether nothing within a sphere or box needs to be drawn. `room` is that of DeformationSnapshot::hides().
    bool hides(const Ball& ball, const osg::Vec2d& room) const;
    bool hides(const EyeBox& box, const osg::Vec2d& room) const;
    /// Whether a position lies beyond the end of what one of the deformations shows (DeformationSnapshot::isBeyond()).
    bool isBeyond(const osg::Vec3d& position) const;
    /// Whether hides() or a frame's complaint() can ever give an answer.
    bool looksAtBoxes() const { return _looksAtBoxes; }
    /// How far vertical movements (DeformationSnapshot::movedHeight) move ground at most that lies between two heights above the zero
    /// height, metres.
    double verticalMovement(double lowest, double highest) const;
    /// Whether nothing but vertical movements moves what is in a sphere.
    bool movesVertically(const Ball& ball) const;
    /// A bounding sphere of a deformed sphere.
    Ball bound(const Ball& ball) const;
    /// A hull around a deformed box. `hull` receives the result; callers reuse it for speed. `fineness` is the largest
    /// margin wanted for each of the box's axes, as a share of the radius of the box's bounding sphere. The margin is
    /// larger where it would need too many points (by default, more than 8 cells along an axis).
    void bound(const EyeBox& box, Hull& hull, double fineness = 0.02) const;

    /// The distance, metres, that LOD ranges are compared with. At this distance the undeformed sphere would need the
    /// level of detail that the deformed one needs. `viewPoint` is in eye space. `bound` is the result of bound() for
    /// this sphere, if the caller has it.
    double lodDistance(const Ball& ball, const osg::Vec3d& viewPoint, const Ball* bound = nullptr) const;
    /// An upper limit of the distance, LOD scale included, that is compared with the ranges of a node with this
    /// bounding sphere. The limit makes finer triangles due where those of a tile, or of a mesh of one of its blocks,
    /// are too large for the deformation; elsewhere it is infinite.
    double lodLimit(const osg::LOD& node, const Ball& ball) const;
    /// The factor by which lodDistance() asks for more detail than the distance to the deformed sphere alone.
    double detail(const Ball& ball) const;

protected:
    ~DeformationChain() override;

private:
    /// How much larger the error of a tile becomes that levels of detail go by.
    double growthOf(const DeformationSnapshot& snapshot, const Ball& ball) const;
    double blockLimit(const osg::LOD& node, const Ball& ball) const;
    double longestEdge(const Ball& ball) const;

    std::vector<osg::ref_ptr<const DeformationSnapshot>> _snapshots;
    bool _looksAtBoxes = false;
    double _tileEdge = 0.0;
    double _tileError = 0.0;
    bool _ownTiles = true;
    bool _coarseTiles = false;
};

/// Whether a subgraph is deformed. This depends on the define GEOFX_DEFORMATION and on the program, in the state sets
/// from the root down to the subgraph. OSG's rules of inheritance apply, as on the GPU.
/// @ingroup effect
struct OSGGEOFX_EXPORT DeformationSwitch
{
    bool on = true;
    bool overridden = false;
    const osg::StateAttribute* program = nullptr; ///< the program in force, of any class
    bool programOverridden = false;
    /// Inherits from a state set on the way down; null changes nothing.
    void meet(const osg::StateSet* state);
};

/// The largest factor by which a matrix lengthens a vector (its spectral norm), rounded up so that bounds do not
/// shrink.
OSGGEOFX_EXPORT double largestScale(const osg::Matrixd& matrix);

/// The matrix that moves a rigid object to its deformed place, from eye space to eye space. The object is rotated only
/// if `turn` is true.
osg::Matrixd rigidPlacement(const DeformationChain& chain, const osg::Vec3d& reference, bool turn);

/// The modelview matrix of one of a billboard's drawables. `modelView` is that of the billboard. The drawable faces the
/// eye as seen from its deformed place. The result does not include the deformation itself.
osg::Matrixd billboardModelView(const DeformationChain& chain, const osg::Billboard& billboard,
                                unsigned int drawable, const osg::Matrixd& modelView);

} // namespace osgGeoFX
