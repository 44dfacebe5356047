// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An engine that assembles its shaders itself, and draws with programs of a class of its own, as osgEarth does.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/ShaderHost.h>
#include <tools/BentGround.h>

#include <osg/Program>

#include <mutex>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// A program that is no osg::Program, but draws with one.
class EngineProgram : public osg::StateAttribute
{
public:
    EngineProgram() = default;
    EngineProgram(const EngineProgram& other, const osg::CopyOp& copy) : osg::StateAttribute(other, copy) {}
    META_StateAttribute(engine, EngineProgram, PROGRAM);
    int compare(const osg::StateAttribute& other) const override
    {
        return this < &other ? -1 : this > &other;
    }

    void apply(osg::State& state) const override { inner->apply(state); }
    void releaseGLObjects(osg::State* state) const override { inner->releaseGLObjects(state); }
    void resizeGLObjectBuffers(unsigned int size) override { inner->resizeGLObjectBuffers(size); }

    osg::ref_ptr<osg::Program> inner = new osg::Program; // as a default, the fixed functions
};

/// The engine: it joins pieces of text.
class Engine : public ShaderHost
{
public:
    Engine()
    {
        assemble({"vec4 geofx_vertex(vec4 eye) { return eye; }\n",
                  "vec4 geofx_fragment(vec4 color, vec4 map) { return color + 0.0 * map; }\n",
                  {}});
    }
    void use(const ShaderTexts& texts) override
    {
        ++told;
        assemble(texts);
    }
    bool draws(const osg::StateAttribute& attribute) const override { return &attribute == program.get(); }

    const osg::ref_ptr<EngineProgram> program = new EngineProgram;
    std::string defines; ///< before the text of the vertex stage
    int told = 0;

private:
    void assemble(const ShaderTexts& texts)
    {
        const std::string version = "#version 330 compatibility\n#line 1\n";
        program->inner = new osg::Program;
        program->inner->addShader(new osg::Shader(
            osg::Shader::VERTEX,
            version + defines + texts.vertex +
                "void engine_view(inout vec4 eye) { eye = geofx_vertex(eye); }\n"
                "void main()\n{\n    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n"
                "    vec4 placed = eye;\n    engine_view(placed);\n"
                "    gl_Position = placed == eye ? ftransform() : gl_ProjectionMatrix * placed;\n"
                "    gl_FrontColor = gl_Color;\n}\n"));
        program->inner->addShader(
            new osg::Shader(osg::Shader::FRAGMENT,
                            version + texts.fragment +
                                "void main() { gl_FragColor = geofx_fragment(gl_Color, vec4(0.0)); }\n"));
    }
};

class ShaderHosts : public BentGround
{
protected:
    osg::ref_ptr<osg::Geometry> engineGround() const
    {
        osg::ref_ptr<osg::Geometry> ground = makeGround();
        ground->getOrCreateStateSet()->setAttribute(_engine->program);
        return ground;
    }

    const osg::ref_ptr<Engine> _engine = new Engine;
};

} // namespace

TEST_F(ShaderHosts, DrawWhatTheKitDraws)
{
    const osg::ref_ptr<EffectScene> kits = makeScene({makeGround()});
    const osg::ref_ptr<EffectScene> engines = makeScene({engineGround()});
    engines->setShaderHost(_engine);
    EXPECT_TRUE(same(*render(engines), *render(kits)));
    EXPECT_EQ(_engine->told, 1);
    EXPECT_TRUE(same(*render(engines), *render(kits)));
    EXPECT_EQ(_engine->told, 1);
    // Another effect needs other texts. Switching it off does not.
    const osg::ref_ptr<ProjectiveMappings> paint = makePaint();
    const osg::ref_ptr<osg::Image> plain = render(kits);
    kits->addEffect(paint);
    engines->addEffect(paint);
    const osg::ref_ptr<osg::Image> painted = render(kits);
    EXPECT_GT(differing(*painted, *plain), 500);
    EXPECT_TRUE(same(*render(engines), *painted));
    EXPECT_EQ(_engine->told, 2);
    paint->setEnabled(false);
    EXPECT_TRUE(same(*render(engines), *plain));
    EXPECT_EQ(_engine->told, 2);
    // Outside of scenes nothing happens, with the texts of the effects, too.
    EXPECT_TRUE(same(*render(makePlain({engineGround()})), *render(makePlain({makeGround()}))));
}

// Tiles that an engine has left coarse, beside the picture and behind the eye, with corners far ahead.
TEST_F(ShaderHosts, CoarseTilesBesideAPanoramaStayThere)
{
    const osg::ref_ptr<osg::Geometry> coarse = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const float side : {-1.0f, 1.0f})
        for (const osg::Vec2& corner :
             {osg::Vec2(4e5f, -2e5f), osg::Vec2(6e5f, -1e5f), osg::Vec2(4e5f, 9e6f)})
            corners->push_back(osg::Vec3(side * corner.x(), corner.y(), 0.0f));
    for (const osg::Vec2& corner : {osg::Vec2(-1e5f, -5e5f), osg::Vec2(1e5f, -5e5f), osg::Vec2(0.0f, 9e6f)})
        corners->push_back(osg::Vec3(corner, 0.0f));
    const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    color->push_back({1.0f, 0.0f, 1.0f, 1.0f});
    coarse->setVertexArray(corners);
    coarse->setColorArray(color);
    coarse->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(corners->size())));
    coarse->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);

    viewer().getCamera()->setCullingMode(osg::CullSettings::NO_CULLING);
    const auto picture = [&](const std::string& defines, bool withCoarse)
    {
        const osg::ref_ptr<Engine> engine = new Engine;
        engine->defines = defines;
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setViewRadius(120.0);
        map->setPaint(false);
        map->setSky(false);
        map->setStrokes(false);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(map);
        scene->setShaderHost(engine);
        scene->addChild(makeGround());
        scene->addChild(coarse);
        for (unsigned int i = 0; i < 2; ++i)
            scene->getChild(i)->getOrCreateStateSet()->setAttribute(engine->program);
        if (!withCoarse) scene->removeChild(coarse);
        return render(scene);
    };
    const osg::ref_ptr<osg::Image> expected = picture("", false);
    EXPECT_GT(covered(*expected), 2000);
    EXPECT_GT(differing(*picture("", true), *expected), 1000) << "there is nothing to mend";
    EXPECT_TRUE(same(*picture("#define GEOFX_HOST_COARSE_TILES\n", true), *expected));
    viewer().getCamera()->setCullingMode(osg::CullSettings::DEFAULT_CULLING);
}

TEST_F(ShaderHosts, TextsHaveNoVersion)
{
    class Listener : public ShaderHost
    {
    public:
        void use(const ShaderTexts& given) override { texts = given; }
        bool draws(const osg::StateAttribute&) const override { return false; }
        ShaderTexts texts;
    };
    const osg::ref_ptr<Listener> listener = new Listener;
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    scene->setShaderHost(listener);
    render(scene);
    for (const std::string& text : {listener->texts.vertex, listener->texts.fragment})
    {
        EXPECT_EQ(text.find("#version"), std::string::npos);
        EXPECT_EQ(text.find("void main"), std::string::npos);
    }
    EXPECT_NE(listener->texts.vertex.find("vec4 geofx_vertex(vec4 eyePosition)"), std::string::npos);
    EXPECT_NE(listener->texts.fragment.find("vec4 geofx_fragment(vec4 color, vec4 map)"), std::string::npos);
}

namespace
{

/// An engine whose programs are made of all those above them in the scene graph, as osgEarth's are.
class AddingProgram : public osg::StateAttribute
{
public:
    explicit AddingProgram(ShaderTexts added = {}) : texts(std::move(added)) {}
    AddingProgram(const AddingProgram& other, const osg::CopyOp& copy)
        : osg::StateAttribute(other, copy), texts(other.texts)
    {
    }
    META_StateAttribute(engine, AddingProgram, PROGRAM);
    int compare(const osg::StateAttribute& other) const override
    {
        return this < &other ? -1 : this > &other;
    }
    void apply(osg::State& state) const override
    {
        const auto& known = state.getAttributeVec(this);
        ShaderTexts all = {"vec4 geofx_vertex(vec4 eye) { return eye; }\n",
                           "vec4 geofx_fragment(vec4 color, vec4 map) { return color + 0.0 * map; }\n",
                           {}};
        for (const auto& each : known)
        {
            const auto* program = dynamic_cast<const AddingProgram*>(each.first);
            if (program && !program->texts.vertex.empty()) all = program->texts;
        }
        if (!texts.vertex.empty()) all = texts;
        if (!_joined || _vertex != all.vertex)
        {
            _vertex = all.vertex;
            const std::string version = "#version 330 compatibility\n#line 1\n";
            _joined = new osg::Program;
            _joined->addShader(new osg::Shader(
                osg::Shader::VERTEX,
                version + all.vertex +
                    "void main()\n{\n    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n"
                    "    vec4 placed = geofx_vertex(eye);\n"
                    "    gl_Position = placed == eye ? ftransform() : gl_ProjectionMatrix * placed;\n"
                    "    gl_FrontColor = gl_Color;\n}\n"));
            _joined->addShader(
                new osg::Shader(osg::Shader::FRAGMENT,
                                version + all.fragment +
                                    "void main() { gl_FragColor = geofx_fragment(gl_Color, vec4(0.0)); }\n"));
            for (const auto& [name, binding] : all.blocks)
                _joined->addBindUniformBlock(name, binding);
        }
        _joined->apply(state);
    }

    ShaderTexts texts;

protected:
    ~AddingProgram() override = default;

private:
    mutable osg::ref_ptr<osg::Program> _joined;
    mutable std::string _vertex;
};

class AddingEngine : public ShaderHost
{
public:
    osg::ref_ptr<osg::StateSet> addition(const ShaderTexts& texts) override
    {
        ++asked;
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        state->setAttribute(new AddingProgram(texts),
                            osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
        return state;
    }
    bool draws(const osg::StateAttribute& program) const override
    {
        return dynamic_cast<const AddingProgram*>(&program) != nullptr;
    }
    int asked = 0;
};

} // namespace

// An addition is drawn below the engine's own programs, and nothing of them changes.
TEST_F(ShaderHosts, AddToWhatTheyHave)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    // An override, such as a picker's, does not keep the effects from it.
    ground->getOrCreateStateSet()->setAttribute(new AddingProgram,
                                                osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    const osg::ref_ptr<AddingEngine> engine = new AddingEngine;
    const osg::ref_ptr<EffectScene> kits = makeScene({makeGround()});
    const osg::ref_ptr<EffectScene> engines = makeScene({ground});
    engines->setShaderHost(engine);
    EXPECT_TRUE(same(*render(engines), *render(kits)));
    EXPECT_TRUE(same(*render(engines), *render(kits)));
    EXPECT_EQ(engine->asked, 1);
    const osg::ref_ptr<ProjectiveMappings> paint = makePaint();
    kits->addEffect(paint);
    engines->addEffect(paint);
    EXPECT_TRUE(same(*render(engines), *render(kits)));
    EXPECT_EQ(engine->asked, 2);
    EXPECT_TRUE(same(*render(makePlain({ground})), *render(makePlain({makeGround()}))));
}

// Passes ask for additions of their own, so close-ups lift what such an engine draws.
TEST_F(ShaderHosts, AddToPassesToo)
{
    const auto withCloseUp = [&](osg::Geometry* ground, ShaderHost* host)
    {
        const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
        closeUp->getRegion()->setCenter({0.0, 0.0});
        closeUp->getRegion()->setSize(60.0, 60.0);
        closeUp->setOffset({0.0, 0.0, 60.0});
        const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        closeUps->setPipeline(CloseUps::MULTI_PASS);
        closeUps->setTessellation(1);
        closeUps->addCloseUp(closeUp);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(closeUps);
        scene->addChild(ground);
        scene->setShaderHost(host);
        return render(scene);
    };
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeGround()}));
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    ground->getOrCreateStateSet()->setAttribute(new AddingProgram);
    const osg::ref_ptr<osg::Image> kits = withCloseUp(makeGround(), nullptr);
    EXPECT_GT(differing(*kits, *plain), 300);
    EXPECT_TRUE(same(*withCloseUp(ground, new AddingEngine), *kits));
}

// Without the host's word, a program of another class is a stranger.
TEST_F(ShaderHosts, WhatTheyDoNotDrawStaysWhereItIs)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({engineGround()});
    osg::ref_ptr<osg::Image> drawn;
    const std::vector<std::string> said = watch().messagesOf([&] { drawn = render(scene); });
    EXPECT_TRUE(same(*drawn, *render(makePlain({makeGround()}))));
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said.front().find("engine::EngineProgram"), std::string::npos) << said.front();
}
