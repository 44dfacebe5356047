// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/panorama/detail/StrokeParameters.h>
#include <osgGeoFX/panorama/detail/TileStrokes.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/observer_ptr>

#include <cstddef>
#include <mutex>
#include <vector>

namespace osgGeoFX
{

/** Gives the tiles of a terrain their brush strokes; Section 3.3 of Brown and Samavati (2017).

    As a listener of a TileGuard it makes them on the pager's thread. Other tiles, and those from before a change of
    the parameters, get theirs when strokes() is called. The tile's geometry keeps them (TileStrokes), and they go
    with it. A geometry in several places has strokes for each. Any number of scenes with different parameters may
    share a terrain. The strokes of a maker stay while it lives and keeps its parameters, and go when no maker wants them.

    A place has the same strokes in every tile and after every reload, as far as the tiles agree on its cover. Coarser
    tiles have those of coarser levels only. Thread-safe. */
class StrokeMaker : public TileListener
{
public:
    /// `ellipsoid` is null for projected terrain.
    explicit StrokeMaker(const osg::EllipsoidModel* ellipsoid);

    void setParameters(const StrokeParameters& parameters);
    StrokeParameters getParameters() const;
    const osg::EllipsoidModel* getEllipsoid() const { return _ellipsoid.get(); }
    /// Whether strokes for a terrain with this ellipsoid would be the same; null for projected terrain.
    bool isFor(const osg::EllipsoidModel* ellipsoid) const;

    /// Makes strokes for all geometries at and below a node whose strokes are missing or outdated. `toWorld` is the
    /// matrix from the node's parent. No other thread may use the nodes.
    void furnish(osg::Node& tile, const osg::Matrixd& toWorld = osg::Matrixd());
    /// Makes the strokes of a tile for its place below the transforms that strokes() has seen above such tiles.
    void tileRead(osg::Node& tile) override;

    /// The strokes of one geometry. Missing or outdated ones are made. A mesh of a terrain tile has those of the
    /// whole tile. Null if there is nothing to draw. `toWorld` is the matrix from the geometry's frame. Several cull
    /// threads may ask for one geometry at once.
    osg::ref_ptr<osg::Geometry> strokes(osg::Geometry& terrain, const osg::Matrixd& toWorld) const;

protected:
    ~StrokeMaker() override;

private:
    class Furnisher;

    TileStrokes* known(osg::Object& keeper, const osg::Matrixd& toWorld,
                       const StrokeParameters& parameters) const;
    template<typename IsFormer>
    void dropUnwanted(osg::Object& keeper, const IsFormer& isFormer) const;
    void keep(osg::Object& keeper, TileStrokes& strokes) const;
    void take(osg::Object& keeper, TileStrokes& strokes) const;
    void learn(const osg::Object& keeper, const osg::Matrixd& toWorld) const;
    void furnishBelow(osg::Node& tile, const osg::Matrixd& above, bool ofPager);

    const osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    mutable std::mutex _mutex; ///< for the parameters
    StrokeParameters _parameters;
    mutable osg::Matrixd _above; ///< the matrix from a pager's tiles to the world
    /// What keeps strokes of this maker, or did so; under the lock of the user data.
    mutable std::vector<osg::observer_ptr<osg::Object>> _keepers;
    mutable std::size_t _tidyAt = 64; ///< the number of keepers at which those that are gone are forgotten
};

} // namespace osgGeoFX
