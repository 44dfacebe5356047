// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Textures, fog, alpha test and clip planes below an EffectScene: as OpenGL's fixed functions have them.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/LookFixture.h>

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/ClipNode>
#include <osg/Fog>
#include <osg/Geometry>
#include <osg/TexEnv>
#include <osg/TexEnvCombine>
#include <osg/TexGen>
#include <osg/TexGenNode>
#include <osg/TexMat>
#include <osg/Texture2D>

class TextureLook : public geofx::test::LookFixture
{
};

TEST_F(TextureLook, TextureEnvironments)
{
    struct Format
    {
        const char* name;
        GLenum pixels;
        GLint internal;
        bool decal; ///< OpenGL does not say what DECAL is for the others
    };
    const Format formats[] = {
        {"RGB", GL_RGB, GL_RGB, true},
        {"RGBA", GL_RGBA, GL_RGBA, true},
        {"luminance", GL_LUMINANCE, GL_LUMINANCE, false},
        {"luminance 8", GL_LUMINANCE, GL_LUMINANCE8, false},
        {"luminance alpha", GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, false},
        {"alpha", GL_ALPHA, GL_ALPHA, false},
        {"intensity", GL_LUMINANCE, GL_INTENSITY, false},
    };
    const std::pair<const char*, osg::TexEnv::Mode> modes[] = {
        {"modulate ", osg::TexEnv::MODULATE}, {"replace ", osg::TexEnv::REPLACE},
        {"decal ", osg::TexEnv::DECAL},       {"blend ", osg::TexEnv::BLEND},
        {"add ", osg::TexEnv::ADD},
    };
    for (const Format& format : formats)
    {
        for (const auto& [modeName, mode] : modes)
        {
            if (mode == osg::TexEnv::DECAL && !format.decal) continue;
            compare(std::string(modeName) + format.name,
                    [&, chosen = mode](const Place& place)
                    {
                        addTexture(place.state(), 0, format.pixels, chosen, format.internal);
                        place.scene.addChild(makeWaves());
                    });
        }
    }
    compare("a format of the user's own",
            [](const Place& place)
            {
                addTexture(place.state(), 0, GL_RGBA, osg::TexEnv::REPLACE);
                auto* texture = static_cast<osg::Texture2D*>(
                    place.state().getTextureAttribute(0, osg::StateAttribute::TEXTURE));
                texture->setInternalFormat(GL_RGB8);
                place.scene.addChild(makeWaves());
            });
}

TEST_F(TextureLook, Textures)
{
    compare("four units",
            [](const Place& place)
            {
                addSun(place);
                addTexture(place.state(), 0, GL_RGB, osg::TexEnv::MODULATE);
                addTexture(place.state(), 1, GL_RGBA, osg::TexEnv::DECAL);
                addTexture(place.state(), 2, GL_LUMINANCE, osg::TexEnv::ADD);
                addTexture(place.state(), 3, GL_ALPHA, osg::TexEnv::MODULATE);
                for (unsigned int unit = 0; unit < 4; ++unit)
                {
                    osg::Matrix matrix = osg::Matrix::rotate(0.4 * unit, osg::Vec3d(0, 0, 1)) *
                                         osg::Matrix::scale(1 + 0.2 * unit, 1, 1);
                    place.state().setTextureAttribute(unit, new osg::TexMat(matrix));
                }
                place.scene.addChild(makeWaves());
            });
    compare("the third unit alone, with the default environment",
            [](const Place& place)
            {
                place.state().setTextureAttributeAndModes(2, makeTexture(GL_RGB));
                place.scene.addChild(makeWaves());
            });
    compare("a texture without its mode",
            [](const Place& place)
            {
                place.state().setTextureAttribute(0, makeTexture(GL_RGB));
                place.scene.addChild(makeWaves());
            });
    compare("a mode without a texture, and a texture without an image",
            [](const Place& place)
            {
                place.state().setTextureMode(0, GL_TEXTURE_2D, on);
                place.state().setTextureAttributeAndModes(1, new osg::Texture2D);
                place.scene.addChild(makeWaves());
            });
    compare("four coordinates",
            [](const Place& place)
            {
                addTexture(place.state(), 0, GL_RGB, osg::TexEnv::REPLACE);
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                osg::ref_ptr<osg::Vec4Array> coordinates = new osg::Vec4Array;
                for (const osg::Vec3& vertex : *static_cast<osg::Vec3Array*>(waves->getVertexArray()))
                    coordinates->push_back({vertex.x(), vertex.y(), 0, 2 + 0.2f * vertex.x()});
                waves->setTexCoordArray(0, coordinates);
                place.scene.addChild(waves);
            });
}

// As a shadow map: a texture of depths gives how many of them pass.
TEST_F(TextureLook, ComparedDepths)
{
    const std::pair<const char*, osg::Texture::ShadowTextureMode> kinds[] = {
        {"luminance", osg::Texture::LUMINANCE},
        {"intensity", osg::Texture::INTENSITY},
        {"alpha", osg::Texture::ALPHA},
    };
    const std::pair<const char*, osg::TexEnv::Mode> modes[] = {
        {"modulate ", osg::TexEnv::MODULATE},
        {"replace ", osg::TexEnv::REPLACE},
        {"blend ", osg::TexEnv::BLEND},
        {"add ", osg::TexEnv::ADD},
    };
    for (const auto& [kindName, kind] : kinds)
    {
        for (const auto& [modeName, mode] : modes)
        {
            compare(std::string(modeName) + kindName,
                    [chosenKind = kind, chosenMode = mode](const Place& place)
                    {
                        constexpr int size = 16;
                        osg::ref_ptr<osg::Image> depths = new osg::Image;
                        depths->allocateImage(size, size, 1, GL_DEPTH_COMPONENT, GL_FLOAT);
                        for (int y = 0; y < size; ++y)
                            for (int x = 0; x < size; ++x)
                                *reinterpret_cast<float*>(depths->data(x, y)) =
                                    (x / 2 + y / 2) % 2 ? 0.7f : 0.3f;
                        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(depths);
                        texture->setInternalFormat(GL_DEPTH_COMPONENT24);
                        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
                        texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
                        texture->setShadowComparison(true);
                        texture->setShadowTextureMode(chosenKind);
                        place.state().setTextureAttributeAndModes(1, texture);
                        place.state().setTextureAttribute(1, new osg::TexEnv(chosenMode));
                        osg::ref_ptr<osg::TexGen> gen = new osg::TexGen;
                        gen->setMode(osg::TexGen::EYE_LINEAR);
                        gen->setPlane(osg::TexGen::S, osg::Plane(0.2, 0.1, 0, 0.3));
                        gen->setPlane(osg::TexGen::T, osg::Plane(0, 0.3, 0.2, -0.1));
                        gen->setPlane(osg::TexGen::R, osg::Plane(0.1, 0, 0.1, 0.5));
                        gen->setPlane(osg::TexGen::Q, osg::Plane(0, 0, 0, 1));
                        place.state().setTextureAttributeAndModes(1, gen);
                        place.scene.addChild(makeWaves());
                    });
        }
    }
}

TEST_F(TextureLook, GeneratedCoordinates)
{
    const auto withMode = [](osg::TexGen::Mode mode, bool perspective)
    {
        return [=](const Place& place)
        {
            addTexture(place.state(), 0, GL_RGB, osg::TexEnv::REPLACE);
            osg::ref_ptr<osg::TexGen> gen = new osg::TexGen;
            gen->setMode(mode);
            gen->setPlane(osg::TexGen::S, osg::Plane(0.2, 0.1, 0, 0.3));
            gen->setPlane(osg::TexGen::T, osg::Plane(0, 0.3, 0.2, -0.1));
            gen->setPlane(osg::TexGen::R, osg::Plane(0, 0, 1, 0));
            gen->setPlane(osg::TexGen::Q, osg::Plane(perspective ? 0.1 : 0, 0, 0, perspective ? 2 : 1));
            place.state().setTextureAttributeAndModes(0, gen);
            place.scene.addChild(makeWaves());
        };
    };
    compare("object linear", withMode(osg::TexGen::OBJECT_LINEAR, false));
    compare("object linear, projective", withMode(osg::TexGen::OBJECT_LINEAR, true));
    compare("eye linear", withMode(osg::TexGen::EYE_LINEAR, false));
    compare("eye linear, projective", withMode(osg::TexGen::EYE_LINEAR, true));
    compare("sphere map",
            [&](const Place& place)
            {
                withMode(osg::TexGen::SPHERE_MAP, false)(place);
                place.state().setMode(GL_NORMALIZE, on);
            });
    compare("normal map", withMode(osg::TexGen::NORMAL_MAP, false));
    compare("reflection map", withMode(osg::TexGen::REFLECTION_MAP, false));
    compare("s alone",
            [&](const Place& place)
            {
                withMode(osg::TexGen::OBJECT_LINEAR, true)(place);
                for (const GLenum mode : {GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R, GL_TEXTURE_GEN_Q})
                    place.state().setTextureMode(0, mode, off);
            });
    compare(
        "from a node",
        [](const Place& place)
        {
            addTexture(place.state(), 0, GL_RGB, osg::TexEnv::REPLACE);
            for (const GLenum mode : {GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R, GL_TEXTURE_GEN_Q})
                place.state().setTextureMode(0, mode, on);
            osg::ref_ptr<osg::TexGenNode> node = new osg::TexGenNode;
            node->getTexGen()->setMode(osg::TexGen::EYE_LINEAR);
            node->getTexGen()->setPlane(osg::TexGen::S, osg::Plane(0.2, 0.1, 0, 0.3));
            node->getTexGen()->setPlane(osg::TexGen::T, osg::Plane(0, 0.3, 0.2, -0.1));
            place.above.addChild(node);
            place.scene.addChild(makeWaves());
        });
}

TEST_F(TextureLook, Fragments)
{
    compare("alpha test",
            [](const Place& place)
            {
                place.state().setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.55f));
                place.scene.addChild(makeWaves());
            });
    compare("blending",
            [](const Place& place)
            {
                place.state().setAttributeAndModes(new osg::BlendFunc);
                place.state().setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
                place.scene.addChild(makeWaves());
            });
    compare("clip planes",
            [](const Place& place)
            {
                osg::ref_ptr<osg::ClipNode> node = new osg::ClipNode;
                node->addClipPlane(new osg::ClipPlane(0, 1, 0.3, 0, 1.5));
                node->addClipPlane(new osg::ClipPlane(1, 0, -1, 0.5, 1));
                node->addChild(makeWaves());
                place.scene.addChild(node);
            });
    for (const osg::Fog::Mode mode : {osg::Fog::LINEAR, osg::Fog::EXP, osg::Fog::EXP2})
    {
        for (const bool own : {false, true})
        {
            compare("fog " + std::to_string(mode) + (own ? " with its own coordinates" : ""),
                    [=](const Place& place)
                    {
                        osg::ref_ptr<osg::Fog> fog = new osg::Fog;
                        fog->setMode(mode);
                        fog->setColor({0.9f, 0.8f, 0.7f, 1});
                        fog->setStart(10);
                        fog->setEnd(22);
                        fog->setDensity(0.06f);
                        osg::ref_ptr<osg::Geometry> waves = makeWaves();
                        if (own)
                        {
                            fog->setFogCoordinateSource(osg::Fog::FOG_COORDINATE);
                            osg::ref_ptr<osg::FloatArray> coordinates = new osg::FloatArray;
                            for (unsigned int i = 0; i < waves->getVertexArray()->getNumElements(); ++i)
                                coordinates->push_back(10.0f + 0.02f * static_cast<float>(i));
                            waves->setFogCoordArray(coordinates, osg::Array::BIND_PER_VERTEX);
                        }
                        place.state().setAttributeAndModes(fog);
                        place.scene.addChild(waves);
                    });
        }
    }
}

TEST_F(TextureLook, UnsupportedIsSaid)
{
    const auto messagesFor = [&](const std::function<void(osg::StateSet&)>& change)
    {
        const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
        const osg::ref_ptr<osgGeoFX::VerticalExaggeration> lift = new osgGeoFX::VerticalExaggeration;
        lift->setFactor(2);
        scene->addEffect(lift);
        change(*scene->getOrCreateStateSet());
        scene->addChild(makeWaves());
        scene->addChild(makeWaves());
        return watch().messagesOf(
            [&]
            {
                render(scene);
                render(scene);
            });
    };
    EXPECT_EQ(
        messagesFor([](osg::StateSet& state) { addTexture(state, 0, GL_RGB, osg::TexEnv::ADD); }).size(), 0u);
    EXPECT_EQ(messagesFor([](osg::StateSet& state) { state.setTextureMode(1, GL_TEXTURE_3D, on); }).size(),
              1u);
    EXPECT_EQ(messagesFor(
                  [](osg::StateSet& state)
                  {
                      state.setTextureAttributeAndModes(0, makeTexture(GL_RGB));
                      state.setTextureAttribute(0, new osg::TexEnvCombine);
                  })
                  .size(),
              1u);
    EXPECT_EQ(
        messagesFor([](osg::StateSet& state) { state.setTextureAttributeAndModes(4, makeTexture(GL_RGB)); })
            .size(),
        1u);
}
