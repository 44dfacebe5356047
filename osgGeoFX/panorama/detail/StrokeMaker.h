// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/panorama/detail/StrokeParameters.h>
#include <osgGeoFX/panorama/detail/TileStrokes.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Matrixd>

#include <mutex>

namespace osgGeoFX
{

/** Gives the tiles of a terrain their brush strokes; Section 3.3 of Brown and Samavati (2017).

    As a listener of a TileGuard it makes them on the pager's thread. Tiles that came otherwise, or before the parameters
    changed, get theirs when strokes() is asked for them. They are kept with the tile's geometry (TileStrokes) and go with
    it; a geometry that stands in several places has strokes for each. Scenes with different parameters may share a terrain, any number of
    them: each maker has its own for as long as it lives and keeps its parameters.

    A place has the same strokes in every tile and after every reload, as far as the tiles agree on what covers it; coarser tiles
    have those of coarser levels only. Thread-safe. */
class StrokeMaker : public TileListener
{
public:
    /// `ellipsoid` is null for projected terrain.
    explicit StrokeMaker(const osg::EllipsoidModel* ellipsoid);

    void setParameters(const StrokeParameters& parameters);
    StrokeParameters getParameters() const;
    const osg::EllipsoidModel* getEllipsoid() const { return _ellipsoid.get(); }
    /// Whether strokes for a terrain with that ellipsoid would be the same; null for projected terrain.
    bool isFor(const osg::EllipsoidModel* ellipsoid) const;

    /// Makes the strokes of all geometries at and below a node that have none yet or outdated ones. `toWorld` is the way from the node's parent.
    /// No other thread may use the nodes.
    void furnish(osg::Node& tile, const osg::Matrixd& toWorld = osg::Matrixd());
    /// Below transforms that strokes() has seen above the tiles.
    void tileRead(osg::Node& tile) override;

    /// The strokes of one geometry, made where it has none yet or outdated ones; a mesh of a terrain tile has those of the whole
    /// tile. Null where nothing is to be drawn. `toWorld` is the
    /// way from the geometry's frame. Threads that cull may ask for the same geometry at once.
    osg::ref_ptr<osg::Geometry> strokes(osg::Geometry& terrain, const osg::Matrixd& toWorld) const;

protected:
    ~StrokeMaker() override;

private:
    class Furnisher;

    TileStrokes* known(const osg::Object& keeper, const osg::Matrixd& toWorld,
                       const StrokeParameters& parameters) const;
    void keep(osg::Object& keeper, TileStrokes& strokes) const;
    void learn(const osg::Object& keeper, const osg::Matrixd& toWorld) const;
    void furnishBelow(osg::Node& tile, const osg::Matrixd& above, bool ofPager);

    const osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    mutable std::mutex _mutex; ///< of the parameters
    StrokeParameters _parameters;
    mutable osg::Matrixd _above; ///< the way from a pager's tiles to the world
};

} // namespace osgGeoFX
