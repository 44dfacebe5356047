// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Two effects in one scene, each pair of kinds in both orders: the picture is the one that is made another way, with at
// most one of the two. Heights are exaggerated beforehand, mappings are a texture of the ground, close-ups are rigid things
// that stand there, vertices are moved on the CPU.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/CloseUpStage.h>
#include <tools/ImageComparison.h>
#include <tools/PanoramaHills.h>
#include <tools/SampledCases.h>
#include <tools/StrokeTiles.h>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osg/Texture2D>

#include <cmath>
#include <functional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Picture = osg::ref_ptr<osg::Image>;

constexpr int WIDTH = 320, HEIGHT = 240;
constexpr double HALF = 1000.0; // metres, of the ground

/// A smooth picture for a mapping, or for the ground's own texture.
osg::ref_ptr<osg::Image> makeWaves()
{
    constexpr int side = 64;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int i = 0; i < side * side; ++i)
    {
        const double x = static_cast<double>(i % side) / side;
        const double y = static_cast<double>(i / side) / side;
        unsigned char* texel = image->data() + 4 * i;
        texel[0] = static_cast<unsigned char>(140.0 + 90.0 * std::sin(11.0 * x));
        texel[1] = static_cast<unsigned char>(120.0 + 90.0 * std::cos(9.0 * y));
        texel[2] = static_cast<unsigned char>(120.0 + 90.0 * std::sin(8.0 * (x + y)));
        texel[3] = 255;
    }
    return image;
}

/// A ground of 2 × 2 km without light.
class EffectPairs : public CloseUpStage
{
protected:
    EffectPairs() : CloseUpStage(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _ground = static_cast<osg::Geometry*>(_scene->getChild(0));
        osg::StateSet& state = *_root->getOrCreateStateSet();
        state.setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        look({300.0, -1400.0, 700.0}, {0.0, 0.0, 100.0});
    }

    /// The ground with heights made of its own.
    osg::ref_ptr<osg::Geometry> withHeights(const std::function<double(double)>& height) const
    {
        return moved([&](const osg::Vec3d& at) { return osg::Vec3d(at.x(), at.y(), height(at.z())); });
    }

    /// The ground with its vertices moved beforehand.
    osg::ref_ptr<osg::Geometry> moved(const std::function<osg::Vec3d(const osg::Vec3d&)>& move) const
    {
        osg::ref_ptr<osg::Geometry> result =
            new osg::Geometry(*_ground, osg::CopyOp::DEEP_COPY_ARRAYS | osg::CopyOp::DEEP_COPY_PRIMITIVES);
        // Not in the buffers of the other one.
        result->setUseVertexBufferObjects(false);
        for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*result->getVertexArray()))
            vertex = move(vertex);
        return result;
    }

    /// The ground, moved as the effects move it for the viewer's camera.
    osg::ref_ptr<osg::Geometry> deformed(const Effects& effects)
    {
        const osg::ref_ptr<EffectScene> scene = sceneOf(effects, _ground);
        const osg::Camera& camera = *viewer().getCamera();
        const osg::Matrixd view = camera.getViewMatrix();
        const osg::Matrixd back = osg::Matrixd::inverse(view);
        const osg::ref_ptr<const DeformationChain> chain =
            scene->deformation(view, camera.getProjectionMatrix());
        return moved([&](const osg::Vec3d& at) { return chain->deform(at * view) * back; });
    }

    /// The ground with the mapping's picture as its own texture.
    osg::ref_ptr<osg::Geometry> mapped() const
    {
        osg::ref_ptr<osg::Geometry> result =
            new osg::Geometry(*_ground, osg::CopyOp::DEEP_COPY_STATESETS | osg::CopyOp::DEEP_COPY_ARRAYS |
                                            osg::CopyOp::DEEP_COPY_PRIMITIVES);
        result->setUseVertexBufferObjects(false);
        const auto& vertices = static_cast<const osg::Vec3Array&>(*_ground->getVertexArray());
        osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
        for (const osg::Vec3& vertex : vertices)
            coordinates->push_back(
                (osg::Vec2(vertex.x(), vertex.y()) / static_cast<float>(HALF) + osg::Vec2(1.0f, 1.0f)) *
                0.5f);
        result->setTexCoordArray(0, coordinates);
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(_waves);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        result->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
        return result;
    }

    /// The mapping, on the whole ground.
    osg::ref_ptr<ProjectiveMappings> makeMappings() const
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setRectangle({0.0, 0.0}, HALF, HALF);
        mapping->setSoftEdges(false);
        mapping->setLayer(new DataLayer(_waves));
        osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->addMapping(mapping);
        return mappings;
    }

    static osg::ref_ptr<ProjectiveMapping> makeColored(const osg::Vec2d& center, double half,
                                                       const osg::Vec4d& color)
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setRectangle(center, half, half);
        mapping->setSoftEdges(false);
        mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
        mapping->getTransfer()->setConstant(color);
        return mapping;
    }

    static osg::ref_ptr<VerticalExaggeration> makeExaggeration(double factor, double base = 0.0)
    {
        osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(factor);
        exaggeration->setBaseHeight(base);
        return exaggeration;
    }

    static osg::ref_ptr<BirdsEyeView> makeBirdsEye()
    {
        osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
        view->setFocusLine(0.1);
        view->setHorizonLine(0.6);
        return view;
    }

    static osg::ref_ptr<PedestrianView> makePedestrian()
    {
        osg::ref_ptr<PedestrianView> view = new PedestrianView;
        view->setFocusDistance(300.0);
        view->setZoneWidth(800.0);
        view->setBendAngle(1.2);
        return view;
    }

    /// Its projection without its painting.
    static osg::ref_ptr<PanoramaMap> makeProjection()
    {
        osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setPaint(false);
        map->setStrokes(false);
        map->setWater(false);
        map->setSky(false);
        map->setViewRadius(700.0);
        return map;
    }

    /// A rectangle whose sides lie on the ground's triangles.
    static osg::ref_ptr<CloseUp> makeRectangle(const osg::Vec2d& center, double rise)
    {
        osg::ref_ptr<CloseUp> closeUp = makeCloseUp(center, 500.0, rise);
        closeUp->getRegion()->setShape(RegionOfInterest::RECTANGLE);
        closeUp->getAnchor()->setKind(Anchor::NONE);
        closeUp->getAnchor()->setLineWidth(0.0);
        closeUp->setScale(1.4, 1.4, 1.4);
        return closeUp;
    }

    static osg::ref_ptr<CloseUps> makeCloseUps(const std::vector<osg::ref_ptr<CloseUp>>& all)
    {
        osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        for (const osg::ref_ptr<CloseUp>& each : all)
            closeUps->addCloseUp(each);
        return closeUps;
    }

    /// What a close-up shows, as a thing that stands there.
    static osg::ref_ptr<osg::Node> makeModel(const CloseUp& closeUp, const osg::Geometry& ground)
    {
        const RegionOfInterest& region = *closeUp.getRegion();
        const osg::Matrixd frame = region.frameToWorld(nullptr);
        const osg::Matrixd toRegion = osg::Matrixd::inverse(frame);
        osg::ref_ptr<osg::Geometry> piece = new osg::Geometry(ground, osg::CopyOp::SHALLOW_COPY);
        const auto& all = static_cast<const osg::DrawElementsUInt&>(*ground.getPrimitiveSet(0));
        const auto& vertices = static_cast<const osg::Vec3Array&>(*ground.getVertexArray());
        osg::ref_ptr<osg::DrawElementsUInt> kept = new osg::DrawElementsUInt(GL_TRIANGLES);
        for (unsigned int i = 0; i < all.size(); i += 3)
        {
            bool inside = true;
            for (unsigned int corner = i; corner < i + 3; ++corner)
            {
                const osg::Vec3d at = osg::Vec3d(vertices[all[corner]]) * toRegion;
                inside = inside && std::abs(at.x()) < region.getWidth() / 2.0 + 1.0 &&
                         std::abs(at.y()) < region.getDepth() / 2.0 + 1.0;
            }
            for (unsigned int corner = i; inside && corner < i + 3; ++corner)
                kept->push_back(all[corner]);
        }
        EXPECT_FALSE(kept->empty());
        piece->setPrimitiveSet(0, kept);
        osg::ref_ptr<osg::MatrixTransform> lifted =
            new osg::MatrixTransform(toRegion * closeUp.shape(0.0) * frame);
        lifted->addChild(piece);
        osg::ref_ptr<RigidReference> rigid = new RigidReference;
        rigid->setReference(frame.getTrans());
        rigid->addChild(lifted);
        return rigid;
    }

    static osg::ref_ptr<osg::Group> together(const std::vector<osg::ref_ptr<osg::Node>>& nodes)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (const osg::ref_ptr<osg::Node>& node : nodes)
            group->addChild(node);
        return group;
    }

    /// The pair's picture of the ground, in both orders if `both`, is `expected`, which neither of the two makes alone.
    /// `share`: of the pixels that may be off by more than the tolerance, of 255.
    void expectPair(const osg::ref_ptr<Effect>& first, const osg::ref_ptr<Effect>& second,
                    const Picture& expected, double share, int tolerance = 4, bool both = true)
    {
        expectPairOf(_ground, first, second, expected, share, tolerance, both);
    }

    void expectPairOf(osg::Node* content, const osg::ref_ptr<Effect>& first,
                      const osg::ref_ptr<Effect>& second, const Picture& expected, double share,
                      int tolerance = 4, bool both = true)
    {
        const double wanted = std::max(0.02, 3.0 * share);
        EXPECT_GT(differing(*picture({first}, content), *expected, tolerance), wanted)
            << "the second one shows nothing";
        EXPECT_GT(differing(*picture({second}, content), *expected, tolerance), wanted)
            << "the first one shows nothing";
        expectSame(picture({first, second}, content), expected, share, tolerance, "in this order");
        if (both)
            expectSame(picture({second, first}, content), expected, share, tolerance, "in the other order");
    }

    static void expectSame(const Picture& actual, const Picture& expected, double share, int tolerance,
                           const std::string& name)
    {
        EXPECT_LE(differing(*actual, *expected, tolerance), share)
            << name << ": " << imagesMatch(*actual, *expected, {}, name).message();
    }

    osg::ref_ptr<osg::Geometry> _ground;
    osg::ref_ptr<osg::Image> _waves = makeWaves();
};

} // namespace

// Bends and panorama maps each make a picture of the whole view: the first one is drawn, and a sentence says so.
TEST_F(EffectPairs, OfTwoProjectionsTheFirstIsDrawn)
{
    osg::ref_ptr<BlendedView> blend = new BlendedView;
    const Effects kinds = {makeBirdsEye(), makePedestrian(), blend, makeProjection()};
    for (const osg::ref_ptr<Effect>& first : kinds)
    {
        const Picture alone = picture({first}, _ground);
        for (const osg::ref_ptr<Effect>& second : kinds)
        {
            if (first == second) continue;
            SCOPED_TRACE(std::string(first->className()) + " " + second->className());
            Picture both;
            const std::vector<std::string> messages = watch().messagesOf(
                [&] {
                    both = picture({first, second}, _ground);
                });
            EXPECT_TRUE(same(*both, *alone));
            ASSERT_EQ(messages.size(), 1u);
            for (const Effect* each : {first.get(), second.get()})
                EXPECT_NE(messages[0].find(each->className()), std::string::npos) << messages[0];
            EXPECT_NE(messages[0].find("the first one in the scene's list"), std::string::npos)
                << messages[0];
            // The CPU's answers are those of the picture.
            const osg::Camera& camera = *viewer().getCamera();
            const osg::ref_ptr<const DeformationChain> chain =
                _scene->deformation(camera.getViewMatrix(), camera.getProjectionMatrix());
            EXPECT_LE(chain->snapshots().size(), 1u);
            // If it is switched off, the other one shows, without a word.
            first->setEnabled(false);
            const Picture other = draw();
            first->setEnabled(true);
            EXPECT_TRUE(same(*other, *picture({second}, _ground)));
        }
    }
}

// Without its projection a panorama map is a painting, which any bend may bend.
TEST_F(EffectPairs, APaintingUnderABend)
{
    osg::ref_ptr<PanoramaMap> painting = new PanoramaMap;
    painting->setProjection(false);
    painting->setSky(false);
    painting->setRipples(0.0); // each frame has another time
    const osg::ref_ptr<BirdsEyeView> bend = makeBirdsEye();
    const Picture painted = picture({painting}, _ground);
    const Picture bent = picture({bend}, _ground);
    for (const Effects& both : {Effects{painting, bend}, Effects{bend, painting}})
    {
        const Picture drawn = picture(both, _ground);
        EXPECT_GT(differing(*drawn, *painted), 0.05);
        int outlines = 0;
        int focus = 0;
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
        {
            const unsigned char* pixel = drawn->data() + 4 * i;
            const auto ground = [&](const osg::Image& of)
            {
                const unsigned char* there = of.data() + 4 * i;
                return there[0] != 26 || there[1] != 51 || there[2] != 77;
            };
            outlines += ground(*drawn) != ground(*bent) ? 1 : 0;
            // Below the line nothing is bent.
            if (i / WIDTH >= 0.09 * HEIGHT) continue;
            for (int c = 0; c < 3; ++c)
                focus = std::max(focus, std::abs(pixel[c] - painted->data()[4 * i + c]));
        }
        EXPECT_EQ(outlines, 0);
        EXPECT_LE(focus, 2);
    }
}

TEST_F(EffectPairs, TwoExaggerations)
{
    const auto height = [](double z)
    {
        const double once = 10.0 + 2.0 * (z - 10.0);
        return -20.0 + 1.5 * (once + 20.0);
    };
    const Picture expected = picture({}, withHeights(height));
    expectPair(makeExaggeration(2.0, 10.0), makeExaggeration(1.5, -20.0), expected, 0.002, 4, false);
}

TEST_F(EffectPairs, AnExaggerationUnderABend)
{
    const osg::ref_ptr<osg::Geometry> high = withHeights([](double z) { return 2.5 * z; });
    osg::ref_ptr<BlendedView> blend = new BlendedView;
    blend->setBirdsEyeView(makeBirdsEye());
    blend->setPedestrianView(makePedestrian());
    for (const osg::ref_ptr<Effect>& bend :
         sampledCases<osg::ref_ptr<Effect>>({makeBirdsEye(), makePedestrian(), blend}, 2))
    {
        SCOPED_TRACE(bend->className());
        const Picture expected = picture({bend}, high);
        expectPair(makeExaggeration(2.5), bend, expected, 0.004, 4, false);
    }
}

// The other way round, heights count where the bend has put them.
TEST_F(EffectPairs, ABendUnderAnExaggeration)
{
    const Effects effects = {makeBirdsEye(), makeExaggeration(1.5)};
    expectPair(effects[0], effects[1], picture({}, deformed(effects)), 0.004, 4, false);
}

TEST_F(EffectPairs, AnExaggerationInAPanorama)
{
    const osg::ref_ptr<PanoramaMap> map = makeProjection();
    const Picture expected = picture({map}, withHeights([](double z) { return 2.5 * z; }));
    expectPair(makeExaggeration(2.5), map, expected, 0.004, 4, false);
}

TEST_F(EffectPairs, MappingsOnExaggeratedGround)
{
    const Picture expected = picture({makeExaggeration(2.0)}, mapped());
    expectPair(makeExaggeration(2.0), makeMappings(), expected, 0.004);
}

TEST_F(EffectPairs, MappingsOnBentGround)
{
    for (const osg::ref_ptr<Effect>& bend :
         sampledCases<osg::ref_ptr<Effect>>({makeBirdsEye(), makePedestrian()}, 2, 1))
    {
        SCOPED_TRACE(bend->className());
        const Picture expected = picture({bend}, mapped());
        expectPair(bend, makeMappings(), expected, 0.004);
    }
}

TEST_F(EffectPairs, MappingsInAPanorama)
{
    const osg::ref_ptr<PanoramaMap> map = makeProjection();
    const Picture expected = picture({map}, mapped());
    expectPair(map, makeMappings(), expected, 0.004);
}

// Mappings lie on the paint if they come later: as the ground's own colors there, and elsewhere as the painting.
TEST_F(EffectPairs, MappingsOnAPainting)
{
    const osg::ref_ptr<PanoramaMap> projection = makeProjection();
    osg::ref_ptr<PanoramaMap> painting = makeProjection();
    painting->setPaint(true);
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(makeColored({0.0, -200.0}, 300.0, {0.9, 0.2, 0.1, 1.0}));
    const Picture plain = picture({projection, mappings}, _ground);
    const Picture painted = picture({painting}, _ground);
    const Picture drawn = picture({painting, mappings}, _ground);
    int mapped = 0;
    int off = 0;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i += 4)
    {
        const unsigned char* there = plain->data() + i;
        const bool inside = there[0] == 230 && there[1] == 51 && there[2] == 26;
        mapped += inside ? 1 : 0;
        const unsigned char* wanted = (inside ? plain : painted)->data() + i;
        for (int c = 0; c < 3; ++c)
            off += std::abs(wanted[c] - drawn->data()[i + c]) > 1 ? 1 : 0;
    }
    EXPECT_GT(mapped, 0.05 * WIDTH * HEIGHT);
    EXPECT_EQ(off, 0);
    // The paint covers what comes before it.
    // Within 2/255: another program rounds the directions of strokes on slopes otherwise.
    EXPECT_EQ(differing(*picture({mappings, painting}, _ground), *painted), 0.0);
}

TEST_F(EffectPairs, CloseUpsOfExaggeratedGroundKeepTheirOwnHeights)
{
    const osg::ref_ptr<CloseUp> closeUp = makeRectangle({100.0, -200.0}, 500.0);
    const Picture expected =
        picture({}, together({withHeights([](double z) { return 2.0 * z; }), makeModel(*closeUp, *_ground)}));
    expectPair(makeExaggeration(2.0), makeCloseUps({closeUp}), expected, 0.012);
}

TEST_F(EffectPairs, CloseUpsOfBentGround)
{
    for (const osg::ref_ptr<Effect>& bend :
         sampledCases<osg::ref_ptr<Effect>>({makeBirdsEye(), makePedestrian()}, 2))
    {
        SCOPED_TRACE(bend->className());
        const osg::ref_ptr<CloseUp> closeUp = makeRectangle({-150.0, 150.0}, 350.0);
        const Picture expected = picture({bend}, together({_ground, makeModel(*closeUp, *_ground)}));
        expectPair(bend, makeCloseUps({closeUp}), expected, 0.012);
    }
}

// Houses stand in the close-up as on the ground, wherever bend and close-up have moved them.
TEST_F(EffectPairs, HousesInCloseUpsOfBentGround)
{
    osg::ref_ptr<osg::ShapeDrawable> box = new osg::ShapeDrawable(new osg::Box({}, 60.0f, 45.0f, 80.0f));
    box->setColor({0.9f, 0.1f, 0.1f, 1.0f});
    // The bird's-eye view puts what is far elsewhere, farther than a house is wide.
    for (const auto& [bend, center] :
         {std::pair<osg::ref_ptr<Effect>, osg::Vec2d>(makeBirdsEye(), {150.0, 450.0}),
          std::pair<osg::ref_ptr<Effect>, osg::Vec2d>(makePedestrian(), {150.0, -350.0})})
    {
        SCOPED_TRACE(bend->className());
        osg::ref_ptr<osg::Group> houses = new osg::Group;
        for (const double aside : {-60.0, 60.0})
        {
            const osg::Vec3d at(center + osg::Vec2d(aside, aside), groundHeight(center.x(), center.y()));
            osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(osg::Matrixd::translate(at));
            place->addChild(box);
            osg::ref_ptr<RigidReference> rigid = new RigidReference;
            rigid->setReference(at);
            rigid->addChild(place);
            houses->addChild(rigid);
        }
        houses->getOrCreateStateSet()->setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
        const osg::ref_ptr<osg::Node> town = together({_ground, houses});
        const osg::ref_ptr<CloseUp> closeUp = makeRectangle(center, 250.0);
        // To where the picture has room.
        const bool low = center.y() < 0.0;
        closeUp->setOffset({low ? -150.0 : -500.0, low ? 30.0 : -400.0, 250.0});
        for (const CloseUp::Edge edge : {CloseUp::FRAGMENTS, CloseUp::PRIMITIVES})
        {
            closeUp->setEdge(edge);
            const Effects effects = {bend, makeCloseUps({closeUp})};
            const Picture drawn = picture(effects, town);
            houses->setNodeMask(0);
            const Picture empty = picture(effects, town);
            houses->setNodeMask(~0u);
            // Both the two in the overview and those in the close-up, which are larger.
            const double overview = differing(*picture({bend}, town), *picture({bend}, _ground), 20);
            EXPECT_GT(overview, 0.0);
            EXPECT_GT(differing(*drawn, *empty, 20), 1.15 * overview);
            osg::Camera& camera = *viewer().getCamera();
            const osg::CullSettings::CullingMode culling = camera.getCullingMode();
            camera.setCullingMode(osg::CullSettings::NO_CULLING);
            const Picture whole = picture(effects, town);
            camera.setCullingMode(culling);
            EXPECT_TRUE(same(*drawn, *whole));
        }
    }
}

TEST_F(EffectPairs, CloseUpsOfAPanorama)
{
    const osg::ref_ptr<PanoramaMap> map = makeProjection();
    const osg::ref_ptr<CloseUp> closeUp = makeRectangle({100.0, -300.0}, 150.0);
    const Picture expected = picture({map}, together({_ground, makeModel(*closeUp, *_ground)}));
    expectPair(map, makeCloseUps({closeUp}), expected, 0.012);
}

TEST_F(EffectPairs, MappingsInCloseUps)
{
    const osg::ref_ptr<CloseUps> closeUps = makeCloseUps({makeRectangle({100.0, -200.0}, 500.0)});
    const Picture expected = picture({closeUps}, mapped());
    expectPair(makeMappings(), closeUps, expected, 0.004);
}

// What draws the scene again goes through the mappings themselves; the scene has their pages.
TEST_F(EffectPairs, PagesOfMappingsBesidePasses)
{
    const Effects others = {makeCloseUps({makeRectangle({100.0, -200.0}, 500.0)}), makeProjection()};
    for (const osg::ref_ptr<Effect>& other : others)
    {
        SCOPED_TRACE(other->className());
        const Picture expected = picture({makeMappings(), other}, _ground);
        const osg::ref_ptr<ProjectiveMappings> paged = makeMappings();
        paged->setCaching(ProjectiveMappings::AUTOMATIC);
        Picture drawn = picture({paged, other}, _ground);
        for (int i = 0; i < 100 && paged->cacheStatistics().pagedFrames < 2; ++i)
            drawn = draw();
        EXPECT_EQ(paged->cacheStatistics().reason, "");
        EXPECT_GE(paged->cacheStatistics().pagedFrames, 2u);
        expectSame(drawn, expected, 0.004, 3, "by pages");
    }
}

TEST_F(EffectPairs, TwoSetsOfMappings)
{
    const std::vector<osg::ref_ptr<ProjectiveMapping>> mappings = {
        makeColored({-100.0, -100.0}, 300.0, {0.9, 0.2, 0.1, 0.7}),
        makeColored({100.0, 50.0}, 300.0, {0.1, 0.3, 0.9, 0.6})};
    std::vector<osg::ref_ptr<ProjectiveMappings>> sets;
    for (int i = 0; i < 3; ++i)
        sets.push_back(new ProjectiveMappings);
    for (std::size_t i = 0; i < 2; ++i)
    {
        sets[i]->addMapping(mappings[i]);
        sets[2]->addMapping(mappings[i]);
    }
    expectPair(sets[0], sets[1], picture({sets[2]}, _ground), 0.0, 2, false);
}

TEST_F(EffectPairs, TwoSetsOfCloseUps)
{
    const osg::ref_ptr<CloseUp> low = makeRectangle({250.0, -250.0}, 300.0);
    const osg::ref_ptr<CloseUp> high = makeRectangle({-400.0, 100.0}, 450.0);
    const Picture expected = picture({makeCloseUps({low, high})}, _ground);
    expectPair(makeCloseUps({low}), makeCloseUps({high}), expected, 0.002);
}

namespace
{

/// Hills with woods, a town and a lake below a panorama map with all its parts.
class PanoramaPairs : public EffectPairs
{
protected:
    void SetUp() override
    {
        EffectPairs::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _terrain = _hills.terrain();
        _map->setRipples(0.0); // each frame has another time
    }

    void lookAt(const osg::Vec2d& middle, double width)
    {
        const osg::ref_ptr<EffectScene> scene = sceneOf({_map}, _terrain);
        viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, 4.0 / 3.0, 1000.0, 1e6);
        const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*scene, *_map);
        hand->setCameraProjection(viewer().getCamera()->getProjectionMatrix());
        hand->setWidth(width);
        EXPECT_TRUE(hand->setCenter(osg::Vec3d(middle, 0.0)));
        hand->updateCamera(*viewer().getCamera());
    }

    /// The same terrain in one color.
    osg::ref_ptr<osg::Node> colored(const osg::Vec4& color)
    {
        osg::ref_ptr<osg::CoordinateSystemNode> terrain = _hills.terrain();
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
        colors->front() = color;
        StrokeTiles::geometryOf(static_cast<osg::MatrixTransform&>(*terrain->getChild(0)))
            .setColorArray(colors);
        return terrain;
    }

    PanoramaHills _hills{};
    osg::ref_ptr<osg::Node> _terrain;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
};

} // namespace

// The lake mirrors the mapped hills: as if the hills had that color.
TEST_F(PanoramaPairs, TheMirrorUnderMappings)
{
    _map->setPaint(false);
    _map->setStrokes(false);
    _map->setReflection(1.0);
    lookAt({-12000.0, -12000.0}, 16000.0);
    const osg::Vec4 color(0.8f, 0.4f, 0.2f, 1.0f);
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(makeColored({0.0, 0.0}, 40000.0, color));
    const osg::ref_ptr<osg::Node> white = colored({1.0f, 1.0f, 1.0f, 1.0f});
    const Picture expected = picture({_map}, colored(color));
    expectPairOf(white, mappings, _map, expected, 0.004, 4, false);
}

// Where nothing is lifted, the close-up of a painting is the painting: woods, and water with its mirror.
TEST_F(PanoramaPairs, PaintedCloseUps)
{
    for (const osg::Vec2d& place : {osg::Vec2d(9000.0, -7000.0), osg::Vec2d(-12000.0, -7000.0)})
    {
        lookAt({place.x(), -12000.0}, 16000.0);
        const osg::ref_ptr<CloseUp> closeUp = makeCloseUp(place, 6000.0, 0.0);
        closeUp->getAnchor()->setKind(Anchor::NONE);
        closeUp->getAnchor()->setLineWidth(0.0);
        const osg::ref_ptr<CloseUps> closeUps = makeCloseUps({closeUp});
        const Picture painting = picture({_map}, _terrain);
        for (const int samples : {1, 2})
        {
            SCOPED_TRACE(std::to_string(place.x()) + ", samples: " + std::to_string(samples));
            closeUps->setSupersampling(samples);
            const Picture drawn = picture({_map, closeUps}, _terrain);
            EXPECT_EQ(closeUps->statistics().closeUps, 1);
            // Its border is blended.
            expectSame(drawn, painting, 0.015, 4, std::to_string(static_cast<int>(place.x())));
        }
    }
}

// What is lifted has strokes, too.
TEST_F(PanoramaPairs, StrokesInCloseUps)
{
    lookAt({9000.0, -12000.0}, 16000.0);
    // Air takes contrast from what is far.
    _map->setAtmosphere(0.0);
    for (const bool projection : {false, true})
    {
        SCOPED_TRACE(projection);
        _map->setProjection(projection);
        const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({9000.0, -7000.0}, 6000.0, 2500.0);
        const osg::ref_ptr<CloseUps> closeUps = makeCloseUps({closeUp});
        const Picture drawn = picture({_map, closeUps}, _terrain);
        _map->setStrokes(false);
        const Picture bare = picture({_map, closeUps}, _terrain);
        const Picture ground = picture({_map}, _terrain);
        _map->setStrokes(true);
        int strokes = 0;
        for (int i = 0; i < 4 * WIDTH * HEIGHT; i += 4)
        {
            const auto far = [&](const Picture& a, const Picture& b)
            {
                return std::abs(a->data()[i + 1] - b->data()[i + 1]) > 12;
            };
            strokes += far(bare, ground) && far(drawn, bare) ? 1 : 0;
        }
        EXPECT_GT(strokes, 60); // none where strokes are missing
    }
}
