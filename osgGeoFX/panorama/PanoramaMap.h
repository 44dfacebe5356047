// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/TextureUnits.h>

#include <osg/Image>
#include <osg/Math>
#include <osg/Vec2d>

#include <array>
#include <memory>
#include <vector>

namespace osgGeoFX
{

class PanoramaTextures;
class StrokeLines;

/** A panorama map: draws the terrain below the scene in the manner of Heinrich Berann's paintings, in real time.

    It follows Brown, Samavati: "Real-Time Panorama Maps" (2017). Each part has its own switch:

    **Projection** (Section 3.1): a modified orthographic projection. The ground is seen from above at the picture's
    base and curves away to a horizon at `horizonLine`. Heights point up in the picture, all at the same scale, so
    that summits can be compared wherever they stand, unless `horizonExaggeration` says otherwise. A user may bend the curve
    through points of his own (setCurvePoints()). The ground shown is a rectangle. The camera sets its place: the
    ground below the eye appears in the middle of the picture's base, and the camera's direction points up in the
    picture (the pitch has no effect). The width shown is the width that the camera would show if it looked straight
    down. So every manipulator pans, zooms and rotates the map. An orthographic camera shows its own width. The
    projection is a Deformation: culling, paging, picking and labels work as with the other deformations.

    **Ground** (Section 3.2): fields, hills, cliffs, snow, forest and towns, each in colors of its own from light to
    shade. The classes come from the tiles' cover (a texture at `coverUnit`, shaders/lib/cover.glsl, made by
    osggeofx_build), else from height and slope. Objects that are not ground keep their look below a state set with
    `setDefine("GEOFX_PAINTED", OFF)`.

    **Strokes** (Section 3.3): trees, cliffs and houses on a lattice over the whole Earth, equally dense on the screen
    at any zoom. Roads, rivers and towns come from vector data (StrokeLines).

    **Water** (Section 3.4): colored by the distance from the shore, with reflections of terrain and sky.
    **Atmosphere** (Section 3.5) and a painted **sky**.

    In a scene the map comes after an exaggeration. Of a map and a bend the first is drawn. Positions are exact within 1e-5
    of the viewing distance, up to 60 degrees of arc from the eye. Every threading model may draw the scene. As with
    all effects, parameters are changed between frames.
    @ingroup panorama */
class OSGGEOFX_EXPORT PanoramaMap : public Deformation, public TextureUser
{
public:
    PanoramaMap();
    PanoramaMap(const PanoramaMap& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, PanoramaMap);

    /// How far the camera's own picture has become the panorama map: 0 is the camera's picture, 1, the default, the map.
    /// Between them each place lies on the straight line in eye space from where the camera sees it to where the map
    /// draws it, a little beyond the strength's share of the way, and the paint, the strokes, the water and the sky fade in. Every strength is a deformation with the bounds,
    /// the picking and the levels of detail of one. Ground that both show stays one to one for cameras that look from
    /// straight down to level, without a roll, where heights have one scale. PanoramaManipulator holds places exactly at strength 1 only.
    bool setStrength(double strength) { return assign("strength", strength); }
    double getStrength() const { return _strength; }
    bool isActive() const override { return getEnabled() && _strength > 0.0; }

    /// @name The projection
    /// @{

    /// Whether the map's projection is used; true by default. Else the painting is drawn in the camera's own
    /// perspective.
    bool setProjection(bool on) { return assign("projection", on ? 1.0 : 0.0); }
    bool getProjection() const { return _projection; }
    /// The view radius: half the width of the ground shown, metres, 0…2e6. 0, the default, takes it from the camera.
    bool setViewRadius(double metres) { return assign("viewRadius", metres); }
    double getViewRadius() const { return _viewRadius; }
    /// The arc of the horizon that the picture shows, for a cylindrical map as a strip of 360° is: radians, 0…2π. 0, the default:
    /// the ground shown is a rectangle. The picture's base is then a circle around the ground below the eye; its part of this
    /// arc is twice the view radius long. Distances D1 and D2 count from this circle. Widths get smaller with the distance
    /// from it, as those of a panorama do, and heights with them: `exaggeration` is their ratio everywhere. Ground nearer to
    /// the eye's foot than 0.3 radii of the circle is not drawn. One camera draws up to 330° of a map whole. Let several cameras draw
    /// a larger one side by side, each a part of the view (CameraRole::LIKE, such as drawInParts() makes); a warning says
    /// so. It needs `strength` 1 (or 0).
    bool setHorizontalAngle(double radians) { return assign("horizontalAngle", radians); }
    double getHorizontalAngle() const { return _horizontalAngle; }
    /// H: the height at which a flat sea ends, as a fraction of the picture's height; 0.1…1, 0.8 by default.
    bool setHorizonLine(double line) { return assign("horizonLine", line); }
    double getHorizonLine() const { return _horizonLine; }
    /// D1: the distance from the base up to which the ground keeps the base's scale, in view radii; 0…20, 0.4 by
    /// default.
    bool setCurveDistance(double radii) { return assign("curveDistance", radii); }
    double getCurveDistance() const { return _curveDistance; }
    /// D2: the distance of the horizon from the base, in view radii; 0.1…50, 3.6 by default. It must exceed D1.
    bool setHorizonDistance(double radii) { return assign("horizonDistance", radii); }
    double getHorizonDistance() const { return _horizonDistance; }
    /// C of Eq. 1: how much lower the horizon is at the picture's sides, as a fraction of its height; 0…0.5, 0.05 by
    /// default.
    bool setHorizonBend(double fraction) { return assign("horizonBend", fraction); }
    double getHorizonBend() const { return _horizonBend; }
    /// The scale factor of Eq. 2: the scale of heights over the scale of widths; 0…20, 2 by default.
    bool setExaggeration(double factor) { return assign("exaggeration", factor); }
    double getExaggeration() const { return _exaggeration; }
    /// The height that lies on the curve, metres, −12 000…12 000; 0 by default.
    bool setBaseHeight(double metres) { return assign("baseHeight", metres); }
    double getBaseHeight() const { return _baseHeight; }
    /// Whether the terrain's lowest height replaces baseHeight where it is higher; true by default.
    bool setBaseFromTerrain(bool on) { return assign("baseFromTerrain", on ? 1.0 : 0.0); }
    bool getBaseFromTerrain() const { return _baseFromTerrain; }
    /// How much finer the levels of detail are than those of a plain view of the same scale; 0.05…16, 1 by default.
    /// The exaggeration also magnifies the height errors of coarse tiles on the screen.
    bool setDetail(double factor) { return assign("detail", factor); }
    double getDetail() const { return _detail; }
    /// The scale factor of heights at the horizon and beyond; up to 20. −1, the default, is `exaggeration`, as the paper
    /// has it: summits can be compared wherever they stand. With another value, `exaggeration` is that of the picture's
    /// base, and the factor changes smoothly on the way to the horizon.
    bool setHorizonExaggeration(double factor) { return assign("horizonExaggeration", factor); }
    double getHorizonExaggeration() const { return _horizonExaggeration; }
    /// A point that the bending curve of the ground passes through: its distance as a share of D2 and its height as a share
    /// of the horizon line. A point counts where both are above 0.
    struct CurvePoint
    {
        double distance = 0.0;
        double height = 0.0;
    };
    static constexpr unsigned int mostCurvePoints = 6;
    /// The points that the bending curve passes through, in order, at most six; none by default. x is the distance and y
    /// the height, as in CurvePoint. Distances are 0.001…0.999 and increase by 0.001 at least; heights are 0.001…1 and do
    /// not decrease. With points, the curve is a monotone cubic through the base, the points and the horizon, level there
    /// (Steffen 1990), and D1 has no effect. Without, it is the paper's: straight up to D1, then a parabola.
    bool setCurvePoints(const std::vector<osg::Vec2d>& points);
    std::vector<osg::Vec2d> getCurvePoints() const;
    /// One of the six that are properties (`curve1Distance`, `curve1Height`, …), from 0; those between may be unused.
    bool setCurvePoint(unsigned int index, const osg::Vec2d& point);
    osg::Vec2d getCurvePoint(unsigned int index) const;
    /// The height of the bending curve, with or without points, at a distance, both as in CurvePoint: from 0 at 0 to 1 at 1.
    double curveHeight(double distance) const;
    /// @}

    /// @name The painting
    /// @{

    /// Whether the ground is painted; true by default.
    bool setPaint(bool on) { return assign("paint", on ? 1.0 : 0.0); }
    bool getPaint() const { return _paint; }
    /// 0 is midwinter, 1/4 spring, 1/2 midsummer (the default), 3/4 autumn, 1 midwinter. It sets the colors and the
    /// snow line.
    bool setSeason(double season) { return assign("season", season); }
    double getSeason() const { return _season; }
    /// The height where snow covers half of the level ground in midsummer, metres, up to 12 000. −1, the default,
    /// computes it from the latitude.
    bool setSnowLine(double metres) { return assign("snowLine", metres); }
    double getSnowLine() const { return _snowLine; }
    /// The range of heights over which the snow cover grows, metres; 1…5000, 500 by default.
    bool setSnowWidth(double metres) { return assign("snowWidth", metres); }
    double getSnowWidth() const { return _snowWidth; }
    /// The height where woods end if the tiles have no cover, metres, up to 12 000. −1, the default, computes it from
    /// the latitude.
    bool setTreeLine(double metres) { return assign("treeLine", metres); }
    double getTreeLine() const { return _treeLine; }
    /// Steeper ground is rock. Rise over run; 0.05…10, 0.85 by default.
    bool setCliffSlope(double slope) { return assign("cliffSlope", slope); }
    double getCliffSlope() const { return _cliffSlope; }
    /// Less steep ground is field. Rise over run; 0.005…10, 0.18 by default.
    bool setHillSlope(double slope) { return assign("hillSlope", slope); }
    double getHillSlope() const { return _hillSlope; }
    /// The factor by which lighting steepens the slopes; 0.1…20, 2.2 by default.
    bool setRelief(double factor) { return assign("relief", factor); }
    double getRelief() const { return _relief; }
    /// How much the brush strokes tilt the ground's normals; 0…2, 0.35 by default.
    bool setBrush(double strength) { return assign("brush", strength); }
    double getBrush() const { return _brush; }
    /// How much the light falls off towards the picture's base, in its lowest 24 %; 0…2, 0.3 by default.
    bool setBottomShade(double light) { return assign("bottomShade", light); }
    double getBottomShade() const { return _bottomShade; }
    /// The direction of the light's source, clockwise from up in the picture; it is the same for all headings.
    /// Radians, −π…π; −60° by default, from the left.
    bool setLightAzimuth(double radians) { return assign("lightAzimuth", radians); }
    double getLightAzimuth() const { return _lightAzimuth; }
    /// The elevation of the light's source, radians; 0…π/2, 32° by default.
    bool setLightElevation(double radians) { return assign("lightElevation", radians); }
    double getLightElevation() const { return _lightElevation; }
    /// Whether the scene's light 0 replaces the light of these two angles; false by default.
    bool setSceneLight(bool on) { return assign("sceneLight", on ? 1.0 : 0.0); }
    bool getSceneLight() const { return _sceneLight; }
    /// The share of the air's blue in the ground's color at the horizon; 0…1, 0.8 by default.
    bool setAtmosphere(double strength) { return assign("atmosphere", strength); }
    double getAtmosphere() const { return _atmosphere; }
    /// The colors of the classes from shade to light, as PanoramaPalette.h describes. Null, the default: the kit's
    /// own.
    void setPalette(osg::Image* image);
    osg::Image* getPalette() { return _palette; }
    const osg::Image* getPalette() const { return _palette; }
    /// @}

    /// @name Water and sky
    /// @{

    /// Whether water has a painted surface; true by default.
    bool setWater(bool on) { return assign("water", on ? 1.0 : 0.0); }
    bool getWater() const { return _water; }
    /// The distance from the shore from which water is deep, metres (if depths are known: depth in metres / 0.02);
    /// 1…1e6, 2200 by default.
    bool setDeepShore(double metres) { return assign("deepShore", metres); }
    double getDeepShore() const { return _deepShore; }
    /// The share of the reflected terrain and sky in the water's color; 0…1, 0.5 by default.
    bool setReflection(double strength) { return assign("reflection", strength); }
    double getReflection() const { return _reflection; }
    /// How far ripples displace reflections; 0…10, 1 by default.
    bool setRipples(double strength) { return assign("ripples", strength); }
    double getRipples() const { return _ripples; }
    /// Whether a painted sky stands behind the terrain, and `edge` beyond the terrain's border; true by default.
    bool setSky(bool on) { return assign("sky", on ? 1.0 : 0.0); }
    bool getSky() const { return _sky; }
    /// The seed that arranges the clouds; 0…9999, 1 by default.
    bool setClouds(int seed) { return assign("clouds", seed); }
    int getClouds() const { return _clouds; }
    /// The program's own image of the sky. Its width is a full turn of 360° and repeats; its lowest row is the
    /// horizon. Null, the default: the kit's own (makeSky()).
    void setSkyImage(osg::Image* image);
    osg::Image* getSkyImage() { return _skyImage; }
    const osg::Image* getSkyImage() const { return _skyImage; }
    /// @}

    /// @name Where the terrain ends
    /// @{

    /// What lies beyond the border of the terrain.
    enum Edge
    {
        AUTOMATIC, ///< SEA where the data's own border is sea, else HAZE; HAZE for other databases
        SEA,       ///< sea everywhere
        HAZE ///< land and sea fade into haze at the horizon and the sides, and into blank paper at the base
    };
    /// AUTOMATIC by default. Without a sky nothing is drawn beyond the terrain. A terrain that osggeofx_build did not
    /// build has sea or haze behind it, but does not fade itself.
    bool setEdge(Edge edge) { return assign("edge", edge); }
    Edge getEdge() const { return static_cast<Edge>(_edge); }
    /// The width of the band in which the land fades, in view radii; 0…5, 0.3 by default. At most a fifth of the
    /// terrain's shorter side.
    bool setEdgeWidth(double radii) { return assign("edgeWidth", radii); }
    double getEdgeWidth() const { return _edgeWidth; }
    /// @}

    /// @name Strokes
    /// @{

    /// Whether trees, cliffs and houses are painted as strokes; true by default.
    bool setStrokes(bool on) { return assign("strokes", on ? 1.0 : 0.0); }
    bool getStrokes() const { return _strokes; }
    /// The height of a painted tree, pixels; 1…200, 5 by default.
    bool setStrokeSize(double pixels) { return assign("strokeSize", pixels); }
    double getStrokeSize() const { return _strokeSize; }
    /// The distance between trees on the screen, pixels; 1…200, 4.2 by default.
    bool setStrokeSpacing(double pixels) { return assign("strokeSpacing", pixels); }
    double getStrokeSpacing() const { return _strokeSpacing; }
    /// The smallest distance between trees on the ground, metres; 1…10 000, 25 by default. A change rebuilds all
    /// tiles' strokes.
    bool setStrokeStep(double metres) { return assign("strokeStep", metres); }
    double getStrokeStep() const { return _strokeStep; }
    /// Roads, rivers and towns, painted with the strokes. The units are degrees on a globe, else the terrain's metres;
    /// lines in other units are not drawn. The lines must not change any more. Null, the default: none. A change
    /// rebuilds all tiles' strokes.
    void setLines(StrokeLines* lines);
    StrokeLines* getLines() { return _lines.get(); }
    const StrokeLines* getLines() const { return _lines.get(); }
    /// @}

    /// @name Texture units
    /// @{

    /// The texture unit of the tiles' cover; 4…31, 7 by default, as osggeofx_build makes them.
    bool setCoverUnit(int unit) { return assign("coverUnit", unit); }
    int getCoverUnit() const { return _coverUnit; }
    /// The first of three texture units for the palette, the brush and the reflection; 4…29. −1, the default: the
    /// scene chooses them, and prefers 4, 5 and 6.
    bool setFirstUnit(int unit) { return assign("firstUnit", unit); }
    int getFirstUnit() const { return _firstUnit; }
    /// The first of two texture units for the terrain's edge and the sky; 4…30. −1, the default: the scene chooses
    /// them, and prefers 14 and 15.
    bool setEdgeUnit(int unit) { return assign("edgeUnit", unit); }
    int getEdgeUnit() const { return _edgeUnit; }
    /// @}

    const Properties& properties() const override;
    osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const override;
    double longestEdge(const CameraRange& cameras, double tolerance) const override;
    bool isProjection() const override { return getProjection(); }
    unsigned int leastParts() const override;
    std::string vertexFile() const override { return "stages/panorama.glsl"; }
    bool carriesThings() const override { return true; }

    using Deformation::asPassEffect;
    using Deformation::asSurfaceEffect;
    SurfaceEffect* asSurfaceEffect() override;
    PassEffect* asPassEffect() override;
    std::vector<TextureUnitWish> textureUnits() const override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~PanoramaMap() override;

    std::string inconsistency() const override;

private:
    std::string curveFault() const;
    std::array<CurvePoint, mostCurvePoints> allCurvePoints() const;
    class Ground;
    class Scenery;
    /// Indices of its texture units in textureUnits().
    enum Unit : std::size_t
    {
        PaletteUnit,
        BrushUnit,
        MirrorUnit,
        EdgeMapUnit,
        EdgeSkyUnit,
        CoverUnit
    };

    double _strength = 1.0;
    bool _projection = true;
    double _viewRadius = 0.0;
    double _horizontalAngle = 0.0;
    double _horizonLine = 0.8;
    double _curveDistance = 0.4;
    double _horizonDistance = 3.6;
    double _horizonBend = 0.05;
    double _exaggeration = 2.0;
    double _baseHeight = 0.0;
    bool _baseFromTerrain = true;
    double _detail = 1.0;
    bool _paint = true;
    double _season = 0.5;
    double _snowLine = -1.0;
    double _snowWidth = 500.0;
    double _treeLine = -1.0;
    double _cliffSlope = 0.85;
    double _hillSlope = 0.18;
    double _relief = 2.2;
    double _brush = 0.35;
    double _bottomShade = 0.3;
    double _lightAzimuth = -osg::PI / 3.0;
    double _lightElevation = 32.0 * osg::PI / 180.0;
    bool _sceneLight = false;
    double _atmosphere = 0.8;
    bool _water = true;
    double _deepShore = 2200.0;
    double _reflection = 0.5;
    double _ripples = 1.0;
    bool _sky = true;
    int _clouds = 1;
    int _edge = AUTOMATIC;
    double _edgeWidth = 0.3;
    bool _strokes = true;
    double _strokeSize = 5.0;
    double _strokeSpacing = 4.2;
    double _strokeStep = 25.0;
    int _coverUnit = 7;
    int _firstUnit = -1;
    int _edgeUnit = -1;
    double _horizonExaggeration = -1.0;
    CurvePoint _curve1, _curve2, _curve3, _curve4, _curve5, _curve6;
    osg::ref_ptr<osg::Image> _palette;
    osg::ref_ptr<osg::Image> _skyImage;
    osg::ref_ptr<StrokeLines> _lines;
    std::unique_ptr<PanoramaTextures> _textures;
    osg::ref_ptr<Ground> _ground;
    osg::ref_ptr<Scenery> _scenery;
};

} // namespace osgGeoFX
