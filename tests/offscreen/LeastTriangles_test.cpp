// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/LeastTriangles.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <osg/Group>
#include <osgDB/ReadFile>

#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double POST = 10.0; // metres
constexpr double EYE = 1e6; // metres up: distances differ by less than what the heights below leave room for

/// A database of square posts over a plane. `height` is that of a post: columns from the west, rows from the south.
class Built
{
public:
    Built(int across, int up, const std::function<double(int, int)>& height, bool compressed = false)
        : columns(across), rows(up)
    {
        TestRaster raster(across, up);
        raster.placed(500000.0, 2400000.0, POST, POST).crs("EPSG:32604");
        raster.fill([&](int column, int row, int) { return height(column, up - 1 - row); });
        BuildOptions options;
        options.dems = {raster.write(_folder / "dem.tif")};
        options.epsg = 32604;
        options.tileSize = 16;
        options.compressTextures = compressed;
        options.output = (_folder / "database").string();
        buildDatabase(options);
        root = osgDB::readRefNodeFile((_folder / "database" / "terrain.osgb").string());
        // Posts are the middles of pixels.
        center.set(500000.0 + POST * 0.5 * columns, 2400000.0 - POST * 0.5 * rows, 0.0);
    }

    /// From far above, so that an error of `metres` is what a pixel error of 1 allows.
    std::uint64_t count(double metres, double share = 1.0) const
    {
        std::string error;
        const auto least = LeastTriangles::read(*root, error);
        EXPECT_TRUE(least) << error;
        if (!least) return 0;
        const double width = share * POST * std::max(columns, rows);
        const osg::ref_ptr<DeformationChain> none = new DeformationChain;
        return least->count(
            view(), osg::Matrixd::frustum(-0.5 * width, 0.5 * width, -0.5 * width, 0.5 * width, EYE, 2 * EYE),
            EYE / metres, 1.0, *none);
    }

    osg::Matrixd view() const
    {
        return osg::Matrixd::lookAt(center + osg::Vec3d(0.0, 0.0, EYE), center, osg::Vec3d(0.0, 1.0, 0.0));
    }

    int columns, rows;
    osg::ref_ptr<osg::Node> root;
    osg::Vec3d center;

private:
    TempDir _folder;
};

/// The vertices of the conforming network, found from above: each that is missed by more than `metres`, and with it those that its
/// triangles' splits depend on, up to the whole square. `side` posts, a power of two and one.
std::set<std::pair<int, int>> networkOf(int side, const std::function<double(int, int)>& height,
                                        double metres)
{
    using Post = std::pair<int, int>;
    std::set<Post> needed;
    std::function<void(Post)> need;
    // A split at a post halves the two triangles whose longest edge it divides. These exist only once their own right-angled
    // corners have been split into the network.
    std::map<Post, std::vector<Post>> parents;
    std::function<void(Post, Post, Post)> visit = [&](Post a, Post b, Post c)
    {
        const Post middle{(a.first + b.first) / 2, (a.second + b.second) / 2};
        if (std::abs(a.first - c.first) + std::abs(a.second - c.second) <= 1) return;
        parents[middle].push_back(c);
        visit(c, a, middle);
        visit(b, c, middle);
    };
    const int last = side - 1;
    visit({last, last}, {0, 0}, {last, 0});
    visit({0, 0}, {last, last}, {0, last});
    need = [&](Post post)
    {
        if (!parents.count(post) || !needed.insert(post).second) return;
        for (const Post& parent : parents[post])
            need(parent);
    };
    std::function<void(Post, Post, Post)> measure = [&](Post a, Post b, Post c)
    {
        const Post middle{(a.first + b.first) / 2, (a.second + b.second) / 2};
        if (std::abs(a.first - c.first) + std::abs(a.second - c.second) <= 1) return;
        const double straight = 0.5 * (height(a.first, a.second) + height(b.first, b.second));
        if (std::abs(height(middle.first, middle.second) - straight) > metres) need(middle);
        measure(c, a, middle);
        measure(b, c, middle);
    };
    measure({last, last}, {0, 0}, {last, 0});
    measure({0, 0}, {last, last}, {0, last});
    return needed;
}

TEST(LeastTriangles, AreNoneForAPlainAndForAnEvenSlope)
{
    EXPECT_EQ(Built(33, 33, [](int, int) { return 100.0; }).count(0.01), 0u);
    EXPECT_EQ(Built(33, 33, [](int column, int row) { return 3.0 * column + 2.0 * row; }).count(0.01), 0u);
    // An extent that fills the quadtree nowhere.
    EXPECT_EQ(Built(41, 23, [](int column, int row) { return 3.0 * column + 2.0 * row; }).count(0.01), 0u);
}

TEST(LeastTriangles, AreThoseOfTheConformingNetwork)
{
    Random random(17);
    for (const int side : {17, 65})
    {
        std::vector<double> heights;
        for (int i = 0; i < side * side; ++i)
            heights.push_back(random.uniform(0.0, 1.0) < 0.05 ? random.uniform(30.0, 90.0) : 0.0);
        const auto height = [&](int column, int row)
        {
            return heights[static_cast<std::size_t>(row * side + column)];
        };
        const Built built(side, side, height);
        for (const double metres : {1.0, 17.3, 41.1})
        {
            const auto expected = networkOf(side, height, metres);
            ASSERT_GT(expected.size(), 0u);
            EXPECT_EQ(built.count(metres), 2 * expected.size()) << side << " posts, " << metres << " m";
        }
    }
}

TEST(LeastTriangles, AreThoseInTheView)
{
    const auto spikes = [](int column, int row)
    {
        return column % 4 == 2 && row % 4 == 2 ? 50.0 : 0.0;
    };
    const Built built(65, 65, spikes);
    const auto all = networkOf(65, spikes, 5.0);
    std::size_t inside = 0;
    for (const auto& [column, row] : all)
        inside += std::abs(column - 32) < 16.2 && std::abs(row - 32) < 16.2 ? 1 : 0;
    ASSERT_LT(inside, all.size() / 2);
    EXPECT_EQ(built.count(5.0, 0.5), 2 * inside);
}

TEST(LeastTriangles, FollowTheDistance)
{
    const auto waves = [](int column, int row)
    {
        return 20.0 * std::sin(0.7 * column) * std::sin(0.9 * row);
    };
    const Built built(65, 65, waves);
    std::uint64_t before = built.count(0.2);
    for (const double metres : {1.0, 5.0, 12.0, 40.0})
    {
        const std::uint64_t now = built.count(metres);
        EXPECT_LE(now, before);
        before = now;
    }
    EXPECT_EQ(before, 0u);
}

TEST(LeastTriangles, NeedADatabaseOfOurs)
{
    std::string error;
    const osg::ref_ptr<osg::Group> other = new osg::Group;
    EXPECT_FALSE(LeastTriangles::read(*other, error));
    EXPECT_NE(error.find("--least-triangles"), std::string::npos) << error;
}

TEST(LeastTriangles, CompressedTexturesChangeNothing)
{
    // Their textures have texels beyond the tile's border.
    const auto height = [](int column, int row)
    {
        return 40.0 * std::sin(0.3 * column) * std::cos(0.2 * row) + 3.0 * std::sin(1.7 * column + 0.9 * row);
    };
    const Built plain(65, 65, height), compressed(65, 65, height, true);
    for (const double metres : {0.5, 2.0, 8.0})
    {
        EXPECT_GT(plain.count(metres), 2u);
        EXPECT_EQ(compressed.count(metres), plain.count(metres)) << metres;
    }
}

} // namespace
