// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Island.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace osgGeoFX;

namespace figure3
{

namespace
{

constexpr double originLongitude = -157.862; // Honolulu
constexpr double originLatitude = 21.305;

Scene loaded(const std::string& terrain)
{
    std::string error;
    std::optional<Scene> scene = Scene::load(terrain, error);
    if (!scene) throw std::runtime_error(error);
    if (!scene->reference || !scene->reference->isGeocentric())
        throw std::runtime_error(terrain + ": the figures want Oahu on the globe; build it without --srs.");
    return *scene;
}

} // namespace

Grid::Grid(const osg::Vec2d& low, const osg::Vec2d& step, osg::Image* image)
    : _low(low), _step(step), _image(image), _columns(image->s()), _rows(image->t()),
      _cells(reinterpret_cast<float*>(image->data()))
{
}

Grid::Grid(const osg::Vec2d& low, const osg::Vec2d& high, double cell)
    : Grid(low, {cell, cell},
           zeros(static_cast<int>(std::ceil((high.x() - low.x()) / cell)),
                 static_cast<int>(std::ceil((high.y() - low.y()) / cell))))
{
}

Grid::Grid(const MappingRaster& raster)
    : Grid(raster.low,
           {(raster.high.x() - raster.low.x()) / raster.layer->getImage()->s(),
            (raster.high.y() - raster.low.y()) / raster.layer->getImage()->t()},
           raster.layer->getImage())
{
}

osg::ref_ptr<osg::Image> Grid::zeros(int columns, int rows)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns, rows, 1, GL_RED, GL_FLOAT);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(0));
    return image;
}

Grid Grid::blank() const
{
    return {_low, _step, zeros(_columns, _rows)};
}

int Grid::columnOf(double x) const
{
    return static_cast<int>(std::clamp((x - _low.x()) / _step.x(), 0.0, columns() - 1.0));
}

int Grid::rowOf(double y) const
{
    return static_cast<int>(std::clamp((y - _low.y()) / _step.y(), 0.0, rows() - 1.0));
}

double Grid::smooth(const osg::Vec2d& place) const
{
    const double x = std::clamp((place.x() - _low.x()) / _step.x() - 0.5, 0.0, columns() - 1.001);
    const double y = std::clamp((place.y() - _low.y()) / _step.y() - 0.5, 0.0, rows() - 1.001);
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const double u = x - column;
    const double v = y - row;
    const auto along = [&](int r)
    {
        return static_cast<double>(at(column, r)) * (1.0 - u) + static_cast<double>(at(column + 1, r)) * u;
    };
    return along(row) * (1.0 - v) + along(row + 1) * v;
}

void Grid::lay(ProjectiveMapping& mapping) const
{
    const osg::Vec2d half = (high() - _low) / 2.0;
    mapping.setRectangle(_low + half, half.x(), half.y());
}

Island::Island(const std::string& terrain, const std::string& dataFolder) : scene(loaded(terrain))
{
    mappings->setGeodeticOrigin(osg::DegreesToRadians(originLongitude),
                                osg::DegreesToRadians(originLatitude));
    // A layer over the whole island keeps the rasters' resolution.
    mappings->setPageSide(4096);
    _heights = std::make_unique<Grid>(read(dataFolder + "/elevation.tif", DataLayer::VALUE));
    _landCover = std::make_unique<Grid>(read(dataFolder + "/landcover.tif", DataLayer::CLASS));
}

Grid Island::read(const std::string& file, DataLayer::Kind kind) const
{
    MappingFrame frame;
    frame.origin = mappings->getLocalOrigin();
    MappingRaster::Options options;
    options.kind = kind;
    options.maxSide = 3400; // all cells of the rasters
    std::string error;
    const std::optional<MappingRaster> raster = MappingRaster::read(file, frame, options, error);
    if (!raster) throw std::runtime_error(error);
    return Grid(*raster);
}

osg::Vec2d Island::place(double longitude, double latitude) const
{
    osg::Vec3d world;
    scene.reference->toWorld(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), 0.0, world);
    const osg::Vec3d place = mappings->placeOf(world, scene.effects->ground().ellipsoid);
    return {place.x(), place.y()};
}

osg::Vec3d Island::onGround(const osg::Vec2d& place) const
{
    return {place, _heights->smooth(place)};
}

float Island::relief(int column, int row) const
{
    const Grid& heights = *_heights;
    const int left = std::max(column - 1, 0);
    const int right = std::min(column + 1, heights.columns() - 1);
    const int below = std::max(row - 1, 0);
    const int above = std::min(row + 1, heights.rows() - 1);
    const double across = (right - left) * heights.step().x();
    const double along = (above - below) * heights.step().y();
    const double fallEast = static_cast<double>(heights.at(left, row) - heights.at(right, row));
    const double fallNorth = static_cast<double>(heights.at(column, below) - heights.at(column, above));
    osg::Vec3d normal(fallEast / across, fallNorth / along, 1.0);
    normal.normalize();
    const osg::Vec3d light(-0.5657, 0.5657, 0.6);
    return static_cast<float>(std::max(normal * light, 0.0));
}

ProjectiveMapping& Island::show(const Grid& values, int order)
{
    osg::ref_ptr<DataLayer> layer = new DataLayer(values.image());
    layer->setKind(DataLayer::VALUE);
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setLayer(layer);
    mapping->setOrder(order);
    values.lay(*mapping);
    mappings->addMapping(mapping);
    return *mapping;
}

ProjectiveMapping& Island::tone(double brightness, double saturation, int order)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle({0.0, 0.0}, 3e5, 3e5);
    mapping->setOrder(order);
    mapping->getTransfer()->setSource(ColorTransfer::SCENE);
    mapping->getTransfer()->setBrightness(brightness);
    mapping->getTransfer()->setSaturation(saturation);
    mappings->addMapping(mapping);
    return *mapping;
}

} // namespace figure3
