// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>

#include <filesystem>

namespace geofx::bench
{

/** The terrain of a database as one mesh: all tiles of the finest level without their skirts, in one
   osg::Geometry with one vertex buffer, one index buffer and one texture (of the finest level whose tiles'
   textures together have at most 2048 texels along an edge), and the tiles' own kinds of arrays. What a paged
   database is measured against.

    Reads all its tiles. Throws BenchError where a tile cannot be read or is not as osggeofx_build writes it.
 */
osg::ref_ptr<osg::Node> readAsSingleMesh(const std::filesystem::path& terrain);

} // namespace geofx::bench
