// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/viewer/Scene.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace figure3
{

/// Numbers on a regular grid in the mappings' frame; row 0 is the southernmost. A copy shares them.
class Grid
{
public:
    /// Of this cell size, metres, from `low` to `high` at least; all are 0.
    Grid(const osg::Vec2d& low, const osg::Vec2d& high, double cell);
    explicit Grid(const osgGeoFX::MappingRaster& raster);
    /// One with the same cells, all 0.
    Grid blank() const;

    int columns() const { return _columns; }
    int rows() const { return _rows; }
    const osg::Vec2d& low() const { return _low; }
    osg::Vec2d high() const { return _low + osg::Vec2d(columns() * _step.x(), rows() * _step.y()); }
    /// Width and height of a cell, metres.
    const osg::Vec2d& step() const { return _step; }
    osg::Vec2d middle(int column, int row) const
    {
        return _low + osg::Vec2d((column + 0.5) * _step.x(), (row + 0.5) * _step.y());
    }
    float& at(int column, int row) const
    {
        return _cells[static_cast<std::ptrdiff_t>(row) * _columns + column];
    }
    /// The column and row of a place; of the nearest cell outside.
    int columnOf(double x) const;
    int rowOf(double y) const;
    float nearest(const osg::Vec2d& place) const { return at(columnOf(place.x()), rowOf(place.y())); }
    double smooth(const osg::Vec2d& place) const;

    osg::Image* image() const { return _image.get(); }
    /// Gives a mapping the grid's rectangle.
    void lay(osgGeoFX::ProjectiveMapping& mapping) const;

private:
    Grid(const osg::Vec2d& low, const osg::Vec2d& step, osg::Image* image);
    static osg::ref_ptr<osg::Image> zeros(int columns, int rows);

    osg::Vec2d _low, _step;
    osg::ref_ptr<osg::Image> _image;
    int _columns, _rows;
    float* _cells;
};

/// Values of data/oahu/landcover.csv.
enum LandCover
{
    SEA = 1,
    LAKE = 2,
    TOWN = 15,
    URBAN = 16,
    INDUSTRIAL = 17,
    PAVED = 18,
    ROAD = 19,
    FREEWAY = 20
};

/** Oahu on the globe, with its rasters in the frame of the mappings about Honolulu. */
class Island
{
public:
    /// Throws std::runtime_error with a sentence for people.
    Island(const std::string& terrain, const std::string& dataFolder);

    osgGeoFX::Scene scene;
    osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;

    /// Metres above the sea.
    const Grid& heights() const { return *_heights; }
    /// Values of LandCover.
    const Grid& landCover() const { return *_landCover; }

    /// Of longitude and latitude, degrees.
    osg::Vec2d place(double longitude, double latitude) const;
    /// With the height of the ground.
    osg::Vec3d onGround(const osg::Vec2d& place) const;
    /// Where the land catches light from the north-west, 0…1; 0.6 on flat ground. For each cell of the heights.
    float relief(int column, int row) const;

    /// A mapping of a grid's values, added.
    osgGeoFX::ProjectiveMapping& show(const Grid& values, int order);
    /// A mapping with the scene's own colors, over all that is seen, added.
    osgGeoFX::ProjectiveMapping& tone(double brightness, double saturation, int order);
    /// Keeps what a figure needs while it is drawn.
    template<class T>
    T* keep(T* object)
    {
        _kept.emplace_back(object);
        return object;
    }

private:
    Grid read(const std::string& file, osgGeoFX::DataLayer::Kind kind) const;

    std::unique_ptr<Grid> _heights, _landCover;
    std::vector<osg::ref_ptr<osg::Referenced>> _kept;
};

} // namespace figure3
