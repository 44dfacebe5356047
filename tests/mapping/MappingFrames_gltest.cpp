// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// When changes of mappings are seen: always in the next frame. MappingThreads_gltest has threads and views.
#include <tools/MappingStage.h>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

osg::ref_ptr<osg::Image> values(double scale)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(20, 30, 1, GL_LUMINANCE, GL_FLOAT);
    for (unsigned int i = 0; i < 600; ++i)
        reinterpret_cast<float*>(image->data())[i] = static_cast<float>(scale * i / 600.0);
    return image;
}

} // namespace

class MappingFrames : public MappingStage
{
protected:
    /// One of each: a picture, a picture with a mask, values with a table, a constant, the scene's own color.
    static std::vector<osg::ref_ptr<ProjectiveMapping>> makeSome()
    {
        std::vector<osg::ref_ptr<ProjectiveMapping>> all;
        all.push_back(makePicture({-40.0, 30.0}, 45.0, makeImage(40, 30, waves)));
        all.push_back(makePicture({40.0, 30.0}, 45.0, makeImage(64, 64, stripes)));
        all.back()->setMask(new DataLayer(makeImage(16, 16, waves)));
        all.back()->getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
        all.push_back(makePicture({-30.0, -30.0}, 50.0, values(1.0)));
        all.back()->getLayer()->setKind(DataLayer::VALUE);
        all.back()->setTable(ColorTable::named("viridis"));
        all.back()->getTransfer()->setSource(ColorTransfer::TABLE);
        all.push_back(makeSolid({20.0, -20.0}, 30.0, {0.8, 0.3, 0.1}));
        all.back()->setOpacity(0.7);
        all.push_back(makeSolid({0.0, 0.0}, 25.0, {0.0, 0.0, 0.0}));
        all.back()->getTransfer()->setSource(ColorTransfer::SCENE);
        all.back()->getTransfer()->setHue(1.5);
        return all;
    }
    osg::ref_ptr<EffectScene> sceneOf(ProjectiveMappings* mappings)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(mappings);
        scene->addChild(makeGround());
        return scene;
    }
    static osg::ref_ptr<ProjectiveMappings>
    mappingsOf(const std::vector<osg::ref_ptr<ProjectiveMapping>>& all)
    {
        osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        for (const auto& mapping : all)
            mappings->addMapping(mapping);
        return mappings;
    }
    osg::ref_ptr<osg::Image> drawAnew(const std::vector<osg::ref_ptr<ProjectiveMapping>>& all)
    {
        return render(sceneOf(mappingsOf(all)));
    }
};

TEST_F(MappingFrames, ChangesAreInTheNextFrame)
{
    lookDown({0.0, 0.0}, 1.2, 0.3);
    using All = std::vector<osg::ref_ptr<ProjectiveMapping>>;
    struct Edit
    {
        const char* name;
        std::function<void(All&, ProjectiveMappings&)> act;
    };
    const Edit edits[] = {
        {"move",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->setCenter({-20.0, 10.0});
         }},
        {"turn",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->setRectangle({0.0, -50.0}, 30.0, 10.0, 0.7);
         }},
        {"far away",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->setCenter({5000.0, 5000.0});
         }},
        {"back",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->setCenter({20.0, -20.0});
         }},
        {"transform",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->setTransform({0.7, 0.1, 0.0, -0.1, 0.8, 0.0, 0.1, 0.1, 1.0});
         }},
        {"order",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->setOrder(3);
         }},
        {"opacity",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setOpacity(0.5);
         }},
        {"no opacity",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setOpacity(0.0);
         }},
        {"opacity again",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setOpacity(1.0);
         }},
        {"soft edges",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->setSoftEdges(true);
         }},
        {"disabled",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->setEnabled(false);
         }},
        {"enabled",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->setEnabled(true);
         }},
        {"pixels of the image",
         [](All& all, ProjectiveMappings&)
         {
             osg::Image& image = *all[0]->getLayer()->getImage();
             for (unsigned int i = 0; i < 400; ++i)
                 image.data()[4 * i] = 255;
             image.dirty();
         }},
        {"image",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->getLayer()->setImage(makeImage(33, 57, stripes));
         }},
        {"no image",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->getLayer()->setImage(nullptr);
         }},
        {"image again",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->getLayer()->setImage(makeImage(100, 20, waves));
         }},
        {"layer",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setLayer(new DataLayer(makeImage(8, 8, waves)));
         }},
        {"shared layer",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setLayer(all[0]->getLayer());
         }},
        {"smoothness",
         [](All& all, ProjectiveMappings&)
         {
             all[0]->getLayer()->setSmooth(false);
         }},
        {"mask's image",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->getMask()->setImage(makeImage(10, 10, stripes));
         }},
        {"no mask",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setMask(nullptr);
         }},
        {"alpha",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->getTransfer()->setAlpha(ColorTransfer::FROM_RAMP);
         }},
        {"table's stops",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->getTable()->addStop(0.5, osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
         }},
        {"table's mode",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->getTable()->setMode(ColorTable::NEAREST);
         }},
        {"table",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->setTable(ColorTable::named("terrain"));
         }},
        {"value range",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->getTransfer()->setValueRange(0.2, 0.6);
         }},
        {"layer's kind",
         [](All& all, ProjectiveMappings&)
         {
             all[2]->getLayer()->setKind(DataLayer::CLASS);
         }},
        {"constant",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->getTransfer()->setConstant({0.1, 0.9, 0.4, 1.0});
         }},
        {"equation",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->getTransfer()->setEquation(ColorTransfer::SCREEN);
         }},
        {"transfer",
         [](All& all, ProjectiveMappings&)
         {
             all[3]->setTransfer(all[4]->getTransfer());
         }},
        {"shared transfer",
         [](All& all, ProjectiveMappings&)
         {
             all[4]->getTransfer()->setBrightness(2.5);
         }},
        {"camera",
         [](All& all, ProjectiveMappings&)
         {
             ProjectiveMapping::Camera camera;
             camera.eye.set(0.0, 0.0, 60.0);
             camera.pitch = -1.3;
             all[1]->setCamera(camera);
         }},
        {"plane again",
         [](All& all, ProjectiveMappings&)
         {
             all[1]->setProjector(ProjectiveMapping::PLANE);
         }},
        {"removed",
         [](All& all, ProjectiveMappings& mappings)
         {
             mappings.removeMapping(all[3]);
             all.erase(all.begin() + 3);
         }},
        {"added",
         [](All& all, ProjectiveMappings& mappings)
         {
             all.push_back(makeSolid({10.0, 50.0}, 20.0, {0.2, 1.0, 0.2}));
             mappings.addMapping(all.back());
         }},
        {"all removed",
         [](All& all, ProjectiveMappings& mappings)
         {
             mappings.removeMappings();
             all.clear();
         }},
        {"some again",
         [](All& all, ProjectiveMappings& mappings)
         {
             all = makeSome();
             for (const auto& mapping : all)
                 mappings.addMapping(mapping);
         }},
    };
    for (const bool wholeList : {false, true})
    {
        All all = makeSome();
        const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(all);
        mappings->setWholeList(wholeList);
        const osg::ref_ptr<EffectScene> scene = sceneOf(mappings);
        osg::ref_ptr<osg::Image> former = render(scene);
        EXPECT_TRUE(same(*former, *drawAnew(all))) << "in the first frame";
        for (const Edit& edit : edits)
        {
            SCOPED_TRACE(edit.name);
            edit.act(all, *mappings);
            const osg::ref_ptr<osg::Image> image = render(scene);
            EXPECT_GT(differing(*image, *former), 20) << "it should show";
            EXPECT_EQ(differing(*image, *drawAnew(all)), 0);
            former = image;
        }
        // The effect itself.
        mappings->setEnabled(false);
        EXPECT_TRUE(same(*render(scene), *drawAnew({})));
        mappings->setEnabled(true);
        EXPECT_TRUE(same(*render(scene), *former));
        scene->removeEffect(mappings);
        EXPECT_TRUE(same(*render(scene), *drawAnew({})));
    }
}

TEST_F(MappingFrames, OneAfterTheOtherAndNothingInBetween)
{
    lookDown({0.0, 0.0}, 1.0);
    const osg::ref_ptr<ProjectiveMapping> solid = makeSolid({-30.0, 0.0}, 20.0, colorOf(0));
    const osg::ref_ptr<ProjectiveMapping> picture = makePicture({30.0, 0.0}, 20.0, makeImage(4, colorOf(0)));
    _mappings->addMapping(solid);
    _mappings->addMapping(picture);
    for (int i = 0; i < 20; ++i)
    {
        solid->getTransfer()->setConstant(osg::Vec4d(colorOf(i), 1.0));
        picture->getLayer()->setImage(makeImage(4, colorOf(i + 100)));
        const osg::ref_ptr<osg::Image> image = draw();
        EXPECT_TRUE(alike(at(*image, pixelOf(osg::Vec2d(-30.0, 0.0))), colorOf(i))) << i;
        EXPECT_TRUE(alike(at(*image, pixelOf(osg::Vec2d(30.0, 0.0))), colorOf(i + 100))) << i;
    }
}

TEST_F(MappingFrames, UnitsAndPagesAndGlObjects)
{
    lookDown({0.0, 0.0}, 1.2);
    const auto all = makeSome();
    const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(all);
    const osg::ref_ptr<EffectScene> scene = sceneOf(mappings);
    const osg::ref_ptr<osg::Image> expected = render(scene);
    EXPECT_GT(differing(*expected, *drawAnew({})), _width * _height / 5);
    EXPECT_TRUE(mappings->setUnits(14, 4, 5));
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(mappings->setUnits(5, 14, 4));
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(mappings->setPageSide(64));
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(mappings->setMaxPages(5));
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(mappings->setMaxDataSize(8.0));
    EXPECT_TRUE(same(*render(scene), *expected));
    for (osg::State* state : {static_cast<osg::State*>(nullptr), context().getState()})
    {
        scene->releaseGLObjects(state);
        EXPECT_TRUE(same(*render(scene), *expected));
        EXPECT_TRUE(same(*render(scene), *expected));
    }
    // As it is when a window is closed and another one opened.
    viewer().setSceneData(new osg::Group);
    EXPECT_TRUE(same(*render(scene), *expected));
    all[0]->setCenter({0.0, 0.0});
    EXPECT_TRUE(same(*render(scene), *drawAnew(all)));
}

TEST_F(MappingFrames, TwoSetsInOneScene)
{
    lookDown({0.0, 0.0}, 1.2);
    const auto all = makeSome();
    const osg::ref_ptr<osg::Image> expected = drawAnew(all);
    const osg::ref_ptr<ProjectiveMappings> below = mappingsOf({all[0], all[1], all[2]});
    const osg::ref_ptr<ProjectiveMappings> above = mappingsOf({all[3], all[4]});
    above->setUnits(11, 12, 13);
    const osg::ref_ptr<EffectScene> scene = sceneOf(below);
    scene->addEffect(above);
    EXPECT_TRUE(same(*render(scene), *expected));
    // Each takes the other's units.
    below->setUnits(11, 12, 13);
    above->setUnits(8, 9, 10);
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(same(*render(scene), *expected));
    above->setUnits(11, 12, 13);
    below->setUnits(8, 9, 10);
    EXPECT_TRUE(same(*render(scene), *expected));
    above->setEnabled(false);
    EXPECT_TRUE(same(*render(scene), *drawAnew({all[0], all[1], all[2]})));
    above->setEnabled(true);
    below->setEnabled(false);
    EXPECT_TRUE(same(*render(scene), *drawAnew({all[3], all[4]})));
    // One set in two scenes.
    const osg::ref_ptr<EffectScene> other = sceneOf(above);
    EXPECT_TRUE(same(*render(other), *drawAnew({all[3], all[4]})));
    below->setEnabled(true);
    EXPECT_TRUE(same(*render(scene), *expected));
}
