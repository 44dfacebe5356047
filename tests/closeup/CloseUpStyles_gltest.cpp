// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Light, data, lines, anchors and movement of close-ups, against what their documentation and plain geometry say of single pixels.
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <tools/CloseUpStage.h>

#include <osg/GLExtensions>
#include <osg/Geometry>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr CloseUps::Pipeline pipelines[] = {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS};
constexpr double grey = 0.4; ///< of the ground; twice as bright is not white yet

osg::ref_ptr<osg::Image> makeValues(int side, double half,
                                    const std::function<osg::Vec4d(double, double)>& texel)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_FLOAT);
    auto* next = reinterpret_cast<osg::Vec4f*>(image->data());
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            *next++ = osg::Vec4f(
                texel(half * ((2.0 * column + 1.0) / side - 1.0), half * ((2.0 * row + 1.0) / side - 1.0)));
    return image;
}

/// Colors the ground by its place, red and green by a varying, and blue by a flat one: 1 east of the origin, else 0.
class PlaceColors : public SurfaceEffect
{
public:
    PlaceColors()
    {
        ShaderLibrary::add("test/placecolors.vert.glsl",
                           "out vec2 SLOT_place;\n"
                           "flat out int SLOT_east;\n"
                           "void SLOT_locate(vec3 p) { SLOT_place = p.xy / 400.0 + 0.5;"
                           " SLOT_east = p.x > 0.0 ? 1 : 0; }\n");
        ShaderLibrary::add(
            "test/placecolors.frag.glsl",
            "in vec2 SLOT_place;\n"
            "flat in int SLOT_east;\n"
            "vec4 SLOT_color(vec4 color) { return vec4(SLOT_place, float(SLOT_east), 1.0); }\n");
    }
    PlaceColors(const PlaceColors& other, const osg::CopyOp& copy) : SurfaceEffect(other, copy) {}
    META_Object(test, PlaceColors);
    const Properties& properties() const override
    {
        static const Properties all = {enabledProperty()};
        return all;
    }
    std::string vertexFile() const override { return "test/placecolors.vert.glsl"; }
    std::string fragmentFile() const override { return "test/placecolors.frag.glsl"; }
    std::vector<Varying> varyings() const override { return {{"vec2", "place"}, {"int", "east", true}}; }
    bool fill(osg::StateSet&, const std::string&, const SurfaceView&) override { return true; }
};

/// Level grey ground without light, two metres to a pixel from straight above: north is up.
class CloseUpStyles : public CloseUpStage
{
protected:
    CloseUpStyles() : CloseUpStage(200, 150) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        _scene->removeChildren(0, _scene->getNumChildren());
        osg::ref_ptr<osg::Geometry> ground = makeHills(1000.0, 40);
        for (osg::Vec3& vertex : dynamic_cast<osg::Vec3Array&>(*ground->getVertexArray()))
            vertex.z() = 0.0f;
        const auto shade = static_cast<float>(grey);
        dynamic_cast<osg::Vec4Array&>(*ground->getColorArray()).front().set(shade, shade, shade, 1.0f);
        _scene->addChild(ground);
        fromAbove();
    }

    void fromAbove()
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt({0.0, 0.0, 3000.0}, osg::Vec3d(), {0.0, 1.0, 0.0});
        camera.setProjectionMatrixAsOrtho(-200.0, 200.0, -150.0, 150.0, 1.0, 6000.0);
    }
    /// North is to the back and heights go up, two metres to a pixel, with height 0 in row 25.
    void fromTheSouth()
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt({0.0, -2000.0, 0.0}, osg::Vec3d(), {0.0, 0.0, 1.0});
        camera.setProjectionMatrixAsOrtho(-200.0, 200.0, -50.0, 250.0, 1.0, 6000.0);
    }
    static osg::Vec3d colorAt(const osg::Image& image, int x, int y)
    {
        const unsigned char* rgb = image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return osg::Vec3d(rgb[0], rgb[1], rgb[2]) / 255.0;
    }
    /// Of the place on the ground that is (x, y) metres east and north of the origin.
    osg::Vec3d colorOf(const osg::Image& image, double x, double y) const
    {
        return colorAt(image, static_cast<int>(std::floor(x / 2.0)) + _width / 2,
                       static_cast<int>(std::floor(y / 2.0)) + _height / 2);
    }
};

} // namespace

TEST_F(CloseUpStyles, TheSunShinesFromItsAzimuthAndTheRegionsHeading)
{
    // A hip roof whose four sides fall to the east, north, west and south.
    constexpr double half = 200.0, slope = 0.5;
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    data->setRectangle({-half, -half}, {half, half});
    data->addLayer("height", SurfaceData::HEIGHT,
                   makeValues(128, half,
                              [](double x, double y)
                              {
                                  const double height = -slope * std::max(std::abs(x), std::abs(y));
                                  return osg::Vec4d(height, height, height, 1.0);
                              }));
    data->addDerived("normal", SurfaceData::NORMAL);
    _closeUps->setSurfaceData(data);
    const osg::Vec3d sides[] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};

    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 240.0, 300.0);
    closeUp->setScale(1.0, 1.0, 1.0);
    closeUp->getAnchor()->setKind(Anchor::NONE);
    closeUp->getAnchor()->setLineWidth(0.0);
    closeUp->setLighting(CloseUp::SUN);
    _closeUps->addCloseUp(closeUp);
    for (const auto& [heading, azimuth, elevation] : {std::array<double, 3>{0.0, 20.0, 45.0},
                                                      {50.0, 20.0, 45.0},
                                                      {-130.0, 20.0, 40.0},
                                                      {75.0, -155.0, 60.0}})
    {
        closeUp->getRegion()->setHeading(osg::DegreesToRadians(heading));
        closeUp->setSun(osg::DegreesToRadians(azimuth), osg::DegreesToRadians(elevation));
        // Both are clockwise: the sun's azimuth from the region's y axis, and that from north.
        const double bearing = osg::DegreesToRadians(heading + azimuth);
        const double up = osg::DegreesToRadians(elevation);
        const osg::Vec3d sun(std::cos(up) * std::sin(bearing), std::cos(up) * std::cos(bearing),
                             std::sin(up));
        for (const CloseUps::Pipeline pipeline : pipelines)
        {
            SCOPED_TRACE(::testing::Message()
                         << "heading " << heading << ", azimuth " << azimuth << ", pipeline " << pipeline);
            _closeUps->setPipeline(pipeline);
            const osg::ref_ptr<osg::Image> image = draw();
            double light[4], seen[4];
            for (std::size_t i = 0; i < 4; ++i)
            {
                osg::Vec3d normal = sides[i] * slope + osg::Vec3d(0.0, 0.0, 1.0);
                normal.normalize();
                light[i] = normal * sun;
                ASSERT_GT(light[i], 0.0) << "a side in the shade would say little";
                seen[i] = colorOf(*image, 55.0 * sides[i].x(), 55.0 * sides[i].y()).y();
            }
            const auto dark = static_cast<std::size_t>(std::min_element(light, light + 4) - light);
            const auto bright = static_cast<std::size_t>(std::max_element(light, light + 4) - light);
            const double contrast = (seen[bright] - seen[dark]) / (light[bright] - light[dark]);
            EXPECT_GT(contrast, 0.2);
            // Lambert's law: the light that a side gets grows with the cosine, whatever comes from everywhere.
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_NEAR(seen[i], seen[dark] + contrast * (light[i] - light[dark]), 0.012) << "side " << i;
        }
    }
}

TEST_F(CloseUpStyles, LayersShowWhatTheirImagesBecame)
{
    constexpr double half = 200.0;
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    data->setRectangle({-half, -half}, {half, half});
    const auto paint = [](const osg::Vec4d& color)
    {
        return makeValues(16, half, [&](double, double) { return color; });
    };
    const osg::ref_ptr<osg::Image> first = paint({1.0, 0.0, 0.0, 1.0});
    const osg::ref_ptr<osg::Image> second = paint({0.0, 0.0, 1.0, 1.0});
    data->addLayer("first", SurfaceData::COLOR, first);
    data->addLayer("second", SurfaceData::COLOR, second);
    _closeUps->setSurfaceData(data);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 240.0, 300.0);
    closeUp->getAnchor()->setKind(Anchor::NONE);
    _closeUps->addCloseUp(closeUp);
    const auto shown = [&](const char* layer)
    {
        closeUp->setSurface(layer);
        return colorOf(*draw(), 0.0, 0.0);
    };
    const auto repaint = [&](osg::Image& image, const osg::Vec4d& color)
    {
        const osg::ref_ptr<osg::Image> other = paint(color);
        std::copy_n(other->data(), other->getTotalSizeInBytes(), image.data());
        image.dirty();
    };
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        repaint(*first, {1.0, 0.0, 0.0, 1.0});
        EXPECT_LT((shown("first") - osg::Vec3d(1.0, 0.0, 0.0)).length(), 0.02);
        EXPECT_LT((shown("second") - osg::Vec3d(0.0, 0.0, 1.0)).length(), 0.02);
        repaint(*first, {0.0, 1.0, 0.0, 1.0});
        EXPECT_LT((shown("first") - osg::Vec3d(0.0, 1.0, 0.0)).length(), 0.02);
        EXPECT_LT((shown("second") - osg::Vec3d(0.0, 0.0, 1.0)).length(), 0.02);
        // The other one, later: one picture's count of changes must not hide the other's.
        repaint(*second, {1.0, 1.0, 0.0, 1.0});
        EXPECT_LT((shown("second") - osg::Vec3d(1.0, 1.0, 0.0)).length(), 0.02);
        repaint(*second, {0.0, 0.0, 1.0, 1.0});
        EXPECT_LT((shown("second") - osg::Vec3d(0.0, 0.0, 1.0)).length(), 0.02);
    }
}

TEST_F(CloseUpStyles, VaryingsOfOtherEffectsReachTheFragmentsOfCloseUps)
{
    _scene->addEffect(new PlaceColors);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 160.0, 300.0);
    closeUp->getRegion()->setShape(RegionOfInterest::RECTANGLE);
    closeUp->setScale(2.0, 2.0, 2.0);
    closeUp->setRoundness(0.5); // asks for tessellation, and does not change level ground
    closeUp->getAnchor()->setKind(Anchor::NONE);
    _closeUps->addCloseUp(closeUp);
    float version = 0.0f;
    withContext([&](osg::State& state) { version = state.get<osg::GLExtensions>()->glVersion; });
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        for (const int tessellation : {1, 16})
        {
            SCOPED_TRACE(::testing::Message()
                         << "pipeline " << pipeline << ", tessellation " << tessellation);
            _closeUps->setPipeline(pipeline);
            _closeUps->setTessellation(tessellation);
            const osg::ref_ptr<osg::Image> image = draw();
            EXPECT_EQ(_closeUps->statistics().pipeline, pipeline);
            EXPECT_EQ(_closeUps->statistics().tessellated, tessellation > 1 && version >= 4.0f);
            // The close-up shows the ground twice as large, and beside it lies the ground itself.
            for (const auto& [x, y, scale] : {std::array<double, 3>{100.0, 60.0, 2.0},
                                              {-100.0, -60.0, 2.0},
                                              {190.0, 100.0, 1.0},
                                              {-190.0, 20.0, 1.0}})
            {
                // Of the pixel's middle.
                const osg::Vec3d expected((x + 1.0) / scale / 400.0 + 0.5, (y + 1.0) / scale / 400.0 + 0.5,
                                          x > 0.0 ? 1.0 : 0.0);
                EXPECT_LT((colorOf(*image, x, y) - expected).length(), 0.01) << x << ", " << y;
            }
        }
    }
}

TEST_F(CloseUpStyles, WideLinesAreWhole)
{
    // The close-up lies within its region's picture, so that the line alone says how large that is.
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 160.0, 100.0);
    closeUp->getRegion()->setShape(RegionOfInterest::RECTANGLE);
    closeUp->setScale(0.3, 0.3, 0.3);
    closeUp->setColor({1.0, 0.0, 1.0});
    closeUp->getAnchor()->setKind(Anchor::NONE);
    _closeUps->addCloseUp(closeUp);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        for (const int samples : {1, 2})
        {
            for (const double width : {3.0, 20.0})
            {
                SCOPED_TRACE(::testing::Message()
                             << "pipeline " << pipeline << ", samples " << samples << ", width " << width);
                _closeUps->setPipeline(pipeline);
                _closeUps->setSupersampling(samples);
                closeUp->getAnchor()->setLineWidth(width);
                const osg::ref_ptr<osg::Image> image = draw();
                for (const osg::Vec2d& side :
                     {osg::Vec2d(1, 0), osg::Vec2d(0, 1), osg::Vec2d(-1, 0), osg::Vec2d(0, -1)})
                {
                    // Pixels beyond the border, which is 40 pixels from the middle.
                    const auto isLine = [&](double beyond)
                    {
                        const osg::Vec2d at = side * (80.0 + 2.0 * beyond);
                        return (colorOf(*image, at.x(), at.y()) - osg::Vec3d(1.0, 0.0, 1.0)).length() < 0.05;
                    };
                    EXPECT_TRUE(isLine(width / 2.0 - 1.0)) << side.x() << ", " << side.y();
                    EXPECT_FALSE(isLine(width / 2.0 + 1.0)) << side.x() << ", " << side.y();
                }
            }
        }
    }
}

TEST_F(CloseUpStyles, MasksLieWhereTheirRegionDoes)
{
    // A white disc over the ground, of few texels: half of one would be two pixels.
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 200.0, 100.0);
    closeUp->setScale(1.0, 1.0, 1.0);
    closeUp->setBrightness(1.0);
    closeUp->getAnchor()->setKind(Anchor::NONE);
    closeUp->getAnchor()->setLineWidth(0.0);
    closeUp->getRegion()->setMaskSide(24);
    _closeUps->addCloseUp(closeUp);
    constexpr double radius = 50.0; // pixels
    for (const double softness : {0.0, 0.5})
    {
        closeUp->getRegion()->setSoftness(softness);
        for (const CloseUps::Pipeline pipeline : pipelines)
        {
            SCOPED_TRACE(::testing::Message() << "softness " << softness << ", pipeline " << pipeline);
            _closeUps->setPipeline(pipeline);
            const osg::ref_ptr<osg::Image> image = draw();
            double cover = 0.0;
            osg::Vec2d middle;
            for (int y = 0; y < _height; ++y)
            {
                for (int x = 0; x < _width; ++x)
                {
                    const double share = (colorAt(*image, x, y).x() - grey) / (1.0 - grey);
                    cover += share;
                    middle += osg::Vec2d(x + 0.5, y + 0.5) * share;
                }
            }
            middle /= cover;
            EXPECT_NEAR(middle.x(), 0.5 * _width, 0.1);
            EXPECT_NEAR(middle.y(), 0.5 * _height, 0.1);
            // A disc, or a cone that is cut off halfway from its border to its middle.
            const double inner = radius * (1.0 - softness);
            const double expected = osg::PI / 3.0 * (radius * radius + radius * inner + inner * inner);
            EXPECT_NEAR(cover / expected, 1.0, 0.02);
        }
    }
}

TEST_F(CloseUpStyles, AnchorsAreAsOpaqueAsTheirTableSaysOfTheirHeight)
{
    fromTheSouth();
    const osg::ref_ptr<osg::Image> empty = draw();
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 240.0, 200.0);
    closeUp->setScale(1.0, 1.0, 1.0);
    closeUp->setColor({1.0, 0.0, 1.0});
    Anchor& anchor = *closeUp->getAnchor();
    anchor.setLineWidth(0.0);
    anchor.setOpacity(1.0);
    // Opaque in the lowest quarter, clear above it.
    std::vector<float> table(256, 0.0f);
    std::fill_n(table.begin(), 64, 1.0f);
    anchor.setTable(table);
    _closeUps->addCloseUp(closeUp);
    for (const Anchor::Kind kind : {Anchor::CONTOUR, Anchor::STRETCHED})
    {
        anchor.setKind(kind);
        // What is stretched rises where the mask does.
        closeUp->getRegion()->setSoftness(kind == Anchor::STRETCHED ? 0.8 : 0.0);
        for (const CloseUps::Pipeline pipeline : pipelines)
        {
            SCOPED_TRACE(::testing::Message() << "kind " << kind << ", pipeline " << pipeline);
            _closeUps->setPipeline(pipeline);
            const osg::ref_ptr<osg::Image> image = draw();
            // From the ground, in row 25, to the close-up 200 m above it, in row 125.
            for (int row = 28; row < 123; ++row)
            {
                const double share = (row + 0.5 - 25.0) / 100.0;
                if (std::abs(share - 0.25) < 0.03) continue;
                const bool opaque = (colorAt(*image, 100, row) - osg::Vec3d(1.0, 0.0, 1.0)).length() < 0.05;
                const bool clear = (colorAt(*image, 100, row) - colorAt(*empty, 100, row)).length() < 0.02;
                EXPECT_EQ(opaque, share < 0.25) << "at " << share << " of the way";
                EXPECT_EQ(clear, share > 0.25) << "at " << share << " of the way";
            }
        }
    }
}

TEST_F(CloseUpStyles, TurnWithTheSimulationsTime)
{
    // Not with the clock: a program that is paused, or that draws a film frame by frame, says what time it is.
    struct Clock : public osg::NodeCallback
    {
        void operator()(osg::Node*, osg::NodeVisitor* visitor) override
        {
            const_cast<osg::FrameStamp*>(visitor->getFrameStamp())->setSimulationTime(time);
        }
        double time = 0.0;
    };
    const osg::ref_ptr<Clock> clock = new Clock;
    _root->setUpdateCallback(clock);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 200.0, 200.0);
    closeUp->getRegion()->setShape(RegionOfInterest::STAR);
    _closeUps->addCloseUp(closeUp);
    const auto pictureOf = [&](double turn, double rate, double time)
    {
        closeUp->setTurn(turn);
        closeUp->setTurnRate(rate);
        clock->time = time;
        return draw();
    };
    const osg::ref_ptr<osg::Image> still = pictureOf(0.2, 0.0, 7.0);
    EXPECT_TRUE(same(*still, *pictureOf(0.2, 0.3, 0.0)));
    const osg::ref_ptr<osg::Image> turned = pictureOf(0.8, 0.0, 0.0);
    EXPECT_GT(differing(*still, *turned), 0.01);
    EXPECT_LT(differing(*turned, *pictureOf(0.2, 0.3, 2.0)), 0.001);
    EXPECT_LT(differing(*turned, *pictureOf(0.2, -0.3, -2.0)), 0.001);
}

TEST_F(CloseUpStyles, LayersGiveMemoryBackWhenCloseUpsShrink)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 100.0, 200.0);
    _closeUps->addCloseUp(closeUp);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        _closeUps->setSupersampling(4);
        closeUp->setScale(4.0, 4.0, 1.0);
        const osg::ref_ptr<osg::Image> large = draw();
        const CloseUps::Statistics before = _closeUps->statistics();
        EXPECT_GE(before.width, 600);
        _closeUps->setSupersampling(1);
        closeUp->setScale(0.5, 0.5, 1.0);
        const osg::ref_ptr<osg::Image> small = draw();
        const CloseUps::Statistics after = _closeUps->statistics();
        EXPECT_LE(4 * after.width * after.height, before.width * before.height);
        EXPECT_GT(differing(*large, *small), 0.05);
        EXPECT_TRUE(same(*small, *draw()));
    }
}

TEST_F(CloseUpStyles, RegionsOfInactiveCloseUpsKeepTheirLine)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 160.0, 100.0);
    closeUp->getRegion()->setShape(RegionOfInterest::RECTANGLE);
    closeUp->setScale(0.5, 0.5, 0.5);
    closeUp->setColor({1.0, 0.0, 1.0});
    closeUp->getAnchor()->setLineWidth(4.0);
    _closeUps->addCloseUp(closeUp);
    for (const CloseUps::Pipeline pipeline : pipelines)
    {
        _closeUps->setPipeline(pipeline);
        for (const CloseUp::Activity activity : {CloseUp::ACTIVE, CloseUp::REGION_ONLY})
        {
            SCOPED_TRACE(::testing::Message() << "pipeline " << pipeline << ", activity " << activity);
            closeUp->setActivity(activity);
            const osg::ref_ptr<osg::Image> image = draw();
            EXPECT_LT((colorOf(*image, 79.5, 0.0) - osg::Vec3d(1.0, 0.0, 1.0)).length(), 0.05);
            EXPECT_LT((colorOf(*image, 0.0, -79.5) - osg::Vec3d(1.0, 0.0, 1.0)).length(), 0.05);
        }
    }
}
