// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A: noise; F: transmitters.
#include "Figures.h"

#include <osg/MatrixTransform>
#include <osgGeoFX/mapping/ValueMap.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace osgGeoFX;

namespace figure3
{

namespace
{

/// Metres from each cell to the nearest one of a land cover, by two passes over the grid.
Grid distancesTo(const Grid& cover, LandCover wanted)
{
    Grid distance = cover.blank();
    const float across = static_cast<float>(distance.step().x());
    const float slant = across * 1.4142f;
    const int columns = distance.columns();
    const int rows = distance.rows();
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            distance.at(column, row) = static_cast<int>(cover.at(column, row)) == wanted ? 0.0f : 1e6f;
    const auto lower = [&](int column, int row, int dx, int dy)
    {
        if (column + dx < 0 || column + dx >= columns || row + dy < 0 || row + dy >= rows) return;
        float& here = distance.at(column, row);
        here = std::min(here, distance.at(column + dx, row + dy) + (dx && dy ? slant : across));
    };
    for (const int to : {-1, 1})
        for (int i = 0; i < rows * columns; ++i)
        {
            const int cell = to < 0 ? i : rows * columns - 1 - i;
            const int column = cell % columns;
            const int row = cell / columns;
            lower(column, row, to, 0);
            for (int dx = -1; dx <= 1; ++dx)
                lower(column, row, dx, to);
        }
    return distance;
}

struct Runway
{
    osg::Vec2d from, to;
};

/// dB(A) from a runway: along it, and from the aircraft that come and go in its direction.
double runwayNoise(const Runway& runway, const osg::Vec2d& place)
{
    osg::Vec2d direction = runway.to - runway.from;
    const double length = direction.normalize();
    const osg::Vec2d at = place - runway.from;
    const double along = at * direction;
    const double aside = std::abs(at.x() * direction.y() - at.y() * direction.x());
    const double beyond = std::max({-along, along - length, 0.0});
    // Aircraft are the higher, and spread the more, the farther they are from the runway.
    const double high = beyond * 0.09;
    return 82.0 - 29.0 * std::log10(1.0 + std::hypot(aside, high) / 300.0) - beyond / 900.0;
}

double loudness(double level)
{
    return std::pow(10.0, level / 10.0);
}

osg::ref_ptr<ColorTable> noiseColors()
{
    osg::ref_ptr<ColorTable> table = new ColorTable;
    table->setStops({{45.0, {0.45f, 0.75f, 0.35f, 0.0f}},
                     {50.0, {0.55f, 0.80f, 0.35f, 0.45f}},
                     {55.0, {0.98f, 0.92f, 0.35f, 0.65f}},
                     {60.0, {0.99f, 0.75f, 0.24f, 0.72f}},
                     {65.0, {0.96f, 0.52f, 0.18f, 0.76f}},
                     {70.0, {0.88f, 0.24f, 0.18f, 0.80f}},
                     {75.0, {0.70f, 0.10f, 0.32f, 0.84f}},
                     {85.0, {0.38f, 0.06f, 0.42f, 0.88f}}});
    return table;
}

} // namespace

Shot noiseMap(Island& island)
{
    const osg::Vec2d low = island.place(-158.06, 21.22);
    const osg::Vec2d high = island.place(-157.74, 21.43);
    const Grid freeways = distancesTo(island.landCover(), FREEWAY);
    const Grid roads = distancesTo(island.landCover(), ROAD);
    const Runway runways[] = {
        {island.place(-157.9462, 21.3254), island.place(-157.9055, 21.3254)},
        {island.place(-157.9480, 21.3069), island.place(-157.9087, 21.3069)},
        {island.place(-157.9273, 21.3136), island.place(-157.9057, 21.3301)},
    };
    Grid noise(low, high, 30.0);
    for (int row = 0; row < noise.rows(); ++row)
    {
        for (int column = 0; column < noise.columns(); ++column)
        {
            const osg::Vec2d place = noise.middle(column, row);
            double sum = loudness(34.0);
            sum += loudness(73.0 - 28.0 * std::log10(1.0 + freeways.smooth(place) / 80.0));
            sum += loudness(58.0 - 26.0 * std::log10(1.0 + roads.smooth(place) / 70.0));
            for (const Runway& runway : runways)
                sum += loudness(runwayNoise(runway, place));
            noise.at(column, row) = static_cast<float>(10.0 * std::log10(sum));
        }
    }

    osg::ref_ptr<DataLayer> values = new DataLayer(noise.image());
    values->setKind(DataLayer::VALUE);
    const osg::ref_ptr<ColorTable> colors = noiseColors();
    ValueMap* map = island.keep(new ValueMap(*island.mappings, values, colors, 1));
    noise.lay(map->mapping());
    map->mapping().getTransfer()->setAlpha(ColorTransfer::FROM_SOURCE);
    map->setLines(5.0, 36.0, {0.25f, 0.08f, 0.05f, 0.55f});
    island.tone(1.0, 0.45, 0); // the map below steps back

    LegendStyle style;
    style.title = "Noise by day";
    style.unit = "dB(A)";
    style.width = 360.0;
    style.barHeight = 20.0;
    style.textSize = 17.0;
    style.mostTicks = 9;
    style.font = osgText::readRefFontFile("DejaVuSans.ttf");
    const osg::ref_ptr<osg::MatrixTransform> corner =
        new osg::MatrixTransform(osg::Matrix::translate(24.0, 24.0, 0.0));
    corner->addChild(map->legend(style));
    return {"-157.950,21.232,9000,12,-42", 38.0, {}, corner};
}

namespace
{

struct Transmitter
{
    double longitude, latitude;
    double range;   ///< metres, where it is strongest
    double heading; ///< degrees, where it is strongest
    int lobes;      ///< 0: the same to all sides
    osg::Vec4 color;
};

/// A ring at the edge of the range, and steps of strength within.
osg::ref_ptr<ColorTable> rangeColors(osg::Vec4 color)
{
    const float steps[][2] = {{0.0f, 0.0f},    {0.006f, 0.0f}, {0.010f, 1.0f},  {0.035f, 1.0f},
                              {0.039f, 0.30f}, {0.33f, 0.34f}, {0.335f, 0.50f}, {0.66f, 0.54f},
                              {0.665f, 0.72f}, {1.0f, 0.9f}};
    osg::ref_ptr<ColorTable> table = new ColorTable;
    for (const auto& [value, alpha] : steps)
    {
        color.a() = alpha;
        table->addStop(static_cast<double>(value), color);
    }
    return table;
}

/// Masts stand on the highest ground within 400 metres.
osg::Vec2d highestNear(const Grid& heights, const osg::Vec2d& place)
{
    osg::Vec2d best = place;
    for (double y = -400.0; y <= 400.0; y += 25.0)
        for (double x = -400.0; x <= 400.0; x += 25.0)
            if (heights.smooth(place + osg::Vec2d(x, y)) > heights.smooth(best))
                best = place + osg::Vec2d(x, y);
    return best;
}

/// How strong a transmitter is, 1 at its mast and 0 out of range: lobes of the antenna, and shadows of the hills.
Grid strengthOf(const Island& island, const Transmitter& transmitter)
{
    const osg::Vec2d mast =
        highestNear(island.heights(), island.place(transmitter.longitude, transmitter.latitude));
    const osg::Vec2d reach(transmitter.range, transmitter.range);
    Grid strength(mast - reach, mast + reach, transmitter.range / 256.0);
    const Grid& heights = island.heights();
    const double top = heights.smooth(mast) + 40.0;
    for (int row = 0; row < strength.rows(); ++row)
    {
        for (int column = 0; column < strength.columns(); ++column)
        {
            const osg::Vec2d place = strength.middle(column, row);
            const osg::Vec2d away = place - mast;
            const double distance = away.length();
            const double angle = std::atan2(away.x(), away.y()) - osg::DegreesToRadians(transmitter.heading);
            const double lobe = transmitter.lobes ? 0.68 + 0.32 * std::cos(transmitter.lobes * angle) : 1.0;
            // How far the ground between stands above the line of sight, metres.
            const double ground = heights.smooth(place) + 15.0;
            double blocked = 0.0;
            const int steps = static_cast<int>(distance / 60.0);
            for (int i = 1; i < steps; ++i)
            {
                const double share = static_cast<double>(i) / steps;
                blocked =
                    std::max(blocked, heights.smooth(mast + away * share) - (top + (ground - top) * share));
            }
            const double open = 1.0 - distance / (transmitter.range * lobe);
            strength.at(column, row) = static_cast<float>(std::clamp(open - blocked / 400.0, 0.0, 1.0));
        }
    }
    return strength;
}

} // namespace

Shot transmitters(Island& island)
{
    island.tone(0.62, 0.2, 0);
    const Transmitter all[] = {
        {-157.8095, 21.2600, 4300.0, 330.0, 0, {0.10f, 0.75f, 1.00f, 1.0f}}, // Diamond Head
        {-157.8480, 21.3120, 5400.0, 200.0, 3, {1.00f, 0.25f, 0.55f, 1.0f}}, // Punchbowl
        {-157.8800, 21.3050, 5200.0, 270.0, 2, {1.00f, 0.80f, 0.10f, 1.0f}}, // Sand Island
        {-157.9080, 21.3560, 5600.0, 180.0, 1, {0.30f, 1.00f, 0.35f, 1.0f}}, // Salt Lake
        {-157.8140, 21.3310, 5400.0, 250.0, 2, {0.65f, 0.40f, 1.00f, 1.0f}}, // Tantalus
        {-157.7760, 21.3000, 4800.0, 200.0, 1, {1.00f, 0.50f, 0.15f, 1.0f}}, // Palolo
    };
    int order = 1;
    for (const Transmitter& transmitter : all)
    {
        const Grid strength = strengthOf(island, transmitter);
        // What several reach adds up, and the rings tell whose it is.
        ProjectiveMapping& area = island.show(strength, order++);
        area.setTable(rangeColors(transmitter.color));
        area.getTransfer()->setSource(ColorTransfer::TABLE);
        area.getTransfer()->setEquation(ColorTransfer::SCREEN);
    }
    return {"-157.855,21.196,11200,5,-43", 38.0, {}, nullptr};
}

} // namespace figure3
