// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/TileStrokes.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/detail/CoverSampler.h>
#include <osgGeoFX/panorama/detail/NormalSampler.h>
#include <osgGeoFX/panorama/detail/StrokeLattice.h>
#include <osgGeoFX/panorama/detail/StrokeScan.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGeoFX
{

namespace
{

constexpr double whole = 32767.0; ///< 1 as a short

GLshort toShort(double share)
{
    return static_cast<GLshort>(std::lround(std::clamp(share, -1.0, 1.0) * whole));
}

osg::Vec3s toShorts(const osg::Vec3d& direction)
{
    return {toShort(direction.x()), toShort(direction.y()), toShort(direction.z())};
}

/// The value of a vertex in an array of one of the types in use. Nothing for other types.
std::optional<osg::Vec3d> vectorAt(const osg::Array* array, unsigned int index)
{
    if (!array || index >= array->getNumElements()) return {};
    switch (array->getType())
    {
    case osg::Array::Vec3ArrayType:
        return osg::Vec3d((*static_cast<const osg::Vec3Array*>(array))[index]);
    case osg::Array::Vec3sArrayType:
    {
        const osg::Vec3s& each = (*static_cast<const osg::Vec3sArray*>(array))[index];
        return osg::Vec3d(each.x(), each.y(), each.z()) / whole;
    }
    case osg::Array::Vec3bArrayType:
    {
        const osg::Vec3b& each = (*static_cast<const osg::Vec3bArray*>(array))[index];
        return osg::Vec3d(each.x(), each.y(), each.z()) / 127.0;
    }
    case osg::Array::Vec2ArrayType:
    {
        const osg::Vec2& each = (*static_cast<const osg::Vec2Array*>(array))[index];
        return osg::Vec3d(static_cast<double>(each.x()), static_cast<double>(each.y()), 0.0);
    }
    default:
        return {};
    }
}

/// The share of the lattice points in a town from vector data that are houses, unless the cover knows more.
constexpr double townShare = 0.7;

/// The towns on the mesh; nothing if there are none.
std::optional<StrokeLines::Towns> townsOf(const StrokeScan& scan, const StrokeLattice& lattice,
                                          const StrokeParameters& parameters)
{
    const StrokeLines* lines = parameters.lines;
    if (!lines || (lines->getUnits() == StrokeLines::DEGREES) != lattice.onGlobe()) return {};
    StrokeLines::Towns towns(*lines, lattice.toMap(scan.low()), lattice.toMap(scan.high()));
    if (towns.empty()) return {};
    return towns;
}

/// Makes strokes of the spots on a mesh.
class Painter
{
public:
    Painter(const osg::Geometry& mesh, const StrokeScan& scan, const StrokeLattice& lattice,
            const StrokeParameters& parameters)
        : _mesh(mesh), _scan(scan), _lattice(lattice), _parameters(parameters),
          _cover(mesh, parameters.coverUnit), _normalMap(mesh), _towns(townsOf(scan, lattice, parameters))
    {
    }

    void paint(const StrokeSpot& spot);
    void paint(const StrokeLineSpot& spot);
    osg::ref_ptr<osg::Geometry> points() const;

private:
    std::optional<osg::Vec3d> between(const osg::Array* array, const StrokeSpot& spot) const;
    osg::Vec3d normalAt(const StrokeSpot& spot) const;
    glsl::geofx_Cover coverAt(const StrokeSpot& spot, double steepness) const;
    std::optional<TileStrokes::Kind> kindAt(const StrokeSpot& spot, double steepness,
                                            const glsl::geofx_Cover& cover) const;
    glsl::geofx_Cover withTowns(const StrokeSpot& spot, glsl::geofx_Cover cover) const;
    void add(const StrokeSpot& spot, const osg::Vec3d& normal, const osg::Vec3d& direction,
             TileStrokes::Kind kind, GLshort threshold, const glsl::geofx_Cover& cover, double ofKind = 0.0);

    const osg::Geometry& _mesh;
    const StrokeScan& _scan;
    const StrokeLattice& _lattice;
    const StrokeParameters& _parameters;
    const CoverSampler _cover;
    const NormalSampler _normalMap;
    const std::optional<StrokeLines::Towns> _towns;
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3sArray> _normals = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4sArray> _traits = new osg::Vec4sArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3sArray> _directions = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2sArray> _places = new osg::Vec2sArray(osg::Array::BIND_PER_VERTEX);
    bool _directed = false; ///< whether any stroke has a direction of its own
};

std::optional<osg::Vec3d> Painter::between(const osg::Array* array, const StrokeSpot& spot) const
{
    osg::Vec3d sum;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::optional<osg::Vec3d> value = vectorAt(array, spot.corners[i]);
        if (!value) return {};
        sum += *value * spot.weights[i];
    }
    return sum;
}

osg::Vec3d Painter::normalAt(const StrokeSpot& spot) const
{
    if (_normalMap.valid())
    {
        if (const std::optional<osg::Vec3d> at = between(_mesh.getTexCoordArray(0), spot))
            if (const std::optional<osg::Vec3d> normal = _normalMap.at(at->x(), at->y())) return *normal;
    }
    std::optional<osg::Vec3d> normal = between(_mesh.getNormalArray(), spot);
    if (!normal || !(normal->length2() > 0.0))
    {
        const osg::Array* vertices = _scan.vertices();
        const osg::Vec3d a = *vectorAt(vertices, spot.corners[0]);
        normal = (*vectorAt(vertices, spot.corners[1]) - a) ^ (*vectorAt(vertices, spot.corners[2]) - a);
    }
    normal->normalize();
    return *normal;
}

glsl::geofx_Cover Painter::coverAt(const StrokeSpot& spot, double steepness) const
{
    if (_cover.valid())
    {
        // One texel for a whole mesh needs no coordinates.
        const std::optional<osg::Vec3d> at =
            _cover.uniform() ? osg::Vec3d() : between(_mesh.getTexCoordArray(0), spot);
        if (at)
        {
            const glsl::Rgba texel = _cover.at(at->x(), at->y());
            if (glsl::geofx_coverKnown(texel)) return glsl::geofx_coverOf(texel);
        }
    }
    double height = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        height += spot.weights[i] * _scan.height(spot.corners[i]);
    return glsl::geofx_likelyCover(height, steepness, _parameters.treeLine);
}

/// The cover in a town from vector data.
glsl::geofx_Cover Painter::withTowns(const StrokeSpot& spot, glsl::geofx_Cover cover) const
{
    if (!_towns || !_towns->contain(_lattice.toMap(_lattice.place(spot.column, spot.row)))) return cover;
    cover.town = std::max(cover.town, townShare);
    cover.trees = std::min(cover.trees, 1.0 - townShare);
    return cover;
}

std::optional<TileStrokes::Kind> Painter::kindAt(const StrokeSpot& spot, double steepness,
                                                 const glsl::geofx_Cover& cover) const
{
    if (cover.shore > 0.0) return {};
    const auto chance = [&](StrokeChance which)
    {
        return _lattice.chance(spot.column, spot.row, which);
    };
    // The steeper the ground, the more of it is rock.
    const double cliff = std::max(_parameters.cliffSlope, 1e-3);
    if (chance(StrokeChance::Cliff) < std::clamp(2.0 * (steepness - cliff) / cliff, 0.0, 1.0))
        return TileStrokes::Cliff;
    const double drawn = chance(StrokeChance::Cover);
    if (drawn < cover.trees) return TileStrokes::Tree;
    if (drawn < cover.trees + cover.town) return TileStrokes::House;
    // What neither grows nor is built on shows the way that water takes down it: the more of it, the steeper.
    if (chance(StrokeChance::Slope) < glsl::geofx_strokeSlopes(steepness, cliff)) return TileStrokes::Cliff;
    return {};
}

void Painter::paint(const StrokeSpot& spot)
{
    const osg::Vec3d up = _scan.up(spot.corners[0]);
    const osg::Vec3d normal = normalAt(spot);
    const double cosine = std::clamp(normal * up, 0.01, 1.0);
    const double steepness = std::sqrt(1.0 - cosine * cosine) / cosine;
    const glsl::geofx_Cover cover = withTowns(spot, coverAt(spot, steepness));
    const std::optional<TileStrokes::Kind> kind = kindAt(spot, steepness, cover);
    if (!kind) return;
    osg::Vec3d downhill;
    if (*kind == TileStrokes::Cliff)
    {
        downhill = normal * (normal * up) - up;
        downhill.normalize();
        _directed = true;
    }
    add(spot, normal, downhill, *kind,
        toShort(_lattice.chance(spot.column, spot.row, StrokeChance::Threshold)), cover,
        *kind == TileStrokes::House   ? glsl::geofx_townMiddle(cover.town, steepness, cover.shore)
        : *kind == TileStrokes::Cliff ? cover.bare
                                      : 0.0);
}

void Painter::paint(const StrokeLineSpot& spot)
{
    // Roads cross water. A river in a lake is not seen.
    const glsl::geofx_Cover cover = coverAt(spot, 0.0);
    if (spot.kind == StrokeLines::RIVER && cover.shore > 0.0) return;
    osg::Vec3d along = spot.along;
    along.normalize();
    _directed = true;
    add(spot, normalAt(spot), along, spot.kind == StrokeLines::RIVER ? TileStrokes::River : TileStrokes::Road,
        static_cast<GLshort>(_scan.finestOfLines()), cover);
}

void Painter::add(const StrokeSpot& spot, const osg::Vec3d& normal, const osg::Vec3d& direction,
                  TileStrokes::Kind kind, GLshort threshold, const glsl::geofx_Cover& cover, double ofKind)
{
    _vertices->push_back(osg::Vec3(*between(_scan.vertices(), spot)));
    _normals->push_back(toShorts(normal));
    _directions->push_back(toShorts(direction));
    _traits->push_back(osg::Vec4s(toShort(_lattice.chance(spot.column, spot.row, StrokeChance::Seed)),
                                  static_cast<GLshort>(spot.halfLevel), static_cast<GLshort>(kind),
                                  threshold));
    _places->push_back(
        osg::Vec2s(toShort(ofKind), static_cast<GLshort>(std::clamp(-cover.shore, 0.0, whole))));
}

osg::ref_ptr<osg::Geometry> Painter::points() const
{
    if (_vertices->empty()) return nullptr;
    _vertices->trim();
    _normals->trim();
    _traits->trim();
    _directions->trim();
    _places->trim();
    _normals->setNormalize(true);
    osg::ref_ptr<osg::Geometry> points = new osg::Geometry;
    points->setName("strokes");
    points->setUseDisplayList(false);
    points->setUseVertexBufferObjects(true);
    points->setVertexArray(_vertices);
    points->setNormalArray(_normals);
    points->setTexCoordArray(0, _traits);
    // In buffers of their own: Mesa complains of more than three arrays that are written into one.
    _directions->setVertexBufferObject(new osg::VertexBufferObject);
    if (_directed) points->setTexCoordArray(1, _directions);
    _places->setVertexBufferObject(new osg::VertexBufferObject);
    points->setTexCoordArray(2, _places);
    points->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(_vertices->size())));
    points->getBound(); // computed here, not by two draw threads at once
    return points;
}

} // namespace

TileStrokes::TileStrokes(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid)
    : _parameters(parameters)
{
    setName("geofx.strokes");
    if (!ellipsoid) return;
    _equator = ellipsoid->getRadiusEquator();
    _polar = ellipsoid->getRadiusPolar();
}

TileStrokes::~TileStrokes() = default;

osg::ref_ptr<TileStrokes> TileStrokes::make(const osg::Geometry& terrain, const osg::Matrixd& toWorld,
                                            const StrokeParameters& parameters,
                                            const osg::EllipsoidModel* ellipsoid)
{
    osg::ref_ptr<TileStrokes> strokes = new TileStrokes(parameters, ellipsoid);
    strokes->_toWorld = toWorld;
    const StrokeLattice lattice(parameters, ellipsoid);
    const StrokeScan scan(lattice, terrain, toWorld, parameters.strokesAlongTile, parameters.lines,
                          parameters.spacing);
    Painter painter(terrain, scan, lattice, parameters);
    for (const StrokeSpot& spot : scan.spots())
        painter.paint(spot);
    for (const StrokeLineSpot& spot : scan.lineSpots())
        painter.paint(spot);
    strokes->_finest = scan.finest();
    strokes->_points = painter.points();
    return strokes;
}

bool TileStrokes::madeWith(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid) const
{
    const double equator = ellipsoid ? ellipsoid->getRadiusEquator() : 0.0;
    const double polar = ellipsoid ? ellipsoid->getRadiusPolar() : 0.0;
    return parameters == _parameters && equator == _equator && polar == _polar;
}

bool TileStrokes::madeAt(const osg::Matrixd& toWorld) const
{
    constexpr double least = 0.01; // metres
    if ((toWorld.getTrans() - _toWorld.getTrans()).length2() > least * least) return false;
    // No tile is larger than the Earth.
    constexpr double turned = 1e-9;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (std::abs(toWorld(row, column) - _toWorld(row, column)) > turned) return false;
    return true;
}

} // namespace osgGeoFX
