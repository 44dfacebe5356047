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

/** Handles close-ups with the mouse (paper: interactive close-ups, Section III.B).

    A click on a close-up or on its region chooses it. In the mode HOVER the pointer chooses it, too. The chosen
    close-up becomes active and all others get an inactive look. A click elsewhere chooses none, and each close-up gets
    back its former look. The key `u` cycles through the modes CLICK, HOVER and OFF. Shift and the left button drag a
    close-up parallel to the image plane, in all modes.

    Changes that the program makes with CloseUp::setActivity() while a close-up is chosen are lost. A handler serves
    one view and works in its event traversal.
    @ingroup closeup */
class OSGGEOFX_EXPORT CloseUpHandler : public osgGA::GUIEventHandler
{
public:
    /// `closeUps` must be an effect of `scene`.
    CloseUpHandler(EffectScene& scene, CloseUps& closeUps);

    enum Mode
    {
        OFF,
        CLICK,
        HOVER ///< the pointer and clicks choose
    };
    /// Default: CLICK. OFF chooses none.
    void setMode(Mode mode);
    Mode getMode() const { return _mode; }
    /// The key that switches to the next mode, as in osgGA::GUIEventAdapter. 0 means none. Default: `u`.
    void setModeKey(int key) { _modeKey = key; }
    int getModeKey() const { return _modeKey; }
    /// The look of close-ups that are not chosen. ACTIVE is refused with false and a warning. Default: DESATURATED.
    bool setInactiveLook(CloseUp::Activity look);
    CloseUp::Activity getInactiveLook() const { return _inactiveLook; }

    /// Chooses a close-up of the effect. A null pointer chooses none.
    void choose(CloseUp* closeUp);
    /// The chosen close-up. Null if none is chosen.
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
