// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Layers that change in each frame: images of which the rows that differ are uploaded, and textures that another pass fills.
#include <tools/MappingStage.h>

#include <osg/Texture2D>

#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

class LiveLayers : public MappingStage
{
protected:
    void SetUp() override
    {
        MappingStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        lookDown({0.0, 0.0}, 1.2);
    }

    /// What a set of mappings shows that has never known another picture.
    osg::ref_ptr<osg::Image> drawAnew(osg::Image* image)
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->addMapping(
            makePicture({0.0, 0.0}, 90.0, new osg::Image(*image, osg::CopyOp::DEEP_COPY_ALL)));
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(mappings);
        scene->addChild(makeGround());
        return render(scene);
    }

    /// A camera that paints a texture before the scene is drawn.
    static osg::ref_ptr<osg::Camera> painter(osg::Texture2D* texture)
    {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
        camera->setRenderOrder(osg::Camera::PRE_RENDER);
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->attach(osg::Camera::COLOR_BUFFER0, texture);
        const int width = texture->getTextureWidth(), height = texture->getTextureHeight();
        camera->setViewport(0, 0, width, height);
        camera->setProjectionMatrixAsOrtho2D(0.0, 1.0, 0.0, 1.0);
        camera->setViewMatrix(osg::Matrixd::identity());
        camera->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        return camera;
    }
    static osg::ref_ptr<osg::Texture2D> textureOf(int width, int height)
    {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setTextureSize(width, height);
        texture->setInternalFormat(GL_RGBA8);
        texture->setResizeNonPowerOfTwoHint(false);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        return texture;
    }
    /// A rectangle of the camera's picture, 0…1.
    static osg::ref_ptr<osg::Geometry> rectangle(double left, double bottom, double right, double top,
                                                 const osg::Vec4& color)
    {
        osg::ref_ptr<osg::Geometry> geometry = osg::createTexturedQuadGeometry(
            osg::Vec3(osg::Vec3d(left, bottom, 0.0)), osg::Vec3(osg::Vec3d(right - left, 0.0, 0.0)),
            osg::Vec3(osg::Vec3d(0.0, top - bottom, 0.0)));
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
        colors->push_back(color);
        geometry->setColorArray(colors, osg::Array::BIND_OVERALL);
        return geometry;
    }
};

TEST_F(LiveLayers, RowsThatDifferAreUploadedAlone)
{
    const osg::ref_ptr<osg::Image> image = makeImage(100, 90, waves);
    _mappings->addMapping(makePicture({0.0, 0.0}, 90.0, image));
    draw();
    const std::uint64_t all = _mappings->capacity().uploadedBytes;
    for (const int row : {0, 41, 89})
    {
        for (int x = 0; x < 100; x += 3)
            std::memset(image->data(x, row), 20 + row, 4);
        image->dirty();
        const std::uint64_t before = _mappings->capacity().uploadedBytes;
        EXPECT_TRUE(same(*draw(), *drawAnew(image))) << row;
        const std::uint64_t bytes = _mappings->capacity().uploadedBytes - before;
        // The slot has 128 rows; above the last row of the picture it is repeated.
        EXPECT_LT(bytes, row == 89 ? all / 2 : all / 10) << row;
        EXPECT_GT(bytes, 0u);
    }
    const std::uint64_t before = _mappings->capacity().uploadedBytes;
    image->dirty();
    draw();
    EXPECT_EQ(_mappings->capacity().uploadedBytes, before) << "nothing has changed";
}

TEST_F(LiveLayers, AnImageOfAnotherSizeIsUploadedWhole)
{
    const osg::ref_ptr<osg::Image> image = makeImage(60, 60, waves);
    _mappings->addMapping(makePicture({0.0, 0.0}, 90.0, image));
    draw();
    for (const int side : {61, 20, 200})
    {
        const osg::ref_ptr<osg::Image> other = makeImage(side, side, stripes);
        image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        std::memcpy(image->data(), other->data(), other->getTotalSizeInBytes());
        image->dirty();
        EXPECT_TRUE(same(*draw(), *drawAnew(image))) << side;
    }
}

TEST_F(LiveLayers, WhatAnotherPassPaintsShowsInTheSameFrame)
{
    // No power of two, and more texels than pixels, so that levels count.
    for (const auto& [width, height] : {std::pair(50, 30), std::pair(700, 420), std::pair(64, 64)})
    {
        const osg::ref_ptr<osg::Texture2D> texture = textureOf(width, height);
        const osg::ref_ptr<osg::Camera> camera = painter(texture);
        const osg::ref_ptr<DataLayer> layer = new DataLayer;
        layer->setTexture(texture);
        const osg::ref_ptr<ProjectiveMapping> mapping = makePicture({0.0, 0.0}, 90.0, nullptr);
        mapping->setLayer(layer);
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->addMapping(mapping);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(mappings);
        scene->addChild(makeGround());
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(camera);
        root->addChild(scene);
        for (int frame = 0; frame < 3; ++frame)
        {
            // Edges on texels' edges, so that the same picture can be made by hand.
            const int left = width / 5 + frame, top = height / 2 + frame;
            camera->setClearColor(osg::Vec4(0.2f, 0.4f, 0.6f, 1.0f));
            camera->removeChildren(0, camera->getNumChildren());
            camera->addChild(rectangle(1.0 * left / width, 0.0, 1.0, 1.0 * top / height,
                                       osg::Vec4(0.8f, 0.2f, 0.4f, 1.0f)));
            const osg::ref_ptr<osg::Image> byHand =
                makeImage(width, height,
                          [&](double u, double v)
                          {
                              const bool within = u * width > left && v * height < top;
                              return within ? osg::Vec4d(0.8, 0.2, 0.4, 1.0) : osg::Vec4d(0.2, 0.4, 0.6, 1.0);
                          });
            // The texture's object is there when it has been drawn once.
            if (frame == 0) render(root);
            const osg::ref_ptr<osg::Image> picture = render(root);
            const osg::ref_ptr<osg::Image> expected = drawAnew(byHand);
            // Averages of colors are those of light there, and of bytes here: edges differ by some shades.
            int off = 0;
            for (int y = 0; y < _height; ++y)
                for (int x = 0; x < _width; ++x)
                    if (difference(at(*picture, x, y), at(*expected, x, y)) > tolerance) ++off;
            EXPECT_LE(off, width > 200 ? 3 * (_width + _height) : 0) << width << ", frame " << frame;
            EXPECT_GT(difference(at(*picture, _width / 2 + 20, _height / 2 - 20), groundColor()), 0.2);
        }
    }
}

TEST_F(LiveLayers, TexturesThatCannotBeShownAreSaid)
{
    const osg::ref_ptr<DataLayer> layer = new DataLayer;
    layer->setTexture(new osg::Texture2D);
    const osg::ref_ptr<ProjectiveMapping> mapping = makePicture({0.0, 0.0}, 90.0, nullptr);
    mapping->setLayer(layer);
    _mappings->addMapping(mapping);
    osg::ref_ptr<osg::Image> picture;
    const auto said = [&](const char* words)
    {
        const std::vector<std::string> messages = watch().messagesOf(
            [&]
            {
                draw();
                picture = draw();
            });
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find(words), std::string::npos) << messages[0];
        EXPECT_LE(difference(at(*picture, 80, 80), groundColor()), tolerance);
    };
    said("setTextureSize");
    layer->setTexture(textureOf(32, 32));
    layer->setKind(DataLayer::VALUE);
    said("kind");
    layer->setKind(DataLayer::COLOR);
    _mappings->setPageSide(64);
    layer->setTexture(textureOf(100, 10));
    said("pageSide");
    layer->setTexture(textureOf(32, 32));
    draw(); // transparent until something is drawn into it
    EXPECT_LE(difference(at(*draw(), 80, 80), groundColor()), tolerance);
}
