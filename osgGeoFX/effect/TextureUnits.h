// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/Effect.h>

#include <osg/ref_ptr>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// A texture unit that an effect needs.
struct TextureUnitWish
{
    const char* property = ""; ///< that a person sets it with
    int unit = -1;             ///< the one that was set; −1 where the scene is to give one
    int preferred = 4;         ///< which one to give, if it is free
    /// Whether it is in force for all that the scene draws, or in the effect's own passes alone.
    bool everywhere = true;
    /// Whether the terrain itself has its texture there, so that no other unit would do.
    bool ofTerrain = false;
};

/** What an effect is that has textures. Its EffectScene gives units to all its effects, so that none takes another's;
    what it gave comes with SurfaceView and ScenePass, in the order of the wishes. */
class OSGGEOFX_EXPORT TextureUser
{
public:
    virtual std::vector<TextureUnitWish> textureUnits() const = 0;

protected:
    TextureUser() = default;
    TextureUser(const TextureUser&) = default;
    TextureUser& operator=(const TextureUser&) = default;
    virtual ~TextureUser();
};

/** The texture units of a scene's effects.

    Units 0 to 3 are the geometry's, and unit 7 is the one on which tiles of terrain databases say what lies on the ground;
    neither is given to an effect that does not ask for it. Units that were set come first, enabled effects before those that
    are switched off, then the others in the same order: each gets the one that it prefers or the lowest that is
    free. */
struct OSGGEOFX_EXPORT TextureUnits
{
    static constexpr int first = 4, last = 31;
    static constexpr int ofCover = 7;

    using Effects = std::vector<osg::ref_ptr<Effect>>;
    using Units = std::vector<int>;

    std::vector<Units> ofEffects;       ///< for each effect, in the order of its wishes
    std::vector<bool> complete;         ///< whether each effect has all that it needs
    std::vector<std::string> sentences; ///< of what could not be had, by effects that are enabled

    static TextureUnits of(const Effects& effects);
    /// A property for one: −1, the default, for the scene's choice.
    static Property property(const std::string& name);
    /// A sentence where an effect's own wishes do not fit each other, or where one is for a unit of the geometry.
    static std::string inconsistency(const std::vector<TextureUnitWish>& wishes);
};

} // namespace osgGeoFX
