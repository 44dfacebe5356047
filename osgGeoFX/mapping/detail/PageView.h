// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DrawableCompanion.h>
#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/mapping/detail/PageCut.h>
#include <osgGeoFX/scene/detail/Visibility.h>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <functional>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/// The frame of the mappings, and how a camera looks at it.
struct PageFrame
{
    osg::Matrixd toEye; ///< from the frame to the view's eye space
    osg::Matrixd fromEye;
    bool globe = false;
    double curvature = 0.0;                                        ///< one over the radius of the globe, 1/m
    std::function<osg::Vec3d(const osg::Vec3d& position)> placeOf; ///< both within the frame
    std::function<osg::Vec3d(const osg::Vec3d& place)> positionOf;
    double pixel = 0.0;         ///< what a pixel spans at a metre from the eye, metres
    double pixelAnywhere = 0.0; ///< and at any distance beside that
};

/// Notes the boxes of the drawables that a camera's culling has found in sight. It draws nothing.
class PageWatch final : public DrawableCompanion
{
public:
    void start() override
    {
        _boxes.clear();
        _boundless = false;
    }
    osg::Drawable* companion(osg::Drawable& drawable, const osg::Matrixd& modelView) override;
    osg::StateSet* state() override { return nullptr; }
    bool standing() const override { return true; }

    /// Undeformed, in the view's eye space.
    const std::vector<EyeBox>& boxes() const { return _boxes; }
    /// Whether something is drawn that nobody knows the place of.
    bool boundless() const { return _boundless; }

private:
    std::vector<EyeBox> _boxes;
    bool _boundless = false;
};

/// What a camera sees of a part of the plane. For one thread at a time.
class PageView final : public PageSight
{
public:
    /// `mapped`: beyond it nothing lies. `isEmpty`: whether nothing lies on a part of it.
    using IsEmpty = std::function<bool(const PlaneBox& box)>;
    PageView(const PlaneBox& mapped, IsEmpty isEmpty, const ScenePass& pass, const PageFrame& frame);

    /// The ground below the boxes, as far as something may lie there.
    std::vector<SeenGround> groundBelow(const std::vector<EyeBox>& boxes);
    /// Whether groundBelow() has met what reaches beyond that.
    bool beyond() const { return _beyond; }

    bool empty(const PlaneBox& box) override { return _isEmpty(box); }
    bool shows(const SeenGround& ground) override;
    double texel(const SeenGround& ground) override;

private:
    /// A box in the frame around a part of the ground.
    void bound(const SeenGround& ground, osg::Vec3d& low, osg::Vec3d& high) const;
    EyeBox eyeBox(const osg::Vec3d& low, const osg::Vec3d& high) const;
    /// Lowers a distance to the least one of a box as it is drawn, cut in halves so many times at most.
    void approach(const osg::Vec3d& low, const osg::Vec3d& high, int cuts, double& least) const;

    const PlaneBox _mapped;
    const IsEmpty _isEmpty;
    const ScenePass& _pass;
    const PageFrame& _frame;
    Visibility _visibility;
    osg::Vec3d _eye; ///< in the view's eye space
    bool _beyond = false;
};

} // namespace osgGeoFX
