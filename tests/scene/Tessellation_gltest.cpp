// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Coarse ground whose triangles the GPU divides in the zone of a bend, against the same ground with 256 triangles for each: outlines,
// distances, seams between parts that are divided and others, culling, picking.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/DistancePicture.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>

#include <tools/SmoothTexture.h>

#include <osg/ClipNode>
#include <osg/ColorMask>
#include <osg/Fog>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgUtil/RenderStage>
#include <osgViewer/Renderer>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

using namespace geofx::test;
using namespace osgGeoFX;
using osg::Vec3d;

namespace
{

constexpr int WIDTH = 480, HEIGHT = 320;
/// The ground is a strip, both of whose sides are in the picture.
constexpr double LONG = 1e5, WIDE = 25000.0, NEAR_PLANE = 500.0, FAR_PLANE = 6e5;
/// A pixel in the middle of the picture, as a share of the distance.
const double PIXEL = 2.0 * std::tan(0.35) / HEIGHT;
constexpr unsigned int POSTS = 5;

/// The heights of a coarse ground: hills and a sea.
std::vector<double> randomHeights(Random& random)
{
    std::vector<double> heights(POSTS * POSTS);
    for (double& each : heights)
        each = std::max(0.0, random.uniform(-600.0, 1000.0));
    return heights;
}

/// What the ground is made of.
enum Primitives
{
    INDICES,
    STRIPS,
    ARRAYS,
    DRESSED ///< indices, with normals and texture coordinates
};

/// A triangle mesh over some cells of the coarse ground, whose triangles have `parts` parts along each side.
osg::ref_ptr<osg::Geometry> makePart(const std::vector<double>& heights, unsigned int parts,
                                     unsigned int from, unsigned int to, Primitives primitives,
                                     const Vec3d& origin)
{
    const unsigned int posts = (POSTS - 1) * parts + 1;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    const osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    const auto height = [&](unsigned int x, unsigned int y)
    {
        return heights[y * POSTS + x];
    };
    for (unsigned int j = 0; j < posts; ++j)
    {
        for (unsigned int i = 0; i < posts; ++i)
        {
            const unsigned int x = std::min(i / parts, POSTS - 2), y = std::min(j / parts, POSTS - 2);
            const double u = 1.0 * i / parts - x, v = 1.0 * j / parts - y;
            // On the coarse triangles: below and above the diagonal.
            const double a = height(x, y), b = height(x + 1, y), c = height(x, y + 1),
                         d = height(x + 1, y + 1);
            const double z = u >= v ? a + u * (b - a) + v * (d - b) : a + v * (c - a) + u * (d - c);
            vertices->push_back(osg::Vec3(
                Vec3d(1.0 * i / parts * WIDE / (POSTS - 1), 1.0 * j / parts * LONG / (POSTS - 1), z) -
                origin));
            coordinates->push_back({static_cast<float>(u + x) / POSTS, static_cast<float>(v + y) / POSTS});
            colors->push_back(
                {static_cast<float>(u + x) / POSTS, static_cast<float>(v + y) / POSTS, 0.7f, 1.0f});
        }
    }
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osg::DrawElementsUInt> corners = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int y = from * parts; y < to * parts; ++y)
    {
        const osg::ref_ptr<osg::DrawElementsUShort> strip = new osg::DrawElementsUShort(GL_TRIANGLE_STRIP);
        for (unsigned int x = 0; x + 1 < posts; ++x)
        {
            const unsigned int a = y * posts + x;
            for (const unsigned int corner : {a, a + 1, a + posts + 1, a, a + posts + 1, a + posts})
                corners->push_back(corner);
        }
        // With the same diagonals: from east to west.
        for (unsigned int x = posts; x-- > 0;)
        {
            strip->push_back(static_cast<GLushort>(y * posts + x));
            strip->push_back(static_cast<GLushort>((y + 1) * posts + x));
        }
        if (primitives == STRIPS) geometry->addPrimitiveSet(strip);
    }
    if (primitives == INDICES || primitives == DRESSED) geometry->addPrimitiveSet(corners);
    if (primitives == DRESSED)
    {
        const osg::ref_ptr<osg::Vec3Array> normals =
            new osg::Vec3Array(static_cast<unsigned int>(vertices->size()));
        std::fill(normals->begin(), normals->end(), osg::Vec3(0.1f, -0.2f, 0.9f));
        geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        geometry->setTexCoordArray(0, coordinates);
    }
    if (primitives == ARRAYS)
    {
        const osg::ref_ptr<osg::Vec3Array> flatVertices = new osg::Vec3Array;
        const osg::ref_ptr<osg::Vec4Array> flatColors = new osg::Vec4Array;
        for (const unsigned int corner : *corners)
        {
            flatVertices->push_back((*vertices)[corner]);
            flatColors->push_back((*colors)[corner]);
        }
        geometry->setVertexArray(flatVertices);
        geometry->setColorArray(flatColors, osg::Array::BIND_PER_VERTEX);
        geometry->addPrimitiveSet(
            new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(flatVertices->size())));
    }
    geometry->setUseDisplayList(false);
    // Mesa complains of buffers that OSG uses again for others.
    geometry->setUseVertexBufferObjects(primitives == STRIPS);
    return geometry;
}

/// The ground in as many geometries as it has rows of cells, some of which lie before the zone, in it, and behind it. With
/// `apart`, each has a frame of its own.
osg::ref_ptr<osg::Group> makeGround(const std::vector<double>& heights, unsigned int parts,
                                    Primitives primitives = INDICES, bool apart = false)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (unsigned int row = 0; row + 1 < POSTS; ++row)
    {
        const Vec3d origin = apart ? Vec3d(0.5 * WIDE, row * 12345.6, 100.0) : Vec3d();
        const osg::ref_ptr<osg::MatrixTransform> frame =
            new osg::MatrixTransform(osg::Matrix::translate(origin));
        frame->addChild(makePart(heights, parts, row, row + 1, primitives, origin));
        if (apart)
            root->addChild(frame);
        else
            root->addChild(frame->getChild(0));
    }
    root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return root;
}

osg::ref_ptr<PerspectiveBend> makeBend(int kind, Random& random)
{
    const osg::ref_ptr<BlendedView> blended = new BlendedView;
    BirdsEyeView& bird = *blended->getBirdsEyeView();
    PedestrianView& pedestrian = *blended->getPedestrianView();
    bird.setFocusLine(random.uniform(0.1, 0.35));
    bird.setHorizonLine(random.uniform(0.65, 0.9));
    pedestrian.setBendAngle(random.uniform(0.5, 1.4));
    pedestrian.setFocusDistance(random.uniform(0.0, 15000.0));
    pedestrian.setZoneWidth(random.uniform(15000.0, 40000.0));
    const auto curve = static_cast<PerspectiveBend::Curve>(random.integer(0, 2));
    osg::ref_ptr<PerspectiveBend> result = &bird;
    if (kind == 1) result = &pedestrian;
    if (kind == 2)
    {
        blended->setHighHeight(60000.0);
        blended->setLowHeight(random.uniform(1000.0, 40000.0));
        result = blended;
    }
    result->setCurve(curve);
    return result;
}

class Tessellation : public DistancePictures
{
protected:
    Tessellation() : DistancePictures(WIDTH, HEIGHT, NEAR_PLANE, FAR_PLANE, PIXEL) {}

    void SetUp() override
    {
        DistancePictures::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        // A context tells what it can do when it has drawn.
        render(new osg::Group);
    }

    void look(Random& random)
    {
        const double height = random.uniform(15000.0, 50000.0);
        const Vec3d eye(random.uniform(0.0, 1.0) * WIDE, random.uniform(-0.4, 0.1) * LONG, height);
        const double heading = random.uniform(-0.3, 0.3);
        const Vec3d to = eye + Vec3d(std::sin(heading), std::cos(heading), -random.uniform(0.2, 0.7)) * 1e4;
        viewer().getCamera()->setViewMatrixAsLookAt(eye, to, Vec3d(0.0, 0.0, 1.0));
        viewer().getCamera()->setProjectionMatrixAsPerspective(40.0, static_cast<double>(WIDTH) / HEIGHT,
                                                               NEAR_PLANE, FAR_PLANE);
    }

    static osg::ref_ptr<EffectScene> makeScene(PerspectiveBend* bend, osg::Node* ground)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setGround(EffectScene::GroundDescription{EffectScene::PROJECTED, 0.0, 1000.0, 0});
        scene->addEffect(bend);
        scene->addChild(ground);
        return scene;
    }

    /// How many leaves of the last frame are divided, and how many are not.
    struct Leaves
    {
        int divided = 0, whole = 0;
    };
    Leaves leaves()
    {
        Leaves result;
        auto& renderer = dynamic_cast<osgViewer::Renderer&>(*viewer().getCamera()->getRenderer());
        for (int i = 0; i < 2; ++i)
        {
            osgUtil::RenderStage* stage =
                renderer.getSceneView(static_cast<unsigned int>(i))->getRenderStage();
            if (stage) count(*stage, result);
        }
        return result;
    }

    static osg::ref_ptr<PerspectiveBend> bendOf(int sample)
    {
        Random random(static_cast<std::uint64_t>(sample) + 1000);
        return makeBend(sample % 3, random);
    }

private:
    static void count(osgUtil::RenderBin& bin, Leaves& result)
    {
        for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        {
            for (const auto& leaf : graph->_leaves)
                ++(&PatchGeometry::originalOf(*leaf->_drawable) == leaf->_drawable ? result.whole
                                                                                   : result.divided);
        }
        for (const auto& [number, inner] : bin.getRenderBinList())
            count(*inner, result);
    }
};

/// Pixels in the middle of the ground, as another picture has it, that are open.
int holes(const std::vector<double>& picture, const std::vector<double>& other)
{
    constexpr int room = 12;
    int count = 0;
    for (int y = room; y + room < HEIGHT; ++y)
    {
        for (int x = room; x + room < WIDTH; ++x)
        {
            if (picture[static_cast<std::size_t>(y * WIDTH + x)] < HUGE_VAL) continue;
            bool inside = true;
            for (int i = -room; i <= room && inside; ++i)
                for (int j = -room; j <= room && inside; ++j)
                    inside = other[static_cast<std::size_t>((y + j) * WIDTH + x + i)] < HUGE_VAL;
            count += inside ? 1 : 0;
        }
    }
    return count;
}

/// Pixels whose color no pixel around them has in another picture, up to some levels.
int strangeColors(const osg::Image& picture, const osg::Image& other, int levels)
{
    int count = 0;
    for (int y = 1; y + 1 < HEIGHT; ++y)
    {
        for (int x = 1; x + 1 < WIDTH; ++x)
        {
            bool strange = false;
            for (int channel = 0; channel < 3; ++channel)
            {
                const auto at = [channel](const osg::Image& image, int column, int row)
                {
                    return static_cast<int>(image.data(static_cast<unsigned int>(column),
                                                       static_cast<unsigned int>(row))[channel]);
                };
                int low = 255, high = 0;
                for (int i = 0; i < 9; ++i)
                {
                    low = std::min(low, at(other, x + i % 3 - 1, y + i / 3 - 1));
                    high = std::max(high, at(other, x + i % 3 - 1, y + i / 3 - 1));
                }
                const int here = at(picture, x, y);
                strange = strange || here < low - levels || here > high + levels;
            }
            count += strange ? 1 : 0;
        }
    }
    return count;
}

} // namespace

TEST_F(Tessellation, TheOutlineOfACoarseGridIsThatOfOneSixteenTimesFiner)
{
    const int count = fullTest() ? 200 : 15;
    int coarseDiffers = 0, dividedParts = 0, wholeParts = 0;
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE("camera " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        const std::vector<double> heights = randomHeights(random);
        look(random);
        const auto distances = [&](const osg::ref_ptr<osg::Group>& ground, bool divided)
        {
            const osg::ref_ptr<PerspectiveBend> bend = bendOf(sample);
            bend->setTessellation(divided);
            const osg::ref_ptr<EffectScene> scene = makeScene(bend, ground);
            const osg::ref_ptr<VerticalExaggeration> higher = new VerticalExaggeration;
            higher->setFactor(2.0);
            if (sample % 5 == 4) scene->insertEffect(0, higher);
            return distancesOf(scene);
        };
        const osg::ref_ptr<osg::Group> ground =
            makeGround(heights, 1, static_cast<Primitives>(sample / 3 % 3));
        const std::vector<double> fine = distances(makeGround(heights, 16), false);
        const Strangers coarse = apart(distances(ground, false), fine);
        const Strangers divided = apart(distances(ground, true), fine);
        const Leaves parts = leaves();
        dividedParts += parts.divided;
        wholeParts += parts.whole;
        EXPECT_EQ(divided.outlines, 0) << "without tessellation " << coarse.outlines;
        // Behind a ridge ground may show for less than a pixel, in one of the two.
        EXPECT_LE(divided.depths, 6) << "without tessellation " << coarse.depths;
        coarseDiffers += coarse.outlines > 100 ? 1 : 0;
        RecordProperty("camera" + std::to_string(sample),
                       std::to_string(divided.outlines) + " for " + std::to_string(coarse.outlines));
    }
    // So that the test can fail.
    EXPECT_GE(coarseDiffers, count / 6);
    EXPECT_GT(dividedParts, count);
    EXPECT_GT(wholeParts, count / 2);
}

TEST_F(Tessellation, ClipPlanesCutTheGroundWhereItLies)
{
    Random random(7);
    const std::vector<double> heights = randomHeights(random);
    look(random);
    const auto distances = [&](unsigned int parts, bool divided, bool cut)
    {
        const osg::ref_ptr<PerspectiveBend> bend = bendOf(0);
        bend->setTessellation(divided);
        const osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        if (cut) clip->addClipPlane(new osg::ClipPlane(0, 0.8, -0.6, 0.0, 0.25 * LONG));
        clip->addChild(makeGround(heights, parts));
        return distancesOf(makeScene(bend, clip));
    };
    const std::vector<double> fine = distances(16, false, true);
    EXPECT_EQ(apart(distances(1, true, true), fine).outlines, 0);
    EXPECT_GT(leaves().divided, 0);
    EXPECT_GT(apart(distances(1, true, false), fine).outlines, 1000);
}

TEST_F(Tessellation, NoCrackOpens)
{
    // With few parts, so that edges that do not agree are far apart.
    const int count = fullTest() ? 200 : 12;
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE("camera " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        const std::vector<double> heights = randomHeights(random);
        look(random);
        const std::vector<double> fine = distancesOf(makeScene(bendOf(sample), makeGround(heights, 16)));
        const osg::ref_ptr<PerspectiveBend> bend = bendOf(sample);
        bend->setTessellation(true);
        bend->setTessellationPixels(6.0);
        EXPECT_EQ(holes(distancesOf(makeScene(bend, makeGround(heights, 1))), fine), 0);
        // In frames of their own, of which floats differ: OpenGL leaves a pixel open here and there, divided or not.
        EXPECT_LE(holes(distancesOf(makeScene(bend, makeGround(heights, 1, INDICES, true))), fine), 3);
    }
}

TEST_F(Tessellation, ManyTrianglesWithManyPartsAreAllDrawn)
{
    Random random(7);
    const std::vector<double> heights = randomHeights(random);
    look(random);
    const std::vector<double> fine = distancesOf(makeScene(bendOf(7), makeGround(heights, 16)));
    const osg::ref_ptr<osg::Group> ground = makeGround(heights, 1);
    for (unsigned int row = 0; row < ground->getNumChildren(); ++row)
    {
        // Behind the first one, drawn a thousand times.
        auto& corners =
            dynamic_cast<osg::DrawElementsUInt&>(*ground->getChild(row)->asGeometry()->getPrimitiveSet(0));
        const std::vector<unsigned int> all(corners.begin(), corners.end());
        for (int i = 0; i < 1000; ++i)
            corners.insert(corners.begin(), all.begin(), all.begin() + 3);
    }
    const osg::ref_ptr<PerspectiveBend> bend = bendOf(7);
    bend->setTessellation(true);
    bend->setTessellationPixels(0.1);
    const Strangers found = apart(distancesOf(makeScene(bend, ground)), fine);
    EXPECT_EQ(found.outlines, 0);
    EXPECT_LE(found.depths, 6);
}

TEST_F(Tessellation, ColorsLightTexturesFogAndStylesAreThoseOfTheFineGrid)
{
    const int count = fullTest() ? 60 : 6;
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE("camera " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        const std::vector<double> heights(POSTS * POSTS, 0.0);
        look(random);
        std::vector<osg::ref_ptr<osg::Image>> pictures;
        for (const bool divided : {false, true})
        {
            const osg::ref_ptr<osg::Group> ground = makeGround(heights, divided ? 1 : 16, DRESSED);
            osg::StateSet& state = *ground->getOrCreateStateSet();
            const osg::ref_ptr<osg::Material> material = new osg::Material;
            material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
            state.setAttribute(material);
            state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
            state.setMode(GL_LIGHT0, osg::StateAttribute::ON);
            const osg::ref_ptr<osg::Image> image = new osg::Image;
            image->allocateImage(2, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
            for (unsigned int i = 0; i < 16; ++i)
                image->data()[i] = static_cast<unsigned char>(i % 4 == 3 ? 255 : 97 * i % 256);
            state.setTextureAttributeAndModes(0, smoothTexture(image));
            const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
            fog->setMode(osg::Fog::LINEAR);
            fog->setColor({0.3f, 0.5f, 0.8f, 1.0f});
            fog->setEnd(2e5f);
            state.setAttributeAndModes(fog);
            const osg::ref_ptr<PerspectiveBend> bend = bendOf(sample);
            bend->setTessellation(divided);
            bend->setContextSaturation(0.0);
            bend->setContextBrightness(1.3);
            pictures.push_back(render(makeScene(bend, ground)));
        }
        EXPECT_LE(strangeColors(*pictures[1], *pictures[0], 3), 10);
        EXPECT_LE(strangeColors(*pictures[0], *pictures[1], 3), 10);
    }
}

TEST_F(Tessellation, CullingChangesNoPixel)
{
    const int count = fullTest() ? 200 : 12;
    int culled = 0;
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE("camera " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        const std::vector<double> heights = randomHeights(random);
        look(random);
        const osg::ref_ptr<PerspectiveBend> bend = bendOf(sample);
        bend->setTessellation(true);
        const osg::ref_ptr<EffectScene> scene =
            makeScene(bend, makeGround(heights, 1, INDICES, sample % 2 == 0));
        // So narrow a picture that parts lie outside.
        viewer().getCamera()->setProjectionMatrixAsPerspective(
            random.uniform(4.0, 20.0), static_cast<double>(WIDTH) / HEIGHT, NEAR_PLANE, FAR_PLANE);
        const osg::ref_ptr<osg::Image> with = render(scene);
        const Leaves drawn = leaves();
        scene->setCompensation(false);
        viewer().getCamera()->setCullingMode(osg::CullSettings::NO_CULLING);
        EXPECT_TRUE(imagesMatch(*with, *render(scene), {}));
        const Leaves all = leaves();
        culled += all.divided - drawn.divided;
        EXPECT_EQ(all.divided + all.whole, static_cast<int>(POSTS) - 1);
        viewer().getCamera()->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
    }
    EXPECT_GT(culled, 0);
}

TEST_F(Tessellation, IsOffByDefaultAndThenNothingIsDivided)
{
    Random random(2);
    const std::vector<double> heights = randomHeights(random);
    look(random);
    const osg::ref_ptr<PerspectiveBend> bend = bendOf(2);
    const osg::ref_ptr<EffectScene> scene = makeScene(bend, makeGround(heights, 1));
    const osg::ref_ptr<osg::Image> without = render(scene);
    EXPECT_EQ(leaves().divided, 0);
    bend->setTessellation(true);
    render(scene);
    EXPECT_GT(leaves().divided, 0);
    // A context of old, in another window.
    bend->meetContext(3.3f);
    EXPECT_TRUE(imagesMatch(*without, *render(scene), {}));
    EXPECT_EQ(leaves().divided, 0);
}

TEST_F(Tessellation, LeavesAloneWhatHasMoreThanPlainTriangles)
{
    Random random(2);
    const std::vector<double> heights = randomHeights(random);
    look(random);
    const osg::ref_ptr<PerspectiveBend> bend = bendOf(2);
    struct Drawn : public osg::Drawable::DrawCallback
    {
        void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
        {
            drawable->drawImplementation(info);
        }
    };
    const std::vector<std::pair<const char*, std::function<void(osg::Geometry&)>>> cases = {
        {"lines",
         [](osg::Geometry& geometry)
         {
             geometry.addPrimitiveSet(new osg::DrawArrays(GL_LINE_STRIP, 0, 10));
         }},
        {"instances",
         [](osg::Geometry& geometry)
         {
             geometry.getPrimitiveSet(0)->setNumInstances(2);
         }},
        {"a draw callback",
         [](osg::Geometry& geometry)
         {
             geometry.setDrawCallback(new Drawn);
         }},
        {"a program of its own",
         [](osg::Geometry& geometry)
         {
             const osg::ref_ptr<osg::Program> program = new osg::Program;
             program->addShader(new osg::Shader(osg::Shader::VERTEX,
                                                "#version 330 compatibility\n"
                                                "vec4 geofx_vertex(vec4 eye);\n"
                                                "void main() {\n"
                                                "    gl_FrontColor = gl_Color;\n"
                                                "    gl_Position = gl_ProjectionMatrix * "
                                                "geofx_vertex(gl_ModelViewMatrix * gl_Vertex);\n}\n"));
             program->addShader(
                 new osg::Shader(osg::Shader::FRAGMENT,
                                 "#version 330 compatibility\n"
                                 "vec4 geofx_fragment(vec4 color, vec4 map);\n"
                                 "void main() { gl_FragColor = geofx_fragment(gl_Color, vec4(0.0)); }\n"));
             EffectScene::addFunctions(*program);
             geometry.getOrCreateStateSet()->setAttribute(program);
         }},
    };
    for (const auto& [what, change] : cases)
    {
        SCOPED_TRACE(what);
        const osg::ref_ptr<osg::Group> ground = makeGround(heights, 1);
        for (unsigned int i = 0; i < ground->getNumChildren(); ++i)
            change(*ground->getChild(i)->asGeometry());
        const osg::ref_ptr<EffectScene> scene = makeScene(bend, ground);
        bend->setTessellation(false);
        const osg::ref_ptr<osg::Image> without = render(scene);
        bend->setTessellation(true);
        EXPECT_TRUE(imagesMatch(*without, *render(scene), {}));
        EXPECT_EQ(leaves().divided, 0);
    }
}

TEST_F(Tessellation, GeometryThatChangesIsDividedAsItIs)
{
    Random random(2);
    look(random);
    const osg::ref_ptr<PerspectiveBend> bend = bendOf(2);
    bend->setTessellation(true);
    const osg::ref_ptr<osg::Group> ground = makeGround(randomHeights(random), 1);
    const osg::ref_ptr<EffectScene> scene = makeScene(bend, ground);
    const osg::ref_ptr<osg::Image> whole = render(scene);
    for (unsigned int row = 0; row < ground->getNumChildren(); ++row)
    {
        const osg::Geometry& geometry = *ground->getChild(row)->asGeometry();
        ASSERT_EQ(geometry.getNumPrimitiveSets(), 1u);
        auto& corners = const_cast<osg::DrawElementsUInt&>(
            dynamic_cast<const osg::DrawElementsUInt&>(*geometry.getPrimitiveSet(0)));
        EXPECT_EQ(corners.getMode(), static_cast<GLenum>(GL_TRIANGLES)) << "the application's stays as it is";
        corners.resize(corners.size() / 2);
        corners.dirty();
    }
    const osg::ref_ptr<osg::Image> half = render(scene);
    EXPECT_FALSE(imagesMatch(*whole, *half, {}));
    // As if it had been so from the beginning.
    EXPECT_TRUE(imagesMatch(*half, *render(makeScene(bend, ground)), {}));
    for (unsigned int row = 0; row < ground->getNumChildren(); ++row)
        ground->getChild(row)->getOrCreateStateSet()->setAttribute(
            new osg::ColorMask(true, false, true, true));
    const osg::ref_ptr<osg::Image> masked = render(scene);
    EXPECT_FALSE(imagesMatch(*half, *masked, {}));
    scene->setCompensation(false);
    EXPECT_TRUE(imagesMatch(*masked, *render(scene), {}));
    EXPECT_TRUE(imagesMatch(*masked, *render(makeScene(bend, ground)), {}));
}

TEST_F(Tessellation, PickingFindsWhatIsDrawn)
{
    const int cameras = fullTest() ? 60 : 10, pixels = 40;
    int checked = 0, chords = 0;
    for (int sample = 0; sample < cameras; ++sample)
    {
        SCOPED_TRACE("camera " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        const std::vector<double> heights = randomHeights(random);
        look(random);
        const osg::ref_ptr<PerspectiveBend> bend = bendOf(sample);
        bend->setTessellation(true);
        bend->setTessellationPixels(0.1);
        const osg::ref_ptr<EffectScene> scene = makeScene(bend, makeGround(heights, 1));
        const std::vector<double> drawn = distancesOf(scene);
        const DeformedView view(*scene, *viewer().getCamera());
        bend->setTessellation(false);
        const DeformedView coarse(*scene, *viewer().getCamera());
        bend->setTessellation(true);
        for (int i = 0; i < pixels; ++i)
        {
            const int x = random.integer(1, WIDTH - 2), y = random.integer(1, HEIGHT - 2);
            const double there = drawn[static_cast<std::size_t>(y * WIDTH + x)];
            // Half a pixel around, and where an outline is near nothing is said.
            const auto range = [&](const DeformedView& picture, double& low, double& high)
            {
                low = HUGE_VAL;
                high = 0.0;
                for (int k = 0; k < 9; ++k)
                {
                    const auto hit = picture.pick(x + 0.5 * (k % 3), y + 0.5 * (k / 3));
                    if (!hit) return false;
                    low = std::min(low, -hit->deformed.z());
                    high = std::max(high, -hit->deformed.z());
                }
                return true;
            };
            double low = 0.0, high = 0.0;
            if (there == HUGE_VAL || !range(view, low, high)) continue;
            const double style = view.chain().style(view.pick(x + 0.5, y + 0.5)->world * view.modelView());
            if (!(style > 0.0 && style < 1.0)) continue;
            // The depth buffer's 24 bits, and less than half a pixel along the line of sight.
            const double slack = there * there / NEAR_PLANE * 3e-7 + 0.4 * PIXEL * there;
            EXPECT_GE(there, low - slack) << "pixel " << x << ' ' << y;
            EXPECT_LE(there, high + slack) << "pixel " << x << ' ' << y;
            ++checked;
            if (range(coarse, low, high)) chords += there < low - slack || there > high + slack ? 1 : 0;
        }
    }
    EXPECT_GT(checked, cameras * pixels / 20);
    EXPECT_GT(chords, checked / 10) << "picking of chords fails, so that the test can";
}
