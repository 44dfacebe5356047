// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Shade on the ground: it takes its share of the ground's color wherever effects put the ground, with any kind of depths, and is no
// thing that hides, throws a shadow or is picked.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <tools/BentGround.h>
#include <tools/DepthKinds.h>
#include <tools/SampledCases.h>

#include <osg/LightSource>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// A part of the ground of BentGround.
struct Part
{
    double west, south, east, north;
};
constexpr Part BROAD = {-60.0, -110.0, 50.0, 90.0};

class GroundShadeTest : public BentGround
{
protected:
    /// A sheet on the ground, in triangles four times as wide as the ground's, `lift` metres above it.
    static osg::ref_ptr<osg::Geometry> makeSheet(const Part& part, const osg::Vec4& color, double lift = 0.0)
    {
        constexpr double step = 8.0;
        const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
        const osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
        const int columns = static_cast<int>(std::ceil((part.east - part.west) / step)),
                  rows = static_cast<int>(std::ceil((part.north - part.south) / step));
        for (int row = 0; row <= rows; ++row)
            for (int column = 0; column <= columns; ++column)
            {
                const double x = part.west + (part.east - part.west) * column / columns,
                             y = part.south + (part.north - part.south) * row / rows;
                places->push_back(osg::Vec3d(x, y, std::sin(x / 13) * std::cos(y / 17) + lift));
                if (row == rows || column == columns) continue;
                const int first = row * (columns + 1) + column;
                for (const int corner : {0, 1, columns + 2, 0, columns + 2, columns + 1})
                    triangles->push_back(static_cast<GLushort>(first + corner));
            }
        osg::ref_ptr<osg::Geometry> sheet = new osg::Geometry;
        sheet->setUseDisplayList(false);
        sheet->setVertexArray(places);
        const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
        colors->front() = color;
        sheet->setColorArray(colors);
        sheet->addPrimitiveSet(triangles);
        return sheet;
    }
    static osg::ref_ptr<osg::Geometry> makeShade(const Part& part, float share, double lift = 0.0)
    {
        osg::ref_ptr<osg::Geometry> shade = makeSheet(part, {0.0f, 0.0f, 0.0f, share}, lift);
        shade->setStateSet(GroundShade::createState());
        return shade;
    }
    /// White wherever the sheet is, whatever stands before it.
    static osg::ref_ptr<osg::Geometry> makeMark(const Part& part)
    {
        osg::ref_ptr<osg::Geometry> mark = makeSheet(part, {1.0f, 1.0f, 1.0f, 1.0f});
        mark->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
        mark->getOrCreateStateSet()->setRenderBinDetails(9, "RenderBin");
        return mark;
    }
    static osg::ref_ptr<EffectScene> sceneOf(int kind)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        if (kind == 1 || kind == 3) scene->addEffect(makeBend());
        if (kind == 2)
        {
            osg::ref_ptr<PedestrianView> walk = new PedestrianView;
            walk->setFocusDistance(80);
            walk->setZoneWidth(60);
            scene->addEffect(walk);
        }
        if (kind == 3)
        {
            osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
            lift->setFactor(2.0);
            scene->addEffect(lift);
        }
        return scene;
    }

    struct Counts
    {
        int marked = 0, shaded = 0, wrong = 0;
    };
    /// Pixels of the mark; those that have lost their share there; and all that are something else than with or without it.
    static Counts compare(const osg::Image& without, const osg::Image& with, const osg::Image& mark,
                          double share)
    {
        Counts counts;
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
        {
            const unsigned char *a = without.data() + 4 * i, *b = with.data() + 4 * i;
            const unsigned char* m = mark.data() + 4 * i;
            const bool marked = m[0] == 255 && m[1] == 255 && m[2] == 255;
            bool kept = true, shaded = true;
            for (int channel = 0; channel < 3; ++channel)
            {
                kept = kept && std::abs(a[channel] - b[channel]) <= 1;
                shaded = shaded && std::abs((1.0 - share) * a[channel] - b[channel]) <= 1.5;
            }
            counts.marked += marked ? 1 : 0;
            counts.shaded += marked && shaded ? 1 : 0;
            counts.wrong += (marked ? !shaded && !kept : !kept) ? 1 : 0;
        }
        return counts;
    }
};

class GroundShadeDepths : public GroundShadeTest, public ::testing::WithParamInterface<DepthKind>
{
};

std::string nameOf(const ::testing::TestParamInfo<DepthKind>& info)
{
    return info.param.name;
}

} // namespace

TEST_F(GroundShadeTest, TakesItsShareOfTheGroundWhereverThatIs)
{
    for (const int kind : {-1, 0, 1, 2, 3})
    {
        SCOPED_TRACE(kind);
        const auto picture = [&](const osg::ref_ptr<osg::Node>& more)
        {
            osg::ref_ptr<osg::Group> scene;
            if (kind < 0)
                scene = new osg::Group; // plain OpenSceneGraph
            else
                scene = sceneOf(kind);
            scene->addChild(makeGround());
            if (more) scene->addChild(more);
            return render(scene);
        };
        const osg::ref_ptr<osg::Image> ground = picture(nullptr);
        // As in a town, whose buildings keep their shape; its shade does not.
        const osg::ref_ptr<osg::Group> town = new osg::Group;
        town->getOrCreateStateSet()->setDefine(RigidParts::define);
        town->addChild(makeShade(BROAD, 0.4f));
        const Counts counts = compare(*ground, *picture(town), *picture(makeMark(BROAD)), 0.4);
        EXPECT_GT(counts.marked, 2000);
        // Some of it is behind waves of the ground.
        EXPECT_GT(counts.shaded, counts.marked * 97 / 100);
        // Where a steep wave hides another one, both show for some pixels.
        EXPECT_LE(counts.wrong, kind == 3 ? counts.marked / 20 : 0);
    }
}

TEST_P(GroundShadeDepths, AreAllTheSame)
{
    const osg::ref_ptr<EffectScene> scene = sceneOf(1);
    scene->addChild(makeGround());
    const osg::ref_ptr<osg::Geometry> shade = makeShade(BROAD, 0.4f);
    const osg::ref_ptr<osg::Node> box = makeBox(24.0f, {0.0, -20.0, -1.0});
    scene->addChild(box);
    GetParam().setUp(*viewer().getCamera(), *scene);
    const osg::ref_ptr<osg::Image> without = render(scene);
    scene->addChild(shade);
    const osg::ref_ptr<osg::Image> with = render(scene);
    scene->removeChild(box);
    const osg::ref_ptr<osg::Image> alone = render(scene);
    scene->replaceChild(shade, makeMark(BROAD));
    const osg::ref_ptr<osg::Image> mark = render(scene);
    const Counts counts = compare(*without, *with, *mark, 0.4);
    EXPECT_EQ(counts.wrong, 0);
    EXPECT_GT(counts.shaded, counts.marked * 7 / 10);
    // The box stands before some of it.
    EXPECT_LT(counts.shaded, counts.marked * 97 / 100);
    EXPECT_GT(differing(*alone, *with), 500);
}

INSTANTIATE_TEST_SUITE_P(Kinds, GroundShadeDepths, ::testing::ValuesIn(sampledCases(DepthKind::all(), 2)),
                         nameOf);

TEST_F(GroundShadeTest, OverlapsInAnyOrder)
{
    const Part other = {-20.0, -60.0, 80.0, 40.0};
    const osg::ref_ptr<osg::Geometry> one = makeShade(BROAD, 0.4f), two = makeShade(other, 0.25f);
    std::vector<osg::ref_ptr<osg::Image>> pictures;
    for (const bool turned : {false, true})
    {
        const osg::ref_ptr<EffectScene> scene = sceneOf(1);
        scene->addChild(makeGround());
        scene->addChild(turned ? two : one);
        scene->addChild(turned ? one : two);
        pictures.push_back(render(scene));
    }
    int apart = 0;
    for (unsigned int i = 0; i < pictures[0]->getTotalSizeInBytes(); ++i)
        apart = std::max(apart, std::abs(pictures[0]->data()[i] - pictures[1]->data()[i]));
    EXPECT_LE(apart, 1);
}

TEST_F(GroundShadeTest, IsNotPicked)
{
    const osg::ref_ptr<EffectScene> scene = sceneOf(1);
    scene->addChild(makeGround());
    const osg::ref_ptr<osg::Geometry> plain = makeSheet(BROAD, {1.0f, 1.0f, 1.0f, 1.0f}, 3.0),
                                      shade = makeShade(BROAD, 0.4f, 3.0);
    const osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<const DeformationChain> chain =
        scene->deformation(camera.getViewMatrix(), camera.getProjectionMatrix());
    for (const bool picked : {true, false})
    {
        const osg::ref_ptr<osg::Geometry>& sheet = picked ? plain : shade;
        scene->addChild(sheet);
        int found = 0, all = 0;
        for (int i = 1; i < 10; ++i)
        {
            const osg::Vec3d through(0.0, -0.3 + 0.05 * i, -1.0);
            const osg::ref_ptr<DeformedLineIntersector> ray =
                new DeformedLineIntersector(osg::Vec3d(), through * 2000.0);
            const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
                new DeformedIntersectionVisitor(ray, *chain, camera.getViewMatrix(), 1.0);
            scene->accept(*visitor);
            for (const auto& hit : ray->intersections())
            {
                ++all;
                found += hit.drawable == sheet ? 1 : 0;
            }
        }
        EXPECT_GT(all, 5);
        EXPECT_EQ(found > 0, picked);
        scene->removeChild(sheet);
    }
}

TEST_F(GroundShadeTest, ThrowsNoShadow)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    scene->addEffect(new SunShadows);
    const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition({0.6f, 0.0f, 0.8f, 0.0f});
    scene->addChild(sun);
    scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    scene->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    scene->addChild(makeGround());
    const osg::ref_ptr<osg::Image> ground = render(scene);
    const Part part = {0.0, -60.0, 30.0, -30.0};
    const osg::ref_ptr<osg::Geometry> plain = makeSheet(part, {1.0f, 1.0f, 1.0f, 1.0f}, 12.0);
    plain->setNormalArray(new osg::Vec3Array(osg::Array::BIND_OVERALL, 1));
    scene->addChild(plain);
    const int thrown = differing(*ground, *render(scene));
    // Nothing of the ground's color is taken, so what is left to see would be its shadow.
    scene->replaceChild(plain, makeShade(part, 0.0f, 12.0));
    EXPECT_GT(thrown, 300);
    EXPECT_EQ(differing(*ground, *render(scene)), 0);
}
