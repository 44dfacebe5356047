// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Coarse ground whose triangles the GPU divides in the zone of a bend, against the same ground with 256 triangles for each: outlines,
// distances, seams between parts that are divided and others, culling, picking.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>

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
    ARRAYS
};

/// A triangle mesh over some cells of the coarse ground, whose triangles have `parts` parts along each side.
osg::ref_ptr<osg::Geometry> makePart(const std::vector<double>& heights, unsigned int parts,
                                     unsigned int from, unsigned int to, Primitives primitives,
                                     const Vec3d& origin)
{
    const unsigned int posts = (POSTS - 1) * parts + 1;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
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
    if (primitives == INDICES) geometry->addPrimitiveSet(corners);
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
    geometry->setUseVertexBufferObjects(true);
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

class Tessellation : public GlFixture
{
protected:
    Tessellation() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
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

    /// Distances before the eye, metres; HUGE_VAL where nothing is drawn.
    std::vector<double> distancesOf(osg::Node* node)
    {
        const osg::ref_ptr<ImageCapture> capture =
            ImageCapture::attach(viewer().getCamera(), ImageCapture::Format::DepthFloat);
        capture->request();
        render(node);
        const osg::ref_ptr<osg::Image> image = capture->take();
        capture->detach(viewer().getCamera());
        std::vector<double> distances;
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
        {
            const auto depth = static_cast<double>(reinterpret_cast<const float*>(image->data())[i]);
            const double ndc = 2.0 * depth - 1.0;
            distances.push_back(depth >= 1.0 ? HUGE_VAL
                                             : 2.0 * FAR_PLANE * NEAR_PLANE /
                                                   (FAR_PLANE + NEAR_PLANE - ndc * (FAR_PLANE - NEAR_PLANE)));
        }
        return distances;
    }

    /// Pixels of one picture of which nothing like it lies within a pixel in the other.
    struct Strangers
    {
        int outlines = 0; ///< ground where the other has none, or none where it has ground
        int depths = 0;
    };
    static Strangers strangers(const std::vector<double>& picture, const std::vector<double>& other)
    {
        Strangers result;
        for (int y = 1; y + 1 < HEIGHT; ++y)
        {
            for (int x = 1; x + 1 < WIDTH; ++x)
            {
                const double here = picture[static_cast<std::size_t>(y * WIDTH + x)];
                double low = HUGE_VAL, high = 0.0;
                bool open = false;
                for (int i = 0; i < 9; ++i)
                {
                    const double there =
                        other[static_cast<std::size_t>((y + i / 3 - 1) * WIDTH + x + i % 3 - 1)];
                    open = open || there == HUGE_VAL;
                    if (there == HUGE_VAL) continue;
                    low = std::min(low, there);
                    high = std::max(high, there);
                }
                if (here == HUGE_VAL ? !open : low == HUGE_VAL)
                    ++result.outlines;
                else if (here < HUGE_VAL &&
                         !(here >= low * (1.0 - PIXEL) && (open || here <= high * (1.0 + PIXEL))))
                    ++result.depths;
            }
        }
        return result;
    }
    /// In either direction.
    static Strangers apart(const std::vector<double>& one, const std::vector<double>& other)
    {
        const Strangers a = strangers(one, other), b = strangers(other, one);
        return {a.outlines + b.outlines, a.depths + b.depths};
    }

    std::vector<double> distancesOf(int kind, int sample, const osg::ref_ptr<osg::Group>& ground,
                                    bool divided)
    {
        Random random(static_cast<std::uint64_t>(sample) + 1000);
        const osg::ref_ptr<PerspectiveBend> bend = makeBend(kind, random);
        bend->setTessellation(divided);
        return distancesOf(makeScene(bend, ground));
    }
};

} // namespace

TEST_F(Tessellation, TheOutlineOfACoarseGridIsThatOfOneSixteenTimesFiner)
{
    const int count = fullTest() ? 60 : 4;
    int coarseDiffers = 0;
    for (int sample = 0; sample < 3 * count; ++sample)
    {
        SCOPED_TRACE("camera " + std::to_string(sample));
        const int kind = sample % 3;
        Random random(static_cast<std::uint64_t>(sample));
        const std::vector<double> heights = randomHeights(random);
        look(random);
        const auto primitives = static_cast<Primitives>(sample / 3 % 3);
        const osg::ref_ptr<osg::Group> ground = makeGround(heights, 1, primitives);
        const std::vector<double> fine = distancesOf(kind, sample, makeGround(heights, 16), false);
        const Strangers divided = apart(distancesOf(kind, sample, ground, true), fine);
        const Strangers coarse = apart(distancesOf(kind, sample, ground, false), fine);
        EXPECT_EQ(divided.outlines, 0) << "without tessellation " << coarse.outlines;
        // Behind a ridge ground may show for less than a pixel, in one of the two.
        EXPECT_LE(divided.depths, 6) << "without tessellation " << coarse.depths;
        coarseDiffers += coarse.outlines > 20 ? 1 : 0;
        RecordProperty("camera" + std::to_string(sample),
                       std::to_string(divided.outlines) + " for " + std::to_string(coarse.outlines));
    }
    // So that the test can fail.
    EXPECT_GT(coarseDiffers, count / 2);
}
