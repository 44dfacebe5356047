// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/DataLayer.h>
#include <osgGeoFX/mapping/LayerSource.h>

#include <osg/Image>
#include <osg/Referenced>
#include <osg/Vec2d>

#include <optional>
#include <string>

namespace osgGeoFX
{

/** A raster that is read in parts, in the frame of mappings: where a PagedRaster has its pixels from. `geodata/TiledRaster`
    makes one of any raster that GDAL opens; a program may have its own, such as one that computes its pixels.
    @ingroup mapping */
class OSGGEOFX_EXPORT RasterTiles : public osg::Referenced
{
public:
    RasterTiles();

    /// The rectangle that the raster covers, metres in the frame.
    virtual osg::Vec2d low() const = 0;
    virtual osg::Vec2d high() const = 0;
    /// The side of the raster's own pixels, about, metres.
    virtual double texel() const = 0;
    virtual DataLayer::Kind kind() const = 0;
    /// The pixels of a rectangle of the frame, metres, in rows from below: RGBA bytes for colors, else floats in one channel, with
    /// NaN where there is none. Beyond the raster there is nothing: transparent, or NaN. Takes time with the number of pixels
    /// that are asked for, not with the rectangle's size. Null, with a sentence in `error`, if they cannot be read. Several
    /// threads call it at once.
    virtual osg::ref_ptr<osg::Image> read(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                          std::string& error) = 0;
    /// The same for a picture whose texels will be seen so many times larger than as a rule, for the memory does not hold finer ones: a raster that draws itself may
    /// divide lengths in pixels by that. By default they are those of read().
    virtual osg::ref_ptr<osg::Image> readCoarser(const osg::Vec2d& from, const osg::Vec2d& to, int columns,
                                                 int rows, double coarseness, std::string& error);
    /// Whether readCoarser() gives something else than read(), so that tiles are read again when this changes. Default: false.
    virtual bool hasLengthsInPixels() const { return false; }
    /// The file that it is read from, for OSG's files; nothing for one that no file tells, which is the default.
    virtual std::optional<LayerSource> source() const { return std::nullopt; }

protected:
    ~RasterTiles() override;
};

} // namespace osgGeoFX
