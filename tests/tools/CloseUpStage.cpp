// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/CloseUpStage.h>

#include <tools/Town.h>

#include <osg/LightSource>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;

namespace geofx::test
{

namespace
{

osg::ref_ptr<osg::Texture2D> makeTexture()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(32, 32, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 32 * 32; ++i)
    {
        unsigned char* texel = image->data() + 3 * i;
        const int wave = (i % 32) * 5 + (i / 32) * 3;
        texel[0] = static_cast<unsigned char>(120 + wave % 130);
        texel[1] = static_cast<unsigned char>(250 - wave % 110);
        texel[2] = static_cast<unsigned char>(150 + (wave * 7) % 90);
    }
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::MIRROR);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::MIRROR);
    return texture;
}

} // namespace

CloseUpStage::CloseUpStage(int width, int height) : GlFixture(width, height), _width(width), _height(height)
{
}

void CloseUpStage::SetUp()
{
    GlFixture::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    osg::Camera& camera = *viewer().getCamera();
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setClearColor({0.1f, 0.2f, 0.3f, 1.0f});
    viewer().setLightingMode(osg::View::NO_LIGHT);
    osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition({0.4f, -0.5f, 0.8f, 0.0f});
    sun->getLight()->setAmbient({0.3f, 0.3f, 0.3f, 1.0f});
    _root->addChild(sun);
    _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    _root->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    _root->addChild(_scene);
    _scene->addEffect(_closeUps);
    osg::ref_ptr<osg::Geometry> hills = makeHills();
    hills->getOrCreateStateSet()->setTextureAttributeAndModes(0, makeTexture());
    _scene->addChild(hills);
    look({300.0, -1800.0, 1200.0}, {0.0, 0.0, 100.0});
}

double CloseUpStage::groundHeight(double x, double y)
{
    return 60.0 * std::sin(x / 170.0) * std::cos(y / 210.0) + 0.02 * x;
}

osg::ref_ptr<osg::Geometry> CloseUpStage::makeHills(double half, int cells)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    const auto row = static_cast<unsigned int>(cells + 1);
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            const double u = static_cast<double>(i) / cells;
            const double v = static_cast<double>(j) / cells;
            const double x = half * (2.0 * u - 1.0);
            const double y = half * (2.0 * v - 1.0);
            osg::Vec3d normal(groundHeight(x - 1.0, y) - groundHeight(x + 1.0, y),
                              groundHeight(x, y - 1.0) - groundHeight(x, y + 1.0), 2.0);
            normal.normalize();
            vertices->push_back(osg::Vec3d(x, y, groundHeight(x, y)));
            normals->push_back(normal);
            coordinates->push_back(osg::Vec2(osg::Vec2d(6.0 * u, 6.0 * v)));
            if (i == cells || j == cells) continue;
            const auto a = static_cast<unsigned int>(vertices->size()) - 1;
            for (const unsigned int index : {a, a + 1, a + row + 1, a, a + row + 1, a + row})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> hills = new osg::Geometry;
    hills->setUseDisplayList(false);
    hills->setUseVertexBufferObjects(true);
    hills->setVertexArray(vertices);
    hills->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    hills->setTexCoordArray(0, coordinates);
    // OSG's default material takes the color, and without one that of whatever was drawn last.
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(1);
    white->front().set(1.0f, 1.0f, 1.0f, 1.0f);
    hills->setColorArray(white, osg::Array::BIND_OVERALL);
    hills->addPrimitiveSet(triangles);
    return hills;
}

osg::ref_ptr<osg::Geometry> CloseUpStage::makeHouses()
{
    TownPlan plan;
    plan.center = osg::Vec2d(-200.0, 100.0);
    plan.blocksAcross = plan.blocksAlong = 5;
    plan.height = groundHeight;
    return makeTown(plan);
}

osg::ref_ptr<CloseUp> CloseUpStage::makeCloseUp(const osg::Vec2d& center, double size, double rise)
{
    osg::ref_ptr<CloseUp> closeUp = new CloseUp;
    closeUp->getRegion()->setCenter(center);
    closeUp->getRegion()->setSize(size, size);
    closeUp->getRegion()->setMaskSide(64);
    closeUp->setOffset({0.0, 0.0, rise});
    return closeUp;
}

void CloseUpStage::look(const osg::Vec3d& eye, const osg::Vec3d& at, double angle)
{
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt(eye, at, osg::Vec3d(0.0, 0.0, 1.0));
    const double distance = (at - eye).length();
    camera.setProjectionMatrixAsPerspective(angle, static_cast<double>(_width) / _height, 0.02 * distance,
                                            20.0 * distance + 2000.0);
}

void CloseUpStage::lookAnyhow(Random& random)
{
    osg::Camera& camera = *viewer().getCamera();
    const double azimuth = random.uniform(0.0, 6.28);
    const double elevation = random.uniform(0.2, 1.4);
    const double distance = random.logarithmic(900.0, 3000.0);
    const osg::Vec3d at(random.uniform(-300.0, 300.0), random.uniform(-300.0, 300.0),
                        random.uniform(0.0, 300.0));
    look(at + osg::Vec3d(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                         std::sin(elevation)) *
                  distance,
         at, random.uniform(30.0, 60.0));
    if (random.integer(0, 3) == 0)
        camera.setViewMatrix(camera.getViewMatrix() *
                             osg::Matrixd::rotate(random.uniform(-1.0, 1.0), osg::Vec3d(0.0, 0.0, 1.0)));
    if (random.integer(0, 4) > 0) return;
    const double half = 0.4 * distance;
    camera.setProjectionMatrixAsOrtho(-half * _width / _height, half * _width / _height, -half, half, 1.0,
                                      distance + 3000.0);
}

osg::ref_ptr<EffectScene> CloseUpStage::sceneOf(const Effects& effects, osg::Node* content)
{
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    scene->addChild(content);
    for (const osg::ref_ptr<Effect>& effect : effects)
        scene->addEffect(effect);
    return scene;
}

osg::ref_ptr<osg::Image> CloseUpStage::picture(const Effects& effects, osg::Node* content)
{
    _root->removeChild(_scene);
    _scene = sceneOf(effects, content);
    _root->addChild(_scene);
    draw();
    return draw();
}

std::pair<osg::ref_ptr<osg::Image>, osg::ref_ptr<osg::Image>> CloseUpStage::drawBoth()
{
    _closeUps->setPipeline(CloseUps::SINGLE_PASS);
    const osg::ref_ptr<osg::Image> single = draw();
    if (_closeUps->statistics().closeUps > 0)
    {
        EXPECT_EQ(_closeUps->statistics().pipeline, CloseUps::SINGLE_PASS);
    }
    _closeUps->setPipeline(CloseUps::MULTI_PASS);
    const osg::ref_ptr<osg::Image> multiple = draw();
    EXPECT_EQ(_closeUps->statistics().pipeline, CloseUps::MULTI_PASS);
    return {single, multiple};
}

double CloseUpStage::differing(const osg::Image& a, const osg::Image& b, int tolerance)
{
    EXPECT_EQ(a.getTotalSizeInBytes(), b.getTotalSizeInBytes());
    int count = 0;
    for (int i = 0; i < a.s() * a.t(); ++i)
    {
        int most = 0;
        for (int channel = 0; channel < 3; ++channel)
            most = std::max(most, std::abs(a.data()[4 * i + channel] - b.data()[4 * i + channel]));
        count += most > tolerance ? 1 : 0;
    }
    return static_cast<double>(count) / (a.s() * a.t());
}

} // namespace geofx::test
