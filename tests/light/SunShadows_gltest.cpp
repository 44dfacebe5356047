// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures of SunShadows against rays from what picking finds at a pixel to the sun, through the formulas of the ground and of boxes.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/GlFixture.h>
#include <tools/PlainView.h>
#include <tools/SampledCases.h>

#include <osg/ClusterCullingCallback>
#include <osg/ContextData>
#include <osg/GLObjects>
#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Switch>
#include <osgDB/DatabasePager>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 160;
constexpr double HALF = 800.0; ///< metres, of the ground
constexpr int CELLS = 64;      ///< across it
constexpr double CELL = 2.0 * HALF / CELLS;
constexpr double pi = 3.14159265358979;
constexpr double rounding = 1e-3; ///< of colors that are mixed and those that are not, in the mean of 1/255

struct Box
{
    osg::Vec3d low, high;
};

/// Towers and a wall, on the ground's level.
const std::vector<Box> boxes = {{{-60.0, -250.0, -20.0}, {-30.0, -220.0, 90.0}},
                                {{40.0, -300.0, -20.0}, {70.0, -270.0, 60.0}},
                                {{-20.0, -330.0, -20.0}, {30.0, -326.0, 18.0}},
                                {{150.0, -40.0, -20.0}, {230.0, 10.0, 120.0}},
                                {{-220.0, 90.0, -20.0}, {-170.0, 150.0, 100.0}}};

double hillAt(double x, double y)
{
    return 110.0 * std::exp(-((x - 120.0) * (x - 120.0) / 90000.0 + (y - 330.0) * (y - 330.0) / 4900.0)) +
           3.0 * std::sin(x / 70.0) * std::cos(y / 50.0);
}

/// The height of the mesh, which has straight lines between the formula's posts.
double groundAt(double x, double y)
{
    const double column = std::floor((x + HALF) / CELL), row = std::floor((y + HALF) / CELL);
    const double left = column * CELL - HALF, low = row * CELL - HALF;
    const double u = (x - left) / CELL, v = (y - low) / CELL;
    static const std::vector<double> posts = []
    {
        std::vector<double> heights;
        for (int i = 0; i < (CELLS + 1) * (CELLS + 1); ++i)
            heights.push_back(hillAt(i % (CELLS + 1) * CELL - HALF, i / (CELLS + 1) * CELL - HALF));
        return heights;
    }();
    const auto first = static_cast<std::size_t>(row * (CELLS + 1) + column);
    const double a = posts[first], b = posts[first + 1], c = posts[first + CELLS + 1],
                 d = posts[first + CELLS + 2];
    return u > v ? a + u * (b - a) + v * (d - b) : a + v * (c - a) + u * (d - c);
}

osg::ref_ptr<osg::Geometry> meshOf(osg::Vec3Array* vertices, osg::Vec3Array* normals,
                                   osg::DrawElements* triangles)
{
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->setUseDisplayList(false);
    mesh->setUseVertexBufferObjects(false);
    mesh->setVertexArray(vertices);
    mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(1);
    white->front().set(1.0f, 1.0f, 1.0f, 1.0f);
    mesh->setColorArray(white, osg::Array::BIND_OVERALL);
    mesh->addPrimitiveSet(triangles);
    return mesh;
}

osg::ref_ptr<osg::Geometry> makeGround()
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int i = 0; i < (CELLS + 1) * (CELLS + 1); ++i)
    {
        const unsigned int column = i % (CELLS + 1), row = i / (CELLS + 1);
        const double x = column * CELL - HALF, y = row * CELL - HALF;
        vertices->push_back(osg::Vec3d(x, y, hillAt(x, y)));
        osg::Vec3d normal(hillAt(x - 1.0, y) - hillAt(x + 1.0, y), hillAt(x, y - 1.0) - hillAt(x, y + 1.0),
                          2.0);
        normal.normalize();
        normals->push_back(normal);
        if (column == CELLS || row == CELLS) continue;
        for (const unsigned int corner : {i, i + 1, i + CELLS + 2, i, i + CELLS + 2, i + CELLS + 1})
            triangles->push_back(corner);
    }
    return meshOf(vertices, normals, triangles);
}

osg::ref_ptr<osg::Geometry> makeBox(const Box& box)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int face = 0; face < 6; ++face)
    {
        const int axis = face / 2;
        const auto first = static_cast<unsigned int>(vertices->size());
        osg::Vec3d normal;
        normal[axis] = face % 2 ? 1.0 : -1.0;
        for (int corner = 0; corner < 4; ++corner)
        {
            osg::Vec3d place;
            place[axis] = face % 2 ? box.high[axis] : box.low[axis];
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            place[next] = corner & 1 ? box.high[next] : box.low[next];
            place[last] = corner & 2 ? box.high[last] : box.low[last];
            vertices->push_back(place);
            normals->push_back(normal);
        }
        for (const unsigned int corner : {0u, 1u, 3u, 0u, 3u, 2u})
            triangles->push_back(first + corner);
    }
    return meshOf(vertices, normals, triangles);
}

/// Whether a ray from a place to the sun meets anything.
bool isHidden(const osg::Vec3d& place, const osg::Vec3d& towards)
{
    for (const Box& box : boxes)
    {
        double begin = 0.0, end = 1e9;
        for (int axis = 0; axis < 3; ++axis)
        {
            double a = (box.low[axis] - place[axis]) / towards[axis];
            double b = (box.high[axis] - place[axis]) / towards[axis];
            if (a > b) std::swap(a, b);
            begin = std::max(begin, a);
            end = std::min(end, b);
        }
        if (end > begin) return true;
    }
    for (double way = 1.0; way < 1500.0; way += 1.0)
    {
        const osg::Vec3d at = place + towards * way;
        if (std::max(std::abs(at.x()), std::abs(at.y())) >= HALF - CELL || at.z() > 130.0) return false;
        if (at.z() < groundAt(at.x(), at.y())) return true;
    }
    return false;
}

osg::Vec3d toSun(double azimuth, double elevation)
{
    const double a = azimuth / 180.0 * pi, e = elevation / 180.0 * pi;
    return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

class SunShadowsTest : public GlFixture
{
protected:
    SunShadowsTest() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        usePlainView(viewer());
        build(osg::Matrixd());
    }

    /// The world in a frame; buildings below references of their own where `rigid`.
    void build(const osg::Matrixd& frame, bool rigid = false)
    {
        _frame = frame;
        osg::ref_ptr<osg::MatrixTransform> world = new osg::MatrixTransform(frame);
        world->addChild(makeGround());
        for (const Box& box : boxes)
        {
            osg::ref_ptr<osg::Group> parent = world;
            if (rigid)
            {
                const osg::Vec3d foot = (box.low + box.high) * 0.5;
                osg::ref_ptr<RigidReference> reference = new RigidReference;
                reference->setReference(osg::Vec3d(foot.x(), foot.y(), 0.0));
                world->addChild(reference);
                parent = reference;
            }
            parent->addChild(makeBox(box));
        }
        _world = world;
        _scene = new EffectScene;
        _scene->addEffect(_shadows);
        _scene->addChild(world);
        _root = new osg::Group;
        _root->addChild(_scene);
        _sun = new osg::LightSource;
        _sun->getLight()->setAmbient({0.3f, 0.3f, 0.3f, 1.0f});
        _sun->getLight()->setDiffuse({0.7f, 0.7f, 0.7f, 1.0f});
        _sun->getLight()->setSpecular({0.0f, 0.0f, 0.0f, 1.0f});
        _root->addChild(_sun);
        osg::StateSet& state = *_root->getOrCreateStateSet();
        state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
        state.setMode(GL_LIGHT0, osg::StateAttribute::ON);
        osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
        model->setAmbientIntensity({0.0f, 0.0f, 0.0f, 1.0f});
        state.setAttribute(model);
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
        state.setAttribute(material);
        _scene->setTerrainFrame(frame.isIdentity() ? EffectScene::PROJECTED : EffectScene::GEOCENTRIC);
        shineFrom(215.0, 32.0);
        look({-60.0, -620.0, 230.0}, {20.0, -120.0, 0.0});
    }

    void shineFrom(double azimuth, double elevation)
    {
        _towards = toSun(azimuth, elevation);
        _sun->getLight()->setPosition(osg::Vec4d(osg::Matrixd::transform3x3(_towards, _frame), 0.0));
    }

    void look(const osg::Vec3d& eye, const osg::Vec3d& at)
    {
        osg::Camera& camera = *viewer().getCamera();
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), _frame);
        camera.setViewMatrixAsLookAt(eye * _frame, at * _frame, up);
        camera.setProjectionMatrixAsPerspective(42.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 20000.0);
    }

    osg::ref_ptr<BirdsEyeView> bend()
    {
        osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
        view->setFocusLine(0.3);
        view->setHorizonLine(0.95);
        _scene->addEffect(view);
        return view;
    }

    osg::ref_ptr<osg::Image> draw() { return render(_root); }
    osg::ref_ptr<osg::Image> drawWithout()
    {
        _shadows->setEnabled(false);
        const osg::ref_ptr<osg::Image> image = draw();
        _shadows->setEnabled(true);
        return image;
    }
    osg::ref_ptr<osg::Image> drawUnlit()
    {
        const osg::Vec4 diffuse = _sun->getLight()->getDiffuse();
        _sun->getLight()->setDiffuse({0.0f, 0.0f, 0.0f, 1.0f});
        const osg::ref_ptr<osg::Image> image = draw();
        _sun->getLight()->setDiffuse(diffuse);
        return image;
    }

    static int redAt(const osg::Image& image, int x, int y)
    {
        return image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))[0];
    }
    static double meanDifference(const osg::Image& a, const osg::Image& b)
    {
        double sum = 0.0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
                sum += std::abs(redAt(a, x, y) - redAt(b, x, y));
        return sum / (WIDTH * HEIGHT);
    }

    /// The same without what light that changes slowly does to all of a face at once, where it is rounded.
    static double changeOfShadows(const osg::Image& a, const osg::Image& b)
    {
        double sum = 0.0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
            {
                const int change = std::abs(redAt(a, x, y) - redAt(b, x, y));
                sum += change > 3 ? change : 0;
            }
        return sum / (WIDTH * HEIGHT);
    }

    /// Whether a place is in shadow; empty where another one within `margin` metres is not as it is.
    std::optional<bool> hidden(const osg::Vec3d& place, const osg::Vec3d& normal, double margin) const
    {
        const bool here = isHidden(place + normal * 0.2, _towards);
        const osg::Vec3d axis =
            std::abs(normal.z()) < 0.9 ? osg::Vec3d(0.0, 0.0, 1.0) : osg::Vec3d(1.0, 0.0, 0.0);
        osg::Vec3d right = axis ^ normal;
        right.normalize();
        const osg::Vec3d up = normal ^ right;
        for (int i = 0; i < 8; ++i)
        {
            const double angle = i * pi / 4.0;
            const osg::Vec3d moved =
                place + right * (margin * std::cos(angle)) + up * (margin * std::sin(angle));
            if (isHidden(moved + normal * 0.2, _towards) != here) return std::nullopt;
        }
        return here;
    }

    /// Every fifth pixel in each direction is as dark as the ray says: what it was without the sun, or with all of it.
    void expectTheShadowsOfRays(double margin, int leastDark)
    {
        const osg::ref_ptr<osg::Image> lit = drawWithout(), unlit = drawUnlit(), drawn = draw();
        const DeformedView view(*_scene, *viewer().getCamera());
        const osg::Matrixd toLocal = osg::Matrixd::inverse(_frame);
        int dark = 0, bright = 0, wrong = 0;
        std::string where;
        for (int y = 2; y < HEIGHT; y += 5)
        {
            for (int x = 2; x < WIDTH; x += 5)
            {
                const auto hit = view.pick(x + 0.5, y + 0.5);
                if (!hit) continue;
                const osg::Vec3d place = hit->world * toLocal;
                const osg::Vec3d normal = osg::Matrixd::transform3x3(hit->normal, toLocal);
                // What the sun hardly touches tells nothing.
                if (redAt(*lit, x, y) - redAt(*unlit, x, y) < 25 || normal * _towards < 0.15) continue;
                if (std::max(std::abs(place.x()), std::abs(place.y())) > HALF - 30.0) continue;
                const std::optional<bool> expected = hidden(place, normal, margin);
                if (!expected) continue;
                const osg::Image& same = *expected ? *unlit : *lit;
                const bool off = std::abs(redAt(*drawn, x, y) - redAt(same, x, y)) > 2;
                (*expected ? dark : bright) += 1;
                wrong += off ? 1 : 0;
                if (off && where.size() < 300)
                    where += " (" + std::to_string(x) + "," + std::to_string(y) + ") at " +
                             std::to_string(place.x()) + " " + std::to_string(place.y()) + " " +
                             std::to_string(place.z()) + (*expected ? " is lit" : " is dark");
            }
        }
        EXPECT_GT(dark, leastDark);
        EXPECT_GT(bright, 300);
        EXPECT_LE(wrong, 1 + dark / 40) << "of " << dark + bright << ":" << where;
    }

    /// What all textures of the context take, bytes.
    unsigned int textureBytes()
    {
        unsigned int bytes = 0;
        withContext(
            [&](osg::State& state)
            {
                double time = 1.0;
                osg::flushDeletedGLObjects(state.getContextID(), 0.0, time);
                bytes = osg::get<osg::TextureObjectManager>(state.getContextID())->getCurrTexturePoolSize();
            });
        return bytes;
    }

    osg::ref_ptr<SunShadows> _shadows = new SunShadows;
    osg::Matrixd _frame;
    osg::Vec3d _towards;
    osg::ref_ptr<osg::MatrixTransform> _world;
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<osg::Group> _root;
    osg::ref_ptr<osg::LightSource> _sun;
};

osg::Matrixd onGlobe()
{
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    return LocalOrigin::onGlobe(-157.8 / 180.0 * pi, 21.3 / 180.0 * pi).toWorld(earth);
}

/// Asked for tiles, it notes their names and reads none.
class NotingPager : public osgDB::DatabasePager
{
public:
    void requestNodeFile(const std::string& file, osg::NodePath&, float, const osg::FrameStamp*,
                         osg::ref_ptr<osg::Referenced>&, const osg::Referenced*) override
    {
        asked.insert(file);
    }
    std::set<std::string> asked;
};

} // namespace

TEST_F(SunShadowsTest, LieWhereRaysSay)
{
    expectTheShadowsOfRays(2.5, 20);
    // A low sun behind the camera, and one to the side.
    shineFrom(300.0, 14.0);
    expectTheShadowsOfRays(3.0, 100);
    shineFrom(20.0, 55.0);
    expectTheShadowsOfRays(2.5, 15);
}

TEST_F(SunShadowsTest, LieOnBentGroundWhereTheyLieOnPlainGround)
{
    const osg::ref_ptr<BirdsEyeView> view = bend();
    const osg::ref_ptr<osg::Image> bent = draw();
    expectTheShadowsOfRays(3.0, 20);
    view->setEnabled(false);
    EXPECT_GT(meanDifference(*bent, *draw()), 1.0) << "nothing was bent";
}

TEST_F(SunShadowsTest, OnAGlobeToo)
{
    build(onGlobe());
    expectTheShadowsOfRays(2.5, 20);
    bend();
    expectTheShadowsOfRays(3.0, 20);
}

TEST_F(SunShadowsTest, AreThoseOfThingsThatKeepTheirShape)
{
    build(osg::Matrixd(), true);
    bend();
    // All of it stands a hundred metres higher.
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(1.5);
    lift->setBaseHeight(-200.0);
    _scene->addEffect(lift);
    expectTheShadowsOfRays(3.0, 20);
}

TEST_F(SunShadowsTest, HaveTheirStrength)
{
    const osg::ref_ptr<osg::Image> lit = drawWithout(), full = draw();
    _shadows->setStrength(0.5);
    const osg::ref_ptr<osg::Image> half = draw();
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            ASSERT_NEAR(redAt(*half, x, y), 0.5 * (redAt(*lit, x, y) + redAt(*full, x, y)), 1.5)
                << x << " " << y;
    EXPECT_GT(meanDifference(*lit, *full), 1.0);
}

TEST_F(SunShadowsTest, AreNotThereWithoutASun)
{
    _sun->getLight()->setDiffuse({0.0f, 0.0f, 0.0f, 1.0f});
    EXPECT_LT(meanDifference(*drawWithout(), *draw()), rounding);
    // A lamp on a mast has no direction that is everywhere the same, and the viewer's headlight is none.
    _sun->getLight()->setDiffuse({0.7f, 0.7f, 0.7f, 1.0f});
    _sun->getLight()->setPosition({0.0f, -200.0f, 400.0f, 1.0f});
    const auto expectNone = [&](const std::string& why)
    {
        const std::vector<std::string> heard = watch().messagesOf(
            [&]
            {
                for (int i = 0; i < 3; ++i)
                    EXPECT_LT(meanDifference(*drawWithout(), *draw()), rounding) << why;
            });
        ASSERT_EQ(heard.size(), 1u) << ::testing::PrintToString(heard);
        EXPECT_NE(heard[0].find(why), std::string::npos) << heard[0];
    };
    expectNone("Set its position with w = 0");
    shineFrom(215.0, 32.0);
    _sun->getLight()->setLightNum(3);
    _root->getOrCreateStateSet()->setMode(GL_LIGHT3, osg::StateAttribute::ON);
    expectNone("has the number 3. Call setLightNum(0)");
    _root->removeChild(_sun);
    viewer().setLightingMode(osg::View::HEADLIGHT);
    expectNone("a view's headlight is none");
    // Each of them once.
    EXPECT_LT(meanDifference(*drawWithout(), *draw()), rounding);
    _sun->getLight()->setLightNum(0);
    _root->getStateSet()->setMode(GL_LIGHT3, osg::StateAttribute::OFF);
    _root->addChild(_sun);
    EXPECT_GT(meanDifference(*drawWithout(), *draw()), 1.0);
}

// It counts which light OSG's own culling comes to last.
TEST_F(SunShadowsTest, AreThoseOfTheLightThatIsOn)
{
    // A sun that moves turns the texels.
    constexpr double ofTexels = 0.1;
    const osg::ref_ptr<osg::Image> expected = draw();
    const osg::ref_ptr<osg::LightSource> other = new osg::LightSource;
    other->setLight(osg::clone(_sun->getLight()));
    other->getLight()->setPosition(osg::Vec4d(toSun(60.0, 35.0), 0.0));

    const osg::ref_ptr<osg::Switch> off = new osg::Switch;
    off->addChild(other, false);
    _root->addChild(off);
    EXPECT_EQ(meanDifference(*expected, *draw()), 0.0) << "a light below a switch that is off";
    off->setValue(0, true);
    const osg::ref_ptr<osg::Image> ofOther = draw();
    EXPECT_GT(meanDifference(*expected, *ofOther), 1.0);

    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    levels->setRadius(1000.0f);
    levels->addChild(_sun, 0.0f, 1e5f);
    levels->addChild(other, 1e5f, 1e9f);
    _root->removeChild(off);
    _root->removeChild(_sun);
    _root->addChild(levels);
    EXPECT_LT(meanDifference(*expected, *draw()), ofTexels) << "a sun below levels of detail";
    levels->setRange(0, 1e5f, 1e9f);
    levels->setRange(1, 0.0f, 1e5f);
    EXPECT_LT(meanDifference(*ofOther, *draw()), ofTexels);

    // In the camera's own frame.
    _root->removeChild(levels);
    _root->addChild(_sun);
    _sun->setReferenceFrame(osg::LightSource::ABSOLUTE_RF);
    const osg::Vec3d eye =
        osg::Matrixd::transform3x3(_towards, osg::Matrixd(viewer().getCamera()->getViewMatrix()));
    _sun->getLight()->setPosition(osg::Vec4d(eye, 0.0));
    EXPECT_LT(meanDifference(*expected, *draw()), ofTexels);
}

TEST_F(SunShadowsTest, AreAsSharpOverHighGround)
{
    const osg::ref_ptr<osg::Image> low = draw();
    for (const double height : {500.0, 4500.0})
    {
        build(osg::Matrixd::translate(0.0, 0.0, height));
        _scene->setTerrainFrame(EffectScene::PROJECTED);
        // But for where its texels lie.
        EXPECT_LT(meanDifference(*low, *draw()), 0.3) << height;
        expectTheShadowsOfRays(2.5, 20);
    }
}

// OpenGL leaves open what a shader that compares depths does with another texture, even where it does not look.
TEST_F(SunShadowsTest, HaveDepthsToCompareWithAlsoWithoutASun)
{
    class Looks : public osg::Drawable::DrawCallback
    {
    public:
        void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
        {
            drawable->drawImplementation(info);
            info.getState()->setActiveTextureUnit(unit);
            glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE_ARB, &compares);
            glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
        }
        const unsigned int unit = 5;
        mutable GLint compares = 0, width = 0;
    };
    const osg::ref_ptr<Looks> looks = new Looks;
    const osg::ref_ptr<osg::Geometry> last = makeBox(boxes[0]);
    last->setDrawCallback(looks);
    _scene->addChild(last);
    _shadows->setMapUnit(static_cast<int>(looks->unit));
    // First, so that no map is there from before.
    const osg::Vec4 color = _sun->getLight()->getDiffuse();
    _sun->getLight()->setDiffuse({0.0f, 0.0f, 0.0f, 1.0f});
    draw();
    EXPECT_EQ(looks->compares, GL_COMPARE_R_TO_TEXTURE_ARB);
    EXPECT_EQ(looks->width, 1);
    _sun->getLight()->setDiffuse(color);
    draw();
    EXPECT_EQ(looks->compares, GL_COMPARE_R_TO_TEXTURE_ARB);
    EXPECT_GT(looks->width, 1);
}

// From below the horizon a light would shine on walls through the ground.
TEST_F(SunShadowsTest, TakeAllLightBelowTheHorizon)
{
    for (const bool globe : {false, true})
    {
        if (globe) build(onGlobe());
        shineFrom(200.0, -8.0);
        EXPECT_GT(meanDifference(*drawWithout(), *drawUnlit()), 0.5);
        EXPECT_LT(meanDifference(*draw(), *drawUnlit()), rounding);
    }
}

TEST_F(SunShadowsTest, DoNotShimmerWhileTheSunMoves)
{
    _shadows->setMapSize(1024);
    for (const bool bent : sampledCases<bool>({false, true}, 2, 1))
    {
        if (bent) bend();
        std::vector<double> steps;
        osg::ref_ptr<osg::Image> former;
        // Through the highest place, and a minute of the clock from step to step.
        for (int i = 0; i <= 24; ++i)
        {
            shineFrom(177.0 + 0.25 * i, 38.0 + 0.002 * i * (24 - i));
            const osg::ref_ptr<osg::Image> image = draw();
            if (former) steps.push_back(changeOfShadows(*former, *image));
            former = image;
        }
        std::vector<double> sorted = steps;
        std::sort(sorted.begin(), sorted.end());
        const double median = sorted[sorted.size() / 2];
        EXPECT_GT(median, 0.01);
        EXPECT_LT(sorted.back(), 2.0 * median);
    }
}

// Rising from near the ground, the first map gives way to the next ones.
TEST_F(SunShadowsTest, DoNotJumpWhileTheEyeRises)
{
    std::vector<double> steps;
    osg::ref_ptr<osg::Image> former;
    for (int i = 0; i <= 24; ++i)
    {
        const double height = 180.0 * std::exp(0.02 * i);
        look({-60.0, -620.0, height}, {20.0, -120.0, 0.0});
        const osg::ref_ptr<osg::Image> image = draw();
        if (former) steps.push_back(meanDifference(*former, *image));
        former = image;
    }
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_LT(sorted.back(), 2.0 * sorted[sorted.size() / 2]);
}

TEST_F(SunShadowsTest, OfWhatStandsBehindTheCameraFallIntoThePictureAndAskForNoTile)
{
    const osg::ref_ptr<NotingPager> pager = new NotingPager;
    viewer().setDatabasePager(pager);
    // Above the picture's left border and behind the eye, towards the sun.
    osg::ref_ptr<osg::PagedLOD> tile = new osg::PagedLOD;
    const Box tower{{-400.0, -1050.0, -20.0}, {-340.0, -990.0, 600.0}};
    const osg::ref_ptr<osg::Image> before = draw();
    tile->addChild(makeBox(tower), 0.0f, 1e6f);
    tile->setFileName(1, "finer.osgb");
    tile->setRange(1, 0.0f, 1e6f);
    tile->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    tile->setCenter((tower.low + tower.high) * 0.5);
    tile->setRadius(330.0f);
    _world->addChild(tile);
    const osg::ref_ptr<osg::Image> after = draw();
    EXPECT_GT(meanDifference(*before, *after), 1.0);
    EXPECT_TRUE(pager->asked.empty()) << *pager->asked.begin();
    // In the picture it is asked for, as without shadows.
    look({-370.0, -1900.0, 330.0}, {-370.0, -1000.0, 300.0});
    draw();
    EXPECT_EQ(pager->asked.count("finer.osgb"), 1u);
}

// A pager, or a MemoryBudget, removes what nobody has seen for some time.
TEST_F(SunShadowsTest, OfATileBesideThePictureDoNotKeepIt)
{
    const Box tower{{-400.0, -1050.0, -20.0}, {-340.0, -990.0, 600.0}};
    for (const osg::LOD::RangeMode mode : {osg::LOD::DISTANCE_FROM_EYE_POINT, osg::LOD::PIXEL_SIZE_ON_SCREEN})
    {
        build(osg::Matrixd());
        const osg::ref_ptr<osg::PagedLOD> tile = new osg::PagedLOD;
        tile->setRangeMode(mode);
        tile->setCullCallback(new osg::ClusterCullingCallback);
        // Both are there, and the first one is wanted from nowhere.
        tile->addChild(new osg::Group, 1e7f, 1e8f);
        tile->addChild(makeBox(tower), 0.0f, 1e7f);
        tile->setFileName(1, "finer.osgb");
        tile->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        tile->setCenter((tower.low + tower.high) * 0.5);
        tile->setRadius(330.0f);
        const osg::ref_ptr<osg::Image> before = draw();
        _world->addChild(tile);
        EXPECT_GT(meanDifference(*before, *draw()), 1.0) << "no shadow";
        EXPECT_EQ(tile->getTimeStamp(1), 0.0);
        EXPECT_EQ(tile->getFrameNumber(1), 0u);
        EXPECT_EQ(tile->getFrameNumberOfLastTraversal(), 0u);
        look({-370.0, -1900.0, 330.0}, {-370.0, -1000.0, 300.0});
        draw();
        EXPECT_GT(tile->getTimeStamp(1), 0.0) << "it is in the picture now";
        EXPECT_GT(tile->getFrameNumberOfLastTraversal(), 0u);
    }
}

TEST_F(SunShadowsTest, StayAsTheyAreWhereNothingChanges)
{
    const auto maps = static_cast<std::uint64_t>(_shadows->getCascades());
    for (const bool globe : {false, true})
    {
        if (globe) build(onGlobe());
        // Two visitors may cull in turn.
        draw();
        const osg::ref_ptr<osg::Image> first = draw();
        const SunShadows::Statistics before = _shadows->statistics();
        EXPECT_GE(before.drawn, maps);
        for (int i = 0; i < 4; ++i)
            EXPECT_EQ(meanDifference(*draw(), *first), 0.0) << i;
        EXPECT_EQ(_shadows->statistics().drawn, before.drawn);
        EXPECT_EQ(_shadows->statistics().kept, before.kept + 4 * maps);
        // A bend changes nothing of the undeformed world.
        bend();
        draw();
        EXPECT_EQ(_shadows->statistics().drawn, before.drawn);
        // A new context has none of them.
        withContext([&](osg::State& state) { _scene->releaseGLObjects(&state); });
        const osg::ref_ptr<osg::Image> bent = draw();
        EXPECT_EQ(_shadows->statistics().drawn, before.drawn + maps);
        EXPECT_EQ(meanDifference(*bent, *draw()), 0.0);
    }
}

TEST_F(SunShadowsTest, FollowWhatChanges)
{
    build(osg::Matrixd(), true);
    // The maps of another effect, which knows no earlier frame.
    const auto drawAnew = [&]
    {
        const osg::ref_ptr<SunShadows> kept = _shadows;
        _scene->removeEffect(kept);
        _scene->addEffect(new SunShadows);
        const osg::ref_ptr<osg::Image> image = draw();
        _scene->removeEffect(_scene->getEffect(_scene->getNumEffects() - 1));
        _scene->addEffect(kept);
        return image;
    };
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    const osg::ref_ptr<osg::Geometry> box = makeBox({{-60.0, -160.0, -20.0}, {-30.0, -130.0, 90.0}});
    const osg::ref_ptr<osg::Geometry> mast = makeBox({{-100.0, -260.0, -20.0}, {-95.0, -255.0, 70.0}});
    const auto raise = [&](float height)
    {
        auto& vertices = static_cast<osg::Vec3Array&>(*box->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex.z() = vertex.z() > 0.0f ? height : vertex.z();
        vertices.dirty();
        box->dirtyBound();
    };
    const std::vector<std::pair<const char*, std::function<void()>>> changes = {
        {"a thing comes",
         [&]
         {
             _world->addChild(place);
             place->addChild(box);
         }},
        {"it moves",
         [&]
         {
             place->setMatrix(osg::Matrixd::translate(40.0, 30.0, 0.0));
         }},
        {"its vertices change",
         [&]
         {
             raise(40.0f);
         }},
        {"other vertices",
         [&]
         {
             const osg::ref_ptr<osg::Vec3Array> copy =
                 new osg::Vec3Array(static_cast<osg::Vec3Array&>(*box->getVertexArray()));
             box->setVertexArray(copy);
             raise(70.0f);
         }},
        {"half of it sinks, within the same box",
         [&]
         {
             auto& vertices = static_cast<osg::Vec3Array&>(*box->getVertexArray());
             for (osg::Vec3& vertex : vertices)
                 if (vertex.x() < -45.0f) vertex.z() = -20.0f;
             vertices.dirty();
             box->dirtyBound();
         }},
        {"fewer triangles",
         [&]
         {
             static_cast<osg::DrawElementsUInt&>(*box->getPrimitiveSet(0)).resize(18);
             box->getPrimitiveSet(0)->dirty();
         }},
        {"another thing in its place",
         [&]
         {
             place->removeChild(box);
             place->addChild(mast);
         }},
        {"a house goes",
         [&]
         {
             _world->removeChild(1, 1);
         }},
        {"the sun moves",
         [&]
         {
             shineFrom(190.0, 40.0);
         }},
        {"the eye flies",
         [&]
         {
             look({60.0, -560.0, 230.0}, {20.0, -120.0, 0.0});
         }},
        {"it creeps",
         [&]
         {
             look({60.5, -560.0, 230.0}, {20.0, -120.0, 0.0});
         }},
        {"it goes", [&]
         {
             place->removeChildren(0, place->getNumChildren());
         }}};
    draw();
    osg::ref_ptr<osg::Image> former = draw();
    for (const auto& [what, change] : changes)
    {
        const std::uint64_t before = _shadows->statistics().drawn;
        change();
        const osg::ref_ptr<osg::Image> image = draw();
        EXPECT_GT(meanDifference(*image, *former), 0.05) << what;
        // The near maps alone, where the eye moves by less than a texel of the wide ones.
        EXPECT_GE(_shadows->statistics().drawn, before + (std::string(what) == "it creeps" ? 0 : 1)) << what;
        // A sun that moves turns the texels of this effect alone.
        EXPECT_LT(meanDifference(*image, *drawAnew()), 0.04) << what;
        former = image;
        draw();
    }
}

// With draw threads two frames are on their way, and one set of maps is enough for both.
TEST_F(SunShadowsTest, TakeFourBytesForEachTexelOfACamera)
{
    constexpr unsigned int texels = 256;
    _shadows->setMapSize(texels);
    _shadows->setEnabled(false);
    draw();
    const unsigned int before = textureBytes();
    _shadows->setEnabled(true);
    const auto eye = [](int step)
    {
        return osg::Vec3d(-60.0 + 40.0 * step, -620.0, 230.0);
    };
    const osg::Vec3d at(20.0, -120.0, 0.0);
    constexpr int steps = 7;
    std::vector<osg::ref_ptr<osg::Image>> expected;
    for (int i = 0; i < steps; ++i)
    {
        look(eye(i), at);
        expected.push_back(draw());
    }
    constexpr unsigned int one = 4 * texels * texels;
    EXPECT_EQ(textureBytes() - before, 5 * one);

    using Threading = osgViewer::ViewerBase;
    for (const auto model : {Threading::CullDrawThreadPerContext, Threading::DrawThreadPerContext,
                             Threading::CullThreadPerCameraDrawThreadPerContext})
    {
        const osg::ref_ptr<ImageCapture> capture =
            ImageCapture::attach(viewer().getCamera(), ImageCapture::Format::Rgba);
        viewer().setThreadingModel(model);
        const SunShadows::Statistics start = _shadows->statistics();
        for (int i = 0; i < steps; ++i)
        {
            // All of the frames before are on their way, or have been drawn.
            look(eye(i), at);
            capture->request();
            viewer().frame();
            const osg::ref_ptr<osg::Image> image = capture->take();
            ASSERT_TRUE(image);
            EXPECT_LT(meanDifference(*image, *expected[static_cast<std::size_t>(i)]), 0.01)
                << model << " " << i;
        }
        for (int i = 0; i < 40; ++i)
        {
            look(eye(i % steps), at);
            viewer().frame();
        }
        look(eye(3), at);
        viewer().frame();
        viewer().frame();
        const SunShadows::Statistics still = _shadows->statistics();
        for (int i = 0; i < 6; ++i)
            viewer().frame();
        EXPECT_EQ(_shadows->statistics().drawn, still.drawn) << "drawn though nothing changes";
        EXPECT_GT(still.kept, start.kept);
        capture->request();
        viewer().frame();
        const osg::ref_ptr<osg::Image> last = capture->take();
        viewer().setThreadingModel(Threading::SingleThreaded);
        capture->detach(viewer().getCamera());
        ASSERT_TRUE(last);
        EXPECT_LT(meanDifference(*last, *expected[3]), 0.01) << model;
        EXPECT_EQ(textureBytes() - before, 5 * one) << model;
    }

    // The former ones go when what was drawn with them has gone: when each cull visitor has drawn with the new ones.
    viewer().setThreadingModel(Threading::DrawThreadPerContext);
    _shadows->setCascades(3);
    for (int i = 0; i < 6; ++i)
        viewer().frame();
    viewer().setThreadingModel(Threading::SingleThreaded);
    draw();
    EXPECT_EQ(textureBytes() - before, 3 * one);
}

TEST_F(SunShadowsTest, LeaveNoTextureBehind)
{
    _scene->removeEffect(_shadows);
    draw();
    const unsigned int before = textureBytes();
    for (const bool held : {true, false})
    {
        _shadows = new SunShadows;
        _shadows->setMapSize(256);
        _scene->addEffect(_shadows);
        draw();
        EXPECT_GT(textureBytes(), before + 1000000u);
        osg::observer_ptr<SunShadows> observed = _shadows;
        _scene->removeEffect(_shadows);
        if (!held) _shadows = nullptr;
        draw();
        EXPECT_EQ(observed.valid(), held);
        EXPECT_LT(textureBytes(), before + 100u) << held;
    }
    // Where it leaves one scene, another one keeps its maps.
    _shadows = new SunShadows;
    _scene->addEffect(_shadows);
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addEffect(_shadows);
    draw();
    const std::uint64_t drawn = _shadows->statistics().drawn;
    other->removeEffect(_shadows);
    draw();
    EXPECT_EQ(_shadows->statistics().drawn, drawn);
}

TEST_F(SunShadowsTest, AreDrawnAnewNearbyOnlyWhileTheEyeMoves)
{
    draw();
    const SunShadows::Statistics before = _shadows->statistics();
    const int steps = fullTest() ? 40 : 20;
    for (int i = 1; i <= steps; ++i)
    {
        look({-60.0 + 3.0 * i, -620.0, 230.0}, {20.0, -120.0, 0.0});
        draw();
    }
    const SunShadows::Statistics after = _shadows->statistics();
    const double drawn = static_cast<double>(after.drawn - before.drawn);
    const double kept = static_cast<double>(after.kept - before.kept);
    EXPECT_EQ(drawn + kept, 5.0 * steps);
    EXPECT_GT(drawn, 0.1 * steps);
    EXPECT_LT(drawn, 3.0 * steps);
}
