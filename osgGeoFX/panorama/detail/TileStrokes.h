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

/** The brush strokes of a geometry, as one of its user objects. Those of a terrain tile belong to its first mesh. They are
    points that shaders/stages/panorama.strokes.* draw. Immutable once made.

    The points' arrays are in the frame of the tile's geometry:
    - Vertices (vec3) are the places of strokes.
    - Normals (3 shorts, normalised) are the ground's.
    - Texture coordinates 0 (4 shorts) are the seed, 0…32767; the level, in halves; the kind, 0 tree, 1 cliff, 2 house,
      3 road, 4 river; and the threshold, 0…32767. Roads and rivers have another number in place of the threshold: their
      finest level in the tile, in halves.
    - Texture coordinates 1 (3 shorts) exist if there are cliffs, roads or rivers. They are the direction on the ground,
      downhill or along the line.
    - Texture coordinates 2 (2 shorts): of a house how much of a city's middle it is, of a cliff the cover's share of bare ground, 0…32767, else 0; and the distance from the nearest shore in whole metres, at most 32767.

    In copies and files it is an empty string. These get strokes of their own when they are drawn. */
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

    /// Makes the strokes of a geometry from a maker's parameters, of its mesh and its textures of cover and normals.
    /// `toWorld` is the matrix from the geometry's frame. `ellipsoid` is null for projected terrain. Any thread may
    /// call it, while the geometry does not change.
    static osg::ref_ptr<TileStrokes> make(const osg::Geometry& terrain, const osg::Matrixd& toWorld,
                                          const StrokeParameters& parameters,
                                          const osg::EllipsoidModel* ellipsoid);

    /// Null if there are none.
    osg::Geometry* points() const { return _points.get(); }
    /// The finest level of strokes of the tile, in halves.
    int finest() const { return _finest; }
    const StrokeParameters& parameters() const { return _parameters; }
    /// Whether make() would make these with such parameters.
    bool madeWith(const StrokeParameters& parameters, const osg::EllipsoidModel* ellipsoid) const;
    /// Whether they were made for this matrix to the world, within a centimetre.
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
        _above; ///< the pager's: the matrix from the tile's parent that they were made with; under StrokeMaker's lock
    std::vector<osg::observer_ptr<const osg::Referenced>>
        _users; ///< the makers that they are kept for; under StrokeMaker's lock
};

} // namespace osgGeoFX
