// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/UnitSources.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

// Kernels reach over so many steps of the lattice and of the raster, whichever are wider. A B-spline has two, and GDAL
// reads four more.
constexpr double KERNEL_STEPS = 8.0;
// A curved footprint may bulge by this share of its width between the points that were looked at.
constexpr double BULGE = 0.002;

struct Window
{
    double west, south, east, north, stepX, stepY;
};

/// A unit's posts and texels, with an apron.
Window windowOf(const BuildPlan& plan, const Unit& unit)
{
    const Lattice lattice = plan.postsWithApron(unit);
    return {lattice.x0,
            lattice.y0,
            lattice.x0 + lattice.dx * (lattice.columns - 1),
            lattice.y0 + lattice.dy * (lattice.rows - 1),
            lattice.dx,
            lattice.dy};
}

bool touches(const BuildPlan& plan, const Window& window, double west, double south, double east,
             double north, double stepX, double stepY)
{
    const double x = KERNEL_STEPS * (window.stepX + stepX) + BULGE * (east - west),
                 y = KERNEL_STEPS * (window.stepY + stepY) + BULGE * (north - south);
    if (window.north < south - y || window.south > north + y) return false;
    for (const double turn : {-720.0, -360.0, 0.0, 360.0, 720.0})
        if ((turn == 0.0 || plan.scheme.crs.geographic) && window.west + turn <= east + x &&
            window.east + turn >= west - x)
            return true;
    return false;
}

bool touches(const BuildPlan& plan, const Window& window, const Footprint& print)
{
    // Next to a pole a raster of another projection may reach anywhere.
    if (print.wholeCircle)
        return touches(plan, window, print.west - 360.0, print.south, print.east + 360.0, print.north,
                       print.stepX, print.stepY);
    return touches(plan, window, print.west, print.south, print.east, print.north, print.stepX, print.stepY);
}

} // namespace

Digest heightsKey(const BuildPlan& plan, const Unit& unit)
{
    const Window window = windowOf(plan, unit);
    ContentHash hash;
    hash.add(unit.root.level).add(unit.depth);
    for (int y = 0; y < unit.span(); ++y)
        for (int x = 0; x < unit.span(); ++x)
            hash.add(plan.isBesideDenser(
                {unit.latticeLevel(), unit.root.x * unit.span() + x, unit.root.y * unit.span() + y}));
    if (plan.voids)
        if (const auto filled = plan.voids->digest(plan.postsWithApron(unit))) hash.add(*filled);
    for (std::size_t i = 0; i < plan.layers.size(); ++i)
    {
        const BuildPlan::Layer& layer = plan.layers[i];
        // Where a layer ends and blends follows from all its files.
        const bool blends = i > 0;
        if (blends && !touches(plan, window, layer.west, layer.south, layer.east, layer.north,
                               std::max(layer.stepX, layer.blendX), std::max(layer.stepY, layer.blendY)))
            continue;
        hash.add(std::string(blends ? "blended" : "layer"));
        if (blends)
            for (const double each : {layer.west, layer.south, layer.east, layer.north, layer.stepX,
                                      layer.stepY, layer.blendX, layer.blendY})
                hash.add(each);
        for (std::size_t file = layer.first; file < layer.last; ++file)
            if (blends || touches(plan, window, plan.demSources[file].print))
                hash.add(plan.demSources[file].identity);
    }
    return hash.digest();
}

Digest surfaceSources(const BuildPlan& plan, const Unit& unit)
{
    const Window window = windowOf(plan, unit);
    ContentHash hash;
    hash.add(plan.scheme.textureIntervals(unit.latticeLevel()));
    const auto add = [&](const BuildPlan::Source& source)
    {
        if (touches(plan, window, source.print)) hash.add(source.identity);
    };
    for (const BuildPlan::Source& source : plan.imagerySources)
        add(source);
    hash.add(std::string("classes"));
    if (plan.landCoverSource)
        add(*plan.landCoverSource);
    else
        hash.add(plan.whole().minHeight).add(plan.whole().maxHeight);
    hash.add(std::string("trees"));
    if (plan.treeCoverSource) add(*plan.treeCoverSource);
    return hash.digest();
}

} // namespace osgGeoFX
