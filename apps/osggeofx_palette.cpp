// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_palette: palettes of panorama maps, ready ones and those of paintings.
#include "process/CommandLine.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/PalettePoints.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>

#include <CLI/CLI.hpp>
#include <osg/Notify>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>

namespace fs = std::filesystem;
using osgGeoFX::ColorVision;
using osgGeoFX::PalettePoint;
using osgGeoFX::PaletteSample;
namespace glsl = osgGeoFX::glsl;

namespace
{

constexpr int badInput = 2;
/// Pixels of a written palette for each of its rows, so that one can draw in it.
constexpr int bandHeight = 32;
/// Fewer points of a class say nothing of how it changes with the light.
constexpr std::size_t leastPoints = 2;
/// What cartographers take for colors that are told apart at a glance, in CIEDE2000.
constexpr double goodContrast = 10.0;
constexpr const char* classNames[] = {"field",        "hill",  "cliff", "snow",
                                      "forest floor", "trees", "town",  "bare ground"};

/// A sentence for the person at the terminal.
struct Failure : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

struct Arguments
{
    std::string painting, lightMap, classMap, points, ready, output;
    int around = 2;
    bool hillshade = false;
};

void addOptions(CLI::App& app, Arguments& arguments)
{
    CLI::Option* painting = app.add_option("painting", arguments.painting,
                                           "The painting; or, alone, a palette whose contrast is wanted")
                                ->type_name("IMAGE");
    CLI::Option* lightMap =
        app.add_option("--light", arguments.lightMap,
                       "Its light map: black is turned away from the light, white faces it")
            ->type_name("IMAGE")
            ->needs(painting);
    app.add_flag("--hillshade", arguments.hillshade,
                 "The light map is a hillshade, such as gdaldem's: black is grazed by the light")
        ->needs(lightMap);
    CLI::Option* classes =
        app.add_option("--classes", arguments.classMap,
                       "An image of the same view whose red, 0 to 7 of 255, is the class of each pixel; "
                       "other values count for none")
            ->type_name("IMAGE")
            ->needs(lightMap);
    app.add_option(
           "--points", arguments.points,
           "Sample points in place of --classes: class,x,y in each line, in pixels from the upper left "
           "corner of the painting; and lightX,lightY, where the light map shows the same place, or light, "
           "-1 to 1")
        ->type_name("CSV")
        ->needs(painting)
        ->excludes(classes);
    app.add_option("--around", arguments.around,
                   "A point's color is the mean of the pixels so far around it (2)")
        ->check(CLI::Range(0, 100))
        ->type_name("PIXELS");
    app.add_option("--ready", arguments.ready, "A ready palette in place of a painting")
        ->check(CLI::IsMember({"spring", "summer", "autumn", "winter", "colorblind"}))
        ->excludes(painting);
    app.add_option("-o,--output", arguments.output,
                   "The palette, as an image to draw in, and for osggeofx_panorama --palette and scene files")
        ->type_name("FILE.png");
    app.footer(
        "Classes are field, hill, cliff, snow, forest, trees, town and bare. Those without samples keep the "
        "kit's own colors. The program says how far the classes are apart for readers who see all colors, "
        "and for color-blind ones. Exit code: 0; 2 if something is at fault, with a sentence.\n\n"
        "Examples:\n"
        "  osggeofx_palette yellowstone.jpg --light light.png --points points.csv -o yellowstone.png\n"
        "  osggeofx_palette --ready colorblind -o colorblind.png\n"
        "  osggeofx_palette my-palette.png");
}

osg::ref_ptr<osg::Image> readImage(const std::string& what, const std::string& file)
{
    if (!fs::exists(file)) throw Failure(file + ": does not exist; give " + what + ".");
    osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(file);
    if (!image || !image->valid() || image->isCompressed())
        throw Failure(file + ": is not a picture that OpenSceneGraph reads; save " + what + " as PNG.");
    return image;
}

/// A pixel that is counted from the upper left corner, red, green and blue.
osg::Vec3d pixel(const osg::Image& image, int x, int y)
{
    const osg::Vec4 color =
        image.getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(image.t() - 1 - y));
    return {static_cast<double>(color.r()), static_cast<double>(color.g()), static_cast<double>(color.b())};
}

/// The mean around a place.
osg::Vec3d colorAt(const osg::Image& image, const osg::Vec2d& place, int around)
{
    const int x = static_cast<int>(std::floor(place.x())), y = static_cast<int>(std::floor(place.y()));
    osg::Vec3d sum;
    int count = 0;
    for (int row = std::max(y - around, 0); row <= std::min(y + around, image.t() - 1); ++row)
    {
        for (int column = std::max(x - around, 0); column <= std::min(x + around, image.s() - 1); ++column)
        {
            sum += pixel(image, column, row);
            ++count;
        }
    }
    return sum / count;
}

void checkInside(const osg::Image& image, const osg::Vec2d& place, const std::string& what,
                 const std::string& points)
{
    if (place.x() >= 0.0 && place.y() >= 0.0 && place.x() < image.s() && place.y() < image.t()) return;
    char text[160];
    std::snprintf(text, sizeof(text), ": the point %.6g, %.6g lies outside of the %s of %d x %d pixels; ",
                  place.x(), place.y(), what.c_str(), image.s(), image.t());
    throw Failure(points + text + "count from its upper left corner.");
}

/// The light −1…1 at a point.
double lightOf(const PalettePoint& point, const osg::Image& painting, const osg::Image* lightMap,
               const Arguments& arguments)
{
    if (point.light) return *point.light;
    if (!lightMap)
        throw Failure(arguments.points +
                      ": not all points have a light; give the column light, or a light map by --light.");
    const osg::Vec2d place = point.lightPlace.value_or(osg::Vec2d(
        point.place.x() * lightMap->s() / painting.s(), point.place.y() * lightMap->t() / painting.t()));
    checkInside(*lightMap, place, "light map", arguments.points);
    const double seen = colorAt(*lightMap, place, arguments.around).x();
    return arguments.hillshade ? seen : 2.0 * seen - 1.0;
}

std::vector<PaletteSample> samplesAt(const osg::Image& painting, const osg::Image* lightMap,
                                     const Arguments& arguments)
{
    std::vector<PaletteSample> samples;
    for (const PalettePoint& point : osgGeoFX::readPalettePoints(arguments.points))
    {
        checkInside(painting, point.place, "painting", arguments.points);
        samples.push_back({point.row, lightOf(point, painting, lightMap, arguments),
                           colorAt(painting, point.place, arguments.around)});
    }
    return samples;
}

/// A hillshade as a light map: 0…1 becomes 0.5…1.
osg::ref_ptr<osg::Image> lightMapOf(const Arguments& arguments)
{
    osg::ref_ptr<osg::Image> image = readImage("a light map", arguments.lightMap);
    if (!arguments.hillshade) return image;
    osg::ref_ptr<osg::Image> map = new osg::Image;
    map->allocateImage(image->s(), image->t(), 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (unsigned int row = 0; row < static_cast<unsigned int>(image->t()); ++row)
        for (unsigned int column = 0; column < static_cast<unsigned int>(image->s()); ++column)
        {
            osg::Vec4 color = image->getColor(column, row);
            color.r() = 0.5f + 0.5f * color.r();
            map->setColor(color, column, row);
        }
    return map;
}

osg::ref_ptr<osg::Image> paletteOfPainting(const Arguments& arguments)
{
    const osg::ref_ptr<osg::Image> painting = readImage("a painting", arguments.painting);
    std::string error;
    osg::ref_ptr<osg::Image> palette;
    if (!arguments.points.empty())
    {
        osg::ref_ptr<osg::Image> lightMap;
        if (!arguments.lightMap.empty()) lightMap = readImage("a light map", arguments.lightMap);
        const std::vector<PaletteSample> samples = samplesAt(*painting, lightMap, arguments);
        palette = osgGeoFX::paletteFromSamples(samples, leastPoints, error);
        std::array<std::size_t, std::size(classNames)> counts{};
        for (const PaletteSample& sample : samples)
            ++counts[static_cast<std::size_t>(sample.row)];
        for (std::size_t row = 0; row < counts.size(); ++row)
            std::printf("%s: %zu points%s.\n", classNames[row], counts[row],
                        counts[row] < leastPoints ? ", too few; it keeps the kit's own colors" : "");
    }
    else
        palette = osgGeoFX::paletteFromPainting(*painting, *lightMapOf(arguments),
                                                *readImage("a map of classes", arguments.classMap), error);
    if (!palette) throw Failure(arguments.painting + ": " + error);
    return palette;
}

osg::ref_ptr<osg::Image> paletteOf(const Arguments& arguments)
{
    static const std::map<std::string, double> seasons = {
        {"winter", 0.0}, {"spring", 0.25}, {"summer", 0.5}, {"autumn", 0.75}};
    if (arguments.ready == "colorblind") return osgGeoFX::makeColorBlindPalette();
    if (!arguments.ready.empty()) return osgGeoFX::makePalette(seasons.at(arguments.ready));
    if (!arguments.points.empty() || !arguments.classMap.empty()) return paletteOfPainting(arguments);
    if (!arguments.lightMap.empty())
        throw Failure("Nothing says what " + arguments.painting +
                      " shows where; give --points, or --classes.");
    if (arguments.painting.empty())
        throw Failure("No painting is given; give one with --light and --points, or --ready.");
    std::string error;
    osg::ref_ptr<osg::Image> palette = osgGeoFX::readPalette(arguments.painting, error);
    if (!palette) throw Failure(error);
    return palette;
}

void sayContrast(const osg::Image& palette)
{
    const std::pair<ColorVision, const char*> visions[] = {
        {ColorVision::USUAL, "readers who see all colors"},
        {ColorVision::DEUTERANOPIA, "readers without green cones (deuteranopia)"},
        {ColorVision::PROTANOPIA, "readers without red cones (protanopia)"}};
    for (const auto& [vision, readers] : visions)
    {
        const osgGeoFX::PaletteContrast least = osgGeoFX::leastContrast(palette, vision);
        std::printf("For %s, %s and %s are the most alike, at light %.2f: CIEDE2000 %.1f%s.\n", readers,
                    classNames[least.row], classNames[least.otherRow], least.light, least.difference,
                    least.difference < goodContrast ? "; from 10 on they are told apart at a glance" : "");
    }
}

void write(const osg::Image& palette, const std::string& file)
{
    osg::ref_ptr<osg::Image> bands = new osg::Image;
    bands->allocateImage(palette.s(), palette.t() * bandHeight, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int row = 0; row < bands->t(); ++row)
        for (int column = 0; column < bands->s(); ++column)
            std::memcpy(bands->data(column, row), palette.data(column, row / bandHeight), 3);
    if (!osgDB::writeImageFile(*bands, file))
        throw Failure(file +
                      ": cannot be written; choose a folder that exists, and a name that ends in .png.");
}

} // namespace

int main(int argc, char** argv)
{
    // What cannot be read or written is said below, in a sentence.
    osg::setNotifyLevel(osg::FATAL);
    CLI::App app("Makes palettes of panorama maps, from paintings or ready ones, and says who can read them.",
                 "osggeofx_palette");
    Arguments arguments;
    addOptions(app, arguments);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return geofx::exitCodeOf(app, error);
    }
    try
    {
        osgGeoFX::InputFiles inputs;
        for (const std::string& file :
             {arguments.painting, arguments.lightMap, arguments.classMap, arguments.points})
            inputs.add(file);
        if (!arguments.output.empty()) inputs.claim("The palette", arguments.output, "-o");
        const osg::ref_ptr<osg::Image> palette = paletteOf(arguments);
        sayContrast(*palette);
        if (!arguments.output.empty()) write(*palette, arguments.output);
        return 0;
    }
    catch (const std::runtime_error& error)
    {
        std::cerr << "osggeofx_palette: " << error.what() << '\n';
    }
    return badInput;
}
