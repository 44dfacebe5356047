// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/PresetKeys.h>

#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/detail/OverlayShapes.h>

#include <osg/Notify>
#include <osgViewer/View>

namespace osgGeoFX
{

namespace
{

constexpr double secondsShown = 3.0;

osg::ref_ptr<osgText::Text> makeText(const std::string& line, const osg::Viewport& port)
{
    const double size = 1.3 * overlayTextSize(port.height());
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setCharacterSize(static_cast<float>(size));
    text->setPosition(osg::Vec3(osg::Vec3d(0.5 * port.width(), port.height() - 2.5 * size, 0.0)));
    text->setAlignment(osgText::Text::CENTER_BASE_LINE);
    text->setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    text->setBackdropType(osgText::Text::OUTLINE);
    text->setBackdropColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    text->setText(line, osgText::String::ENCODING_UTF8);
    return text;
}

} // namespace

PresetKeys::PresetKeys(EffectScene& scene, double seconds) : _scene(&scene), _seconds(seconds)
{
    std::string error;
    _presets = EffectPreset::read(scene, error);
    if (!error.empty()) OSG_WARN << "osgGeoFX: " << error << std::endl;
}

void PresetKeys::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("p and P", "Blend to the next preset, or to the one before");
}

std::string PresetKeys::text() const
{
    return _words;
}

void PresetKeys::step(std::ptrdiff_t by, double time)
{
    const auto count = static_cast<std::ptrdiff_t>(_presets.size());
    // The first key leads to the first one, or to the last.
    const std::ptrdiff_t from = _current ? static_cast<std::ptrdiff_t>(*_current) : by > 0 ? -1 : 0;
    _current = static_cast<std::size_t>((from + by + count) % count);
    const EffectPreset& preset = _presets[*_current];
    std::string error;
    _blend = PresetBlend::begin(*_scene, preset, error);
    _start = time;
    _until = time + secondsShown;
    _words = _blend ? preset.name : error;
    _text = nullptr;
}

bool PresetKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (_presets.empty()) return false;
    using Event = osgGA::GUIEventAdapter;
    if (event.getEventType() == Event::KEYDOWN && (event.getKey() == 'p' || event.getKey() == 'P'))
    {
        step(event.getKey() == 'p' ? 1 : -1, event.getTime());
        action.requestRedraw();
        return true;
    }
    if (event.getEventType() != Event::FRAME) return false;
    const double time = event.getTime();
    if (_blend)
    {
        const double share = _seconds > 0.0 ? (time - _start) / _seconds : 1.0;
        std::string error;
        if (!_blend->set(share, error) && share >= 1.0)
        {
            // Between two presets values may not fit for a while; in the end they should.
            _words = error;
            _text = nullptr;
        }
        if (share >= 1.0) _blend.reset();
        action.requestRedraw();
    }
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (time >= _until) _words.clear();
    if (!view || !view->getCamera()->getViewport()) return false;
    if (_words.empty())
    {
        if (_overlay) _overlay->setNodeMask(0u);
        return false;
    }
    const bool fresh = showOverlay(*view, _overlay, 10);
    if (!fresh && _text) return false;
    // A new one each time: OSG would write over a buffer that it has told drivers not to expect changes of.
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _text = makeText(_words, *_overlay->getViewport());
    _overlay->addChild(_text);
    return false;
}

} // namespace osgGeoFX
