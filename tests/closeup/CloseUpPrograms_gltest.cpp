// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Close-ups of what an application's own programs draw.
#include <tools/CloseUpStage.h>
#include <tools/HostPrograms.h>

#include <osg/BufferIndexBinding>
#include <osg/BufferObject>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class CloseUpPrograms : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        _scene->removeChildren(0, _scene->getNumChildren());
        _closeUps->addCloseUp(makeCloseUp({0.0, 0.0}));
        _closeUps->setPipeline(CloseUps::MULTI_PASS);
        look({0.0, -1500.0, 900.0}, {});
    }
    osg::ref_ptr<osg::Image> drawWith(osg::Program* program)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        const osg::ref_ptr<osg::Geometry> hills = makeHills();
        auto& colors = dynamic_cast<osg::Vec4Array&>(*hills->getColorArray());
        colors.front().set(0.2f, 0.5f, 0.3f, 1.0f);
        if (program) hills->getOrCreateStateSet()->setAttribute(program);
        _scene->addChild(hills);
        draw();
        return draw();
    }
};

} // namespace

// A program of an application's, with calls of the kit's functions or adapted: lifted, cut and anchored as what has none.
TEST_F(CloseUpPrograms, WhatProgramsDrawIsLiftedOut)
{
    const osg::ref_ptr<osg::Image> expected = drawWith(nullptr);
    const HostProgram host("#version 330 compatibility\n",
                           "gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * gl_Vertex);");
    for (const bool called : {true, false})
    {
        SCOPED_TRACE(called);
        const osg::ref_ptr<osg::Program> program = host.make(called);
        if (called)
            EffectScene::addFunctions(*program);
        else
            EffectScene::adapt(*program);
        EXPECT_LE(differing(*drawWith(program), *expected), 0.0005);
        _closeUps->setEnabled(false);
        EXPECT_GT(differing(*drawWith(program), *expected), 0.05);
        _closeUps->setEnabled(true);
    }
}

namespace
{

/// A program that has its color in a uniform block, with the block's buffer.
osg::ref_ptr<osg::StateSet> makeBlockState(unsigned int binding)
{
    HostProgram host("#version 330 compatibility\n",
                     "gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * gl_Vertex);");
    host.fragments = {
        "#version 330 compatibility\nDEFINES\nlayout(std140) uniform Paint\n{\n    vec4 color;\n};\n"
        "void main() { gl_FragColor = TINT(color); }\n"};
    const osg::ref_ptr<osg::Program> program = host.make(false);
    program->addBindUniformBlock("Paint", binding);
    EffectScene::adapt(*program);
    const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(1);
    color->front().set(0.2f, 0.5f, 0.3f, 1.0f);
    color->setBufferObject(new osg::UniformBufferObject);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttribute(program);
    state->setAttribute(new osg::UniformBufferBinding(binding, color, 0, sizeof(osg::Vec4f)));
    return state;
}

} // namespace

// Two sets of close-ups and an application's program, each with a uniform block.
TEST_F(CloseUpPrograms, UniformBlocksDoNotCollide)
{
    const osg::ref_ptr<CloseUps> more = new CloseUps;
    more->addCloseUp(makeCloseUp({-500.0, 100.0}, 300.0, 350.0));
    more->addCloseUp(makeCloseUp({500.0, 100.0}, 300.0, 250.0));
    more->setPipeline(CloseUps::MULTI_PASS);
    const auto drawWithBlock = [&](unsigned int binding)
    {
        drawWith(nullptr);
        _scene->getChild(0)->setStateSet(makeBlockState(binding));
        draw();
        return draw();
    };
    const osg::ref_ptr<osg::Image> overview = drawWith(nullptr);
    EXPECT_LE(differing(*drawWithBlock(1), *overview), 0.0005) << "the block's color is the ground's";
    _scene->addEffect(more);
    const osg::ref_ptr<osg::Image> expected = drawWith(nullptr);
    EXPECT_GT(differing(*expected, *overview), 0.05);
    // The scene gives 7 and 8 to the sets of close-ups.
    EXPECT_LE(differing(*drawWithBlock(1), *expected), 0.0005);
    for (const unsigned int binding : {7u, 8u})
    {
        SCOPED_TRACE(binding);
        EXPECT_TRUE(_scene->setFirstBlockBinding(static_cast<int>(binding) + 1));
        EXPECT_LE(differing(*drawWithBlock(binding), *expected), 0.0005);
        EXPECT_TRUE(_scene->setFirstBlockBinding(7));
    }
    // A set keeps what its property names.
    EXPECT_TRUE(more->setBlockBinding(30));
    EXPECT_LE(differing(*drawWithBlock(8), *expected), 0.0005);
}
