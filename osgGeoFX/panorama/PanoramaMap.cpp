// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <osgGeoFX/panorama/StrokeLines.h>
#include <osgGeoFX/panorama/detail/PanoramaGround.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>
#include <osgGeoFX/panorama/detail/PanoramaScenery.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgGeoFX
{

namespace
{

/// What stands for the projection's (0, 0) where the camera is orthographic: that of a field of view of 50° across.
constexpr double orthographicScale = 2.1;
/// Between points of the bending curve, and from the base and the horizon.
constexpr double leastStep = 0.001;

std::string curveName(unsigned int index, const char* part)
{
    return "curve" + std::to_string(index + 1) + part;
}

} // namespace

PanoramaMap::PanoramaMap()
    : _textures(std::make_unique<PanoramaTextures>()), _ground(new Ground(*this, *_textures)),
      _scenery(new Scenery(*this, *_textures))
{
}

PanoramaMap::PanoramaMap(const PanoramaMap& other, const osg::CopyOp& copy)
    : Deformation(other, copy), _palette(copy(other._palette.get())), _skyImage(copy(other._skyImage.get())),
      _lines(other._lines), _textures(std::make_unique<PanoramaTextures>()),
      _ground(new Ground(*this, *_textures)), _scenery(new Scenery(*this, *_textures))
{
    for (const Property& property : PanoramaMap::properties())
        property.put(*this, property.get(other));
}

PanoramaMap::~PanoramaMap() = default;

const Properties& PanoramaMap::properties() const
{
    using Self = PanoramaMap;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            Property::number(
                "strength",
                "how far the camera's own picture has become the map: 0 is the camera's picture, 1 "
                "the map",
                0.0, 1.0)
                .of<&Self::_strength>(),
            Property::flag("projection", "whether the terrain is drawn as a painted panorama is, and not "
                                         "only painted in the camera's own view")
                .of<&Self::_projection>(),
            Property::number("viewRadius", "half the width of the ground shown; 0 takes it from the camera",
                             0.0, 2e6, "m")
                .of<&Self::_viewRadius>(),
            Property::angle(
                "horizontalAngle",
                "the arc of the horizon that a cylindrical map shows, 360 for a strip all around; 0 "
                "shows a rectangle of the ground; needs strength 1",
                0.0, 2.0 * osg::PI)
                .of<&Self::_horizontalAngle>(),
            Property::number("horizonLine",
                             "where a flat sea ends, as a share of the image's height from below", 0.1, 1.0)
                .of<&Self::_horizonLine>(),
            Property::number("curveDistance",
                             "how far the ground lies as at the base before it curves, in view radii; less "
                             "than horizonDistance",
                             0.0, 20.0)
                .of<&Self::_curveDistance>(),
            Property::number(
                "horizonDistance",
                "the distance of the horizon from the base, in view radii; more than curveDistance", 0.1,
                50.0)
                .of<&Self::_horizonDistance>(),
            Property::number("horizonBend",
                             "how far the horizon is lower at the sides, as a share of the image's height",
                             0.0, 0.5)
                .of<&Self::_horizonBend>(),
            Property::number("exaggeration", "the ratio of heights to widths", 0.0, 20.0)
                .of<&Self::_exaggeration>()
                .turnedByFactor(1.15),
            Property::number("baseHeight",
                             "the height above the database's zero height that lies on the curve", -12000.0,
                             12000.0, "m")
                .of<&Self::_baseHeight>(),
            Property::flag("baseFromTerrain", "whether the lowest ground of the database lies on the curve "
                                              "where it is higher than baseHeight")
                .of<&Self::_baseFromTerrain>(),
            Property::number(
                "detail",
                "how many times finer the level of detail is than in a plain view of the same scale", 0.05,
                16.0)
                .of<&Self::_detail>(),
            Property::number("horizonExaggeration",
                             "the ratio of heights to widths at the horizon, which changes from exaggeration "
                             "at the image's base; -1 is exaggeration",
                             -1.0, 20.0)
                .of<&Self::_horizonExaggeration>(),
            Property::number(
                "curve1Distance",
                "how far the first point of the bending curve lies, as a share of horizonDistance; a point "
                "counts where its distance and its height are above 0, and curveDistance only without points",
                0.0, 1.0)
                .of<&Self::_curve1, &CurvePoint::distance>(),
            Property::number("curve1Height", "how high the curve is there, as a share of horizonLine", 0.0,
                             1.0)
                .of<&Self::_curve1, &CurvePoint::height>(),
            Property::number("curve2Distance", "the same of the second point", 0.0, 1.0)
                .of<&Self::_curve2, &CurvePoint::distance>(),
            Property::number("curve2Height", "how high the curve is there", 0.0, 1.0)
                .of<&Self::_curve2, &CurvePoint::height>(),
            Property::number("curve3Distance", "the same of the third point", 0.0, 1.0)
                .of<&Self::_curve3, &CurvePoint::distance>(),
            Property::number("curve3Height", "how high the curve is there", 0.0, 1.0)
                .of<&Self::_curve3, &CurvePoint::height>(),
            Property::number("curve4Distance", "the same of the fourth point", 0.0, 1.0)
                .of<&Self::_curve4, &CurvePoint::distance>(),
            Property::number("curve4Height", "how high the curve is there", 0.0, 1.0)
                .of<&Self::_curve4, &CurvePoint::height>(),
            Property::number("curve5Distance", "the same of the fifth point", 0.0, 1.0)
                .of<&Self::_curve5, &CurvePoint::distance>(),
            Property::number("curve5Height", "how high the curve is there", 0.0, 1.0)
                .of<&Self::_curve5, &CurvePoint::height>(),
            Property::number("curve6Distance", "the same of the sixth point", 0.0, 1.0)
                .of<&Self::_curve6, &CurvePoint::distance>(),
            Property::number("curve6Height", "how high the curve is there", 0.0, 1.0)
                .of<&Self::_curve6, &CurvePoint::height>(),
            Property::flag("paint", "whether the ground is painted").of<&Self::_paint>(),
            Property::number("season",
                             "the time of the year, which palettes and the snow line follow; 0 and 1 are "
                             "midwinter, 0.5 is midsummer",
                             0.0, 1.0)
                .of<&Self::_season>(),
            Property::number("snowLine",
                             "the height above which most of the even ground is white in midsummer; -1 takes "
                             "it from the latitude",
                             -1.0, 12000.0, "m")
                .of<&Self::_snowLine>(),
            Property::number("snowWidth", "the range of heights over which snow comes in", 1.0, 5000.0, "m")
                .of<&Self::_snowWidth>(),
            Property::number("treeLine",
                             "the height above which no woods are where the tiles do not tell what grows; -1 "
                             "takes it from the latitude",
                             -1.0, 12000.0, "m")
                .of<&Self::_treeLine>(),
            Property::number("cliffSlope", "the slope, rise over run, from which on ground is rock", 0.05,
                             10.0)
                .of<&Self::_cliffSlope>(),
            Property::number("hillSlope", "the slope, rise over run, up to which ground is field", 0.005,
                             10.0)
                .of<&Self::_hillSlope>(),
            Property::number("relief", "the factor by which slopes are lit as steeper than they are", 0.1,
                             20.0)
                .of<&Self::_relief>(),
            Property::number("brush", "how much brush strokes turn the ground's normals", 0.0, 2.0)
                .of<&Self::_brush>(),
            Property::number("bottomShade", "how much light the base lacks", 0.0, 2.0)
                .of<&Self::_bottomShade>(),
            Property::angle("lightAzimuth",
                            "where the light comes from, clockwise from the way up in the image", -osg::PI,
                            osg::PI)
                .of<&Self::_lightAzimuth>(),
            Property::angle("lightElevation", "the angle of the light above the horizon", 0.0, osg::PI_2)
                .of<&Self::_lightElevation>(),
            Property::flag("sceneLight", "whether the scene's sun shines instead").of<&Self::_sceneLight>(),
            Property::number("atmosphere", "how much of the air's blue the horizon has", 0.0, 1.0)
                .of<&Self::_atmosphere>(),
            Property::flag("water", "whether water is painted as such").of<&Self::_water>(),
            Property::number("deepShore",
                             "the distance from the shore from which on water is deep; where depths are "
                             "known, 50 times the depth counts as well",
                             1.0, 1e6, "m")
                .of<&Self::_deepShore>(),
            Property::number("reflection", "how much of the terrain and the sky the water shows", 0.0, 1.0)
                .of<&Self::_reflection>(),
            Property::number("ripples", "how far ripples move reflections", 0.0, 10.0).of<&Self::_ripples>(),
            Property::flag(
                "sky", "whether a sky is painted behind the terrain, and what edge says where no terrain is")
                .of<&Self::_sky>(),
            Property::integer("clouds", "which clouds there are", 0, 9999).of<&Self::_clouds>(),
            Property::choice(
                "edge", "what lies beyond the terrain",
                {{"automatic",
                  "sea where the data's own border is sea, else haze; haze for databases that do not tell"},
                 {"sea", ""},
                 {"haze", "the land runs out into haze, and into paper at the base"}})
                .of<&Self::_edge>(),
            Property::number("edgeWidth",
                             "over how much of the ground the land runs out, in view radii; not over more "
                             "than a fifth of the terrain",
                             0.0, 5.0)
                .of<&Self::_edgeWidth>(),
            Property::flag("strokes", "whether trees, cliffs and houses are painted as strokes")
                .of<&Self::_strokes>(),
            Property::number("strokeSize", "the height of a painted tree", 1.0, 200.0, "px")
                .of<&Self::_strokeSize>(),
            Property::number("strokeSpacing", "the distance between trees in the image", 1.0, 200.0, "px")
                .of<&Self::_strokeSpacing>(),
            Property::number("strokeStep", "the least distance between trees on the ground", 1.0, 10000.0,
                             "m")
                .of<&Self::_strokeStep>(),
            Property::integer("coverUnit",
                              "the texture unit where tiles have what they say of the ground; none of the "
                              "three from firstUnit on",
                              4, 31)
                .of<&Self::_coverUnit>(),
            Property::integer("firstUnit",
                              "the first of three texture units for the palette, the brush and the "
                              "reflection; -1 takes units that the scene's effects have free",
                              -1, 29)
                .of<&Self::_firstUnit>(),
            Property::integer("edgeUnit",
                              "the first of two texture units for the terrain's edge and the sky, neither of "
                              "them coverUnit or one of the three from firstUnit on; -1 takes units that the "
                              "scene's effects have free",
                              -1, 30)
                .of<&Self::_edgeUnit>(),
        });
    return all;
}

std::string PanoramaMap::inconsistency() const
{
    if (_curveDistance >= _horizonDistance) return "curveDistance must be less than horizonDistance.";
    if (_horizontalAngle > 0.0 && _strength > 0.0 && _strength < 1.0)
        return "A map with a horizontalAngle has no steps between the camera's picture and the map; set "
               "strength to 1, or "
               "horizontalAngle to 0.";
    if (const std::string fault = curveFault(); !fault.empty()) return fault;
    if (_firstUnit >= 0 && _firstUnit < TextureUnits::first)
        return "firstUnit must be from 4 to 29, for the geometry has those below, or -1 for the scene's "
               "choice.";
    if (_firstUnit >= 0 && _coverUnit >= _firstUnit && _coverUnit < _firstUnit + 3)
        return "coverUnit must not be one of the three units from firstUnit on.";
    if (_edgeUnit >= 0 && _edgeUnit < TextureUnits::first)
        return "edgeUnit must be from 4 to 30, for the geometry has those below, or -1 for the scene's "
               "choice.";
    if (_edgeUnit >= 0 && _edgeUnit <= _coverUnit && _coverUnit < _edgeUnit + 2)
        return "coverUnit must not be one of the two units from edgeUnit on.";
    if (_edgeUnit >= 0 && _firstUnit >= 0 && _edgeUnit < _firstUnit + 3 && _firstUnit < _edgeUnit + 2)
        return "The two units from edgeUnit on must not be among the three from firstUnit on.";
    return {};
}

std::array<PanoramaMap::CurvePoint, PanoramaMap::mostCurvePoints> PanoramaMap::allCurvePoints() const
{
    return {_curve1, _curve2, _curve3, _curve4, _curve5, _curve6};
}

std::string PanoramaMap::curveFault() const
{
    osg::Vec2d last;
    for (const osg::Vec2d& point : getCurvePoints())
    {
        if (point.x() > 1.0 - leastStep || point.x() < last.x() + leastStep)
            return "the distances of the curve's points (curve1Distance, curve2Distance, …) must increase in "
                   "steps of at least 0.001 and be at most 0.999.";
        if (point.y() < leastStep || point.y() < last.y())
            return "the heights of the curve's points (curve1Height, curve2Height, …) must not decrease, and "
                   "be at least 0.001.";
        last = point;
    }
    return {};
}

std::vector<osg::Vec2d> PanoramaMap::getCurvePoints() const
{
    std::vector<osg::Vec2d> points;
    for (const CurvePoint& point : allCurvePoints())
        if (point.distance > 0.0 && point.height > 0.0) points.emplace_back(point.distance, point.height);
    return points;
}

bool PanoramaMap::setCurvePoints(const std::vector<osg::Vec2d>& points)
{
    if (points.size() > mostCurvePoints)
    {
        OSG_WARN << "osgGeoFX: PanoramaMap: a bending curve has at most " << mostCurvePoints
                 << " points, not " << points.size() << ". The former ones stay." << std::endl;
        return false;
    }
    std::map<std::string, double> values;
    for (unsigned int i = 0; i < mostCurvePoints; ++i)
    {
        const osg::Vec2d point = i < points.size() ? points[i] : osg::Vec2d();
        if (i < points.size() && !(point.x() > 0.0 && point.y() > 0.0))
        {
            OSG_WARN << "osgGeoFX: PanoramaMap: the distances and the heights of a bending curve's points "
                        "must be above 0. The former points stay."
                     << std::endl;
            return false;
        }
        values[curveName(i, "Distance")] = point.x();
        values[curveName(i, "Height")] = point.y();
    }
    return assign(values);
}

osg::Vec2d PanoramaMap::getCurvePoint(unsigned int index) const
{
    if (index >= mostCurvePoints) return {};
    const CurvePoint point = allCurvePoints()[index];
    return {point.distance, point.height};
}

bool PanoramaMap::setCurvePoint(unsigned int index, const osg::Vec2d& point)
{
    return index < mostCurvePoints &&
           assign({{curveName(index, "Distance"), point.x()}, {curveName(index, "Height"), point.y()}});
}

double PanoramaMap::curveHeight(double distance) const
{
    glsl::geofx_Panorama view{};
    view.profile = profileThrough(getCurvePoints());
    view.horizon = 1.0;
    view.curve = _curveDistance / _horizonDistance;
    return glsl::geofx_panoramaRise(view, distance) / glsl::geofx_panoramaRise(view, 1.0);
}

osg::ref_ptr<const DeformationSnapshot> PanoramaMap::snapshot(const ViewGeometry& view) const
{
    if (!_projection) return nullptr;
    const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(*this, view);
    if (!panorama) return nullptr;
    const bool perspective = view.projection(3, 3) == 0.0;
    const double scale = perspective ? std::abs(view.projection(0, 0)) : orthographicScale;
    return new PanoramaSnapshot(*panorama, scale / panorama->across / _detail);
}

unsigned int PanoramaMap::leastParts() const
{
    // A part of 180 degrees keeps far from what lies opposite.
    const double largest = 1.1 * osg::PI;
    return _projection && _horizontalAngle > largest ? 2 : 1;
}

SurfaceEffect* PanoramaMap::asSurfaceEffect()
{
    return _ground;
}

PassEffect* PanoramaMap::asPassEffect()
{
    return _scenery;
}

void PanoramaMap::setPalette(osg::Image* image)
{
    _palette = image;
    touch();
}

void PanoramaMap::setSkyImage(osg::Image* image)
{
    _skyImage = image;
    touch();
}

void PanoramaMap::setLines(StrokeLines* lines)
{
    _lines = lines;
    touch();
}

std::vector<TextureUnitWish> PanoramaMap::textureUnits() const
{
    const auto after = [&](int place)
    {
        return TextureUnitWish{"firstUnit", _firstUnit < 0 ? -1 : _firstUnit + place, 4 + place};
    };
    const auto edge = [&](int place)
    {
        return TextureUnitWish{"edgeUnit", _edgeUnit < 0 ? -1 : _edgeUnit + place, 14 + place};
    };
    return {after(0), after(1), after(2),
            edge(0),  edge(1),  {"coverUnit", _coverUnit, _coverUnit, true, true}};
}

void PanoramaMap::resizeGLObjectBuffers(unsigned int size)
{
    _textures->resizeGLObjectBuffers(size);
    _scenery->resizeGLObjectBuffers(size);
}

void PanoramaMap::releaseGLObjects(osg::State* state) const
{
    _textures->releaseGLObjects(state);
    _scenery->releaseGLObjects(state);
}

} // namespace osgGeoFX
