// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Matrixd>
#include <osg/Texture2D>
#include <osg/Vec2f>
#include <osg/Vec3d>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// What one drawable has of a mesh.
struct MeshPiece
{
    std::vector<osg::Vec3d> positions; ///< eye space, deformed; local when the mesh is ready
    std::vector<osg::Vec3d> normals;   ///< likewise, of length 1; empty where there are none
    std::vector<osg::Vec2f> places;    ///< in the texture; empty where there are none
    std::vector<unsigned int> corners; ///< three for each triangle
    osg::ref_ptr<osg::Texture2D> texture;
};

/// Writes an .obj file with its materials and textures. `notes`: lines of comment. False if it cannot.
bool writeObjFile(const std::string& file, const std::vector<MeshPiece>& pieces,
                  const std::vector<std::string>& notes);

} // namespace osgGeoFX
