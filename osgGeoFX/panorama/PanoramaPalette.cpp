// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaPalette.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/detail/ColorDifference.h>

#include <osgDB/FileUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using glsl::Rgb;

constexpr int columns = glsl::GEOFX_PALETTE_COLUMNS;
constexpr int rows = glsl::GEOFX_PALETTE_ROWS;
using Row = std::array<Rgb, columns>;
using Palette = std::array<Row, rows>;

/// Red, green and blue in one number, at these lights; straight between them.
constexpr std::array<double, 7> stopLights = {-1.0, -0.55, -0.2, 0.1, 0.4, 0.7, 1.0};
constexpr unsigned stopColors[rows][stopLights.size()] = {
    {0x363a80, 0x50609c, 0x66859c, 0x84a676, 0xb0bd58, 0xdbcf5c, 0xf9e788}, // field
    {0x42347f, 0x5f4f9f, 0x8a649c, 0xb27567, 0xd28e4e, 0xecb058, 0xfcd98c}, // hill
    {0x2b2c69, 0x454697, 0x6b5a9c, 0x975c6e, 0xb9684d, 0xdb905f, 0xf7c896}, // cliff
    {0x6c74c8, 0x9499e0, 0xb8b7ea, 0xd5ceee, 0xeee3e8, 0xfcf2e0, 0xfffdee}, // snow
    {0x302764, 0x40397b, 0x444f78, 0x3d6054, 0x52733a, 0x748838, 0x9fa248}, // forest floor
    {0x443a8c, 0x5350a4, 0x52709a, 0x528b60, 0x7ca744, 0xb4bf47, 0xe8d960}, // trees
    {0x544a88, 0x7466a4, 0x9987a6, 0xbb9d96, 0xd9b993, 0xf0d4a9, 0xfdefcd}, // town
    {0x474886, 0x6a6cab, 0x908cae, 0xb0a292, 0xc9b580, 0xe2cb91, 0xf8e9bd}, // bare
};

/// The same for color-blind readers. They come from a search for the colors nearest to a summer day's in L*a*b* of which
/// any two rows differ by 11 in CIEDE2000 at every light, and which grow lighter with the light.
constexpr unsigned colorBlindColors[rows][stopLights.size()] = {
    {0x3b3c56, 0x4a5166, 0x53756f, 0x85a971, 0xb9c65e, 0xeee46f, 0xffff9a}, // field
    {0x5458ae, 0x6f6dc8, 0x8674b2, 0xa57a7b, 0xc28c63, 0xdbad6f, 0xe3cb97}, // hill
    {0x141950, 0x143278, 0x474684, 0x8b6075, 0xaa6d65, 0xbf876d, 0xc0a288}, // cliff
    {0x7d94dd, 0x9fb2ee, 0xbec9f4, 0xd0d2ee, 0xe8e2ee, 0xf7f0e8, 0xfffffc}, // snow
    {0x261628, 0x312842, 0x374354, 0x335d4e, 0x426c3a, 0x608339, 0x859a47}, // forest floor
    {0x293987, 0x4b5499, 0x476a7f, 0x3c7d52, 0x5b8d25, 0x87a01a, 0xbcba40}, // trees
    {0x7c74a5, 0x9189b8, 0xa09bc8, 0xbaa0b1, 0xc6a99c, 0xd1b7a3, 0xd7d0c1}, // town
    {0x5c5c7b, 0x6a6e8f, 0x878694, 0xbeb8a7, 0xe2d6ab, 0xf5e6b9, 0xffffd7}, // bare
};

/// What another season than summer puts in the place of the last four stops, of rows that grow.
enum Season
{
    WINTER,
    SPRING,
    SUMMER,
    AUTUMN,
    SEASONS
};
constexpr std::size_t litStops = 4;
constexpr int growing = 4;
constexpr int growingRows[growing] = {glsl::GEOFX_PALETTE_FIELD, glsl::GEOFX_PALETTE_HILL,
                                      glsl::GEOFX_PALETTE_FOREST, glsl::GEOFX_PALETTE_TREES};
constexpr unsigned seasonColors[SEASONS][growing][litStops] = {
    {{0x94a39a, 0xbdb993, 0xd8cda3, 0xefe5c4},
     {0x9c7f8c, 0xba9a8a, 0xd3b698, 0xeedcc0},
     {0x34526a, 0x456a68, 0x648272, 0x92a58e},
     {0x3f6f78, 0x5b8472, 0x86a07c, 0xbfc9a2}},
    {{0x70a57c, 0x98bd6c, 0xc2d474, 0xe9ea9c},
     {0x9a8470, 0xb2a25a, 0xd0be64, 0xeeda94},
     {0x36685a, 0x48803f, 0x68993e, 0x93b650},
     {0x499066, 0x70ae4c, 0xa5c852, 0xe0e57a}},
    {},
    {{0x80a07a, 0xaeb263, 0xd5c467, 0xf3e192},
     {0xa66a68, 0xc77f50, 0xdf9f58, 0xf4c98a},
     {0x41605c, 0x5c6344, 0x7f703f, 0xa8904e},
     {0x587f66, 0x8f8142, 0xcb8840, 0xf0cb68}},
};

Rgb rgb(unsigned code)
{
    return Rgb(code >> 16 & 255u, code >> 8 & 255u, code & 255u) / 255.0;
}

double lightOf(int column)
{
    return 2.0 * column / (columns - 1) - 1.0;
}

Rgb seasonColor(int season, int row, std::size_t stop)
{
    const std::size_t unlit = stopLights.size() - litStops;
    const int* const grows = std::find(std::begin(growingRows), std::end(growingRows), row);
    if (season == SUMMER || stop < unlit || grows == std::end(growingRows)) return rgb(stopColors[row][stop]);
    return rgb(seasonColors[season][grows - growingRows][stop - unlit]);
}

/// Between the two seasons that a time of the year lies between.
Rgb stopColor(double time, int row, std::size_t stop)
{
    const double quarters = 4.0 * (time - std::floor(time));
    const int before = static_cast<int>(quarters) % SEASONS;
    return glm::mix(seasonColor(before, row, stop), seasonColor((before + 1) % SEASONS, row, stop),
                    glsl::geofx_ease(quarters - std::floor(quarters), 0.0, 1.0));
}

/// `stop`: the color of a row at one of the stops.
template<class StopColor>
Palette interpolated(const StopColor& stop)
{
    Palette colors;
    for (int row = 0; row < rows; ++row)
    {
        for (int column = 0; column < columns; ++column)
        {
            const double light = lightOf(column);
            std::size_t next = 1;
            while (next + 1 < stopLights.size() && light > stopLights[next])
                ++next;
            const double before = stopLights[next - 1];
            colors[row][column] = glm::mix(stop(row, next - 1), stop(row, next),
                                           (light - before) / (stopLights[next] - before));
        }
    }
    return colors;
}

Palette palette(double time)
{
    return interpolated([&](int row, std::size_t stop) { return stopColor(time, row, stop); });
}

osg::ref_ptr<osg::Image> toImage(const Palette& colors)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns, rows, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int row = 0; row < rows; ++row)
    {
        for (int column = 0; column < columns; ++column)
        {
            unsigned char* texel = image->data(column, row);
            for (int i = 0; i < 3; ++i)
                texel[i] = static_cast<unsigned char>(
                    std::lround(255.0 * glm::clamp(colors[row][column][i], 0.0, 1.0)));
            texel[3] = 255;
        }
    }
    return image;
}

bool hasPixels(const osg::Image& image)
{
    return image.valid() && image.r() == 1 && !image.isCompressed();
}

Rgb pixel(const osg::Image& image, int column, int row)
{
    const osg::Vec4 color = image.getColor(static_cast<unsigned>(column), static_cast<unsigned>(row));
    return {static_cast<double>(color.r()), static_cast<double>(color.g()), static_cast<double>(color.b())};
}

/// The pixel of one image where another one has column and row.
Rgb pixelAt(const osg::Image& image, const osg::Image& other, int column, int row)
{
    const auto scaled = [](int index, int size, int others)
    {
        return static_cast<int>((2LL * index + 1) * size / (2LL * others));
    };
    return pixel(image, scaled(column, image.s(), other.s()), scaled(row, image.t(), other.t()));
}

/// Columns of an image at `column` of a palette: the mean of those that it covers, or between two where they are wider.
Rgb resampled(const osg::Image& image, int column, int row)
{
    const double width = static_cast<double>(image.s()) / columns;
    if (width <= 1.0)
    {
        const double place = std::clamp((column + 0.5) * width - 0.5, 0.0, image.s() - 1.0);
        const int left = static_cast<int>(place);
        return glm::mix(pixel(image, left, row), pixel(image, std::min(left + 1, image.s() - 1), row),
                        place - left);
    }
    const int first = static_cast<int>(column * width);
    const int last = std::max(first + 1, static_cast<int>((column + 1) * width));
    Rgb sum(0.0);
    for (int i = first; i < last; ++i)
        sum += pixel(image, i, row);
    return sum / static_cast<double>(last - first);
}

/// The colors of one class in a painting, by light.
class Samples
{
public:
    void add(double light, const Rgb& color)
    {
        Bin& bin = _bins[static_cast<std::size_t>(std::clamp(light, 0.0, 0.999) * binCount)];
        bin.light += light;
        bin.color += color;
        ++bin.count;
        ++_count;
    }

    std::size_t count() const { return _count; }

    /// `own`: the row of the kit's own palette.
    Row row(const Row& own) const
    {
        Row row;
        for (int column = 0; column < columns; ++column)
            row[column] = at(own, static_cast<double>(column) / (columns - 1));
        return row;
    }

private:
    static constexpr int binCount = 32;
    struct Bin
    {
        double light = 0.0;
        Rgb color = Rgb(0.0);
        int count = 0;
        double meanLight() const { return light / count; }
        Rgb meanColor() const { return color / static_cast<double>(count); }
    };

    static Rgb colorAt(const Row& row, double light)
    {
        return row[static_cast<std::size_t>(std::lround(std::clamp(light, 0.0, 1.0) * (columns - 1)))];
    }

    Rgb at(const Row& own, double light) const
    {
        const Bin* below = nullptr;
        const Bin* above = nullptr;
        for (const Bin& bin : _bins)
        {
            if (bin.count == 0) continue;
            if (bin.meanLight() <= light)
                below = &bin;
            else if (!above)
                above = &bin;
        }
        if (!below || !above)
        {
            const Bin& end = below ? *below : *above;
            return end.meanColor() + colorAt(own, light) - colorAt(own, end.meanLight());
        }
        return glm::mix(below->meanColor(), above->meanColor(),
                        (light - below->meanLight()) / (above->meanLight() - below->meanLight()));
    }

    std::array<Bin, binCount> _bins;
    std::size_t _count = 0;
};

/// The kit's own palette with the rows of which there are enough samples; null if there is none.
osg::ref_ptr<osg::Image> fromSamples(const std::array<Samples, rows>& samples, std::size_t least)
{
    Palette colors = palette(0.5);
    bool any = false;
    for (int row = 0; row < rows; ++row)
    {
        if (samples[row].count() < std::max(least, std::size_t{1})) continue;
        colors[row] = samples[row].row(colors[row]);
        any = true;
    }
    return any ? toImage(colors) : nullptr;
}

} // namespace

osg::ref_ptr<osg::Image> makePalette(double season)
{
    return toImage(palette(std::isfinite(season) ? season : 0.5));
}

osg::ref_ptr<osg::Image> makeColorBlindPalette()
{
    return toImage(interpolated([](int row, std::size_t stop) { return rgb(colorBlindColors[row][stop]); }));
}

PaletteContrast leastContrast(const osg::Image& palette, ColorVision vision)
{
    PaletteContrast least;
    least.difference = HUGE_VAL;
    if (!hasPixels(palette) || palette.s() != columns || palette.t() != rows) return least;
    for (int column = 0; column < columns; ++column)
    {
        std::array<glm::dvec3, rows> seen;
        for (int row = 0; row < rows; ++row)
            seen[row] = labOf(seenWith(vision, pixel(palette, column, row)));
        for (int row = 0; row < rows; ++row)
        {
            for (int other = 0; other < row; ++other)
            {
                const double difference = colorDifference(seen[row], seen[other]);
                if (difference < least.difference) least = {other, row, lightOf(column), difference};
            }
        }
    }
    return least;
}

osg::ref_ptr<osg::Image> paletteFromImage(const osg::Image& image, std::string& error)
{
    if (!hasPixels(image))
    {
        error =
            "The palette has no pixels that can be read; save it as an uncompressed picture, such as a PNG.";
        return nullptr;
    }
    if (image.t() < rows)
    {
        error = "The palette is " + std::to_string(image.t()) +
                " pixels high; give it at least 8 rows: from the bottom field, hill, cliff, snow, forest "
                "floor, trees, town, bare ground.";
        return nullptr;
    }
    Palette colors;
    for (int row = 0; row < rows; ++row)
    {
        // The rows of pixels whose middles lie in the middle half of the band.
        const double band = static_cast<double>(image.t()) / rows;
        const int first = static_cast<int>(std::ceil((row + 0.25) * band - 0.5));
        const int last = static_cast<int>(std::floor((row + 0.75) * band - 0.5));
        const int middle = static_cast<int>((row + 0.5) * band);
        const int from = first <= last ? first : middle;
        const int to = first <= last ? last : middle;
        for (int column = 0; column < columns; ++column)
        {
            Rgb sum(0.0);
            for (int i = from; i <= to; ++i)
                sum += resampled(image, column, i);
            colors[row][column] = sum / static_cast<double>(to - from + 1);
        }
    }
    return toImage(colors);
}

osg::ref_ptr<osg::Image> readPalette(const std::string& path, std::string& error)
{
    const std::string found = osgDB::findDataFile(path);
    if (found.empty())
    {
        error = "The palette " + path +
                " does not exist; give the path of a picture such as data/panorama/palette.png.";
        return nullptr;
    }
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(found);
    if (!image)
    {
        error = "The palette " + path + " is not a picture that OpenSceneGraph reads; save it as PNG.";
        return nullptr;
    }
    osg::ref_ptr<osg::Image> result = paletteFromImage(*image, error);
    if (!result) error = path + ": " + error;
    return result;
}

osg::ref_ptr<osg::Image> paletteFromSamples(const std::vector<PaletteSample>& samples, std::size_t least,
                                            std::string& error)
{
    std::array<Samples, rows> sorted;
    for (const PaletteSample& sample : samples)
        if (sample.row >= 0 && sample.row < rows)
            sorted[static_cast<std::size_t>(sample.row)].add(
                (sample.light + 1.0) / 2.0, {sample.color.x(), sample.color.y(), sample.color.z()});
    osg::ref_ptr<osg::Image> result = fromSamples(sorted, least);
    if (!result)
        error = "No class has as many as " + std::to_string(least) +
                " samples; give more, of the rows 0 to 7 of a palette.";
    return result;
}

osg::ref_ptr<osg::Image> paletteFromPainting(const osg::Image& painting, const osg::Image& lightMap,
                                             const osg::Image& classMap, std::string& error)
{
    for (const osg::Image* image : {&painting, &lightMap, &classMap})
    {
        if (!hasPixels(*image))
        {
            error = std::string("The ") +
                    (image == &painting   ? "painting"
                     : image == &lightMap ? "light map"
                                          : "map of classes") +
                    " has no pixels that can be read; give an uncompressed picture.";
            return nullptr;
        }
    }
    std::array<Samples, rows> samples;
    for (int row = 0; row < painting.t(); ++row)
    {
        for (int column = 0; column < painting.s(); ++column)
        {
            const long code = std::lround(255.0 * pixelAt(classMap, painting, column, row).x);
            if (code < 0 || code >= rows) continue;
            samples[static_cast<std::size_t>(code)].add(pixelAt(lightMap, painting, column, row).x,
                                                        pixel(painting, column, row));
        }
    }
    osg::ref_ptr<osg::Image> result = fromSamples(samples, 16);
    if (!result)
        error = "The map of classes has fewer than 16 pixels of each class; its red must be 0 to 7 of 255, "
                "the rows of a palette.";
    return result;
}

} // namespace osgGeoFX
