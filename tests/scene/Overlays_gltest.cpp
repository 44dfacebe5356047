// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// State that applies within a frustum (osg::CullingSet::addStateFrustum), and OSG's node that lives on it.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>

#include <osg/TexEnv>
#include <osg/Texture2D>
#include <osgSim/OverlayNode>
#include <osgUtil/CullVisitor>

#include <array>
#include <functional>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

osg::ref_ptr<osg::StateSet> plainColor(const osg::Vec4ub& color)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::copy(color.ptr(), color.ptr() + 4, image->data());
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    state->setTextureAttributeAndModes(0, texture);
    state->setTextureAttribute(0, new osg::TexEnv(osg::TexEnv::REPLACE));
    return state;
}

/// Puts a state set into force for all drawables below it whose boxes reach into a frustum.
class Region : public osg::Group
{
public:
    Region(osg::StateSet* state, const osg::Polytope& frustum) : _state(state), _frustum(frustum) {}

    void traverse(osg::NodeVisitor& visitor) override
    {
        osgUtil::CullVisitor* cull = visitor.asCullVisitor();
        if (!cull)
        {
            osg::Group::traverse(visitor);
            return;
        }
        osg::Polytope inView;
        inView.setAndTransformProvidingInverse(_frustum, osg::Matrix::inverse(*cull->getModelViewMatrix()));
        cull->getProjectionCullingStack().back().addStateFrustum(_state, inView);
        cull->getCurrentCullingSet().addStateFrustum(_state, _frustum);
        osg::Group::traverse(visitor);
        cull->getCurrentCullingSet().getStateFrustumList().pop_back();
        cull->getProjectionCullingStack().back().getStateFrustumList().pop_back();
    }

protected:
    ~Region() override = default;

private:
    const osg::ref_ptr<osg::StateSet> _state;
    osg::Polytope _frustum;
};

class Overlays : public BentGround
{
protected:
    static constexpr double WEST = -35.0, EAST = 28.0, SOUTH = -75.0, NORTH = 50.0;

    /// Four planes upright.
    static osg::Polytope frustum()
    {
        osg::Polytope sides;
        sides.add(osg::Plane(1.0, 0.0, 0.0, -WEST));
        sides.add(osg::Plane(-1.0, 0.0, 0.0, EAST));
        sides.add(osg::Plane(0.0, 1.0, 0.0, -SOUTH));
        sides.add(osg::Plane(0.0, -1.0, 0.0, NORTH));
        return sides;
    }
    static bool holds(double x, double y) { return x > WEST && x < EAST && y > SOUTH && y < NORTH; }

    /// A box that was put somewhere; with an own state, with a state that conflicts, as a thing that keeps its shape.
    static osg::ref_ptr<osg::Node> thing(int kind, const osg::Vec3d& place)
    {
        const osg::ref_ptr<osg::MatrixTransform> box = makeBox(6.0f, kind == 2 ? osg::Vec3d() : place);
        osg::Drawable& drawable = *box->getChild(0)->asDrawable();
        if (kind == 1) drawable.setStateSet(plainColor({200, 30, 30, 255}));
        if (kind != 2) return box;
        const osg::ref_ptr<RigidReference> rigid = new RigidReference;
        rigid->addChild(box);
        const osg::ref_ptr<osg::MatrixTransform> moved =
            new osg::MatrixTransform(osg::Matrix::translate(place));
        moved->addChild(rigid);
        return moved;
    }

    /// Things in the frustum and beside it. `state`: what those in the frustum are drawn with, put above each drawable here, and without
    /// what it has itself; null to leave that to a Region.
    static osg::ref_ptr<osg::Group> things(osg::StateSet* state)
    {
        const osg::ref_ptr<osg::Group> all = new osg::Group;
        for (int i = 0; i < 24; ++i)
        {
            const osg::Vec3d place(-55.0 + 22.0 * (i % 6), -90.0 + 50.0 * (i / 6), 0.0);
            const osg::ref_ptr<osg::Node> each = thing(i % 3, place);
            if (state && holds(place.x(), place.y()))
            {
                osg::Node* node = each;
                while (!node->asDrawable())
                    node = node->asGroup()->getChild(0);
                node->setStateSet(state);
            }
            all->addChild(each);
        }
        return all;
    }
    static osg::ref_ptr<osg::Group> region(osg::StateSet* state, osg::Node* below)
    {
        const osg::ref_ptr<Region> result = new Region(state, frustum());
        result->addChild(below);
        return result;
    }

    /// A quad a little above the ground, and not level (OSG looks for a volume), below OSG's node for overlays.
    static osg::ref_ptr<osgSim::OverlayNode> overlay(osgSim::OverlayNode::OverlayTechnique technique)
    {
        const osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry(
            {WEST, SOUTH, 5.0}, {EAST - WEST, 0.0, 4.0}, {0.0, NORTH - SOUTH, 0.0});
        const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(1);
        color->front() = {1.0f, 0.0f, 1.0f, 1.0f};
        quad->setColorArray(color, osg::Array::BIND_OVERALL);
        const osg::ref_ptr<osgSim::OverlayNode> node = new osgSim::OverlayNode(technique);
        node->setOverlaySubgraph(quad);
        node->setContinuousUpdate(true);
        return node;
    }
    static bool isOverlay(const unsigned char* pixel)
    {
        return pixel[0] > 230 && pixel[1] < 25 && pixel[2] > 230;
    }
    static osg::ref_ptr<VerticalExaggeration> lift(double factor)
    {
        const osg::ref_ptr<VerticalExaggeration> result = new VerticalExaggeration;
        result->setFactor(factor);
        return result;
    }
    osg::ref_ptr<osg::Image> second(osg::Node* scene)
    {
        render(scene);
        return render(scene);
    }
};

// The view-dependent technique draws no overlay with these cameras, without the kit either.
const std::vector<std::pair<const char*, osgSim::OverlayNode::OverlayTechnique>> techniques = {
    {"object", osgSim::OverlayNode::OBJECT_DEPENDENT_WITH_ORTHOGRAPHIC_OVERLAY}};

} // namespace

// What lies in the frustum before the deformation gets the state, whether the node of the frustum is above the scene or below it.
TEST_F(Overlays, StateOfAFrustumIsThatOfWhatStandsInIt)
{
    const osg::ref_ptr<osg::StateSet> blue = plainColor({20, 40, 220, 255});
    const auto bent = [](osg::Node* below)
    {
        return makeScene({makeGround(), below});
    };
    const osg::ref_ptr<osg::Image> expected = render(bent(things(blue)));
    EXPECT_GT(differing(*expected, *render(bent(things(nullptr)))), 200);
    EXPECT_TRUE(same(*render(bent(region(blue, things(nullptr)))), *expected, "below"));
    // The ground reaches into the frustum, so it stands beside the node.
    const osg::ref_ptr<EffectScene> scene = makeScene({things(nullptr)});
    const osg::ref_ptr<EffectScene> ground = makeScene({makeGround()});
    EXPECT_TRUE(same(*render(makePlain({ground, region(blue, scene)})), *expected, "above"));
}

// Without a deformation, OSG's own culling goes on below effects that color.
TEST_F(Overlays, StateOfAFrustumStaysBelowMappings)
{
    const osg::ref_ptr<osg::StateSet> blue = plainColor({20, 40, 220, 255});
    const auto painted = [](osg::Node* below)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<ProjectiveMappings> paint = makePaint();
        // Beside the things.
        paint->getMapping(0)->setRectangle(osg::Vec2d(0.0, 110.0), 60.0, 20.0, 0.0);
        scene->addEffect(paint);
        scene->addChild(makeGround());
        scene->addChild(below);
        return scene;
    };
    const osg::ref_ptr<osg::Image> expected = render(painted(things(blue)));
    EXPECT_GT(differing(*expected, *render(painted(things(nullptr)))), 200);
    EXPECT_TRUE(same(*render(painted(region(blue, things(nullptr)))), *expected));
}

TEST_F(Overlays, OfOsgAreKeptByWeakEffects)
{
    for (const auto& [name, technique] : techniques)
    {
        const osg::ref_ptr<osgSim::OverlayNode> node = overlay(technique);
        node->addChild(makeGround());
        const osg::ref_ptr<osg::Image> expected = second(node);
        const auto overlaid = [](const osg::Image& image)
        {
            int count = 0;
            for (int i = 0; i < WIDTH * HEIGHT; ++i)
                count += isOverlay(image.data() + 4 * i) ? 1 : 0;
            return count;
        };
        EXPECT_GT(overlaid(*expected), WIDTH * HEIGHT / 10) << name;
        for (const bool above : {true, false})
        {
            const std::string where = std::string(name) + (above ? ", above the scene" : ", below the scene");
            const osg::ref_ptr<EffectScene> scene = new EffectScene;
            scene->addEffect(lift(1.0001));
            const osg::ref_ptr<osgSim::OverlayNode> own = overlay(technique);
            (above ? own->osg::Group::addChild(scene) : scene->addChild(own));
            (above ? static_cast<osg::Group&>(*scene) : static_cast<osg::Group&>(*own))
                .addChild(makeGround());
            const osg::ref_ptr<osg::Image> actual = second(above ? own->asGroup() : scene->asGroup());
            EXPECT_TRUE(imagesMatch(*actual, *expected, {4 / 255.0f, 0.002, 1.0f}, where)) << where;
        }
    }
}

TEST_F(Overlays, OfOsgLieOnTheBentGround)
{
    for (const auto& [name, technique] : techniques)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(makeBend());
        const osg::ref_ptr<osgSim::OverlayNode> node = overlay(technique);
        node->addChild(makeGround());
        scene->addChild(node);
        const osg::ref_ptr<osg::Image> image = second(scene);
        const DeformedView view(*scene, *viewer().getCamera());
        int inside = 0, wrong = 0, all = 0;
        for (int y = 0; y < HEIGHT; y += 8)
        {
            for (int x = 0; x < WIDTH; x += 8)
            {
                const auto hit = view.pick(x + 0.5, y + 0.5);
                if (!hit) continue;
                // The overlay's own texels and the pixels are as wide as this.
                const auto near = [&](double at, double edge)
                {
                    return std::abs(at - edge) < 2.0;
                };
                if (near(hit->world.x(), WEST) || near(hit->world.x(), EAST) || near(hit->world.y(), SOUTH) ||
                    near(hit->world.y(), NORTH))
                    continue;
                const bool expected = holds(hit->world.x(), hit->world.y());
                ++all;
                inside += expected ? 1 : 0;
                wrong += expected != isOverlay(image->data(static_cast<unsigned int>(x),
                                                           static_cast<unsigned int>(y)))
                             ? 1
                             : 0;
            }
        }
        EXPECT_GT(inside, all / 10) << name;
        EXPECT_LT(inside, all * 9 / 10) << name;
        EXPECT_LE(wrong, all / 100) << name;
    }
}
