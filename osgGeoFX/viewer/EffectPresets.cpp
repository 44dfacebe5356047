// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/EffectPresets.h>

#include <osgGeoFX/viewer/EffectKinds.h>

#include <nlohmann/json.hpp>
#include <osg/Math>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const char* const userValue = "geofx.presets";

struct Found
{
    osg::ref_ptr<PropertyHolder> holder;
    const Property* property = nullptr;
};

/// What a setting names; empty, with a sentence, if there is no such thing.
std::optional<Found> find(const std::vector<osg::ref_ptr<Effect>>& effects, const std::string& name,
                          std::string& error)
{
    const std::size_t point = name.find('.');
    std::string kind = name.substr(0, point);
    std::size_t number = 1;
    if (const std::size_t bracket = kind.find('['); bracket != std::string::npos)
    {
        const std::string digits = kind.substr(bracket + 1, kind.size() - bracket - 2);
        const bool good = kind.back() == ']' && !digits.empty() && digits.size() < 5 &&
                          digits.find_first_not_of("0123456789") == std::string::npos;
        number = good ? std::stoul(digits) : 0;
        kind.resize(bracket);
    }
    if (point == std::string::npos || number == 0)
    {
        error = "\"" + name +
                "\" names no property; write the kind of an effect and its property, such as "
                "\"birdsEyeView.focusLine\", or \"birdsEyeView[2].focusLine\" for the second of the kind.";
        return std::nullopt;
    }
    std::size_t left = number;
    osg::ref_ptr<PropertyHolder> holder;
    std::string kinds;
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        kinds += (kinds.empty() ? "" : ", ") + kindOf(*effect);
        if (kindOf(*effect) == kind && --left == 0) holder = effect;
        if (holder) break;
    }
    if (!holder)
    {
        error = "\"" + name + "\" names an effect that the scene has not; it has " +
                (kinds.empty() ? "none" : kinds) + ".";
        return std::nullopt;
    }
    std::string rest = name.substr(point + 1);
    for (std::size_t next = rest.find('.'); next != std::string::npos; next = rest.find('.'))
    {
        const std::vector<PropertyHolder::Part> parts = holder->parts();
        const auto part =
            std::find_if(parts.begin(), parts.end(),
                         [&](const PropertyHolder::Part& each) { return each.name == rest.substr(0, next); });
        if (part == parts.end()) break;
        holder = part->object;
        rest.erase(0, next + 1);
    }
    const Property* const property = holder->property(rest);
    if (!property)
    {
        error = "\"" + name + "\": " + kindOf(*holder) + " has no property \"" + rest + "\".";
        return std::nullopt;
    }
    return Found{holder, property};
}

std::vector<osg::ref_ptr<Effect>> effectsOf(EffectScene& scene)
{
    std::vector<osg::ref_ptr<Effect>> effects;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
        effects.emplace_back(scene.getEffect(i));
    return effects;
}

void addSettings(PropertyHolder& holder, const std::string& prefix, PropertyHolder::Texts& settings)
{
    for (const Property& property : holder.properties())
        settings.emplace_back(prefix + property.name, property.text(property.get(holder)));
    for (const PropertyHolder::Part& part : holder.parts())
        addSettings(*part.object, prefix + part.name + ".", settings);
}

} // namespace

EffectPreset EffectPreset::of(EffectScene& scene, const std::string& name)
{
    EffectPreset preset{name, {}};
    std::map<std::string, int> seen;
    for (const osg::ref_ptr<Effect>& effect : effectsOf(scene))
    {
        const std::string kind = kindOf(*effect);
        const int number = ++seen[kind];
        addSettings(*effect, kind + (number > 1 ? "[" + std::to_string(number) + "]" : std::string()) + ".",
                    preset.settings);
    }
    return preset;
}

std::vector<EffectPreset> EffectPreset::read(const EffectScene& scene, std::string& error)
{
    std::string text;
    std::vector<EffectPreset> presets;
    if (!scene.getUserValue(userValue, text)) return presets;
    try
    {
        for (const auto& each : nlohmann::json::parse(text))
        {
            EffectPreset preset{each.at("name").get<std::string>(), {}};
            for (const auto& setting : each.at("set"))
                preset.settings.emplace_back(setting.at(0).get<std::string>(),
                                             setting.at(1).get<std::string>());
            presets.push_back(preset);
        }
        return presets;
    }
    catch (const nlohmann::json::exception& fault)
    {
        error = "The scene's presets (user value " + std::string(userValue) +
                ") cannot be read; write them with EffectPreset::write(). " + fault.what();
        return {};
    }
}

void EffectPreset::write(EffectScene& scene, const std::vector<EffectPreset>& presets)
{
    nlohmann::json all = nlohmann::json::array();
    for (const EffectPreset& preset : presets)
    {
        nlohmann::json settings = nlohmann::json::array();
        for (const auto& [property, value] : preset.settings)
            settings.push_back({property, value});
        all.push_back({{"name", preset.name}, {"set", settings}});
    }
    // A text that is no UTF-8 is a text all the same.
    scene.setUserValue(userValue, all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string EffectPreset::fault(const std::vector<osg::ref_ptr<Effect>>& effects, const std::string& property,
                                const std::string& value)
{
    std::string error;
    const std::optional<Found> found = find(effects, property, error);
    double number = 0.0;
    if (!found || !found->property->parse(value, number, error)) return error;
    return {};
}

std::optional<PresetBlend> PresetBlend::begin(EffectScene& scene, const EffectPreset& preset,
                                              std::string& error)
{
    PresetBlend blend;
    const std::vector<osg::ref_ptr<Effect>> effects = effectsOf(scene);
    for (const auto& [name, text] : preset.settings)
    {
        const std::optional<Found> found = find(effects, name, error);
        double value = 0.0;
        if (!found || !found->property->parse(text, value, error))
        {
            error.insert(0, "The preset \"" + preset.name + "\" cannot be shown: ");
            return std::nullopt;
        }
        std::vector<Change>& changes = blend._changes[found->holder];
        // The last of two counts.
        changes.erase(std::remove_if(changes.begin(), changes.end(),
                                     [&](const Change& each) { return each.property == found->property; }),
                      changes.end());
        changes.push_back({found->property, found->property->get(*found->holder), value});
    }
    return blend;
}

double PresetBlend::Change::at(double share) const
{
    if (share >= 1.0) return to;
    if (share <= 0.0) return from;
    const bool hasOwnMeaning = property->minimum == -1.0 && (from == -1.0 || to == -1.0);
    switch (property->kind)
    {
    case Property::Kind::Flag:
    case Property::Kind::Choice:
    case Property::Kind::Integer:
        return share < 0.5 ? from : to;
    case Property::Kind::Color:
    {
        const osg::Vec3d before = unpackedColor(static_cast<int>(from)),
                         after = unpackedColor(static_cast<int>(to));
        return packedColor(before + (after - before) * share);
    }
    case Property::Kind::Angle:
    {
        const double circle = 2.0 * osg::PI;
        // A direction, and not an arc.
        if (!(property->minimum < 0.0) || property->maximum - property->minimum < circle - 1e-9) break;
        double value = from + std::remainder(to - from, circle) * share;
        if (value < property->minimum) value += circle;
        if (value > property->maximum) value -= circle;
        return value;
    }
    default:
        break;
    }
    if (hasOwnMeaning) return share < 0.5 ? from : to;
    return from + (to - from) * share;
}

bool PresetBlend::set(double share, std::string& error) const
{
    const double part = std::clamp(share, 0.0, 1.0);
    const double smooth = part * part * (3.0 - 2.0 * part);
    std::string sentences;
    for (const auto& [holder, changes] : _changes)
    {
        std::map<std::string, double> values;
        for (const Change& change : changes)
            values[change.property->name] = change.at(smooth);
        std::string sentence;
        if (!holder->setProperties(values, sentence)) sentences += (sentences.empty() ? "" : " ") + sentence;
    }
    error = sentences;
    return sentences.empty();
}

} // namespace osgGeoFX
