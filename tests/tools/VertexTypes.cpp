// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/VertexTypes.h>

#include <algorithm>

namespace geofx::test
{

namespace
{

template<typename Array, typename Convert>
osg::ref_ptr<osg::Array> converted(const osg::Vec3Array& vertices, Convert convert)
{
    osg::ref_ptr<Array> array = new Array;
    for (const osg::Vec3& vertex : vertices)
        array->push_back(convert(vertex));
    return array;
}

} // namespace

osg::ref_ptr<osg::Array> convertVertices(const osg::Vec3Array& vertices, VertexType type)
{
    const auto whole = [](float value)
    {
        return static_cast<short>(value);
    };
    switch (type)
    {
    case VertexType::Vec2:
        return converted<osg::Vec2Array>(vertices,
                                         [](const osg::Vec3& v) { return osg::Vec2(v.x(), v.y()); });
    case VertexType::Vec4:
        return converted<osg::Vec4Array>(vertices, [](const osg::Vec3& v) { return osg::Vec4(v, 1.0f); });
    case VertexType::ScaledVec4:
        return converted<osg::Vec4Array>(vertices,
                                         [](const osg::Vec3& v) { return osg::Vec4(v, 1.0f) * 2.0f; });
    case VertexType::Vec2d:
        return converted<osg::Vec2dArray>(vertices, [](const osg::Vec3& v)
                                          { return osg::Vec2d(osg::Vec2(v.x(), v.y())); });
    case VertexType::Vec3d:
        return converted<osg::Vec3dArray>(vertices, [](const osg::Vec3& v) { return osg::Vec3d(v); });
    case VertexType::Vec4d:
        return converted<osg::Vec4dArray>(vertices,
                                          [](const osg::Vec3& v) { return osg::Vec4d(osg::Vec3d(v), 1.0); });
    case VertexType::Vec3s:
        return converted<osg::Vec3sArray>(vertices, [&](const osg::Vec3& v)
                                          { return osg::Vec3s(whole(v.x()), whole(v.y()), whole(v.z())); });
    case VertexType::Vec4s:
        return converted<osg::Vec4sArray>(
            vertices,
            [&](const osg::Vec3& v) { return osg::Vec4s(whole(v.x()), whole(v.y()), whole(v.z()), 1); });
    case VertexType::Vec3i:
        return converted<osg::Vec3iArray>(vertices, [&](const osg::Vec3& v)
                                          { return osg::Vec3i(whole(v.x()), whole(v.y()), whole(v.z())); });
    case VertexType::Vec3:
        break;
    }
    return new osg::Vec3Array(vertices);
}

} // namespace geofx::test
