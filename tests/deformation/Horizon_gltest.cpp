// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The bird's-eye view keeps its word in the picture: the context's horizon lies at horizonLine, and below focusLine nothing
// changes. Measured in pixels of what was drawn.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/RandomSamples.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Triangles that reach over the focus line reach that many rows below it.
constexpr int LINE_ROWS = 4;
constexpr int WIDTH = 320, HEIGHT = 240;

/// A camera over the plane z = 0 with a bend that serves it.
struct Shot
{
    osg::ref_ptr<BirdsEyeView> effect = new BirdsEyeView;
    osg::Vec3d eye;
    osg::Matrixd view;
    osg::Matrixd projection;
    int width = 0;
    int height = 0;

    /// Of the ray through a line of the picture's middle column, below level ground, radians; 0…π.
    double depression(double line) const
    {
        osg::Matrixd back;
        back.invert(view * projection);
        osg::Vec3d direction = osg::Vec3d(0.0, 2.0 * line - 1.0, 1.0) * back - eye;
        direction.normalize();
        const osg::Vec3d right = osg::Matrixd::transform3x3(view, osg::Vec3d(1.0, 0.0, 0.0));
        osg::Vec3d forward = osg::Vec3d(0.0, 0.0, 1.0) ^ osg::Vec3d(right.x(), right.y(), 0.0);
        forward.normalize();
        return std::atan2(-direction.z(), direction * forward);
    }

    osg::Vec2d pixel(const osg::Vec4d& homogeneous) const
    {
        const osg::Vec4d clip = homogeneous * view * projection;
        return {(clip.x() / clip.w() + 1.0) / 2.0 * width, (clip.y() / clip.w() + 1.0) / 2.0 * height};
    }

    /// The row in which a column has the horizon: on the line of the picture that goes through horizonLine in the middle
    /// and to where the bend's axis, which is level, vanishes. For an unrolled camera that is everywhere horizonLine.
    double expectedRow(double column) const
    {
        const double middle = effect->getHorizonLine() * height;
        const osg::Vec3d ahead = osg::Matrixd::transform3x3(view, osg::Vec3d(0.0, 0.0, -1.0));
        const osg::Vec4d clip = osg::Vec4d(ahead.y(), -ahead.x(), 0.0, 0.0) * view * projection;
        // The line through (0, line, 1) and clip, in the picture's homogeneous coordinates.
        const osg::Vec3d here(0.0, 2.0 * effect->getHorizonLine() - 1.0, 1.0);
        const osg::Vec3d line = here ^ osg::Vec3d(clip.x(), clip.y(), clip.w());
        const double x = 2.0 * column / width - 1.0;
        const double y = -(line.x() * x + line.z()) / line.y();
        return std::abs(line.x()) < 1e-12 ? middle : (y + 1.0) / 2.0 * height;
    }
};

Shot randomShot(Random& random, bool rolled)
{
    Shot shot;
    double horizon = 0.0;
    double focus = 0.0;
    double reach = 0.0; ///< from the line b to the axis
    // Cameras beyond these limits the bend does not serve, or not in full: so in a bend sharper than a few metres.
    do
    {
        shot.width = random.integer(120, WIDTH);
        shot.height = random.integer(90, HEIGHT);
        BirdsEyeView& effect = *shot.effect;
        effect.setFocusLine(0.0);
        effect.setHorizonLine(random.uniform(0.3, 0.93));
        effect.setFocusLine(random.uniform(0.0, 0.95) * effect.getHorizonLine());
        effect.setCurve(static_cast<PerspectiveBend::Curve>(random.integer(0, 2)));
        effect.setContextTilt(random.integer(0, 3) ? random.uniform(0.02, 0.9) : 0.0);
        const double half = std::tan(random.uniform(0.2, 1.6) / 2.0);
        const double aspect = static_cast<double>(shot.width) / shot.height;
        const bool offAxis = random.integer(0, 1) != 0;
        const double x = offAxis ? random.uniform(-0.8, 0.8) * half * aspect : 0.0;
        const double y = offAxis ? random.uniform(-0.8, 0.8) * half : 0.0;
        shot.projection =
            osg::Matrixd::frustum(x - half * aspect, x + half * aspect, y - half, y + half, 1.0, 1e9);
        shot.eye = {random.uniform(-1e5, 1e5), random.uniform(-1e5, 1e5), random.logarithmic(20.0, 3000.0)};
        // A rolled camera that looks straight down has no direction square to the view.
        const double pitch = random.uniform(rolled ? -1.2 : -1.4, 0.2);
        const double roll = rolled ? random.uniform(-0.6, 0.6) : 0.0;
        shot.view = osg::Matrixd::translate(-shot.eye) *
                    osg::Matrixd::rotate(random.uniform(0.0, 2.0 * osg::PI), osg::Vec3d(0, 0, 1)) *
                    osg::Matrixd::rotate(-osg::PI_2 - pitch, osg::Vec3d(1, 0, 0)) *
                    osg::Matrixd::rotate(roll, osg::Vec3d(0, 0, 1));
        horizon = shot.depression(shot.effect->getHorizonLine());
        focus = shot.depression(shot.effect->getFocusLine());
        reach = shot.eye.z() * (1.0 / std::tan(horizon) - 1.0 / std::tan(focus)) *
                (1.0 - effect.getContextTilt());
    } while (horizon < 0.035 || horizon > 1.5 || focus < horizon || focus > 2.8 || reach < 20.0);
    return shot;
}

osg::ref_ptr<osg::Geometry> makeWhite(osg::Vec3Array* vertices, osg::DrawElementsUInt* triangles)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    white->push_back(osg::Vec4(1, 1, 1, 1));
    geometry->setColorArray(white);
    geometry->addPrimitiveSet(triangles);
    // Each camera's own; a buffer object would be used again, of which Mesa complains.
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(false);
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    return geometry;
}

/// A grid of rows, each closed to a ring.
osg::ref_ptr<osg::Geometry> makeRings(const std::vector<std::pair<double, double>>& radiiAndHeights)
{
    constexpr unsigned int sectors = 96;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int row = 0; row < radiiAndHeights.size(); ++row)
    {
        const auto& [radius, z] = radiiAndHeights[row];
        for (unsigned int i = 0; i < sectors; ++i)
        {
            const double angle = 2.0 * osg::PI * i / sectors;
            vertices->push_back(osg::Vec3d(radius * std::cos(angle), radius * std::sin(angle), z));
            if (row == 0) continue;
            const unsigned int a = (row - 1) * sectors + i;
            const unsigned int b = (row - 1) * sectors + (i + 1) % sectors;
            for (const unsigned int index : {a, b, a + sectors, b, b + sectors, a + sectors})
                triangles->push_back(index);
        }
    }
    return makeWhite(vertices, triangles);
}

/// The plane around the eye's foot, so far that what lies beyond is less than a fifth of a pixel: the context's plane lies
/// at most the eye's height below the horizon's ray, and a pixel is at least 1/1200 of its distance.
osg::ref_ptr<osg::Geometry> makePlane(double eyeHeight)
{
    std::vector<std::pair<double, double>> rings;
    const double reach = std::max(1e6, 2e4 * eyeHeight);
    for (int i = 0; i <= 200; ++i)
        rings.emplace_back(0.02 * eyeHeight * std::pow(reach / (0.02 * eyeHeight), i / 200.0), 0.0);
    return makeRings(rings);
}

/// Without a tilt the context's plane is seen from its edge and covers no pixel. What stands on it shows where it is: a fence
/// around the eye, far behind every zone. Its foot is the horizon line, and it is some ten pixels high.
osg::ref_ptr<osg::Geometry> makeFence(const Shot& shot)
{
    const double radius = 1000.0 * shot.eye.z();
    const double pixel = 2.0 / shot.projection(1, 1) / shot.height;
    return makeRings({{radius, 0.0}, {radius, 10.0 * pixel * radius}});
}

int rowOf(const osg::Image& image, int column, bool top)
{
    const int height = image.t();
    for (int i = 0; i < height; ++i)
    {
        const int row = top ? height - 1 - i : i;
        if (*image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row)) > 127) return row;
    }
    return -1;
}

struct Measured
{
    int columns = 0;
    double worst = 0.0;
    double slope = 0.0; ///< rows per column, from the first to the last
};

class Horizon : public GlFixture
{
protected:
    Horizon() : GlFixture(WIDTH, HEIGHT) {}

    Measured measure(const Shot& shot)
    {
        const bool edge = shot.effect->getContextTilt() == 0.0;
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setTerrainFrame(EffectScene::PROJECTED);
        scene->addEffect(shot.effect);
        osg::ref_ptr<osg::MatrixTransform> foot =
            new osg::MatrixTransform(osg::Matrixd::translate(shot.eye.x(), shot.eye.y(), 0.0));
        foot->addChild(edge ? makeFence(shot) : makePlane(shot.eye.z()));
        scene->addChild(foot);
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setViewport(0, 0, shot.width, shot.height);
        camera.setProjectionMatrix(shot.projection);
        camera.setViewMatrix(shot.view);
        const osg::ref_ptr<osg::Image> image = render(scene);
        Measured result;
        double first = 0.0;
        double firstColumn = -1.0;
        for (int i = 0; i <= 16; ++i)
        {
            const int column = std::min(shot.width - 1, i * shot.width / 16);
            const double expected = shot.expectedRow(column + 0.5);
            if (expected < 1.0 || expected > shot.height - 14.0) continue;
            const int row = rowOf(*image, column, !edge);
            if (row < 0)
            {
                ADD_FAILURE() << "column " << column << " is black";
                continue;
            }
            // The border of what is drawn lies between the middles of two rows.
            const double measured = edge ? row : row + 1.0;
            const double slope = shot.expectedRow(column + 1.5) - expected;
            result.worst = std::max(result.worst, std::abs(measured - expected) / std::hypot(1.0, slope));
            ++result.columns;
            if (firstColumn < 0.0)
            {
                first = measured;
                firstColumn = column;
            }
            else
            {
                result.slope = (measured - first) / (column - firstColumn);
            }
        }
        return result;
    }
};

} // namespace

TEST_F(Horizon, LiesAtItsLine)
{
    const int cameras = 200;
    double worst = 0.0;
    int columns = 0;
    int edges = 0;
    for (int i = 0; i < cameras; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const Shot shot = randomShot(random, false);
        SCOPED_TRACE("camera " + std::to_string(i));
        EXPECT_NEAR(shot.expectedRow(0.0), shot.effect->getHorizonLine() * shot.height, 1e-6);
        const Measured measured = measure(shot);
        EXPECT_LE(measured.worst, 1.0) << "contextTilt " << shot.effect->getContextTilt() << ", curve "
                                       << shot.effect->getCurve() << ", eye " << shot.eye.z() << " m";
        worst = std::max(worst, measured.worst);
        columns += measured.columns;
        edges += shot.effect->getContextTilt() == 0.0 ? 1 : 0;
    }
    std::cout << columns << " columns of " << cameras << " cameras, " << edges << " seen edge-on, worst "
              << worst << " pixels\n";
    EXPECT_GT(columns, 14 * cameras);
    EXPECT_GT(edges, cameras / 8);
}

TEST_F(Horizon, RollsWithTheCamera)
{
    const int cameras = 60;
    double worst = 0.0;
    double worstTurn = 0.0;
    int columns = 0;
    for (int i = 0; i < cameras; ++i)
    {
        Random random(static_cast<std::uint64_t>(i) + 500);
        const Shot shot = randomShot(random, true);
        SCOPED_TRACE("camera " + std::to_string(i));
        const Measured measured = measure(shot);
        EXPECT_LE(measured.worst, 1.0) << "contextTilt " << shot.effect->getContextTilt();
        worst = std::max(worst, measured.worst);
        columns += measured.columns;
        if (measured.columns < 12) continue;
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), shot.view);
        const double roll = std::atan2(-up.x(), up.y());
        const double turn = std::atan(measured.slope);
        const osg::Matrixd& p = shot.projection;
        const double natural = std::atan(std::tan(roll) * p(1, 1) / p(0, 0) * shot.height / shot.width);
        worstTurn = std::max(worstTurn, std::abs(turn - natural));
        // Two pixels over the columns that were measured.
        EXPECT_NEAR(turn, natural, 0.03) << "roll " << roll;
    }
    std::cout << columns << " columns of " << cameras << " cameras, worst " << worst
              << " pixels; turned from the natural horizon by " << worstTurn << " at most\n";
    EXPECT_GT(columns, 6 * cameras);
}

TEST_F(Horizon, BelowTheFocusLineNothingChanges)
{
    const std::optional<Scene> oahu = loadOahu("oahu_projected");
    if (!oahu) return;
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    const osg::ref_ptr<PedestrianView> farAway = new PedestrianView;
    farAway->setFocusDistance(1e7);
    oahu->effects->addEffect(farAway);
    const int cameras = fullTest() ? 100 : 6;
    std::size_t pixels = 0;
    std::size_t deformedPixels = 0;
    std::size_t differingPixels = 0;
    for (int i = 0; i < cameras; ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i) + 900);
        Shot shot;
        do
        {
            shot = randomShot(random, false);
        } while (shot.effect->getFocusLine() < 0.15);
        ViewPoint point;
        point.longitude = osg::DegreesToRadians(random.uniform(-158.2, -157.7));
        point.latitude = osg::DegreesToRadians(random.uniform(21.3, 21.7));
        point.height = random.logarithmic(1500.0, 15000.0);
        point.heading = random.uniform(0.0, 2.0 * osg::PI);
        point.pitch = std::asin(osg::Matrixd::transform3x3(shot.view, osg::Vec3d(0.0, 0.0, -1.0)).z());
        osg::Matrixd view;
        ASSERT_TRUE(point.viewMatrix(*oahu->reference, view));
        const double scale = 20.0;
        double left = 0.0;
        double right = 0.0;
        double bottom = 0.0;
        double top = 0.0;
        double near = 0.0;
        double far = 0.0;
        ASSERT_TRUE(shot.projection.getFrustum(left, right, bottom, top, near, far));
        const osg::Matrixd projection =
            osg::Matrixd::frustum(left * scale, right * scale, bottom * scale, top * scale, scale, 3e5);
        oahu->effects->addEffect(shot.effect);
        farAway->setEnabled(false);
        harness.setCamera(view, projection);
        harness.camera().setLODScale(1.0f);
        // Triangles that are longer than the zone is wide reach from it into the focus.
        while (CullHarness::load(harness.frame(true, false).requests, random, 1.0) > 0)
            continue;
        // The finest that is there, for all pictures alike, whatever the effect asks for.
        harness.camera().setLODScale(1e-9f);
        const Culled bent = harness.frame(true);
        shot.effect->setEnabled(false);
        const Culled plain = harness.frame(true);
        farAway->setEnabled(true);
        const Culled shaded = harness.frame(true);
        oahu->effects->removeEffect(shot.effect);

        const int rows = static_cast<int>(std::floor(shot.effect->getFocusLine() * HEIGHT));
        // The same triangles in the same shaders give the same bytes, but for those that reach over the focus line. OSG's
        // fixed functions may round a color in another way.
        std::size_t differing = 0;
        std::size_t differingAtLine = 0;
        int most = 0;
        int mostAtLine = 0;
        for (int row = 0; row < HEIGHT; ++row)
        {
            for (int column = 0; column < WIDTH; ++column)
            {
                const auto x = static_cast<unsigned int>(column);
                const auto y = static_cast<unsigned int>(row);
                const unsigned char* a = bent.image->data(x, y);
                const unsigned char* b = shaded.image->data(x, y);
                const unsigned char* c = plain.image->data(x, y);
                const bool atLine = row >= rows - LINE_ROWS;
                if (!std::equal(a, a + 3, b))
                    ++(row >= rows ? deformedPixels : atLine ? differingAtLine : differing);
                int& worst = atLine ? mostAtLine : most;
                for (int channel = 0; channel < 3 && row < rows; ++channel)
                    worst = std::max(worst, std::abs(a[channel] - c[channel]));
            }
        }
        EXPECT_LE(most, 1);
        EXPECT_EQ(differing, 0u) << rows << " rows";
        EXPECT_LE(mostAtLine, 4);
        EXPECT_LE(differingAtLine, static_cast<std::size_t>(LINE_ROWS * WIDTH) / 20);
        differing += differingAtLine;
        differingPixels += differing;
        pixels += static_cast<std::size_t>(rows * WIDTH);
    }
    std::cout << differingPixels << " of " << pixels << " pixels below the focus line differ by a level, "
              << deformedPixels << " above it are others\n";
    EXPECT_GT(deformedPixels, pixels / 10);
}
