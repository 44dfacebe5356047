// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/VectorShapes.h>

#include <osg/Image>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Draws shapes as pixels, with smooth edges, whatever the magnification.
class ShapePainter
{
public:
    /// A tile's texel is a pixel of the screen where the tile is seen the nearest, or down to half of one: lengths in pixels are those in the middle.
    static constexpr double texelsOfPixel = 1.41;

    /// The rectangle of the plane that the picture shows, metres. `coarseness`: RasterTiles::readCoarser(). Throws BuildError where there is no memory.
    ShapePainter(const osg::Vec2d& low, const osg::Vec2d& high, int columns, int rows,
                 double coarseness = 1.0);
    ~ShapePainter();
    ShapePainter(const ShapePainter&) = delete;
    ShapePainter& operator=(const ShapePainter&) = delete;

    /// The shape's places are metres.
    void draw(const VectorShape& shape, const ShapePaint& paint);
    /// RGBA bytes in rows from below. Transparent texels have their neighbours' colors, for a filter mixes them.
    osg::ref_ptr<osg::Image> finish();

    /// How far a paint reaches beyond its shape where a texel is so large, metres.
    static double reachOf(const ShapePaint& paint, double texel);

    /// A symbol as a picture whose middle lies at the place. `side`: of the square picture, in the symbol's pixels or metres. Throws BuildError where its
    /// picture cannot be used.
    static osg::ref_ptr<osg::Image> symbol(const SymbolPaint& paint, const std::string& file, bool anyFormat,
                                           double& side);

private:
    class Work;
    std::unique_ptr<Work> _work;
};

} // namespace osgGeoFX
