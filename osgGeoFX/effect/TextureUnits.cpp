// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/TextureUnits.h>

#include <algorithm>
#include <map>
#include <optional>

namespace osgGeoFX
{

TextureUser::~TextureUser() = default;

namespace
{

/// Who has which units.
class Table
{
public:
    /// Where it is free for an effect that needs it there.
    bool isFree(int unit, std::size_t effect, bool everywhere) const
    {
        const auto [begin, end] = _taken.equal_range(unit);
        return std::all_of(begin, end,
                           [&](const auto& entry)
                           {
                               // Passes are drawn one after the other, each with its own textures.
                               const bool bothInPasses = !everywhere && !entry.second.everywhere;
                               return bothInPasses && entry.second.effect != effect;
                           });
    }
    std::optional<std::size_t> holder(int unit) const
    {
        const auto found = _taken.find(unit);
        if (found == _taken.end()) return std::nullopt;
        return found->second.effect;
    }
    void take(int unit, std::size_t effect, bool everywhere) { _taken.insert({unit, {effect, everywhere}}); }

private:
    struct Holder
    {
        std::size_t effect;
        bool everywhere;
    };
    std::multimap<int, Holder> _taken;
};

std::string nameOf(const Effect& effect, std::size_t place)
{
    return std::string(effect.className()) + " (effect " + std::to_string(place + 1) + " of the scene)";
}

} // namespace

Property TextureUnits::property(const std::string& name, const std::string& description)
{
    return Property::integer(name, description + "; -1 takes one that the scene's effects have free", -1,
                             last);
}

std::string TextureUnits::inconsistency(const std::vector<TextureUnitWish>& wishes)
{
    for (auto wish = wishes.begin(); wish != wishes.end(); ++wish)
    {
        if (wish->unit >= 0 && wish->unit < first)
            return std::string(wish->property) + " must be from " + std::to_string(first) + " to " +
                   std::to_string(last) + ", for the geometry has those below, or -1 for the scene's choice.";
        const auto same = std::find_if(wishes.begin(), wish,
                                       [&](const TextureUnitWish& each)
                                       { return each.unit >= 0 && each.unit == wish->unit; });
        if (same != wish) return std::string(same->property) + " and " + wish->property + " must differ.";
    }
    return {};
}

TextureUnits TextureUnits::of(const Effects& effects, int lowest)
{
    std::vector<std::vector<TextureUnitWish>> wishes(effects.size());
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        if (const auto* user = dynamic_cast<const TextureUser*>(effects[i].get()))
            wishes[i] = user->textureUnits();
        order.push_back(i);
    }
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t i) { return effects[i]->getEnabled(); });

    TextureUnits result;
    result.ofEffects.resize(effects.size());
    for (std::size_t i = 0; i < effects.size(); ++i)
        result.ofEffects[i].assign(wishes[i].size(), -1);
    Table table;
    const auto say = [&](std::size_t effect, const std::string& sentence)
    {
        if (effects[effect]->getEnabled()) result.sentences.push_back(sentence);
    };
    const auto eachWish = [&](const auto& action)
    {
        for (const std::size_t i : order)
        {
            for (std::size_t j = 0; j < wishes[i].size(); ++j)
                action(i, wishes[i][j], result.ofEffects[i][j]);
        }
    };
    // Several effects may read what the terrain has on one unit; no one else may have it.
    eachWish(
        [&](std::size_t effect, const TextureUnitWish& wish, int& unit)
        {
            if (!wish.ofTerrain) return;
            unit = wish.unit;
            table.take(unit, effect, true);
        });
    eachWish(
        [&](std::size_t effect, const TextureUnitWish& wish, int& unit)
        {
            if (wish.ofTerrain || wish.unit < 0) return;
            if (table.isFree(wish.unit, effect, wish.everywhere))
            {
                unit = wish.unit;
                table.take(unit, effect, wish.everywhere);
                return;
            }
            const std::size_t holder = table.holder(wish.unit).value_or(effect);
            say(effect, nameOf(*effects[effect], effect) + " cannot have texture unit " +
                            std::to_string(wish.unit) + " as its " + wish.property + ", for " +
                            nameOf(*effects[holder], holder) +
                            " has it; the scene gives it another one. Set one that is free, or -1 for the "
                            "scene's choice.");
        });
    eachWish(
        [&](std::size_t effect, const TextureUnitWish& wish, int& unit)
        {
            if (unit >= 0) return;
            const auto free = [&](int each)
            {
                return each != ofCover && table.isFree(each, effect, wish.everywhere);
            };
            int given = wish.preferred >= lowest && free(wish.preferred) ? wish.preferred : lowest;
            while (given <= last && !free(given))
                ++given;
            if (given > last) return;
            unit = given;
            table.take(unit, effect, wish.everywhere);
        });
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Units& units = result.ofEffects[i];
        result.complete.push_back(std::find(units.begin(), units.end(), -1) == units.end());
        if (result.complete.back()) continue;
        say(i, nameOf(*effects[i], i) + " is not drawn: the other effects have all texture units from " +
                   std::to_string(lowest) + " to " + std::to_string(last) +
                   ". Remove effects, or put the mappings of several sets into one.");
    }
    return result;
}

} // namespace osgGeoFX
