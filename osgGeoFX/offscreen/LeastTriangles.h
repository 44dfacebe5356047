// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Vec3f>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** How few triangles would do for a view of a terrain database: what the triangles that are drawn can be compared with.

    The measure is a right-triangulated irregular network over all samples of the database, made for this one view. A vertex
    belongs to it if its hierarchical error, the largest vertical error of all that its split brings with it, covers more than the
    pixel error at the vertex' distance. Each vertex in the view counts for two triangles. (Evans, Kirkpatrick, Townsend:
    Right-triangulated irregular networks, 2001.) Skirts and what lies behind the terrain's own hills are not considered.

    Immutable; every thread may use it. It holds 16 bytes for each sample of the database. */
class OSGGEOFX_EXPORT LeastTriangles
{
public:
    /** Reads all finest tiles of the database at or below a node; the node itself stays as it is. This takes as long as reading the
        whole database does. Null, and a sentence in `error`, where there is no database of osggeofx_build or a tile is missing. */
    static std::unique_ptr<LeastTriangles> read(const osg::Node& root, std::string& error);

    /** The count for one view. `view` is from the world to eye space, `projection` from there to clip space. `pixelsPerRadian` is that of
        the picture, `pixelError` the allowed error in pixels. With deformations, their places and distances count. */
    std::uint64_t count(const osg::Matrixd& view, const osg::Matrixd& projection, double pixelsPerRadian,
                        double pixelError, const DeformationChain& chain) const;

private:
    LeastTriangles() = default;

    std::size_t place(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(_side) +
               static_cast<std::size_t>(column);
    }
    osg::Vec3d up(const osg::Vec3d& position) const;
    float ownError(int column, int row, int alongColumns, int alongRows) const;
    void findEnd();
    void gatherErrors();

    osg::Vec3d _origin; ///< of the positions, in the world
    bool _geocentric = false;
    int _side = 0;                      ///< samples along the quadtree's border, a power of two and one
    int _lastColumn = 0, _lastRow = 0;  ///< the terrain ends there
    std::vector<osg::Vec3f> _positions; ///< row by row from the south; NaN where there is no ground
    std::vector<float> _errors;         ///< hierarchical, metres
};

} // namespace osgGeoFX
