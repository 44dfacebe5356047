// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/observer_ptr>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <optional>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Close-ups by hand (paper: interactive close-ups, Section III.B).

    A click on a close-up or on its region, or the pointer over them, chooses it: it becomes active, and the others take an
    inactive look. A click beside all of them chooses none: then each looks as it did before. The key `u` cycles through the
    modes CLICK, HOVER and OFF. Shift and the left button drag a close-up in the plane parallel to the picture, in all modes.

    What the program itself does to CloseUp::setActivity() while one is chosen is lost. Serves one view, in its event
    traversal. */
class OSGGEOFX_EXPORT CloseUpHandler : public osgGA::GUIEventHandler
{
public:
    /// `closeUps` is an effect of the scene.
    CloseUpHandler(EffectScene& scene, CloseUps& closeUps);

    enum Mode
    {
        OFF,
        CLICK,
        HOVER ///< clicks as well
    };
    /// CLICK by default. OFF chooses none.
    void setMode(Mode mode);
    Mode getMode() const { return _mode; }
    /// The key that goes on to the next mode, of osgGA::GUIEventAdapter; `u` by default, 0 for none.
    void setModeKey(int key) { _modeKey = key; }
    int getModeKey() const { return _modeKey; }
    /// What those look like that are not chosen; ACTIVE is refused. DESATURATED by default.
    bool setInactiveLook(CloseUp::Activity look);
    CloseUp::Activity getInactiveLook() const { return _inactiveLook; }

    /// One of the effect's; null for none.
    void choose(CloseUp* closeUp);
    /// Null where none is.
    CloseUp* chosen() const;

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

protected:
    ~CloseUpHandler() override;

private:
    std::optional<CloseUpHit> pick(osgViewer::View& view, double x, double y) const;
    bool push(const osgGA::GUIEventAdapter& event, osgViewer::View& view);
    void drag(const osgGA::GUIEventAdapter& event, osgViewer::View& view);
    void dress();

    /// The left button is down: on nothing that matters, for a click, or on a close-up that it drags.
    enum Press
    {
        NONE,
        MAYBE_CLICK,
        DRAGS
    };

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<CloseUps> _closeUps;
    Mode _mode = CLICK;
    int _modeKey = 'u';
    CloseUp::Activity _inactiveLook = CloseUp::DESATURATED;
    osg::observer_ptr<CloseUp> _chosen;
    std::vector<std::pair<osg::observer_ptr<CloseUp>, CloseUp::Activity>> _former; ///< before one was chosen
    Press _press = NONE;
    osg::Vec2d _pressed;                ///< pixels
    osg::ref_ptr<CloseUp> _held;        ///< what is dragged
    osg::Vec3d _heldAt;                 ///< where it was taken, world
    osg::Vec3d _heldOffset;             ///< its offset then
    std::optional<osg::Vec2d> _pointer; ///< where it has moved to since the last frame
};

} // namespace osgGeoFX
