// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Lenses and mask painting: what they show and draw, and how they follow the mouse.
#include <osgGeoFX/mapping/LensMapping.h>
#include <osgGeoFX/mapping/MaskPainter.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/NotifyWatch.h>

#include <gtest/gtest.h>
#include <osg/Geode>
#include <osg/MatrixTransform>
#include <osgUtil/UpdateVisitor>
#include <osgViewer/Viewer>

#include <cmath>
#include <functional>

using namespace osgGeoFX;
using osg::Vec2d;

namespace
{

/// Red grows to the right, green upwards; 256² texels.
osg::ref_ptr<DataLayer> colorField()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(256, 256, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int row = 0; row < 256; ++row)
    {
        for (int column = 0; column < 256; ++column)
        {
            image->data(column, row)[0] = static_cast<unsigned char>(column);
            image->data(column, row)[1] = static_cast<unsigned char>(row);
            image->data(column, row)[2] = 7;
        }
    }
    return new DataLayer(image);
}

/// A mapping that is not added: 1024 × 1024 m about the origin.
osg::ref_ptr<ProjectiveMapping> content(DataLayer* layer)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setLayer(layer);
    mapping->setRectangle({0, 0}, 512.0, 512.0);
    return mapping;
}

/// Flat ground of 2 × 2 km seen from above, in a viewer that never draws.
class Pointer : public ::testing::Test
{
protected:
    void SetUp() override
    {
        osg::ref_ptr<osg::Geode> ground = new osg::Geode;
        ground->addDrawable(osg::createTexturedQuadGeometry({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}));
        _scene->addChild(ground);
        _scene->addEffect(_mappings);
        _viewer.setSceneData(_scene);
        osg::Camera& camera = *_viewer.getCamera();
        camera.setViewport(0, 0, 200, 100);
        camera.setViewMatrixAsLookAt({0, 0, 500}, {0, 0, 0}, {0, 1, 0});
        // 1000 m across 200 pixels.
        camera.setProjectionMatrixAsOrtho(-500, 500, -250, 250, 1, 1000);
    }

    bool send(osgGA::GUIEventHandler& handler, osgGA::GUIEventAdapter::EventType type, float x, float y,
              int modifiers = 0)
    {
        osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
        event->setEventType(type);
        event->setX(x);
        event->setY(y);
        event->setModKeyMask(modifiers);
        event->setButton(osgGA::GUIEventAdapter::LEFT_MOUSE_BUTTON);
        event->setScrollingMotion(osgGA::GUIEventAdapter::SCROLL_UP);
        event->setKey('z');
        event->setUnmodifiedKey('z');
        return handler.handle(*event, _viewer);
    }

    using Event = osgGA::GUIEventAdapter;
    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osgViewer::Viewer _viewer;
};

/// Whether a setter refuses, with one warning.
bool refused(const std::function<bool()>& set)
{
    geofx::test::NotifyWatch watch;
    bool taken = true;
    const std::vector<std::string> messages = watch.messagesOf([&] { taken = set(); });
    return !taken && messages.size() == 1;
}

} // namespace

TEST(Lens, showsWhatIsBelowIt)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    {
        osg::ref_ptr<LensMapping> lens = new LensMapping(*mappings, 5);
        EXPECT_EQ(mappings->getNumMappings(), 1u); // the rim
        lens->setContent(content(colorField()));
        EXPECT_EQ(mappings->getNumMappings(), 2u);
        EXPECT_EQ(mappings->mappingsAt({0, 0}).front(), &lens->rim());
        for (const Vec2d& center : {Vec2d(0, 0), Vec2d(200, -100), Vec2d(-260, 300)})
        {
            ASSERT_TRUE(lens->place(center, 100.0, 100.0, 0.4));
            const osg::Image& cut = *lens->inside().getLayer()->getImage();
            const glm::dmat3 back = glm::inverse(lens->inside().placeToRaster());
            for (int i = 60; i < 200; i += 9)
            {
                const glm::dvec3 place = back * glm::dvec3((i + 0.5) / cut.s(), 150.5 / cut.t(), 1.0);
                const unsigned char* texel = cut.data(static_cast<unsigned int>(i), 150);
                // 4 m to a texel; the middle of texel 0 is 2 m from the edge.
                ASSERT_NEAR(texel[0], (place.x + 512.0) / 4.0 - 0.5, 0.51);
                ASSERT_NEAR(texel[1], (place.y + 512.0) / 4.0 - 0.5, 0.51);
                ASSERT_EQ(texel[2], 7);
                ASSERT_EQ(texel[3], 255);
            }
            EXPECT_EQ(cut.data(0, 0)[3], 0) << "outside of the circle";
        }
        // Half of it over the edge of what it shows.
        lens->place({512, 0}, 100.0, 100.0);
        const osg::Image& cut = *lens->inside().getLayer()->getImage();
        EXPECT_EQ(cut.data(100, 128)[3], 255);
        EXPECT_EQ(cut.data(156, 128)[3], 0);
        lens->setContent(nullptr);
        EXPECT_EQ(mappings->getNumMappings(), 1u);
    }
    EXPECT_EQ(mappings->getNumMappings(), 0u);
}

TEST(Lens, keepsValuesAndWhatTheyMean)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(64, 64, 1, GL_LUMINANCE, GL_SHORT);
    for (int row = 0; row < 64; ++row)
    {
        for (int column = 0; column < 64; ++column)
            *reinterpret_cast<short*>(image->data(column, row)) =
                static_cast<short>(column < 32 ? 1000 + 10 * column : -9999);
    }
    osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    layer->setKind(DataLayer::VALUE);
    layer->setNoData(-9999);
    osg::ref_ptr<ProjectiveMapping> shown = content(layer);
    shown->setTable(ColorTable::named("greys", 1000.0, 1400.0));
    shown->getTransfer()->setSource(ColorTransfer::TABLE);
    shown->getTransfer()->setValueRange(1000.0, 1400.0);
    osg::ref_ptr<LensMapping> lens = new LensMapping(*mappings);
    lens->setContent(shown);
    lens->place({-200, 0}, 60.0, 60.0);
    EXPECT_EQ(lens->inside().getTable(), shown->getTable());
    EXPECT_EQ(lens->inside().getTransfer()->getSource(), ColorTransfer::TABLE);
    EXPECT_EQ(lens->inside().getTransfer()->getHighValue(), 1400.0);
    EXPECT_EQ(lens->inside().getTransfer()->getAlpha(), ColorTransfer::FROM_MASK);
    EXPECT_EQ(lens->inside().getLayer()->getKind(), DataLayer::VALUE);
    const auto valueAt = [&](unsigned int column)
    {
        return *reinterpret_cast<const float*>(lens->inside().getLayer()->getImage()->data(column, 128));
    };
    // Texels are 16 m, ten units each.
    EXPECT_NEAR(static_cast<double>(valueAt(128)), 1000.0 + 10.0 * (312.0 / 16.0 - 0.5), 0.5);
    lens->setCenter({0, 0});
    EXPECT_FALSE(std::isnan(valueAt(100)));
    EXPECT_TRUE(std::isnan(valueAt(160)));

    // A change of the content shows after refresh().
    shown->getTransfer()->setValueRange(900.0, 1500.0);
    lens->refresh();
    EXPECT_EQ(lens->inside().getTransfer()->getHighValue(), 1500.0);
}

TEST(Lens, sceneColorsNeedNoPicture)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    osg::ref_ptr<LensMapping> lens = new LensMapping(*mappings);
    osg::ref_ptr<ProjectiveMapping> grey = new ProjectiveMapping;
    grey->getTransfer()->setSource(ColorTransfer::SCENE);
    grey->getTransfer()->setSaturation(0.0);
    lens->setContent(grey);
    EXPECT_FALSE(lens->inside().getLayer());
    EXPECT_EQ(lens->inside().getTransfer()->getSaturation(), 0.0);
    EXPECT_EQ(lens->inside().getTransfer()->getAlpha(), ColorTransfer::FROM_MASK);
    ASSERT_TRUE(lens->inside().getMask());
    const osg::Image& mask = *lens->inside().getMask()->getImage();
    EXPECT_EQ(mask.data(256, 256)[3], 255);
    EXPECT_EQ(mask.data(60, 60)[3], 0);
    LensMapping::Style style;
    style.round = false;
    style.softness = 0.5;
    ASSERT_TRUE(lens->setStyle(style));
    const osg::Image& square = *lens->inside().getMask()->getImage();
    EXPECT_GT(square.data(60, 60)[3], 0);
    EXPECT_LT(square.data(60, 60)[3], 255);
    EXPECT_EQ(square.data(256, 256)[3], 255);
    style.rim = 2.0;
    EXPECT_TRUE(refused([&] { return static_cast<bool>(lens->setStyle(style)); }));
    EXPECT_TRUE(refused([&] { return static_cast<bool>(lens->setRadius(0.0)); }));
    EXPECT_TRUE(refused([&] { return static_cast<bool>(lens->setCenter({std::nan(""), 0.0})); }));
}

TEST_F(Pointer, leadsTheLens)
{
    osg::ref_ptr<LensMapping> lens = new LensMapping(*_mappings);
    lens->setRadius(100.0);
    osg::ref_ptr<LensFollowsPointer> handler =
        new LensFollowsPointer(*_scene, *_mappings, *lens, 90.0, 120.0);
    EXPECT_FALSE(send(*handler, Event::MOVE, 150.0f, 70.0f)) << "others may want it, too";
    EXPECT_NEAR(lens->getCenter().x(), 250.0, 0.5);
    EXPECT_NEAR(lens->getCenter().y(), 100.0, 0.5);
    EXPECT_FALSE(send(*handler, Event::SCROLL, 150.0f, 70.0f)) << "the wheel alone is the manipulator's";
    EXPECT_EQ(lens->getHalfWidth(), 100.0);
    EXPECT_TRUE(send(*handler, Event::SCROLL, 150.0f, 70.0f, Event::MODKEY_CTRL));
    EXPECT_NEAR(lens->getHalfWidth(), 115.0, 1e-9);
    EXPECT_TRUE(send(*handler, Event::SCROLL, 150.0f, 70.0f, Event::MODKEY_CTRL));
    EXPECT_NEAR(lens->getHalfHeight(), 120.0, 1e-9);
}

TEST_F(Pointer, lensFollowsANode)
{
    osg::ref_ptr<LensMapping> lens = new LensMapping(*_mappings);
    osg::ref_ptr<osg::MatrixTransform> outer = new osg::MatrixTransform(osg::Matrix::translate(100, 0, 0));
    osg::ref_ptr<osg::MatrixTransform> vehicle = new osg::MatrixTransform(osg::Matrix::translate(0, 50, 5));
    osg::ref_ptr<osg::Geode> box = new osg::Geode;
    box->addDrawable(osg::createTexturedQuadGeometry({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    vehicle->addChild(box);
    outer->addChild(vehicle);
    _scene->addChild(outer);
    vehicle->addUpdateCallback(new LensFollowsNode(*_scene, *_mappings, *lens));
    osgUtil::UpdateVisitor update;
    // What is above the scene does not count: the mappings' frame is that of its children.
    osg::ref_ptr<osg::MatrixTransform> root = new osg::MatrixTransform(osg::Matrix::translate(7000, 0, 0));
    root->addChild(_scene);
    root->accept(update);
    EXPECT_NEAR(lens->getCenter().x(), 100.0, 1e-3);
    EXPECT_NEAR(lens->getCenter().y(), 50.0, 1e-3);
    vehicle->setMatrix(osg::Matrix::translate(-30, 60, 5));
    root->accept(update);
    EXPECT_NEAR(lens->getCenter().x(), 70.0, 1e-3);
    EXPECT_NEAR(lens->getCenter().y(), 60.0, 1e-3);
}

TEST(MaskPainter, paintsSoftStrokesAndTakesThemBack)
{
    osg::ref_ptr<ProjectiveMapping> mapping = content(nullptr);
    osg::ref_ptr<MaskPainter> painter = new MaskPainter(*mapping, 256, 128);
    EXPECT_EQ(mapping->getTransfer()->getAlpha(), ColorTransfer::FROM_MASK);
    ASSERT_TRUE(mapping->getMask());
    EXPECT_FALSE(painter->canUndo());
    ASSERT_TRUE(painter->setBrush({50.0, 0.5, 1.0, false}));
    const unsigned int before = painter->image().getModifiedCount();
    painter->begin({-300, 0});
    painter->moveTo({300, 0});
    EXPECT_GT(painter->image().getModifiedCount(), before);
    painter->end();
    // Full to half of the radius, then less and less, nothing beyond; all along the way.
    for (const double x : {-300.0, -150.0, 0.0, 300.0})
    {
        EXPECT_EQ(painter->at({x, 20.0}), 1.0) << x;
        EXPECT_NEAR(painter->at({x, 38.0}), 0.5, 0.25) << x;
        EXPECT_EQ(painter->at({x, 60.0}), 0.0) << x;
    }
    EXPECT_EQ(painter->at({-340.0, 0.0}) > 0.0, true);
    EXPECT_EQ(painter->at({-356.0, 0.0}), 0.0);

    ASSERT_TRUE(painter->setBrush({50.0, 0.5, 0.5, true}));
    painter->begin({0, -200});
    painter->moveTo({0, 200});
    painter->moveTo({0, -200}); // over itself: no stronger
    painter->end();
    EXPECT_NEAR(painter->at({0, 0}), 0.5, 0.01);
    EXPECT_EQ(painter->at({200, 0}), 1.0);

    EXPECT_TRUE(painter->undo());
    EXPECT_EQ(painter->at({0, 0}), 1.0);
    EXPECT_TRUE(painter->undo());
    EXPECT_EQ(painter->at({0, 0}), 0.0);
    EXPECT_FALSE(painter->undo());

    // What the beginning of a stroke covers, its end does not take away.
    painter->setBrush({50.0, 0.5, 1.0, false});
    painter->begin({0, -200});
    painter->moveTo({0, 200});
    painter->moveTo({300, 200});
    EXPECT_EQ(painter->at({0, 160}), 1.0);
    painter->end();

    painter->fill(1.0);
    EXPECT_EQ(painter->at({500, 500}), 1.0);
    EXPECT_EQ(painter->at({600, 500}), 0.0) << "outside";
    painter->setHistory(0);
    EXPECT_FALSE(painter->undo());
    EXPECT_TRUE(refused([&] { return static_cast<bool>(painter->setBrush({-1.0, 0.5, 1.0, false})); }));
}

TEST(MaskPainter, knowsTurnedAndProjectiveMappings)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    const Vec2d corners[4] = {{0, 0}, {1000, 0}, {700, 600}, {300, 600}};
    ASSERT_TRUE(mapping->setQuad(corners));
    osg::ref_ptr<MaskPainter> painter = new MaskPainter(*mapping, 300, 300);
    painter->setBrush({60.0, 0.9, 1.0, false});
    painter->begin({500, 300});
    painter->end();
    for (double angle = 0.0; angle < 6.2; angle += 0.3)
    {
        const Vec2d way(std::cos(angle), std::sin(angle));
        EXPECT_EQ(painter->at(Vec2d(500, 300) + way * 48.0), 1.0) << angle;
        EXPECT_EQ(painter->at(Vec2d(500, 300) + way * 66.0), 0.0) << angle;
    }
}

TEST_F(Pointer, paintsMasks)
{
    osg::ref_ptr<ProjectiveMapping> mapping = content(nullptr);
    osg::ref_ptr<MaskPainter> painter = new MaskPainter(*mapping, 256, 256);
    painter->setBrush({40.0, 0.5, 1.0, false});
    osg::ref_ptr<MaskPaintHandler> handler = new MaskPaintHandler(*_scene, *_mappings, *painter);
    EXPECT_FALSE(send(*handler, Event::PUSH, 100.0f, 50.0f)) << "without Shift";
    EXPECT_TRUE(send(*handler, Event::PUSH, 100.0f, 50.0f, Event::MODKEY_SHIFT));
    EXPECT_TRUE(send(*handler, Event::DRAG, 140.0f, 50.0f, Event::MODKEY_SHIFT));
    EXPECT_TRUE(send(*handler, Event::RELEASE, 140.0f, 50.0f, Event::MODKEY_SHIFT));
    EXPECT_FALSE(send(*handler, Event::DRAG, 100.0f, 90.0f, Event::MODKEY_SHIFT));
    EXPECT_EQ(painter->at({0, 0}), 1.0);
    EXPECT_EQ(painter->at({100, 0}), 1.0);
    EXPECT_EQ(painter->at({0, 150}), 0.0);
    EXPECT_TRUE(send(*handler, Event::PUSH, 100.0f, 50.0f, Event::MODKEY_SHIFT | Event::MODKEY_CTRL));
    EXPECT_TRUE(send(*handler, Event::RELEASE, 100.0f, 50.0f));
    EXPECT_EQ(painter->at({0, 0}), 0.0);
    EXPECT_TRUE(send(*handler, Event::KEYDOWN, 0.0f, 0.0f, Event::MODKEY_CTRL));
    EXPECT_EQ(painter->at({0, 0}), 1.0);
    EXPECT_TRUE(send(*handler, Event::SCROLL, 0.0f, 0.0f, Event::MODKEY_SHIFT));
    EXPECT_NEAR(painter->getBrush().radius, 48.0, 1e-9);
}
