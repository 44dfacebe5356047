// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/SunKeys.h>

#include <osgGeoFX/viewer/Overlay.h>

#include <osg/Math>
#include <osg/NodeVisitor>

#include <cstdio>

namespace osgGeoFX
{

namespace
{

constexpr double step = 1800.0; ///< seconds of the clock
constexpr double secondsShown = 2.0;

class SunFinder : public osg::NodeVisitor
{
public:
    SunFinder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::LightSource& node) override
    {
        if (!found) found = dynamic_cast<SunLight*>(&node);
        traverse(node);
    }
    osg::ref_ptr<SunLight> found;
};

osg::ref_ptr<osgText::Text> makeText(const std::string& line)
{
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setCharacterSize(18.0f);
    text->setPosition(osg::Vec3(10.0f, 34.0f, 0.0f)); // above the coordinates below the pointer
    text->setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    text->setBackdropType(osgText::Text::OUTLINE);
    text->setBackdropColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    text->setText(line, osgText::String::ENCODING_UTF8);
    return text;
}

} // namespace

SunKeys::SunKeys(osg::Node& scene)
{
    SunFinder finder;
    scene.accept(finder);
    _sun = finder.found;
}

void SunKeys::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("j and J", "Move the sun by half an hour, on and back");
}

std::string SunKeys::text() const
{
    return _overlay && _overlay->getNodeMask() ? _text->getText().createUTF8EncodedString() : std::string();
}

bool SunKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!_sun || !view) return false;
    if (event.getEventType() == osgGA::GUIEventAdapter::FRAME)
    {
        if (_overlay && _overlay->getNodeMask())
        {
            showOverlay(*view, _overlay, 10);
            if (event.getTime() >= _until) _overlay->setNodeMask(0);
        }
        return false;
    }
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN ||
        (event.getKey() != 'j' && event.getKey() != 'J'))
        return false;
    ClockTime time = _sun->getTime();
    time.time += event.getKey() == 'j' ? step : -step;
    _sun->setTime(time);
    char line[128];
    std::snprintf(line, sizeof line, "%s  sun %.0f° high, at %.0f°", textOf(time).c_str(),
                  osg::RadiansToDegrees(_sun->position().elevation),
                  osg::RadiansToDegrees(_sun->position().azimuth));
    _until = event.getTime() + secondsShown;
    if (!view->getCamera()->getViewport()) return true;
    showOverlay(*view, _overlay, 10);
    // A new one each time: OSG would write over a buffer that it has told drivers not to expect changes of.
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _text = makeText(line);
    _overlay->addChild(_text);
    return true;
}

} // namespace osgGeoFX
