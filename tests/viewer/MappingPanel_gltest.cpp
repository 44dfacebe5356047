// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The list of mappings as it is drawn, with keys put into the queue of an off-screen viewer.
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/MappingPanel.h>
#include <tools/GlFixture.h>

#include <osg/Geometry>

#include <algorithm>

using namespace osgGeoFX;
using Event = osgGA::GUIEventAdapter;

namespace
{

constexpr int WIDTH = 640;
constexpr int HEIGHT = 480;

/// White ground that fills the picture.
class MappingPanelDrawn : public geofx::test::GlFixture
{
protected:
    MappingPanelDrawn() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->addChild(osg::createTexturedQuadGeometry({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}));
        _scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        _scene->addEffect(_mappings);
        for (int i = 0; i < 100; ++i)
        {
            osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
            mapping->setName("flood depths " + std::to_string(i));
            mapping->setRectangle({i * 5.0 - 250.0, -120.0}, 20.0, 20.0);
            mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
            mapping->getTransfer()->setConstant({1.0, 0.0, 0.0, 1.0});
            _mappings->addMapping(mapping);
        }
        viewer().getCamera()->setViewMatrixAsLookAt({0, 0, 500}, {0, 0, 0}, {0, 1, 0});
        viewer().getCamera()->setProjectionMatrixAsOrtho(-320, 320, -240, 240, 1, 1000);
        viewer().setSceneData(_scene);
        viewer().addEventHandler(_panel);
    }

    void press(int key)
    {
        viewer().getEventQueue()->keyPress(key);
        viewer().getEventQueue()->keyRelease(key);
    }

    /// osgText updates its vertices in a buffer that it has told OpenGL is static, and Mesa says so; nothing else may
    /// be said.
    void frame()
    {
        for (const std::string& message : watch().messagesOf([&] { viewer().frame(); }))
            EXPECT_NE(message.find("GL_STATIC_DRAW"), std::string::npos) << message;
    }

    /// What keys did and the picture after it, the list with it.
    osg::ref_ptr<osg::Image> draw()
    {
        frame();
        osg::ref_ptr<osg::Image> picture = new osg::Image;
        withContext([&](osg::State&) { picture->readPixels(0, 0, WIDTH, HEIGHT, GL_RGB, GL_UNSIGNED_BYTE); });
        return picture;
    }

    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
    osg::ref_ptr<MappingPanel> _panel = new MappingPanel(*_scene);
};

/// Pixels of a kind in the picture's right upper quarter, or in the rest of it.
template<typename Kind>
int count(const osg::Image& image, bool quarter, const Kind& kind)
{
    int found = 0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
        {
            const bool inside = x >= WIDTH / 2 && y >= HEIGHT / 2;
            if (inside == quarter && kind(image.getColor(static_cast<unsigned>(x), static_cast<unsigned>(y))))
                ++found;
        }
    }
    return found;
}

bool isDark(const osg::Vec4& c)
{
    return c.r() < 0.35f && c.g() < 0.35f && c.b() < 0.35f;
}
bool isMarked(const osg::Vec4& c)
{
    return c.b() > 0.5f && c.r() < 0.4f;
}
bool isBright(const osg::Vec4& c)
{
    return c.r() > 0.75f && c.g() > 0.75f;
}
bool isRed(const osg::Vec4& c)
{
    return c.r() > 0.9f && c.g() < 0.1f;
}

bool same(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::equal(a.data(), a.data() + a.getTotalSizeInBytes(), b.data());
}

} // namespace

TEST_F(MappingPanelDrawn, CoversItsCornerAloneAndShowsWhatKeysDo)
{
    const osg::ref_ptr<osg::Image> without = draw();
    EXPECT_EQ(count(*without, true, isDark), 0);
    const int red = count(*without, false, isRed);
    EXPECT_GT(red, 1000);

    press(Event::KEY_F9);
    const osg::ref_ptr<osg::Image> shown = draw();
    EXPECT_GT(count(*shown, true, isDark), 20000);
    EXPECT_GT(count(*shown, true, isMarked), 1000) << "the selected row";
    EXPECT_EQ(count(*shown, false, isRed), red);
    EXPECT_LT(count(*shown, false, isDark), 5000) << "some lines beyond the quarter";
    // Letters are bright on the dark ground; of the quarter, the list leaves some bright pixels at the edge, too.
    EXPECT_GT(count(*shown, true, isBright), 2000);
    EXPECT_LT(count(*shown, true, isBright), WIDTH * HEIGHT / 16);
    const osg::ref_ptr<osg::Image> again = draw();
    EXPECT_TRUE(same(*shown, *again)) << "nothing has changed";

    press(Event::KEY_Down);
    EXPECT_FALSE(same(*shown, *draw()));
    press(Event::KEY_Up);
    EXPECT_TRUE(same(*shown, *draw()));

    press(Event::KEY_End);
    press(Event::KEY_Return);
    EXPECT_LT(count(*draw(), false, isRed), red) << "the leftmost mapping is switched off";
    press(Event::KEY_Return);
    press(Event::KEY_F9);
    EXPECT_TRUE(same(*without, *draw()));
}

TEST_F(MappingPanelDrawn, ChangesWhileAnotherThreadDraws)
{
    viewer().setThreadingModel(osgViewer::ViewerBase::DrawThreadPerContext);
    press(Event::KEY_F9);
    const int keys[] = {Event::KEY_Down, Event::KEY_Left, '.', '+', Event::KEY_Page_Down, Event::KEY_Return};
    for (int i = 0; i < 120; ++i)
    {
        press(keys[i % 6]);
        if (i % 40 == 39) press(Event::KEY_F9);
        frame();
    }
    viewer().setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    // Shown, hidden, shown, hidden.
    EXPECT_EQ(count(*draw(), true, isDark), 0);
    press(Event::KEY_F9);
    EXPECT_GT(count(*draw(), true, isDark), 20000);
}
