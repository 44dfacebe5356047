// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// All headers of both libraries in one file, which CMake writes: two that call different things by one name do not compile.
#include <AllHeaders.h>

#include <gtest/gtest.h>

#include <type_traits>

TEST(Headers, CallEachThingByANameOfItsOwn)
{
    EXPECT_TRUE((std::is_same_v<decltype(osgGeoFX::ViewGeometry::ground), osgGeoFX::Ground>));
    EXPECT_TRUE(std::is_class_v<osgGeoFX::Ground>);
    EXPECT_TRUE(std::is_enum_v<osgGeoFX::GroundKind>);
}
