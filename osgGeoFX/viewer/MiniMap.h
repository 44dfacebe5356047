// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/viewer/CornerOverlay.h>
#include <osgGeoFX/viewer/ViewOrientation.h>

#include <memory>
#include <optional>

namespace osgGeoFX
{

/** A small map in the lower left corner of the window: the ground from above, without effects, north upwards, with the camera, what
    the picture takes in, and the parts of a bend in it: focus white, transition zone amber, context blue.

    A camera of its own draws it (CameraRole::undeformed()), lit from the north-west as maps are. Its levels of detail are those of its few pixels, with twice
    the error that the window has, so it asks the pager for little, and as a rule for nothing that the window has not. Its
    middle lies ahead of the camera; its width follows the bend, or the eye's height without one.

    The key i shows and hides it.
    @ingroup viewer */
class OSGGEOFX_EXPORT MiniMap : public CornerOverlay
{
public:
    /// `reference`: for true north on a projected terrain; null for the grid's. `terrain`: of a database of osggeofx_build, for its
    /// levels of detail; without it, ranges of distance count as made for a window of this height with a lens of 30°.
    explicit MiniMap(EffectScene& scene, const Georeference* reference = nullptr,
                     const std::optional<TerrainInfo>& terrain = std::nullopt);

    /// The width of the ground on the map, metres; 0, the default, lets the bend or the eye's height decide.
    void setWidth(double metres) { _width = metres > 0.0 ? metres : 0.0; }
    double getWidth() const { return _width; }
    /// The camera that draws the ground; null before it is shown for the first time.
    const osg::Camera* getCamera() const { return _map.get(); }
    /// Where the map shows a place, pixels from the viewport's lower left corner. `world`: in the frame of the scene's children.
    /// Empty while it is hidden, and for places that are not on it.
    std::optional<osg::Vec2d> pixelOf(const osg::Vec3d& world) const;

protected:
    ~MiniMap() override;

private:
    struct Content;
    void show(osgViewer::View& view) override;
    void hide() override;
    void place(osgViewer::View& view, const Content& content, const ViewOrientation& orientation);
    void draw(const Content& content);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<const Georeference> _reference;
    std::optional<TerrainInfo> _terrain;
    osg::ref_ptr<osg::Camera> _map; ///< the ground, below the overlay
    osg::Matrixd _toMap;            ///< from the children's frame to metres east and north of the eye's foot
    double _width = 0.0;
    std::unique_ptr<Content> _drawn;
};

} // namespace osgGeoFX
