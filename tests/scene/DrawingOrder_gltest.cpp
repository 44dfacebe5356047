// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The order in which things of a scene are drawn: an application's as OSG does, those of a database of the kit's the nearest first.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/detail/TileNormals.h>
#include <osgGeoFX/effect/detail/TownState.h>
#include <tools/BentGround.h>
#include <tools/CullHarness.h>

#include <osg/Depth>
#include <osg/Texture2D>

#include <algorithm>
#include <map>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// A state that is known by the name of a texture.
void mark(osg::StateSet& state, unsigned int unit, const char* name)
{
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setName(name);
    state.setTextureAttribute(unit, texture);
}
void makeTile(osg::StateSet& state)
{
    mark(state, TileNormals::unit, TileNormals::texture);
}

/// Boxes ahead of the camera, each with a state of its own, as tiles have. Their names are the distances.
class DrawingOrder : public BentGround
{
protected:
    void SetUp() override
    {
        BentGround::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        for (const int distance : {400, 100, 300, 200})
        {
            const osg::ref_ptr<osg::MatrixTransform> box = makeBox(10.0f, osg::Vec3d(0.0, distance, 0.0));
            osg::Drawable* drawable = box->getChild(0)->asDrawable();
            ASSERT_NE(drawable, nullptr);
            drawable->setName(std::to_string(distance));
            _states[distance] = drawable->getOrCreateStateSet();
            makeTile(*_states[distance]);
            _boxes->addChild(box);
        }
        _scene->addChild(_boxes);
    }

    std::vector<int> order(osg::Node* top)
    {
        CullHarness harness(context(), top, WIDTH, HEIGHT);
        harness.setCamera(osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, 30.0), osg::Vec3d(0.0, 1000.0, 0.0),
                                               osg::Vec3d(0.0, 0.0, 1.0)),
                          osg::Matrixd::perspective(40.0, 4.0 / 3.0, 1.0, 2000.0));
        std::vector<int> result;
        for (const Culled::Leaf& leaf : harness.frame(true, false).leaves)
            result.push_back(std::stoi(leaf.drawable->getName()));
        return result;
    }
    std::vector<int> order() { return order(_scene); }

    const osg::ref_ptr<EffectScene> _scene = new EffectScene;
    const osg::ref_ptr<osg::Group> _boxes = new osg::Group;
    std::map<int, osg::StateSet*> _states;
};

using Order = std::vector<int>;

} // namespace

TEST_F(DrawingOrder, IsFromNearToFarWithAndWithoutEffects)
{
    EXPECT_EQ(order(_boxes), Order({400, 100, 300, 200})); // OSG's own
    EXPECT_EQ(order(), Order({100, 200, 300, 400}));
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(2.0);
    _scene->addEffect(high);
    EXPECT_EQ(order(), Order({100, 200, 300, 400}));
}

TEST_F(DrawingOrder, StaysWhereThePictureDependsOnIt)
{
    _states[200]->setMode(GL_BLEND, osg::StateAttribute::ON);
    EXPECT_EQ(order(), Order({100, 300, 400, 200}));
    // Nothing goes past what stays.
    _states[100]->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    EXPECT_EQ(order(), Order({400, 100, 300, 200}));
    _states[100]->removeMode(GL_DEPTH_TEST);
    _states[100]->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL));
    EXPECT_EQ(order(), Order({400, 100, 300, 200}));
    _states[100]->removeAttribute(osg::StateAttribute::DEPTH);
    EXPECT_EQ(order(), Order({100, 300, 400, 200}));
    _states[200]->removeMode(GL_BLEND);
    _boxes->getOrCreateStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
    EXPECT_EQ(order(), Order({400, 100, 300, 200}));
}

TEST_F(DrawingOrder, BuildingsAreDrawnBeforeTheGround)
{
    const osg::ref_ptr<osg::Group> town = new osg::Group;
    mark(*town->getOrCreateStateSet(), 0, TownState::texture);
    for (const int distance : {450, 250, 350})
    {
        const osg::ref_ptr<osg::MatrixTransform> box = makeBox(10.0f, osg::Vec3d(0.0, distance, 0.0));
        box->getChild(0)->asDrawable()->setName(std::to_string(distance));
        town->addChild(box);
    }
    _scene->addChild(town);
    EXPECT_EQ(order(), Order({250, 350, 450, 100, 200, 300, 400}));
}

/// What the GPU divides has a program of its own. Which of a tile's two comes first must not depend on what is in sight, or pixels of
/// equal depths between its parts would.
TEST_F(DrawingOrder, OfATilesPartsIsTheSameWhicheverIsSeenFirst)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setTessellation(true);
    _scene->addEffect(bend);
    _scene->removeChild(_boxes);
    const osg::ref_ptr<osg::MatrixTransform> tile = new osg::MatrixTransform;
    _scene->addChild(tile);
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    makeTile(*state);
    std::vector<osg::ref_ptr<osg::Geometry>> parts;
    for (int distance = 20; distance <= 1000; distance += 20)
    {
        parts.push_back(makeBox(2.0f));
        auto& vertices = static_cast<osg::Vec3Array&>(*parts.back()->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex.y() += static_cast<float>(distance);
        parts.back()->setName(std::to_string(distance));
        parts.back()->setStateSet(state);
    }
    CullHarness harness(context(), _scene, WIDTH, HEIGHT);
    const osg::Matrixd view = osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, 50.0), osg::Vec3d(0.0, 100.0, 0.0),
                                                   osg::Vec3d(0.0, 0.0, 1.0));
    const osg::Matrixd projection = osg::Matrixd::perspective(60.0, 4.0 / 3.0, 1.0, 2000.0);
    harness.setCamera(view, projection);
    harness.frame(true); // a context is known from its second frame on
    Order orders[2];
    bool divided[2] = {};
    for (Order& result : orders)
    {
        tile->removeChildren(0, tile->getNumChildren());
        for (const auto& part : parts)
            tile->addChild(part);
        std::reverse(parts.begin(), parts.end());
        for (const Culled::Leaf& leaf : harness.frame(true).leaves)
            result.push_back(std::stoi(leaf.drawable->getName()));
    }
    ASSERT_TRUE(bend->tessellates());
    const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, projection);
    for (const int distance : orders[0])
    {
        const double style = chain->style(osg::Vec3d(0.0, distance, 0.0) * view);
        divided[style > 0.0 && style < 1.0] = true;
    }
    EXPECT_TRUE(divided[0] && divided[1]);
    EXPECT_EQ(orders[0], orders[1]);
}

// Of two surfaces of equal depth, an application's scene shows the one that OSG draws first. A scene of the kit does the same, with and
// without effects.
TEST_F(DrawingOrder, OfAnApplicationsThingsIsOsgs)
{
    for (auto& [distance, state] : _states)
        state->removeTextureAttribute(TileNormals::unit, osg::StateAttribute::TEXTURE);
    EXPECT_EQ(order(), Order({400, 100, 300, 200}));
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(2.0);
    _scene->addEffect(high);
    EXPECT_EQ(order(), Order({400, 100, 300, 200}));
    // Two quads in one place. The first has a state of its own, the second that of a group.
    const auto quad = [](const osg::Vec4& color)
    {
        const osg::ref_ptr<osg::Geometry> result = osg::createTexturedQuadGeometry(
            {-60.0f, -60.0f, 20.0f}, {120.0f, 0.0f, 0.0f}, {0.0f, 150.0f, 0.0f});
        const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1);
        colors->front() = color;
        result->setColorArray(colors, osg::Array::BIND_OVERALL);
        return result;
    };
    const auto pair = [&](osg::Group* top)
    {
        const osg::ref_ptr<osg::Geometry> first = quad({1.0f, 0.0f, 0.0f, 1.0f});
        first->getOrCreateStateSet();
        top->addChild(first);
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        group->getOrCreateStateSet();
        group->addChild(quad({0.0f, 0.0f, 1.0f, 1.0f}));
        top->addChild(group);
        return osg::ref_ptr<osg::Group>(top);
    };
    const osg::ref_ptr<osg::Image> expected = render(pair(new osg::Group));
    EXPECT_TRUE(same(*render(pair(new EffectScene)), *expected));
}

TEST_F(DrawingOrder, OfTheHostStays)
{
    const osg::ref_ptr<osg::Group> host = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> sky = makeBox(10.0f, osg::Vec3d(0.0, 500.0, 0.0));
    sky->getChild(0)->asDrawable()->setName("500");
    sky->getChild(0)->asDrawable()->getOrCreateStateSet();
    host->addChild(sky);
    host->addChild(_scene);
    EXPECT_EQ(order(host), Order({500, 100, 200, 300, 400}));
    host->getOrCreateStateSet()->setRenderBinDetails(1, "TraversalOrderBin");
    EXPECT_EQ(order(host), Order({500, 400, 100, 300, 200}));
}
