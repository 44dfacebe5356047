// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/BuildingMesh.h>

#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/town/detail/Openness.h>
#include <osgGeoFX/town/detail/Scatter.h>
#include <osgGeoFX/town/detail/TownGeometry.h>
#include <osgGeoFX/town/detail/WindowPicture.h>

#include <osgUtil/Tessellator>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// The measures of a use, metres.
struct Measures
{
    double storey, window;
};

Measures measuresOf(BuildingUse use)
{
    switch (use)
    {
    case BuildingUse::HOUSE:
        return {2.8, 3.0};
    case BuildingUse::FLATS:
        return {3.0, 3.4};
    case BuildingUse::OFFICE:
        return {3.6, 3.0};
    case BuildingUse::TOWER:
        return {3.6, 2.4};
    case BuildingUse::HALL:
        return {6.0, 7.0};
    }
    return {3.0, 3.0};
}

/// A place on a wall is asked for so far in front of it and, at a corner, so far along it, metres.
constexpr double BEFORE = 0.05, BESIDE = 0.5;

/// One of a building's numbers that look random, 0 to 1.
double chance(std::uint32_t seed, std::uint32_t which)
{
    return scatter(seed ^ (which * 0x9e3779b9u + 0x85ebca6bu));
}

osg::Vec3d pick(const std::vector<osg::Vec3d>& colors, double chance)
{
    return colors[std::min(static_cast<std::size_t>(chance * static_cast<double>(colors.size())),
                           colors.size() - 1)];
}

osg::Vec3d wallColor(BuildingUse use, std::uint32_t seed)
{
    static const std::vector<osg::Vec3d>
        house = {{0.93, 0.91, 0.86}, {0.89, 0.84, 0.74}, {0.82, 0.80, 0.75},
                 {0.80, 0.83, 0.82}, {0.90, 0.80, 0.68}, {0.76, 0.70, 0.62}},
        flats = {{0.92, 0.90, 0.86},
                 {0.87, 0.82, 0.73},
                 {0.83, 0.80, 0.76},
                 {0.78, 0.77, 0.75},
                 {0.90, 0.86, 0.79}},
        office = {{0.83, 0.83, 0.82}, {0.77, 0.75, 0.71}, {0.86, 0.84, 0.80}, {0.70, 0.71, 0.72}},
        tower = {{0.80, 0.86, 0.90}, {0.90, 0.92, 0.93}, {0.72, 0.79, 0.82}, {0.90, 0.88, 0.83}},
        hall = {{0.80, 0.80, 0.79}, {0.74, 0.76, 0.77}, {0.84, 0.82, 0.77}};
    const std::vector<osg::Vec3d>* lists[] = {&house, &flats, &office, &hall, &tower};
    return pick(*lists[static_cast<int>(use)], chance(seed, 1)) * (0.94 + 0.1 * chance(seed, 2));
}

osg::Vec3d roofColor(BuildingUse use, bool gabled, std::uint32_t seed)
{
    static const std::vector<osg::Vec3d> tiles = {{0.55, 0.33, 0.25}, {0.46, 0.36, 0.31}, {0.42, 0.41, 0.41},
                                                  {0.60, 0.42, 0.32}, {0.38, 0.42, 0.42}, {0.50, 0.47, 0.43}},
                                         gravel = {{0.66, 0.65, 0.63},
                                                   {0.72, 0.70, 0.67},
                                                   {0.58, 0.58, 0.58},
                                                   {0.78, 0.77, 0.75}};
    const bool tiled = gabled || use == BuildingUse::HOUSE;
    return pick(tiled ? tiles : gravel, chance(seed, 3)) * (0.92 + 0.14 * chance(seed, 4));
}

osg::Vec4ub bytes(const osg::Vec3d& color)
{
    osg::Vec4ub result(0, 0, 0, 255);
    for (unsigned int i = 0; i < 3; ++i)
        result[i] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(color[i], 0.0, 1.0)));
    return result;
}

double cross(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

} // namespace

struct BuildingMesh::Look
{
    osg::Vec3d wall, roof;
    bool windows = false;
    double storeys = 1.0; ///< up to the eaves, a whole number
    double storey = 3.0;  ///< metres
    double window = 3.0;
};

std::vector<osg::Vec2d> triangulate(const std::vector<Ring>& rings)
{
    std::vector<osg::Vec2d> result;
    const Ring& outline = rings.front();
    if (outline.size() < 3) return result;
    if (rings.size() == 1 && outline.size() <= 4)
    {
        // A triangle, or a convex square: from a corner.
        bool convex = true;
        for (std::size_t i = 0; i < outline.size(); ++i)
        {
            const osg::Vec2d &a = outline[i], &b = outline[(i + 1) % outline.size()],
                             &c = outline[(i + 2) % outline.size()];
            convex = convex && cross(b - a, c - b) > 0.0;
        }
        if (convex)
        {
            for (std::size_t i = 2; i < outline.size(); ++i)
                result.insert(result.end(), {outline[0], outline[i - 1], outline[i]});
            return result;
        }
    }
    // In doubles about the first point, so that floats have digits enough.
    const osg::Vec2d origin = outline.front();
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    std::vector<osg::Vec2d> exact;
    for (const Ring& ring : rings)
    {
        geometry->addPrimitiveSet(new osg::DrawArrays(GL_POLYGON, static_cast<GLint>(vertices->size()),
                                                      static_cast<GLsizei>(ring.size())));
        for (const osg::Vec2d& place : ring)
        {
            exact.push_back(place);
            vertices->push_back(osg::Vec3(osg::Vec3d(place - origin, 0.0)));
        }
    }
    geometry->setVertexArray(vertices);
    osg::ref_ptr<osgUtil::Tessellator> tessellator = new osgUtil::Tessellator;
    tessellator->setTessellationType(osgUtil::Tessellator::TESS_TYPE_GEOMETRY);
    tessellator->setWindingType(osgUtil::Tessellator::TESS_WINDING_ODD);
    tessellator->setTessellationNormal(osg::Vec3(0.0f, 0.0f, 1.0f));
    tessellator->retessellatePolygons(*geometry);
    const auto* made = static_cast<const osg::Vec3Array*>(geometry->getVertexArray());
    const auto at = [&](unsigned int index)
    {
        if (index < exact.size()) return exact[index];
        const osg::Vec3& place = (*made)[index];
        return origin + osg::Vec2d(osg::Vec2(place.x(), place.y()));
    };
    const auto add = [&](unsigned int a, unsigned int b, unsigned int c)
    {
        const osg::Vec2d p = at(a), q = at(b), r = at(c);
        const double twice = cross(q - p, r - p);
        if (twice == 0.0) return;
        if (twice > 0.0)
            result.insert(result.end(), {p, q, r});
        else
            result.insert(result.end(), {p, r, q});
    };
    for (const auto& set : geometry->getPrimitiveSetList())
    {
        const unsigned int count = set->getNumIndices();
        for (unsigned int i = 2; i < count; ++i)
            switch (set->getMode())
            {
            case GL_TRIANGLES:
                if (i % 3 == 2) add(set->index(i - 2), set->index(i - 1), set->index(i));
                break;
            case GL_TRIANGLE_STRIP:
                add(set->index(i - 2), set->index(i - 1), set->index(i));
                break;
            case GL_TRIANGLE_FAN:
            case GL_POLYGON:
                add(set->index(0), set->index(i - 1), set->index(i));
                break;
            default:
                break;
            }
    }
    return result;
}

bool isRectangle(const std::vector<Ring>& rings)
{
    if (rings.size() != 1 || rings.front().size() != 4) return false;
    const Ring& ring = rings.front();
    for (std::size_t i = 0; i < 4; ++i)
    {
        osg::Vec2d in = ring[(i + 1) % 4] - ring[i], out = ring[(i + 2) % 4] - ring[(i + 1) % 4];
        const double lengths = in.length() * out.length();
        // Within eight degrees of a right angle.
        if (!(lengths > 0.0) || std::abs(in * out) > 0.14 * lengths || cross(in, out) <= 0.0) return false;
    }
    return true;
}

unsigned int BuildingMesh::vertex(const osg::Vec3d& place, const osg::Vec3d& normal, const osg::Vec3d& color,
                                  double u, double v)
{
    _places.push_back(osg::Vec3(place));
    _normals.push_back(osg::Vec3(normal));
    _references.push_back(_reference);
    _colors.push_back(bytes(color));
    _texels.emplace_back(static_cast<float>(u), static_cast<float>(v));
    return static_cast<unsigned int>(_places.size() - 1);
}

double roofRise(const PlacedBuilding& building)
{
    if (!building.gabled || !isRectangle(building.rings)) return 0.0;
    const Ring& ring = building.rings.front();
    const double narrow = std::min((ring[1] - ring[0]).length(), (ring[2] - ring[1]).length());
    return std::min(0.36 * narrow, 0.45 * (building.top - std::max(building.reference.z(), building.foot)));
}

std::vector<double> BuildingMesh::shades(const osg::Vec2d& place, const osg::Vec3d& normal,
                                         const std::vector<double>& heights, bool roof) const
{
    std::vector<double> result(heights.size(), 1.0);
    if (!_openness) return result;
    const double ground = static_cast<double>(_reference.z());
    const osg::Vec3d there = osg::Vec3d(place, ground) * _toOpenness;
    std::vector<double> asked;
    for (const double height : heights)
        asked.push_back(there.z() + std::max(height - ground, 0.0));
    _openness->at({there.x(), there.y()}, osg::Matrixd::transform3x3(normal, _toOpenness), there.z(),
                  asked.data(), result.data(), asked.size(), roof ? _number : Openness::none);
    for (double& each : result)
        each = 1.0 - Openness::darkening * (1.0 - each);
    return result;
}

void BuildingMesh::quad(const osg::Vec3d (&corners)[4], const osg::Vec3d& normal,
                        const osg::Vec3d (&colors)[4], const osg::Vec2d& from, const osg::Vec2d& to)
{
    const unsigned int first = vertex(corners[0], normal, colors[0], from.x(), from.y());
    vertex(corners[1], normal, colors[1], to.x(), from.y());
    vertex(corners[2], normal, colors[2], to.x(), to.y());
    vertex(corners[3], normal, colors[3], from.x(), to.y());
    for (const unsigned int corner : {0u, 1u, 2u, 0u, 2u, 3u})
        _triangles.push_back(first + corner);
}

void BuildingMesh::wall(const PlacedBuilding& building, const osg::Vec2d& a, const osg::Vec2d& b,
                        double eaves, const Look& look, bool windows)
{
    const osg::Vec2d along = b - a;
    const double length = along.length();
    if (!(length > 0.0)) return;
    const osg::Vec3d normal(along.y() / length, -along.x() / length, 0.0);
    const double base = building.reference.z(), bottom = building.foot - (building.raised ? 0.0 : _depth);
    // The ground darkens a wall's foot only, so the shades of a high wall need a corner there.
    const bool high = _openness && eaves - base > 2.0 * Openness::groundReach;
    std::vector<double> heights = {base, eaves};
    if (high) heights.insert(heights.begin() + 1, base + Openness::groundReach);
    const osg::Vec2d inward = along * (std::min(BESIDE, 0.25 * length) / length),
                     before = osg::Vec2d(normal.x(), normal.y()) * BEFORE;
    const std::vector<double> left = shades(a + inward + before, normal, heights, false),
                              right = shades(b - inward + before, normal, heights, false);
    const auto shaded = [&](const std::vector<double>& shades, double z)
    {
        // Without the openness, walls are a little darker near the ground, where less of the sky lights them.
        if (!_openness)
            return look.wall *
                   (0.84 + 0.16 * std::clamp((z - base) / std::max(eaves - base, 1e-3), 0.0, 1.0));
        std::size_t i = high && z > heights[1] ? 1 : 0;
        const double share =
            std::clamp((z - heights[i]) / std::max(heights[i + 1] - heights[i], 1e-3), 0.0, 1.0);
        return look.wall * (shades[i] + share * (shades[i + 1] - shades[i]));
    };
    const auto piece = [&](double from, double to, const osg::Vec2d& texelFrom, const osg::Vec2d& texelTo)
    {
        if (!(to > from)) return;
        const osg::Vec3d corners[4] = {
            {a.x(), a.y(), from}, {b.x(), b.y(), from}, {b.x(), b.y(), to}, {a.x(), a.y(), to}};
        const osg::Vec3d colors[4] = {shaded(left, from), shaded(right, from), shaded(right, to),
                                      shaded(left, to)};
        quad(corners, normal, colors, texelFrom, texelTo);
    };
    const auto part = [&](double from, double to, const osg::Vec2d& texelFrom, const osg::Vec2d& texelTo)
    {
        if (!high || !(from < heights[1] && heights[1] < to))
        {
            piece(from, to, texelFrom, texelTo);
            return;
        }
        const double middle =
            texelFrom.y() + (texelTo.y() - texelFrom.y()) * (heights[1] - from) / (to - from);
        piece(from, heights[1], texelFrom, {texelTo.x(), middle});
        piece(heights[1], to, {texelFrom.x(), middle}, texelTo);
    };
    // Shorter ones have no room for a window.
    if (!windows || length < 0.6 * look.window)
    {
        part(bottom, eaves, WindowPicture::plain(), WindowPicture::plain());
        return;
    }
    const double count = std::max(1.0, std::round(length / look.window));
    const double first = std::floor(
        WindowPicture::columns * chance(building.seed, 5 + static_cast<std::uint32_t>(std::lround(length))));
    const double start = first / WindowPicture::columns, end = (first + count) / WindowPicture::columns;
    const auto row = [&](double storeys)
    {
        return WindowPicture::storey(building.use, storeys);
    };
    const double cellar = base - WindowPicture::ground * look.storey;
    part(bottom, std::min(cellar, eaves), WindowPicture::plain(), WindowPicture::plain());
    double from = std::max(bottom, cellar);
    double done = 0.0; // storeys below, whole pictures of them
    while (base + (done + WindowPicture::above) * look.storey <= from)
        done += WindowPicture::above;
    while (from < eaves)
    {
        const double to = std::min(eaves, base + (done + WindowPicture::above) * look.storey);
        part(from, to, {start, row((from - base) / look.storey - done)},
             {end, row((to - base) / look.storey - done)});
        from = to;
        done += WindowPicture::above;
    }
}

void BuildingMesh::flatRoof(const std::vector<Ring>& rings, double z, const osg::Vec3d& color)
{
    const osg::Vec3d up(0.0, 0.0, 1.0);
    const osg::Vec2d plain = WindowPicture::plain();
    const std::vector<osg::Vec2d> triangles = triangulate(rings);
    std::map<std::pair<double, double>, double> known;
    const auto corner = [&](const osg::Vec2d& place)
    {
        const auto [found, isNew] = known.try_emplace({place.x(), place.y()}, 1.0);
        if (isNew) found->second = shades(place, up, {z}, true).front();
        return vertex({place.x(), place.y(), z}, up, color * found->second, plain.x(), plain.y());
    };
    // The corners of a square serve both triangles.
    std::vector<unsigned int> corners;
    if (rings.size() == 1 && triangles.size() == 6 && rings.front().size() == 4)
        for (const osg::Vec2d& place : triangles)
            for (unsigned int i = 0; i < 4; ++i)
                if (rings.front()[i] == place)
                {
                    corners.push_back(i);
                    break;
                }
    if (corners.size() == 6)
    {
        const auto first = static_cast<unsigned int>(_places.size());
        for (const osg::Vec2d& place : rings.front())
            corner(place);
        for (const unsigned int each : corners)
            _triangles.push_back(first + each);
        return;
    }
    for (const osg::Vec2d& place : triangles)
        _triangles.push_back(corner(place));
}

void BuildingMesh::floor(const PlacedBuilding& building, const osg::Vec3d& color)
{
    const osg::Vec2d plain = WindowPicture::plain();
    const std::vector<osg::Vec2d> triangles = triangulate(building.rings);
    const osg::Vec3d down(0.0, 0.0, -1.0);
    // The other way around, to be seen from below.
    for (auto place = triangles.rbegin(); place != triangles.rend(); ++place)
        _triangles.push_back(vertex({place->x(), place->y(), building.foot}, down,
                                    color * (1.0 - Openness::darkening), plain.x(), plain.y()));
}

void BuildingMesh::face(const std::vector<osg::Vec3d>& corners, const osg::Vec3d& color)
{
    osg::Vec3d normal = (corners[1] - corners[0]) ^ (corners[2] - corners[0]);
    normal.normalize();
    const osg::Vec2d plain = WindowPicture::plain();
    const auto first = static_cast<unsigned int>(_places.size());
    for (const osg::Vec3d& corner : corners)
    {
        // As if it were level: two slopes that meet have one shade there.
        const double shade =
            shades({corner.x(), corner.y()}, osg::Vec3d(0.0, 0.0, 1.0), {corner.z()}, true).front();
        vertex(corner, normal, color * shade, plain.x(), plain.y());
    }
    for (unsigned int i = 2; i < corners.size(); ++i)
        _triangles.insert(_triangles.end(), {first, first + i - 1, first + i});
}

void BuildingMesh::gable(const PlacedBuilding& building, double eaves, const Look& look)
{
    const Ring& ring = building.rings.front();
    // The ridge runs along the longer sides.
    const std::size_t first = (ring[1] - ring[0]).length() >= (ring[2] - ring[1]).length() ? 0 : 1;
    const auto corner = [&](std::size_t i)
    {
        const osg::Vec2d& place = ring[(first + i) % 4];
        return osg::Vec3d(place.x(), place.y(), eaves);
    };
    osg::Vec3d start = (corner(3) + corner(0)) * 0.5, end = (corner(1) + corner(2)) * 0.5;
    start.z() = end.z() = building.top;
    face({corner(0), corner(1), end, start}, look.roof);
    face({corner(2), corner(3), start, end}, look.roof);
    face({corner(1), corner(2), end}, look.wall);
    face({corner(3), corner(0), start}, look.wall);
}

void BuildingMesh::add(const PlacedBuilding& building, BuildingLevel level, std::size_t number)
{
    if (building.rings.empty() || building.rings.front().size() < 3) return;
    _reference = osg::Vec3(building.reference);
    _number = number;
    const bool detail = level == BuildingLevel::DETAIL;
    const double rise = roofRise(building);
    const bool gabled = rise > 0.0;
    const double eaves = detail ? building.top - rise : meanTop(building);
    Look look;
    look.wall = wallColor(building.use, building.seed);
    look.roof = roofColor(building.use, building.gabled, building.seed);
    if (!detail)
    {
        // From afar the windows are one with the wall.
        const osg::Vec3d mean = WindowPicture::mean(building.use);
        look.wall = osg::componentMultiply(look.wall, mean);
    }
    const Measures measures = measuresOf(building.use);
    look.window = measures.window;
    look.storeys = std::max(1.0, std::round((eaves - building.reference.z()) / measures.storey));
    look.storey = (eaves - building.reference.z()) / look.storeys;
    for (const Ring& ring : building.rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
            wall(building, ring[i], ring[(i + 1) % ring.size()], eaves, look, detail);
    if (building.raised) floor(building, look.wall);
    if (detail && gabled)
        gable(building, eaves, look);
    else
        flatRoof(building.rings, eaves, look.roof);
}

osg::ref_ptr<osg::Geometry> BuildingMesh::create() const
{
    if (_triangles.empty()) return nullptr;
    osg::ref_ptr<osg::Geometry> geometry = TownGeometry::create(_places, _colors, _triangles);
    // Bytes do, since each face has one normal.
    osg::ref_ptr<osg::Vec3bArray> normals = new osg::Vec3bArray(osg::Array::BIND_PER_VERTEX);
    normals->setNormalize(true);
    for (const osg::Vec3& normal : _normals)
        normals->push_back(osg::Vec3b(static_cast<signed char>(std::lround(127.0f * normal.x())),
                                      static_cast<signed char>(std::lround(127.0f * normal.y())),
                                      static_cast<signed char>(std::lround(127.0f * normal.z()))));
    geometry->setNormalArray(TownGeometry::withOwnBuffer(normals));
    geometry->setTexCoordArray(
        0, TownGeometry::withOwnBuffer(new osg::Vec2Array(_texels.begin(), _texels.end())));
    RigidParts::finish(*geometry, _references);
    return geometry;
}

} // namespace osgGeoFX
