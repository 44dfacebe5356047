// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/MappingStage.h>

#include <tools/ImageComparison.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

using namespace osgGeoFX;

namespace geofx::test
{

MappingStage::MappingStage(int width, int height) : GlFixture(width, height), _width(width), _height(height)
{
}

void MappingStage::SetUp()
{
    GlFixture::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    osg::Camera& camera = *viewer().getCamera();
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setClearColor({0, 0, 0, 1});
    viewer().setLightingMode(osg::View::NO_LIGHT);
    _scene->addEffect(_mappings);
    _scene->addChild(makeGround());
}

osg::ref_ptr<osg::Geometry> MappingStage::makeGround(double half, int cells)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    const auto row = static_cast<unsigned int>(cells + 1);
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            vertices->push_back(
                osg::Vec3d(half * (2.0 * i / cells - 1.0), half * (2.0 * j / cells - 1.0), 0.0));
            if (i == cells || j == cells) continue;
            const auto a = static_cast<unsigned int>(vertices->size()) - 1;
            for (const unsigned int index : {a, a + 1, a + row + 1, a, a + row + 1, a + row})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array;
    color->push_back(osg::Vec4(osg::Vec3(groundColor()), 1.0f));
    osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
    ground->setUseDisplayList(false);
    ground->setUseVertexBufferObjects(false);
    ground->setVertexArray(vertices);
    ground->setColorArray(color, osg::Array::BIND_OVERALL);
    ground->addPrimitiveSet(triangles);
    return ground;
}

osg::ref_ptr<ProjectiveMapping> MappingStage::makeSolid(const osg::Vec2d& center, double half,
                                                        const osg::Vec3d& color)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle(center, half, half);
    mapping->setSoftEdges(false);
    mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
    mapping->getTransfer()->setConstant(osg::Vec4d(color, 1.0));
    return mapping;
}

osg::ref_ptr<ProjectiveMapping> MappingStage::makePicture(const osg::Vec2d& center, double half,
                                                          osg::Image* image)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle(center, half, half);
    mapping->setSoftEdges(false);
    mapping->setLayer(new DataLayer(image));
    return mapping;
}

osg::ref_ptr<osg::Image> MappingStage::makeImage(int width, int height,
                                                 const std::function<osg::Vec4d(double u, double v)>& color)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < height; ++y)
    {
        for (int x = 0; x < width; ++x)
        {
            const osg::Vec4d rgba = color((x + 0.5) / width, (y + 0.5) / height);
            unsigned char* texel = image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            for (int c = 0; c < 4; ++c)
                texel[c] = static_cast<unsigned char>(std::lround(255.0 * rgba[c]));
        }
    }
    return image;
}

osg::ref_ptr<osg::Image> MappingStage::makeImage(int side, const osg::Vec3d& color)
{
    return makeImage(side, side, [&](double, double) { return osg::Vec4d(color, 1.0); });
}

osg::Vec4d MappingStage::waves(double u, double v)
{
    return {0.5 + 0.5 * std::sin(9.0 * u), 0.5 + 0.5 * std::cos(7.0 * v), 0.5 + 0.5 * std::sin(5.0 * (u + v)),
            0.4 + 0.6 * u};
}

osg::Vec4d MappingStage::stripes(double u, double v)
{
    const bool on = std::fmod(6.0 * u + 2.0 * v, 1.0) < 0.5;
    return on ? osg::Vec4d(1.0, 0.8, 0.0, 1.0) : osg::Vec4d(0.0, 0.3, 0.9, 0.5);
}

osg::Vec3d MappingStage::colorOf(int number)
{
    // Steps that have no factor in common with the numbers of shades.
    return {(60 + (number * 37) % 190) / 255.0, (90 + (number * 53) % 160) / 255.0,
            (70 + (number * 29 + number / 160) % 180) / 255.0};
}

void MappingStage::lookDown(const osg::Vec2d& at, double pixel, double heading)
{
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt(osg::Vec3d(at, 1000.0), osg::Vec3d(at, 0.0),
                                 osg::Vec3d(std::sin(heading), std::cos(heading), 0.0));
    const double x = 0.5 * pixel * _width;
    const double y = 0.5 * pixel * _height;
    camera.setProjectionMatrixAsOrtho(-x, x, -y, y, 1.0, 2000.0);
}

void MappingStage::look(const osg::Vec3d& eye, const osg::Vec3d& at, double angle)
{
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt(eye, at, osg::Vec3d(0.0, 0.0, 1.0));
    const double distance = (at - eye).length();
    camera.setProjectionMatrixAsPerspective(angle, static_cast<double>(_width) / _height, 0.02 * distance,
                                            20.0 * distance + 2000.0);
}

osg::Vec2d MappingStage::pixelOf(const osg::Vec3d& world)
{
    const osg::Camera& camera = *viewer().getCamera();
    const osg::Vec3d p = world * camera.getViewMatrix() * camera.getProjectionMatrix();
    return {0.5 * (p.x() + 1.0) * _width, 0.5 * (p.y() + 1.0) * _height};
}

bool MappingStage::inside(const osg::Vec2d& pixel, double border) const
{
    return pixel.x() >= border && pixel.y() >= border && pixel.x() < _width - border &&
           pixel.y() < _height - border;
}

osg::Vec3d MappingStage::at(const osg::Image& image, int x, int y)
{
    const unsigned char* data = image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    return {data[0] / 255.0, data[1] / 255.0, data[2] / 255.0};
}

osg::Vec3d MappingStage::at(const osg::Image& image, const osg::Vec2d& pixel)
{
    return at(image, static_cast<int>(std::floor(pixel.x())), static_cast<int>(std::floor(pixel.y())));
}

double MappingStage::difference(const osg::Vec3d& a, const osg::Vec3d& b)
{
    return std::max({std::abs(a.x() - b.x()), std::abs(a.y() - b.y()), std::abs(a.z() - b.z())});
}

::testing::AssertionResult MappingStage::same(const osg::Image& a, const osg::Image& b)
{
    return imagesMatch(a, b);
}

int MappingStage::differing(const osg::Image& a, const osg::Image& b)
{
    int count = 0;
    for (int y = 0; y < a.t(); ++y)
    {
        for (int x = 0; x < a.s(); ++x)
            count += alike(at(a, x, y), at(b, x, y)) ? 0 : 1;
    }
    return count;
}

osg::ref_ptr<osg::Image> MappingStage::drawSettled(const osgGeoFX::PagedRaster& raster)
{
    for (int i = 0; i < 2000; ++i)
    {
        const osg::ref_ptr<osg::Image> image = draw();
        // What the last frame saw is known to the next one.
        if (i >= 2 && raster.statistics().settled) return image;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "never settled";
    return draw();
}

} // namespace geofx::test
