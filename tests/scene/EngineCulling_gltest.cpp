// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Terrain engines that cull for themselves, below a scene with effects: with EffectScene::OPEN nothing that the deformed
// picture shows is missing, to the last bit.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/CloseUpStage.h>
#include <tools/FakeEngine.h>
#include <tools/GlRequired.h>

#include <osgViewer/Renderer>

#include <iostream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class EngineCulling : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->removeEffect(_closeUps);
        std::vector<FakeEngine::Tile> tiles;
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x)
                tiles.push_back({cut(x, y, 8), cut(x, y, 4)});
        _engine = new FakeEngine(tiles, 1200.0);
        _scene->addChild(_engine);
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    }

    /// A part of the ground, in so many parts along a side.
    static osg::ref_ptr<osg::Geometry> cut(int column, int row, int parts)
    {
        const osg::ref_ptr<osg::Geometry> part = makeHills(1000.0 / cells, parts);
        auto& vertices = dynamic_cast<osg::Vec3Array&>(*part->getVertexArray());
        for (osg::Vec3& vertex : vertices)
        {
            const double x = static_cast<double>(vertex.x()) + 1000.0 * (2.0 * column + 1.0 - cells) / cells;
            const double y = static_cast<double>(vertex.y()) + 1000.0 * (2.0 * row + 1.0 - cells) / cells;
            vertex = osg::Vec3(osg::Vec3d(x, y, groundHeight(x, y)));
        }
        return part;
    }
    /// One color all over the ground.
    static osg::ref_ptr<ProjectiveMapping> makePaint()
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setRectangle(osg::Vec2d(0.0, 0.0), 500.0, 300.0, 0.3);
        mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
        mapping->getTransfer()->setConstant(osg::Vec4d(0.9, 0.1, 0.1, 1.0));
        return mapping;
    }
    /// Where nothing is deformed, the engine is left to its own ways.
    bool isDeformed()
    {
        const osg::Camera& camera = *viewer().getCamera();
        return !_scene->deformation(camera.getViewMatrix(), camera.getProjectionMatrix())->empty();
    }
    /// With everything drawn that there is.
    osg::ref_ptr<osg::Image> drawAll()
    {
        _engine->culls = false;
        viewer().getCamera()->setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> image = draw();
        viewer().getCamera()->setCullingMode(osg::CullSettings::DEFAULT_CULLING);
        _engine->culls = true;
        return image;
    }

    static constexpr int cells = 10;
    osg::ref_ptr<FakeEngine> _engine;
};

/// A node of an engine beside its terrain, as osgEarth's draping has one.
class ViewPointReader : public osg::Group
{
public:
    void traverse(osg::NodeVisitor& visitor) override
    {
        if (osgUtil::CullVisitor* const cull = visitor.asCullVisitor()) viewPoint = cull->getViewPointLocal();
        osg::Group::traverse(visitor);
    }
    osg::Vec3d viewPoint;
};

} // namespace

TEST_F(EngineCulling, OpenLosesNothing)
{
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(6.0);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({-300.0, 200.0});
    _closeUps->addCloseUp(closeUp);
    const int count = fullTest() ? 200 : 12;
    int lost = 0, open = 0, straight = 0;
    for (const std::vector<Effect*>& effects :
         {std::vector<Effect*>{high}, std::vector<Effect*>{bend}, std::vector<Effect*>{pedestrian},
          std::vector<Effect*>{high, bend, _closeUps}})
    {
        for (Effect* each : effects)
            _scene->addEffect(each);
        Random random(7);
        for (int i = 0; i < count; ++i)
        {
            SCOPED_TRACE("camera " + std::to_string(i));
            lookAnyhow(random);
            if (!isDeformed()) continue;
            const osg::ref_ptr<osg::Image> expected = drawAll();
            _scene->setEngineCulling(EffectScene::AS_IT_IS);
            if (!same(*draw(), *expected)) ++lost;
            straight += _engine->drawn;
            _scene->setEngineCulling(EffectScene::OPEN);
            EXPECT_TRUE(same(*draw(), *expected));
            open += _engine->drawn;
        }
        for (Effect* each : effects)
            _scene->removeEffect(each);
    }
    std::cout << "left to itself, the engine loses something in " << lost << " of " << 4 * count
              << " pictures; it draws " << straight << " tiles, open " << open << '\n';
    EXPECT_GT(lost, count / 2);
    // Without a deformation it culls as ever.
    _scene->setEngineCulling(EffectScene::OPEN);
    look({300.0, -1800.0, 1200.0}, {0.0, 900.0, 0.0}, 15.0);
    draw();
    EXPECT_LT(_engine->drawn, cells * cells);
}

// The ground of a close-up may lie beside the picture that shows it.
TEST_F(EngineCulling, CloseUpsAloneLoseNothing)
{
    for (const double x : {-500.0, 0.0, 500.0})
        _closeUps->addCloseUp(makeCloseUp({x, 200.0 - 0.4 * x}));
    _scene->addEffect(_closeUps);
    _engine->horizon = false; // right where nothing is deformed
    // Ground of known heights that nothing moves is seen nowhere but in the picture, and yet parts of it are drawn from beside it.
    EffectScene::GroundDescription ground;
    ground.minHeight = -90.0;
    ground.maxHeight = 90.0;
    Random random(9);
    const int count = fullTest() ? 200 : 20;
    int lost = 0, open = 0, proxy = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        lookAnyhow(random);
        ASSERT_TRUE(_scene->setGround(i % 2 ? ground : EffectScene::GroundDescription()));
        const osg::ref_ptr<osg::Image> expected = drawAll();
        _scene->setEngineCulling(EffectScene::AS_IT_IS);
        if (!same(*draw(), *expected)) ++lost;
        for (const EffectScene::EngineCulling culling : {EffectScene::OPEN, EffectScene::PROXY})
        {
            _scene->setEngineCulling(culling);
            EXPECT_TRUE(same(*draw(), *expected)) << culling;
            (culling == EffectScene::OPEN ? open : proxy) += _engine->drawn;
        }
    }
    EXPECT_GT(lost, count / 10);
    std::cout << "the engine draws " << open << " tiles open, " << proxy << " with a proxy\n";
    EXPECT_LT(proxy, 0.85 * open);
}

// Tiles of which the picture shows nothing stay coarse, and all others are as fine as they were.
TEST_F(EngineCulling, TilesThatAreOutOfSightAreToldFromOthers)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({-300.0, 200.0});
    _closeUps->addCloseUp(closeUp);
    _scene->setEngineCulling(EffectScene::OPEN);
    for (const std::vector<Effect*>& effects :
         {std::vector<Effect*>{bend}, std::vector<Effect*>{bend, _closeUps}})
    {
        for (Effect* each : effects)
            _scene->addEffect(each);
        Random random(8);
        int all = 0, told = 0, drawn = 0, kept = 0, needed = 0;
        for (int i = 0; i < 10; ++i)
        {
            SCOPED_TRACE("camera " + std::to_string(i));
            lookAnyhow(random);
            if (!isDeformed()) continue;
            _engine->asks = false;
            const osg::ref_ptr<osg::Image> expected = draw();
            all += _engine->fine;
            _engine->asks = true;
            EXPECT_TRUE(same(*draw(), *expected));
            told += _engine->fine;
            drawn += _engine->drawn;
            _engine->leavesOut = true;
            EXPECT_TRUE(same(*draw(), *expected));
            kept += _engine->drawn;
            needed += _engine->kept;
            _engine->leavesOut = false;
        }
        EXPECT_LT(told, all);
        EXPECT_GT(told, 0);
        EXPECT_LT(kept, drawn);
        EXPECT_GE(kept, needed);
        for (Effect* each : effects)
            _scene->removeEffect(each);
    }
    osg::ref_ptr<osgUtil::CullVisitor> plain = new osgUtil::CullVisitor;
    EXPECT_FALSE(isTileOutOfSight(*_engine, *plain));
    EXPECT_FALSE(
        isBoxOutOfSight(osg::BoundingBox(0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f), osg::Matrixd(), *plain));
}

// What the engine gets to cull by contains all that the picture shows, and not much more.
TEST_F(EngineCulling, AProxyLosesNothingAndKeepsLittleElse)
{
    EffectScene::GroundDescription ground;
    ground.minHeight = -90.0;
    ground.maxHeight = 90.0;
    ASSERT_TRUE(_scene->setGround(ground));
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(6.0);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    const osg::ref_ptr<BlendedView> blended = new BlendedView;
    const osg::ref_ptr<PanoramaMap> panorama = new PanoramaMap;
    panorama->setRipples(0.0);
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(makePaint());
    _closeUps->addCloseUp(makeCloseUp({-300.0, 200.0}));
    const int count = fullTest() ? 200 : 10;
    int all = 0, allNeeded = 0;
    for (const std::vector<Effect*>& effects :
         {std::vector<Effect*>{high}, std::vector<Effect*>{bend}, std::vector<Effect*>{pedestrian},
          std::vector<Effect*>{blended}, std::vector<Effect*>{panorama}, std::vector<Effect*>{bend, mappings},
          std::vector<Effect*>{high, bend, _closeUps}})
    {
        SCOPED_TRACE(effects.back()->className());
        for (Effect* each : effects)
            _scene->addEffect(each);
        Random random(11);
        int open = 0, proxy = 0, needed = 0;
        for (int i = 0; i < count; ++i)
        {
            SCOPED_TRACE("camera " + std::to_string(i));
            lookAnyhow(random);
            if (!isDeformed()) continue;
            const osg::ref_ptr<osg::Image> expected = drawAll();
            _scene->setEngineCulling(EffectScene::OPEN);
            EXPECT_TRUE(same(*draw(), *expected));
            open += _engine->drawn;
            needed += _engine->kept;
            _scene->setEngineCulling(EffectScene::PROXY);
            EXPECT_TRUE(same(*draw(), *expected));
            proxy += _engine->drawn;
        }
        std::cout << effects.back()->className() << ": the engine draws " << open << " tiles open, " << proxy
                  << " with a proxy; " << needed << " are needed, " << static_cast<double>(proxy) / needed
                  << '\n';
        EXPECT_LT(proxy, open);
        // `needed` counts what the passes of close-ups draw, too.
        if (effects.back() == _closeUps.get()) continue;
        all += proxy;
        allNeeded += needed;
        for (Effect* each : effects)
            _scene->removeEffect(each);
    }
    EXPECT_LT(all, 1.3 * allNeeded);
}

// Engines fit textures to the eye's surroundings. From a raised eye these would be a continent.
TEST_F(EngineCulling, AllButTheStatedTerrainGetTheCamerasViewPoint)
{
    const osg::ref_ptr<ViewPointReader> beside = new ViewPointReader, above = new ViewPointReader;
    _scene->removeChild(_engine);
    above->addChild(_engine);
    _scene->addChild(above);
    _scene->addChild(beside);
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(6.0);
    const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    for (Effect* effect : {static_cast<Effect*>(high), static_cast<Effect*>(pedestrian)})
    {
        _scene->addEffect(effect);
        Random random(12);
        for (int i = 0; i < 6; ++i)
        {
            SCOPED_TRACE("camera " + std::to_string(i));
            lookAnyhow(random);
            if (!isDeformed()) continue;
            const osg::ref_ptr<osg::Image> expected = drawAll();
            const osg::Vec3d eye = osg::Matrixd::inverse(viewer().getCamera()->getViewMatrix()).getTrans();
            for (const EffectScene::EngineCulling culling : {EffectScene::OPEN, EffectScene::PROXY})
            {
                _scene->setEngineCulling(culling);
                _scene->setEngineTerrain(nullptr);
                EXPECT_TRUE(same(*draw(), *expected));
                EXPECT_GT(_engine->viewPoint.z(), 1000.0 + eye.z());
                EXPECT_GT(above->viewPoint.z(), 1000.0 + eye.z());
                EXPECT_GT(beside->viewPoint.z(), 1000.0 + eye.z());
                _scene->setEngineTerrain(_engine);
                EXPECT_TRUE(same(*draw(), *expected));
                EXPECT_GT(_engine->viewPoint.z(), 1000.0 + eye.z());
                EXPECT_LT((above->viewPoint - eye).length(), 0.1);
                EXPECT_LT((beside->viewPoint - eye).length(), 0.1);
            }
        }
        _scene->removeEffect(effect);
    }
}

TEST_F(EngineCulling, ClampCallbacksCutNothingOff)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    _scene->addEffect(bend);
    _scene->setEngineCulling(EffectScene::OPEN);
    osg::Camera& camera = *viewer().getCamera();
    look({0.0, -1500.0, 400.0}, {0.0, 0.0, 0.0}, 40.0);
    const osg::ref_ptr<osg::Image> expected = draw();
    const osg::Matrixd projection = camera.getProjectionMatrix();
    const osg::ref_ptr<osgUtil::CullVisitor> clamping = osgUtil::CullVisitor::create();
    camera.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    camera.setClampProjectionMatrixCallback(new FakeClamp(*clamping, 1200.0));
    const auto cut = [&]
    {
        camera.setProjectionMatrix(projection);
        return differing(*draw(), *expected, 8);
    };
    for (int frame = 0; frame < 3; ++frame)
        EXPECT_LT(cut(), 0.005);
    // The host has its way where the engine is left to itself.
    _scene->setEngineCulling(EffectScene::AS_IT_IS);
    EXPECT_GT(cut(), 0.02);
    _scene->setEngineCulling(EffectScene::OPEN);
    EXPECT_LT(cut(), 0.005);
    camera.setClampProjectionMatrixCallback(nullptr);
}

TEST_F(EngineCulling, OpenHoldsTheHorizonClipPlaneNeutral)
{
    // As osgEarth has it: a plane in a uniform, which cuts off what is beyond the horizon.
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    _scene->addEffect(bend);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    const std::string version = "#version 330 compatibility\n";
    program->addShader(
        new osg::Shader(osg::Shader::VERTEX, version + "vec4 geofx_vertex(vec4 eye);\n"
                                                       "void main() { gl_Position = gl_ProjectionMatrix * "
                                                       "geofx_vertex(gl_ModelViewMatrix * gl_Vertex); }\n"));
    program->addShader(new osg::Shader(
        osg::Shader::FRAGMENT, version + "uniform vec4 oe_ClipPlane_plane;\n"
                                         "void main() { gl_FragColor = vec4(oe_ClipPlane_plane.w); }\n"));
    EffectScene::addFunctions(*program);
    const osg::ref_ptr<osg::StateSet> state = _root->getOrCreateStateSet();
    state->setAttributeAndModes(program, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    state->addUniform(new osg::Uniform("oe_ClipPlane_plane", osg::Vec4f(0.0f, 0.0f, 1.0f, -1.0f)));
    const auto shown = [&]
    {
        return draw()->data(100, 40)[0] == 255;
    };
    EXPECT_FALSE(shown());
    _scene->setEngineCulling(EffectScene::OPEN);
    EXPECT_TRUE(shown());
    _scene->setEngineCulling(EffectScene::AS_IT_IS);
    EXPECT_FALSE(shown());
}
