// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The meshes of buildings: closed walls, faces outward, roofs as large as the outline, and what RigidParts needs.
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/town/detail/BlockMaker.h>
#include <osgGeoFX/town/detail/BuildingMesh.h>
#include <osgGeoFX/town/detail/BuildingReader.h>
#include <osgGeoFX/town/detail/WindowPicture.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <map>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double DEPTH = 3.0;

/// Area by OGR.
double areaOf(const std::vector<Ring>& rings)
{
    OGRPolygon polygon;
    for (const Ring& ring : rings)
    {
        OGRLinearRing line;
        for (const osg::Vec2d& place : ring)
            line.addPoint(place.x(), place.y());
        line.closeRings();
        polygon.addRing(&line);
    }
    return polygon.get_Area();
}

PlacedBuilding building(std::vector<Ring> rings, double base, double height)
{
    PlacedBuilding result;
    const osg::Vec2d middle = ringMiddle(rings.front());
    result.reference.set(middle.x(), middle.y(), base);
    result.foot = base - 1.0;
    result.top = base + height;
    result.area = areaOf(rings);
    result.rings = std::move(rings);
    return result;
}

/// A star of so many corners, which has no symmetry.
Ring star(Random& random, const osg::Vec2d& middle, int corners, double inner, double outer)
{
    Ring ring;
    for (int i = 0; i < corners; ++i)
    {
        const double angle = 2.0 * osg::PI * (i + random.uniform(-0.3, 0.3)) / corners,
                     r = random.uniform(inner, outer);
        ring.push_back(middle + osg::Vec2d(std::cos(angle), std::sin(angle)) * r);
    }
    return ring;
}

struct Face
{
    osg::Vec3d corners[3], normal, given;
    double area = 0.0;
};

std::vector<Face> facesOf(const osg::Geometry& geometry)
{
    const DrawableTriangles mesh(geometry);
    const auto* normals = static_cast<const osg::Vec3bArray*>(geometry.getNormalArray());
    std::vector<Face> faces;
    for (std::size_t i = 0; i < mesh.corners().size(); i += 3)
    {
        Face face;
        for (std::size_t c = 0; c < 3; ++c)
            face.corners[c] = mesh.positions()[mesh.corners()[i + c]];
        face.normal = (face.corners[1] - face.corners[0]) ^ (face.corners[2] - face.corners[0]);
        face.area = 0.5 * face.normal.length();
        face.normal.normalize();
        const osg::Vec3b& byte = (*normals)[mesh.corners()[i]];
        face.given.set(byte.x() / 127.0, byte.y() / 127.0, byte.z() / 127.0);
        faces.push_back(face);
    }
    return faces;
}

bool isWall(const Face& face)
{
    return std::abs(face.normal.z()) < 1e-3;
}

/// What faces upward covers the outline once; what is upright has the outline's length at each height below the eaves.
void check(const PlacedBuilding& each, BuildingLevel level)
{
    BuildingMesh mesh(DEPTH);
    mesh.add(each, level);
    const osg::ref_ptr<osg::Geometry> geometry = mesh.create();
    ASSERT_TRUE(geometry);
    const std::vector<Face> faces = facesOf(*geometry);
    double covered = 0.0, volume = 0.0, lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (const Face& face : faces)
    {
        EXPECT_GT(face.normal * face.given, 0.98);
        EXPECT_GT(face.normal.z(), -1e-3);
        if (face.normal.z() > 1e-3) covered += face.area * face.normal.z();
        for (const osg::Vec3d& corner : face.corners)
        {
            lowest = std::min(lowest, corner.z());
            highest = std::max(highest, corner.z());
        }
        // The volume above the lowest wall's foot, by the divergence theorem; there is no floor, at which z is 0.
        const osg::Vec3d down(0.0, 0.0, each.foot - DEPTH);
        const osg::Vec3d a = face.corners[0] - down, b = face.corners[1] - down, c = face.corners[2] - down;
        volume += a * (b ^ c) / 6.0;
    }
    const double area = areaOf(each.rings), height = each.top - each.foot + DEPTH;
    // Floats of some tens of metres.
    EXPECT_NEAR(covered, area, 1e-4 * area);
    EXPECT_NEAR(lowest, each.foot - DEPTH, 1e-3);
    if (level == BuildingLevel::DETAIL || !each.gabled)
    {
        EXPECT_NEAR(highest, each.top, 1e-3);
    }
    // Closed and outward: a prism's volume, or less below a gabled roof.
    if (each.gabled)
    {
        EXPECT_LT(volume, area * height);
        EXPECT_GT(volume, 0.6 * area * height);
    }
    else
    {
        EXPECT_NEAR(volume, area * height, 2e-4 * area * height);
    }
    // Each horizontal edge between faces belongs to two of them, but those at the foot.
    using Point = std::tuple<long, long, long>;
    const auto key = [](const osg::Vec3d& place)
    {
        return Point(std::lround(place.x() * 200.0), std::lround(place.y() * 200.0),
                     std::lround(place.z() * 200.0));
    };
    std::map<std::pair<Point, Point>, int> edges;
    for (const Face& face : faces)
        for (std::size_t c = 0; c < 3; ++c)
            ++edges[{key(face.corners[c]), key(face.corners[(c + 1) % 3])}];
    const long foot = std::lround((each.foot - DEPTH) * 200.0);
    if (each.rings.size() == 1 && each.rings.front().size() == 4)
        for (const auto& [edge, count] : edges)
        {
            if (std::get<2>(edge.first) == foot && std::get<2>(edge.second) == foot) continue;
            EXPECT_EQ(count, 1);
            EXPECT_EQ(edges.count({edge.second, edge.first}), 1u)
                << std::get<0>(edge.first) << " " << std::get<1>(edge.first) << " "
                << std::get<2>(edge.first);
        }
    // Each vertex has its building's reference, and the radius that contains it.
    const osg::Vec4Array* references = RigidParts::of(*geometry);
    ASSERT_TRUE(references);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
    double farthest = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        const osg::Vec4& reference = (*references)[i];
        const osg::Vec3d middle(reference.x(), reference.y(), reference.z());
        EXPECT_LT((middle - each.reference).length(), 1e-4);
        farthest = std::max(farthest, (osg::Vec3d(vertices[i]) - middle).length());
    }
    EXPECT_LE(farthest, RigidParts::radius(*geometry));
    EXPECT_GT(farthest, 0.99 * RigidParts::radius(*geometry) - 0.01);
}

} // namespace

TEST(BuildingMesh, ClosedAndOutwardWithTheOutlinesArea)
{
    const int count = fullTest() ? 2000 : 200;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        std::vector<Ring> rings = {star(random, {random.uniform(-200, 200), random.uniform(-200, 200)},
                                        random.integer(3, 24), 12.0, 30.0)};
        if (random.integer(0, 1))
        {
            // A courtyard, or two.
            const osg::Vec2d middle = ringMiddle(rings.front());
            Ring hole = star(random, middle, random.integer(3, 8), 1.5, 3.5);
            std::reverse(hole.begin(), hole.end());
            bool inside = true;
            for (const osg::Vec2d& place : rings.front())
                inside = inside && (place - middle).length() > 6.0;
            if (inside) rings.push_back(hole);
        }
        PlacedBuilding each = building(rings, random.uniform(0.0, 500.0), random.logarithmic(3.0, 300.0));
        each.use = static_cast<BuildingUse>(random.integer(0, BUILDING_USES - 1));
        each.seed = static_cast<std::uint32_t>(i);
        for (const BuildingLevel level : {BuildingLevel::SINGLE, BuildingLevel::DETAIL})
            check(each, level);
    }
}

TEST(BuildingMesh, GabledRoofs)
{
    for (int i = 0; i < 100; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const double angle = random.uniform(0.0, 6.28), length = random.uniform(8, 30),
                     width = random.uniform(5, 12);
        const osg::Vec2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
        const osg::Vec2d a = along * (0.5 * length), b = across * (0.5 * width);
        Ring ring = {-a - b, a - b, a + b, -a + b};
        std::rotate(ring.begin(), ring.begin() + i % 4, ring.end());
        PlacedBuilding each = building({ring}, 20.0, random.uniform(4.0, 9.0));
        each.gabled = true;
        for (const BuildingLevel level : {BuildingLevel::SINGLE, BuildingLevel::DETAIL})
            check(each, level);
        BuildingMesh mesh(DEPTH);
        mesh.add(each, BuildingLevel::DETAIL);
        // The ridge runs along the longer side: roofs look across it.
        int slopes = 0;
        for (const Face& face : facesOf(*mesh.create()))
        {
            if (isWall(face)) continue;
            ++slopes;
            EXPECT_LT(std::abs(face.normal * osg::Vec3d(length > width ? along : across, 0.0)), 0.01);
            EXPECT_GT(face.normal.z(), 0.6);
            EXPECT_LT(face.normal.z(), 0.97);
        }
        EXPECT_EQ(slopes, 4);
        EXPECT_TRUE(isRectangle(each.rings));
    }
    // What is no rectangle has a flat roof.
    PlacedBuilding bent = building({{{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}}}, 0.0, 6.0);
    bent.gabled = true;
    BuildingMesh mesh(DEPTH);
    mesh.add(bent, BuildingLevel::DETAIL);
    for (const Face& face : facesOf(*mesh.create()))
        EXPECT_TRUE(isWall(face) || face.normal.z() > 0.999);
}

TEST(BuildingMesh, WindowsAreWholeAndStayInTheirBand)
{
    const double texel = 1.0 / 2048.0;
    for (int use = 0; use < BUILDING_USES; ++use)
        for (const double height : {3.0, 8.0, 40.0, 170.0, 400.0})
        {
            SCOPED_TRACE(::testing::Message() << use << " " << height);
            PlacedBuilding each = building({{{0, 0}, {31, 0}, {31, 17}, {0, 17}}}, 0.0, height);
            each.foot = -40.0; // on a cliff
            each.use = static_cast<BuildingUse>(use);
            BuildingMesh mesh(DEPTH);
            mesh.add(each, BuildingLevel::DETAIL);
            const osg::ref_ptr<osg::Geometry> geometry = mesh.create();
            const auto& texels = static_cast<const osg::Vec2Array&>(*geometry->getTexCoordArray(0));
            const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
            const double low = WindowPicture::storey(each.use, -WindowPicture::ground),
                         high = WindowPicture::storey(each.use, WindowPicture::above);
            int ground = 0;
            for (std::size_t i = 0; i < texels.size(); ++i)
            {
                const auto v = static_cast<double>(texels[i].y());
                const bool plain = v > WindowPicture::plain().y() - texel;
                EXPECT_TRUE(plain || (v >= low - 1e-6 && v <= high + 1e-6)) << v;
                if (plain) continue;
                const double columns = static_cast<double>(texels[i].x()) * WindowPicture::columns;
                EXPECT_NEAR(columns, std::round(columns), 1e-4);
                if (vertices[i].z() == static_cast<float>(height)) ++ground;
                // Eaves end a storey.
                const double storeys = (v - low) / (high - low) * WindowPicture::rows;
                if (std::abs(static_cast<double>(vertices[i].z()) - height) < 1e-3)
                {
                    EXPECT_NEAR(storeys, std::round(storeys), 1e-3);
                }
            }
            EXPECT_GT(ground, 0);
        }
}

TEST(BuildingMesh, FromAfarWallsAreAsBrightAsWithWindows)
{
    for (int use = 0; use < BUILDING_USES; ++use)
    {
        const osg::Vec3d mean = WindowPicture::mean(static_cast<BuildingUse>(use));
        const osg::ref_ptr<osg::Image> image = WindowPicture::create();
        const int low = static_cast<int>(std::lround(
            WindowPicture::storey(static_cast<BuildingUse>(use), -WindowPicture::ground) * image->t()));
        const int high = static_cast<int>(std::lround(
            WindowPicture::storey(static_cast<BuildingUse>(use), WindowPicture::above) * image->t()));
        double sum = 0.0;
        for (int y = low; y < high; ++y)
            for (int x = 0; x < image->s(); ++x)
                sum += image->data(static_cast<unsigned>(x), static_cast<unsigned>(y))[1] / 255.0;
        EXPECT_NEAR(sum / ((high - low) * image->s()), mean.y(), 0.003);
        EXPECT_GT(mean.y(), 0.5);
        EXPECT_LT(mean.y(), 0.97);
    }
}

TEST(BuildingMesh, BlocksTakeInWhatStandsTogether)
{
    std::vector<PlacedBuilding> houses;
    double area = 0.0;
    // Two rows of houses 8 m apart, and one 200 m away, and a tower among them.
    for (int i = 0; i < 12; ++i)
    {
        const osg::Vec2d at(10.0 + 18.0 * (i % 6), 10.0 + 20.0 * (i / 6));
        houses.push_back(
            building({{at, at + osg::Vec2d(10, 0), at + osg::Vec2d(10, 12), at + osg::Vec2d(0, 12)}}, 5.0,
                     6.0 + i % 3));
        area += 120.0;
    }
    houses.push_back(building({{{300, 300}, {315, 300}, {315, 312}, {300, 312}}}, 9.0, 8.0));
    houses.push_back(building({{{52, 60}, {70, 60}, {70, 78}, {52, 78}}}, 5.0, 80.0));
    const std::vector<PlacedBuilding> blocks = makeBlocks(houses);
    ASSERT_EQ(blocks.size(), 3u);
    int towers = 0, rows = 0, alone = 0;
    for (const PlacedBuilding& block : blocks)
    {
        const double size = areaOf(block.rings);
        if (block.top - block.reference.z() > 50.0)
            ++towers;
        else if (size > area)
        {
            ++rows;
            EXPECT_LT(size, 2.5 * area);
            EXPECT_NEAR(block.top, 12.0, 0.01); // the mean of 6, 7 and 8 above 5
            EXPECT_NEAR(block.foot, 4.0, 1e-9);
        }
        else
            ++alone;
        EXPECT_GT(ringArea(block.rings.front()), 0.0);
    }
    EXPECT_EQ(towers, 1);
    EXPECT_EQ(rows, 1);
    EXPECT_EQ(alone, 1);
}
