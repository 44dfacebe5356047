// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/Deformation.h>

#include <osg/Image>

#include <memory>

namespace osgGeoFX
{

/** A panorama map: the terrain below the scene in the manner of Heinrich Berann's paintings, live.

    Brown, Samavati: "Real-Time Panorama Maps" (2017). What it does, each part with a switch of its own:

    **Projection** (Section 3.1): a modified orthographic one. The ground wraps a curve from a view from above at the picture's
    base to a horizon at `horizonLine`; heights move up in the picture, all by the same scale, so summits compare wherever they
    stand; the ground shown is a rectangle. The camera tells the place: the middle of the picture's base is the ground below
    the eye, up in the picture is where the camera looks (its pitch does not matter), and the width shown is what a camera that
    looks straight down from there would show: so every manipulator pans, zooms and rotates. An orthographic camera shows its own
    width. It is a deformation: culled, paged, picked and labelled as the others are.

    **Ground** (Section 3.2): fields, hills, cliffs, snow, forest and towns, by what the tiles say of themselves (a texture at
    `coverUnit`, shaders/lib/cover.glsl, which osggeofx_build makes) or, where they say nothing, by height and slope; each in colours
    of its own from light to shade. What is not ground keeps its look below a state set with
    `setDefine("GEOFX_PAINTED", OFF)`.

    **Strokes** (Section 3.3): trees, cliffs and houses, placed on a lattice of the whole Earth, as dense on the screen at any zoom.

    **Water** (Section 3.4): by the distance to the shore, with the reflection of terrain and sky. **Atmosphere** (Section 3.5)
    and a painted **sky**.

    Stands after an exaggeration or a mapping in a scene, and instead of a bend. Positions are exact within 1e-5 of the viewing
    distance up to 60 degrees of arc from the eye. Objects below the scene may be drawn in all threading models; changed as all
    effects are, between frames. */
class OSGGEOFX_EXPORT PanoramaMap : public Deformation
{
public:
    PanoramaMap();
    PanoramaMap(const PanoramaMap& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, PanoramaMap);

    /// @name The projection
    /// @{

    /// True by default; without it the painting is drawn from the camera's own perspective.
    bool setProjection(bool on) { return assign("projection", on ? 1.0 : 0.0); }
    bool getProjection() const { return _projection; }
    /// Half the width of the ground shown, metres; 0, the default, takes it from the camera.
    bool setViewRadius(double metres) { return assign("viewRadius", metres); }
    double getViewRadius() const { return _viewRadius; }
    /// H: where a flat sea ends, as a fraction of the picture's height; 0.1…1, 0.8 by default.
    bool setHorizonLine(double line) { return assign("horizonLine", line); }
    double getHorizonLine() const { return _horizonLine; }
    /// D1: how far the ground lies as at the base before it curves, in view radii; 0…20, 0.4 by default.
    bool setCurveDistance(double radii) { return assign("curveDistance", radii); }
    double getCurveDistance() const { return _curveDistance; }
    /// D2: the horizon's distance from the base, in view radii; 0.1…50, 3.6 by default, and more than D1.
    bool setHorizonDistance(double radii) { return assign("horizonDistance", radii); }
    double getHorizonDistance() const { return _horizonDistance; }
    /// C of Eq. 1: how far the horizon is lower at the picture's sides, as a fraction of its height; 0…0.5, 0.05 by default.
    bool setHorizonBend(double fraction) { return assign("horizonBend", fraction); }
    double getHorizonBend() const { return _horizonBend; }
    /// The scale factor of Eq. 2: heights over widths in the picture; 0…20, 2 by default.
    bool setExaggeration(double factor) { return assign("exaggeration", factor); }
    double getExaggeration() const { return _exaggeration; }
    /// The height that lies on the curve, metres; 0 by default.
    bool setBaseHeight(double metres) { return assign("baseHeight", metres); }
    double getBaseHeight() const { return _baseHeight; }
    /// Whether the lowest ground of the database lies there where it is higher; true by default.
    bool setBaseFromTerrain(bool on) { return assign("baseFromTerrain", on ? 1.0 : 0.0); }
    bool getBaseFromTerrain() const { return _baseFromTerrain; }
    /// How much finer levels of detail are than a plain view of the same scale asks for; 0.05…16, 1 by default.
    bool setDetail(double factor) { return assign("detail", factor); }
    double getDetail() const { return _detail; }
    /// @}

    const Properties& properties() const override;
    osg::ref_ptr<const DeformationFrame> frame(const ViewGeometry& view) const override;
    std::string vertexFile() const override { return "stages/panorama.glsl"; }

    using Deformation::asPassEffect;
    using Deformation::asSurfaceEffect;
    SurfaceEffect* asSurfaceEffect() override;

protected:
    ~PanoramaMap() override;

    std::string inconsistency() const override;

private:
    class Ground;

    bool _projection = true;
    double _viewRadius = 0.0;
    double _horizonLine = 0.8;
    double _curveDistance = 0.4;
    double _horizonDistance = 3.6;
    double _horizonBend = 0.05;
    double _exaggeration = 2.0;
    double _baseHeight = 0.0;
    bool _baseFromTerrain = true;
    double _detail = 1.0;
    osg::ref_ptr<Ground> _ground;
};

} // namespace osgGeoFX
