// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Close-ups of what an application's own programs draw.
#include <tools/CloseUpStage.h>
#include <tools/HostPrograms.h>

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
