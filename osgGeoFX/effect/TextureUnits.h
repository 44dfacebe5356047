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
    /// Whether the effect draws without this unit, too, in another way. Such requests are met after all others, and a
    /// unit of −1 tells that there is none left.
    bool optional = false;
};

/// A request of an effect for the binding point of one uniform block.
/// @ingroup effect
struct UniformBlockWish
{
    const char* property = ""; ///< the name of the property that sets it
    int binding = -1;          ///< the binding point that the property sets; −1 lets the scene choose one
    int preferred = 7;         ///< the binding point to choose if it is free
};

/** The second base class of an effect that uses textures or uniform blocks. Its EffectScene assigns units and binding
    points to all its effects, so that no effect takes another's. SurfaceView and ScenePass hold the assigned ones in
    the order of the requests.

    @ingroup effect */
class OSGGEOFX_EXPORT TextureUser
{
public:
    /// The requests of this effect for texture units.
    virtual std::vector<TextureUnitWish> textureUnits() const = 0;
    /// Its requests for uniform blocks; none by default.
    virtual std::vector<UniformBlockWish> uniformBlocks() const { return {}; }

protected:
    TextureUser() = default;
    TextureUser(const TextureUser&) = default;
    TextureUser& operator=(const TextureUser&) = default;
    virtual ~TextureUser();
};

/** The texture units of a scene's effects, and the binding points of their uniform blocks.

    Units 0 to 3 belong to the geometry. On unit 7, tiles of terrain databases have the texture that tells what lies
    on the ground. The scene gives none of them to an effect that does not ask for it.

    Requests for a certain unit come first. Enabled effects come before those that are switched off. Then all other
    requests follow in the same order: each gets the unit that it prefers, or else the lowest free unit. What effects can
    do without comes last. Binding points are given out in the same way. Every effect has its own ones.

    @ingroup effect */
struct OSGGEOFX_EXPORT TextureUnits
{
    static constexpr int first = 4, last = 31;
    static constexpr int ofCover = 7;
    /// The lowest binding point that a scene chooses by itself, and the last one that every GPU has.
    static constexpr int firstBlock = 7, lastBlock = 35;

    using Effects = std::vector<osg::ref_ptr<Effect>>;
    using Units = std::vector<int>;

    std::vector<Units> ofEffects; ///< for each effect, in the order of its requests
    std::vector<Units>
        ofBlocks; ///< for each effect, the binding points of its blocks, in the order of its requests
    std::vector<bool> complete; ///< whether each effect has all units and binding points that it needs
    std::vector<std::string> sentences; ///< the requests of enabled effects that could not be met

    /// Assigns units and binding points to the effects of a scene. `lowest`, `lowestBlock`: of those that it may choose,
    /// `first` to `last` and 0 to `lastBlock`.
    static TextureUnits of(const Effects& effects, int lowest = first, int lowestBlock = firstBlock);
    /// The same with those texture units that it may choose, ascending.
    static TextureUnits of(const Effects& effects, const Units& choice, int lowestBlock = firstBlock);
    /// A property for a unit; −1, the default, is for the scene's choice.
    static Property property(const std::string& name, const std::string& description);
    /// The same for the binding point of a uniform block.
    static Property blockProperty(const std::string& name, const std::string& description);
    /// A sentence if an effect's own requests do not fit each other, or if one is for a unit of the geometry.
    static std::string inconsistency(const std::vector<TextureUnitWish>& wishes);
};

} // namespace osgGeoFX
