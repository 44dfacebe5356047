// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lines in a live picture: where picking says that their ground is to be seen, and where the same lines as vectors are.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/lines/LinePicture.h>
#include <osgGeoFX/lines/MapLines.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/BentGround.h>
#include <tools/CloseUpStage.h>
#include <tools/CoreView.h>
#include <tools/RandomSamples.h>

#include <cairo.h>
#include <osg/Fog>
#include <osg/Program>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 640, HEIGHT = 400;

bool isMagenta(const unsigned char* pixel)
{
    return pixel[0] > 150 && pixel[1] < 110 && pixel[2] > 150;
}

class MapLinesTest : public CloseUpStage
{
protected:
    MapLinesTest() : CloseUpStage(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->removeEffect(_closeUps);
        _reader->setImmediate(true);
        _root->addChild(_reader);
        _styles[""].color.set(1.0f, 0.0f, 1.0f, 1.0f);
        _styles[""].width = 3.0;
        _styles[""].hand = 0.0;
        Random random(41);
        for (int i = 0; i < 14; ++i)
        {
            MapLine line;
            const osg::Vec2d from(random.uniform(-900.0, 900.0), random.uniform(-900.0, 900.0));
            const osg::Vec2d to(random.uniform(-900.0, 900.0), random.uniform(-900.0, 900.0));
            for (int k = 0; k <= 60; ++k)
            {
                const osg::Vec2d at = from + (to - from) * (k / 60.0);
                // The ground is drawn as triangles, which lie below or above its formula.
                line.places.emplace_back(at.x(), at.y(), groundHeight(at.x(), at.y()) + 3.0);
            }
            _lines.push_back(line);
        }
        look({100.0, -1500.0, 360.0}, {0.0, 0.0, 20.0});
    }

    void show()
    {
        hide();
        _node = new MapLines(_lines, _styles);
        _node->setScale(1.0);
        _scene->addChild(_node);
    }
    void hide()
    {
        if (_node) _scene->removeChild(_node);
        _node = nullptr;
    }

    LinePicture vectors() { return {_lines, _styles, *_scene, *viewer().getCamera(), _reader->pictures()}; }

    static std::vector<std::pair<const char*, osg::ref_ptr<Effect>>> kinds()
    {
        osg::ref_ptr<osgGeoFX::BirdsEyeView> bird = new osgGeoFX::BirdsEyeView;
        bird->setFocusLine(0.2);
        bird->setHorizonLine(0.8);
        osg::ref_ptr<osgGeoFX::PedestrianView> pedestrian = new osgGeoFX::PedestrianView;
        pedestrian->setFocusDistance(500.0);
        pedestrian->setZoneWidth(400.0);
        pedestrian->setBendAngle(0.5);
        osg::ref_ptr<osgGeoFX::VerticalExaggeration> exaggeration = new osgGeoFX::VerticalExaggeration;
        exaggeration->setFactor(2.5);
        // Without trees, which would hide lines that picking takes for visible.
        osg::ref_ptr<PanoramaMap> panorama = new PanoramaMap;
        panorama->setViewRadius(900.0);
        for (const char* const part : {"strokes", "water", "sky"})
        {
            std::string error;
            EXPECT_TRUE(panorama->setPropertyText(part, "false", error)) << error;
        }
        return {{"plain", nullptr},
                {"bird's eye", bird},
                {"pedestrian", pedestrian},
                {"exaggeration", exaggeration},
                {"panorama", panorama}};
    }

    /// Whether one of the pixels around one is a line's.
    static bool near(const osg::Image& image, double x, double y, int around)
    {
        for (int j = -around; j <= around; ++j)
            for (int i = -around; i <= around; ++i)
            {
                const int column = static_cast<int>(x) + i, row = static_cast<int>(y) + j;
                if (column < 0 || row < 0 || column >= image.s() || row >= image.t()) continue;
                if (isMagenta(image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row))))
                    return true;
            }
        return false;
    }

    /// The share of the line pixels of one image that have none of the other one's near them.
    static double strays(const osg::Image& of, const osg::Image& in, int around)
    {
        int all = 0, stray = 0;
        for (int y = 0; y < of.t(); ++y)
            for (int x = 0; x < of.s(); ++x)
            {
                if (!isMagenta(of.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)))) continue;
                ++all;
                stray += near(in, x, y, around) ? 0 : 1;
            }
        EXPECT_GT(all, 500);
        return static_cast<double>(stray) / std::max(all, 1);
    }

    /// The vectors on black.
    static osg::ref_ptr<osg::Image> drawn(const LinePicture& lines)
    {
        cairo_surface_t* const surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, WIDTH, HEIGHT);
        cairo_t* const target = cairo_create(surface);
        lines.draw(target);
        cairo_destroy(target);
        cairo_surface_flush(surface);
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(WIDTH, HEIGHT, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        for (int y = 0; y < HEIGHT; ++y)
        {
            const unsigned char* const from =
                cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface);
            for (int x = 0; x < WIDTH; ++x)
            {
                unsigned char* const to =
                    image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(HEIGHT - 1 - y));
                for (int channel = 0; channel < 4; ++channel)
                    to[channel] = from[4 * x + (channel < 3 ? 2 - channel : 3)];
            }
        }
        cairo_surface_destroy(surface);
        return image;
    }

    std::vector<MapLine> _lines;
    std::map<std::string, LineStyle> _styles;
    osg::ref_ptr<MapLines> _node;
    osg::ref_ptr<DepthReader> _reader = new DepthReader;
};

} // namespace

// Of each effect: a place of a line that picking says is hidden is no line's pixel, one that it says is seen is.
TEST_F(MapLinesTest, AreDrawnWhereTheirGroundIsToBeSeen)
{
    Random random(42);
    for (const auto& [kind, effect] : kinds())
    {
        SCOPED_TRACE(kind);
        if (effect) _scene->addEffect(effect);
        int shown = 0, hidden = 0;
        for (int sample = 0; sample < 2; ++sample)
        {
            const double heading = random.uniform(0.0, 6.28);
            look({1300.0 * std::cos(heading), 1300.0 * std::sin(heading), random.uniform(150.0, 500.0)},
                 {0.0, 0.0, 0.0});
            hide();
            draw();
            const osg::Camera& camera = *viewer().getCamera();
            const DeformedView view(*_scene, camera);
            const LinePicture lines = vectors();
            show();
            const osg::ref_ptr<osg::Image> image = draw();
            for (const MapLine& line : _lines)
                for (std::size_t k = 0; k < line.places.size(); k += 4)
                {
                    const osg::Vec3d& place = line.places[k];
                    osg::Vec2d pixel;
                    if (!view.project(place, pixel) || pixel.x() < 3.0 || pixel.y() < 3.0 ||
                        pixel.x() > WIDTH - 3.0 || pixel.y() > HEIGHT - 3.0)
                        continue;
                    const double distance = -(view.deform(place) * camera.getViewMatrix()).z();
                    bool before = true, clear = true;
                    for (const osg::Vec2d& side : {osg::Vec2d(0, 0), osg::Vec2d(3, 0), osg::Vec2d(-3, 0),
                                                   osg::Vec2d(0, 3), osg::Vec2d(0, -3)})
                    {
                        const auto hit = view.pick(pixel.x() + side.x(), pixel.y() + side.y());
                        const double met =
                            hit ? -(view.deform(hit->world) * camera.getViewMatrix()).z() : HUGE_VAL;
                        before = before && met < 0.95 * distance;
                        clear = clear && met > (side.length2() > 0.0 ? 0.98 : 0.997) * distance;
                        if (!before && !clear) break;
                    }
                    const bool is = near(*image, pixel.x(), pixel.y(), 1);
                    if (clear)
                    {
                        ++shown;
                        EXPECT_TRUE(is) << pixel.x() << ", " << pixel.y();
                    }
                    // Another line may run there.
                    if (before && is)
                    {
                        bool other = false;
                        for (const LinePicture::Part& part : lines.parts())
                            for (const osg::Vec2d& point : part.points)
                                other = other || (point - pixel).length() < 8.0;
                        EXPECT_TRUE(other) << pixel.x() << ", " << pixel.y();
                    }
                    hidden += before ? 1 : 0;
                }
        }
        EXPECT_GT(shown, 40);
        RecordProperty(std::string(kind) + " hidden", hidden);
        if (effect) _scene->removeEffect(effect);
    }
}

// The same lines as vectors, which Cairo draws, lie on the same pixels.
TEST_F(MapLinesTest, VectorsAreThePicture)
{
    for (const auto& [kind, effect] : kinds())
    {
        SCOPED_TRACE(kind);
        if (effect) _scene->addEffect(effect);
        hide();
        draw();
        const osg::ref_ptr<osg::Image> byCairo = drawn(vectors());
        show();
        const osg::ref_ptr<osg::Image> image = draw();
        EXPECT_LT(strays(*image, *byCairo, 1), 0.03);
        EXPECT_LT(strays(*byCairo, *image, 1), 0.03);
        if (effect) _scene->removeEffect(effect);
    }
}

// Poles before a line leave it whole; a wall cuts it.
TEST_F(MapLinesTest, VectorsHaveNoGapsOfAFewPixels)
{
    _lines = {MapLine()};
    for (int k = 0; k <= 60; ++k)
    {
        const double x = -300.0 + 10.0 * k;
        _lines.front().places.emplace_back(x, 0.0, groundHeight(x, 0.0) + 3.0);
    }
    look({0.0, -1000.0, 500.0}, {0.0, 0.0, 20.0});
    const auto partsBehind = [&](float width)
    {
        const osg::ref_ptr<osg::Group> poles = new osg::Group;
        for (const float x : {-200.0f, -50.0f, 120.0f})
            poles->addChild(new osg::ShapeDrawable(new osg::Box({x, -60.0f, 100.0f}, width, 10.0f, 300.0f)));
        _scene->addChild(poles);
        draw();
        const std::size_t parts = vectors().parts().size();
        _scene->removeChild(poles);
        return parts;
    };
    EXPECT_EQ(partsBehind(8.0f), 1u);
    EXPECT_EQ(partsBehind(60.0f), 4u);
}

// Widths by the distance, casings and dashes are those of the vectors, too.
TEST_F(MapLinesTest, StylesOfVectorsAreThoseOfThePicture)
{
    LineStyle& style = _styles[""];
    style.ground = 12.0;
    style.width = 14.0;
    style.least = 2.0;
    style.dash = 60.0;
    style.gap = 40.0;
    look({0.0, -1700.0, 900.0}, {0.0, 0.0, 20.0});
    draw();
    const LinePicture lines = vectors();
    double narrow = 1e9, wide = 0.0;
    for (const LinePicture::Part& part : lines.parts())
        for (const LinePicture::Piece& piece : lines.piecesOf(part))
        {
            narrow = std::min(narrow, piece.width);
            wide = std::max(wide, piece.width);
        }
    EXPECT_GT(wide, 1.5 * narrow);
    show();
    const osg::ref_ptr<osg::Image> image = draw();
    const osg::ref_ptr<osg::Image> byCairo = drawn(lines);
    EXPECT_LT(strays(*image, *byCairo, 1), 0.05);
    EXPECT_LT(strays(*byCairo, *image, 1), 0.05);
    // Without dashes there would be more.
    style.dash = 0.0;
    show();
    const osg::ref_ptr<osg::Image> whole = draw();
    EXPECT_GT(strays(*whole, *image, 1), 0.15);

    style = LineStyle();
    style.color.set(0.0f, 0.0f, 0.0f, 1.0f);
    style.casing.set(1.0f, 0.0f, 1.0f, 1.0f);
    style.casingWidth = 3.0;
    style.hand = 0.0;
    show();
    const osg::ref_ptr<osg::Image> cased = draw();
    const osg::ref_ptr<osg::Image> casedByCairo = drawn(vectors());
    EXPECT_LT(strays(*cased, *casedByCairo, 1), 0.02);
    EXPECT_LT(strays(*casedByCairo, *cased, 1), 0.02);
}

// Lines narrower than a pixel are as pale as their vectors, which Cairo draws onto the same ground.
TEST_F(MapLinesTest, ThinLinesAreAsPaleAsTheirVectors)
{
    // From above, where nothing is hidden.
    look({0.0, -900.0, 2200.0}, {0.0, 0.0, 20.0});
    const osg::ref_ptr<osg::Image> plain = draw();
    const auto ink = [&](const osg::Image& image)
    {
        double sum = 0.0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
            {
                const unsigned char* const pixel = image.data(x, y);
                const unsigned char* const ground = plain->data(x, y);
                for (int channel = 0; channel < 3; ++channel)
                    sum += std::abs(pixel[channel] - ground[channel]);
            }
        return sum;
    };
    for (const double width : {0.3, 0.5, 0.8, 1.0, 1.5})
    {
        SCOPED_TRACE(width);
        _styles[""].width = width;
        hide();
        draw();
        const osg::ref_ptr<osg::Image> byCairo = new osg::Image(*plain, osg::CopyOp::DEEP_COPY_ALL);
        ASSERT_TRUE(vectors().drawOnto(*byCairo, 0));
        show();
        EXPECT_NEAR(ink(*draw()) / ink(*byCairo), 1.0, 0.1);
    }
}

// They write no depth, and rays do not meet them.
TEST_F(MapLinesTest, HideNothing)
{
    draw();
    const std::vector<float> former = _reader->pictures().front()->depths;
    show();
    draw();
    EXPECT_TRUE(_reader->pictures().front()->depths == former);
    const DeformedView view(*_scene, *viewer().getCamera());
    for (const MapLine& line : _lines)
    {
        osg::Vec2d pixel;
        if (!view.project(line.places[30], pixel)) continue;
        const auto hit = view.pick(pixel.x(), pixel.y());
        if (hit)
        {
            EXPECT_NEAR(hit->world.z(), groundHeight(hit->world.x(), hit->world.y()), 4.0);
        }
    }
}

// As deep as the ground on which they lie.
TEST_F(MapLinesTest, AreInTheFogOfTheirGround)
{
    _styles[""].width = 9.0;
    look({100.0, -1400.0, 900.0}, {0.0, 0.0, 20.0});
    const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setColor({0.1f, 0.8f, 0.2f, 1.0f});
    _scene->getOrCreateStateSet()->setAttributeAndModes(fog);
    const osg::ref_ptr<Effect> bend = kinds()[1].second;
    const std::vector<MapLine> all = _lines;
    for (const bool linear : {false, true})
    {
        SCOPED_TRACE(linear ? "linear" : "exp");
        fog->setMode(linear ? osg::Fog::LINEAR : osg::Fog::EXP);
        fog->setStart(linear ? 700.0f : 0.0f);
        fog->setEnd(linear ? 2500.0f : 1.0f);
        fog->setDensity(0.0006f);
        for (const bool bent : {false, true})
        {
            SCOPED_TRACE(bent ? "bent" : "straight");
            if (bent) _scene->addEffect(bend);
            int compared = 0;
            float least = 1.0f, most = 0.0f;
            // One by one: a wide line covers others behind it.
            for (std::size_t k = 0; k < all.size(); k += 3)
            {
                _lines = {all[k]};
                hide();
                draw();
                const DeformedView view(*_scene, *viewer().getCamera());
                show();
                const osg::ref_ptr<osg::Image> image = draw();
                const auto distanceOf = [&](const osg::Vec3d& world)
                {
                    return -(view.deform(world) * viewer().getCamera()->getViewMatrix()).z();
                };
                for (const osg::Vec3d& place : all[k].places)
                {
                    osg::Vec2d pixel;
                    if (!view.project(place, pixel) || pixel.x() < 0.0 || pixel.y() < 0.0 ||
                        pixel.x() >= WIDTH || pixel.y() >= HEIGHT)
                        continue;
                    const auto distance = static_cast<float>(distanceOf(place));
                    bool hidden = false;
                    for (const osg::Vec2d& side : {osg::Vec2d(0, 0), osg::Vec2d(5, 0), osg::Vec2d(-5, 0),
                                                   osg::Vec2d(0, 5), osg::Vec2d(0, -5)})
                    {
                        const auto hit = view.pick(pixel.x() + side.x(), pixel.y() + side.y());
                        const double before =
                            (side.length2() > 0.0 ? 0.98 : 0.997) * static_cast<double>(distance);
                        hidden = hit && distanceOf(hit->world) < before;
                        if (hidden) break;
                    }
                    if (hidden) continue;
                    const float clear = linear ? std::clamp((2500.0f - distance) / 1800.0f, 0.0f, 1.0f)
                                               : std::exp(-0.0006f * distance);
                    const osg::Vec4 expected = fog->getColor() * (1.0f - clear) + _styles[""].color * clear;
                    const osg::Vec4 seen = image->getColor(static_cast<unsigned int>(pixel.x()),
                                                           static_cast<unsigned int>(pixel.y()));
                    ++compared;
                    least = std::min(least, clear);
                    most = std::max(most, clear);
                    for (unsigned int channel = 0; channel < 3; ++channel)
                        EXPECT_NEAR(seen[channel], expected[channel], 0.02f)
                            << pixel.x() << ", " << pixel.y() << ": " << channel;
                }
            }
            EXPECT_GT(compared, 60);
            EXPECT_GT(most - least, 0.15f);
            if (bent) _scene->removeEffect(bend);
        }
    }
}

// A close-up lifts the lines of its region.
TEST_F(MapLinesTest, AreLiftedIntoCloseUps)
{
    _lines = {_lines.front()};
    _lines.front().places.clear();
    for (int k = 0; k <= 60; ++k)
    {
        const double x = -150.0 + 5.0 * k;
        _lines.front().places.emplace_back(x, 0.0, groundHeight(x, 0.0) + 3.0);
    }
    for (const CloseUps::Pipeline pipeline : {CloseUps::AUTOMATIC, CloseUps::MULTI_PASS})
    {
        osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        closeUps->addCloseUp(makeCloseUp({0.0, 0.0}, 400.0, 400.0));
        closeUps->setPipeline(pipeline);
        _scene->addEffect(closeUps);
        look({100.0, -1300.0, 1100.0}, {0.0, 0.0, 200.0});
        show();
        const osg::ref_ptr<osg::Image> image = draw();
        const DeformedView view(*_scene, *viewer().getCamera());
        osg::Vec2d ground, lifted;
        ASSERT_TRUE(view.project(_lines.front().places[30], ground));
        ASSERT_TRUE(view.project(_lines.front().places[30] + osg::Vec3d(0.0, 0.0, 400.0), lifted));
        int above = 0;
        for (int y = static_cast<int>(lifted.y()) - 40; y < static_cast<int>(lifted.y()) + 60; ++y)
            above += y >= 0 && y < HEIGHT && near(*image, lifted.x(), y, 0) ? 1 : 0;
        EXPECT_GT(above, 1) << pipeline;
        _scene->removeEffect(closeUps);
    }
}

// In a core profile, and with a depth that falls with the distance.
TEST_F(MapLinesTest, AreThereInOtherContextsAndDepths)
{
    _scene->addEffect(kinds()[1].second);
    // Ground of an application's program, for there are no fixed functions.
    const auto program = [](bool core)
    {
        const std::string version = core ? "#version 330 core\n" : "#version 330 compatibility\n";
        osg::ref_ptr<osg::Program> result = new osg::Program;
        result->addShader(new osg::Shader(osg::Shader::VERTEX,
                                          version + "vec4 geofx_vertex(vec4 eye);\nvoid main()\n{\n"
                                                    "    gl_Position = gl_ProjectionMatrix * "
                                                    "geofx_vertex(gl_ModelViewMatrix * gl_Vertex);\n}\n"));
        result->addShader(new osg::Shader(
            osg::Shader::FRAGMENT, version + "vec4 geofx_fragment(vec4 color, vec4 map);\nout vec4 color;\n"
                                             "void main()\n{\n    color = geofx_fragment(vec4(0.2, 0.5, 0.2, "
                                             "1.0), vec4(0.0));\n}\n"));
        EffectScene::addFunctions(*result);
        return result;
    };
    osg::StateSet& ground = *_scene->getChild(0)->getOrCreateStateSet();
    ground.setAttributeAndModes(program(false));
    show();
    const osg::ref_ptr<osg::Image> image = draw();

    CoreView core(WIDTH, HEIGHT);
    ASSERT_TRUE(core.valid());
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addEffect(kinds()[1].second);
    const osg::ref_ptr<osg::Geometry> hills = makeHills();
    hills->getOrCreateStateSet()->setAttributeAndModes(program(true));
    other->addChild(hills);
    const osg::ref_ptr<MapLines> lines = new MapLines(_lines, _styles);
    other->addChild(lines);
    const osg::ref_ptr<osg::Image> inCore = core.render(other, *viewer().getCamera(), 2);
    EXPECT_TRUE(core.errors.empty()) << core.errors.front();
    EXPECT_LT(strays(*image, *inCore, 1), 0.01);
    EXPECT_LT(strays(*inCore, *image, 1), 0.01);
}

namespace
{

class WideLines : public BentGround
{
};

} // namespace

// The ground hides no side of a line that is wider than the ground's triangles: as if there was no ground.
TEST_F(WideLines, AreWhole)
{
    std::map<std::string, LineStyle> styles;
    styles[""].color.set(1.0f, 0.0f, 1.0f, 1.0f);
    styles[""].ground = 16.0;
    styles[""].width = 90.0;
    styles[""].hand = 0.0;
    std::vector<MapLine> lines;
    for (const double y : {-80.0, -20.0, 60.0})
    {
        MapLine line;
        for (double x = -60.0; x <= 60.0; x += 4.0)
            line.places.emplace_back(x, y, std::sin(x / 13) * std::cos(y / 17));
        lines.push_back(line);
    }
    std::vector<osg::ref_ptr<EffectScene>> kept; // or buffers of one would serve the next
    for (const bool bent : {false, true})
    {
        SCOPED_TRACE(bent ? "bent" : "straight");
        std::array<int, 2> counts{};
        for (const bool ground : {false, true})
        {
            const osg::ref_ptr<EffectScene> scene = new EffectScene;
            kept.push_back(scene);
            if (bent) scene->addEffect(makeBend());
            if (ground) scene->addChild(makeGround());
            scene->addChild(new MapLines(lines, styles));
            const osg::ref_ptr<osg::Image> image = render(scene);
            for (int i = 0; i < image->s() * image->t(); ++i)
                counts[ground ? 1 : 0] += isMagenta(image->data() + 4 * i) ? 1 : 0;
        }
        EXPECT_GT(counts[0], 800);
        // The ground's waves are a metre high.
        EXPECT_GT(counts[1], counts[0] * 97 / 100);
    }
}
