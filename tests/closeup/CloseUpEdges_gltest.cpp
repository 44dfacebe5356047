// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Borders of close-ups pixel by pixel: outlines in corners against the areas that plane geometry gives, and soft edges and anchors
// of two close-ups against pictures of each alone, laid over each other in the order of their distance.
#include <tools/CloseUpStage.h>
#include <tools/TileBlock.h>

#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr CloseUps::Pipeline pipelines[] = {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS};

/// Level ground in one grey, without light.
class CloseUpEdges : public CloseUpStage
{
protected:
    CloseUpEdges() : CloseUpStage(200, 150) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        _scene->removeChildren(0, _scene->getNumChildren());
        osg::ref_ptr<osg::Geometry> ground = makeHills(1000.0, 40);
        for (osg::Vec3& vertex : dynamic_cast<osg::Vec3Array&>(*ground->getVertexArray()))
            vertex.z() = 0.0f;
        dynamic_cast<osg::Vec4Array&>(*ground->getColorArray()).front().set(0.5f, 0.5f, 0.5f, 1.0f);
        _scene->addChild(ground);
    }

    void fromAbove(const osg::Vec3d& place = osg::Vec3d())
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(place + osg::Vec3d(0.0, 0.0, 3000.0), place, {0.0, 1.0, 0.0});
        camera.setProjectionMatrixAsOrtho(-200.0, 200.0, -150.0, 150.0, 1.0, 6000.0);
    }
    static osg::Vec3d colorAt(const osg::Image& image, int x, int y)
    {
        const unsigned char* rgb = image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return osg::Vec3d(rgb[0], rgb[1], rgb[2]) / 255.0;
    }
    static double distance(const osg::Vec3d& a, const osg::Vec3d& b)
    {
        const osg::Vec3d apart = a - b;
        return std::max({std::abs(apart.x()), std::abs(apart.y()), std::abs(apart.z())});
    }
    /// Of the pictures of one close-up after the other.
    osg::ref_ptr<osg::Image> drawOf(const std::vector<CloseUp*>& closeUps)
    {
        _closeUps->removeCloseUps();
        for (CloseUp* each : closeUps)
            _closeUps->addCloseUp(each);
        return draw();
    }
};

/// How much of each pixel is within so many pixels of a quadrangle's sides, inside of it. Corners counter-clockwise.
class Frame
{
public:
    Frame(const std::array<osg::Vec2d, 4>& corners, double width) : _corners(corners), _width(width) {}

    double shareOf(int x, int y) const
    {
        constexpr int steps = 8;
        int found = 0;
        for (int j = 0; j < steps; ++j)
            for (int i = 0; i < steps; ++i)
            {
                const double far = inside(osg::Vec2d(x + (i + 0.5) / steps, y + (j + 0.5) / steps));
                found += far > 0.0 && far < _width ? 1 : 0;
            }
        return static_cast<double>(found) / (steps * steps);
    }

private:
    /// Pixels to the nearest side, negative outside.
    double inside(const osg::Vec2d& point) const
    {
        double least = 1e30;
        for (std::size_t i = 0; i < 4; ++i)
        {
            osg::Vec2d along = _corners[(i + 1) % 4] - _corners[i];
            along.normalize();
            const osg::Vec2d way = point - _corners[i];
            least = std::min(least, along.x() * way.y() - along.y() * way.x());
        }
        return least;
    }

    std::array<osg::Vec2d, 4> _corners;
    double _width;
};

} // namespace

TEST_F(CloseUpEdges, OutlinesAreAsWideInTheCornersOfRectangles)
{
    const osg::Vec3d lineColor(1.0, 0.0, 1.0);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 100.0, 100.0);
    // Apart from the line around its region.
    const osg::Vec3d aside(0.0, 260.0, 0.0);
    closeUp->setScale(2.0, 2.0, 2.0);
    closeUp->setColor(osg::Vec3d(lineColor));
    closeUp->getAnchor()->setKind(Anchor::NONE);
    RegionOfInterest& region = *closeUp->getRegion();
    region.setShape(RegionOfInterest::RECTANGLE);
    region.setSize(100.0, 70.0);
    region.setMaskSide(256);
    _closeUps->addCloseUp(closeUp);
    const osg::Camera& camera = *viewer().getCamera();
    double worst = 0.0, worstOfCorner = 0.0;
    for (const bool oblique : {false, true})
    {
        for (const double heading : {0.0, 10.0, 45.0})
        {
            for (const double width : {2.0, 4.0})
            {
                for (int i = 0; i < 4; ++i)
                {
                    fromAbove(aside);
                    if (oblique)
                        look(aside + osg::Vec3d(40.0, -300.0, 420.0), aside + osg::Vec3d(0.0, 0.0, 100.0),
                             32.0);
                    const double turn = osg::DegreesToRadians(heading);
                    region.setHeading(turn);
                    closeUp->setOffset({-aside.y() * std::sin(turn), aside.y() * std::cos(turn), 100.0});
                    // Corners lie anywhere among the squares of four pixels that GPUs draw at once.
                    region.setCenter({0.37 * i, 1.0 * (i % 2) + 0.21 * i});
                    closeUp->getAnchor()->setLineWidth(width);
                    _closeUps->setPipeline(pipelines[i / 2]);
                    const osg::ref_ptr<osg::Image> image = draw();
                    closeUp->getAnchor()->setLineWidth(0.0);
                    const osg::ref_ptr<osg::Image> without = draw();
                    const osg::Matrixd toPicture = closeUp->shape(0.0) * region.frameToWorld(nullptr) *
                                                   camera.getViewMatrix() * camera.getProjectionMatrix() *
                                                   osg::Matrixd::translate(1.0, 1.0, 0.0) *
                                                   osg::Matrixd::scale(0.5 * _width, 0.5 * _height, 1.0);
                    std::array<osg::Vec2d, 4> corners;
                    const osg::Vec2d signs[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
                    for (std::size_t k = 0; k < 4; ++k)
                    {
                        const osg::Vec3d at =
                            osg::Vec3d(50.0 * signs[k].x(), 35.0 * signs[k].y(), 0.0) * toPicture;
                        corners[k].set(at.x(), at.y());
                    }
                    const Frame frame(corners, width);
                    for (const osg::Vec2d& corner : corners)
                    {
                        double seen = 0.0, expected = 0.0;
                        for (int y = static_cast<int>(corner.y()) - 9; y <= static_cast<int>(corner.y()) + 9;
                             ++y)
                        {
                            for (int x = static_cast<int>(corner.x()) - 9;
                                 x <= static_cast<int>(corner.x()) + 9; ++x)
                            {
                                const osg::Vec3d before = colorAt(*without, x, y);
                                // Pixels that the region covers in part mix with what is behind them.
                                const osg::Vec3d way = lineColor - before;
                                const double share = (colorAt(*image, x, y) - before) * way / way.length2();
                                const double wanted = frame.shareOf(x, y);
                                seen += share;
                                expected += wanted;
                                worst = std::max(worst, std::abs(share - wanted));
                                EXPECT_NEAR(share, wanted, 0.35)
                                    << "pixel " << x << ", " << y << "; oblique " << oblique << ", heading "
                                    << heading << ", width " << width << ", place " << i;
                            }
                        }
                        worstOfCorner = std::max(worstOfCorner, std::abs(seen / expected - 1.0));
                        EXPECT_NEAR(seen / expected, 1.0, 0.08)
                            << "oblique " << oblique << ", heading " << heading << ", width " << width
                            << ", place " << i;
                    }
                }
            }
        }
    }
    std::cout << "a pixel's share is off by " << worst << " at most, a corner's by " << 100.0 * worstOfCorner
              << " %\n";
}

TEST_F(CloseUpEdges, WallsOfTilesDoNotHangOutBelowThem)
{
    // Level ground like that of a tile, with walls along lines 50 m apart.
    const auto draw = [&](bool walls, bool culling, CloseUps::Pipeline pipeline)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        const osg::ref_ptr<osg::Geometry> ground = makeHills(1000.0, 40);
        auto& vertices = dynamic_cast<osg::Vec3Array&>(*ground->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex.z() = 0.0f;
        _scene->addChild(makeTileBlock(*ground));
        auto& triangles = dynamic_cast<osg::DrawElementsUInt&>(*ground->getPrimitiveSet(0));
        for (unsigned int i = 0; walls && i + 42 < 41 * 41; ++i)
        {
            if (i % 41 == 40) continue;
            for (const unsigned int next : {i + 1, i + 41})
            {
                vertices.push_back(vertices[i] - osg::Vec3(0.0f, 0.0f, 25.0f));
                const auto low = static_cast<unsigned int>(vertices.size() - 1);
                for (const unsigned int corner : {i, low, next})
                    triangles.push_back(corner);
            }
        }
        for (osg::Array* array : {ground->getNormalArray(), ground->getTexCoordArray(0)})
            array->resizeArray(static_cast<unsigned int>(vertices.size()));
        _scene->setCullingActive(culling);
        _closeUps->setPipeline(pipeline);
        return CloseUpStage::draw();
    };
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({10.0, 20.0}, 400.0, 300.0);
    closeUp->getRegion()->setShape(RegionOfInterest::ELLIPSE);
    _closeUps->addCloseUp(closeUp);
    look({100.0, -1500.0, 1000.0}, {0.0, 0.0, 300.0}, 30.0);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        const osg::ref_ptr<osg::Image> expected = draw(false, true, pipeline);
        EXPECT_EQ(differing(*draw(true, true, pipeline), *expected), 0.0) << "pipeline " << pipeline;
        EXPECT_EQ(differing(*draw(true, false, pipeline), *expected), 0.0)
            << "without culling, pipeline " << pipeline;
    }
}

TEST_F(CloseUpEdges, TheNearerOfTwoSoftEdgesLiesOverTheOther)
{
    // Two tilted discs that cross along the middle of the picture: one is nearer in its upper half, the other in its lower one.
    fromAbove();
    const osg::ref_ptr<CloseUp> bright = makeCloseUp({-25.0, 0.0}, 240.0, 400.0);
    const osg::ref_ptr<CloseUp> dark = makeCloseUp({25.0, 0.0}, 240.0, 400.0);
    for (const osg::ref_ptr<CloseUp>& each : {bright, dark})
    {
        each->getAnchor()->setKind(Anchor::NONE);
        each->getAnchor()->setLineWidth(0.0);
        each->setScale(1.0, 1.0, 1.0);
        each->getRegion()->setSoftness(1.0);
        each->setBrightness(each == bright ? 0.5 : -0.5);
        each->setTilt(each == bright ? 0.4 : -0.4);
    }
    const double ground = 127.5 / 255.0;
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> onlyBright = drawOf({bright});
        const osg::ref_ptr<osg::Image> onlyDark = drawOf({dark});
        for (const bool brightFirst : {true, false})
        {
            SCOPED_TRACE(::testing::Message() << "pipeline " << pipeline << ", bright first " << brightFirst);
            const osg::ref_ptr<osg::Image> both =
                brightFirst ? drawOf({bright, dark}) : drawOf({dark, bright});
            int mixed = 0, wrong = 0;
            for (int y = 0; y < _height; ++y)
            {
                if (std::abs(y - _height / 2) < 3) continue;
                for (int x = 0; x < _width; ++x)
                {
                    // Of white over the ground, and of black over it.
                    const double white = colorAt(*onlyBright, x, y).x();
                    const double black = colorAt(*onlyDark, x, y).x();
                    const double coverOfBright = (white - ground) / (1.0 - ground);
                    const double coverOfDark = 1.0 - black / ground;
                    const bool brightIsNearer = y > _height / 2;
                    const double expected = brightIsNearer ? black * (1.0 - coverOfBright) + coverOfBright
                                                           : white * (1.0 - coverOfDark);
                    mixed += coverOfBright > 0.1 && coverOfDark > 0.1 ? 1 : 0;
                    wrong += std::abs(colorAt(*both, x, y).x() - expected) > 0.02 ? 1 : 0;
                }
            }
            EXPECT_GT(mixed, 3000);
            EXPECT_EQ(wrong, 0) << "of " << mixed << " pixels that both cover";
        }
    }
}

TEST_F(CloseUpEdges, AnchorsLieOverSoftEdgesThatAreFartherAway)
{
    // From the south and a little above: a wall below a level close-up, before or behind an upright one that is soft.
    const osg::ref_ptr<CloseUp> walled = makeCloseUp({0.0, 0.0}, 160.0, 200.0);
    walled->setScale(1.0, 1.0, 1.0);
    walled->getRegion()->setShape(RegionOfInterest::RECTANGLE);
    walled->setColor({1.0, 0.0, 1.0});
    walled->getAnchor()->setStyle(Anchor::SOLID);
    walled->getAnchor()->setOpacity(0.6);
    walled->getAnchor()->setLineWidth(0.0);
    const osg::ref_ptr<CloseUp> soft = makeCloseUp({0.0, 0.0}, 200.0, 100.0);
    soft->setScale(1.0, 1.0, 1.0);
    soft->getAnchor()->setKind(Anchor::NONE);
    soft->getAnchor()->setLineWidth(0.0);
    soft->getRegion()->setSoftness(1.0);
    soft->setTilt(osg::PI_2);
    soft->setBrightness(0.5);
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt({0.0, -2000.0, 350.0}, {0.0, 0.0, 100.0}, {0.0, 0.0, 1.0});
    camera.setProjectionMatrixAsOrtho(-200.0, 200.0, -150.0, 150.0, 1.0, 6000.0);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        for (const bool wallIsNearer : {true, false})
        {
            soft->setOffset({0.0, wallIsNearer ? 300.0 : -300.0, wallIsNearer ? 160.0 : 60.0});
            const osg::ref_ptr<osg::Image> nothing = drawOf({});
            const osg::ref_ptr<osg::Image> onlyWall = drawOf({walled});
            const osg::ref_ptr<osg::Image> onlySoft = drawOf({soft});
            for (const bool wallFirst : {true, false})
            {
                SCOPED_TRACE(::testing::Message() << "pipeline " << pipeline << ", the wall is nearer "
                                                  << wallIsNearer << ", first " << wallFirst);
                const osg::ref_ptr<osg::Image> both =
                    wallFirst ? drawOf({walled, soft}) : drawOf({soft, walled});
                const osg::Vec3d magenta(1.0, 0.0, 1.0);
                int mixed = 0, wrong = 0;
                for (int y = 0; y < _height; ++y)
                {
                    for (int x = 0; x < _width; ++x)
                    {
                        const osg::Vec3d background = colorAt(*nothing, x, y);
                        const osg::Vec3d rim = colorAt(*onlySoft, x, y);
                        const double cover = (rim.x() - background.x()) / (1.0 - background.x());
                        const osg::Vec3d wall = background * 0.4 + magenta * 0.6;
                        // The wall alone: not its close-up, nor edges.
                        if (distance(colorAt(*onlyWall, x, y), wall) > 0.01) continue;
                        if (cover < 0.05 || cover > 0.95) continue;
                        const osg::Vec3d expected =
                            wallIsNearer ? rim * 0.4 + magenta * 0.6
                                         : wall * (1.0 - cover) + osg::Vec3d(1.0, 1.0, 1.0) * cover;
                        ++mixed;
                        wrong += distance(colorAt(*both, x, y), expected) > 0.02 ? 1 : 0;
                    }
                }
                EXPECT_GT(mixed, 500);
                EXPECT_EQ(wrong, 0) << "of " << mixed << " pixels";
            }
        }
    }
}
