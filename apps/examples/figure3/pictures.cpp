// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// C: textures by masks; E: symbols on a generalised map.
#include "Figures.h"
#include "Marks.h"

#include <osgGeoFX/mapping/MaskPainter.h>
#include <osgGeoFX/mapping/SymbolMapping.h>

#include <algorithm>
#include <array>
#include <vector>

using namespace osgGeoFX;

namespace figure3
{

namespace
{

using Color = std::array<float, 3>; ///< 0…255

/// A picture for each cell of the heights, darker where the land turns from the light.
template<class ColorOf>
osg::ref_ptr<DataLayer> shaded(const Island& island, double contrast, ColorOf colorOf)
{
    const Grid& heights = island.heights();
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(heights.columns(), heights.rows(), 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    for (int row = 0; row < heights.rows(); ++row)
    {
        unsigned char* texel = image->data(0, static_cast<unsigned int>(row));
        for (int column = 0; column < heights.columns(); ++column)
        {
            const Color color = colorOf(column, row);
            const double light = 1.0 + contrast * (static_cast<double>(island.relief(column, row)) - 0.6);
            for (const float part : color)
                *texel++ =
                    static_cast<unsigned char>(std::clamp(static_cast<double>(part) * light, 0.0, 255.0));
        }
    }
    return new DataLayer(image);
}

ProjectiveMapping* addPicture(Island& island, DataLayer* layer, int order)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setLayer(layer);
    mapping->setOrder(order);
    island.heights().lay(*mapping);
    island.mappings->addMapping(mapping);
    return mapping;
}

struct Stroke
{
    double radius; ///< metres
    std::vector<osg::Vec2d> places;
};

/// A mask as a person paints it, over the same rectangle as the mapping.
void paint(Island& island, ProjectiveMapping& mapping, const std::vector<Stroke>& strokes)
{
    MaskPainter* painter = island.keep(new MaskPainter(mapping, 2048, 2048));
    for (const Stroke& stroke : strokes)
    {
        MaskPainter::Brush brush;
        brush.radius = stroke.radius;
        brush.hardness = 0.62;
        painter->setBrush(brush);
        painter->begin(stroke.places.front());
        for (const osg::Vec2d& place : stroke.places)
            painter->moveTo(place);
        painter->end();
    }
}

bool isWater(float cover)
{
    return cover >= static_cast<float>(SEA) && cover <= static_cast<float>(LAKE);
}

} // namespace

Shot textures(Island& island)
{
    const Grid& heights = island.heights();
    const Grid& cover = island.landCover();
    // Everywhere: a relief without colors. Within the masks: heights in colors, and the terrain's own land cover.
    const auto greys = [&](int column, int row)
    {
        return isWater(cover.nearest(heights.middle(column, row))) ? Color{168.0f, 182.0f, 196.0f}
                                                                   : Color{190.0f, 188.0f, 183.0f};
    };
    ProjectiveMapping* grey = addPicture(island, shaded(island, 1.15, greys), 0);

    const osg::ref_ptr<ColorTable> tints = new ColorTable;
    tints->setStops({{0.0, {0.52f, 0.74f, 0.50f, 1.0f}},
                     {60.0, {0.76f, 0.84f, 0.52f, 1.0f}},
                     {180.0, {0.96f, 0.90f, 0.58f, 1.0f}},
                     {380.0, {0.93f, 0.70f, 0.40f, 1.0f}},
                     {620.0, {0.78f, 0.44f, 0.28f, 1.0f}},
                     {900.0, {0.60f, 0.30f, 0.34f, 1.0f}}});
    const auto byHeight = [&](int column, int row)
    {
        if (isWater(cover.nearest(heights.middle(column, row)))) return Color{132.0f, 178.0f, 214.0f};
        const osg::Vec4 color = tints->at(static_cast<double>(heights.at(column, row))) * 255.0f;
        return Color{color.r(), color.g(), color.b()};
    };
    ProjectiveMapping* tinted = addPicture(island, shaded(island, 0.85, byHeight), 1);
    paint(island, *tinted,
          {{3200.0,
            {island.place(-157.862, 21.392), island.place(-157.822, 21.362), island.place(-157.785, 21.335)}},
           {2600.0, {island.place(-157.840, 21.352), island.place(-157.800, 21.318)}}});

    // The terrain's own colors come back where the relief is taken away.
    MaskPainter* painter = island.keep(new MaskPainter(*grey, 2048, 2048));
    painter->fill(1.0);
    const std::vector<Stroke> taken = {
        {2300.0,
         {island.place(-157.882, 21.318), island.place(-157.852, 21.300), island.place(-157.826, 21.279)}},
        {1900.0, {island.place(-157.826, 21.279), island.place(-157.806, 21.262)}}};
    for (const Stroke& stroke : taken)
    {
        painter->setBrush({stroke.radius, 0.62, 1.0, true});
        painter->begin(stroke.places.front());
        for (const osg::Vec2d& place : stroke.places)
            painter->moveTo(place);
        painter->end();
    }
    return {"-157.868,21.217,10500,18,-44", 38.0, {}, nullptr};
}

namespace
{

/// The share of cells of some kind in a square around each cell, by running sums along rows and then columns.
template<class Is>
Grid shareOf(const Grid& cover, int reach, Is is)
{
    Grid share = cover.blank();
    const Grid along = cover.blank();
    const int columns = cover.columns();
    const int rows = cover.rows();
    const float one = 1.0f / static_cast<float>(2 * reach + 1);
    for (int row = 0; row < rows; ++row)
    {
        float sum = 0.0f;
        for (int column = -reach; column < columns; ++column)
        {
            if (column + reach < columns && is(cover.at(column + reach, row))) sum += one;
            if (column - reach - 1 >= 0 && is(cover.at(column - reach - 1, row))) sum -= one;
            if (column >= 0) along.at(column, row) = sum;
        }
    }
    std::vector<float> sums(static_cast<std::size_t>(columns), 0.0f);
    for (int row = -reach; row < rows; ++row)
    {
        for (int column = 0; column < columns; ++column)
        {
            float& sum = sums[static_cast<std::size_t>(column)];
            if (row + reach < rows) sum += one * along.at(column, row + reach);
            if (row - reach - 1 >= 0) sum -= one * along.at(column, row - reach - 1);
            if (row >= 0) share.at(column, row) = sum;
        }
    }
    return share;
}

/// Water, towns, freeways and the rest, each place as most of its surroundings are.
void generalise(Island& island)
{
    const Grid& cover = island.landCover();
    const Grid water = shareOf(cover, 3, isWater);
    const Grid built = shareOf(cover, 7, [](float c) { return c >= TOWN && c <= FREEWAY; });
    const Grid freeway = shareOf(cover, 2, [](float c) { return static_cast<int>(c) == FREEWAY; });
    const auto colorOf = [&](int column, int row)
    {
        const osg::Vec2d place = island.heights().middle(column, row);
        // Over the width of a cell the one goes over into the other.
        const auto edge = [&](const Grid& share, double half)
        {
            return static_cast<float>(std::clamp((share.smooth(place) - half) * 6.0 + 0.5, 0.0, 1.0));
        };
        Color color{188.0f, 214.0f, 152.0f};
        const auto paintOver = [&](const Color& other, float strength)
        {
            for (std::size_t i = 0; i < color.size(); ++i)
                color[i] += (other[i] - color[i]) * strength;
        };
        paintOver({244.0f, 230.0f, 206.0f}, edge(built, 0.5));
        paintOver({232.0f, 164.0f, 72.0f}, edge(freeway, 0.17));
        paintOver({158.0f, 200.0f, 228.0f}, edge(water, 0.5));
        return color;
    };
    addPicture(island, shaded(island, 0.6, colorOf), 0);
}

} // namespace

Shot symbols(Island& island)
{
    generalise(island);
    SymbolMapping* symbols = island.keep(new SymbolMapping(*island.mappings));
    const auto addLook = [&](const osg::ref_ptr<osg::Image>& image, int order)
    {
        SymbolMapping::Look look;
        look.levels = {{new DataLayer(image), 90000.0}};
        look.width = 6000.0;
        look.pixels = 52.0;
        look.stretch = 1.25;
        look.turned = true;
        look.order = order;
        return *symbols->addLook(look);
    };
    struct Sign
    {
        Glyph glyph;
        osg::Vec4 color;
        std::vector<osg::Vec2d> places;
    };
    const Sign signs[] = {
        {planeGlyph, {0.20f, 0.33f, 0.62f, 1.0f}, {{-157.918, 21.320}, {-158.071, 21.314}}},
        {peakGlyph,
         {0.42f, 0.29f, 0.18f, 1.0f},
         {{-157.806, 21.2620}, {-157.848, 21.3125}, {-157.8140, 21.3310}}},
        {anchorGlyph,
         {0.05f, 0.45f, 0.55f, 1.0f},
         {{-157.868, 21.3085}, {-157.955, 21.352}, {-157.842, 21.284}, {-157.893, 21.324}}},
        {sunGlyph,
         {0.93f, 0.58f, 0.10f, 1.0f},
         {{-157.8270, 21.2750}, {-157.850, 21.290}, {-157.700, 21.273}, {-157.875, 21.300}}},
        {crossGlyph,
         {0.80f, 0.13f, 0.17f, 1.0f},
         {{-157.8545, 21.3075}, {-157.888, 21.342}, {-157.818, 21.289}, {-157.866, 21.328}}},
        {flagGlyph,
         {0.20f, 0.52f, 0.24f, 1.0f},
         {{-157.817, 21.279}, {-157.905, 21.352}, {-157.772, 21.283}}},
    };
    int order = 1;
    for (const Sign& sign : signs)
    {
        const int number = addLook(makeSign(sign.glyph, sign.color), order++);
        for (const osg::Vec2d& place : sign.places)
            symbols->add(number, island.onGround(island.place(place.x(), place.y())));
    }
    return {"-157.905,21.262,7200,24,-42", 40.0, {"birdsEyeView focusLine=0.42 horizonLine=0.90"}, nullptr};
}

} // namespace figure3
