// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Nothing shows between tiles, at the grid's cells and in the distance; and bad input shows nothing.
#include <tools/MappingStage.h>
#include <tools/RandomSamples.h>

#include <cmath>
#include <limits>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

const osg::Vec3d WHITE(1.0, 1.0, 1.0);

} // namespace

class MappingSeams : public MappingStage
{
protected:
    /// Where a pixel's middle sees the plane z = 0; false for the sky.
    bool groundAt(int x, int y, osg::Vec2d& place)
    {
        const osg::Camera& camera = *viewer().getCamera();
        const osg::Matrixd back =
            osg::Matrixd::inverse(camera.getViewMatrix() * camera.getProjectionMatrix());
        const osg::Vec2d p(2.0 * (x + 0.5) / _width - 1.0, 2.0 * (y + 0.5) / _height - 1.0);
        const osg::Vec3d near = osg::Vec3d(p, -1.0) * back;
        const osg::Vec3d far = osg::Vec3d(p, 1.0) * back;
        const double share = near.z() / (near.z() - far.z());
        if (share < 0.0 || share > 1.0) return false;
        const osg::Vec3d hit = near + (far - near) * share;
        place.set(hit.x(), hit.y());
        return true;
    }
    osg::ref_ptr<ProjectiveMapping> makeTile(bool picture, const osg::Vec2d& center, const osg::Vec2d& half,
                                             double heading)
    {
        const osg::ref_ptr<ProjectiveMapping> tile =
            picture ? makePicture(center, 1.0, makeImage(8, WHITE)) : makeSolid(center, 1.0, WHITE);
        tile->setRectangle(center, half.x(), half.y(), heading);
        return tile;
    }
};

TEST_F(MappingSeams, NoGroundBetweenTiles)
{
    const int cameras = fullTest() ? 500 : 50;
    for (int i = 0; i < cameras && !HasFailure(); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        // Irregular columns and rows, turned.
        const double heading = random.uniform(-3.0, 3.0);
        const osg::Vec2d east(std::cos(heading), -std::sin(heading));
        const osg::Vec2d north(std::sin(heading), std::cos(heading));
        std::vector<double> cuts[2];
        for (std::vector<double>& cut : cuts)
        {
            cut.push_back(-200.0);
            while (cut.back() < 200.0)
                cut.push_back(cut.back() + random.uniform(5.0, 60.0));
        }
        _mappings->removeMappings();
        for (std::size_t x = 1; x < cuts[0].size(); ++x)
        {
            for (std::size_t y = 1; y < cuts[1].size(); ++y)
            {
                const osg::Vec2d center =
                    east * (cuts[0][x] + cuts[0][x - 1]) / 2.0 + north * (cuts[1][y] + cuts[1][y - 1]) / 2.0;
                const osg::Vec2d half((cuts[0][x] - cuts[0][x - 1]) / 2.0,
                                      (cuts[1][y] - cuts[1][y - 1]) / 2.0);
                _mappings->addMapping(makeTile(i % 2 == 1, center, half, heading));
            }
        }
        const double around = random.uniform(-3.0, 3.0);
        const double away = random.uniform(50.0, 150.0);
        look(osg::Vec3d(away * std::sin(around), away * std::cos(around), random.logarithmic(3.0, 100.0)),
             osg::Vec3d(random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0), 0.0));
        const osg::ref_ptr<osg::Image> image = draw();
        int within = 0;
        for (int y = 0; y < _height; ++y)
        {
            for (int x = 0; x < _width; ++x)
            {
                osg::Vec2d place;
                if (!groundAt(x, y, place)) continue;
                const double reach = 199.9;
                if (std::abs(place * east) > reach || std::abs(place * north) > reach) continue;
                ++within;
                ASSERT_TRUE(alike(at(*image, x, y), WHITE)) << "camera " << i << " at " << x << ", " << y;
            }
        }
        EXPECT_GT(within, 2000);
    }
}

TEST_F(MappingSeams, NoGroundOnEdgesThroughPixels)
{
    // The middles of pixels lie on the edges, to the last bit or nearly so.
    for (const double pixel : {0.25, 0.7, 1.0 / 3.0, 1.1})
    {
        for (const double offset : {0.0, 123.456, 700.1})
        {
            _mappings->removeMappings();
            const double side = 8.0 * pixel;
            const osg::Vec2d at0(offset, -offset);
            for (int x = -10; x < 10; ++x)
            {
                for (int y = -10; y < 10; ++y)
                {
                    const osg::Vec2d center =
                        at0 + osg::Vec2d((x + 0.5) * side + 0.5 * pixel, (y + 0.5) * side + 0.5 * pixel);
                    _mappings->addMapping(makeTile((x + y) % 2 == 0, center, {side / 2.0, side / 2.0}, 0.0));
                }
            }
            lookDown(at0, pixel);
            const osg::ref_ptr<osg::Image> image = draw();
            int off = 0;
            for (int y = 1; y < _height - 1; ++y)
            {
                for (int x = 1; x < _width - 1; ++x)
                    off += alike(at(*image, x, y), WHITE) ? 0 : 1;
            }
            EXPECT_EQ(off, 0) << "of pixels of " << pixel << " m about " << offset;
        }
    }
}

TEST_F(MappingSeams, NoneAtCells)
{
    const auto wave = [](double u, double v)
    {
        return osg::Vec4d(0.5 + 0.5 * std::sin(12.0 * u), 0.5 + 0.5 * std::cos(9.0 * v), u * v, 1.0);
    };
    const osg::ref_ptr<ProjectiveMapping> large = makePicture({0.0, 0.0}, 300.0, makeImage(256, 256, wave));
    large->setRectangle({0.0, 0.0}, 300.0, 280.0, 0.3);
    _mappings->addMapping(large);
    look({0.0, -300.0, 250.0}, {0.0, 0.0, 0.0});
    const osg::ref_ptr<osg::Image> expected = draw();
    // Thousands of small ones beside it, and on it, where they leave the color as it is.
    Random random(3);
    for (int i = 0; i < 4000; ++i)
    {
        const bool beside = i % 2 == 0;
        const osg::Vec2d place =
            beside ? osg::Vec2d(random.uniform(-900.0, 900.0), random.uniform(700.0, 900.0))
                   : osg::Vec2d(random.uniform(-250.0, 250.0), random.uniform(-250.0, 250.0));
        const osg::ref_ptr<ProjectiveMapping> small =
            makeSolid(place, random.logarithmic(0.5, 20.0), colorOf(i));
        if (!beside) small->getTransfer()->setBlendFunction(ColorTransfer::ZERO, ColorTransfer::ONE);
        small->setOrder(random.integer(-1, 1));
        _mappings->addMapping(small);
    }
    const osg::ref_ptr<osg::Image> image = draw();
    int covered = 0;
    int off = 0;
    for (int y = 0; y < _height; ++y)
    {
        for (int x = 0; x < _width; ++x)
        {
            osg::Vec2d place;
            if (!groundAt(x, y, place) || place.y() > 650.0) continue;
            covered += alike(at(*expected, x, y), groundColor()) ? 0 : 1;
            off += at(*expected, x, y) == at(*image, x, y) ? 0 : 1;
        }
    }
    EXPECT_GT(covered, 5000);
    EXPECT_EQ(off, 0);
}

TEST_F(MappingSeams, NothingShimmersInTheDistance)
{
    const auto chequered = [](double u, double v)
    {
        const bool white = (static_cast<int>(u * 1024.0) + static_cast<int>(v * 1024.0)) % 2 == 0;
        return white ? osg::Vec4d(1.0, 1.0, 1.0, 1.0) : osg::Vec4d(0.0, 0.0, 0.0, 1.0);
    };
    _mappings->addMapping(makePicture({0.0, 0.0}, 500.0, makeImage(1024, 1024, chequered)));
    const int steps = fullTest() ? 100 : 20;
    // From far above, and from as flat as one sees it in the distance.
    for (const osg::Vec3d& eye : {osg::Vec3d(0.0, -200.0, 3000.0), osg::Vec3d(0.0, -3000.0, 900.0)})
    {
        double lowest = 1.0;
        double highest = 0.0;
        int seen = 0;
        for (int step = 0; step < steps; ++step)
        {
            look(eye + osg::Vec3d(0.37 * step, 0.61 * step, 0.23 * step), {0.0, 0.0, 0.0});
            const osg::ref_ptr<osg::Image> image = draw();
            for (int y = 0; y < _height; ++y)
            {
                for (int x = 0; x < _width; ++x)
                {
                    osg::Vec2d place;
                    if (!groundAt(x, y, place) || std::abs(place.x()) > 400.0 || std::abs(place.y()) > 400.0)
                        continue;
                    ++seen;
                    lowest = std::min(lowest, at(*image, x, y).y());
                    highest = std::max(highest, at(*image, x, y).y());
                }
            }
        }
        EXPECT_GT(seen, 100 * steps);
        // Half of the light, as sRGB has it; no pixel in any picture is further off.
        EXPECT_NEAR(lowest, 188.0 / 255.0, 2.0 * tolerance);
        EXPECT_NEAR(highest, 188.0 / 255.0, 2.0 * tolerance);
    }
    // And near by it is black and white.
    lookDown({0.0, 0.0}, 0.1);
    const osg::ref_ptr<osg::Image> image = draw();
    double lowest = 1.0;
    double highest = 0.0;
    for (int i = 0; i < _width * _height; ++i)
    {
        lowest = std::min(lowest, at(*image, i % _width, i / _width).y());
        highest = std::max(highest, at(*image, i % _width, i / _width).y());
    }
    EXPECT_LT(lowest, 0.1);
    EXPECT_GT(highest, 0.9);
}

TEST_F(MappingSeams, OddImages)
{
    lookDown({0.0, 0.0}, 1.0);
    const osg::Vec3d grey(0.6, 0.6, 0.6);
    const int sizes[][2] = {{1, 1}, {3, 5}, {17, 1}, {1, 64}, {127, 33}, {255, 257}};
    for (const auto& size : sizes)
    {
        for (const GLenum format : {GL_RGB, GL_RGBA, GL_BGR, GL_BGRA, GL_LUMINANCE, GL_LUMINANCE_ALPHA})
        {
            for (const GLenum type : {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_FLOAT})
            {
                osg::ref_ptr<osg::Image> image = new osg::Image;
                image->allocateImage(size[0], size[1], 1, format, type);
                for (int y = 0; y < size[1]; ++y)
                {
                    for (int x = 0; x < size[0]; ++x)
                        image->setColor(osg::Vec4(0.6f, 0.6f, 0.6f, 1.0f), x, y);
                }
                _mappings->removeMappings();
                _mappings->addMapping(makePicture({0.0, 0.0}, 50.0, image));
                const osg::ref_ptr<osg::Image> picture = draw();
                for (const double x : {-49.0, 0.3, 49.0})
                {
                    ASSERT_TRUE(alike(at(*picture, pixelOf(osg::Vec2d(x, 48.7))), grey))
                        << size[0] << " x " << size[1] << ", " << format << ", " << type;
                }
                ASSERT_TRUE(alike(at(*picture, pixelOf(osg::Vec2d(51.0, 0.0))), groundColor()));
            }
        }
    }
}

TEST_F(MappingSeams, NumbersThatAreNone)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(40, 40, 1, GL_LUMINANCE, GL_FLOAT);
    const float nones[] = {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for (int y = 0; y < 40; ++y)
    {
        for (int x = 0; x < 40; ++x)
        {
            auto* value = reinterpret_cast<float*>(
                image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
            *value = x < 20 ? nones[(x + y) % 4] : 0.5f;
        }
    }
    const osg::ref_ptr<ProjectiveMapping> mapping = makePicture({0.0, 0.0}, 60.0, image);
    mapping->setTable(ColorTable::named("greys"));
    mapping->getTransfer()->setSource(ColorTransfer::TABLE);
    _mappings->addMapping(mapping);
    for (const double pixel : {1.0, 10.0})
    {
        lookDown({0.0, 0.0}, pixel);
        for (const DataLayer::Kind kind : {DataLayer::VALUE, DataLayer::CLASS})
        {
            mapping->getLayer()->setKind(kind);
            const osg::ref_ptr<osg::Image> picture = draw();
            EXPECT_TRUE(alike(at(*picture, pixelOf(osg::Vec2d(-30.0, 10.0))), groundColor())) << kind;
            const osg::Vec3d middle(0.5, 0.5, 0.5);
            EXPECT_TRUE(alike(at(*picture, pixelOf(osg::Vec2d(30.0, 10.0))), middle)) << kind;
        }
    }
}

TEST_F(MappingSeams, WhatCannotBeDrawn)
{
    lookDown({0.0, 0.0}, 1.0);
    const osg::ref_ptr<osg::Image> bare = draw();
    // No layer, no image, an empty one: nothing is drawn, and nothing is said.
    const osg::ref_ptr<ProjectiveMapping> mapping = makePicture({0.0, 0.0}, 50.0, nullptr);
    _mappings->addMapping(mapping);
    EXPECT_EQ(differing(*draw(), *bare), 0);
    mapping->getLayer()->setImage(new osg::Image);
    EXPECT_EQ(differing(*draw(), *bare), 0);
    mapping->setLayer(nullptr);
    EXPECT_EQ(differing(*draw(), *bare), 0);
    mapping->getTransfer()->setSource(ColorTransfer::TABLE);
    EXPECT_EQ(differing(*draw(), *bare), 0);
    mapping->setLayer(new DataLayer(makeImage(4, WHITE)));
    EXPECT_EQ(differing(*draw(), *bare), 0) << "there is no table";
    mapping->getTransfer()->setSource(ColorTransfer::LAYER);
    EXPECT_GT(differing(*draw(), *bare), 9000);
    // A format that is none: one warning.
    osg::ref_ptr<osg::Image> depth = new osg::Image;
    depth->allocateImage(8, 8, 1, GL_DEPTH_COMPONENT, GL_FLOAT);
    mapping->getLayer()->setImage(depth);
    mapping->getLayer()->setName("of depths");
    osg::ref_ptr<osg::Image> image;
    auto said = watch().messagesOf([&] { image = draw(); });
    EXPECT_EQ(differing(*image, *bare), 0);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("of depths"), std::string::npos) << said[0];
    EXPECT_EQ(differing(*draw(), *bare), 0);
    // Larger than a page: one warning, and a coarser picture.
    _mappings->setPageSide(64);
    mapping->getLayer()->setImage(makeImage(100, WHITE));
    said = watch().messagesOf([&] { image = draw(); });
    EXPECT_GT(differing(*image, *bare), 9000);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("64"), std::string::npos) << said[0];
    EXPECT_EQ(differing(*draw(), *image), 0);
    // Degenerate places are refused.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::function<bool()>> refused = {
        [&] {
            return mapping->setAxes({0.0, 0.0}, {0.0, 10.0});
        },
        [&] {
            return mapping->setAxes({10.0, 10.0}, {20.0, 20.0});
        },
        [&] {
            return mapping->setRectangle({0.0, 0.0}, 0.0, 10.0);
        },
        [&] {
            return mapping->setRectangle({nan, 0.0}, 10.0, 10.0);
        },
        [&] {
            return mapping->setCenter({0.0, std::numeric_limits<double>::infinity()});
        },
        [&] { return mapping->setTransform(glm::dmat3(0.0)); },
        [&] { return mapping->setTransform(glm::dmat3(1, 0, 2, 0, 1, 0, 0, 0, -1)); },
        [&] {
            return mapping->setQuad({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {3.0, 0.0}});
        },
        [&] {
            return mapping->setQuad({{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}});
        },
        [&] { return mapping->setOpacity(nan); },
        [&] { return mapping->setOrder(1001); },
    };
    for (std::size_t i = 0; i < refused.size(); ++i)
    {
        bool taken = true;
        said = watch().messagesOf([&] { taken = refused[i](); });
        EXPECT_FALSE(taken) << i;
        EXPECT_EQ(said.size(), 1u) << i;
        // Of several numbers those may be taken that fit; what is there can be drawn in any case.
        draw();
        mapping->setTransform(glm::dmat3(1.0));
        EXPECT_TRUE(mapping->setRectangle({0.0, 0.0}, 50.0, 50.0)) << i;
        EXPECT_EQ(differing(*draw(), *image), 0) << i;
    }
}
