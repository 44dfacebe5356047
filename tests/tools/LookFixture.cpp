// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/LookFixture.h>

#include <tools/ImageComparison.h>

#include <osg/LightSource>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <cmath>
#include <cstring>

namespace geofx::test
{

namespace
{

bool isBackground(const unsigned char* pixel)
{
    constexpr unsigned char background[] = {26, 51, 77, 0};
    return std::memcmp(pixel, background, sizeof background) == 0;
}

int covered(const osg::Image& image)
{
    int count = 0;
    for (unsigned int i = 0; i < image.getTotalSizeInBytes(); i += 4)
        count += isBackground(image.data() + i) ? 0 : 1;
    return count;
}

osg::ref_ptr<osg::Image> makeImage(GLenum format, GLint internalFormat)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(16, 16, 1, format, GL_UNSIGNED_BYTE);
    image->setInternalTextureFormat(internalFormat);
    const unsigned int channels = osg::Image::computeNumComponents(format);
    for (unsigned int i = 0; i < 256 * channels; ++i)
    {
        const unsigned int texel = i / channels;
        const unsigned int step = 37 + 31 * (i % channels);
        image->data()[i] = static_cast<unsigned char>(40 + (texel / 4 * step + texel % 16 * 9) % 200);
    }
    return image;
}

} // namespace

void LookFixture::SetUp()
{
    GlFixture::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    osg::Camera& camera = *viewer().getCamera();
    camera.setClearColor({26 / 255.0f, 51 / 255.0f, 77 / 255.0f, 0});
    camera.setViewMatrixAsLookAt({1, -13, 8}, {0, 0, 0}, {0, 0, 1});
    camera.setProjectionMatrixAsPerspective(38, 1.2, 1, 100);
    viewer().setLightingMode(osg::View::NO_LIGHT);
}

void LookFixture::compare(const std::string& name, const Build& build, int tolerance, bool moves)
{
    SCOPED_TRACE(name);
    const osg::ref_ptr<osg::Image> expected = renderPlain(build);
    EXPECT_GT(covered(*expected), 500);

    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    root->addChild(scene);
    build({*root, *scene});
    const osg::ref_ptr<osgGeoFX::VerticalExaggeration> lift = new osgGeoFX::VerticalExaggeration;
    scene->addEffect(lift);
    // Too little to move a vertex; normals take their way through the effect.
    lift->setFactor(1.0000001);
    osg::ref_ptr<osg::Image> drawn, lifted;
    const std::vector<std::string> said = watch().messagesOf(
        [&]
        {
            drawn = render(root);
            // So that the comparison says something: it was the kit's program that drew it.
            lift->setFactor(1.7);
            lifted = render(root);
        });
    expectSame(*drawn, *expected, tolerance, name);
    EXPECT_EQ(std::memcmp(lifted->data(), expected->data(), expected->getTotalSizeInBytes()) != 0, moves);
    // A program that does not call the functions is told of.
    EXPECT_EQ(said.size(), moves ? 0u : 1u) << ::testing::PrintToString(said);
}

osg::ref_ptr<osg::Image> LookFixture::renderPlain(const Build& build)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Group> plain = new osg::Group;
    root->addChild(plain);
    build({*root, *plain});
    return render(root);
}

void LookFixture::expectSame(const osg::Image& actual, const osg::Image& expected, int tolerance,
                             const std::string& name)
{
    int differing = 0;
    for (unsigned int i = 0; i < expected.getTotalSizeInBytes(); i += 4)
        differing += isBackground(actual.data() + i) != isBackground(expected.data() + i) ? 1 : 0;
    EXPECT_EQ(differing, 0) << "pixels that only one of the two covers";
    const float most = (static_cast<float>(tolerance) + 0.1f) / 255.0f;
    EXPECT_TRUE(imagesMatch(actual, expected, {most, 0.0, most}, name));
}

osg::ref_ptr<osg::Geometry> LookFixture::makeWaves()
{
    constexpr int cells = 24;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            const float x = 8.0f * static_cast<float>(i) / cells - 4.0f;
            const float y = 8.0f * static_cast<float>(j) / cells - 4.0f;
            vertices->push_back({x, y, 0.8f * std::sin(x) * std::cos(y) + 0.05f * x});
            osg::Vec3 normal(-0.8f * std::cos(x) * std::cos(y) - 0.05f, 0.8f * std::sin(x) * std::sin(y), 1);
            normal.normalize();
            normals->push_back(normal);
            colors->push_back({0.5f + x / 8, 0.5f + y / 8, 0.5f - x / 16, 0.6f + y / 12});
            coordinates->push_back({0.3f * x, 0.3f * y});
            if (i == cells || j == cells) continue;
            const auto a = static_cast<GLushort>(j * (cells + 1) + i);
            const auto b = static_cast<GLushort>(a + cells + 1);
            for (const int index : {+a, a + 1, +b, a + 1, b + 1, +b})
                triangles->push_back(static_cast<GLushort>(index));
        }
    }
    osg::ref_ptr<osg::Geometry> waves = new osg::Geometry;
    waves->setUseDisplayList(false);
    waves->setUseVertexBufferObjects(false);
    waves->setVertexArray(vertices);
    waves->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    waves->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    for (unsigned int unit = 0; unit < 4; ++unit)
        waves->setTexCoordArray(unit, coordinates);
    waves->addPrimitiveSet(triangles);
    return waves;
}

osg::ref_ptr<osg::Geometry> LookFixture::makeWaves(GLenum primitive)
{
    osg::ref_ptr<osg::Geometry> waves = makeWaves();
    const auto count = static_cast<GLsizei>(waves->getVertexArray()->getNumElements());
    waves->setPrimitiveSet(0, new osg::DrawArrays(primitive, 0, count));
    return waves;
}

osg::ref_ptr<osg::Texture2D> LookFixture::makeTexture(GLenum format, GLint internalFormat)
{
    osg::ref_ptr<osg::Texture2D> texture =
        new osg::Texture2D(makeImage(format, internalFormat ? internalFormat : static_cast<GLint>(format)));
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    return texture;
}

void LookFixture::addTexture(osg::StateSet& state, unsigned int unit, GLenum format, osg::TexEnv::Mode mode,
                             GLint internalFormat)
{
    state.setTextureAttributeAndModes(unit, makeTexture(format, internalFormat));
    osg::ref_ptr<osg::TexEnv> environment = new osg::TexEnv(mode);
    environment->setColor({0.9f, 0.3f, 0.1f, 0.4f});
    state.setTextureAttribute(unit, environment);
}

osg::ref_ptr<osg::Light> LookFixture::addLight(const Place& place, int number, const osg::Vec4& position)
{
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::ref_ptr<osg::Light> light = new osg::Light(static_cast<unsigned int>(number));
    light->setPosition(position);
    light->setAmbient({0.1f, 0.05f, 0.1f, 1});
    light->setDiffuse({0.7f, 0.6f - 0.2f * static_cast<float>(number), 0.4f, 1});
    light->setSpecular({0.8f, 0.8f, 0.6f, 1});
    source->setLight(light);
    place.above.addChild(source);
    place.state().setMode(GL_LIGHTING, on);
    place.state().setMode(static_cast<GLenum>(GL_LIGHT0 + number), on);
    return light;
}

void LookFixture::addSun(const Place& place)
{
    addLight(place, 0, {-0.5f, -0.6f, 0.7f, 0});
}

osg::ref_ptr<osg::Material> LookFixture::makeMaterial(float shininess, osg::Material::ColorMode mode)
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(mode);
    material->setAmbient(osg::Material::FRONT_AND_BACK, {0.6f, 0.3f, 0.5f, 1});
    material->setDiffuse(osg::Material::FRONT, {0.8f, 0.5f, 0.2f, 0.7f});
    material->setDiffuse(osg::Material::BACK, {0.1f, 0.9f, 0.4f, 0.5f});
    material->setSpecular(osg::Material::FRONT_AND_BACK, {0.7f, 0.6f, 0.9f, 1});
    material->setEmission(osg::Material::FRONT_AND_BACK, {0.05f, 0.1f, 0.02f, 1});
    material->setShininess(osg::Material::FRONT_AND_BACK, shininess);
    return material;
}

} // namespace geofx::test
