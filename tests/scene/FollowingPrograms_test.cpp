// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The copies of an application's programs: what they have, and when there is a new one.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <osgGeoFX/scene/detail/FollowingPrograms.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

using namespace osgGeoFX;

namespace
{

/// An application's own class.
class TintedProgram : public osg::Program
{
public:
    TintedProgram() = default;
    TintedProgram(const TintedProgram& other, const osg::CopyOp& copy)
        : osg::Program(other, copy), tint(other.tint)
    {
    }
    META_StateAttribute(geofxTest, TintedProgram, osg::StateAttribute::PROGRAM);

    int tint = 0;

protected:
    ~TintedProgram() override = default;
};

/// A program at the address of the one before, of which there is one at a time.
class PlacedProgram : public osg::Program
{
public:
    explicit PlacedProgram(const osg::Program& other) : osg::Program(other, osg::CopyOp::SHALLOW_COPY) {}
    static void* operator new(std::size_t) { return _memory; }
    static void operator delete(void*) {}

protected:
    ~PlacedProgram() override = default;

private:
    alignas(osg::Program) inline static unsigned char _memory[sizeof(osg::Program)];
};

const osg::Program* programOf(const osg::StateSet* state)
{
    return state ? dynamic_cast<const osg::Program*>(state->getAttribute(osg::StateAttribute::PROGRAM))
                 : nullptr;
}

osg::ref_ptr<TintedProgram> makeProgram()
{
    osg::ref_ptr<TintedProgram> program = new TintedProgram;
    program->tint = 7;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, "#pragma import_defines(OWN)\nvoid main() {}\n"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}\n"));
    EffectProgram::addFunctions(*program, {});
    program->setName("the grass");
    program->setParameter(GL_GEOMETRY_VERTICES_OUT_EXT, 5);
    program->addBindAttribLocation("blade", 6);
    program->addBindFragDataLocation("result", 1);
    program->addBindUniformBlock("Wind", 3);
    program->addTransformFeedBackVarying("tip");
    program->getShaderDefines().insert("BY_HAND");
    return program;
}

} // namespace

TEST(FollowingPrograms, CopiesHaveAllThatTheProgramHas)
{
    FollowingPrograms following;
    const osg::ref_ptr<TintedProgram> program = makeProgram();
    EXPECT_FALSE(following.of(*program)) << "nothing to follow yet";
    const osg::ref_ptr<osg::Program> effects = EffectProgram::create({new BirdsEyeView});
    following.follow(*effects);
    const osg::ref_ptr<osg::StateSet> state = following.of(*program);
    const auto* copy = dynamic_cast<const TintedProgram*>(programOf(state));
    ASSERT_TRUE(copy);
    ASSERT_NE(copy, program);
    EXPECT_EQ(copy->tint, 7);
    EXPECT_EQ(copy->getName(), "the grass");
    EXPECT_EQ(copy->getParameter(GL_GEOMETRY_VERTICES_OUT_EXT), 5);
    EXPECT_EQ(copy->getAttribBindingList(), program->getAttribBindingList());
    EXPECT_EQ(copy->getFragDataBindingList(), program->getFragDataBindingList());
    EXPECT_EQ(copy->getUniformBlockBindingList(), program->getUniformBlockBindingList());
    ASSERT_EQ(copy->getNumTransformFeedBackVaryings(), 1u);
    EXPECT_EQ(copy->getTransformFeedBackVarying(0), "tip");
    for (const char* define : {"OWN", "BY_HAND", "GEOFX_EFFECT_0", "GEOFX_DEFORMATION"})
        EXPECT_EQ(copy->getShaderDefines().count(define), 1u) << define;
    // Its own shaders, and the effects' functions in the place of those that it was given.
    ASSERT_EQ(copy->getNumShaders(), 4u);
    EXPECT_EQ(copy->getShader(0), program->getShader(0));
    EXPECT_EQ(copy->getShader(1), program->getShader(1));
    for (const unsigned int i : {2u, 3u})
    {
        EXPECT_NE(copy->getShader(i), program->getShader(i));
        EXPECT_EQ(copy->getShader(i)->getType(), program->getShader(i)->getType());
        EXPECT_EQ(copy->getShader(i)->getShaderSource(),
                  EffectProgram::functions({new BirdsEyeView}, copy->getShader(i)->getType()));
        EXPECT_EQ(program->getShader(i)->getShaderSource(),
                  EffectProgram::functions({}, program->getShader(i)->getType()));
    }
}

TEST(FollowingPrograms, OthersAreLeftAsTheyAre)
{
    FollowingPrograms following;
    const osg::ref_ptr<osg::Program> effects = EffectProgram::create({});
    following.follow(*effects);
    EXPECT_FALSE(following.of(*osg::ref_ptr<osg::Program>(new osg::Program)));
    const osg::ref_ptr<osg::Program> own = new osg::Program;
    own->addShader(new osg::Shader(osg::Shader::VERTEX, "void main() {}\n"));
    EXPECT_FALSE(following.of(*own));
    EXPECT_TRUE(following.programs().empty());
}

// A program may be out of sight while the effects change.
TEST(FollowingPrograms, FunctionsAtTheAddressOfFormerOnesAreOthers)
{
    const osg::ref_ptr<osg::Program> ordinary = new osg::Program;
    ordinary->addShader(new osg::Shader(osg::Shader::VERTEX, "void main() {}\n"));
    EffectProgram::addFunctions(*ordinary, {});
    const EffectProgram::Effects bird = {new BirdsEyeView};
    for (const osg::ref_ptr<osg::Program>& program : {ordinary, osg::ref_ptr<osg::Program>(makeProgram())})
    {
        FollowingPrograms following;
        osg::ref_ptr<osg::Program> effects = new PlacedProgram(*EffectProgram::create({}));
        following.follow(*effects);
        EXPECT_TRUE(following.of(*program));
        following.follow(*osg::ref_ptr<osg::Program>(EffectProgram::create({})));
        effects = nullptr;
        effects = new PlacedProgram(*EffectProgram::create(bird));
        following.follow(*effects);
        const osg::ref_ptr<osg::StateSet> state = following.of(*program);
        const osg::Program* copy = programOf(state);
        ASSERT_TRUE(copy);
        const osg::Shader& last = *copy->getShader(copy->getNumShaders() - 1);
        EXPECT_EQ(last.getShaderSource(), EffectProgram::functions(bird, last.getType()));
    }
}

TEST(FollowingPrograms, AChangeMakesANewCopyAndLeavesTheFormerOne)
{
    FollowingPrograms following;
    const osg::ref_ptr<osg::Program> first = EffectProgram::create({});
    const osg::ref_ptr<osg::Program> second = EffectProgram::create({new BirdsEyeView});
    following.follow(*first);
    const osg::ref_ptr<TintedProgram> program = makeProgram();
    osg::ref_ptr<osg::StateSet> last = following.of(*program);
    const auto next = [&](const char* what)
    {
        const osg::ref_ptr<osg::StateSet> state = following.of(*program);
        const osg::ref_ptr<const osg::Program> former = programOf(last);
        EXPECT_NE(state, last) << what;
        EXPECT_NE(programOf(state), former) << what;
        EXPECT_EQ(following.of(*program), state) << what;
        // Frames on their way hold it, and so its GL objects go with the others'.
        EXPECT_EQ(following.programs().size(), 2u) << what;
        last = state;
    };
    EXPECT_EQ(following.of(*program), last);
    following.follow(*second);
    next("other effects");
    following.follow(*second);
    EXPECT_EQ(following.of(*program), last);
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}\n"));
    next("a shader more");
    program->removeShader(program->getShader(0));
    next("a shader less");
    program->addBindAttribLocation("blade", 7);
    next("an attribute");
    program->addBindFragDataLocation("result", 2);
    next("an output");
    program->addBindUniformBlock("Wind", 4);
    next("a block");
    program->setParameter(GL_GEOMETRY_VERTICES_OUT_EXT, 6);
    next("a parameter");
    program->addTransformFeedBackVarying("foot");
    next("feedback");
    program->getShaderDefines().insert("MORE");
    next("a define");
}

TEST(FollowingPrograms, NothingIsKeptOfProgramsThatAreGone)
{
    FollowingPrograms following;
    const osg::ref_ptr<osg::Program> effects = EffectProgram::create({});
    following.follow(*effects);
    osg::ref_ptr<TintedProgram> program = makeProgram();
    const osg::observer_ptr<const osg::Program> copy = programOf(following.of(*program));
    EXPECT_TRUE(copy.valid());
    program = makeProgram();
    following.of(*program);
    EXPECT_FALSE(copy.valid());
    EXPECT_EQ(following.programs().size(), 1u);
}

namespace
{

/// Of OSG's own class, as each tile of a database may have one.
osg::ref_ptr<osg::Program> makeTile(const std::string& name, const std::string& more = "")
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName(name);
    program->addShader(
        new osg::Shader(osg::Shader::VERTEX, "#pragma import_defines(OWN)\nvoid main() {}\n" + more));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}\n"));
    EffectProgram::addFunctions(*program, {});
    return program;
}

} // namespace

TEST(FollowingPrograms, EqualProgramsShareOneCopy)
{
    FollowingPrograms following;
    const osg::ref_ptr<osg::Program> effects = EffectProgram::create({new BirdsEyeView});
    following.follow(*effects);
    std::vector<osg::ref_ptr<osg::Program>> tiles;
    std::set<const osg::StateSet*> states;
    for (int i = 0; i < 200; ++i)
    {
        tiles.push_back(makeTile("tile " + std::to_string(i)));
        states.insert(following.of(*tiles.back()));
    }
    EXPECT_EQ(states.size(), 1u);
    EXPECT_EQ(following.programs().size(), 1u);
    const osg::ref_ptr<osg::StateSet> shared = following.of(*tiles[0]);
    for (const char* define : {"OWN", "GEOFX_EFFECT_0", "GEOFX_DEFORMATION"})
        EXPECT_EQ(programOf(shared)->getShaderDefines().count(define), 1u) << define;

    // Each of these is another program, and the others go on with theirs.
    tiles[0]->getShader(0)->setShaderSource("void main() { gl_Position = gl_Vertex; }\n");
    tiles[1]->addBindAttribLocation("blade", 7);
    tiles[2]->addBindFragDataLocation("result", 2);
    tiles[3]->addBindUniformBlock("Wind", 4);
    tiles[4]->setParameter(GL_GEOMETRY_VERTICES_OUT_EXT, 6);
    tiles[5]->addTransformFeedBackVarying("foot");
    tiles[6]->getShaderDefines().insert("MORE");
    tiles[7]->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void more() {}\n"));
    std::set<const osg::StateSet*> others = {shared};
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_TRUE(others.insert(following.of(*tiles[i])).second) << i;
    for (std::size_t i = 8; i < tiles.size(); ++i)
        EXPECT_EQ(following.of(*tiles[i]), shared) << i;
    // The same change makes the same program.
    tiles[8]->addBindAttribLocation("blade", 7);
    EXPECT_EQ(following.of(*tiles[8]), following.of(*tiles[1]));
    EXPECT_EQ(following.programs().size(), 9u);
    // Neither the application's shaders nor what is drawn with them has changed.
    EXPECT_EQ(programOf(shared)->getShader(0)->getShaderSource(), tiles[9]->getShader(0)->getShaderSource());
    EXPECT_NE(programOf(shared)->getShader(0), tiles[9]->getShader(0));
    // Copies of programs that differ in one shader share the other one.
    EXPECT_EQ(programOf(shared)->getShader(1), programOf(following.of(*tiles[0]))->getShader(1));
}

// Tiles, and passes whose programs are replaced.
TEST(FollowingPrograms, ListsDoNotGrow)
{
    FollowingPrograms following;
    osg::ref_ptr<osg::Program> effects = EffectProgram::create({new BirdsEyeView});
    following.follow(*effects);
    for (int i = 0; i < 1000; ++i)
        following.of(*makeTile("tile", "// " + std::to_string(i)));
    EXPECT_LE(following.programs().size(), 64u);
    const osg::ref_ptr<osg::Program> lasts = makeTile("a tile that stays");
    for (int i = 0; i < 20; ++i)
    {
        effects = EffectProgram::create({new BirdsEyeView});
        following.follow(*effects);
        following.of(*lasts);
    }
    following.of(*makeTile("another one", "// more"));
    EXPECT_LE(following.programs().size(), 3u);
}
