// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/FrameStamp>
#include <osg/Group>
#include <osgUtil/CullVisitor>

#include <array>
#include <atomic>
#include <mutex>
#include <string>

namespace osgGeoFX
{

class CameraEffects;
class Effect;
class EffectScene;

/// Finds what a program does to a scene that cannot come out right, or has no effect, and says so: one sentence for each cause,
/// once. Thread-safe.
class Misuse
{
public:
    enum Cause
    {
        SCALED_ABOVE,     ///< a transform above the scene scales
        LEVELS_ABOVE,     ///< a node with levels of detail stands above the scene
        EARTH_AS_PLANE,   ///< geocentric coordinates that nothing says are geocentric
        SCENE_IN_SCENE,   ///< a scene below another one
        TWO_TERRAINS,     ///< one scene draws two terrains
        MAP_MISSING,      ///< nothing has a texture on a deformation's mapUnit()
        STRAY_EFFECT,     ///< CameraEffects for an effect that no scene has
        OTHER_UNITS,      ///< CameraEffects draw an effect that has come to need other texture units
        NO_OTHER_SHADERS, ///< CameraEffects want other shaders, and a ShaderHost has one text
        CAUSES
    };

    /// A scene takes an effect, or gives it up.
    static void enter(const Effect& effect);
    static void leave(const Effect& effect);

    /// Looks at one camera that draws the scene with effects.
    void look(const EffectScene& scene, osgUtil::CullVisitor& outer, const ViewGeometry& view,
              const osg::Group& terrain);
    /// The scene is about to draw a terrain in a frame.
    void meet(const osg::Group& terrain, const osg::FrameStamp* frame);
    /// Looks at what a camera has of its own.
    void look(const CameraEffects& camera);
    /// Says a sentence, once for each cause.
    void say(Cause cause, const std::string& sentence);
    /// Whether something holds for so many looks on end that it does not end when tiles come.
    bool lasts(Cause cause, bool holds);
    /// Says nothing of a cause any more.
    void dismiss(Cause cause) { _said |= 1u << cause; }
    /// Whether there is nothing more to say of a cause.
    bool said(Cause cause) const { return (_said & 1u << cause) != 0; }

private:
    std::atomic<unsigned int> _said{0};
    std::array<std::atomic<unsigned int>, CAUSES> _looks{};
    std::mutex _mutex;
    const osg::Group* _terrain = nullptr; ///< the last one, only compared
    unsigned int _frame = 0;              ///< in which it was drawn
};

} // namespace osgGeoFX
