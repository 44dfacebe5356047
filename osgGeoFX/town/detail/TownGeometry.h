// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>

#include <vector>

namespace osgGeoFX
{

/** What all geometry of a town has in common. */
struct TownGeometry
{
    /// Triangles by three indices each, with a color for each vertex. The indices are as short as they can be.
    static osg::ref_ptr<osg::Geometry> create(const std::vector<osg::Vec3>& places,
                                              const std::vector<osg::Vec4ub>& colors,
                                              const std::vector<unsigned int>& triangles);
    /// The array, with a buffer of its own: drivers count how often one is written.
    static osg::Array* withOwnBuffer(osg::Array* array);
};

} // namespace osgGeoFX
