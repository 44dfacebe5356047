// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Which geometry takes mappings: what has textures of its own, subgraphs with channels, holes, and rigid objects.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/MappingStage.h>

#include <osg/MatrixTransform>
#include <osg/Texture2D>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

class MappingGeometry : public MappingStage
{
};

TEST_F(MappingGeometry, TexturesOfTheGeometryStay)
{
    const auto textured = [&]
    {
        osg::ref_ptr<osg::Geometry> ground = makeGround();
        const auto& vertices = static_cast<const osg::Vec3Array&>(*ground->getVertexArray());
        osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
        for (const osg::Vec3& vertex : vertices)
            coordinates->push_back({vertex.x() / 50.0f, vertex.y() / 70.0f});
        for (unsigned int unit = 0; unit < 4; ++unit)
        {
            osg::ref_ptr<osg::Texture2D> texture =
                new osg::Texture2D(makeImage(16, 16, unit % 2 ? stripes : waves));
            texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
            texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
            ground->setTexCoordArray(unit, coordinates);
            ground->getOrCreateStateSet()->setTextureAttributeAndModes(unit, texture);
        }
        osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array;
        white->push_back(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
        ground->setColorArray(white, osg::Array::BIND_OVERALL);
        return ground;
    };
    lookDown({0.0, 0.0}, 1.2);
    const auto draw = [&](ProjectiveMapping* mapping)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        if (mapping) mappings->addMapping(mapping);
        scene->addEffect(mappings);
        scene->addChild(textured());
        return render(scene);
    };
    const osg::ref_ptr<osg::Image> plain = draw(nullptr);
    const osg::ref_ptr<osg::Image> mapped =
        draw(makePicture({0.0, 0.0}, 40.0, makeImage(1, {0.0, 1.0, 0.0})));
    int covered = 0;
    for (int y = 0; y < _height; ++y)
    {
        for (int x = 0; x < _width; ++x)
        {
            const osg::Vec2d place((x + 0.5 - 0.5 * _width) * 1.2, (y + 0.5 - 0.5 * _height) * 1.2);
            const bool within = std::abs(place.x()) < 40.0 && std::abs(place.y()) < 40.0;
            covered += within ? 1 : 0;
            const osg::Vec3d expected = within ? osg::Vec3d(0.0, 1.0, 0.0) : at(*plain, x, y);
            ASSERT_TRUE(alike(at(*mapped, x, y), expected)) << x << ", " << y;
        }
    }
    EXPECT_GT(covered, 4000);
    EXPECT_GT(differing(*plain, *MappingStage::draw()), _width * _height / 2);
}

TEST_F(MappingGeometry, Channels)
{
    // Two grounds side by side.
    osg::ref_ptr<osg::Group> halves[2];
    _scene->removeChildren(0, 1);
    for (int i = 0; i < 2; ++i)
    {
        osg::ref_ptr<osg::MatrixTransform> half =
            new osg::MatrixTransform(osg::Matrix::translate(i ? 100.0 : -100.0, 0.0, 0.0));
        half->addChild(makeGround(100.0));
        _scene->addChild(half);
        halves[i] = half;
    }
    lookDown({0.0, 0.0}, 1.0);
    for (int i = 0; i < 3; ++i)
    {
        _mappings->addMapping(makeSolid({0.0, 0.0}, 60.0 - 15.0 * i, colorOf(i)));
        _mappings->getMapping(static_cast<unsigned int>(i))->setChannels(1 << i);
    }
    // In the middle of each half lie all three.
    const auto seen = [&](const osg::Image& image, double x)
    {
        const osg::Vec3d color = at(image, pixelOf(osg::Vec2d(x, 0.0)));
        for (int i = 0; i < 3; ++i)
        {
            if (alike(color, colorOf(i))) return i;
        }
        return alike(color, groundColor()) ? -1 : -2;
    };
    const auto expectSeen = [&](int left, int right)
    {
        const osg::ref_ptr<osg::Image> image = draw();
        EXPECT_EQ(seen(*image, -10.0), left);
        EXPECT_EQ(seen(*image, 10.0), right);
    };
    expectSeen(2, 2);
    const auto setChannels = [&](int half, const char* bits)
    {
        halves[half]->getOrCreateStateSet()->setDefine("GEOFX_MAPPING_CHANNELS", bits,
                                                       osg::StateAttribute::ON);
    };
    setChannels(0, "0");
    expectSeen(-1, 2);
    setChannels(0, "3");
    expectSeen(1, 2);
    setChannels(1, "1");
    expectSeen(1, 0);
    _mappings->getMapping(2)->setChannels(255);
    expectSeen(2, 2);
    _mappings->getMapping(2)->setChannels(0);
    expectSeen(1, 0);
    halves[0]->setStateSet(nullptr);
    expectSeen(1, 0);
}

TEST_F(MappingGeometry, Discard)
{
    // Through a hole one sees another ground below.
    osg::ref_ptr<osg::MatrixTransform> cellar =
        new osg::MatrixTransform(osg::Matrix::translate(0.0, 0.0, -50.0));
    cellar->addChild(makeGround(1000.0));
    const osg::ref_ptr<ProjectiveMapping> paint = makeSolid({0.0, 0.0}, 60.0, colorOf(3));
    paint->setHeights(-60.0, -40.0);
    const osg::ref_ptr<ProjectiveMapping> hole = makeSolid({0.0, 0.0}, 30.0, colorOf(4));
    hole->getTransfer()->setEquation(ColorTransfer::DISCARD);
    hole->setHeights(-10.0, 10.0);
    _mappings->addMapping(paint);
    _mappings->addMapping(hole);
    lookDown({0.0, 0.0}, 1.0);
    EXPECT_TRUE(alike(at(*draw(), 80, 80), {0.0, 0.0, 0.0}));
    EXPECT_TRUE(alike(at(*draw(), 80, 105), {0.0, 0.0, 0.0}));
    EXPECT_TRUE(alike(at(*draw(), 80, 115), groundColor()));
    _scene->addChild(cellar);
    EXPECT_TRUE(alike(at(*draw(), 80, 80), colorOf(3)));
    EXPECT_TRUE(alike(at(*draw(), 80, 115), groundColor()));
    hole->setOpacity(0.4);
    EXPECT_TRUE(alike(at(*draw(), 80, 80), groundColor()));
    hole->setOpacity(0.6);
    EXPECT_TRUE(alike(at(*draw(), 80, 80), colorOf(3)));
}

TEST_F(MappingGeometry, RigidObjectsKeepTheirs)
{
    // A wall across the edge of a mapping; and the same wall painted in two colors.
    const osg::Vec3d place(10.0, -40.0, 0.0);
    const auto wall = [&](const osg::Vec3d& left, const osg::Vec3d& right)
    {
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
        osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
        for (const bool isRight : {false, true})
        {
            const auto first = static_cast<unsigned int>(vertices->size());
            for (int corner = 0; corner < 4; ++corner)
            {
                vertices->push_back(osg::Vec3(
                    osg::Vec3d((isRight ? 15.0 : -15.0) * (corner & 1), 0.0, (corner & 2) ? 25.0 : 0.0)));
                colors->push_back(osg::Vec4(osg::Vec3(isRight ? right : left), 1.0f));
            }
            for (const unsigned int index : {0u, 1u, 2u, 1u, 3u, 2u})
                triangles->push_back(first + index);
        }
        osg::ref_ptr<osg::Geometry> geometry = makeGround();
        geometry->setVertexArray(vertices);
        geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
        geometry->setPrimitiveSet(0, triangles);
        return geometry;
    };
    const auto drawWall =
        [&](const osg::ref_ptr<osg::Geometry>& geometry, bool rigidly, bool bent, bool mapped)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        const osg::ref_ptr<ProjectiveMapping> mapping =
            makeSolid(osg::Vec2d(place.x() - 50.0, place.y()), 50.0, colorOf(5));
        if (mapped) mappings->addMapping(mapping);
        scene->addEffect(mappings);
        osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setHorizonLine(0.8);
        bend->setFocusLine(0.35);
        bend->setContextTilt(0.7);
        if (bent) scene->addEffect(bend);
        osg::ref_ptr<osg::MatrixTransform> site = new osg::MatrixTransform(osg::Matrix::translate(place));
        osg::ref_ptr<osg::Group> holder = rigidly ? new RigidReference : new osg::Group;
        holder->addChild(geometry);
        site->addChild(holder);
        scene->addChild(site);
        return render(scene);
    };
    look({0.0, -150.0, 70.0}, {0.0, -40.0, 0.0});
    const osg::Vec3d bare(0.3, 0.2, 0.6);
    for (const bool bent : {true, false})
    {
        const osg::ref_ptr<osg::Image> actual = drawWall(wall(bare, bare), true, bent, true);
        const osg::ref_ptr<osg::Image> expected = drawWall(wall(colorOf(5), bare), true, bent, false);
        EXPECT_GT(differing(*actual, *drawWall(wall(bare, bare), true, bent, false)), 100);
        // Pixels on the edge may fall to either side.
        EXPECT_LE(differing(*actual, *expected), 3);
    }
    EXPECT_GT(differing(*drawWall(wall(bare, bare), true, true, true),
                        *drawWall(wall(bare, bare), true, false, true)),
              100);
}
