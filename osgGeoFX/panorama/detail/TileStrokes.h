// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Matrixd>
#include <osg/observer_ptr>
#include <osgGeoFX/panorama/detail/StrokeParameters.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/ValueObject>

#include <optional>
#include <vector>

namespace osgGeoFX
{

/** The brush strokes of a geometry, among its user objects, or of a terrain tile, among those of its vertices: points that
    shaders/stages/panorama.strokes.* draw. Immutable once made.

    The points' arrays, in the frame of the tile's geometry:
    - vertices (vec3): where strokes stand;
    - normals (3 shorts, normalised): of the ground;
    - texture coordinates 0 (4 shorts): seed, 0…32767; level, in halves; kind, 0 tree, 1 cliff, 2 house, 3 road, 4
      river; threshold, 0…32767, or of roads and rivers the finest level that the tile has of them, in halves;
    - texture coordinates 1 (3 shorts), where there are cliffs, roads or rivers: along the ground the direction downhill or of the line.

    For copies and files it is an empty string: they get strokes of their own when they are drawn. */
class TileStrokes : public osg::StringValueObject
{
public:
    enum Kind
    {
        Tree,
        Cliff,
        House,
        Road,
        River
    };

    /// Those of a geometry, from `maker`'s parameters: made of the mesh and its textures of cover and
    /// normals. `toWorld` is the
    /// way from the geometry's frame; `ellipsoid` null for projected terrain. For any thread, while the geometry does not change.
    static osg::ref_ptr<TileStrokes> make(const osg::Geometry& terrain, const osg::Matrixd& toWorld,
                                          const StrokeParameters& parameters,
                                          const osg::EllipsoidModel* ellipsoid);

    /// Null where there are none.
    osg::Geometry* points() const { return _points.get(); }
    /// The finest level of strokes that the tile has, in halves.
    int finest() const { return _finest; }
    const StrokeParameters& parameters() const { return _parameters; }
    /// Whether these are what make() would make with them.
    bool madeWith(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid) const;
    /// Whether they were made for that way to the world, within a centimetre.
    bool madeAt(const osg::Matrixd& toWorld) const;
    const osg::Matrixd& toWorld() const { return _toWorld; }

private:
    friend class StrokeMaker;

    TileStrokes(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid);
    ~TileStrokes() override;

    const StrokeParameters _parameters;
    osg::Matrixd _toWorld;
    double _equator = 0.0, _polar = 0.0; ///< radii; 0 on projected terrain
    int _finest = 0;
    osg::ref_ptr<osg::Geometry> _points;
    std::optional<osg::Matrixd>
        _above; ///< the pager's: the way from the tile's parent that they were made with; StrokeMaker's lock
    std::vector<osg::observer_ptr<const osg::Referenced>>
        _users; ///< the makers that they are kept for; StrokeMaker's lock
};

} // namespace osgGeoFX
