// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Styles of bent views in pictures: the map of what tiles say of the ground, blocks, and what keeps its color across.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GlFixture.h>
#include <tools/PlainView.h>
#include <tools/SmoothTexture.h>

#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/Texture2D>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int WIDTH = 200, HEIGHT = 160;
constexpr double HALF = 2000.0; ///< metres, of the ground

osg::ref_ptr<osg::Texture2D> textureOf(const osg::Vec4& west, const osg::Vec4& east)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(64, 64, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < 64 * 64; ++i)
        image->setColor(i % 64 < 32 ? west : east, i % 64, i / 64);
    return smoothTexture(image);
}

/// A quad in cells, so that it can bend. `along`: its sides from a corner.
osg::ref_ptr<osg::Geometry> makeQuad(const osg::Vec3& corner, const osg::Vec3& right, const osg::Vec3& along)
{
    constexpr unsigned int cells = 60;
    osg::ref_ptr<osg::Geometry> quad = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(1);
    white->front().set(1.0f, 1.0f, 1.0f, 1.0f);
    osg::ref_ptr<osg::DrawElementsUInt> corners = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int i = 0; i < (cells + 1) * (cells + 1); ++i)
    {
        const float u = static_cast<float>(i % (cells + 1)) / cells,
                    v = static_cast<float>(i / (cells + 1)) / cells;
        places->push_back(corner + right * u + along * v);
        coordinates->push_back({u, v});
        if (i % (cells + 1) == cells || i / (cells + 1) == cells) continue;
        for (const unsigned int each : {i, i + 1, i + cells + 2, i, i + cells + 2, i + cells + 1})
            corners->push_back(each);
    }
    quad->setVertexArray(places);
    quad->setTexCoordArray(0, coordinates);
    quad->setColorArray(white, osg::Array::BIND_OVERALL);
    quad->addPrimitiveSet(corners);
    quad->setUseDisplayList(false);
    quad->setUseVertexBufferObjects(false);
    return quad;
}

/// Ground with woods in the west and the sea in the east, in the colors of a photo; towers in a row to the north.
class BendStyles : public GlFixture
{
protected:
    BendStyles() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        usePlainView(viewer());
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(osg::Vec3d(0.0, -1900.0, 700.0), osg::Vec3d(0.0, -700.0, 0.0),
                                     osg::Vec3d(0, 0, 1));
        camera.setProjectionMatrixAsPerspective(50.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 20000.0);

        const float half = static_cast<float>(HALF);
        osg::ref_ptr<osg::Geometry> ground =
            makeQuad({-half, -half, 0.0f}, {2 * half, 0.0f, 0.0f}, {0.0f, 2 * half, 0.0f});
        ground->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(photo(west), photo(east)));
        const auto cover = [](const glsl::geofx_Cover& of)
        {
            const glm::dvec4 texel = glsl::geofx_coverTexel(of);
            return osg::Vec4(osg::Vec4d(texel.x, texel.y, texel.z, texel.w));
        };
        ground->getOrCreateStateSet()->setTextureAttribute(7, textureOf(cover(west), cover(east)));

        // One building for each camera's side of the zone, as RigidParts has them.
        for (const float y : {-1050.0f, 900.0f})
        {
            osg::ref_ptr<osg::Geometry> wall =
                makeQuad({-200.0f, y, 0.0f}, {400.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 300.0f});
            osg::ref_ptr<osg::Vec4Array> references = new osg::Vec4Array;
            for (unsigned int i = 0; i < wall->getVertexArray()->getNumElements(); ++i)
                references->push_back({0.0f, y, 0.0f, 400.0f});
            wall->setVertexAttribArray(RigidParts::attribute, references, osg::Array::BIND_PER_VERTEX);
            wall->getOrCreateStateSet()->setDefine(RigidParts::define);
            wall->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(windows, windows));
            _buildings->addChild(wall);
        }
        _bend->setFocusLine(0.45);
        _bend->setHorizonLine(0.97);
        _scene->setTerrainFrame(EffectScene::PROJECTED);
        _scene->addEffect(_bend);
        _scene->addChild(ground);
        _root->addChild(_scene);
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    }

    static osg::Vec4 photo(const glsl::geofx_Cover& cover)
    {
        return cover.shore > 0.0 ? osg::Vec4(0.15f, 0.32f, 0.48f, 1.0f) : osg::Vec4(0.35f, 0.5f, 0.25f, 1.0f);
    }
    osg::Vec3d colorAt(const osg::Image& image, const osg::Vec3d& world)
    {
        const DeformedView view(*_scene, *viewer().getCamera());
        osg::Vec2d pixel;
        EXPECT_TRUE(view.project(world, pixel));
        EXPECT_TRUE(pixel.x() > 1.0 && pixel.y() > 1.0 && pixel.x() < WIDTH - 1.0 && pixel.y() < HEIGHT - 1.0)
            << pixel.x() << " " << pixel.y();
        const unsigned char* bytes =
            image.data(static_cast<unsigned int>(pixel.x()), static_cast<unsigned int>(pixel.y()));
        return osg::Vec3d(bytes[0], bytes[1], bytes[2]) / 255.0;
    }
    static void expectColor(const osg::Vec3d& actual, const glm::dvec3& expected)
    {
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(actual[channel], expected[channel], 3.0 / 255.0);
    }
    double shareAt(const osg::Vec3d& world)
    {
        const DeformedView view(*_scene, *viewer().getCamera());
        return view.chain().style(world * view.modelView());
    }
    /// What the styles make of ground at a place, by the functions' text.
    glm::dvec3 styled(const osg::Vec3d& world, const glsl::geofx_Cover& cover,
                      const glsl::geofx_BendStyle& style)
    {
        const double wet = cover.shore > 0.0 ? 1.0 : 0.0;
        const glm::dvec4 map(glsl::geofx_bendMap(cover, wet, glm::dvec3(1.0)), 1.0);
        return glsl::geofx_bendRestyle(style, rgb(photo(cover)), map, false, shareAt(world));
    }
    static glm::dvec3 rgb(const osg::Vec4& color) { return {color.r(), color.g(), color.b()}; }
    osg::ref_ptr<osg::Image> draw()
    {
        render(_root);
        return render(_root);
    }

    const glsl::geofx_Cover west = {0.9, 0.0, 0.0, -400.0}, east = {0.0, 0.0, 0.0, 400.0};
    const osg::Vec4 windows = {0.2f, 0.3f, 0.45f, 1.0f};
    // Before the zone, and behind it.
    const osg::Vec3d focus = {-200.0, -1150.0, 0.0}, focusSea = {200.0, -1150.0, 0.0};
    const osg::Vec3d context = {-900.0, 1900.0, 0.0}, contextSea = {900.0, 1900.0, 0.0};
    osg::ref_ptr<BirdsEyeView> _bend = new BirdsEyeView;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<osg::Group> _buildings = new osg::Group;
    osg::ref_ptr<osg::Group> _root = new osg::Group;
};

} // namespace

TEST_F(BendStyles, TheContextIsAMapOfWhatTilesSay)
{
    _bend->setCoverMap(true);
    const osg::ref_ptr<osg::Image> map = draw();
    EXPECT_EQ(shareAt(focus), 0.0);
    EXPECT_GT(shareAt(context), 0.2);
    const glsl::geofx_BendStyle style = {1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0};
    expectColor(colorAt(*map, focus), rgb(photo(west)));
    expectColor(colorAt(*map, focusSea), rgb(photo(east)));
    expectColor(colorAt(*map, context), styled(context, west, style));
    expectColor(colorAt(*map, contextSea), styled(contextSea, east, style));
}

TEST_F(BendStyles, OrTheFocusIs)
{
    _bend->setCoverMap(true);
    _bend->setMapPlace(PerspectiveBend::FOCUS);
    const osg::ref_ptr<osg::Image> map = draw();
    const glsl::geofx_BendStyle style = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0};
    expectColor(colorAt(*map, focus), glsl::geofx_bendMap(west, 0.0, glm::dvec3(1.0)));
    expectColor(colorAt(*map, focusSea), glsl::geofx_bendMap(east, 1.0, glm::dvec3(1.0)));
    expectColor(colorAt(*map, context), styled(context, west, style));
}

// Where nothing tells what lies there, the photo stays.
TEST_F(BendStyles, GroundThatTellsNothingHasNoMap)
{
    _scene->getChild(0)->getOrCreateStateSet()->removeTextureAttribute(7, osg::StateAttribute::TEXTURE);
    _bend->setCoverMap(true);
    expectColor(colorAt(*draw(), context), rgb(photo(west)));
}

TEST_F(BendStyles, SeveralAtOnceAndARouteAcross)
{
    const osg::ref_ptr<ProjectiveMapping> way = new ProjectiveMapping;
    way->setRectangle({-420.0, 0.0}, 40.0, HALF);
    way->setSoftEdges(false);
    way->getTransfer()->setSource(ColorTransfer::CONSTANT);
    way->getTransfer()->setConstant({0.9, 0.2, 0.1, 1.0});
    const osg::ref_ptr<ProjectiveMappings> route = new ProjectiveMappings;
    route->addMapping(way);
    _scene->addEffect(route); // behind the bend
    _bend->setCoverMap(true);
    _bend->setContextSaturation(0.0);
    _bend->setContextBrightness(0.8);
    _bend->setFocusSaturation(0.5);
    const osg::ref_ptr<osg::Image> drawn = draw();
    const glsl::geofx_BendStyle style = {0.0, 0.8, 0.5, 1.0, 1.0, 0.0, 0.0};
    expectColor(colorAt(*drawn, context), styled(context, west, style));
    expectColor(colorAt(*drawn, contextSea), styled(contextSea, east, style));
    expectColor(colorAt(*drawn, focus), styled(focus, west, style));
    for (const double y : {-1150.0, -700.0, 0.0, 900.0, 1900.0})
        expectColor(colorAt(*drawn, {-420.0, y, 0.0}), {0.9, 0.2, 0.1});
}

TEST_F(BendStyles, BuildingsOfTheContextAreBlocks)
{
    _scene->addChild(_buildings);
    _bend->setContextBlocks(1.0);
    const osg::ref_ptr<osg::Image> blocks = draw();
    const glsl::geofx_BendStyle style = {1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0};
    const DeformedView view(*_scene, *viewer().getCamera());
    for (const double y : {-1050.0, 900.0})
    {
        // A building has the style of its reference.
        const osg::Vec3d foot(0.0, y, 0.0);
        const double share = view.chain().style(foot * view.modelView());
        EXPECT_EQ(share > 0.1, y > 0.0);
        const glm::dvec3 expected =
            glsl::geofx_bendRestyle(style, rgb(windows), glm::dvec4(1.0), true, share);
        const osg::Vec3d actual = colorAt(*blocks, foot + osg::Vec3d(0.0, 0.0, 100.0));
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(actual[channel], expected[channel], 3.0 / 255.0) << y;
    }
}

// Two bends may be in a scene, and the shaders of both are put together even if one is off.
TEST_F(BendStyles, TwoBendsMayHaveMaps)
{
    _bend->setCoverMap(true);
    const osg::ref_ptr<osg::Image> one = draw();
    const osg::ref_ptr<PedestrianView> other = new PedestrianView;
    other->setCoverMap(true);
    other->setEnabled(false);
    _scene->addEffect(other);
    const osg::ref_ptr<osg::Image> two = draw();
    expectColor(colorAt(*two, context), rgb(osg::Vec4(osg::Vec4d(colorAt(*one, context), 1.0))));
    EXPECT_GT((colorAt(*two, context) - osg::Vec3d(0.35, 0.5, 0.25)).length(), 0.02) << "no map";
}

// Ground in the dark is dark on the map, too.
TEST_F(BendStyles, DarkGroundIsDarkOnTheMap)
{
    _bend->setCoverMap(true);
    _bend->setMapPlace(PerspectiveBend::FOCUS);
    osg::StateSet& state = *_root->getOrCreateStateSet();
    state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({0.0f, 0.0f, 0.0f, 1.0f});
    state.setAttribute(model);
    expectColor(colorAt(*draw(), focus), glsl::geofx_bendMap(west, 0.0, glm::dvec3(0.0)));
}

// Lines on the ground where the zone begins and ends, and nowhere else.
TEST_F(BendStyles, ZoneLinesLieOnTheGround)
{
    const osg::ref_ptr<osg::Geometry> house =
        makeQuad({-500.0f, -700.0f, 0.0f}, {200.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 100.0f});
    const osg::ref_ptr<osg::Vec4Array> references =
        new osg::Vec4Array(house->getVertexArray()->getNumElements());
    std::fill(references->begin(), references->end(), osg::Vec4(-400.0f, -700.0f, 0.0f, 200.0f));
    house->setVertexAttribArray(RigidParts::attribute, references, osg::Array::BIND_PER_VERTEX);
    house->getOrCreateStateSet()->setDefine(RigidParts::define);
    house->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(windows, windows));
    _scene->addChild(house);
    const osg::ref_ptr<PedestrianView> walker = new PedestrianView;
    walker->setFocusDistance(1200.0);
    walker->setZoneWidth(900.0);
    walker->setBendAngle(osg::DegreesToRadians(30.0));
    walker->setTallest(0.0);
    _scene->removeEffect(_bend);
    _scene->addEffect(walker);
    const osg::ref_ptr<osg::Image> plain = draw();
    walker->setZoneLines(true);
    const osg::ref_ptr<osg::Image> lined = draw();
    const DeformedView view(*_scene, *viewer().getCamera());
    const auto rowOf = [&](double x, double y)
    {
        osg::Vec2d pixel;
        return view.project({x, y, 0.0}, pixel) ? pixel.y() : -1.0;
    };
    // So far from the point below the eye.
    const double first = -1900.0 + 1200.0, last = first + 900.0;
    const osg::Vec3d amber = colorAt(*lined, {300.0, first, 0.0}), blue = colorAt(*lined, {300.0, last, 0.0});
    EXPECT_LT((amber - osg::Vec3d(0.98, 0.72, 0.28)).length(), 0.15);
    EXPECT_LT((blue - osg::Vec3d(0.45, 0.74, 1.0)).length(), 0.15);
    unsigned int changed = 0;
    for (unsigned int y = 0; y < HEIGHT; ++y)
    {
        for (unsigned int x = 0; x < WIDTH; ++x)
        {
            if (std::equal(plain->data(x, y), plain->data(x, y) + 3, lined->data(x, y))) continue;
            ++changed;
            const double row = y + 0.5;
            EXPECT_LT(std::min(std::abs(row - rowOf(0.0, first)), std::abs(row - rowOf(0.0, last))), 4.5)
                << x << " " << y;
        }
    }
    EXPECT_GT(changed, 4u * WIDTH);
    // A house on the line has none.
    const osg::Vec3d wall(-400.0, first, 50.0);
    expectColor(colorAt(*plain, wall), rgb(windows));
    EXPECT_LT((colorAt(*lined, wall) - colorAt(*plain, wall)).length(), 1e-9);
}
