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

/// A request of an effect for one texture unit.
/// @ingroup effect
struct TextureUnitWish
{
    const char* property = ""; ///< the name of the property that sets it
    int unit = -1;             ///< the unit that the property sets; −1 lets the scene choose one
    int preferred = 4;         ///< the unit to choose if it is free
    /// Whether the unit is used wherever the scene draws, or only in the effect's own passes.
    bool everywhere = true;
    /// Whether the terrain itself has its texture on this unit, so that no other unit would do.
    bool ofTerrain = false;
};

/** The second base class of an effect that uses textures. Its EffectScene assigns units to all its effects, so that
    no effect takes another's. SurfaceView and ScenePass hold the assigned units in the order of the requests.

    @ingroup effect */
class OSGGEOFX_EXPORT TextureUser
{
public:
    /// The requests of this effect.
    virtual std::vector<TextureUnitWish> textureUnits() const = 0;

protected:
    TextureUser() = default;
    TextureUser(const TextureUser&) = default;
    TextureUser& operator=(const TextureUser&) = default;
    virtual ~TextureUser();
};

/** The texture units of a scene's effects.

    Units 0 to 3 belong to the geometry. On unit 7, tiles of terrain databases have the texture that tells what lies
    on the ground. The scene gives none of them to an effect that does not ask for it.

    Requests for a certain unit come first. Enabled effects come before those that are switched off. Then all other
    requests follow in the same order: each gets the unit that it prefers, or else the lowest free unit.

    @ingroup effect */
struct OSGGEOFX_EXPORT TextureUnits
{
    static constexpr int first = 4, last = 31;
    static constexpr int ofCover = 7;

    using Effects = std::vector<osg::ref_ptr<Effect>>;
    using Units = std::vector<int>;

    std::vector<Units> ofEffects;       ///< for each effect, in the order of its requests
    std::vector<bool> complete;         ///< whether each effect has all units that it needs
    std::vector<std::string> sentences; ///< the requests of enabled effects that could not be met

    /// Assigns units to the effects of a scene. `lowest`: of those that it may choose, `first` to `last`.
    static TextureUnits of(const Effects& effects, int lowest = first);
    /// A property for a unit; −1, the default, is for the scene's choice.
    static Property property(const std::string& name, const std::string& description);
    /// A sentence if an effect's own requests do not fit each other, or if one is for a unit of the geometry.
    static std::string inconsistency(const std::vector<TextureUnitWish>& wishes);
};

} // namespace osgGeoFX
