// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The GL fixture notices what it must: each of these mistakes would fail a test.
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>

#include <gtest/gtest-spi.h>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2DArray>

#include <cstring>

namespace
{

osg::ref_ptr<osg::Geometry> makeQuad()
{
    osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    quad->setCullingActive(false);
    return quad;
}

osg::ref_ptr<osg::Program> makeProgram(const std::string& body)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, "#version 330 compatibility\n"
                                                            "void main() { gl_Position = gl_Vertex; }\n"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "#version 330 compatibility\n"
                                                              "out vec4 color;\n"
                                                              "void main() { " +
                                                                  body + " }\n"));
    return program;
}

} // namespace

using GlMessages = geofx::test::GlFixture;

TEST_F(GlMessages, NoneForACorrectScene)
{
    const osg::ref_ptr<osg::Geometry> quad = makeQuad();
    quad->getOrCreateStateSet()->setAttributeAndModes(makeProgram("color = vec4(1.0, 0.5, 0.0, 1.0);"));
    const osg::ref_ptr<osg::Image> image = render(quad);
    ASSERT_TRUE(image.valid());
    osg::ref_ptr<osg::Image> expected = new osg::Image;
    expected->allocateImage(256, 256, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < expected->getTotalSizeInBytes(); i += 4)
    {
        const unsigned char orange[4] = {255, 128, 0, 255};
        std::memcpy(expected->data() + i, orange, 4);
    }
    // Half of 255 may be rounded either way.
    EXPECT_TRUE(geofx::test::imagesMatch(*image, *expected, {0.0f, 1.0, 1.01f / 255.0f}));
}

TEST_F(GlMessages, NoticesAnErrorOfOpenGl)
{
    EXPECT_NONFATAL_FAILURE(withContext(
                                [](osg::State&)
                                {
                                    glEnable(0xFFFF);
                                    // Taken here, so that OSG's own check does not report it again.
                                    glGetError();
                                }),
                            "OpenGL (type 0x824c");
}

TEST_F(GlMessages, NoticesAShaderThatDoesNotCompile)
{
    const osg::ref_ptr<osg::Geometry> quad = makeQuad();
    quad->getOrCreateStateSet()->setAttributeAndModes(makeProgram("color = no_such_function();"));
    const std::vector<std::string> messages = watch().messagesOf([&] { render(quad); });
    ASSERT_FALSE(messages.empty());
    std::string all;
    for (const std::string& message : messages)
        all += message;
    EXPECT_NE(all.find("no_such_function"), std::string::npos) << all;
}

TEST_F(GlMessages, NoticesAWarningOfOsgWhileItDraws)
{
    // OSG warns of an image that a texture array's other layers do not match.
    const osg::ref_ptr<osg::Texture2DArray> texture = new osg::Texture2DArray;
    for (int size : {4, 8})
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(size, size, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        std::memset(image->data(), 0, image->getTotalSizeInBytes());
        texture->setImage(texture->getNumImages(), image);
    }
    const osg::ref_ptr<osg::Geometry> quad = makeQuad();
    quad->getOrCreateStateSet()->setAttributeAndModes(makeProgram("color = vec4(1.0);"));
    quad->getOrCreateStateSet()->setTextureAttribute(0, texture);
    EXPECT_NONFATAL_FAILURE(render(quad), "OSG: ");
}
