// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/viewer/ViewOrientation.h>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Font>
#include <osgViewer/View>

#include <memory>
#include <string>

namespace osgGeoFX
{

/** A compass and a picture of the ground from the side, in the lower right corner of the window.

    The dial turns so that up in the picture is up on the dial: N shows where north of the undeformed map lies, as seen from the
    camera, whatever a bend does to the ground ahead. Below it stands the heading. Beside it, the ground is drawn from the side as the
    effects have bent it, with the eye, what the picture takes in, and the angle at which the middle of each part is seen: focus white,
    transition zone amber, context blue; 90° is from above, 0° from the edge (ViewOrientation).

    The key o shows and hides it; at first it is hidden. One handler serves one view, in its event traversal.
    @ingroup viewer */
class OSGGEOFX_EXPORT Compass : public osgGA::GUIEventHandler
{
public:
    /// `reference`: for true north on a projected terrain; null for the grid's. `font`: null for that of OSG's own handlers.
    explicit Compass(EffectScene& scene, const Georeference* reference = nullptr,
                     osgText::Font* font = nullptr);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    void setShown(bool shown);
    bool shown() const { return _shown; }
    /// The numbers shown: the heading and the pitch, then the angles of the parts in sight, such as "40° -30° 35° 20° 3°".
    /// Empty while it is hidden, and if nothing in the picture points upwards.
    std::string text() const;

protected:
    ~Compass() override;

private:
    struct Content;
    void show(osgViewer::View& view);
    void draw(const Content& content);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<const Georeference> _reference;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Camera> _overlay;
    bool _shown = false;
    std::unique_ptr<Content> _drawn;
};

} // namespace osgGeoFX
