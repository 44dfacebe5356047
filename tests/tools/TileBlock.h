// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Array>
#include <osg/Geometry>
#include <osg/LOD>

namespace geofx::test
{

/// A block of a tile, as databases have them, whose only mesh is a geometry. The indices that the geometry has belong to
/// the ground; those that it gets later belong to walls.
inline osg::ref_ptr<osg::LOD> makeTileBlock(osg::Geometry& mesh)
{
    osg::ref_ptr<osg::Vec2Array> meshes = new osg::Vec2Array;
    meshes->push_back({1.0f, static_cast<float>(mesh.getPrimitiveSet(0)->getNumIndices())});
    osg::ref_ptr<osg::LOD> block = new osg::LOD;
    block->addChild(&mesh, 0.0f, 1e9f);
    block->setUserData(meshes);
    return block;
}

} // namespace geofx::test
