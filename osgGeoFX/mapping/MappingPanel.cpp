// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/MappingPanel.h>

#include <osgGeoFX/mapping/PointerPlace.h>
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

constexpr std::size_t pageRows = MappingPanelPicture::rows;
constexpr double opacitySteps = 20.0;
constexpr int mostOrder = 1000;
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

MappingPanel::MappingPanel(EffectScene& scene, osgText::Font* font) : _scene(&scene), _picture(font) {}

MappingPanel::~MappingPanel() = default;

void MappingPanel::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F9", "Toggle the list of mappings; with the list:");
    usage.addKeyboardMouseBinding("Up and Down", "Select a mapping; Page Up and Down, Home, End go farther");
    usage.addKeyboardMouseBinding("Alt + left button", "Select the topmost mapping below the pointer");
    usage.addKeyboardMouseBinding("Return", "Switch the selected mapping on or off");
    usage.addKeyboardMouseBinding("Left and Right", "Change the selected mapping's opacity");
    usage.addKeyboardMouseBinding("+ and -", "Raise or lower the selected mapping");
    usage.addKeyboardMouseBinding(", and .", "Change the selected mapping's blending");
}

bool MappingPanel::hasEffect() const
{
    return !effects().empty();
}

ProjectiveMapping* MappingPanel::selected()
{
    return _shown ? _selected.get() : nullptr;
}

std::vector<std::string> MappingPanel::lines() const
{
    if (!_shown) return {};
    const PanelPage shown = page();
    std::vector<std::string> result = {shown.count()};
    for (const PanelPage::Row& row : shown.rows)
    {
        result.push_back((row.on ? "on\t" : "off\t") + row.name + "\t" + row.order + "\t" + row.opacity +
                         "\t" + row.blending);
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
        if (_entries[_checked].mapping->getOrder() != _entries[_checked].order) return true;
    }
    return false;
}

void MappingPanel::list()
{
    _entries.clear();
    _listed.clear();
    for (ProjectiveMappings* effect : effects())
    {
        _listed.emplace_back(effect, effect->revision());
        const auto begin = static_cast<std::ptrdiff_t>(_entries.size());
        for (unsigned int i = effect->getNumMappings(); i-- > 0;)
        {
            ProjectiveMapping* mapping = effect->getMapping(i);
            _entries.push_back({mapping, effect, i, mapping->getOrder()});
        }
        std::stable_sort(_entries.begin() + begin, _entries.end(),
                         [](const Entry& a, const Entry& b) { return a.order > b.order; });
    }
}

void MappingPanel::relist()
{
    list();
    const auto found = std::find_if(_entries.begin(), _entries.end(),
                                    [&](const Entry& entry) { return entry.mapping == _selected.get(); });
    if (found != _entries.end())
        _cursor.row = static_cast<std::size_t>(found - _entries.begin());
    else
        // The one that took the place of what was removed.
        _cursor.row = _entries.empty() ? 0 : std::min(_cursor.row, _entries.size() - 1);
    _selected = _entries.empty() ? nullptr : _entries[_cursor.row].mapping.get();
    _cursor.first = std::min(_cursor.first, _entries.size() - std::min(_entries.size(), pageRows));
}

void MappingPanel::choose(std::size_t row)
{
    _cursor.choose(row, _entries.size());
    _selected = _entries.empty() ? nullptr : _entries[_cursor.row].mapping.get();
}

PanelPage MappingPanel::page() const
{
    PanelPage result;
    result.first = _cursor.first;
    result.selected = _cursor.row;
    result.total = _entries.size();
    const std::size_t last = std::min(_cursor.first + pageRows, _entries.size());
    for (std::size_t i = _cursor.first; i < last; ++i)
    {
        const Entry& entry = _entries[i];
        const ProjectiveMapping& mapping = *entry.mapping;
        const std::size_t mode = blendModeOf(*mapping.getTransfer());
        result.rows.push_back({mapping.getEnabled(), mapping.getEnabled() && entry.effect->getEnabled(),
                               nameOf(mapping, entry.number), std::to_string(mapping.getOrder()),
                               std::to_string(std::lround(mapping.getOpacity() * 100.0)) + " %",
                               mode < blendModes.size() ? blendModes[mode].name : "custom"});
    }
    return result;
}

void MappingPanel::hide()
{
    _shown = false;
    _picture.hide();
    // What is removed from now on need not wait for this list.
    _entries.clear();
    _listed.clear();
}

bool MappingPanel::change(int code, ProjectiveMapping& mapping)
{
    const auto raise = [&](int step)
    {
        mapping.setOrder(std::clamp(mapping.getOrder() + step, -mostOrder, mostOrder));
        relist();
        choose(_cursor.row);
    };
    const auto fade = [&](double step)
    {
        const double wanted = std::round(mapping.getOpacity() * opacitySteps + step) / opacitySteps;
        mapping.setOpacity(std::clamp(wanted, 0.0, 1.0));
    };
    switch (code)
    {
    case Event::KEY_Return:
    case Event::KEY_KP_Enter:
        mapping.setEnabled(!mapping.getEnabled());
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
        turnBlendMode(*mapping.getTransfer(), code == '.');
        return true;
    default:
        return false;
    }
}

bool MappingPanel::key(int code)
{
    if (_cursor.key(code, _entries.size()))
    {
        choose(_cursor.row);
        return true;
    }
    return _cursor.row < _entries.size() && change(code, *_entries[_cursor.row].mapping);
}

bool MappingPanel::pick(const Event& event, osgViewer::View& view)
{
    for (const auto& [effect, revision] : _listed)
    {
        if (!effect->getEnabled()) continue;
        const std::optional<osg::Vec3d> place = placeUnderPointer(*_scene, *effect, *view.getCamera(), event);
        if (!place) return false;
        const std::vector<ProjectiveMapping*> there = effect->mappingsAt({place->x(), place->y()});
        if (there.empty()) continue;
        const auto found = std::find_if(_entries.begin(), _entries.end(),
                                        [&](const Entry& entry) { return entry.mapping == there.front(); });
        if (found != _entries.end()) choose(static_cast<std::size_t>(found - _entries.begin()));
        return true;
    }
    return false;
}

bool MappingPanel::push(const Event& event, osgViewer::View& view)
{
    const bool leftButton = event.getButton() == Event::LEFT_MOUSE_BUTTON;
    if (const auto spot =
            _picture.spotAt(static_cast<double>(event.getX()), static_cast<double>(event.getY())))
    {
        if (leftButton && spot->row && *spot->row < _entries.size())
        {
            choose(*spot->row);
            if (spot->onBox) change(Event::KEY_Return, *_entries[_cursor.row].mapping);
        }
        return true;
    }
    const int modifiers = event.getModKeyMask();
    return leftButton && (modifiers & Event::MODKEY_ALT) && !(modifiers & Event::MODKEY_CTRL) &&
           pick(event, view);
}

bool MappingPanel::scroll(const Event& event)
{
    if (!_picture.spotAt(static_cast<double>(event.getX()), static_cast<double>(event.getY()))) return false;
    _cursor.scroll(event.getScrollingMotion(), _entries.size());
    return true;
}

bool MappingPanel::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    const Event::EventType type = event.getEventType();
    const bool toggled = type == Event::KEYDOWN && event.getKey() == Event::KEY_F9;
    if (toggled && _shown)
    {
        hide();
        action.requestRedraw();
        return true;
    }
    if (!_shown && (!toggled || !hasEffect())) return false;
    _shown = true;
    if (changed()) relist();
    if (_listed.empty())
    {
        // The last effect has gone.
        hide();
        return false;
    }
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    bool handled = false;
    switch (type)
    {
    case Event::KEYDOWN:
        handled = toggled || key(event.getKey());
        break;
    case Event::PUSH:
    case Event::DOUBLECLICK:
        _held = handled = view && push(event, *view);
        break;
    case Event::DRAG:
        return _held;
    case Event::RELEASE:
        // What began here is nothing for a camera manipulator.
        handled = _held;
        _held = false;
        return handled;
    case Event::SCROLL:
        handled = scroll(event);
        break;
    case Event::FRAME:
        // Once, however many keys came before it.
        if (view) _picture.show(*view, page(), words);
        return false;
    default:
        return false;
    }
    if (handled) action.requestRedraw();
    return handled;
}

} // namespace osgGeoFX
