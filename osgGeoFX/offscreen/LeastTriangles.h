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

/** Counts the least number of triangles that would suffice for a view of a terrain database, as a measure for the
    triangles that are drawn.

    The measure is a right-triangulated irregular network over all samples of the database, made for one view. A vertex
    belongs to the network if its hierarchical error covers more pixels than the pixel error at the vertex's distance.
    The hierarchical error is the largest vertical error of all vertices that its split requires. Each vertex in the
    view counts as two triangles (Evans, Kirkpatrick, Townsend: Right-triangulated irregular networks, 2001). The count
    ignores skirts and occlusion by the terrain's own hills.

    Immutable, so all threads may use it. It holds 16 bytes for each sample of the square quadtree around the database.
    @ingroup offscreen */
class OSGGEOFX_EXPORT LeastTriangles
{
public:
    /** Reads all finest tiles of the database at or below a node, which stays unchanged. This takes as long as reading
        the whole database. Returns null, with a sentence in `error`, if there is no database of osggeofx_build, it has
        no ground, its finest tiles differ in size, or a tile cannot be read. */
    static std::unique_ptr<LeastTriangles> read(const osg::Node& root, std::string& error);

    /** The count for one view. `view` is from the world to eye space, `projection` from eye space to clip space.
        `pixelsPerRadian` is that of the viewport, `pixelError` the allowed error in pixels. With deformations, the
        deformed positions and distances count. */
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

    osg::Vec3d _origin; ///< of the positions, world coordinates
    bool _geocentric = false;
    int _side = 0;                      ///< samples along the quadtree's border, a power of two and one
    int _lastColumn = 0, _lastRow = 0;  ///< the terrain's end
    std::vector<osg::Vec3f> _positions; ///< row by row from the south; NaN where there is no ground
    std::vector<float> _errors;         ///< hierarchical, metres
};

} // namespace osgGeoFX
