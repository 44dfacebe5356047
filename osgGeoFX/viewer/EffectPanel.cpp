// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/EffectPanel.h>

#include <osgGeoFX/viewer/EffectKinds.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

const PanelWords words = {"Effects",
                          "property",
                          "",
                          "value",
                          "unit",
                          "Left/Right change   with Shift ten times",
                          "comma/period a tenth   Enter switch, default"};

/// Ranges that are wider tell nothing of what is usual.
constexpr double longestRange = 1000.0;

bool isSwitch(const Property& property)
{
    return property.kind == Property::Kind::Flag || property.kind == Property::Kind::Choice;
}

/// 1, 2 or 5 times a power of ten, at most `length`.
double roundLength(double length)
{
    const double power = std::pow(10.0, std::floor(std::log10(length) + 1e-9));
    const double share = length / power;
    return power * (share < 2.0 - 1e-9 ? 1.0 : share < 5.0 - 1e-9 ? 2.0 : 5.0);
}

/// The multiple of `size` that lies so many of them away, with as few digits as it has.
double multiple(double value, double size, double count)
{
    const double number = std::round(value / size) + count;
    return size < 1.0 ? number / std::round(1.0 / size) : number * size;
}

void put(PropertyHolder& holder, const Property& property, double value)
{
    std::string error;
    // What does not fit the others is left as it is.
    holder.setProperty(property.name, value, error);
}

} // namespace

EffectPanel::EffectPanel(EffectScene& scene, osgText::Font* font)
    : ListPanel(Event::KEY_F10, words, PanelPicture::LEFT, font), _scene(&scene)
{
}

EffectPanel::~EffectPanel() = default;

double EffectPanel::stepped(const Property& property, double value, double steps)
{
    if (isSwitch(property))
    {
        // One further, round and round, however long the step would be.
        const double count = property.maximum - property.minimum + 1.0;
        return property.minimum +
               std::fmod(value - property.minimum + std::copysign(1.0, steps) + count, count);
    }
    if (property.kind == Property::Kind::Integer)
        return std::clamp(value + (std::abs(steps) < 1.0 ? std::copysign(1.0, steps) : steps),
                          property.minimum, property.maximum);
    const bool isAngle = property.kind == Property::Kind::Angle;
    const double unit = isAngle ? osg::PI / 180.0 : 1.0;
    const double range = std::min((property.maximum - property.minimum) / unit, longestRange);
    const double usual = std::abs(property.defaultValue) / unit;
    const double size = roundLength((usual < 1e-3 * range ? range : usual) / 10.0);
    const double own = std::abs(steps) < 1.0 ? size / 10.0 : size;
    const double count = std::abs(steps) < 1.0 ? std::copysign(1.0, steps) : steps;
    const double result = multiple(value / unit, own, count);
    return std::clamp(isAngle ? osg::DegreesToRadians(result) : result, property.minimum, property.maximum);
}

void EffectPanel::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F10", "Toggle the list of effects; with the list:");
    usage.addKeyboardMouseBinding("Up and Down", "Select a row of the list");
    usage.addKeyboardMouseBinding("Page Up and Page Down, Home and End", "Go farther in the list");
    usage.addKeyboardMouseBinding("Left and Right", "Change a property by a step (Shift: ten), or opacity");
    usage.addKeyboardMouseBinding(", and .", "Change it by a tenth of a step, or blending");
    usage.addKeyboardMouseBinding("Return", "Switch it, take the next choice, or the default");
}

void EffectPanel::addButton(const std::string& text, std::function<void()> press)
{
    _buttons.push_back({text, std::move(press)});
}

std::vector<std::string> EffectPanel::lines() const
{
    if (!shown()) return {};
    const PanelPage rows = page();
    std::vector<std::string> result = {rows.count()};
    for (const PanelPage::Row& row : rows.rows)
        result.push_back(row.name + "\t" + row.value + "\t" + row.note);
    return result;
}

bool EffectPanel::changed()
{
    if (!_rowsAbove || _listed.size() != _scene->getNumEffects()) return true;
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
    {
        if (_listed[i] != _scene->getEffect(i)) return true;
    }
    return false;
}

void EffectPanel::add(PropertyHolder& holder, const Effect& effect, const std::string& prefix)
{
    const std::string inside = prefix + "  ";
    for (const Property& property : holder.properties())
    {
        const bool first = property.name == "enabled";
        _entries.push_back(
            {&holder, &property, first ? prefix + kindOf(holder) : inside + property.name, &effect});
    }
    for (const PropertyHolder::Part& part : holder.parts())
        add(*part.object, effect, inside);
}

void EffectPanel::list()
{
    const Property* selected = _cursor.row < _entries.size() ? _entries[_cursor.row].property : nullptr;
    const PropertyHolder* holder = selected ? _entries[_cursor.row].holder.get() : nullptr;
    _entries.clear();
    _listed.clear();
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
    {
        Effect& effect = *_scene->getEffect(i);
        _listed.emplace_back(&effect);
        add(effect, effect, "");
    }
    const auto found = std::find_if(_entries.begin(), _entries.end(),
                                    [&](const Entry& entry)
                                    { return entry.holder == holder && entry.property == selected; });
    const auto row = static_cast<std::size_t>(found - _entries.begin());
    // A button's row moves with the number of entries before it.
    const bool onButton = _rowsAbove && _cursor.row >= *_rowsAbove;
    const std::size_t moved = onButton ? _cursor.row - *_rowsAbove + _entries.size() : _cursor.row;
    _rowsAbove = _entries.size();
    _cursor.choose(found == _entries.end() ? moved : row, size());
}

PanelPage::Row EffectPanel::row(std::size_t number) const
{
    if (number >= _entries.size())
    {
        PanelPage::Row button{};
        button.box = true;
        button.inForce = true;
        button.name = _buttons[number - _entries.size()].text;
        return button;
    }
    const Entry& entry = _entries[number];
    const double value = entry.property->get(*entry.holder);
    PanelPage::Row row{};
    row.box = entry.property->kind == Property::Kind::Flag;
    row.on = row.box && value != 0.0;
    row.inForce = entry.effect->getEnabled();
    row.name = entry.label;
    row.value = entry.property->text(value);
    row.note = entry.property->textUnit();
    return row;
}

void EffectPanel::forget()
{
    _entries.clear();
    _listed.clear();
    _rowsAbove.reset();
}

void EffectPanel::step(const Entry& entry, double steps)
{
    put(*entry.holder, *entry.property, stepped(*entry.property, entry.property->get(*entry.holder), steps));
}

void EffectPanel::press(const Entry& entry)
{
    if (isSwitch(*entry.property))
        step(entry, 1.0);
    else
        put(*entry.holder, *entry.property, entry.property->defaultValue);
}

bool EffectPanel::change(int code, int modifiers)
{
    if (_cursor.row >= _entries.size())
    {
        if (code != Event::KEY_Return && code != Event::KEY_KP_Enter) return false;
        _buttons[_cursor.row - _entries.size()].press();
        return true;
    }
    const Entry& entry = _entries[_cursor.row];
    const double steps = modifiers & Event::MODKEY_SHIFT ? 10.0 : 1.0;
    switch (code)
    {
    case Event::KEY_Left:
        step(entry, isSwitch(*entry.property) ? -1.0 : -steps);
        return true;
    case Event::KEY_Right:
        step(entry, isSwitch(*entry.property) ? 1.0 : steps);
        return true;
    case ',':
        step(entry, -0.1);
        return true;
    case '.':
        step(entry, 0.1);
        return true;
    case Event::KEY_Return:
    case Event::KEY_KP_Enter:
        press(entry);
        return true;
    default:
        return false;
    }
}

void EffectPanel::pressBox(std::size_t number)
{
    if (number >= _entries.size())
        _buttons[number - _entries.size()].press();
    else if (isSwitch(*_entries[number].property))
        press(_entries[number]);
}

} // namespace osgGeoFX
