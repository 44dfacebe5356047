// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/SkyCanvas.h>

#include <osgGeoFX/panorama/detail/PaintNoise.h>

#include <cmath>

namespace osgGeoFX
{

namespace
{

using Color = glm::vec3;

/// From the deepest shade to the sunlit edge.
Color cloudColor(float light)
{
    static const Color shades[] = {{0.430f, 0.470f, 0.720f}, {0.575f, 0.600f, 0.815f},
                                   {0.745f, 0.735f, 0.870f}, {0.905f, 0.860f, 0.890f},
                                   {0.985f, 0.945f, 0.890f}, {1.000f, 0.985f, 0.945f}};
    const float place = glm::clamp(light, 0.0f, 1.0f) * 5.0f;
    const int below = std::min(static_cast<int>(place), 4);
    return glm::mix(shades[below], shades[below + 1], place - static_cast<float>(below));
}

/// A range of distances: the size of its clouds, in heights of the strip, and the haze before them.
struct Range
{
    double spacing; // of banks
    int clouds;     // of a bank, at most
    double baseLow, baseHigh;
    double heightLow, heightHigh;
    float stretch; // width over height
    float haze;
};
constexpr Range ranges[] = {
    {0.42, 1, 0.035, 0.08, 0.03, 0.07, 10.0f, 0.62f},
    {1.30, 3, 0.09, 0.16, 0.09, 0.16, 5.0f, 0.40f},
    {2.60, 3, 0.18, 0.27, 0.17, 0.30, 3.6f, 0.18f},
    {5.00, 4, 0.28, 0.36, 0.38, 0.56, 2.7f, 0.04f},
};

/// The model of one range of clouds, before it is painted; all in pixels.
struct Model
{
    Model(int width, int height)
        : bulge(width, height), base(width, height), top(width, height), fray(width, height)
    {
    }
    SkyStrip<float> bulge; // how far a cloud stands out towards the viewer; 0 for no cloud
    SkyStrip<float> base;  // of the cloud that is seen here
    SkyStrip<float> top;
    SkyStrip<float> fray; // what frays the outlines, along x

    /// The same noise, taken from another place, serves along y.
    float frayY(int x, int y) const { return fray.at(x + fray.width() / 3, fray.height() - 1 - y); }
};

/// A ball of vapour, in pixels.
struct Puff
{
    double x, y, depth, radius;
};

void addPuff(Model& model, const Puff& puff, double base, double top)
{
    const double reach = puff.radius * 1.35;
    for (int y = static_cast<int>(std::floor(std::max(puff.y - reach, 0.0))); y <= puff.y + reach; ++y)
    {
        if (y >= model.bulge.height()) break;
        for (int x = static_cast<int>(std::floor(puff.x - reach)); x <= puff.x + reach; ++x)
        {
            const double scale = 0.35 + 5.0 * puff.radius / model.bulge.height();
            const double dx = x - puff.x + scale * static_cast<double>(model.fray.at(x, y));
            const double dy = y - puff.y + scale * static_cast<double>(model.frayY(x, y));
            const double inside = puff.radius * puff.radius - dx * dx - dy * dy;
            if (inside <= 0.0) continue;
            const auto bulge = static_cast<float>(puff.depth + std::sqrt(inside));
            float& best = model.bulge.at(x, y);
            if (bulge <= best) continue;
            best = bulge;
            model.base.at(x, y) = static_cast<float>(base);
            model.top.at(x, y) = static_cast<float>(top);
        }
    }
}

/// Adds one cloud: two or three towers over a flat base, of large balls within and smaller ones around them.
void addCloud(Model& model, paint::Sequence& random, double x, double base, double width, double height)
{
    const int towers = 2 + static_cast<int>(random.uniform() * 2.99);
    double places[5];
    double tops[5];
    for (int i = 0; i < towers; ++i)
    {
        places[i] = random.uniform(-0.62, 0.62);
        tops[i] = i == 0 ? 1.0 : random.uniform(0.45, 0.85);
    }
    const auto outline = [&](double u)
    {
        double best = 0.24 * (1.0 - u * u);
        for (int i = 0; i < towers; ++i)
        {
            const double d = (u - places[i]) / 0.46;
            best = std::max(best, tops[i] * (1.0 - d * d));
        }
        return best * std::min(1.0, 3.5 * (1.0 - std::abs(u)));
    };
    // The body, without holes.
    const int balls = 26;
    for (int i = 0; i < balls; ++i)
    {
        const double u = 2.0 * (i + 0.5) / balls - 1.0;
        const double reach = outline(u);
        for (const double v : {0.25, 0.62})
        {
            Puff puff;
            puff.radius = height * (0.05 + 0.26 * reach) * random.uniform(0.85, 1.1);
            puff.x = x + 0.5 * width * u;
            puff.y = base + v * reach * height;
            puff.depth = 0.05 * height * reach;
            addPuff(model, puff, base, base + height);
        }
    }
    // The puffs that bulge from it.
    const int puffs = 120;
    for (int i = 0; i < puffs; ++i)
    {
        const bool large = i < 30;
        const double u = random.uniform(-1.0, 1.0);
        const double reach = outline(u);
        const double v = std::sqrt(random.uniform());
        Puff puff;
        puff.radius =
            height * random.uniform(large ? 0.15 : 0.06, large ? 0.24 : 0.13) * (0.35 + 0.65 * reach);
        puff.x = x + 0.5 * width * u;
        puff.y = base + std::max(0.15 * puff.radius, v * reach * height - puff.radius * 0.6);
        puff.depth = height * (0.30 * reach * (1.0 - 0.5 * v) +
                               (large ? random.uniform(-0.05, 0.08) : random.uniform(0.0, 0.16)));
        addPuff(model, puff, base, base + height);
    }
}

/// How much the clouds' surface faces the sun, −1…1, by its slopes over `reach` pixels.
float lambertAt(const Model& model, int x, int y, int reach)
{
    const auto slope = [&](int dx, int dy)
    {
        const float a = model.bulge.at(x + dx * reach, y + dy * reach);
        const float b = model.bulge.at(x - dx * reach, y - dy * reach);
        return glm::clamp((a - b) / (2.0f * static_cast<float>(reach)), -2.0f, 2.0f);
    };
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope(1, 0), -slope(0, 1), 1.0f));
    return glm::dot(normal, glm::vec3(-0.62f, 0.60f, 0.50f));
}

void paintRange(SkyCanvas& canvas, Model& model, const Range& range, paint::Sequence& random,
                const Color& haze)
{
    const double unit = canvas.height();
    model.bulge.fill(0.0f);
    const int count = std::max(1, static_cast<int>(std::lround(canvas.width() / (unit * range.spacing))));
    const double step = static_cast<double>(canvas.width()) / count;
    for (int i = 0; i < count; ++i)
    {
        double place = (i + random.uniform(0.1, 0.9)) * step;
        const double base = unit * random.uniform(range.baseLow, range.baseHigh);
        const int clouds = 1 + static_cast<int>(random.uniform() * range.clouds);
        const int tallest = static_cast<int>(random.uniform() * clouds);
        for (int j = 0; j < clouds; ++j)
        {
            const double tall = random.uniform(range.heightLow, range.heightHigh);
            const double height = unit * tall * (j == tallest ? 1.0 : random.uniform(0.35, 0.72));
            const double width = height * static_cast<double>(range.stretch) * random.uniform(0.8, 1.3);
            place += 0.32 * width;
            addCloud(model, random, place, base + 0.04 * unit * range.heightHigh * random.uniform(), width,
                     height);
            place += random.uniform(0.25, 0.5) * width;
        }
    }
    const double fade = 0.010 * unit + 0.05 * unit * range.heightHigh;
    for (int y = 0; y < canvas.height(); ++y)
    {
        for (int x = 0; x < canvas.width(); ++x)
        {
            const float bulge = model.bulge.at(x, y);
            if (bulge <= 0.0f) continue;
            const auto base = static_cast<double>(model.base.at(x, y) + 0.25f * model.frayY(x, y));
            const double floor = paint::ease(y, base - 0.2 * fade, base + fade);
            if (floor <= 0.0) continue;
            // The light on the masses, and on the puffs that stand out from them.
            const float lambert =
                0.45f * lambertAt(model, x, y, static_cast<int>(0.10 * unit * range.heightHigh + 1.0)) +
                0.55f * lambertAt(model, x, y, static_cast<int>(0.014 * unit + 1.0));
            const auto rise = static_cast<float>(glm::clamp(
                (y - base) / std::max(1.0, static_cast<double>(model.top.at(x, y)) - base), 0.0, 1.0));
            const float light = 0.27f + 0.76f * lambert + 0.34f * (rise - 0.4f);
            const Color color = glm::mix(cloudColor(light), haze, range.haze);
            // The sunlit edge is sharp. The other one dissolves.
            const double soft = (0.05 + 0.12 * paint::ease(static_cast<double>(-lambert), -0.4, 0.5)) * unit *
                                    range.heightHigh +
                                1.0;
            const double cover = paint::ease(static_cast<double>(bulge), 0.0, soft) * floor;
            Color& pixel = canvas.at(x, y);
            pixel = glm::mix(pixel, color, 0.97f * static_cast<float>(cover));
        }
    }
}

/// Clouds without bodies, drawn out by the wind. Heights are in those of the strip.
struct Streaks
{
    double low, lowFull, highFull, high; // strongest between the full ones
    double patches;                      // in a strip's height, along x
    double alongX, alongY;               // strokes in a strip's height
    double strength;
    Color color;
};
const Streaks veils = {0.02, 0.10, 0.26, 0.62, 0.45, 1.3, 7.0, 0.60, {0.900f, 0.885f, 0.925f}};
const Streaks thinVeils = {0.05, 0.14, 0.24, 0.50, 0.60, 1.6, 9.0, 0.50, {0.945f, 0.920f, 0.930f}};
const Streaks wisps = {0.42, 0.66, 0.86, 1.30, 0.50, 2.0, 16.0, 0.62, {0.955f, 0.945f, 0.955f}};

void paintStreaks(SkyCanvas& canvas, const Streaks& streaks, std::uint32_t seed)
{
    const double unit = canvas.height();
    const double turn = canvas.width() / unit;
    const auto cells = [&](double each)
    {
        return std::max(1, static_cast<int>(std::lround(each * turn)));
    };
    const int patches = cells(streaks.patches);
    const int waves = cells(1.0);
    const int strokes = cells(streaks.alongX);
    for (int y = 0; y < canvas.height(); ++y)
    {
        const double v = y / unit;
        const double band = paint::ease(v, streaks.low, streaks.lowFull) *
                            (1.0 - paint::ease(v, streaks.highFull, streaks.high));
        if (band <= 0.0) continue;
        for (int x = 0; x < canvas.width(); ++x)
        {
            const double u = static_cast<double>(x) / canvas.width();
            const double where =
                paint::ease(paint::noise(patches * u, 2.0 * v, patches, 64, seed), -0.15, 0.55);
            if (where <= 0.0) continue;
            const double lean = v + 0.10 * paint::noise(waves * u, 1.5 * v, waves, 64, seed + 1);
            const double streak =
                paint::cloudy(strokes * u, streaks.alongY * lean, strokes, 4096, 4, seed + 2);
            const double cover = streaks.strength * band * where * paint::ease(streak, -0.15, 0.6);
            Color& pixel = canvas.at(x, y);
            pixel = glm::mix(pixel, streaks.color, static_cast<float>(cover));
        }
    }
}

float luminance(const Color& color)
{
    return 0.3f * color.x + 0.5f * color.y + 0.2f * color.z;
}

} // namespace

void paintClouds(SkyCanvas& canvas, std::uint32_t seed, const Color& haze)
{
    paintStreaks(canvas, wisps, seed + 7);
    paintStreaks(canvas, veils, seed + 11);
    Model model(canvas.width(), canvas.height());
    const double cell = 0.11 * canvas.height();
    const int cells = std::max(1, static_cast<int>(std::lround(canvas.width() / cell)));
    for (int y = 0; y < canvas.height(); ++y)
    {
        for (int x = 0; x < canvas.width(); ++x)
        {
            const double u = static_cast<double>(x) / canvas.width() * cells;
            const double v = y / cell;
            model.fray.at(x, y) =
                static_cast<float>(0.055 * canvas.height() * paint::cloudy(u, v, cells, 4096, 4, seed + 21));
        }
    }
    paint::Sequence random(seed + 41);
    for (const Range& range : ranges)
    {
        paintRange(canvas, model, range, random, haze);
        if (&range == &ranges[1]) paintStreaks(canvas, thinVeils, seed + 15);
    }
}

void paintInStrokes(SkyCanvas& canvas, std::uint32_t seed)
{
    struct Brush
    {
        double length; // of half a stroke, in heights of the strip
        double width;
        double cover; // how often each place is painted
    };
    constexpr Brush brushes[] = {{0.040, 0.0120, 1.4}, {0.020, 0.0075, 1.8}, {0.011, 0.0048, 1.6}};
    const double unit = canvas.height();
    const SkyCanvas model = canvas;
    paint::Sequence random(seed + 61);
    for (const Brush& brush : brushes)
    {
        const bool fine = &brush != brushes;
        const double length = std::max(2.0, brush.length * unit);
        const double width = std::max(1.0, brush.width * unit);
        const double area = 2.6 * length * width;
        const int strokes = static_cast<int>(brush.cover * canvas.width() * unit / area);
        for (int i = 0; i < strokes; ++i)
        {
            paint::Stroke stroke;
            stroke.x = random.uniform() * canvas.width();
            stroke.y = random.uniform() * unit;
            stroke.length = length * random.uniform(0.7, 1.3);
            stroke.width = width * random.uniform(0.7, 1.3);
            stroke.seed = paint::hash(seed, static_cast<std::uint32_t>(i));
            const int x = static_cast<int>(stroke.x);
            const int y = static_cast<int>(stroke.y);
            const int reach = std::max(1, static_cast<int>(length * 0.4));
            const float dx = luminance(model.at(x + reach, y)) - luminance(model.at(x - reach, y));
            const float dy = luminance(model.at(x, y + reach)) - luminance(model.at(x, y - reach));
            const double change = static_cast<double>(std::hypot(dx, dy));
            // Strokes run along what is painted; on open sky, across the sky.
            const double along = std::atan2(static_cast<double>(dx), -static_cast<double>(dy));
            const double drawn = paint::ease(change, 0.03, 0.10);
            // The open sky needs no fine brush.
            if (fine && random.uniform() > 0.25 + 0.75 * drawn) continue;
            stroke.angle = drawn > 0.5 ? along : 0.30 * (random.uniform() - 0.5) + 0.12;
            if (drawn > 0.5) stroke.angle += 0.5 * (random.uniform() - 0.5);
            const auto bright = static_cast<float>(1.0 + 0.035 * (random.uniform() - 0.5));
            const auto warm = static_cast<float>(0.022 * (random.uniform() - 0.5));
            const Color color = model.at(x, y) * bright + Color(warm, 0.0f, -warm);
            paint::stamp(stroke,
                         [&](int i1, int j, double cover, double across)
                         {
                             if (j < 0 || j >= canvas.height()) return;
                             const auto ridge = static_cast<float>(1.0 + 0.012 * across);
                             Color& pixel = canvas.at(i1, j);
                             pixel = glm::mix(pixel, color * ridge, static_cast<float>(0.8 * cover));
                         });
        }
    }
}

} // namespace osgGeoFX
