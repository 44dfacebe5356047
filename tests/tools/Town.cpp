// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/RandomSamples.h>
#include <tools/Town.h>

#include <algorithm>
#include <cmath>

namespace geofx::test
{

namespace
{

struct House
{
    osg::Vec2d low, high;
    double wall = 6.0; ///< height, metres
    double roof = 0.0; ///< of the ridge above the walls
    osg::Vec4 wallColor, roofColor;
};

osg::Vec2d half(const TownPlan& plan)
{
    const double pitch = plan.block + plan.street;
    return osg::Vec2d(plan.blocksAcross, plan.blocksAlong) * (pitch / 2.0);
}

/// How far a place is from the middle of the river, which winds from south to north.
double fromRiver(const TownPlan& plan, const osg::Vec2d& place)
{
    const osg::Vec2d from = place - plan.center;
    const double size = std::max(half(plan).y(), 1.0);
    return std::abs(from.x() - 0.22 * size - 0.16 * size * std::sin(2.6 * from.y() / size));
}

double groundAt(const TownPlan& plan, double x, double y)
{
    return plan.height ? plan.height(x, y) : 0.0;
}

osg::Vec4 tinted(Random& random, const osg::Vec4& color, double spread)
{
    const auto factor = static_cast<float>(random.uniform(1.0 - spread, 1.0 + spread));
    return {std::min(color.x() * factor, 1.0f), std::min(color.y() * factor, 1.0f),
            std::min(color.z() * factor, 1.0f), 1.0f};
}

std::vector<House> housesOf(const TownPlan& plan, const osg::Vec2d& block, std::uint64_t number)
{
    Random random(plan.seed * 100003 + number);
    std::vector<House> houses;
    const double middle =
        1.0 - std::min((block - plan.center).length() / std::max(half(plan).length(), 1.0), 1.0);
    const int columns = random.integer(2, 3);
    const int rows = random.integer(2, 3);
    const double width = plan.block / columns;
    const double depth = plan.block / rows;
    for (int i = 0; i < columns * rows; ++i)
    {
        const int row = i / columns;
        const osg::Vec2d corner =
            block + osg::Vec2d((i % columns) * width - plan.block / 2.0, row * depth - plan.block / 2.0);
        House house;
        house.low = corner + osg::Vec2d(random.uniform(1.0, 0.16 * width), random.uniform(1.0, 0.16 * depth));
        house.high = corner + osg::Vec2d(width - random.uniform(1.0, 0.16 * width),
                                         depth - random.uniform(1.0, 0.16 * depth));
        const bool flat = random.uniform(0.0, 1.0) < 0.2 + 0.9 * middle * middle;
        house.wall =
            random.uniform(6.0, 10.0) + (flat ? random.logarithmic(4.0, 45.0) * middle * middle : 0.0);
        house.roof = flat ? 0.0 : random.uniform(3.0, 5.0);
        house.wallColor = tinted(random,
                                 random.integer(0, 2) ? osg::Vec4(0.93f, 0.90f, 0.83f, 1.0f)
                                                      : osg::Vec4(0.86f, 0.78f, 0.68f, 1.0f),
                                 0.07);
        house.roofColor = tinted(
            random, flat ? osg::Vec4(0.66f, 0.66f, 0.67f, 1.0f) : osg::Vec4(0.70f, 0.34f, 0.24f, 1.0f), 0.12);
        houses.push_back(house);
    }
    return houses;
}

/// Collects flat faces.
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

    void house(const House& house, double ground, double below)
    {
        const double bottom = ground - below;
        const double top = ground + house.wall;
        const osg::Vec2d corners[4] = {
            house.low, {house.high.x(), house.low.y()}, house.high, {house.low.x(), house.high.y()}};
        const auto at = [&](int i, double z)
        {
            return osg::Vec3d(corners[i % 4].x(), corners[i % 4].y(), z);
        };
        for (int i = 0; i < 4; ++i)
            face({at(i, bottom), at(i + 1, bottom), at(i + 1, top), at(i, top)}, house.wallColor);
        if (house.roof <= 0.0)
        {
            face({at(0, top), at(1, top), at(2, top), at(3, top)}, house.roofColor);
            return;
        }
        // The ridge runs along the longer side.
        const bool along = house.high.x() - house.low.x() > house.high.y() - house.low.y();
        const int first = along ? 0 : 1;
        const osg::Vec3d up(0.0, 0.0, house.roof);
        const osg::Vec3d start = (at(first + 3, top) + at(first, top)) / 2.0 + up;
        const osg::Vec3d end = (at(first + 1, top) + at(first + 2, top)) / 2.0 + up;
        face({at(first, top), at(first + 1, top), end, start}, house.roofColor);
        face({at(first + 2, top), at(first + 3, top), start, end}, house.roofColor);
        face({at(first + 1, top), at(first + 2, top), end}, house.wallColor);
        face({at(first + 3, top), at(first, top), start}, house.wallColor);
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

constexpr double cellar = 8.0; ///< metres that walls reach into the ground, for slopes

} // namespace

std::vector<osg::Vec2d> townBlocks(const TownPlan& plan)
{
    const double pitch = plan.block + plan.street;
    std::vector<osg::Vec2d> blocks;
    for (int i = 0; i < plan.blocksAcross * plan.blocksAlong; ++i)
    {
        const int row = i / plan.blocksAcross;
        const osg::Vec2d block =
            plan.center - half(plan) + osg::Vec2d(i % plan.blocksAcross + 0.5, row + 0.5) * pitch;
        if (plan.river <= 0.0 || fromRiver(plan, block) > (plan.river + plan.block) / 2.0 + 4.0)
            blocks.push_back(block);
    }
    return blocks;
}

osg::ref_ptr<osg::Geometry> makeTown(const TownPlan& plan)
{
    Mesh mesh;
    const std::vector<osg::Vec2d> blocks = townBlocks(plan);
    for (std::size_t i = 0; i < blocks.size(); ++i)
    {
        for (const House& house : housesOf(plan, blocks[i], i))
        {
            const osg::Vec2d middle = (house.low + house.high) / 2.0;
            mesh.house(house, groundAt(plan, middle.x(), middle.y()), cellar);
        }
    }
    return mesh.take();
}

osg::ref_ptr<osg::Geometry> makeGeneralisedTown(const TownPlan& plan)
{
    Mesh mesh;
    const std::vector<osg::Vec2d> blocks = townBlocks(plan);
    for (std::size_t i = 0; i < blocks.size(); ++i)
    {
        const osg::Vec2d side(plan.block / 2.0, plan.block / 2.0);
        House prism{blocks[i] - side,           blocks[i] + side, 0.0, 0.0, {0.80f, 0.79f, 0.80f, 1.0f},
                    {0.90f, 0.88f, 0.86f, 1.0f}};
        const std::vector<House> houses = housesOf(plan, blocks[i], i);
        for (const House& house : houses)
            prism.wall += (house.wall + house.roof / 2.0) / static_cast<double>(houses.size());
        mesh.house(prism, groundAt(plan, blocks[i].x(), blocks[i].y()), cellar);
    }
    return mesh.take();
}

osg::ref_ptr<osg::Geometry> makeTownGround(const TownPlan& plan, double margin)
{
    Mesh mesh;
    // Fine enough for the river banks to look round.
    const double cell = std::max(plan.street / 5.0, 1.0);
    const osg::Vec2d reach = half(plan) + osg::Vec2d(margin, margin);
    const osg::Vec2d low = plan.center - reach;
    const int columns = static_cast<int>(std::ceil(2.0 * reach.x() / cell));
    const int rows = static_cast<int>(std::ceil(2.0 * reach.y() / cell));
    const auto corner = [&](int column, int row)
    {
        const osg::Vec2d place = low + osg::Vec2d(column, row) * cell;
        return osg::Vec3d(place.x(), place.y(), groundAt(plan, place.x(), place.y()));
    };
    const double pitch = plan.block + plan.street;
    for (int i = 0; i < columns * rows; ++i)
    {
        const int column = i % columns;
        const int row = i / columns;
        const osg::Vec2d place = low + osg::Vec2d(column + 0.5, row + 0.5) * cell;
        const osg::Vec2d within = place - plan.center + half(plan);
        const auto inBlock = [&](double along)
        {
            return std::abs(along / pitch - std::floor(along / pitch) - 0.5) * pitch < plan.block / 2.0;
        };
        const bool town = within.x() > 0.0 && within.y() > 0.0 && within.x() < 2.0 * half(plan).x() &&
                          within.y() < 2.0 * half(plan).y();
        osg::Vec4 color = town ? osg::Vec4(0.60f, 0.60f, 0.60f, 1.0f) : osg::Vec4(0.55f, 0.66f, 0.44f, 1.0f);
        if (town && inBlock(within.x()) && inBlock(within.y())) color = osg::Vec4(0.68f, 0.74f, 0.58f, 1.0f);
        if (fromRiver(plan, place) < plan.river / 2.0) color = osg::Vec4(0.42f, 0.58f, 0.72f, 1.0f);
        mesh.face({corner(column, row), corner(column + 1, row), corner(column + 1, row + 1),
                   corner(column, row + 1)},
                  color);
    }
    return mesh.take();
}

} // namespace geofx::test
