// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/LayerClock.h>

#include <osg/Camera>
#include <osg/ref_ptr>
#include <osgGA/GUIEventHandler>
#include <osgText/Font>
#include <osgViewer/View>

#include <memory>
#include <string>

namespace osgGeoFX
{

/** A bar for the time of a scene's layers (LayerClock) along the lower edge of the window.

    F3 hides and shows it; at first it is shown. The left button drags the time, and pauses the clock where it goes on; the button
    at the left end, or the key y, plays and pauses. `x` and `X` double and halve the speed, the right button on the bar turns the
    direction round, and a click on the text at the right end switches the loop. Keys work while the bar is hidden, too. One bar
    serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT TimeBar : public osgGA::GUIEventHandler
{
public:
    /// `font` is for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    explicit TimeBar(LayerClock& clock, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    bool shown() const { return _shown; }
    /// The texts shown, UTF-8: the time, then the speed and what happens at the end. Empty while the bar is hidden.
    std::string text() const;

protected:
    ~TimeBar() override;

private:
    struct Layout;
    struct Content;
    bool key(int code);
    bool push(const osgGA::GUIEventAdapter& event, double x, double y, const Layout& layout);
    void letGo();
    void drag(double x, const Layout& layout);
    Content content() const;
    void show(osgViewer::View& view);

    osg::ref_ptr<LayerClock> _clock;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Camera> _overlay;
    bool _shown = true;
    bool _held = false;    ///< a button went down on the bar and is still held
    bool _dragged = false; ///< on the track
    bool _plays = false;   ///< whether the clock goes on when the time is let go
    std::unique_ptr<Content> _drawn;
};

} // namespace osgGeoFX
