// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Scenes with effects below the shadow techniques of OSG, whose cameras have no parents: what the light sees is not bent.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>

#include <osg/LightSource>
#include <osg/Program>
#include <osgShadow/LightSpacePerspectiveShadowMap>
#include <osgShadow/ParallelSplitShadowMap>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowTexture>
#include <osgShadow/ShadowedScene>
#include <osgShadow/SoftShadowMap>
#include <osgShadow/StandardShadowMap>
#include <osgShadow/ViewDependentShadowMap>

#include <cmath>
#include <functional>
#include <iostream>
#include <utility>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int shadowUnit = 1;
const osg::Vec3 toLight(-0.75f, -0.2f, 0.63f);

/// A box as BentGround makes it: `size` wide and twice as high.
struct Block
{
    float size;
    osg::Vec3 place;
};

using Blocks = std::vector<Block>;

/// A caster beside a wall that gets its shadow.
Blocks blocksAt(float y)
{
    return {{9.0f, {-24.0f, y - 5.0f, 0.0f}}, {16.0f, {0.0f, y, 0.0f}}};
}

struct Technique
{
    const char* name;
    std::function<osg::ref_ptr<osgShadow::ShadowTechnique>()> make;
};

std::vector<Technique> techniques()
{
    return {{"ShadowMap",
             []
             {
                 osg::ref_ptr<osgShadow::ShadowMap> map = new osgShadow::ShadowMap;
                 map->setTextureUnit(shadowUnit);
                 map->setTextureSize({2048, 2048});
                 return map;
             }},
            {"StandardShadowMap",
             []
             {
                 osg::ref_ptr<osgShadow::StandardShadowMap> map = new osgShadow::StandardShadowMap;
                 map->setTextureSize({2048, 2048});
                 return map;
             }},
            {"LightSpacePerspectiveShadowMapDB",
             []
             {
                 osg::ref_ptr<osgShadow::LightSpacePerspectiveShadowMapDB> map =
                     new osgShadow::LightSpacePerspectiveShadowMapDB;
                 map->setTextureSize({2048, 2048});
                 return map;
             }},
            {"ViewDependentShadowMap", []
             {
                 return osg::ref_ptr<osgShadow::ShadowTechnique>(new osgShadow::ViewDependentShadowMap);
             }}};
}

/// Those whose maps no program of the application looks up. (The shaders that a ViewDependentShadowMap may bring are refused by Mesa.)
std::vector<Technique> otherTechniques()
{
    constexpr short size = 1024;
    return {{"ViewDependentShadowMap",
             []
             {
                 return osg::ref_ptr<osgShadow::ShadowTechnique>(new osgShadow::ViewDependentShadowMap);
             }},
            {"SoftShadowMap",
             []
             {
                 osg::ref_ptr<osgShadow::SoftShadowMap> map = new osgShadow::SoftShadowMap;
                 map->setTextureUnit(shadowUnit);
                 map->setTextureSize({size, size});
                 return map;
             }},
            {"ShadowTexture",
             []
             {
                 osg::ref_ptr<osgShadow::ShadowTexture> texture = new osgShadow::ShadowTexture;
                 texture->setTextureUnit(shadowUnit);
                 return texture;
             }},
            {"ParallelSplitShadowMap", []
             {
                 osg::ref_ptr<osgShadow::ParallelSplitShadowMap> map =
                     new osgShadow::ParallelSplitShadowMap(nullptr, 2);
                 map->setTextureResolution(size);
                 return map;
             }}};
}

class Shadows : public BentGround
{
protected:
    /// The scene below a shadow technique, with a sun.
    osg::ref_ptr<osg::Group> shadowed(osg::Group& scene, const Technique& which)
    {
        const osg::ref_ptr<osgShadow::ShadowTechnique> technique = which.make();
        _kept.push_back(technique);
        osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
        sun->getLight()->setPosition({toLight, 0.0f});
        osg::ref_ptr<osgShadow::ShadowedScene> decorator = new osgShadow::ShadowedScene;
        decorator->getShadowSettings()->setTextureSize({2048, 2048});
        decorator->getShadowSettings()->setBaseShadowTextureUnit(shadowUnit);
        decorator->setShadowTechnique(technique);
        decorator->addChild(sun);
        decorator->addChild(&scene);
        decorator->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        decorator->getStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
        return decorator;
    }

    static osg::ref_ptr<EffectScene> bentScene(const Blocks& blocks)
    {
        const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
        // A bend leaves the parallel pictures of a sun's camera as they are; this does not.
        const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
        lift->setFactor(1.5);
        scene->addEffect(lift);
        for (const Block& block : blocks)
            scene->addChild(makeBox(block.size, block.place));
        return scene;
    }

    /// The color of the geometry where it is lit, much darker elsewhere; `lit` is GLSL, the share of the sun that shows.
    static void paint(EffectScene& scene, const std::string& declarations, const std::string& lit)
    {
        const std::string vertex = "#version 330 compatibility\n"
                                   "vec4 geofx_vertex(vec4 eyePosition);\n"
                                   "uniform mat4 osg_ViewMatrixInverse;\n"
                                   "out vec4 inMap;\n"
                                   "out vec3 inWorld, normal;\n"
                                   "void main()\n{\n"
                                   "    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n"
                                   "    inMap = vec4(dot(eye, gl_EyePlaneS[1]), dot(eye, gl_EyePlaneT[1]),\n"
                                   "                 dot(eye, gl_EyePlaneR[1]), dot(eye, gl_EyePlaneQ[1]));\n"
                                   "    inWorld = (osg_ViewMatrixInverse * eye).xyz;\n"
                                   "    normal = mat3(osg_ViewMatrixInverse) * gl_NormalMatrix * gl_Normal;\n"
                                   "    gl_Position = gl_ProjectionMatrix * geofx_vertex(eye);\n"
                                   "    gl_FrontColor = gl_Color;\n}\n";
        const std::string fragment = "#version 330 compatibility\n"
                                     "vec4 geofx_fragment(vec4 color, vec4 map);\n"
                                     "uniform vec3 toLight;\n"
                                     "in vec4 inMap;\n"
                                     "in vec3 inWorld, normal;\n" +
                                     declarations +
                                     "void main()\n{\n"
                                     "    float sun = dot(normal, toLight) > 0.0 ? " +
                                     lit +
                                     " : 0.0;\n"
                                     "    vec3 color = gl_Color.rgb * (0.2 + 0.8 * sun);\n"
                                     "    gl_FragColor = geofx_fragment(vec4(color, 1.0), vec4(0.0));\n}\n";
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
        scene.addFunctions(*program);
        osg::StateSet& state = *scene.getOrCreateStateSet();
        state.setAttributeAndModes(program);
        state.addUniform(new osg::Uniform("toLight", toLight));
    }

    /// By the technique's map.
    osg::ref_ptr<osg::Group> byMap(const Blocks& blocks, const Technique& technique)
    {
        const osg::ref_ptr<EffectScene> scene = bentScene(blocks);
        paint(*scene, "uniform sampler2DShadow shadows;\n", "textureProj(shadows, inMap)");
        scene->getStateSet()->addUniform(new osg::Uniform("shadows", shadowUnit));
        return shadowed(*scene, technique);
    }

    /// The same scene without any map: whether a ray from a fragment's place in the undeformed world meets a block.
    static osg::ref_ptr<osg::Group> byRays(const Blocks& blocks)
    {
        const osg::ref_ptr<EffectScene> scene = bentScene(blocks);
        const auto count = static_cast<int>(blocks.size());
        paint(*scene,
              "uniform vec3 low[" + std::to_string(count) + "], high[" + std::to_string(count) +
                  "];\n"
                  "float free()\n{\n"
                  "    for (int i = 0; i < " +
                  std::to_string(count) +
                  "; ++i)\n    {\n"
                  "        vec3 a = (low[i] - inWorld) / toLight, b = (high[i] - inWorld) / toLight;\n"
                  "        vec3 into = min(a, b), out_ = max(a, b);\n"
                  "        float begin = max(into.x, max(into.y, into.z));\n"
                  "        float end = min(out_.x, min(out_.y, out_.z));\n"
                  "        if (end > 0.01 && end > begin + 0.01) return 0.0;\n"
                  "    }\n"
                  "    return 1.0;\n}\n",
              "free()");
        osg::ref_ptr<osg::Uniform> low = new osg::Uniform(osg::Uniform::FLOAT_VEC3, "low", count);
        osg::ref_ptr<osg::Uniform> high = new osg::Uniform(osg::Uniform::FLOAT_VEC3, "high", count);
        for (int i = 0; i < count; ++i)
        {
            const Block& block = blocks[static_cast<std::size_t>(i)];
            const osg::Vec3 half(block.size / 2, block.size / 2, 0.0f);
            low->setElement(static_cast<unsigned int>(i), block.place - half);
            high->setElement(static_cast<unsigned int>(i),
                             block.place + half + osg::Vec3(0.0f, 0.0f, 2.0f * block.size));
        }
        scene->getStateSet()->addUniform(low);
        scene->getStateSet()->addUniform(high);
        return scene;
    }

    /// Pixels that are off by more than a soft edge's share.
    static int off(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
        {
            int most = 0;
            for (int channel = 0; channel < 3; ++channel)
                most = std::max(most, std::abs(a.data()[4 * i + channel] - b.data()[4 * i + channel]));
            count += most > 16 ? 1 : 0;
        }
        return count;
    }

    /// Whether a place is on a block, or very near.
    static bool isOf(const Block& block, const osg::Vec3d& world)
    {
        const osg::Vec3d from = world - osg::Vec3d(block.place);
        const double reach = 0.5 * static_cast<double>(block.size) + 0.5;
        return std::abs(from.x()) < reach && std::abs(from.y()) < reach && from.z() > 0.5;
    }
    static bool isDarker(const osg::Image& with, const osg::Image& without, int x, int y)
    {
        const unsigned char* a = with.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        const unsigned char* b = without.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return a[0] + a[1] + a[2] < b[0] + b[1] + b[2] - 24;
    }
    /// Whether a neighbour is in the shadow where the pixel is not, or the other way round.
    static bool isAtBorder(const osg::Image& with, const osg::Image& without, int x, int y)
    {
        const bool dark = isDarker(with, without, x, y);
        for (int j = std::max(0, y - 1); j <= std::min(HEIGHT - 1, y + 1); ++j)
        {
            for (int i = std::max(0, x - 1); i <= std::min(WIDTH - 1, x + 1); ++i)
            {
                if (isDarker(with, without, i, j) != dark) return true;
            }
        }
        return false;
    }

    /// A place on the ground that is seen in two pictures: the pixels that show it.
    struct SamePlace
    {
        std::pair<int, int> bent, straight;
    };
    /// What both pictures of the viewer's camera show, the caster left out.
    std::vector<SamePlace> samePlaces(EffectScene& bent, EffectScene& straight, const Block& caster)
    {
        const DeformedView there(bent, *viewer().getCamera());
        const DeformedView here(straight, *viewer().getCamera());
        std::vector<SamePlace> places;
        for (int y = 0; y < HEIGHT; y += 2)
        {
            for (int x = 0; x < WIDTH; x += 2)
            {
                const auto hit = there.pick(x + 0.5, y + 0.5);
                osg::Vec2d pixel;
                if (!hit || isOf(caster, hit->world) || !here.project(hit->world, pixel)) continue;
                const int column = static_cast<int>(std::floor(pixel.x()));
                const int row = static_cast<int>(std::floor(pixel.y()));
                if (column < 0 || row < 0 || column >= WIDTH || row >= HEIGHT) continue;
                const auto seen = here.pick(column + 0.5, row + 0.5);
                if (!seen || isOf(caster, seen->world) || (seen->world - hit->world).length() > 1.5) continue;
                places.push_back({{x, y}, {column, row}});
            }
        }
        return places;
    }

private:
    // OSG 3.6.5 waits for itself for ever where a technique goes before the views that it was drawn in (osg::Identifier).
    std::vector<osg::ref_ptr<osgShadow::ShadowTechnique>> _kept;
};

} // namespace

TEST_F(Shadows, LieWhereTheUndeformedWorldHasThem)
{
    for (const float y : {-80.0f, -20.0f, 40.0f})
    {
        const Blocks blocks = blocksAt(y);
        const osg::ref_ptr<osg::Image> expected = render(byRays(blocks));
        const osg::ref_ptr<osg::Image> bare = render(byRays({blocks[1]}));
        // Without the caster much else is lit.
        EXPECT_GT(off(*expected, *bare), 100);
        for (const Technique& technique : techniques())
        {
            const std::string name = std::string(technique.name) + " " + std::to_string(static_cast<int>(y));
            SCOPED_TRACE(name);
            const osg::ref_ptr<osg::Image> actual = render(byMap(blocks, technique));
            // A shadow map has texels: its shadows' borders may be off by a pixel.
            EXPECT_TRUE(imagesMatch(*actual, *expected, {16 / 255.0f, 0.01, 1.0f}, name));
        }
    }
}

// The scene adapts the programs of techniques. Each pixel of the bent picture that the caster darkens shows a place that it darkens in
// the straight picture.
TEST_F(Shadows, OfTechniquesWithTheirOwnShadersLieOnTheBentGround)
{
    const Blocks blocks = {{18.0f, {-40.0f, -45.0f, 0.0f}}, {16.0f, {0.0f, -40.0f, 0.0f}}};
    const auto world = [&](bool bent, bool caster)
    {
        const osg::ref_ptr<EffectScene> scene = bentScene(caster ? blocks : Blocks{blocks[1]});
        scene->setAdaptsPrograms(true);
        for (unsigned int i = 0; i < scene->getNumEffects(); ++i)
            scene->getEffect(i)->setEnabled(bent);
        return scene;
    };
    const std::vector<SamePlace> places = samePlaces(*world(true, true), *world(false, true), blocks[0]);
    EXPECT_GT(places.size(), WIDTH * HEIGHT / 16u);
    std::vector<Technique> all = techniques();
    all.pop_back();
    // The others show no shadow of this caster, without the kit either.
    for (const Technique& each : otherTechniques())
    {
        if (each.name == std::string("ViewDependentShadowMap") || each.name == std::string("SoftShadowMap"))
            all.push_back(each);
    }
    for (const Technique& technique : all)
    {
        SCOPED_TRACE(technique.name);
        const bool late = technique.name[0] == 'V';
        const auto picture = [&](bool bent, bool caster)
        {
            const osg::ref_ptr<osg::Group> scene = shadowed(*world(bent, caster), technique);
            if (late) render(scene);
            return render(scene);
        };
        const osg::ref_ptr<osg::Image> bent = picture(true, true), bentLit = picture(true, false);
        const osg::ref_ptr<osg::Image> straight = picture(false, true), straightLit = picture(false, false);
        EXPECT_GT(off(*bent, *straight), WIDTH * HEIGHT / 10);
        std::size_t dark = 0, wrong = 0;
        for (const SamePlace& place : places)
        {
            const auto [x, y] = place.straight;
            const bool here = isDarker(*straight, *straightLit, x, y);
            const bool there = isDarker(*bent, *bentLit, place.bent.first, place.bent.second);
            dark += here ? 1 : 0;
            // At a border, the pixels of the two pictures show places that are not quite the same.
            wrong += here != there && !isAtBorder(*straight, *straightLit, x, y) ? 1 : 0;
        }
        std::cout << technique.name << ": " << wrong << " of " << places.size() << " pixels are wrong, "
                  << dark << " are in the shadow\n";
        EXPECT_GT(dark, 60u);
        EXPECT_LE(wrong, places.size() / 200);
    }
}

// Techniques bring shaders that know nothing of the effects. Where the scene does not adapt them, what they draw is not deformed, neither
// for the view nor for the light.
TEST_F(Shadows, OfTechniquesWithTheirOwnShadersAreThoseOfAPlainGroup)
{
    for (const Technique& technique : techniques())
    {
        if (technique.name == std::string("ViewDependentShadowMap")) continue;
        SCOPED_TRACE(technique.name);
        const Blocks blocks = blocksAt(-60.0f);
        const osg::ref_ptr<osg::Group> plain = makePlain({makeGround()});
        for (const Block& block : blocks)
            plain->addChild(makeBox(block.size, block.place));
        const osg::ref_ptr<osg::Image> expected = render(shadowed(*plain, technique));
        const osg::ref_ptr<osg::Group> lit = makePlain({makeGround()});
        lit->addChild(makeBox(blocks[1].size, blocks[1].place));
        EXPECT_GT(off(*expected, *render(shadowed(*lit, technique))), 100);
        osg::ref_ptr<osg::Image> actual;
        // That it stays undeformed is said.
        watch().messagesOf([&] { actual = render(shadowed(*bentScene(blocks), technique)); });
        EXPECT_TRUE(same(*actual, *expected, technique.name));
    }
}

// ViewDependentShadowMap puts its state into the render graph after the scene has been culled, so its first frame has no shadows.
TEST_F(Shadows, OfWeakEffectsAreThoseOfAPlainGroup)
{
    const Blocks blocks = blocksAt(-40.0f);
    const auto fill = [&](osg::Group& group)
    {
        group.addChild(makeGround());
        for (const Block& block : blocks)
            group.addChild(makeBox(block.size, block.place));
    };
    const auto second = [this](osg::Node* scene)
    {
        render(scene);
        return render(scene);
    };
    for (const Technique& technique : otherTechniques())
    {
        SCOPED_TRACE(technique.name);
        const osg::ref_ptr<osg::Group> plain = new osg::Group;
        fill(*plain);
        const osg::ref_ptr<osg::Image> expected = second(shadowed(*plain, technique));
        plain->removeChild(1u);
        EXPECT_GT(off(*expected, *second(shadowed(*plain, technique))), 100);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        fill(*scene);
        const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
        lift->setFactor(1.0001);
        scene->addEffect(lift);
        scene->setAdaptsPrograms(true);
        const osg::ref_ptr<osg::Image> actual = second(shadowed(*scene, technique));
        EXPECT_TRUE(imagesMatch(*actual, *expected, {16 / 255.0f, 0.001, 1.0f}, technique.name));
    }
}
