// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osg/ref_ptr>
#include <osgGA/GUIEventHandler>
#include <osgText/Font>
#include <osgViewer/View>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

class EffectScene;
class PanoramaMap;

/** The bending curve of a scene's panorama map in the lower right corner of the window, to be changed by hand: the distance
    from the picture's base to the horizon to the right, the height in the picture up.

    F4 shows and hides it; all other input works only while it is shown. The left button drags the curve's points
    (PanoramaMap::setCurvePoints()), and sets a new one where it is pressed on the curve; the right button or Delete removes
    a point. Below are the exaggerations at the base and at the horizon; the right button on the latter makes it that of the
    base again. "Reset" removes all points and the horizon's own exaggeration. The picture follows while the pointer moves.

    It shows the first panorama map of the scene that is switched on, with its projection. Where there is none, a sentence
    says so. One panel serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT CurvePanel : public osgGA::GUIEventHandler
{
public:
    /// `font` is for the texts. Null: the font of OSG's own handlers, fonts/arial.ttf or its substitute.
    explicit CurvePanel(EffectScene& scene, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    bool shown() const { return _shown; }
    /// The map that the panel changes now; null if there is none.
    PanoramaMap* map() const;
    /// The texts shown, UTF-8, from above. Empty while the panel is hidden.
    std::vector<std::string> lines() const;

protected:
    ~CurvePanel() override;

private:
    class Painter;
    struct Content;
    Content content() const;
    bool push(const osgGA::GUIEventAdapter& event, const osg::Viewport& port);
    bool removeHeld();
    void show(osgViewer::View& view);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Camera> _overlay;
    bool _shown = false;
    bool _held = false; ///< a button went down on the panel and is still held
    struct Selection;
    std::unique_ptr<Selection> _selection;
    std::unique_ptr<Content> _drawn;
};

} // namespace osgGeoFX
