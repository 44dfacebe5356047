// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/effect/Deformation.h>

namespace osgGeoFX
{

/// A close-up's lift as a deformation. It tells the levels of detail of a close-up that is drawn by itself.
class LiftSnapshot : public DeformationSnapshot
{
public:
    explicit LiftSnapshot(const CloseUpItem& item);

    osg::Vec3d deform(const osg::Vec3d& position) const override { return position * _lift; }
    osg::Vec3d undeform(const osg::Vec3d& position) const override { return position * _back; }
    osg::Vec3d deformNormal(const osg::Vec3d&, const osg::Vec3d& normal) const override { return normal; }
    Reach reach(const Ball&) const override { return Reach::Affine; }
    double lipschitz(const Ball&) const override { return _stretch; }
    Sag sag(const Ball&, const osg::Vec3d&) const override { return {}; }
    Uniforms uniforms() const override { return {}; }

protected:
    ~LiftSnapshot() override;

private:
    osg::Matrixd _lift, _back;
    double _stretch;
};

} // namespace osgGeoFX
