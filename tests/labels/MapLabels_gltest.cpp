// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Names over a live picture: those of places that are in sight, where these are drawn, and no others.
#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/PictureParts.h>
#include <tools/CloseUpStage.h>
#include <tools/RandomSamples.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 800, HEIGHT = 500;

class MapLabelsTest : public CloseUpStage
{
protected:
    MapLabelsTest() : CloseUpStage(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->removeEffect(_closeUps);
        Random random(31);
        std::vector<MapName> names;
        for (int i = 0; i < 500; ++i)
        {
            MapName name;
            name.text = "Place " + std::to_string(i);
            const double x = random.uniform(-950.0, 950.0), y = random.uniform(-950.0, 950.0);
            // The ground is drawn as triangles, which lie below or above its formula.
            name.places = {{x, y, groundHeight(x, y) + 4.0}};
            name.importance = 500 - i;
            names.push_back(name);
        }
        show(names);
        look({100.0, -1500.0, 260.0}, {0.0, 0.0, 20.0});
    }

    void show(std::vector<MapName> names)
    {
        _root->removeChild(_labels);
        _names = new NameSet(std::move(names));
        NameStyle style;
        style.text.font = "DejaVu Sans";
        style.text.size = 11.0;
        style.text.color.set(1.0f, 0.0f, 1.0f, 1.0f);
        style.text.haloWidth = 0.0;
        style.text.halo.set(1.0f, 0.0f, 1.0f, 1.0f);
        style.lineWidth = 1.0;
        _names->setStyle("", style);
        _labels = new MapLabels(*_scene, _names);
        LabelLayout::Rules rules;
        rules.fading = rules.patience = 0.0;
        _labels->setRules(rules);
        _root->addChild(_labels);
    }

    /// A picture whose names are settled: depths come some frames later.
    osg::ref_ptr<osg::Image> drawSettled()
    {
        osg::ref_ptr<osg::Image> image;
        for (int i = 0; i < 8; ++i)
            image = draw();
        return image;
    }

    std::vector<osg::ref_ptr<Effect>> kinds()
    {
        osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
        bird->setFocusLine(0.2);
        bird->setHorizonLine(0.8);
        osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
        pedestrian->setFocusDistance(500.0);
        pedestrian->setZoneWidth(400.0);
        pedestrian->setBendAngle(0.5);
        osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(2.5);
        // Without the painting, whose trees would hide places that picking takes for visible.
        osg::ref_ptr<PanoramaMap> panorama = new PanoramaMap;
        for (const char* const part : {"paint", "strokes", "water", "sky"})
        {
            std::string error;
            EXPECT_TRUE(panorama->setPropertyText(part, "false", error)) << error;
        }
        return {nullptr, bird, pedestrian, exaggeration, panorama};
    }

    osg::ref_ptr<NameSet> _names;
    osg::ref_ptr<MapLabels> _labels;
};

int magentaIn(const osg::Image& image, int left, int right, int bottom, int top)
{
    int count = 0;
    for (int y = std::max(bottom, 0); y < std::min(top, image.t()); ++y)
    {
        for (int x = std::max(left, 0); x < std::min(right, image.s()); ++x)
        {
            const unsigned char* const pixel =
                image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            count += pixel[0] > 180 && pixel[1] < 90 && pixel[2] > 180 ? 1 : 0;
        }
    }
    return count;
}

} // namespace

// Of each effect, and of several cameras: what picking says is hidden has no name, what it says is seen has one if there is room.
TEST_F(MapLabelsTest, NamesOfPlacesInSightAndOfNoOthers)
{
    Random random(32);
    for (const osg::ref_ptr<Effect>& effect : kinds())
    {
        if (effect) _scene->addEffect(effect);
        for (int sample = 0; sample < 3; ++sample)
        {
            SCOPED_TRACE((effect ? effect->className() : std::string("plain")) + " " +
                         std::to_string(sample));
            const double heading = random.uniform(0.0, 6.28);
            look({1300.0 * std::cos(heading), 1300.0 * std::sin(heading), random.uniform(150.0, 500.0)},
                 {0.0, 0.0, 0.0});
            drawSettled();
            const osg::Camera& camera = *viewer().getCamera();
            const DeformedView view(*_scene, camera);
            const std::vector<MapLabels::Shown> shown = _labels->shown(camera);
            EXPECT_GT(shown.size(), 8u);
            std::set<std::size_t> names;
            for (std::size_t i = 0; i < shown.size(); ++i)
            {
                const PlacedLabel& label = shown[i].label;
                names.insert(shown[i].name);
                osg::Vec2d pixel;
                ASSERT_TRUE(view.project(_names->names()[shown[i].name].places[0], pixel));
                EXPECT_LT((pixel - label.anchor).length(), 1e-6);
                for (std::size_t k = 0; k < i; ++k)
                {
                    const PlacedLabel& other = shown[k].label;
                    EXPECT_FALSE(label.corner.x() < other.corner.x() + other.size.x() &&
                                 other.corner.x() < label.corner.x() + label.size.x() &&
                                 label.corner.y() < other.corner.y() + other.size.y() &&
                                 other.corner.y() < label.corner.y() + label.size.y());
                }
            }
            int hidden = 0, seen = 0;
            for (std::size_t name = 0; name < _names->names().size(); ++name)
            {
                const osg::Vec3d& place = _names->names()[name].places[0];
                osg::Vec2d pixel;
                if (!view.project(place, pixel) || pixel.x() < 2.0 || pixel.y() < 2.0 ||
                    pixel.x() > WIDTH - 2.0 || pixel.y() > HEIGHT - 2.0)
                {
                    EXPECT_FALSE(names.count(name) && (pixel.x() < -1.0 || pixel.y() < -1.0));
                    continue;
                }
                // By how much what is drawn there is nearer, at all of the pixels around: clearly hidden.
                const osg::Matrixd& eye = camera.getViewMatrix();
                const double distance = -(view.deform(place) * eye).z();
                bool clear = true;
                for (const osg::Vec2d& side : {osg::Vec2d(0, 0), osg::Vec2d(2, 0), osg::Vec2d(-2, 0),
                                               osg::Vec2d(0, 2), osg::Vec2d(0, -2)})
                {
                    const auto hit = view.pick(pixel.x() + side.x(), pixel.y() + side.y());
                    clear = hit && -(view.deform(hit->world) * eye).z() < 0.95 * distance;
                    if (!clear) break;
                }
                if (clear)
                {
                    ++hidden;
                    EXPECT_EQ(names.count(name), 0u) << name << " at " << pixel.x() << ", " << pixel.y();
                }
                else
                    seen += names.count(name) ? 1 : 0;
            }
            EXPECT_GT(seen, 8);
            RecordProperty("hidden_" + std::to_string(sample), hidden);
        }
        if (effect) _scene->removeEffect(effect);
    }
}

// The picture: letters in each box, a line from there to the place, and nothing anywhere else.
TEST_F(MapLabelsTest, ThePictureHasThemWhereTheyAreSaidToBe)
{
    const osg::ref_ptr<osg::Image> with = drawSettled();
    const std::vector<MapLabels::Shown> shown = _labels->shown(*viewer().getCamera());
    ASSERT_GT(shown.size(), 10u);
    _labels->setShown(false);
    const osg::ref_ptr<osg::Image> without = drawSettled();
    EXPECT_EQ(magentaIn(*without, 0, WIDTH, 0, HEIGHT), 0);
    int ends = 0;
    std::vector<bool> mayDiffer(WIDTH * HEIGHT, false);
    for (const MapLabels::Shown& each : shown)
    {
        const PlacedLabel& label = each.label;
        const auto mark = [&](double left, double right, double bottom, double top)
        {
            for (int y = std::max(static_cast<int>(bottom) - 1, 0);
                 y < std::min(static_cast<int>(top) + 2, HEIGHT); ++y)
                for (int x = std::max(static_cast<int>(left) - 1, 0);
                     x < std::min(static_cast<int>(right) + 2, WIDTH); ++x)
                    mayDiffer[static_cast<std::size_t>(y * WIDTH + x)] = true;
        };
        mark(label.corner.x(), label.corner.x() + label.size.x(), label.corner.y(),
             label.corner.y() + label.size.y());
        mark(label.anchor.x() - 1.0, label.anchor.x() + 1.0, label.anchor.y(), label.corner.y());
        const int letters = magentaIn(*with, static_cast<int>(label.corner.x()),
                                      static_cast<int>(label.corner.x() + label.size.x()) + 1,
                                      static_cast<int>(label.corner.y()),
                                      static_cast<int>(label.corner.y() + label.size.y()) + 1);
        EXPECT_GT(letters, 4);
        // The line ends within a pixel of the place: it is there right above it, and not two pixels below.
        const int x = static_cast<int>(std::floor(label.anchor.x())),
                  y = static_cast<int>(std::floor(label.anchor.y()));
        EXPECT_GT(magentaIn(*with, x - 1, x + 2, y + 1, y + 3), 0) << _names->names()[each.name].text;
        const bool overAnother =
            std::any_of(shown.begin(), shown.end(),
                        [&](const MapLabels::Shown& other)
                        {
                            const osg::Vec2d low = other.label.corner, high = low + other.label.size;
                            return x + 2 > low.x() && x - 1 < high.x() && y - 1 > low.y() && y - 3 < high.y();
                        });
        if (!overAnother)
        {
            EXPECT_EQ(magentaIn(*with, x - 1, x + 2, y - 3, y - 1), 0) << _names->names()[each.name].text;
            ++ends;
        }
    }
    EXPECT_GT(ends, 10);
    int elsewhere = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            for (int channel = 0; channel < 3; ++channel)
                elsewhere +=
                    !mayDiffer[static_cast<std::size_t>(y * WIDTH + x)] &&
                            with->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))[channel] !=
                                without->data(static_cast<unsigned int>(x),
                                              static_cast<unsigned int>(y))[channel]
                        ? 1
                        : 0;
    EXPECT_EQ(elsewhere, 0);
}

// A bright post stands on a summit, moved by the GPU. The line ends at its foot.
TEST_F(MapLabelsTest, LinesEndAtWhatTheGpuHasMoved)
{
    const double x = 0.5 * 3.14159265 * 170.0, y = 0.0;
    for (const osg::ref_ptr<Effect>& effect : kinds())
    {
        SCOPED_TRACE(effect ? effect->className() : "plain");
        // A patch of a few metres, so that its middle in the picture is the place.
        MapName name;
        name.text = "Summit";
        name.places = {{x, y, groundHeight(x, y) + 6.0}};
        show({name});
        osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
        for (const auto& [dx, dy] : {std::pair{-5.0, -5.0}, {5.0, -5.0}, {5.0, 5.0}, {-5.0, 5.0}})
            corners->push_back(osg::Vec3d(x + dx, y + dy, name.places[0].z()));
        osg::ref_ptr<osg::Geometry> patch = new osg::Geometry;
        patch->setUseVertexBufferObjects(true);
        patch->setVertexArray(corners);
        osg::ref_ptr<osg::Vec4Array> green = new osg::Vec4Array(1);
        green->front().set(0.0f, 1.0f, 0.0f, 1.0f);
        patch->setColorArray(green, osg::Array::BIND_OVERALL);
        patch->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
        patch->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        patch->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
        _scene->addChild(patch);
        if (effect) _scene->addEffect(effect);
        // A panorama map shows what lies in front of the eye's foot.
        const bool map = effect && dynamic_cast<PanoramaMap*>(effect.get());
        look({200.0, map ? -1500.0 : -700.0, map ? 1200.0 : 400.0}, {200.0, 0.0, 20.0});
        _labels->setShown(false);
        const osg::ref_ptr<osg::Image> image = drawSettled();
        _labels->setShown(true);
        drawSettled();
        double sumX = 0.0, sumY = 0.0, count = 0.0;
        for (int row = 0; row < HEIGHT; ++row)
        {
            for (int column = 0; column < WIDTH; ++column)
            {
                const unsigned char* const pixel =
                    image->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
                if (!(pixel[1] > 2 * pixel[0] + 40 && pixel[1] > 2 * pixel[2] + 40)) continue;
                sumX += column + 0.5;
                sumY += row + 0.5;
                count += 1.0;
            }
        }
        const std::vector<MapLabels::Shown> shown = _labels->shown(*viewer().getCamera());
        ASSERT_GT(count, 4.0);
        ASSERT_EQ(shown.size(), 1u);
        EXPECT_NEAR(shown[0].label.anchor.x(), sumX / count, 1.0);
        EXPECT_NEAR(shown[0].label.anchor.y(), sumY / count, 1.0);
        if (effect) _scene->removeEffect(effect);
        _scene->removeChild(patch);
    }
}

// A ridge that comes between takes the name away, and gives it back.
TEST_F(MapLabelsTest, WhatComesBetweenTakesTheNameAway)
{
    MapName name;
    name.text = "Behind";
    name.places = {{0.0, 300.0, groundHeight(0.0, 300.0) + 4.0}};
    show({name});
    look({0.0, -1200.0, 500.0}, {0.0, 0.0, 0.0});
    drawSettled();
    EXPECT_EQ(_labels->shown(*viewer().getCamera()).size(), 1u);
    osg::ref_ptr<osg::Vec3Array> wall = new osg::Vec3Array;
    for (const auto& [x, z] : {std::pair{-400.0, -100.0}, {400.0, -100.0}, {400.0, 600.0}, {-400.0, 600.0}})
        wall->push_back(osg::Vec3d(x, -300.0, z));
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(wall);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    osg::ref_ptr<osg::Vec4Array> grey = new osg::Vec4Array(1);
    grey->front().set(0.5f, 0.5f, 0.5f, 1.0f);
    geometry->setColorArray(grey, osg::Array::BIND_OVERALL);
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    _scene->addChild(geometry);
    drawSettled();
    EXPECT_EQ(_labels->shown(*viewer().getCamera()).size(), 0u);
    _scene->removeChild(geometry);
    drawSettled();
    EXPECT_EQ(_labels->shown(*viewer().getCamera()).size(), 1u);
}

// Two cameras that draw a picture side by side show the same names as one.
TEST_F(MapLabelsTest, PartsOfAPictureShareItsNames)
{
    drawSettled();
    std::set<std::size_t> whole, parts;
    for (const MapLabels::Shown& each : _labels->shown(*viewer().getCamera()))
        whole.insert(each.name);
    ASSERT_GT(whole.size(), 10u);
    drawInParts(viewer(), 2);
    for (int i = 0; i < 8; ++i)
        viewer().frame();
    for (const MapLabels::Shown& each : _labels->shown(*viewer().getCamera()))
        parts.insert(each.name);
    EXPECT_EQ(parts, whole);
}

// A name along a ridge follows it; a name whose curve is too short is left out.
TEST_F(MapLabelsTest, NamesFollowCurves)
{
    MapName ridge, tiny;
    ridge.text = "The Long Range";
    ridge.kind = tiny.kind = MapName::LINE;
    for (int i = -8; i <= 8; ++i)
        ridge.places.emplace_back(60.0 * i, 0.4 * i * i, groundHeight(60.0 * i, 0.4 * i * i) + 30.0);
    tiny.text = "A Small Lake";
    tiny.places = {{0.0, -300.0, 40.0}, {8.0, -300.0, 40.0}};
    show({ridge, tiny});
    look({0.0, -900.0, 900.0}, {0.0, 0.0, 0.0});
    const osg::ref_ptr<osg::Image> image = drawSettled();
    const std::vector<MapLabels::Shown> shown = _labels->shown(*viewer().getCamera());
    ASSERT_EQ(shown.size(), 1u);
    const PlacedLabel& label = shown[0].label;
    EXPECT_EQ(_names->names()[shown[0].name].text, ridge.text);
    const int ink = magentaIn(*image, 0, WIDTH, 0, HEIGHT);
    EXPECT_GT(ink, 60);
    EXPECT_EQ(magentaIn(*image, static_cast<int>(label.corner.x()) - 2,
                        static_cast<int>(label.corner.x() + label.size.x()) + 3,
                        static_cast<int>(label.corner.y()) - 2,
                        static_cast<int>(label.corner.y() + label.size.y()) + 3),
              ink);
}

// As lines do. Ground that a close-up hides has no name, and neither has ground that is hidden on the close-up itself.
TEST_F(MapLabelsTest, NamesOfALiftedRegionRideOnTheCloseUp)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({150.0, 100.0}, 500.0, 350.0);
    _closeUps->addCloseUp(closeUp);
    _scene->addEffect(_closeUps);
    // From above the close-up.
    look({100.0, -1500.0, 1100.0}, {0.0, 0.0, 100.0});
    drawSettled();
    const osg::Camera& camera = *viewer().getCamera();
    const DeformedView view(*_scene, camera);
    int riding = 0, picked = 0, others = 0;
    for (const MapLabels::Shown& shown : _labels->shown(camera))
    {
        const osg::Vec3d& place = _names->names()[shown.name].places.front();
        const double x = place.x() - 150.0, y = place.y() - 100.0;
        const osg::Vec2d anchor = shown.label.anchor;
        const auto hit = pickCloseUp(*_scene, *_closeUps, camera, anchor.x(), anchor.y());
        osg::Vec2d expected;
        // The region is a disc of 250 m.
        if (std::hypot(x, y) < 240.0)
        {
            ++riding;
            expected = projectCloseUp(*_scene, *closeUp, camera, place).value();
            // A name stands above the ground, so that of the farthest edge lies beside the close-up in the picture.
            if (hit)
            {
                ++picked;
                EXPECT_FALSE(hit->onRegion) << shown.name;
                EXPECT_LT((hit->world - place).length(), 40.0) << shown.name;
            }
        }
        else if (std::hypot(x, y) > 260.0)
        {
            ++others;
            ASSERT_TRUE(view.project(place, expected));
            // Depths are compared within a pixel.
            EXPECT_TRUE(!hit || hit->onRegion || hit->place.length() > 0.95) << shown.name;
        }
        else
            continue;
        EXPECT_LT((anchor - expected).length(), 0.1) << shown.name;
    }
    EXPECT_GT(riding, 5);
    EXPECT_GE(picked, riding - 3);
    EXPECT_GT(others, 10);
    // One picture has the same.
    const LabelPicture picture(*_names, *_scene, camera, {});
    int onCloseUp = 0;
    for (const LabelPicture::Name& name : picture.placed())
    {
        const osg::Vec3d& place = _names->names()[name.name].places.front();
        if (std::hypot(place.x() - 150.0, place.y() - 100.0) > 240.0) continue;
        ++onCloseUp;
        EXPECT_LT((name.label.anchor - projectCloseUp(*_scene, *closeUp, camera, place).value()).length(),
                  0.1);
    }
    EXPECT_GE(onCloseUp, 5);
}

// Landmarks alone keep their names in the context of a bend, in a live picture, too.
TEST_F(MapLabelsTest, LandmarksAlone)
{
    _scene->addEffect(kinds()[2]);
    look({0.0, -1300.0, 300.0}, {0.0, 0.0, 0.0});
    const osg::Camera& camera = *viewer().getCamera();
    const auto count = [&](bool important)
    {
        drawSettled();
        const DeformedView view(*_scene, camera);
        int far = 0;
        for (const MapLabels::Shown& each : _labels->shown(camera))
        {
            const MapName& name = _names->names()[each.name];
            const bool isFar = view.chain().style(name.places[0] * view.modelView()) >= 0.5;
            far += isFar && (name.importance >= 400.0) == important ? 1 : 0;
        }
        return far;
    };
    EXPECT_GT(count(false), 0);
    const int before = count(true);
    EXPECT_GT(before, 0);
    _names->setContextImportance(400.0);
    EXPECT_EQ(count(false), 0);
    EXPECT_GE(count(true), before) << "they have more room";
    EXPECT_GT(_labels->shown(camera).size(), static_cast<std::size_t>(count(true)))
        << "the focus has its names";
}
