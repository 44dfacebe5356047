// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/MappingPanel.h>

#include <osgGeoFX/mapping/PointerPlace.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

constexpr double opacitySteps = 20.0;
const PanelWords words = {"Mappings",
                          "name",
                          "order",
                          "opacity",
                          "blending",
                          "Enter on/off   Left/Right opacity   +/- order",
                          "comma/period blending   Alt+click picks"};
/// Orders that are looked at in a frame, so that long lists cost no time while nothing happens.
constexpr std::size_t checkedInAFrame = 4096;

struct BlendMode
{
    const char* name;
    ColorTransfer::Equation equation;
    bool factors; ///< whether the equation uses them
    ColorTransfer::Factor source, destination;
};

constexpr auto sourceAlpha = ColorTransfer::SOURCE_ALPHA;
constexpr std::array<BlendMode, 8> blendModes = {
    {{"normal", ColorTransfer::ADD, true, sourceAlpha, ColorTransfer::ONE_MINUS_SOURCE_ALPHA},
     {"multiply", ColorTransfer::MULTIPLY, false, sourceAlpha, sourceAlpha},
     {"screen", ColorTransfer::SCREEN, false, sourceAlpha, sourceAlpha},
     {"overlay", ColorTransfer::OVERLAY, false, sourceAlpha, sourceAlpha},
     {"add", ColorTransfer::ADD, true, sourceAlpha, ColorTransfer::ONE},
     {"replace", ColorTransfer::ADD, true, ColorTransfer::ONE, ColorTransfer::ZERO},
     {"minimum", ColorTransfer::MINIMUM, false, sourceAlpha, sourceAlpha},
     {"maximum", ColorTransfer::MAXIMUM, false, sourceAlpha, sourceAlpha}}};

/// The number of modes where it is none of them.
std::size_t blendModeOf(const ColorTransfer& transfer)
{
    const auto found =
        std::find_if(blendModes.begin(), blendModes.end(),
                     [&](const BlendMode& mode)
                     {
                         return mode.equation == transfer.getEquation() &&
                                (!mode.factors || (mode.source == transfer.getSourceFactor() &&
                                                   mode.destination == transfer.getDestinationFactor()));
                     });
    return static_cast<std::size_t>(found - blendModes.begin());
}

void turnBlendMode(ColorTransfer& transfer, bool forward)
{
    const std::size_t count = blendModes.size();
    const std::size_t now = blendModeOf(transfer);
    // From a custom one to the first or the last.
    const std::size_t next = forward ? (now + 1 >= count ? 0 : now + 1) : (now == 0 ? count : now) - 1;
    const BlendMode& mode = blendModes[next];
    transfer.setEquation(mode.equation);
    if (mode.factors) transfer.setBlendFunction(mode.source, mode.destination);
}

std::string nameOf(const ProjectiveMapping& mapping, unsigned int number)
{
    if (!mapping.getName().empty()) return mapping.getName();
    if (const DataLayer* layer = mapping.getLayer())
    {
        if (!layer->getName().empty()) return layer->getName();
        if (layer->getImage() && !layer->getImage()->getFileName().empty())
            return osgDB::getSimpleFileName(layer->getImage()->getFileName());
    }
    return "mapping " + std::to_string(number + 1);
}

} // namespace

void MappingPanel::set(const Entry& entry, const char* property, double value)
{
    std::string none; // what is in range is taken
    entry.item->setProperty(property, value, none);
}

MappingPanel::MappingPanel(EffectScene& scene, osgText::Font* font)
    : ListPanel(Event::KEY_F9, words, PanelPicture::RIGHT, font), _scene(&scene)
{
}

MappingPanel::~MappingPanel() = default;

void MappingPanel::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F9", "Toggle the list of mappings; with the list:");
    usage.addKeyboardMouseBinding("Up and Down", "Select a row of the list");
    usage.addKeyboardMouseBinding("Page Up and Page Down, Home and End", "Go farther in the list");
    usage.addKeyboardMouseBinding("Alt + left button", "Select the topmost mapping below the pointer");
    usage.addKeyboardMouseBinding("Return", "Switch it, take the next choice, or the default");
    usage.addKeyboardMouseBinding("Left and Right", "Change a property by a step (Shift: ten), or opacity");
    usage.addKeyboardMouseBinding("+ and -", "Raise or lower the selected mapping");
    usage.addKeyboardMouseBinding(", and .", "Change it by a tenth of a step, or blending");
}

bool MappingPanel::hasEffect() const
{
    return !effects().empty();
}

ProjectiveMapping* MappingPanel::selected()
{
    return shown() ? dynamic_cast<ProjectiveMapping*>(_selected.get()) : nullptr;
}

std::vector<std::string> MappingPanel::lines() const
{
    if (!shown()) return {};
    const PanelPage rows = page();
    std::vector<std::string> result = {rows.count()};
    for (const PanelPage::Row& row : rows.rows)
    {
        result.push_back((row.on ? "on\t" : "off\t") + row.name + "\t" + row.order + "\t" + row.value + "\t" +
                         row.note);
    }
    return result;
}

/// The topmost first.
std::vector<ProjectiveMappings*> MappingPanel::effects() const
{
    std::vector<ProjectiveMappings*> found;
    for (unsigned int i = _scene->getNumEffects(); i-- > 0;)
    {
        if (auto* effect = dynamic_cast<ProjectiveMappings*>(_scene->getEffect(i))) found.push_back(effect);
    }
    return found;
}

bool MappingPanel::changed()
{
    const std::vector<ProjectiveMappings*> now = effects();
    const bool same = std::equal(now.begin(), now.end(), _listed.begin(), _listed.end(),
                                 [](const ProjectiveMappings* effect, const auto& listed)
                                 { return effect == listed.first && effect->revision() == listed.second; });
    if (!same) return true;
    for (std::size_t i = std::min(checkedInAFrame, _entries.size()); i > 0; --i)
    {
        _checked = (_checked + 1) % _entries.size();
        if (_entries[_checked].orderNow() != _entries[_checked].order) return true;
    }
    return false;
}

void MappingPanel::collect()
{
    _entries.clear();
    _listed.clear();
    for (ProjectiveMappings* effect : effects())
    {
        _listed.emplace_back(effect, effect->revision());
        const auto begin = static_cast<std::ptrdiff_t>(_entries.size());
        // Routes lie above mappings of their order.
        for (unsigned int i = effect->getNumRoutes(); i-- > 0;)
        {
            RouteMapping* route = effect->getRoute(i);
            _entries.push_back({route, nullptr, effect, i, route->getOrder()});
        }
        for (unsigned int i = effect->getNumMappings(); i-- > 0;)
        {
            ProjectiveMapping* mapping = effect->getMapping(i);
            _entries.push_back({mapping, mapping, effect, i, mapping->getOrder()});
        }
        std::stable_sort(_entries.begin() + begin, _entries.end(),
                         [](const Entry& a, const Entry& b) { return a.order > b.order; });
    }
}

void MappingPanel::list()
{
    collect();
    const auto found = std::find_if(_entries.begin(), _entries.end(),
                                    [&](const Entry& entry) { return entry.item == _selected.get(); });
    if (found != _entries.end())
        _cursor.row = static_cast<std::size_t>(found - _entries.begin());
    else
        // The one that took the place of what was removed.
        _cursor.row = _entries.empty() ? 0 : std::min(_cursor.row, _entries.size() - 1);
    _selected = _entries.empty() ? nullptr : _entries[_cursor.row].item.get();
    _cursor.first = std::min(_cursor.first, _entries.size() - std::min(_entries.size(), PanelPicture::rows));
}

void MappingPanel::choose(std::size_t number)
{
    ListPanel::choose(number);
    _selected = _entries.empty() ? nullptr : _entries[_cursor.row].item.get();
}

PanelPage::Row MappingPanel::row(std::size_t number) const
{
    const Entry& entry = _entries[number];
    std::string name = entry.item->getName(), note = "route";
    if (entry.mapping)
    {
        const std::size_t mode = blendModeOf(*entry.mapping->getTransfer());
        name = nameOf(*entry.mapping, entry.number);
        note = mode < blendModes.size() ? blendModes[mode].name : "custom";
    }
    else if (name.empty())
        name = "route " + std::to_string(entry.number + 1);
    return {entry.enabled(),
            entry.enabled() && entry.effect->getEnabled(),
            name,
            std::to_string(entry.orderNow()),
            std::to_string(std::lround(entry.item->getProperty("opacity") * 100.0)) + " %",
            note};
}

void MappingPanel::forget()
{
    _entries.clear();
    _listed.clear();
}

bool MappingPanel::change(int code, int)
{
    const Entry& entry = _entries[_cursor.row];
    const auto raise = [&](int step)
    {
        const Property& order = *entry.item->property("order");
        set(entry, "order",
            std::clamp(entry.orderNow() + static_cast<double>(step), order.minimum, order.maximum));
        list();
        choose(_cursor.row);
    };
    const auto fade = [&](double step)
    {
        const double wanted =
            std::round(entry.item->getProperty("opacity") * opacitySteps + step) / opacitySteps;
        set(entry, "opacity", std::clamp(wanted, 0.0, 1.0));
    };
    switch (code)
    {
    case Event::KEY_Return:
    case Event::KEY_KP_Enter:
        pressBox(_cursor.row);
        return true;
    case Event::KEY_Left:
        fade(-1.0);
        return true;
    case Event::KEY_Right:
        fade(1.0);
        return true;
    case '+':
    case '=': // the same key without Shift on many keyboards
    case Event::KEY_KP_Add:
        raise(1);
        return true;
    case '-':
    case Event::KEY_KP_Subtract:
        raise(-1);
        return true;
    case ',':
    case '.':
        if (entry.mapping) turnBlendMode(*entry.mapping->getTransfer(), code == '.');
        return true;
    default:
        return false;
    }
}

void MappingPanel::pressBox(std::size_t number)
{
    set(_entries[number], "enabled", _entries[number].enabled() ? 0.0 : 1.0);
}

bool MappingPanel::pushBeside(const Event& event, osgViewer::View& view)
{
    const int modifiers = event.getModKeyMask();
    if (event.getButton() != Event::LEFT_MOUSE_BUTTON || !(modifiers & Event::MODKEY_ALT) ||
        (modifiers & Event::MODKEY_CTRL))
        return false;
    for (const auto& [effect, revision] : _listed)
    {
        if (!effect->getEnabled()) continue;
        const std::optional<osg::Vec3d> place = placeUnderPointer(*_scene, *effect, *view.getCamera(), event);
        if (!place) return false;
        const std::vector<ProjectiveMapping*> there = effect->mappingsAt({place->x(), place->y()});
        if (there.empty()) continue;
        const RouteMapping* const route = effect->routeOf(*there.front());
        const auto found = std::find_if(
            _entries.begin(), _entries.end(),
            [&](const Entry& entry) { return route ? entry.item == route : entry.mapping == there.front(); });
        if (found != _entries.end()) choose(static_cast<std::size_t>(found - _entries.begin()));
        return true;
    }
    return false;
}

} // namespace osgGeoFX
