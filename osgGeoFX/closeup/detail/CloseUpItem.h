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

/** One close-up as one camera has it in one frame. All positions in eye space, metres, unless they say otherwise. */
class CloseUpItem
{
public:
    /// `time` is the simulation's, seconds.
    CloseUpItem(const CloseUp& closeUp, const ViewGeometry& view, const osg::Matrixd& modelView,
                const DeformationChain& chain, double time);

    const CloseUp& closeUp() const { return *_closeUp; }
    /// From the region's frame (metres) to eye space, undeformed.
    const osg::Matrixd& regionToEye() const { return _regionToEye; }
    /// To places in the region (−1…1) and metres above its base.
    const osg::Matrixd& toRegion() const { return _toRegion; }
    /// From a point of the ground to its place in the close-up; homogeneous.
    const osg::Matrixd& lift() const { return _lift; }
    bool parallel() const { return _parallel; }

    /// Where a point of the ground is in the close-up.
    osg::Vec3d lifted(const osg::Vec3d& position) const { return position * _lift; }
    /// Where a vertex goes whose mask is m: the paper's C = m·M + (1 − m)·I, on the deformed ground.
    osg::Vec3d raised(const osg::Vec3d& position, const osg::Vec3d& bent, double mask) const
    {
        return bent + (lifted(position) - bent) * mask;
    }

    /// On a globe the height, metres above the region's base, below which ground is the planet's other side; else −infinity.
    double otherSide() const { return _otherSide; }
    /// Whether nothing of a ball, or a box, is over the region; false negatives only.
    bool outside(const Ball& ball) const;
    bool outside(const EyeBox& box) const;
    /// Heights above the base of what of a box is over the region.
    void includeHeights(const EyeBox& box, double& lowest, double& highest) const;
    /// Corners of the part of the region between two heights, in the close-up.
    std::array<osg::Vec3d, 8> liftedCorners(double lowest, double highest) const;
    /// The same on the ground, widened by `beyond` metres to all sides.
    EyeBox groundBox(double lowest, double highest, double beyond = 0.0) const;

    bool showsCloseUp() const { return _closeUp->getActivity() != CloseUp::REGION_ONLY; }
    bool showsAnchor() const
    {
        return _closeUp->getActivity() == CloseUp::ACTIVE || _closeUp->getActivity() == CloseUp::DESATURATED;
    }
    bool stretched() const { return showsAnchor() && _closeUp->getAnchor()->getKind() == Anchor::STRETCHED; }
    /// Whether its triangles are cut whole, by the masks of their vertices.
    bool cutByVertices() const { return _closeUp->getEdge() == CloseUp::PRIMITIVES; }
    /// Whether it lacks vertices: where a mask changes, or where what is magnified is to be round.
    bool wantsVertices() const
    {
        return stretched() || _closeUp->getEdge() == CloseUp::PRIMITIVES || _closeUp->getRoundness() > 0.0;
    }
    /// Whether something is drawn from its region on the ground: an anchor, or the line around it.
    bool marksGround() const { return showsAnchor() || _closeUp->getAnchor()->getLineWidth() > 0.0; }
    bool fenced() const { return showsAnchor() && _closeUp->getAnchor()->getKind() == Anchor::CONTOUR; }

    /// What it needs of the textures that all share.
    struct Places
    {
        int mask = 0;                 ///< layer
        int maskSide = 1;             ///< texels
        int anchorRow = 0;            ///< of the tables
        int tableRow = -1;            ///< of the tables; −1 for none
        int surfaceLayer = -1;        ///< −1 for none
        int surfaceKind = 0;          ///< see SLOT_surfaceColor in stages/closeup.frag.glsl
        double low = 0.0, high = 1.0; ///< range of the table
        osg::Vec3d sun;               ///< in the frame of the surface data
    };
    static constexpr int rows = 16;
    using Values = std::array<osg::Vec4f, rows>;
    /// The item as stages/closeup.items.glsl reads it. `shift` takes the picture to its layer, in −1…1, and `layers` are its
    /// own and its anchor's; `samples` stand along a pixel's side.
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
