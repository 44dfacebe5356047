// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/Geometry>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <optional>
#include <vector>

namespace osgGeoFX
{

/** Takes liberties with regions of the ground by hand, in any view of a scene: plain, bent, or a panorama map.

    The key `k` makes the ground below the pointer the center of a new RegionalLiberty, which comes before the scene's bend
    or panorama map. While it is edited, its outline is shown on the ground. A drag with the left button that begins within
    the outline gives its radius; its base is then the lowest ground of the outline. [ and ] enlarge it less and more, { and }
    turn it, ; and ' make it narrower and wider. EffectPanel (F10) shows all its properties. `k` on it ends the editing, on
    another one edits that one. Delete removes the one below the pointer.

    One handler serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT LibertyHandler : public osgGA::GUIEventHandler
{
public:
    explicit LibertyHandler(EffectScene& scene) : _scene(&scene) {}

    /// The liberty that is edited. Null if none is.
    RegionalLiberty* edited() const { return _edited.get(); }
    /// Edits a liberty of the scene. A null pointer ends the editing.
    void edit(RegionalLiberty* liberty);
    /// The outline as it was last shown, pixels of the viewport from its lower left corner. Points that are not known,
    /// since there is no ground, are missing. Empty while nothing is edited.
    std::vector<osg::Vec2d> outline() const;

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

protected:
    ~LibertyHandler() override;

private:
    class Ground;
    using Point = std::optional<osg::Vec2d>;

    RegionalLiberty* at(const Ground& ground, const osg::Vec3d& world) const;
    bool press(int key, osgViewer::View& view);
    void begin(const Ground& ground, const osg::Vec3d& world, double away);
    bool change(int key);
    bool push(const osgGA::GUIEventAdapter& event, osgViewer::View& view);
    void drag(osgViewer::View& view);
    void lower(const Ground& ground);
    void show(osgViewer::View& view);
    void hide();
    void draw();

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<RegionalLiberty> _edited;
    osg::Vec2d _pointer; ///< pixels of the viewport
    bool _drags = false, _dragged = false;
    std::vector<std::optional<osg::Vec3d>>
        _ring;                   ///< of the undeformed ground, in the frame of the scene's children
    std::vector<double> _ringOf; ///< the values that it was made for
    int _age = 0;                ///< frames since then
    std::vector<Point> _outline;
    osg::ref_ptr<osg::Camera> _overlay;
    std::vector<osg::ref_ptr<osg::Geometry>> _lines; ///< a dark one below a light one
};

} // namespace osgGeoFX
