// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/scene/CameraRole.h>

#include <osg/Camera>
#include <osg/Object>

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace osgGeoFX
{

/** What EffectScenes do differently for one camera: its role, its depths, and effects that are off or have other
    values.

    The object is attached to the camera itself, so whoever owns the camera says it, without knowing the scenes.

    @code
    osgGeoFX::CameraEffects& left = osgGeoFX::CameraEffects::of(*leftCamera);
    left.setRole(osgGeoFX::CameraRole::like(*centerCamera));
    left.setEnabled(*closeUps, false);
    @endcode

    Change it between frames. Files keep none of its settings.

    @ingroup scene */
class OSGGEOFX_EXPORT CameraEffects : public osg::Object
{
public:
    CameraEffects() = default;
    CameraEffects(const CameraEffects& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, CameraEffects);

    /// The object of a camera. A camera that has none gets one.
    static CameraEffects& of(osg::Camera& camera);
    /// The object of a camera; null if it has none.
    static const CameraEffects* find(const osg::Camera& camera);

    /// The role of the camera in all scenes. A CameraRoleCallback of a scene may still decide otherwise.
    void setRole(const CameraRole& role) { _role = role; }
    /// Lets the scenes find the role again, as they do by default.
    void clearRole() { _role.reset(); }
    const std::optional<CameraRole>& getRole() const { return _role; }

    /// What depths this camera has, in the place of EffectScene::setDepthConvention(): for a shadow map or a picture in the
    /// picture whose depths are the projection's while the view's are logarithmic. A convention with a fault is refused:
    /// false, after a warning.
    bool setDepthConvention(const DepthConvention& convention);
    /// Lets the camera have the depths of the scenes again, as it does by default.
    void clearDepthConvention() { _depthConvention.reset(); }
    const std::optional<DepthConvention>& getDepthConvention() const { return _depthConvention; }

    /// Draws an effect of a scene for this camera, or leaves it out. An effect that is not enabled stays off. True, the
    /// default, also takes a replacement away.
    void setEnabled(const Effect& effect, bool on);
    /** Draws another effect in the place of an effect of a scene, such as a bend with other values.

        Both must be of one class, and must need the same texture units. A `replacement` that differs is refused: false, after a
        warning, which comes once for each class. Null takes a replacement away. Effects that need other shaders, for another
        curve or for styles, have programs of their own. A scene with a ShaderHost cannot have these, and says so. */
    bool setReplacement(const Effect& effect, Effect* replacement);
    /// What is drawn for this camera in the place of an effect: the effect itself, or another one.
    Effect* effectFor(Effect& effect) const;
    /// Whether setReplacement() takes the second one in the place of the first one.
    static bool mayReplace(const Effect& effect, const Effect& replacement);
    /// The first effect that something is set for and that a condition holds for; null where there is none.
    const Effect* find(const std::function<bool(const Effect&)>& condition) const;

protected:
    ~CameraEffects() override;

private:
    std::optional<CameraRole> _role;
    std::optional<DepthConvention> _depthConvention;
    std::map<osg::ref_ptr<const Effect>, osg::ref_ptr<Effect>> _replacements;
    std::set<std::string> _refused; ///< what a warning has told of
};

} // namespace osgGeoFX
