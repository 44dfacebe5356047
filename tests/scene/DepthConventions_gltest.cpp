// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Reversed and logarithmic depths: each kind gives the picture that standard depths give, beside boxes of the application's, which
// write the same kind of depth, hide and are hidden.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/BentGround.h>
#include <tools/CloseUpStage.h>
#include <tools/CullHarness.h>
#include <tools/DepthKinds.h>
#include <tools/FrameBufferTarget.h>
#include <tools/ImageComparison.h>
#include <tools/PanoramaHills.h>
#include <tools/SampledCases.h>

#include <osg/MatrixTransform>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// The sides of a cube of 2 m, each in a color of its own, in small squares: a logarithmic depth of vertices is right there only.
osg::ref_ptr<osg::Geometry> makeCube()
{
    constexpr int cells = 8;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    const osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int side = 0; side < 6; ++side)
    {
        const int axis = side / 2;
        const auto first = static_cast<int>(vertices->size());
        for (int i = 0; i < (cells + 1) * (cells + 1); ++i)
        {
            const int column = i % (cells + 1), row = i / (cells + 1);
            osg::Vec3 place;
            place[axis] = side % 2 ? 1.0f : -1.0f;
            place[(axis + 1) % 3] = 2.0f * static_cast<float>(column) / cells - 1.0f;
            place[(axis + 2) % 3] = 2.0f * static_cast<float>(row) / cells - 1.0f;
            vertices->push_back(place);
            colors->push_back({0.3f + 0.1f * static_cast<float>(side), side % 2 ? 0.9f : 0.1f, 0.8f, 1.0f});
            if (column == cells || row == cells) continue;
            for (const int corner : {0, 1, cells + 1, 1, cells + 2, cells + 1})
                triangles->push_back(static_cast<GLushort>(first + i + corner));
        }
    }
    osg::ref_ptr<osg::Geometry> cube = new osg::Geometry;
    cube->setUseDisplayList(false);
    cube->setUseVertexBufferObjects(true);
    cube->setVertexArray(vertices);
    cube->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    cube->addPrimitiveSet(triangles);
    return cube;
}

/// Boxes of the application's, beside the scene.
class HostBoxes
{
public:
    explicit HostBoxes(osg::Group& root)
    {
        root.addChild(_boxes);
        _boxes->getOrCreateStateSet()->setMode(GL_LIGHTING,
                                               osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    }
    /// The place is the middle of the box, and half of its size.
    void add(const osg::Vec3d& place, const osg::Vec3d& half)
    {
        const osg::ref_ptr<osg::MatrixTransform> transform =
            new osg::MatrixTransform(osg::Matrixd::scale(half) * osg::Matrixd::translate(place));
        transform->addChild(makeCube());
        _boxes->addChild(transform);
    }
    void use(const DepthKind& kind)
    {
        if (const osg::ref_ptr<osg::Program> program = kind.hostProgram())
            _boxes->getOrCreateStateSet()->setAttribute(program);
    }
    void show(bool on) { _boxes->setNodeMask(on ? ~0u : 0u); }

private:
    osg::ref_ptr<osg::Group> _boxes = new osg::Group;
};

/// How many pixels differ clearly.
int apart(const osg::Image& a, const osg::Image& b)
{
    int count = 0;
    for (int i = 0; i < a.s() * a.t(); ++i)
    {
        int most = 0;
        for (int channel = 0; channel < 3; ++channel)
            most = std::max(most, std::abs(a.data()[4 * i + channel] - b.data()[4 * i + channel]));
        count += most > 4 ? 1 : 0;
    }
    return count;
}

std::string nameOf(const ::testing::TestParamInfo<DepthKind>& info)
{
    return info.param.name;
}

class BentDepths : public BentGround, public ::testing::WithParamInterface<DepthKind>
{
protected:
    void SetUp() override
    {
        BentGround::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->addChild(makeGround());
        _root->addChild(_scene);
    }
    /// Half in the ground as it is drawn.
    void sinkBoxes()
    {
        const DeformedView view(*_scene, *viewer().getCamera());
        for (const osg::Vec3d& place :
             {osg::Vec3d(-20, -70, 0), osg::Vec3d(15, -40, 0), osg::Vec3d(-10, 20, 0), osg::Vec3d(30, 60, 0),
              osg::Vec3d(-40, 110, 0)})
            _boxes.add(view.deform(place), {6, 6, 9});
    }
    void expectTheStandardPicture()
    {
        const osg::ref_ptr<osg::Image> standard = render(_root);
        _boxes.show(false);
        const osg::ref_ptr<osg::Image> without = render(_root);
        _boxes.show(true);
        _scene->setNodeMask(0);
        const osg::ref_ptr<osg::Image> alone = render(_root);
        _scene->setNodeMask(~0u);
        // They hide, and are hidden.
        EXPECT_GT(apart(*standard, *without), 150);
        EXPECT_LT(apart(*standard, *without), covered(*alone) - 150);

        GetParam().setUp(*viewer().getCamera(), *_scene);
        _boxes.use(GetParam());
        // Where a box and the ground meet, the roundings of depths decide.
        EXPECT_LE(apart(*render(_root), *standard), 3);
    }

    osg::ref_ptr<osg::Group> _root = new osg::Group;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    HostBoxes _boxes{*_root};
};

class CloseUpDepths : public CloseUpStage, public ::testing::WithParamInterface<DepthKind>
{
protected:
    CloseUpDepths() : CloseUpStage(300, 225) {}
};

class PanoramaDepths : public GlFixture, public ::testing::WithParamInterface<DepthKind>
{
protected:
    PanoramaDepths() : GlFixture(240, 150) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        viewer().setLightingMode(osg::View::NO_LIGHT);
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setProjectionMatrixAsPerspective(30.0, 240.0 / 150.0, 1000.0, 1e6);
        _map->setRipples(0.0); // each frame has another time
        _scene->addEffect(_map);
        _scene->addChild(_hills.terrain());
        _root->addChild(_scene);
        // In the order of the graph; that of addresses differs from run to run.
        _root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
        const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*_scene, *_map);
        hand->setCameraProjection(camera.getProjectionMatrix());
        hand->setWidth(40000.0);
        EXPECT_TRUE(hand->setCenter(_hills.middle()));
        hand->updateCamera(camera);
    }
    /// The second frame: what pictures in the water show is settled by then.
    osg::ref_ptr<osg::Image> draw()
    {
        render(_root);
        return render(_root);
    }

    /// Metres from the middle of the hills.
    static osg::Vec3d groundAt(double east, double north)
    {
        const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
        constexpr double radius = 6378137.0;
        osg::Vec3d place;
        globe->convertLatLongHeightToXYZ(0.8 + north / radius, 0.4 + east / (radius * std::cos(0.8)), 300.0,
                                         place.x(), place.y(), place.z());
        return place;
    }

    PanoramaHills _hills{0.8};
    osg::ref_ptr<osg::Group> _root = new osg::Group;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
    HostBoxes _boxes{*_root};
};

} // namespace

TEST_P(BentDepths, OfABendAreTheStandardPictures)
{
    _scene->addEffect(makeBend());
    sinkBoxes();
    expectTheStandardPicture();
}

// Geometry without a shader has the application's depths with and without effects.
TEST_P(BentDepths, WithoutEffectsAreTheStandardPictures)
{
    sinkBoxes();
    expectTheStandardPicture();
}

// What is nearer than the near plane is left out where OpenGL would cut it away, and what is behind the far plane where it certainly is.
TEST_P(BentDepths, NearAndFarPlanesCullWhatOpenGlCuts)
{
    _scene->removeChildren(0, _scene->getNumChildren());
    _scene->addEffect(new VerticalExaggeration); // moves nothing; the kit culls
    // At 2, 100 and 900 m from the eye, and 60 m behind it; the planes are at 5 and 500 m.
    const osg::Matrixd toWorld = osg::Matrixd::inverse(viewer().getCamera()->getViewMatrix());
    std::vector<osg::ref_ptr<osg::Geometry>> boxes;
    for (const double away : {2.0, 100.0, 900.0, -60.0})
    {
        const osg::ref_ptr<osg::MatrixTransform> transform =
            new osg::MatrixTransform(osg::Matrixd::scale(osg::Vec3d(0.1, 0.1, 0.1) * std::abs(away)) *
                                     osg::Matrixd::translate(osg::Vec3d(0.0, 0.0, -away) * toWorld));
        boxes.push_back(makeCube());
        transform->addChild(boxes.back());
        _scene->addChild(transform);
    }
    CullHarness harness(context(), _scene, WIDTH, HEIGHT);
    osg::Camera& camera = harness.camera();
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    harness.setCamera(viewer().getCamera()->getViewMatrix(),
                      osg::Matrixd::perspective(40, 4.0 / 3.0, 5, 500));
    GetParam().setUp(camera, *_scene);
    const bool byFragment = GetParam().convention == DepthConvention::LOGARITHMIC_BY_FRAGMENT;
    const bool cut = GetParam().convention != DepthConvention::LOGARITHMIC;
    for (const bool farPlane : {true, false})
    {
        SCOPED_TRACE(farPlane);
        const auto all = osg::CullSettings::ENABLE_ALL_CULLING;
        camera.setCullingMode(farPlane ? all : all & ~osg::CullSettings::FAR_PLANE_CULLING);
        const std::set<const osg::Drawable*> drawn = harness.frame(true, false).drawables();
        EXPECT_EQ(drawn.count(boxes[0]), cut ? 0u : 1u);
        EXPECT_EQ(drawn.count(boxes[1]), 1u);
        EXPECT_EQ(drawn.count(boxes[2]), byFragment && farPlane ? 0u : 1u);
        EXPECT_EQ(drawn.count(boxes[3]), 0u);
    }
}

TEST_P(BentDepths, PixelsFindTheGroundOfStandardDepths)
{
    _scene->addEffect(makeBend());
    osg::Camera& camera = *viewer().getCamera();
    const DeformedView standard(*_scene, camera);
    const auto hits = [&](const DeformedView& view)
    {
        std::vector<osg::Vec3d> places;
        for (const double x : {20.0, 80.0, 140.0})
        {
            for (const double y : {10.0, 40.0, 70.0, 85.0})
            {
                const auto hit = view.pick(x, y);
                places.push_back(hit ? hit->world : osg::Vec3d());
            }
        }
        return places;
    };
    const std::vector<osg::Vec3d> expected = hits(standard);
    EXPECT_GT(expected.front().length(), 1.0);
    GetParam().setUp(camera, *_scene);
    const std::vector<osg::Vec3d> found = hits(DeformedView(*_scene, camera));
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((found[i] - expected[i]).length(), 1e-4) << i;
}

// A camera whose own depths are the projection's, in a scene of another kind.
TEST_P(BentDepths, ACameraMayHaveDepthsOfItsOwn)
{
    if (!GetParam().logarithmic()) return; // the projection tells
    _scene->addEffect(makeBend());
    sinkBoxes();
    const osg::ref_ptr<osg::Image> standard = render(_root);
    GetParam().setUp(*viewer().getCamera(), *_scene);
    EXPECT_GT(apart(*render(_root), *standard), 100) << "the boxes' depths are the projection's";
    CameraEffects& own = CameraEffects::of(*viewer().getCamera());
    EXPECT_TRUE(own.setDepthConvention(DepthConvention()));
    EXPECT_EQ(apart(*render(_root), *standard), 0);
    own.clearDepthConvention();
    EXPECT_GT(apart(*render(_root), *standard), 100);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BentDepths, ::testing::ValuesIn(sampledCases(DepthKind::all(), 2)), nameOf);

TEST_P(CloseUpDepths, OfLayersAndFencesAreTheStandardPictures)
{
    // Two that cross, with soft edges; one has a wall, the other one stretched ground, both a line.
    const osg::ref_ptr<CloseUp> walled = makeCloseUp({-150.0, -200.0}, 500.0, 350.0);
    walled->getAnchor()->setKind(Anchor::CONTOUR);
    walled->getAnchor()->setLineWidth(2.0);
    const osg::ref_ptr<CloseUp> stretched = makeCloseUp({150.0, 100.0}, 500.0, 250.0);
    stretched->getAnchor()->setKind(Anchor::STRETCHED);
    stretched->getAnchor()->setLineWidth(2.0);
    stretched->getRegion()->setShape(RegionOfInterest::ELLIPSE);
    for (const osg::ref_ptr<CloseUp>& each : {walled, stretched})
        _closeUps->addCloseUp(each);
    HostBoxes boxes(*_root);
    // In the ground, through the wall, and through a close-up.
    for (const osg::Vec3d& place : {osg::Vec3d(-600.0, -300.0, -20.0), osg::Vec3d(-150.0, -450.0, 150.0),
                                    osg::Vec3d(100.0, -100.0, 320.0), osg::Vec3d(500.0, 500.0, 0.0)})
        boxes.add(place, {90.0, 90.0, 90.0});
    const auto both = drawBoth();
    boxes.show(false);
    const auto without = drawBoth();
    boxes.show(true);
    EXPECT_GT(apart(*both.first, *without.first), 500);
    GetParam().setUp(*viewer().getCamera(), *_scene);
    boxes.use(GetParam());
    const auto drawn = drawBoth();
    EXPECT_LE(apart(*drawn.first, *both.first), 10);
    EXPECT_LE(apart(*drawn.second, *both.second), 10);
}

// Anchors and soft edges wait for those that are nearer.
TEST_P(CloseUpDepths, OfSoftEdgesThatCrossAreTheStandardPictures)
{
    const osg::ref_ptr<CloseUp> walled = makeCloseUp({0.0, 0.0}, 160.0, 200.0);
    walled->getRegion()->setShape(RegionOfInterest::RECTANGLE);
    walled->getAnchor()->setStyle(Anchor::SOLID);
    walled->getAnchor()->setOpacity(0.6);
    const osg::ref_ptr<CloseUp> soft = makeCloseUp({0.0, 0.0}, 200.0, 100.0);
    soft->setColor({1.0, 0.0, 1.0});
    soft->getRegion()->setSoftness(1.0);
    soft->setTilt(osg::PI_2);
    soft->setBrightness(0.5);
    soft->getAnchor()->setOpacity(0.5);
    walled->getRegion()->setSoftness(0.6);
    for (const osg::ref_ptr<CloseUp>& each : {walled, soft})
    {
        each->getAnchor()->setLineWidth(0.0);
        _closeUps->addCloseUp(each);
    }
    osg::Camera& camera = *viewer().getCamera();
    look({0.0, -2000.0, 350.0}, {0.0, 0.0, 100.0}, 10.0);
    const auto drawAll = [&]
    {
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (const double away : {300.0, 60.0, 0.0, -60.0, -300.0})
        {
            for (const Anchor::Kind kind : {Anchor::NONE, Anchor::CONTOUR})
            {
                soft->setOffset({0.0, away, away > 0.0 ? 160.0 : 60.0});
                soft->getAnchor()->setKind(kind);
                _closeUps->setPipeline(CloseUps::MULTI_PASS);
                images.push_back(draw());
            }
        }
        return images;
    };
    const std::vector<osg::ref_ptr<osg::Image>> standard = drawAll();
    GetParam().setUp(camera, *_scene);
    const std::vector<osg::ref_ptr<osg::Image>> drawn = drawAll();
    // Between the ground's vertices, 50 m apart, a logarithmic depth of vertices is off.
    const int most = GetParam().convention == DepthConvention::LOGARITHMIC ? 20 : 10;
    for (std::size_t i = 0; i < standard.size(); ++i)
        EXPECT_LE(apart(*drawn[i], *standard[i]), most) << i;
}

namespace
{

class LayerDepths : public CloseUpStage
{
};

} // namespace

// With a near plane of a millimetre, where only floating-point depths that are reversed tell one thing from another.
TEST_F(LayerDepths, ReversedDepthsAreAsPreciseInLayersAsInTheFrameBuffer)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 500.0, 300.0);
    closeUp->getAnchor()->setKind(Anchor::CONTOUR);
    _closeUps->addCloseUp(closeUp);
    HostBoxes boxes(*_root);
    for (const osg::Vec3d& place : {osg::Vec3d(-200.0, -100.0, 320.0), osg::Vec3d(0.0, -250.0, 150.0)})
        boxes.add(place, {70.0, 70.0, 70.0});
    osg::Camera& camera = *viewer().getCamera();
    const FrameBufferTarget target(camera, GL_RGBA8, GL_DEPTH_COMPONENT32F);
    const auto drawn = [&]
    {
        draw();
        draw();
        return osg::ref_ptr<osg::Image>(osg::clone(target.image.get(), osg::CopyOp::DEEP_COPY_ALL));
    };
    const osg::ref_ptr<osg::Image> standard = drawn();
    camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(_width) / _height, 0.001, 1e4);
    DepthKind{"", DepthKind::REVERSED_INFINITE, true}.setUp(camera, *_scene);
    const osg::ref_ptr<osg::Image> reversed = drawn();
    int count = 0;
    for (int y = 0; y < _height; ++y)
    {
        for (int x = 0; x < _width; ++x)
            count += (reversed->getColor(x, y) - standard->getColor(x, y)).length() > 0.02f ? 1 : 0;
    }
    EXPECT_LE(count, 5);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CloseUpDepths, ::testing::ValuesIn(sampledCases(DepthKind::all(), 2, 1)),
                         nameOf);

TEST_P(PanoramaDepths, OfAMapWithStrokesAreTheStandardPictures)
{
    const DeformedView view(*_scene, *viewer().getCamera());
    // Where the map shows the ground; the boxes themselves stay out of its projection.
    for (const double east : {-9000.0, -2000.0, 5000.0, 11000.0})
    {
        for (const double north : {-4000.0, 9000.0, 24000.0})
        {
            const osg::Vec3d place = view.deform(groundAt(east, north));
            const double away = (place * view.modelView()).length();
            _boxes.add(place, osg::Vec3d(0.012, 0.012, 0.012) * away);
        }
    }
    const osg::ref_ptr<osg::Image> standard = draw();
    _map->setStrokes(false);
    const osg::ref_ptr<osg::Image> plain = draw();
    _map->setStrokes(true);
    _boxes.show(false);
    const osg::ref_ptr<osg::Image> without = draw();
    _boxes.show(true);
    EXPECT_GT(apart(*standard, *plain), 500) << "strokes";
    EXPECT_GT(apart(*standard, *without), 200) << "boxes";
    GetParam().setUp(*viewer().getCamera(), *_scene);
    _boxes.use(GetParam());
    EXPECT_LE(apart(*draw(), *standard), 10);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PanoramaDepths, ::testing::ValuesIn(sampledCases(DepthKind::all(), 2)),
                         nameOf);
