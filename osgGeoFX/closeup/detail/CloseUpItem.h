// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUp.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/Vec4d>

#include <array>
#include <limits>

namespace osgGeoFX
{

/** One close-up as one camera draws it in one frame. Positions are in eye space, metres, unless a comment says
    otherwise. */
class CloseUpItem
{
public:
    /// `time` is the simulation time, seconds.
    CloseUpItem(const CloseUp& closeUp, const ViewGeometry& view, const osg::Matrixd& modelView,
                const DeformationChain& chain, double time);

    const CloseUp& closeUp() const { return *_closeUp; }
    /// The matrix from the region's frame (metres) to eye space, undeformed.
    const osg::Matrixd& regionToEye() const { return _regionToEye; }
    /// The matrix to places in the region (x and y −1…1, z metres above its base).
    const osg::Matrixd& toRegion() const { return _toRegion; }
    /// The matrix from a point of the ground to its place in the close-up; homogeneous.
    const osg::Matrixd& lift() const { return _lift; }
    bool parallel() const { return _parallel; }

    /// The place of a point of the ground in the close-up.
    osg::Vec3d lifted(const osg::Vec3d& position) const { return position * _lift; }
    /// The place of a vertex with the mask m on the deformed ground: the paper's C = m·M + (1 − m)·I.
    osg::Vec3d raised(const osg::Vec3d& position, const osg::Vec3d& bent, double mask) const
    {
        return bent + (lifted(position) - bent) * mask;
    }

    /// On a globe, a height in metres above the region's base: ground below it is on the other side of the planet.
    /// −infinity on a plane.
    double otherSide() const { return _otherSide; }
    /// Whether no part of a ball or a box is over the region. It may say no where it could say yes, never the
    /// reverse.
    bool outside(const Ball& ball) const;
    bool outside(const EyeBox& box) const;
    /// Includes the heights, above the base, of the part of a box that is over the region.
    void includeHeights(const EyeBox& box, double& lowest, double& highest) const;
    /// The corners, in the close-up, of the part of the region between two heights.
    std::array<osg::Vec3d, 8> liftedCorners(double lowest, double highest) const;
    /// The same part on the ground, widened by `beyond` metres on all sides.
    EyeBox groundBox(double lowest, double highest, double beyond = 0.0) const;

    bool showsCloseUp() const { return _closeUp->getActivity() != CloseUp::REGION_ONLY; }
    bool showsAnchor() const
    {
        return _closeUp->getActivity() == CloseUp::ACTIVE || _closeUp->getActivity() == CloseUp::DESATURATED;
    }
    bool stretched() const { return showsAnchor() && _closeUp->getAnchor()->getKind() == Anchor::STRETCHED; }
    /// Whether the masks of their vertices decide about whole triangles.
    bool cutByVertices() const { return _closeUp->getEdge() == CloseUp::PRIMITIVES; }
    /// Whether it needs more vertices: where a mask changes, or where magnified ground is to be round.
    bool wantsVertices() const
    {
        return stretched() || _closeUp->getEdge() == CloseUp::PRIMITIVES || _closeUp->getRoundness() > 0.0;
    }
    /// Whether its region is marked on the ground, by an anchor or by the line around it.
    bool marksGround() const { return showsAnchor() || _closeUp->getAnchor()->getLineWidth() > 0.0; }
    bool fenced() const { return showsAnchor() && _closeUp->getAnchor()->getKind() == Anchor::CONTOUR; }

    /// Where its data are in the textures that all close-ups share.
    struct Places
    {
        int mask = 0;                 ///< layer
        int maskSide = 1;             ///< texels
        int anchorRow = 0;            ///< row of the tables
        int tableRow = -1;            ///< row of the tables; −1 for none
        int surfaceLayer = -1;        ///< −1 for none
        int surfaceKind = 0;          ///< see SLOT_surfaceColor in stages/closeup.frag.glsl
        double low = 0.0, high = 1.0; ///< range of the table
        osg::Vec3d sun;               ///< direction in the frame of the surface data
    };
    static constexpr int rows = 16;
    using Values = std::array<osg::Vec4f, rows>;
    /// The item as stages/closeup.items.glsl reads it. `shift` moves the picture to its layer, in −1…1. `layers` are
    /// those of the close-up and of its anchor. A pixel's side has `samples` samples.
    Values values(const Places& places, const osg::Vec2d& shift, int layer, int anchorLayer,
                  int samples) const;

private:
    const CloseUp* _closeUp;
    osg::Matrixd _regionToEye, _toRegion, _lift;
    double _halfWidth, _halfDepth;
    double _otherSide = -std::numeric_limits<double>::infinity();
    bool _parallel = false;
};

} // namespace osgGeoFX
