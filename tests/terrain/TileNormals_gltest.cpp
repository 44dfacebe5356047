// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A coarse mesh with a texture of normals is lit as the full mesh is: by plain OpenSceneGraph with the database's own program, and
// below an EffectScene.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/CloseUpStage.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/Fog>
#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osg/TexMat>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgGeoFX;

namespace
{

constexpr int posts = 128;   ///< cells of the lattice along an edge
constexpr double side = 8.0; ///< metres
constexpr int on = osg::StateAttribute::ON;
constexpr int off = osg::StateAttribute::OFF;
constexpr int overriding = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE;

double place(int post)
{
    return side * post / posts - 0.5 * side;
}

/// Hills, and on them what a coarse mesh cannot have: ripples, steep and not high.
double height(double x, double y)
{
    return 0.3 * std::sin(0.8 * x) * std::cos(0.7 * y) + 0.01 * std::sin(14.0 * x + 3.0 * y) +
           0.01 * std::cos(13.0 * y - 2.0 * x);
}

osg::Vec3d normalAt(double x, double y)
{
    osg::Vec3d normal(-(0.24 * std::cos(0.8 * x) * std::cos(0.7 * y) + 0.14 * std::cos(14.0 * x + 3.0 * y) +
                        0.02 * std::sin(13.0 * y - 2.0 * x)),
                      -(-0.21 * std::sin(0.8 * x) * std::sin(0.7 * y) + 0.03 * std::cos(14.0 * x + 3.0 * y) -
                        0.13 * std::sin(13.0 * y - 2.0 * x)),
                      1.0);
    normal.normalize();
    return normal;
}

/// The ground of every `step`-th post, as a tile of a database has it but for the normals' texture.
osg::ref_ptr<osg::Geometry> makeMesh(int step)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    const int cells = posts / step;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i)
        {
            const double x = place(i * step), y = place(j * step);
            vertices->push_back(osg::Vec3(osg::Vec3d(x, y, height(x, y))));
            normals->push_back(osg::Vec3(normalAt(x, y)));
            coordinates->push_back(osg::Vec2((0.5f + static_cast<float>(i * step)) / (posts + 1.0f),
                                             (0.5f + static_cast<float>(j * step)) / (posts + 1.0f)));
            if (i == cells || j == cells) continue;
            const auto a = static_cast<GLushort>(j * (cells + 1) + i);
            const auto b = static_cast<GLushort>(a + cells + 1);
            for (const int index : {+a, a + 1, b + 1, +a, b + 1, +b})
                triangles->push_back(static_cast<GLushort>(index));
        }
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->setUseDisplayList(false);
    mesh->setUseVertexBufferObjects(false);
    mesh->setVertexArray(vertices);
    mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array;
    white->push_back({1.0f, 1.0f, 1.0f, 254.0f / 255.0f});
    mesh->setColorArray(white, osg::Array::BIND_OVERALL);
    mesh->setTexCoordArray(0, coordinates);
    mesh->addPrimitiveSet(triangles);

    osg::ref_ptr<osg::Image> colors = new osg::Image;
    colors->allocateImage(posts + 1, posts + 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int row = 0; row <= posts; ++row)
        for (int column = 0; column <= posts; ++column)
        {
            unsigned char* texel =
                colors->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
            texel[0] = static_cast<unsigned char>(150 + 50 * std::sin(0.1 * column));
            texel[1] = static_cast<unsigned char>(170 + 40 * std::cos(0.08 * row));
            texel[2] = 140;
        }
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(colors);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    mesh->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    return mesh;
}

/// Binds the lattice's normals, with the frame turned by `turn`. The texture reaches `reach` times as far as the ground.
void addNormals(osg::StateSet& state, int channels = 2, int reach = 1, const osg::Matrixd& turn = {})
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    const int texels = reach * posts + 1;
    image->allocateImage(texels, texels, 1, channels == 2 ? GL_RG : GL_RGB, GL_UNSIGNED_BYTE, 1);
    image->setInternalTextureFormat(channels == 2 ? GL_RG8 : GL_RGB8);
    unsigned char* byte = image->data();
    for (int row = 0; row < texels; ++row)
        for (int column = 0; column < texels; ++column)
        {
            const osg::Vec3d normal = normalAt(place(column), place(row)) * turn;
            for (int channel = 0; channel < channels; ++channel)
                *byte++ = static_cast<unsigned char>(std::lround(127.0 * normal[channel]) + 128);
        }
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setName("geofx normals");
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    state.setTextureAttribute(2, texture);
    if (reach == 1) return;
    // Texel by texel, the coordinates of the colors become those of more texels.
    const double scale = (posts + 1.0) / texels;
    state.setTextureAttribute(2, new osg::TexMat(osg::Matrix::scale(scale, scale, 1.0)));
}

/// What a database has above its tiles.
osg::ref_ptr<osg::StateSet> stateOfDatabase()
{
    const geofx::test::TempDir folder;
    BuildOptions options;
    options.dems = {geofx::test::writeRelief(folder / "dem.tif", 20, 20, 10.0, 50.0, 0.01)};
    options.output = (folder / "db").string();
    buildDatabase(options);
    const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(options.output + "/terrain.osgb");
    return root ? root->asGroup()->getChild(0)->getStateSet() : nullptr;
}

struct Difference
{
    double mean = 0.0, most = 0.0; ///< of 255; `most` of all but a thousandth of the channels
    double onlyOne = 0.0;          ///< the share of pixels that only one of the two covers
};

bool covered(const unsigned char* pixel)
{
    return pixel[0] != 255 || pixel[1] != 0 || pixel[2] != 255;
}

/// Where both show ground: outlines are the geometry's matter.

Difference differenceOf(const osg::Image& a, const osg::Image& b)
{
    std::vector<int> values;
    double sum = 0.0;
    double single = 0.0;
    for (unsigned int i = 0; i < a.getTotalSizeInBytes(); ++i)
    {
        const unsigned int pixel = i / 4 * 4;
        const bool first = covered(a.data() + pixel), second = covered(b.data() + pixel);
        if (i % 4 == 3) single += first != second ? 1.0 : 0.0;
        if (i % 4 == 3 || !first || !second) continue;
        values.push_back(std::abs(a.data()[i] - b.data()[i]));
        sum += values.back();
    }
    const std::size_t rank = values.size() - values.size() / 1000 - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
    return {sum / static_cast<double>(values.size()), static_cast<double>(values[rank]),
            single / (a.getTotalSizeInBytes() / 4.0)};
}

/// Makes coordinates that run through the texture a thousand times within a pixel.
class RunAway : public osg::NodeVisitor
{
public:
    RunAway() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Geometry& mesh) override
    {
        for (osg::Vec2& place : dynamic_cast<osg::Vec2Array&>(*mesh.getTexCoordArray(0)))
            place *= 1e6f;
        auto& texture = dynamic_cast<osg::Texture2D&>(
            *mesh.getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        texture.setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
        texture.setMaxAnisotropy(4.0f);
    }
};

} // namespace

class TileLight : public geofx::test::GlFixture
{
protected:
    enum Mesh
    {
        Full,          ///< with normals of vertices, drawn by fixed functions
        CoarseBare,    ///< the same, of every eighth post
        Coarse,        ///< with the texture, and the database's program above
        CoarseOfThree, ///< channels, in a frame whose z points down
        CoarseOfPart   ///< of a texture that reaches farther than the tile
    };
    /// Changes what stands above the tile.
    using Host = std::function<void(osg::Group& above, osg::Group& scene)>;

    TileLight() : GlFixture(240, 200) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt({0.5, -4.5, 5}, {0, -0.2, 0}, {0, 0, 1});
        camera.setClearColor({1, 0, 1, 1});
        camera.setProjectionMatrixAsPerspective(34, 1.2, 1, 100);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        _stateOfDatabase = stateOfDatabase();
        ASSERT_TRUE(_stateOfDatabase.valid());
    }

    osg::ref_ptr<osg::Image> draw(Mesh mesh, const Host& host,
                                  const std::vector<osg::ref_ptr<Effect>>& effects = {}, bool scene = false)
    {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        osg::ref_ptr<osg::Group> group = new osg::Group;
        if (scene)
        {
            const osg::ref_ptr<EffectScene> effectScene = new EffectScene;
            for (const auto& effect : effects)
                effectScene->addEffect(effect);
            group = effectScene;
        }
        root->addChild(group);
        const osg::ref_ptr<osg::Group> terrain = new osg::Group;
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setAmbient(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
        material->setDiffuse(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
        terrain->getOrCreateStateSet()->setAttributeAndModes(material);
        group->addChild(terrain);
        const osg::ref_ptr<osg::Group> tiles = new osg::Group;
        terrain->addChild(tiles);
        const osg::Matrixd turn =
            mesh == CoarseOfThree ? osg::Matrixd::rotate(2.4, osg::Vec3d(0.8, 0.6, 0.0)) : osg::Matrixd();
        const osg::ref_ptr<osg::Geometry> geometry = makeMesh(mesh == Full ? 1 : 8);
        for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*geometry->getVertexArray()))
            vertex = vertex * turn;
        for (osg::Vec3& normal : static_cast<osg::Vec3Array&>(*geometry->getNormalArray()))
            normal = normal * turn;
        const osg::ref_ptr<osg::MatrixTransform> frame =
            new osg::MatrixTransform(osg::Matrixd::inverse(turn));
        frame->addChild(geometry);
        tiles->addChild(frame);
        if (mesh != Full && mesh != CoarseBare)
        {
            tiles->setStateSet(_stateOfDatabase);
            addNormals(*geometry->getOrCreateStateSet(), mesh == CoarseOfThree ? 3 : 2,
                       mesh == CoarseOfPart ? 2 : 1, turn);
        }
        host(*root, *group);
        return render(root);
    }

    /// The bounds are those that the lit picture must keep: a mean of 1.5 of 255, and 24 for all but a thousandth.
    static void expectAlike(const osg::Image& actual, const osg::Image& expected, const std::string& name)
    {
        const Difference difference = differenceOf(actual, expected);
        EXPECT_LE(difference.mean, 1.5) << name;
        EXPECT_LE(difference.most, 24.0) << name;
        EXPECT_LE(difference.onlyOne, 0.01) << name;
        osgDB::writeImageFile(actual, (geofx::test::testOutputFolder() / (name + ".png")).string());
        osgDB::writeImageFile(expected, (geofx::test::testOutputFolder() / (name + " full.png")).string());
    }

    static void expectUnlike(const osg::Image& actual, const osg::Image& expected, const std::string& name)
    {
        EXPECT_GT(differenceOf(actual, expected).mean, 3.0) << name;
    }

    static osg::ref_ptr<osg::Light> addLamp(osg::Group& above, osg::Group& scene, int number,
                                            const osg::Vec4& position)
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        osg::ref_ptr<osg::Light> light = new osg::Light(static_cast<unsigned int>(number));
        light->setPosition(position);
        light->setAmbient({0.05f, 0.05f, 0.08f, 1});
        light->setDiffuse({0.6f, 0.55f, 0.5f, 1});
        light->setSpecular({0.8f, 0.8f, 0.6f, 1});
        source->setLight(light);
        above.addChild(source);
        scene.getOrCreateStateSet()->setMode(GL_LIGHTING, on);
        scene.getOrCreateStateSet()->setMode(static_cast<GLenum>(GL_LIGHT0 + number), on);
        return light;
    }

    static void sun(osg::Group& above, osg::Group& scene)
    {
        addLamp(above, scene, 0, {-0.8f, -0.3f, 0.6f, 0});
    }

    osg::ref_ptr<osg::StateSet> _stateOfDatabase;
};

TEST_F(TileLight, PlainOpenSceneGraph)
{
    const osg::ref_ptr<osg::Image> full = draw(Full, sun);
    expectAlike(*draw(Coarse, sun), *full, "two channels");
    expectAlike(*draw(CoarseOfThree, sun), *full, "three channels");
    expectAlike(*draw(CoarseOfPart, sun), *full, "part of a texture");
    expectUnlike(*draw(CoarseBare, sun), *full, "vertices alone");
}

/// Where ground is seen from its edge, coordinates run through a texture many times within a pixel. Mesa's llvmpipe, filtering
/// anisotropically, would visit every texel between neighbours: this picture would take hours.
TEST_F(TileLight, CoordinatesMayRunAway)
{
    const auto away = [&](osg::Group& above, osg::Group& scene)
    {
        sun(above, scene);
        RunAway runAway;
        scene.accept(runAway);
    };
    const osg::ref_ptr<osg::Image> picture = draw(Coarse, away);
    std::size_t ground = 0;
    for (unsigned int i = 0; i < picture->getTotalSizeInBytes(); i += 4)
        ground += covered(picture->data() + i);
    EXPECT_GT(ground, picture->getTotalSizeInBytes() / 4 / 4);
}

TEST_F(TileLight, WhatTheDatabaseProgramSeesOfModes)
{
    const auto unlit = [](osg::Group& above, osg::Group& scene)
    {
        sun(above, scene);
        scene.getOrCreateStateSet()->setMode(GL_LIGHTING, off | osg::StateAttribute::OVERRIDE);
    };
    // Nothing is left to differ but how two programs round.
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, unlit), *draw(CoarseBare, unlit),
                                         {1.1f / 255, 0.0, 1.1f / 255}, "unlit"));

    // A lamp that has been on keeps its colors in OpenGL.
    draw(Full, sun);
    const auto dark = [](osg::Group&, osg::Group& scene)
    {
        scene.getOrCreateStateSet()->setMode(GL_LIGHTING, on);
    };
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, dark), *draw(CoarseBare, dark),
                                         {1.1f / 255, 0.0, 1.1f / 255}, "no lamp"));

    const auto fog = [](osg::Fog::Mode mode)
    {
        return [mode](osg::Group& above, osg::Group& scene)
        {
            sun(above, scene);
            const osg::ref_ptr<osg::Fog> haze = new osg::Fog;
            haze->setMode(mode);
            haze->setColor({0.7f, 0.75f, 0.8f, 1});
            haze->setDensity(0.12f);
            if (mode == osg::Fog::LINEAR) haze->setStart(3.0f);
            if (mode == osg::Fog::LINEAR) haze->setEnd(12.0f);
            scene.getOrCreateStateSet()->setAttributeAndModes(haze);
        };
    };
    for (const osg::Fog::Mode mode : {osg::Fog::LINEAR, osg::Fog::EXP})
    {
        const osg::ref_ptr<osg::Image> full = draw(Full, fog(mode));
        expectAlike(*draw(Coarse, fog(mode)), *full, mode == osg::Fog::EXP ? "fog exp" : "fog linear");
        expectUnlike(*draw(Full, sun), *full, "fog shows");
    }
}

// Of lamps beside lamp 0 it has what vertices have; and no lamp 0 where there is none.
TEST_F(TileLight, OtherLampsInPlainOpenSceneGraph)
{
    const auto second = [](osg::Group& above, osg::Group& scene)
    {
        addLamp(above, scene, 1, {0.7f, -0.2f, 0.5f, 0})->setDiffuse({0.3f, 0.25f, 0.2f, 1});
    };
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, second), *draw(CoarseBare, second),
                                         {1.1f / 255, 0.0, 1.1f / 255}, "lamp 1 alone"));
    const auto both = [&](osg::Group& above, osg::Group& scene)
    {
        sun(above, scene);
        second(above, scene);
    };
    const osg::ref_ptr<osg::Image> full = draw(Full, both);
    const double bare = differenceOf(*draw(CoarseBare, both), *full).mean;
    EXPECT_GT(bare, 3.0);
    EXPECT_LT(differenceOf(*draw(Coarse, both), *full).mean, 0.8 * bare);
    // A lamp with a place: nothing tells a fragment's.
    const auto bulb = [](osg::Group& above, osg::Group& scene)
    {
        addLamp(above, scene, 0, {1, -1, 2, 1});
    };
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, bulb), *draw(CoarseBare, bulb),
                                         {1.1f / 255, 0.0, 1.1f / 255}, "a lamp with a place"));
}

TEST_F(TileLight, EffectSceneWithoutEffects)
{
    expectAlike(*draw(Coarse, sun, {}, true), *draw(Full, sun), "without effects");
}

TEST_F(TileLight, UnderEffects)
{
    const osg::ref_ptr<VerticalExaggeration> still = new VerticalExaggeration;
    still->setFactor(1.0000001); // the kit's program, and nothing moves
    const osg::ref_ptr<osg::Image> full = draw(Full, sun);
    expectAlike(*draw(Coarse, sun, {still}, true), *full, "kit");
    expectAlike(*draw(CoarseOfThree, sun, {still}, true), *full, "kit with three channels");
    expectAlike(*draw(CoarseOfPart, sun, {still}, true), *full, "kit with part of a texture");
    expectUnlike(*draw(CoarseBare, sun, {still}, true), *full, "kit with vertices alone");

    // The exaggeration turns normals, and has its own in each fragment.
    const osg::ref_ptr<VerticalExaggeration> steep = new VerticalExaggeration;
    steep->setFactor(1.8);
    const osg::ref_ptr<osg::Image> exaggerated = draw(Full, sun, {steep}, true);
    expectUnlike(*exaggerated, *full, "exaggerated");
    expectAlike(*draw(Coarse, sun, {steep}, true), *exaggerated, "exaggerated");
    steep->setRelight(false);
    const osg::ref_ptr<osg::Image> asBefore = draw(Full, sun, {steep}, true);
    expectUnlike(*asBefore, *exaggerated, "not lit anew");
    expectAlike(*draw(Coarse, sun, {steep}, true), *asBefore, "not lit anew");
}

TEST_F(TileLight, UnderEffectsModesAreKnown)
{
    const osg::ref_ptr<VerticalExaggeration> still = new VerticalExaggeration;
    still->setFactor(1.0000001);
    // A lamp with a place, and one that is off though it has colors: the kit sees what is in force.
    const auto bulb = [](osg::Group& above, osg::Group& scene)
    {
        addLamp(above, scene, 1, {1, -1, 2, 1});
        addLamp(above, scene, 0, {-0.8f, -0.3f, 0.6f, 0});
        scene.getOrCreateStateSet()->setMode(GL_LIGHT0, off);
    };
    expectAlike(*draw(Coarse, bulb, {still}, true), *draw(Full, bulb, {still}, true), "a lamp with a place");
    expectUnlike(*draw(CoarseBare, bulb, {still}, true), *draw(Full, bulb, {still}, true), "vertices alone");
    const auto unlit = [](osg::Group& above, osg::Group& scene)
    {
        sun(above, scene);
        scene.getOrCreateStateSet()->setMode(GL_LIGHTING, off | osg::StateAttribute::OVERRIDE);
    };
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, unlit, {still}, true),
                                         *draw(CoarseBare, unlit, {still}, true), {}, "unlit"));
}

TEST_F(TileLight, BentAsTheFullMeshIs)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<osg::Image> full = draw(Full, sun, {bend}, true);
    EXPECT_GT(differenceOf(*full, *draw(Full, sun)).onlyOne, 0.02); // the bend shows
    expectAlike(*draw(Coarse, sun, {bend}, true), *full, "bent");
}

TEST_F(TileLight, AHostsProgramHasTheNormalsOfVertices)
{
    const auto host = [](osg::Group& above, osg::Group& scene)
    {
        sun(above, scene);
        const osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(
            new osg::Shader(osg::Shader::VERTEX,
                            "#version 120\n"
                            "varying vec3 shade;\n"
                            "void main() { gl_Position = ftransform(); shade = 0.5 * gl_Normal + 0.5; }\n"));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                           "#version 120\n"
                                           "varying vec3 shade;\n"
                                           "void main() { gl_FragColor = vec4(shade, 1.0); }\n"));
        above.getOrCreateStateSet()->setAttributeAndModes(program, overriding);
        static_cast<void>(scene);
    };
    const osg::ref_ptr<osg::Image> bare = draw(CoarseBare, host);
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, host), *bare, {}, "plain"));
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, host, {}, true), *bare, {}, "scene"));
    // An empty program that overrides brings the fixed functions back.
    const auto fixed = [](osg::Group& above, osg::Group& scene)
    {
        sun(above, scene);
        above.getOrCreateStateSet()->setAttributeAndModes(new osg::Program, overriding);
    };
    EXPECT_TRUE(geofx::test::imagesMatch(*draw(Coarse, fixed), *draw(CoarseBare, sun), {}, "fixed"));
}

namespace
{

/// The ground so many times as large, and at a level, metres; the coarse one with its texture and the database's program.
osg::ref_ptr<osg::Node> makeLarge(double scale, double level, bool coarse, bool texture,
                                  osg::StateSet* database)
{
    const osg::ref_ptr<osg::Geometry> mesh = makeMesh(coarse ? 8 : 1);
    if (texture) addNormals(*mesh->getOrCreateStateSet());
    const osg::ref_ptr<osg::MatrixTransform> large = new osg::MatrixTransform(
        osg::Matrixd::scale(scale, scale, scale) * osg::Matrixd::translate(0.0, 0.0, level));
    large->addChild(mesh);
    if (texture) large->setStateSet(osg::clone(database, osg::CopyOp::SHALLOW_COPY));
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
    material->setDiffuse(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
    large->getOrCreateStateSet()->setAttributeAndModes(material);
    large->getOrCreateStateSet()->setMode(GL_NORMALIZE, on);
    return large;
}

} // namespace

/// The painting of a panorama map goes by the texture, too, light and slopes.
TEST_F(TileLight, PaintedAsTheFullMeshIs)
{
    const auto paint = [&](bool coarse, bool texture)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setTerrainFrame(EffectScene::PROJECTED);
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setViewRadius(3000.0);
        map->setStrokes(false);
        map->setReflection(0.0);
        scene->addEffect(map);
        scene->addChild(makeLarge(1000.0, 500.0, coarse, texture, _stateOfDatabase));
        viewer().getCamera()->setViewMatrixAsLookAt({0, -3900, 3000}, {0, 0, 0}, {0, 0, 1});
        viewer().getCamera()->setProjectionMatrixAsPerspective(40, 1.2, 10, 1e5);
        return render(scene);
    };
    const osg::ref_ptr<osg::Image> full = paint(false, false);
    const osg::ref_ptr<osg::Image> lit = paint(true, true);
    const osg::ref_ptr<osg::Image> bare = paint(true, false);
    const double without = differenceOf(*bare, *full).mean;
    EXPECT_GT(without, 2.0);
    // Classes change abruptly with the slope, so single pixels may differ by much.
    EXPECT_LT(differenceOf(*lit, *full).mean, 0.5 * without);
    osgDB::writeImageFile(*lit, (geofx::test::testOutputFolder() / "painted.png").string());
    osgDB::writeImageFile(*full, (geofx::test::testOutputFolder() / "painted full.png").string());
}

class TileCloseUps : public geofx::test::CloseUpStage
{
};

/// Geometry stages, which close-ups have, hand on what fragments need for their light.
TEST_F(TileCloseUps, AreLitAsTheFullMeshIs)
{
    const osg::ref_ptr<osg::StateSet> database = stateOfDatabase();
    viewer().getCamera()->setClearColor({1, 0, 1, 1});
    _closeUps->addCloseUp(makeCloseUp({0.0, 0.0}, 700.0, 250.0));
    const auto show = [&](bool coarse, bool texture)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(makeLarge(250.0, 0.0, coarse, texture, database));
    };
    show(false, false);
    const auto full = drawBoth();
    show(true, true);
    const auto lit = drawBoth();
    show(true, false);
    const auto bare = drawBoth();
    for (const bool single : {true, false})
    {
        const osg::Image& expected = single ? *full.first : *full.second;
        const double without = differenceOf(single ? *bare.first : *bare.second, expected).mean;
        const double with = differenceOf(single ? *lit.first : *lit.second, expected).mean;
        EXPECT_GT(without, 3.0) << single;
        // The outlines of the lifted ground, and of the ground behind it, are the geometry's.
        EXPECT_LT(with, 0.5 * without) << single;
    }
    osgDB::writeImageFile(*lit.first, (geofx::test::testOutputFolder() / "single.png").string());
    osgDB::writeImageFile(*full.first, (geofx::test::testOutputFolder() / "single full.png").string());
}
