// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/BentGround.h>

#include <tools/ImageComparison.h>

#include <cmath>
#include <cstring>

namespace geofx::test
{

namespace
{

osg::ref_ptr<osg::Geometry> makeMesh(osg::Vec3Array* vertices, osg::Vec3Array* normals,
                                     osg::Vec4Array* colors, osg::DrawElements* triangles)
{
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->setUseDisplayList(false);
    mesh->setUseVertexBufferObjects(false);
    mesh->setVertexArray(vertices);
    mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    mesh->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    mesh->addPrimitiveSet(triangles);
    return mesh;
}

} // namespace

void BentGround::SetUp()
{
    GlFixture::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    osg::Camera& camera = *viewer().getCamera();
    camera.setClearColor({26 / 255.0f, 51 / 255.0f, 77 / 255.0f, 1});
    camera.setViewMatrixAsLookAt({0, -150, 70}, {0, -40, 0}, {0, 0, 1});
    camera.setProjectionMatrixAsPerspective(40, 4.0 / 3.0, 5, 2000);
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    viewer().setLightingMode(osg::View::NO_LIGHT);
}

osg::ref_ptr<osg::Geometry> BentGround::makeGround()
{
    constexpr int cells = 150;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::Vec2Array> more = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            const float x = 2.0f * static_cast<float>(i) - 150.0f;
            const float y = 2.0f * static_cast<float>(j) - 150.0f;
            vertices->push_back({x, y, std::sin(x / 13) * std::cos(y / 17)});
            osg::Vec3 normal(-1.0f / 13 * std::cos(x / 13) * std::cos(y / 17),
                             1.0f / 17 * std::sin(x / 13) * std::sin(y / 17), 1);
            normal.normalize();
            normals->push_back(normal);
            colors->push_back({0.5f + 0.4f * std::sin(x / 9), 0.5f + 0.4f * std::sin(y / 7),
                               0.4f + 0.3f * std::cos((x + y) / 11), 1});
            coordinates->push_back({x / 50 + 3, y / 50 + 3});
            more->push_back({x / 20 + 7, y / 20 + 7});
            if (i == cells || j == cells) continue;
            const auto a = static_cast<GLuint>(j * (cells + 1) + i);
            const auto b = a + cells + 1;
            for (const GLuint index : {a, a + 1, b, a + 1, b + 1, b})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> ground = makeMesh(vertices, normals, colors, triangles);
    ground->setTexCoordArray(0, coordinates);
    ground->setTexCoordArray(1, more);
    return ground;
}

osg::ref_ptr<osg::Geometry> BentGround::makeBox(float size)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (unsigned int face = 0; face < 6; ++face)
    {
        const unsigned int axis = face / 2;
        const float sign = face % 2 ? 1.0f : -1.0f;
        const auto first = static_cast<GLushort>(vertices->size());
        for (int corner = 0; corner < 4; ++corner)
        {
            osg::Vec3 place;
            place[axis] = sign;
            place[(axis + 1) % 3] = (corner & 1) ? sign : -sign;
            place[(axis + 2) % 3] = (corner & 2) ? 1.0f : -1.0f;
            osg::Vec3 normal;
            normal[axis] = sign;
            vertices->push_back({place.x() * size / 2, place.y() * size / 2, (place.z() + 1) * size});
            normals->push_back(normal);
            colors->push_back(
                {face < 2 ? 0.9f : 0.3f, face < 4 ? 0.7f : 0.9f, 0.2f + 0.15f * static_cast<float>(face), 1});
        }
        for (const int index : {0, 1, 2, 1, 3, 2})
            triangles->push_back(static_cast<GLushort>(first + index));
    }
    return makeMesh(vertices, normals, colors, triangles);
}

osg::ref_ptr<osg::MatrixTransform> BentGround::makeBox(float size, const osg::Vec3d& place)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(osg::Matrix::translate(place));
    transform->addChild(makeBox(size));
    return transform;
}

osg::ref_ptr<osgGeoFX::BirdsEyeView> BentGround::makeBend()
{
    osg::ref_ptr<osgGeoFX::BirdsEyeView> bend = new osgGeoFX::BirdsEyeView;
    bend->setHorizonLine(0.8);
    bend->setFocusLine(0.35);
    bend->setContextTilt(0.7);
    return bend;
}

osg::ref_ptr<osgGeoFX::ProjectiveMappings> BentGround::makePaint()
{
    osg::ref_ptr<osgGeoFX::ProjectiveMapping> mapping = new osgGeoFX::ProjectiveMapping;
    mapping->setRectangle(osg::Vec2d(0.0, 0.0), 80.0, 60.0, 0.3);
    mapping->getTransfer()->setSource(osgGeoFX::ColorTransfer::CONSTANT);
    mapping->getTransfer()->setConstant(osg::Vec4d(0.9, 0.1, 0.1, 1.0));
    osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    mappings->addMapping(mapping);
    return mappings;
}

osg::ref_ptr<osgGeoFX::EffectScene>
BentGround::makeScene(const std::vector<osg::ref_ptr<osg::Node>>& children)
{
    osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(makeBend());
    for (const auto& child : children)
        scene->addChild(child);
    return scene;
}

osg::ref_ptr<osg::Group> BentGround::makePlain(const std::vector<osg::ref_ptr<osg::Node>>& children)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const auto& child : children)
        group->addChild(child);
    return group;
}

::testing::AssertionResult BentGround::same(const osg::Image& a, const osg::Image& b, const std::string& name)
{
    return imagesMatch(a, b, {}, name);
}

int BentGround::covered(const osg::Image& image)
{
    constexpr unsigned char background[] = {26, 51, 77};
    int count = 0;
    for (unsigned int i = 0; i < image.getTotalSizeInBytes(); i += 4)
        count += std::memcmp(image.data() + i, background, sizeof background) ? 1 : 0;
    return count;
}

int BentGround::differing(const osg::Image& a, const osg::Image& b, int from, int to)
{
    int count = 0;
    for (int row = from; row < to; ++row)
    {
        for (int column = 0; column < a.s(); ++column)
        {
            count += std::memcmp(a.data(column, row), b.data(column, row), 3) ? 1 : 0;
        }
    }
    return count;
}

} // namespace geofx::test
