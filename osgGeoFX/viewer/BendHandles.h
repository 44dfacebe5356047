// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/BendOnGround.h>

#include <osg/Camera>
#include <osg/Vec2d>
#include <osgGA/GUIEventHandler>
#include <osgText/Font>
#include <osgViewer/View>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Handles in the picture to drag a bend with: where its zone begins and ends, the horizon, the angle.

    The left button drags them up and down. A handle stands on the place that it moves, and follows the pointer; what it changes is a
    property of the effect, as a list of properties (EffectPanel) shows it:

    | bend | on the first line | on the second line | above |
    | --- | --- | --- | --- |
    | BirdsEyeView | focusLine | contextTilt | horizonLine |
    | PedestrianView | focusDistance | zoneWidth | bendAngle |

    Of a BlendedView they change the view that is in force. Values that the effect refuses leave it as it is; a handle that would lie outside
    the picture stands at its border. While they are shown, the bend's zoneLines are on.

    The key d shows and hides them; at first they are hidden. One handler serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT BendHandles : public osgGA::GUIEventHandler
{
public:
    /// `font`: null for that of OSG's own handlers.
    explicit BendHandles(EffectScene& scene, osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    void setShown(bool shown);
    bool shown() const { return _shown; }

    struct Handle
    {
        osg::ref_ptr<PropertyHolder> holder; ///< the bend, or the part of it that is in force
        std::string property;
        osg::Vec2d place; ///< that it moves, pixels from the viewport's lower left corner; may lie outside
        osg::Vec2d knob;  ///< where it is drawn
        osg::Vec3d
            world; ///< the ground that it stands on, in the frame of the scene's children; of horizonLine, nothing
    };
    /// Those of the last frame; none while they are hidden, or if there is no bend.
    const std::vector<Handle>& handles() const { return _handles; }

protected:
    ~BendHandles() override;

private:
    void find(const osgViewer::View& view);
    void show(osgViewer::View& view);
    bool push(const osg::Vec2d& pixel);
    void drag(const osgViewer::View& view, const osg::Vec2d& pixel);
    void useLines(PerspectiveBend* bend);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Camera> _overlay;
    bool _shown = false;
    double _share = 1.0; ///< how far behind the zone the angle's handle stands, of the zone's width
    std::vector<Handle> _handles;
    std::optional<std::size_t> _held;
    osg::Vec2d _offset;                   ///< from the pointer to the place
    osg::ref_ptr<PerspectiveBend> _lined; ///< whose lines were switched on
    std::string _drawn;                   ///< what the overlay shows, in words
};

} // namespace osgGeoFX
