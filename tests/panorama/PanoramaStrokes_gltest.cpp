// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Brush strokes as the GPU draws them: over hills seen from above, in a map's scale.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/panorama/detail/StrokeMaker.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <tools/GlFixture.h>
#include <tools/TempDir.h>

#include <osg/BlendFunc>
#include <osg/Geometry>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int width = 512;
constexpr int height = 384;
constexpr double side = 6400.0; ///< of the ground, metres
constexpr int posts = 129;

double heightAt(double x, double y)
{
    const double ridge = 500.0 * std::exp(-std::pow((y - 900.0 + 0.3 * x) / 700.0, 2.0));
    return ridge + 120.0 * std::sin(x / 500.0) * std::cos(y / 650.0) + 150.0;
}

osg::ref_ptr<osg::Geometry> hills()
{
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int row = 0; row < posts; ++row)
    {
        for (int column = 0; column < posts; ++column)
        {
            const double u = column / (posts - 1.0), v = row / (posts - 1.0);
            const double x = (u - 0.5) * side, y = (v - 0.5) * side;
            vertices->push_back(osg::Vec3d(x, y, heightAt(x, y)));
            osg::Vec3d normal(heightAt(x - 1.0, y) - heightAt(x + 1.0, y),
                              heightAt(x, y - 1.0) - heightAt(x, y + 1.0), 2.0);
            normal.normalize();
            normals->push_back(normal);
            coordinates->push_back(osg::Vec2d(u, v));
            if (row + 1 == posts || column + 1 == posts) continue;
            const auto first = static_cast<unsigned int>(row * posts + column);
            for (const unsigned int index :
                 {first, first + 1, first + posts + 1, first, first + posts + 1, first + posts})
                triangles->push_back(index);
        }
    }
    mesh->setVertexArray(vertices);
    mesh->setNormalArray(normals);
    mesh->setTexCoordArray(0, coordinates);
    mesh->addPrimitiveSet(triangles);
    mesh->setUseDisplayList(false);
    mesh->setUseVertexBufferObjects(true);
    return mesh;
}

/// Woods in the west, thinner to the east; a lake, and a town beside it.
osg::ref_ptr<osg::Texture2D> cover(bool treesOnly)
{
    constexpr int texels = 256;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(texels, texels, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int row = 0; row < texels; ++row)
    {
        for (int column = 0; column < texels; ++column)
        {
            const double u = (column + 0.5) / texels, v = (row + 0.5) / texels;
            glsl::geofx_Cover at = {};
            const double lake = std::hypot(u - 0.7, (v - 0.25) * 1.5);
            const double town = std::hypot(u - 0.55, v - 0.2);
            at.shore = treesOnly ? -1000.0 : (0.12 - lake) * side;
            at.town = !treesOnly && town < 0.08 ? 0.7 : 0.0;
            at.trees = treesOnly       ? 1.0
                       : at.town > 0.0 ? 0.1
                                       : std::clamp(1.6 - 1.8 * u + 0.4 * std::sin(9.0 * v), 0.0, 1.0);
            const glsl::Rgba texel = glsl::geofx_coverTexel(at);
            image->setColor(osg::Vec4d(texel.x, texel.y, texel.z, texel.w), static_cast<unsigned int>(column),
                            static_cast<unsigned int>(row));
        }
    }
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    return texture;
}

osg::ref_ptr<osg::Texture2D> palette()
{
    // From shade to light: what the strokes and the ground below them take.
    const osg::Vec3 rows[8][3] = {{{.35f, .50f, .55f}, {.62f, .70f, .36f}, {.92f, .90f, .52f}}, // field
                                  {{.38f, .38f, .55f}, {.66f, .55f, .40f}, {.95f, .80f, .50f}}, // hill
                                  {{.30f, .30f, .52f}, {.52f, .38f, .36f}, {.90f, .66f, .46f}}, // cliff
                                  {{.60f, .66f, .88f}, {.84f, .86f, .95f}, {1.0f, .99f, .95f}}, // snow
                                  {{.14f, .13f, .30f}, {.12f, .22f, .20f}, {.24f, .34f, .16f}}, // forest
                                  {{.25f, .22f, .48f}, {.22f, .38f, .28f}, {.62f, .74f, .26f}}, // trees
                                  {{.50f, .46f, .58f}, {.82f, .72f, .60f}, {1.0f, .93f, .80f}}, // town
                                  {{.50f, .48f, .55f}, {.75f, .70f, .60f}, {.96f, .92f, .80f}}};
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(256, 8, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int row = 0; row < 8; ++row)
    {
        for (int column = 0; column < 256; ++column)
        {
            const float t = static_cast<float>(column) / 127.5f;
            const osg::Vec3 color = t < 1.0f ? rows[row][0] * (1.0f - t) + rows[row][1] * t
                                             : rows[row][1] * (2.0f - t) + rows[row][2] * (t - 1.0f);
            image->setColor(osg::Vec4(color, 1.0f), static_cast<unsigned int>(column),
                            static_cast<unsigned int>(row));
        }
    }
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    return texture;
}

/// What PanoramaMap adds, for a plain orthographic map.
const char* const vertexStandIns = R"(
uniform float SLOT_scale;
uniform vec4 SLOT_light;
vec3 SLOT_move(vec3 located, vec3 bent) { return bent; }
float SLOT_groundScale(vec3 eye) { return SLOT_scale; }
float SLOT_strokeLight(vec3 eye, vec3 normal, float y) { return dot(normal, SLOT_light.xyz); }
vec3 SLOT_strokeAir(vec3 color, vec3 eye) { return color; }
float SLOT_strokeFar(vec3 eye) { return 0.0; }
float SLOT_strokeDepth(vec3 eye) { return 0.0; }
float SLOT_strokeTreeShare(vec3 eye) { return 0.0; }
float SLOT_strokeShown(vec3 eye) { return 1.0; }
float SLOT_strokeSteepness(vec3 eye, vec3 normal) { return 1.0; }
vec3 SLOT_strokeOpen(vec3 eye, float steepness, float bare, float light) { return vec3(0.5, 0.4, 0.35) + 0.3 * light; }
vec3 SLOT_strokeShift(vec3 eye, vec3 normal, float land, float scale) { return vec3(0.0); }
)";
const char* const fragmentStandIns = R"(
vec4 SLOT_finish(vec4 color) { return color; }
int SLOT_channels() { return 0; }
vec2 SLOT_pixel(vec2 pixel) { return pixel; }
)";

osg::ref_ptr<osg::Program> strokesProgram()
{
    const TempDir folder;
    folder.write("strokes.vert.glsl", vertexStandIns);
    folder.write("strokes.frag.glsl", fragmentStandIns);
    setenv("OSGGEOFX_SHADER_PATH", folder.path().c_str(), 1);
    PassShaders pass;
    pass.vertex = {"strokes.vert.glsl"};
    pass.geometry = {"stages/panorama.strokes.geom.glsl"};
    pass.fragment = {"strokes.frag.glsl"};
    pass.vertexMain = "stages/panorama.strokes.vert";
    pass.fragmentMain = "stages/panorama.strokes.frag";
    osg::ref_ptr<osg::Program> program = EffectProgram::create({}, pass, "test_");
    unsetenv("OSGGEOFX_SHADER_PATH");
    return program;
}

/// The ground in the base colors below strokes.
osg::ref_ptr<osg::Program> groundProgram()
{
    const char* vertex = R"(#version 330 compatibility
uniform vec4 test_light;
out float light;
out vec2 at;
void main()
{
    light = dot(normalize(gl_NormalMatrix * gl_Normal), test_light.xyz);
    at = gl_MultiTexCoord0.xy;
    gl_Position = ftransform();
})";
    const char* fragment = R"(#version 330 compatibility
#include "lib/cover.glsl"
uniform sampler2D test_palette;
uniform sampler2D test_cover;
in float light;
in vec2 at;
vec3 row(float number)
{
    return texture(test_palette, vec2(0.5 + 0.498 * light, (number + 0.5) / 8.0)).rgb;
}
void main()
{
    geofx_Cover cover = geofx_coverOf(texture(test_cover, at));
    vec3 ground = mix(mix(row(0.0), row(4.0), smoothstep(0.1, 0.6, cover.trees)), row(6.0), cover.town);
    gl_FragColor = vec4(mix(ground, vec3(0.45, 0.68, 0.82), smoothstep(-15.0, 15.0, cover.shore)), 1.0);
})";
    const ShaderLibrary library;
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, library.assemble(fragment, "ground")));
    return program;
}

struct Map
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Geometry> strokes;
    osg::ref_ptr<osg::Uniform> scale = new osg::Uniform("test_scale", 0.1f);
    osg::ref_ptr<osg::Uniform> stroke = new osg::Uniform("test_stroke", osg::Vec4(8.0f, 8.0f, 25.0f, 1.0f));
};

Map makeMap(bool treesOnly, bool withGround)
{
    Map map;
    const osg::ref_ptr<osg::Geometry> mesh = hills();
    osg::StateSet* ground = mesh->getOrCreateStateSet();
    ground->setTextureAttribute(7, cover(treesOnly));
    ground->setAttributeAndModes(groundProgram());
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    StrokeParameters parameters;
    parameters.strokesAlongTile = 256.0;
    parameters.cliffSlope =
        treesOnly ? 100.0 : 2.0; // the ridge has strokes along its fall lines, the fields have none
    maker->setParameters(parameters);
    map.strokes = maker->strokes(*mesh, osg::Matrixd());
    if (!map.strokes) return map;
    osg::StateSet* state = map.strokes->getOrCreateStateSet();
    state->setAttributeAndModes(strokesProgram());
    state->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA));
    state->setRenderBinDetails(1, "RenderBin");
    osg::StateSet* all = map.root->getOrCreateStateSet();
    all->setTextureAttribute(6, palette());
    all->addUniform(new osg::Uniform("test_palette", 6));
    all->addUniform(new osg::Uniform("test_cover", 7));
    all->addUniform(new osg::Uniform("test_viewport", osg::Vec4(width, height, 1.0f / width, 1.0f / height)));
    osg::Vec4 light(-0.6f, 0.35f, 0.55f, 0.0f);
    light.normalize();
    all->addUniform(new osg::Uniform("test_light", light));
    all->addUniform(map.scale);
    all->addUniform(map.stroke);
    if (withGround) map.root->addChild(mesh);
    map.root->addChild(map.strokes);
    return map;
}

const double straightDown = 0.5 * osg::PI;

/// Without ground, all that is not black.
bool isStroke(const osg::Image& image, int x, int y)
{
    const osg::Vec4 color = image.getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    return color.x() + color.y() + color.z() > 0.1f;
}

class PanoramaStrokes : public GlFixture
{
protected:
    PanoramaStrokes() : GlFixture(width, height) {}

    /// Obliquely from the south, `metres` of ground across.
    osg::ref_ptr<osg::Image> draw(const Map& map, double metres, double pitch)
    {
        osg::Camera* camera = viewer().getCamera();
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        const double half = 0.5 * metres;
        camera->setProjectionMatrixAsOrtho(-half, half, -half * height / width, half * height / width, 100.0,
                                           3e4);
        const osg::Vec3d eye(0.0, -1e4 * std::cos(pitch), 1e4 * std::sin(pitch));
        camera->setViewMatrixAsLookAt(eye, osg::Vec3d(0.0, 0.0, 0.0), osg::Vec3d(0.0, 1.0, 0.0));
        map.scale->set(static_cast<float>(width / metres * std::sqrt(std::sin(pitch))));
        const osg::ref_ptr<osg::Image> image = render(map.root);
        return image;
    }
};

/// The share of pixels that strokes cover, from 0 to 1 of each side of the picture.
double covered(const osg::Image& image, double share = 1.0)
{
    const int left = static_cast<int>(0.5 * (1.0 - share) * width),
              bottom = static_cast<int>(0.5 * (1.0 - share) * height);
    int count = 0;
    for (int y = bottom; y < height - bottom; ++y)
        for (int x = left; x < width - left; ++x)
            count += isStroke(image, x, y) ? 1 : 0;
    return static_cast<double>(count) / ((width - 2 * left) * (height - 2 * bottom));
}

TEST_F(PanoramaStrokes, CoverTheGroundAlikeAtAnyZoom)
{
    const Map map = makeMap(true, false);
    ASSERT_TRUE(map.strokes.valid());
    // From the spacing of the lattice to that of level 3: a zoom of 8.
    std::vector<double> shares;
    for (int i = 0; i <= 12; ++i)
    {
        const double metres = 25.0 / 8.0 * width * std::exp2(i / 4.0);
        shares.push_back(covered(*draw(map, metres, straightDown), std::min(0.95, 0.8 * side / metres)));
    }
    const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
    std::cout << "covered " << *least << ".." << *most << std::endl;
    // The dark base shows between them, and there is a wood.
    EXPECT_GT(*least, 0.3);
    EXPECT_LT(*most, 0.65);
    EXPECT_LT(*most / *least, 1.25);
}

TEST_F(PanoramaStrokes, GoWhereTheyWouldBeTooDense)
{
    const Map map = makeMap(true, false);
    const double near = covered(*draw(map, 1600.0, straightDown));
    EXPECT_GT(near, 0.3);
    // What is 1000 times denser on the screen than wanted is gone but for one in as many.
    map.stroke->set(osg::Vec4(8.0f, 8.0f * 32.0f, 25.0f, 1.0f));
    EXPECT_LT(covered(*draw(map, 1600.0, straightDown)), near / 200.0);
    map.stroke->set(osg::Vec4(0.0f, 8.0f, 25.0f, 1.0f));
    EXPECT_EQ(covered(*draw(map, 1600.0, straightDown)), 0.0);
}

TEST_F(PanoramaStrokes, HaveTheirSizeInPixels)
{
    const Map map = makeMap(true, false);
    // Far apart, so that they hide nothing of each other.
    map.stroke->set(osg::Vec4(6.0f, 40.0f, 25.0f, 1.0f));
    const double small = covered(*draw(map, 3200.0, straightDown));
    map.stroke->set(osg::Vec4(12.0f, 40.0f, 25.0f, 1.0f));
    const double large = covered(*draw(map, 3200.0, straightDown));
    EXPECT_NEAR(large / small, 4.0, 0.4);
}

TEST_F(PanoramaStrokes, StandOnTheirFeet)
{
    const Map map = makeMap(true, false);
    map.stroke->set(osg::Vec4(12.0f, 40.0f, 25.0f, 1.0f));
    const double metres = 3200.0;
    const osg::ref_ptr<osg::Image> image = draw(map, metres, straightDown);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*map.strokes->getVertexArray());
    const auto& traits = static_cast<const osg::Vec4sArray&>(*map.strokes->getTexCoordArray(0));
    const double wanted = glsl::geofx_strokeWanted(40.0, 25.0, width / metres);
    int feet = 0, shown = 0, hanging = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        const double scale = glsl::geofx_strokeScale(0.5 * traits[i].y(), traits[i].w() / 32767.0, wanted);
        const osg::Vec3d at(vertices[i]);
        const int x = static_cast<int>(std::floor(0.5 * width + at.x() * width / metres));
        const int y = static_cast<int>(std::floor(0.5 * height + at.y() * width / metres));
        if (scale < 1.0 || x < 10 || y < 10 || x > width - 10 || y > height - 20) continue;
        ++feet;
        shown += isStroke(*image, x, y + 4) ? 1 : 0;
        hanging += isStroke(*image, x, y - 4) ? 1 : 0;
    }
    EXPECT_GT(feet, 40);
    EXPECT_EQ(shown, feet);
    EXPECT_LT(hanging, feet / 8); // those that stand before others
}

TEST_F(PanoramaStrokes, TakeTheColorsOfLightAndShade)
{
    const Map map = makeMap(true, false);
    const auto mean = [&](const osg::Vec4& light)
    {
        map.root->getStateSet()->getUniform("test_light")->set(light);
        const osg::ref_ptr<osg::Image> image = draw(map, 2400.0, straightDown);
        osg::Vec4d sum;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (isStroke(*image, x, y))
                    sum += osg::Vec4d(
                        image->getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
        return sum / sum.w();
    };
    const osg::Vec4d light = mean(osg::Vec4(0.0f, 0.0f, 1.0f, 0.0f)),
                     shade = mean(osg::Vec4(0.0f, 0.0f, -1.0f, 0.0f));
    EXPECT_GT(light.y(), shade.y() + 0.15);
    EXPECT_GT(shade.z(), light.z() + 0.05);
}

TEST_F(PanoramaStrokes, LieOnTheirGround)
{
    const Map map = makeMap(false, true);
    const double metres = 6000.0;
    const osg::ref_ptr<osg::Image> painted = draw(map, metres, straightDown);
    map.strokes->setNodeMask(0u);
    const osg::ref_ptr<osg::Image> bare = draw(map, metres, straightDown);
    // How much of a square of the ground is painted over; its middle and size in shares of the ground's side.
    const auto share = [&](double u, double v, double size)
    {
        int changed = 0, all = 0;
        const double scale = width * side / metres;
        for (int y = 0; y < height; ++y)
        {
            for (int x = 0; x < width; ++x)
            {
                const double du = (x + 0.5 - 0.5 * width) / scale + 0.5 - u;
                const double dv = (y + 0.5 - 0.5 * height) / scale + 0.5 - v;
                if (std::max(std::abs(du), std::abs(dv)) > 0.5 * size) continue;
                ++all;
                const auto column = static_cast<unsigned int>(x), row = static_cast<unsigned int>(y);
                changed +=
                    (painted->getColor(column, row) - bare->getColor(column, row)).length() > 0.05f ? 1 : 0;
            }
        }
        return all > 0 ? static_cast<double>(changed) / all : -1.0;
    };
    EXPECT_EQ(share(0.7, 0.25, 0.05), 0.0);  // the lake
    EXPECT_GT(share(0.1, 0.3, 0.1), 0.35);   // the woods
    EXPECT_GT(share(0.53, 0.2, 0.05), 0.15); // the town
    EXPECT_LT(share(0.9, 0.5, 0.04), 0.02);  // the fields
}

} // namespace
