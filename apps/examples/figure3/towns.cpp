// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// D: two towns in one place. The houses are made up; they stand where the land cover has Honolulu's.
#include "Figures.h"

#include <osgGeoFX/mapping/GeometrySwap.h>
#include <osgGeoFX/mapping/MarkImages.h>

#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

using namespace osgGeoFX;

namespace figure3
{

namespace
{

constexpr double cellar = 6.0; ///< metres that walls reach into the ground, for slopes

/// Collects flat faces; places are metres about the town's middle.
class Mesh
{
public:
    void face(const std::vector<osg::Vec3d>& corners, const osg::Vec4& color)
    {
        osg::Vec3d normal = (corners[1] - corners[0]) ^ (corners[2] - corners[0]);
        normal.normalize();
        for (std::size_t i = 2; i < corners.size(); ++i)
        {
            for (const osg::Vec3d& corner : {corners[0], corners[i - 1], corners[i]})
            {
                _vertices->push_back(osg::Vec3(corner));
                _normals->push_back(osg::Vec3(normal));
                _colors->push_back(color);
            }
        }
    }

    osg::ref_ptr<osg::Geometry> take() const
    {
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setVertexArray(_vertices);
        geometry->setNormalArray(_normals, osg::Array::BIND_PER_VERTEX);
        geometry->setColorArray(_colors, osg::Array::BIND_PER_VERTEX);
        geometry->addPrimitiveSet(
            new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(_vertices->size())));
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        return geometry;
    }

private:
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> _normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> _colors = new osg::Vec4Array;
};

struct House
{
    osg::Vec2d middle, half;
    double wall = 6.0; ///< metres
    double roof = 0.0; ///< of the ridge above the walls; 0: flat
    osg::Vec4 wallColor, roofColor;
};

class Town
{
public:
    Town(const Island& island, const osg::Vec2d& middle, const osg::Vec2d& half)
        : _island(island), _middle(middle), _low(middle - half), _high(middle + half),
          _built(island.landCover().blank())
    {
        const Grid& cover = island.landCover();
        for (int row = cover.rowOf(_low.y()) - 1; row <= cover.rowOf(_high.y()) + 1; ++row)
            for (int column = cover.columnOf(_low.x()) - 1; column <= cover.columnOf(_high.x()) + 1; ++column)
                _built.at(column, row) =
                    cover.at(column, row) >= TOWN && cover.at(column, row) <= INDUSTRIAL ? 1.0f : 0.0f;
        makeHouses();
    }

    osg::ref_ptr<osg::Geometry> houses() const
    {
        Mesh mesh;
        for (const House& house : _houses)
            addHouse(mesh, house);
        return mesh.take();
    }

    /// Blocks between the streets, as high as their houses are on average.
    osg::ref_ptr<osg::Geometry> blocks() const;

private:
    void makeHouses();
    void addHouse(Mesh& mesh, const House& house) const;
    osg::Vec3d at(const osg::Vec2d& place, double above) const
    {
        return {place - _middle, _island.heights().smooth(place) + above};
    }

    const Island& _island;
    osg::Vec2d _middle, _low, _high;
    Grid _built; ///< 1 where the land cover has houses
    std::vector<House> _houses;
};

osg::Vec4 tinted(const osg::Vec4& color, double factor)
{
    const auto part = [&](float c)
    {
        return static_cast<float>(std::min(static_cast<double>(c) * factor, 1.0));
    };
    return {part(color.r()), part(color.g()), part(color.b()), 1.0f};
}

void Town::makeHouses()
{
    std::minstd_rand engine(3);
    const auto random = [&](double low, double high)
    {
        return low + (high - low) * static_cast<double>(engine() - 1) / 2147483646.0;
    };
    // Where it is high: downtown, Kakaʻako and Waikīkī.
    const std::array<osg::Vec2d, 3> centers = {
        _island.place(-157.860, 21.3085), _island.place(-157.846, 21.2945), _island.place(-157.829, 21.2805)};
    constexpr double lot = 27.0;
    for (double y = _low.y(); y < _high.y(); y += lot)
    {
        for (double x = _low.x(); x < _high.x(); x += lot)
        {
            House house;
            house.middle = osg::Vec2d(x + random(-2.0, 2.0), y + random(-2.0, 2.0));
            house.half = osg::Vec2d(random(6.5, 11.0), random(6.5, 11.0));
            double rise = 0.0;
            for (const osg::Vec2d& center : centers)
                rise = std::max(rise, std::exp(-(house.middle - center).length2() / (620.0 * 620.0)));
            const bool flat = random(0.0, 1.0) < 0.15 + rise;
            house.wall =
                random(5.0, 9.0) + (flat ? 6.0 * rise + 85.0 * rise * std::pow(random(0.0, 1.0), 3.0) : 0.0);
            house.roof = flat ? 0.0 : random(2.5, 4.5);
            const osg::Vec4 wall = random(0.0, 1.0) < 0.6 ? osg::Vec4(0.95f, 0.92f, 0.86f, 1.0f)
                                                          : osg::Vec4(0.84f, 0.80f, 0.74f, 1.0f);
            house.wallColor = tinted(wall, random(0.90, 1.05));
            house.roofColor =
                tinted(flat ? osg::Vec4(0.78f, 0.78f, 0.78f, 1.0f) : osg::Vec4(0.74f, 0.38f, 0.27f, 1.0f),
                       random(0.85, 1.1));
            bool free = true;
            for (const int i : {-1, 1})
                for (const int j : {-1, 1})
                    free = free && _built.smooth(house.middle +
                                                 osg::Vec2d(i * house.half.x(), j * house.half.y())) > 0.62;
            if (free) _houses.push_back(house);
        }
    }
}

void Town::addHouse(Mesh& mesh, const House& house) const
{
    const osg::Vec3d ground = at(house.middle, 0.0);
    const auto corner = [&](int i, double z)
    {
        const double dx = i % 4 == 0 || i % 4 == 3 ? -house.half.x() : house.half.x();
        const double dy = i % 4 < 2 ? -house.half.y() : house.half.y();
        return ground + osg::Vec3d(dx, dy, z);
    };
    const double top = house.wall;
    for (int i = 0; i < 4; ++i)
        mesh.face({corner(i, -cellar), corner(i + 1, -cellar), corner(i + 1, top), corner(i, top)},
                  house.wallColor);
    if (house.roof <= 0.0)
    {
        mesh.face({corner(0, top), corner(1, top), corner(2, top), corner(3, top)}, house.roofColor);
        return;
    }
    // The ridge runs along the longer side.
    const int first = house.half.x() > house.half.y() ? 0 : 1;
    const osg::Vec3d up(0.0, 0.0, house.roof);
    const osg::Vec3d start = (corner(first + 3, top) + corner(first, top)) / 2.0 + up;
    const osg::Vec3d end = (corner(first + 1, top) + corner(first + 2, top)) / 2.0 + up;
    mesh.face({corner(first, top), corner(first + 1, top), end, start}, house.roofColor);
    mesh.face({corner(first + 2, top), corner(first + 3, top), start, end}, house.roofColor);
    mesh.face({corner(first + 1, top), corner(first + 2, top), end}, house.wallColor);
    mesh.face({corner(first + 3, top), corner(first, top), start}, house.wallColor);
}

/// Numbers the parts that hang together of what is above a threshold; −1 elsewhere. Two corners of a triangle of the
/// grid, whose squares are cut from the lower left to the upper right, hang together.
Grid numberParts(const Grid& field, float threshold)
{
    Grid parts = field.blank();
    float count = 0.0f;
    std::vector<std::array<int, 2>> open;
    for (int row = 0; row < field.rows(); ++row)
        for (int column = 0; column < field.columns(); ++column)
            if (field.at(column, row) < threshold) parts.at(column, row) = -1.0f;
    for (int i = 0; i < field.rows() * field.columns(); ++i)
    {
        const int column = i % field.columns();
        const int row = i / field.columns();
        if (parts.at(column, row) < 0.0f || parts.at(column, row) > 0.0f) continue;
        parts.at(column, row) = ++count;
        open.push_back({column, row});
        while (!open.empty())
        {
            const auto [x, y] = open.back();
            open.pop_back();
            constexpr int steps[6][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}};
            for (const auto& step : steps)
            {
                const int nextX = x + step[0];
                const int nextY = y + step[1];
                const bool inside =
                    nextX >= 0 && nextY >= 0 && nextX < field.columns() && nextY < field.rows();
                if (!inside || parts.at(nextX, nextY) < 0.0f || parts.at(nextX, nextY) > 0.0f) continue;
                parts.at(nextX, nextY) = count;
                open.push_back({nextX, nextY});
            }
        }
    }
    return parts;
}

osg::ref_ptr<osg::Geometry> Town::blocks() const
{
    constexpr float threshold = 0.55f;
    Grid field(_low, _high, 12.0);
    for (int row = 1; row < field.rows() - 1; ++row)
        for (int column = 1; column < field.columns() - 1; ++column)
            field.at(column, row) = static_cast<float>(_built.smooth(field.middle(column, row)));
    const Grid parts = numberParts(field, threshold);

    struct Sum
    {
        double heights = 0.0, houses = 0.0;
    };
    std::map<float, Sum> sums;
    for (const House& house : _houses)
    {
        Sum& sum = sums[parts.nearest(house.middle)];
        sum.heights += house.wall + house.roof / 2.0;
        sum.houses += 1.0;
    }
    const auto heightOf = [&](float part)
    {
        const auto found = sums.find(part);
        return found == sums.end() ? 7.0 : found->second.heights / found->second.houses;
    };

    Mesh mesh;
    const osg::Vec4 top(0.92f, 0.83f, 0.70f, 1.0f);
    const osg::Vec4 wall(0.76f, 0.65f, 0.53f, 1.0f);
    using Corner = std::array<int, 2>;
    // What of a triangle is above the threshold, with a wall where it is cut.
    const auto addTriangle = [&](const std::array<Corner, 3>& corners)
    {
        std::vector<osg::Vec2d> outline;
        std::vector<bool> cut; // whether a place of the outline lies on the threshold
        float part = -1.0f;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto [c, r] = corners[i];
            const auto [nextC, nextR] = corners[(i + 1) % 3];
            const float here = field.at(c, r);
            const float next = field.at(nextC, nextR);
            if (here >= threshold)
            {
                outline.push_back(field.middle(c, r));
                cut.push_back(false);
                part = parts.at(c, r);
            }
            if ((here >= threshold) == (next >= threshold)) continue;
            const double share = static_cast<double>((threshold - here) / (next - here));
            outline.push_back(field.middle(c, r) * (1.0 - share) + field.middle(nextC, nextR) * share);
            cut.push_back(true);
        }
        if (outline.empty()) return;
        const double height = heightOf(part);
        std::vector<osg::Vec3d> face;
        for (const osg::Vec2d& place : outline)
            face.push_back(at(place, height));
        mesh.face(face, top);
        for (std::size_t i = 0; i < outline.size(); ++i)
        {
            const std::size_t next = (i + 1) % outline.size();
            if (!cut[i] || !cut[next]) continue;
            mesh.face({at(outline[i], -cellar), at(outline[next], -cellar), at(outline[next], height),
                       at(outline[i], height)},
                      wall);
        }
    };
    for (int row = 0; row + 1 < field.rows(); ++row)
    {
        for (int column = 0; column + 1 < field.columns(); ++column)
        {
            const Corner low = {column, row};
            const Corner high = {column + 1, row + 1};
            addTriangle({low, Corner{column + 1, row}, high});
            addTriangle({low, high, Corner{column, row + 1}});
        }
    }
    return mesh.take();
}

/// How far inwards a place lies in the mask, −1…1: a round shape with a few bays.
double maskShape(double x, double y)
{
    const double angle = std::atan2(y, x);
    return 0.84 - std::hypot(x, y) + 0.09 * std::sin(3.0 * angle + 0.6) + 0.05 * std::sin(5.0 * angle);
}

} // namespace

Shot towns(Island& island)
{
    const osg::Vec2d middle = island.place(-157.843, 21.3055);
    const Town town(island, middle, {4000.0, 3200.0});

    // Beside the terrain, so that the sun and the effects are its own.
    const Georeference& reference = *island.scene.reference;
    const osg::EllipsoidModel* ellipsoid = island.scene.effects->ground().ellipsoid;
    const osg::Vec3d world =
        island.mappings->positionOf({middle, 0.0}, ellipsoid) * island.mappings->frameToWorld(ellipsoid);
    double longitude = 0.0;
    double latitude = 0.0;
    double height = 0.0;
    reference.toGeodetic(world, longitude, latitude, height);
    osg::Matrixd frame;
    reference.localToWorld(longitude, latitude, 0.0, frame);
    const osg::ref_ptr<osg::MatrixTransform> ground = new osg::MatrixTransform(frame);
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    ground->getOrCreateStateSet()->setAttributeAndModes(material);
    const osg::ref_ptr<osg::Group> houses = new osg::Group;
    houses->addChild(town.houses());
    const osg::ref_ptr<osg::Group> blocks = new osg::Group;
    blocks->addChild(town.blocks());
    ground->addChild(houses);
    ground->addChild(blocks);
    island.scene.effects->getChild(0)->asGroup()->addChild(ground);

    const osg::Vec2d focus = island.place(-157.8505, 21.3010);
    const osg::Vec2d half(1500.0, 1250.0);
    const osg::ref_ptr<DataLayer> mask =
        new DataLayer(makeMark(1024,
                               [](double x, double y, double texel)
                               {
                                   const auto cover = static_cast<float>(markCover(maskShape(x, y), texel));
                                   return osg::Vec4(cover, cover, cover, cover);
                               }));
    island.keep(swapGeometries(*houses, *blocks, *island.scene.effects, *island.mappings, mask, focus,
                               half.x(), half.y())
                    .release());

    // The border, on the ground alone.
    osg::ref_ptr<ProjectiveMapping> border = new ProjectiveMapping;
    border->setLayer(new DataLayer(makeMark(1024,
                                            [](double x, double y, double texel)
                                            {
                                                const double away = 0.008 - std::abs(maskShape(x, y));
                                                return osg::Vec4(0.93f, 0.36f, 0.10f,
                                                                 static_cast<float>(markCover(away, texel)));
                                            })));
    border->setRectangle(focus, half.x(), half.y());
    border->setChannels(252);
    island.mappings->addMapping(border);
    return {"-157.8702,21.2880,1500,55,-31", 38.0, {}, nullptr};
}

} // namespace figure3
