// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/BendOnGround.h>

#include <osgGeoFX/scene/DeformedView.h>

namespace osgGeoFX
{

std::optional<BendOnGround> BendOnGround::of(EffectScene& scene, const osg::Camera& camera)
{
    return of(scene, camera.getViewMatrix(), camera.getProjectionMatrix());
}

std::optional<BendOnGround> BendOnGround::of(EffectScene& scene, const osg::Matrixd& view,
                                             const osg::Matrixd& projection)
{
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        Effect& effect = *scene.getEffect(i);
        const Deformation* const deformation = effect.isActive() ? effect.asDeformation() : nullptr;
        if (!deformation || !deformation->isProjection()) continue;
        // The first projection of the list is in force, and no other.
        auto* const bend = dynamic_cast<PerspectiveBend*>(&effect);
        if (!bend) return std::nullopt;
        const DeformedView picture(scene, view, projection, 1.0, 1.0);
        const ViewGeometry geometry(picture.modelView(), projection, picture.ground());
        const std::optional<BendPlacement> place = bend->placement(geometry);
        if (!place || place->angle == 0.0 || !bend->snapshot(geometry)) return std::nullopt;
        osg::Matrixd toWorld;
        toWorld.invert(picture.modelView());
        BendOnGround result;
        result.bend = bend;
        result.place = *place;
        result.up = osg::Matrixd::transform3x3(geometry.up, toWorld);
        result.foot = toWorld.getTrans() - result.up * place->planeHeight;
        const osg::Vec3d right = osg::Matrixd::transform3x3(osg::Vec3d(1.0, 0.0, 0.0), toWorld);
        result.forward = result.up ^ (right - result.up * (right * result.up));
        if (result.forward.normalize() <= 0.0) return std::nullopt;
        result.right = result.forward ^ result.up;
        return result;
    }
    return std::nullopt;
}

} // namespace osgGeoFX
