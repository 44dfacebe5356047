// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/TextureUnits.h>

#include <osg/Image>
#include <osg/Math>

#include <memory>

namespace osgGeoFX
{

class PanoramaTextures;
class StrokeLines;

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

    **Strokes** (Section 3.3): trees, cliffs and houses, placed on a lattice of the whole Earth, as dense on the screen at any zoom;
    and roads, rivers and towns from vector data.

    **Water** (Section 3.4): by the distance to the shore, with the reflection of terrain and sky. **Atmosphere** (Section 3.5)
    and a painted **sky**.

    Stands after an exaggeration or a mapping in a scene, and instead of a bend. Positions are exact within 1e-5 of the viewing
    distance up to 60 degrees of arc from the eye. Objects below the scene may be drawn in all threading models; changed as all
    effects are, between frames. */
class OSGGEOFX_EXPORT PanoramaMap : public Deformation, public TextureUser
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
    /// How much finer levels of detail are than a plain view of the same scale asks for; 0.05…16, 1 by default. Heights, and by how
    /// much those of coarse tiles are off, show as much larger as the exaggeration says.
    bool setDetail(double factor) { return assign("detail", factor); }
    double getDetail() const { return _detail; }
    /// @}

    /// @name The painting
    /// @{

    /// Whether the ground is painted; true by default.
    bool setPaint(bool on) { return assign("paint", on ? 1.0 : 0.0); }
    bool getPaint() const { return _paint; }
    /// 0 midwinter, 1/4 spring, 1/2 midsummer (the default), 3/4 autumn, 1 midwinter: palettes and the snow line.
    bool setSeason(double season) { return assign("season", season); }
    double getSeason() const { return _season; }
    /// Where half of the even ground is white in midsummer, metres; −1, the default, takes it from the latitude.
    bool setSnowLine(double metres) { return assign("snowLine", metres); }
    double getSnowLine() const { return _snowLine; }
    /// Over how many metres of height snow comes in; 1…5000, 500 by default.
    bool setSnowWidth(double metres) { return assign("snowWidth", metres); }
    double getSnowWidth() const { return _snowWidth; }
    /// Where woods end if the tiles do not tell what grows, metres; −1, the default, takes it from the latitude.
    bool setTreeLine(double metres) { return assign("treeLine", metres); }
    double getTreeLine() const { return _treeLine; }
    /// Steeper ground is rock, rise over run; 0.05…10, 0.85 by default.
    bool setCliffSlope(double slope) { return assign("cliffSlope", slope); }
    double getCliffSlope() const { return _cliffSlope; }
    /// Ground less steep is field, rise over run; 0.005…10, 0.18 by default.
    bool setHillSlope(double slope) { return assign("hillSlope", slope); }
    double getHillSlope() const { return _hillSlope; }
    /// By how much slopes are lit as steeper than they are; 0.1…20, 2.2 by default.
    bool setRelief(double factor) { return assign("relief", factor); }
    double getRelief() const { return _relief; }
    /// How much brush strokes turn the ground's normals; 0…2, 0.35 by default.
    bool setBrush(double strength) { return assign("brush", strength); }
    double getBrush() const { return _brush; }
    /// How much light the picture's base lacks; 0…2, 0.3 by default.
    bool setBottomShade(double light) { return assign("bottomShade", light); }
    double getBottomShade() const { return _bottomShade; }
    /// Where the light comes from, clockwise from the way up in the picture, so the same for all headings; radians, −π…π, −60° by
    /// default, from the left.
    bool setLightAzimuth(double radians) { return assign("lightAzimuth", radians); }
    double getLightAzimuth() const { return _lightAzimuth; }
    /// How high it stands, radians; 0…π/2, 32° by default.
    bool setLightElevation(double radians) { return assign("lightElevation", radians); }
    double getLightElevation() const { return _lightElevation; }
    /// Whether the scene's light 0 shines instead; false by default.
    bool setSceneLight(bool on) { return assign("sceneLight", on ? 1.0 : 0.0); }
    bool getSceneLight() const { return _sceneLight; }
    /// How much of the air's blue the horizon has; 0…1, 0.8 by default.
    bool setAtmosphere(double strength) { return assign("atmosphere", strength); }
    double getAtmosphere() const { return _atmosphere; }
    /// The colours of classes from light to shade, as makePalette() describes; null, the default, for the kit's own.
    void setPalette(osg::Image* image);
    osg::Image* getPalette() { return _palette; }
    const osg::Image* getPalette() const { return _palette; }
    /// @}

    /// @name Water and sky
    /// @{

    /// Whether water is painted as such; true by default.
    bool setWater(bool on) { return assign("water", on ? 1.0 : 0.0); }
    bool getWater() const { return _water; }
    /// From where on water is deep, metres from the shore (metres of depth over 0.02 where depths are known); 1…1e6, 2200 by
    /// default.
    bool setDeepShore(double metres) { return assign("deepShore", metres); }
    double getDeepShore() const { return _deepShore; }
    /// How much of the terrain and the sky the water shows; 0…1, 0.5 by default.
    bool setReflection(double strength) { return assign("reflection", strength); }
    double getReflection() const { return _reflection; }
    /// How far ripples move reflections; 0…10, 1 by default.
    bool setRipples(double strength) { return assign("ripples", strength); }
    double getRipples() const { return _ripples; }
    /// Whether there is a painted sky behind the terrain, and where no terrain is what `edge` says; true by default.
    bool setSky(bool on) { return assign("sky", on ? 1.0 : 0.0); }
    bool getSky() const { return _sky; }
    /// Which clouds there are: each number has others; 0…9999.
    bool setClouds(int seed) { return assign("clouds", seed); }
    int getClouds() const { return _clouds; }
    /// An image of one's own for the sky: a turn of 360° that repeats across, from the horizon upwards; null, the default, for the
    /// kit's own.
    void setSkyImage(osg::Image* image);
    osg::Image* getSkyImage() { return _skyImage; }
    const osg::Image* getSkyImage() const { return _skyImage; }
    /// @}

    /// @name Where the terrain ends
    /// @{

    /// What lies beyond the terrain.
    enum Edge
    {
        AUTOMATIC, ///< sea where the data's own border is sea, else as HAZE; of databases of others nothing is known: haze
        SEA, ///< sea everywhere
        HAZE ///< the land runs out into haze towards the horizon and the sides, and into paper at the picture's base; the sea, too
    };
    /// AUTOMATIC by default. Without a sky nothing is drawn beyond the terrain. That of databases of others has sea or haze behind it, and
    /// does not run out itself.
    bool setEdge(Edge edge) { return assign("edge", edge); }
    Edge getEdge() const { return static_cast<Edge>(_edge); }
    /// Over how much of the ground the land runs out, view radii; 0…5, 0.3 by default; not over more than a fifth of the terrain.
    bool setEdgeWidth(double radii) { return assign("edgeWidth", radii); }
    double getEdgeWidth() const { return _edgeWidth; }
    /// @}

    /// @name Strokes
    /// @{

    /// Whether trees, cliffs and houses are painted as strokes; true by default.
    bool setStrokes(bool on) { return assign("strokes", on ? 1.0 : 0.0); }
    bool getStrokes() const { return _strokes; }
    /// How high a tree is painted, pixels; 1…200, 5 by default.
    bool setStrokeSize(double pixels) { return assign("strokeSize", pixels); }
    double getStrokeSize() const { return _strokeSize; }
    /// How far trees stand apart on the screen, pixels; 1…200, 4.2 by default.
    bool setStrokeSpacing(double pixels) { return assign("strokeSpacing", pixels); }
    double getStrokeSpacing() const { return _strokeSpacing; }
    /// How far they stand apart on the ground at least, metres; 1…10 000, 25 by default. Each tile's are made anew when it changes.
    bool setStrokeStep(double metres) { return assign("strokeStep", metres); }
    double getStrokeStep() const { return _strokeStep; }
    /// Roads, rivers and towns, painted with the strokes: in degrees above a globe, in the terrain's metres else; those in other
    /// units are not drawn. It must not change any more. Null, the default: none. Each tile's are made anew when another is set.
    void setLines(StrokeLines* lines);
    StrokeLines* getLines() { return _lines.get(); }
    const StrokeLines* getLines() const { return _lines.get(); }
    /// @}

    /// @name Texture units
    /// @{

    /// Where tiles have what they say of the ground; 4…31, 7 by default, as osggeofx_build makes them.
    bool setCoverUnit(int unit) { return assign("coverUnit", unit); }
    int getCoverUnit() const { return _coverUnit; }
    /// The first of three for the palette, the brush and the reflection; 4…29. −1, the default, leaves them to the scene,
    /// which gives 4, 5 and 6 where they are free.
    bool setFirstUnit(int unit) { return assign("firstUnit", unit); }
    int getFirstUnit() const { return _firstUnit; }
    /// The first of two for the terrain's edge and the sky; 4…30. −1, the default, leaves them to the scene,
    /// which gives 14 and 15 where they are free.
    bool setEdgeUnit(int unit) { return assign("edgeUnit", unit); }
    int getEdgeUnit() const { return _edgeUnit; }
    /// @}

    const Properties& properties() const override;
    osg::ref_ptr<const DeformationFrame> frame(const ViewGeometry& view) const override;
    std::string vertexFile() const override { return "stages/panorama.glsl"; }

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
    class Ground;
    class Scenery;
    /// The places of its texture units.
    enum Unit : std::size_t
    {
        PaletteUnit,
        BrushUnit,
        MirrorUnit,
        EdgeMapUnit,
        EdgeSkyUnit,
        CoverUnit
    };

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
    osg::ref_ptr<osg::Image> _palette;
    osg::ref_ptr<osg::Image> _skyImage;
    osg::ref_ptr<StrokeLines> _lines;
    std::unique_ptr<PanoramaTextures> _textures;
    osg::ref_ptr<Ground> _ground;
    osg::ref_ptr<Scenery> _scenery;
};

} // namespace osgGeoFX
