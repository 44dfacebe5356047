// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/TextureUnits.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace osgGeoFX
{

TextureUser::~TextureUser() = default;

namespace
{

/// A request for a number of one kind: a texture unit, or a binding point.
struct Wish
{
    const char* property;
    int wanted, preferred;
    bool everywhere, ofTerrain, optional;
};
using Wishes = std::vector<std::vector<Wish>>; ///< of each effect

/// Numbers of one kind.
struct Kind
{
    const char* one;         ///< "texture unit"
    std::vector<int> choice; ///< what may be chosen, ascending
    int reserved;            ///< is given only to who asks for it; −1 for none
};

std::vector<int> range(int lowest, int last)
{
    std::vector<int> numbers(static_cast<std::size_t>(last - lowest + 1));
    std::iota(numbers.begin(), numbers.end(), lowest);
    return numbers;
}

std::string nameOf(const Effect& effect, std::size_t place)
{
    return std::string(effect.className()) + " (effect " + std::to_string(place + 1) + " of the scene)";
}

/// Gives numbers of one kind to effects.
class Giver
{
public:
    Giver(const TextureUnits::Effects& effects, const std::vector<std::size_t>& order, const Wishes& wishes,
          const Kind& kind, TextureUnits& result)
        : _effects(effects), _order(order), _wishes(wishes), _kind(kind), _result(result)
    {
        for (const auto& each : wishes)
            _given.emplace_back(each.size(), -1);
    }

    std::vector<TextureUnits::Units> give()
    {
        // Several effects may read what the terrain has on one unit; no one else may have it.
        eachWish(
            [&](std::size_t effect, const Wish& wish, int& number)
            {
                if (wish.ofTerrain) take(number = wish.wanted, effect, true);
            });
        eachWish(
            [&](std::size_t effect, const Wish& wish, int& number)
            {
                if (wish.ofTerrain || wish.wanted < 0) return;
                if (isFree(wish.wanted, effect, wish.everywhere))
                    take(number = wish.wanted, effect, wish.everywhere);
                else
                    refuse(effect, wish);
            });
        for (const bool optional : {false, true})
        {
            eachWish(
                [&](std::size_t effect, const Wish& wish, int& number)
                {
                    if (number < 0 && wish.optional == optional) choose(effect, wish, number);
                });
        }
        std::vector<bool> complete(_effects.size(), true);
        eachWish([&](std::size_t effect, const Wish& wish, int& number)
                 { complete[effect] = complete[effect] && (number >= 0 || wish.optional); });
        for (std::size_t i = 0; i < _effects.size(); ++i)
        {
            if (!complete[i]) leaveOut(i);
        }
        return _given;
    }

private:
    template<typename Action>
    void eachWish(const Action& action)
    {
        for (const std::size_t i : _order)
        {
            for (std::size_t j = 0; j < _wishes[i].size(); ++j)
                action(i, _wishes[i][j], _given[i][j]);
        }
    }

    /// Where it is free for an effect that needs it there.
    bool isFree(int number, std::size_t effect, bool everywhere) const
    {
        const auto [begin, end] = _taken.equal_range(number);
        return std::all_of(begin, end,
                           [&](const auto& entry)
                           {
                               // Passes are drawn one after the other, each with its own textures.
                               const bool bothInPasses = !everywhere && !entry.second.everywhere;
                               return bothInPasses && entry.second.effect != effect;
                           });
    }
    void take(int number, std::size_t effect, bool everywhere)
    {
        _taken.insert({number, {effect, everywhere}});
    }

    void choose(std::size_t effect, const Wish& wish, int& number)
    {
        const auto free = [&](int each)
        {
            return each != _kind.reserved && isFree(each, effect, wish.everywhere);
        };
        const std::vector<int>& choice = _kind.choice;
        auto chosen = std::find(choice.begin(), choice.end(), wish.preferred);
        if (chosen == choice.end() || !free(*chosen))
            chosen = std::find_if(choice.begin(), choice.end(), free);
        if (chosen != choice.end()) take(number = *chosen, effect, wish.everywhere);
    }

    void say(std::size_t effect, const std::string& sentence)
    {
        if (_effects[effect]->getEnabled()) _result.sentences.push_back(sentence);
    }
    void refuse(std::size_t effect, const Wish& wish)
    {
        const std::size_t holder = _taken.find(wish.wanted)->second.effect;
        say(effect, nameOf(*_effects[effect], effect) + " cannot have " + _kind.one + " " +
                        std::to_string(wish.wanted) + " as its " + wish.property + ", for " +
                        nameOf(*_effects[holder], holder) +
                        " has it; the scene gives it another one. Set one that is free, or -1 for the "
                        "scene's choice.");
    }
    void leaveOut(std::size_t effect)
    {
        _result.complete[effect] = false;
        const bool any = !_kind.choice.empty();
        say(effect, nameOf(*_effects[effect], effect) + " is not drawn: " +
                        (any ? "the other effects have all " + std::string(_kind.one) + "s from " +
                                   std::to_string(_kind.choice.front()) + " to " +
                                   std::to_string(_kind.choice.back()) + " that the scene may choose"
                             : "there is no " + std::string(_kind.one) + " that the scene may choose") +
                        ". Remove effects, or put the mappings of several sets into one.");
    }

    struct Holder
    {
        std::size_t effect;
        bool everywhere;
    };

    const TextureUnits::Effects& _effects;
    const std::vector<std::size_t>& _order;
    const Wishes& _wishes;
    const Kind& _kind;
    TextureUnits& _result;
    std::vector<TextureUnits::Units> _given;
    std::multimap<int, Holder> _taken;
};

} // namespace

Property TextureUnits::property(const std::string& name, const std::string& description)
{
    return Property::integer(name, description + "; -1 takes one that the scene's effects have free", -1,
                             last);
}

Property TextureUnits::blockProperty(const std::string& name, const std::string& description)
{
    return Property::integer(name, description + "; -1 takes one that the scene's effects have free", -1,
                             lastBlock);
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

TextureUnits TextureUnits::of(const Effects& effects, int lowest, int lowestBlock)
{
    return of(effects, range(lowest, last), lowestBlock);
}

TextureUnits TextureUnits::of(const Effects& effects, const Units& choice, int lowestBlock)
{
    Wishes units(effects.size()), blocks(effects.size());
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        order.push_back(i);
        const auto* user = dynamic_cast<const TextureUser*>(effects[i].get());
        if (!user) continue;
        for (const TextureUnitWish& wish : user->textureUnits())
            units[i].push_back(
                {wish.property, wish.unit, wish.preferred, wish.everywhere, wish.ofTerrain, wish.optional});
        for (const UniformBlockWish& wish : user->uniformBlocks())
            blocks[i].push_back({wish.property, wish.binding, wish.preferred, true, false, false});
    }
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t i) { return effects[i]->getEnabled(); });
    TextureUnits result;
    result.complete.assign(effects.size(), true);
    const Kind unit = {"texture unit", choice, ofCover};
    const Kind block = {"uniform block binding", range(lowestBlock, lastBlock), -1};
    result.ofEffects = Giver(effects, order, units, unit, result).give();
    result.ofBlocks = Giver(effects, order, blocks, block, result).give();
    return result;
}

} // namespace osgGeoFX
