// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/viewer/CornerOverlay.h>
#include <osgGeoFX/viewer/ViewOrientation.h>

#include <osgText/Font>

#include <memory>
#include <string>

namespace osgGeoFX
{

/** A compass and a picture of the ground from the side, in the lower right corner of the window.

    The dial turns so that up in the picture is up on the dial: N shows where north of the undeformed map lies, as seen from the
    camera, whatever a bend does to the ground ahead. Below it stands the heading. Beside it, the ground is drawn from the side as the
    effects have bent it, with the eye, what the picture takes in, and the angle at which the middle of each part is seen: focus white,
    transition zone amber, context blue; 90° is from above, 0° from the edge (ViewOrientation).

    The key o shows and hides it.
    @ingroup viewer */
class OSGGEOFX_EXPORT Compass : public CornerOverlay
{
public:
    /// `reference`: for true north on a projected terrain; null for the grid's. `font`: null for that of OSG's own handlers.
    explicit Compass(EffectScene& scene, const Georeference* reference = nullptr,
                     osgText::Font* font = nullptr);

    /// The numbers shown: the heading and the pitch, then the angles of the parts in sight, such as "40° -30° 35° 20° 3°".
    /// Empty while it is hidden, and if nothing in the picture points upwards.
    std::string text() const;

protected:
    ~Compass() override;

private:
    struct Content;
    void show(osgViewer::View& view) override;
    void draw(const Content& content);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<const Georeference> _reference;
    osg::ref_ptr<osgText::Font> _font;
    std::unique_ptr<Content> _drawn;
};

} // namespace osgGeoFX
