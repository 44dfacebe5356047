// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What mappings hold while cameras, contexts, scenes and other sets of mappings come and go.
#include <bench/GlObjectCount.h>
#include <tools/MappingStage.h>
#include <tools/ThreadedViews.h>

#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>

using namespace geofx::test;
using geofx::bench::GlObjectCount;
using namespace osgGeoFX;

namespace
{

using MappingList = std::vector<osg::ref_ptr<ProjectiveMapping>>;

osg::ref_ptr<osg::Image> values(int side)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_LUMINANCE, GL_FLOAT);
    for (int i = 0; i < side * side; ++i)
        reinterpret_cast<float*>(image->data())[i] = static_cast<float>(100.0 * i / (side * side));
    return image;
}

osg::ref_ptr<ProjectiveMappings> mappingsOf(const MappingList& all)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    for (const auto& mapping : all)
        mappings->addMapping(mapping);
    return mappings;
}

} // namespace

class MappingLife : public MappingStage
{
protected:
    void SetUp() override
    {
        MappingStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        lookDown({0.0, 0.0}, 1.2);
    }

    /// Another context in the place of the one that was.
    void reopen()
    {
        const osg::Matrixd view = viewer().getCamera()->getViewMatrix();
        const osg::Matrixd projection = viewer().getCamera()->getProjectionMatrix();
        GlFixture::TearDown();
        GlFixture::SetUp();
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor({0, 0, 0, 1});
        camera.setViewMatrix(view);
        camera.setProjectionMatrix(projection);
        viewer().setLightingMode(osg::View::NO_LIGHT);
    }

    /// Pictures that let what is below show through, one over the other.
    static MappingList makeSome()
    {
        MappingList all;
        for (int i = 0; i < 6; ++i)
        {
            const osg::ref_ptr<osg::Image> image =
                makeImage(40 + i, 30, [i](double u, double v) { return waves(u + 0.3 * i, v - 0.2 * i); });
            all.push_back(makePicture({25.0 * i - 60.0, 15.0 * (i % 3) - 15.0}, 45.0, image));
            all.back()->setOpacity(0.8);
        }
        all[1]->setLayer(new DataLayer(values(24)));
        all[1]->getLayer()->setKind(DataLayer::VALUE);
        all[1]->setTable(ColorTable::named("viridis", 0.0, 100.0));
        all[1]->getTransfer()->setSource(ColorTransfer::TABLE);
        all[1]->getTransfer()->setValueRange(0.0, 100.0);
        all[4]->setMask(new DataLayer(makeImage(16, 16, waves)));
        all[4]->getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
        return all;
    }
    static osg::ref_ptr<EffectScene> sceneOf(const std::vector<osg::ref_ptr<ProjectiveMappings>>& sets)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        for (const auto& set : sets)
            scene->addEffect(set);
        scene->addChild(makeGround());
        return scene;
    }
    osg::ref_ptr<osg::Image> drawAnew(const MappingList& all) { return render(sceneOf({mappingsOf(all)})); }

    GlObjectCount count()
    {
        GlObjectCount result;
        withContext([&](osg::State& state) { result = GlObjectCount::of(state); });
        return result;
    }
};

TEST_F(MappingLife, SetsOfOneSceneAreBlendedInTheirOrder)
{
    const MappingList all = makeSome();
    const osg::ref_ptr<osg::Image> expected = drawAnew(all);
    const osg::ref_ptr<ProjectiveMappings> first = mappingsOf({all[0], all[1]});
    const osg::ref_ptr<ProjectiveMappings> second = mappingsOf({all[2], all[3]});
    const osg::ref_ptr<ProjectiveMappings> third = mappingsOf({all[4], all[5]});
    const osg::ref_ptr<EffectScene> scene = sceneOf({first, second, third});
    EXPECT_TRUE(same(*render(scene), *expected));
    // Each of them is needed for that.
    for (const auto& set : {first, second, third})
    {
        set->setEnabled(false);
        EXPECT_GT(differing(*render(scene), *expected), _width * _height / 20);
        set->setEnabled(true);
    }
    EXPECT_TRUE(same(*render(scene), *expected));
    // The first is on top when it comes back as the last.
    scene->removeEffect(first);
    EXPECT_TRUE(same(*render(scene), *drawAnew({all[2], all[3], all[4], all[5]})));
    scene->addEffect(first);
    EXPECT_TRUE(same(*render(scene), *drawAnew({all[2], all[3], all[4], all[5], all[0], all[1]})));
}

TEST_F(MappingLife, UnitsOfOnesChoiceStayAndOthersKeepOffThem)
{
    const MappingList all = makeSome();
    const osg::ref_ptr<osg::Image> expected = drawAnew(all);
    const osg::ref_ptr<ProjectiveMappings> below = mappingsOf({all[0], all[1], all[2]});
    const osg::ref_ptr<ProjectiveMappings> above = mappingsOf({all[3], all[4], all[5]});
    const osg::ref_ptr<EffectScene> scene = sceneOf({below, above});
    EXPECT_TRUE(same(*render(scene), *expected));
    // Those that the first set would have.
    EXPECT_TRUE(above->setUnits(10, 8, 9));
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_TRUE(below->setUnits(11, 12, 13));
    EXPECT_TRUE(same(*render(scene), *expected));
    // What both want the first one has, and the other one says so once.
    EXPECT_TRUE(above->setUnits(20, 12, 21));
    osg::ref_ptr<osg::Image> drawn;
    const std::vector<std::string> said = watch().messagesOf(
        [&]
        {
            render(scene);
            drawn = render(scene);
        });
    EXPECT_TRUE(same(*drawn, *expected));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("layerUnit"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("12"), std::string::npos) << said[0];
    EXPECT_TRUE(above->setUnits(-1, -1, -1));
    EXPECT_TRUE(same(*render(scene), *expected));
}

TEST_F(MappingLife, PagesChangeBelowListsOfCameras)
{
    const MappingList all = makeSome();
    const osg::ref_ptr<osg::Image> expected = drawAnew(all);
    const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(all);
    mappings->setWholeList(true);
    const osg::ref_ptr<EffectScene> scene = sceneOf({mappings});
    EXPECT_TRUE(same(*render(scene), *expected));
    const auto expectAsNew = [&](const char* what)
    {
        SCOPED_TRACE(what);
        EXPECT_TRUE(same(*render(scene), *expected));
        const osg::ref_ptr<ProjectiveMappings> fresh = osg::clone(mappings.get());
        EXPECT_TRUE(same(*render(sceneOf({fresh})), *expected));
        EXPECT_EQ(mappings->capacity().texelsUsed, fresh->capacity().texelsUsed);
    };
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_TRUE(mappings->setPageSide(64 << i));
        expectAsNew("pageSide");
        EXPECT_TRUE(mappings->setMaxPages(20 + i));
        expectAsNew("maxPages");
        EXPECT_TRUE(mappings->setMaxDataSize(8.0 - i));
        expectAsNew("maxDataSize");
    }
}

TEST_F(MappingLife, CamerasThatAreGoneTakeNothing)
{
    const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(makeSome());
    const osg::ref_ptr<EffectScene> scene = sceneOf({mappings});
    mappings->setWholeList(true);
    const osg::ref_ptr<osg::Image> expected = render(scene);
    const int texels = mappings->capacity().texelsUsed;
    const int textures = count().textures;
    for (int i = 0; i < 3; ++i)
    {
        ThreadedViews views(osgViewer::ViewerBase::SingleThreaded);
        views.add(scene, *viewer().getCamera());
        views.add(scene, *viewer().getCamera());
        views.realize();
        EXPECT_TRUE(same(*views.pictures().front(), *expected));
        EXPECT_GT(mappings->capacity().texelsUsed, texels);
    }
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_EQ(mappings->capacity().texelsUsed, texels);
    // Nor do they keep what the others have no use for any more.
    mappings->setPageSide(64);
    EXPECT_TRUE(same(*render(scene), *expected));
    EXPECT_EQ(count().textures, textures);
}

TEST_F(MappingLife, AnotherValueRangeUploadsNoLayer)
{
    constexpr int side = 256;
    const osg::ref_ptr<ProjectiveMapping> mapping = makePicture({0.0, 0.0}, 80.0, values(side));
    mapping->getLayer()->setKind(DataLayer::VALUE);
    mapping->setTable(ColorTable::named("viridis", 0.0, 100.0));
    mapping->getTransfer()->setSource(ColorTransfer::TABLE);
    mapping->getTransfer()->setValueRange(0.0, 100.0);
    mapping->setMask(new DataLayer(makeImage(64, 64, waves)));
    mapping->getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
    const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf({mapping});
    const osg::ref_ptr<EffectScene> scene = sceneOf({mappings});
    const osg::ref_ptr<osg::Image> before = render(scene);
    EXPECT_GE(mappings->capacity().uploadedBytes, 4u * side * side);
    const int pages = mappings->capacity().pagesUsed;
    for (int i = 1; i < 5; ++i)
    {
        const std::uint64_t uploaded = mappings->capacity().uploadedBytes;
        mapping->getTransfer()->setValueRange(5.0 * i, 100.0 - 5.0 * i);
        const osg::ref_ptr<osg::Image> after = render(scene);
        EXPECT_GT(differing(*after, *before), 100);
        // A row of a table, the record and the grid.
        EXPECT_LT(mappings->capacity().uploadedBytes - uploaded, 20000u);
        EXPECT_TRUE(same(*after, *drawAnew({mapping})));
    }
    // Another table, and one that is shared with the layer of another mapping.
    const std::uint64_t uploaded = mappings->capacity().uploadedBytes;
    mapping->setTable(ColorTable::named("magma", 0.0, 100.0));
    EXPECT_TRUE(same(*render(scene), *drawAnew({mapping})));
    EXPECT_LT(mappings->capacity().uploadedBytes - uploaded, 20000u);
    EXPECT_EQ(mappings->capacity().pagesUsed, pages);
}

TEST_F(MappingLife, AContextClosesAndOpensWhileTheSetIsElsewhere)
{
    const MappingList all = makeSome();
    const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(all);
    const osg::ref_ptr<EffectScene> scene = sceneOf({mappings});
    const osg::ref_ptr<osg::Image> expected = render(scene);
    for (int i = 0; i < 2; ++i)
    {
        scene->removeEffect(mappings);
        render(scene);
        reopen();
        // Takes the names that the former context had given to the set.
        const osg::ref_ptr<ProjectiveMappings> others = mappingsOf({all[0], all[1]});
        const osg::ref_ptr<EffectScene> other = sceneOf({others});
        const osg::ref_ptr<osg::Image> fewer = render(other);
        if (i == 1)
        {
            // What it had in the former context is no reason to delete what is in this one.
            mappings->releaseGLObjects(nullptr);
            withContext([](osg::State& state) { osg::flushAllDeletedGLObjects(state.getContextID()); });
            EXPECT_TRUE(same(*render(other), *fewer));
        }
        scene->addEffect(mappings);
        EXPECT_TRUE(same(*render(scene), *expected)) << i;
        EXPECT_TRUE(same(*render(other), *fewer)) << i;
    }
}

// ---------------------------------------------------------------------------------------------------------------------

/// One set in two scenes: on a plane, and on a globe so small that what stands on it is nearer or farther.
class MappingGlobes : public MappingLife
{
protected:
    void SetUp() override
    {
        MappingLife::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        MappingList all;
        for (int i = 0; i < 12; ++i)
        {
            all.push_back(
                makePicture({60.0 * (i % 4) - 90.0, 60.0 * (i / 4) - 60.0}, 40.0, makeImage(20, 20, waves)));
            all.back()->setSizeInPixels(14.0);
            all.back()->setTurned(true);
            all.back()->setPixels(1.0, 40.0);
        }
        _symbols = mappingsOf(all);
        look({150.0, -350.0, 300.0}, {0.0, 0.0, 0.0});
    }

    static osg::ref_ptr<osg::EllipsoidModel> makeEllipsoid() { return new osg::EllipsoidModel(400.0, 400.0); }
    /// The ground of the plane, or that of the globe, brought to where the plane is.
    osg::ref_ptr<osg::Group> stage(ProjectiveMappings* mappings, osg::EllipsoidModel* ellipsoid)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(mappings);
        const osg::ref_ptr<osg::Geometry> ground = makeGround(250.0, 40);
        if (!ellipsoid)
        {
            scene->addChild(ground);
            return scene;
        }
        const osg::Matrixd frame = mappings->frameToWorld(ellipsoid);
        for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*ground->getVertexArray()))
        {
            const osg::Vec3d place = vertex;
            vertex = mappings->positionOf(place, ellipsoid) * frame;
        }
        scene->addChild(ground);
        osg::ref_ptr<osg::CoordinateSystemNode> system = new osg::CoordinateSystemNode;
        system->setEllipsoidModel(ellipsoid);
        system->addChild(scene);
        osg::ref_ptr<osg::MatrixTransform> back = new osg::MatrixTransform(osg::Matrixd::inverse(frame));
        back->addChild(system);
        return back;
    }

    osg::ref_ptr<ProjectiveMappings> _symbols;
};

TEST_F(MappingGlobes, OneSetInTwoScenesIsUploadedOnce)
{
    const osg::ref_ptr<osg::Image> flat = render(stage(osg::clone(_symbols.get()), nullptr));
    const osg::ref_ptr<osg::Image> round = render(stage(osg::clone(_symbols.get()), makeEllipsoid()));
    EXPECT_GT(differing(*flat, *round), 300);
    // The ellipsoids are objects of their own and say the same.
    const osg::ref_ptr<osg::Group> scenes[3] = {stage(_symbols, nullptr), stage(_symbols, makeEllipsoid()),
                                                stage(_symbols, makeEllipsoid())};
    std::uint64_t uploaded = 0;
    for (int i = 0; i < 4; ++i)
    {
        EXPECT_TRUE(same(*render(scenes[0]), *flat)) << i;
        EXPECT_TRUE(same(*render(scenes[1]), *round)) << i;
        EXPECT_TRUE(same(*render(scenes[2]), *round)) << i;
        if (i > 0)
        {
            EXPECT_EQ(_symbols->capacity().uploadedBytes, uploaded) << i;
        }
        uploaded = _symbols->capacity().uploadedBytes;
    }
    EXPECT_GT(uploaded, 0u);
}

TEST_F(MappingGlobes, ScenesWithTwoEllipsoidsMayBeCulledAtOnce)
{
    const osg::ref_ptr<osg::Image> flat = render(stage(osg::clone(_symbols.get()), nullptr));
    const osg::ref_ptr<osg::Image> round = render(stage(osg::clone(_symbols.get()), makeEllipsoid()));
    const osg::ref_ptr<osg::Group> scenes[2] = {stage(_symbols, nullptr), stage(_symbols, makeEllipsoid())};
    for (const auto model : ThreadedViews::models)
    {
        SCOPED_TRACE(model);
        for (const bool wholeList : {false, true})
        {
            _symbols->setWholeList(wholeList);
            ThreadedViews views(model);
            for (const auto& scene : scenes)
                views.add(scene, *viewer().getCamera());
            views.realize();
            for (int i = 0; i < 3; ++i)
            {
                const auto pictures = views.pictures();
                ASSERT_TRUE(pictures[0] && pictures[1]);
                EXPECT_TRUE(same(*pictures[0], *flat));
                EXPECT_TRUE(same(*pictures[1], *round));
            }
        }
    }
}
