// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>

#include <ostream>
#include <string>

namespace geofx::test
{

/// The types of vertex arrays that OpenGL draws as positions.
enum class VertexType
{
    Vec2,
    Vec3,
    Vec4,
    ScaledVec4, ///< all four coordinates doubled
    Vec2d,
    Vec3d,
    Vec4d,
    Vec3s,
    Vec4s,
    Vec3i
};

inline const char* nameOf(VertexType type)
{
    static const char* const names[] = {"Vec2",  "Vec3",  "Vec4",  "ScaledVec4", "Vec2d",
                                        "Vec3d", "Vec4d", "Vec3s", "Vec4s",      "Vec3i"};
    return names[static_cast<int>(type)];
}

/// For gtest, which would print bytes.
inline void PrintTo(VertexType type, std::ostream* out)
{
    *out << nameOf(type);
}

/// Whether a type has a third coordinate; where it has not, z is 0.
inline bool hasHeight(VertexType type)
{
    return type != VertexType::Vec2 && type != VertexType::Vec2d;
}

inline bool isInteger(VertexType type)
{
    return type >= VertexType::Vec3s;
}

/// The same vertices as an array of another type; those of integers are cut off.
osg::ref_ptr<osg::Array> convertVertices(const osg::Vec3Array& vertices, VertexType type);

} // namespace geofx::test
