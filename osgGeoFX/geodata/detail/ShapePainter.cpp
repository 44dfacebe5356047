// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/ShapePainter.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>
#include <osgGeoFX/geodata/detail/MarkShapes.h>
#include <osgGeoFX/geodata/detail/RingCut.h>

#include <cairo.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace osgGeoFX
{

namespace
{

constexpr double miterLimit = 4.0;
/// Vertices that are nearer to the one before are left out, texels.
constexpr double nearest = 0.2;
/// Cairo's numbers end at ±8 million, so what is farther away is cut off, texels.
constexpr double margin = 16.0;
/// Marks of patterns that are nearer to each other become an even tint, texels.
constexpr double leastStep = 2.0;

struct SurfaceFreer
{
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextFreer
{
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceFreer>;
using Context = std::unique_ptr<cairo_t, ContextFreer>;
using Line = std::vector<osg::Vec2d>;

Surface makeSurface(int columns, int rows)
{
    Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, columns, rows));
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
        throw BuildError("There is no memory for a picture of vector data; free some.");
    return surface;
}

void setColor(cairo_t* context, const osg::Vec4& color, double opacity = 1.0)
{
    cairo_set_source_rgba(context, static_cast<double>(color.r()), static_cast<double>(color.g()),
                          static_cast<double>(color.b()), static_cast<double>(color.a()) * opacity);
}

/// `scale`: pixels of the picture for one of the stroke's units.
void setStroke(cairo_t* context, const StrokePaint& stroke, double scale)
{
    setColor(context, stroke.color);
    cairo_set_line_width(context, stroke.width * scale);
    cairo_set_line_join(context, stroke.join == StrokePaint::ROUND   ? CAIRO_LINE_JOIN_ROUND
                                 : stroke.join == StrokePaint::BEVEL ? CAIRO_LINE_JOIN_BEVEL
                                                                     : CAIRO_LINE_JOIN_MITER);
    cairo_set_line_cap(context, stroke.cap == StrokePaint::ROUND_CAP ? CAIRO_LINE_CAP_ROUND
                                : stroke.cap == StrokePaint::SQUARE  ? CAIRO_LINE_CAP_SQUARE
                                                                     : CAIRO_LINE_CAP_BUTT);
    cairo_set_miter_limit(context, miterLimit);
}

/// Straight alpha, rows from below.
osg::ref_ptr<osg::Image> imageOf(cairo_surface_t* surface)
{
    cairo_surface_flush(surface);
    const int width = cairo_image_surface_get_width(surface),
              height = cairo_image_surface_get_height(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    const unsigned char* const data = cairo_image_surface_get_data(surface);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < height; ++y)
    {
        const unsigned char* row = data + static_cast<std::ptrdiff_t>(stride) * (height - 1 - y);
        unsigned char* out = image->data(0, static_cast<unsigned int>(y));
        for (int x = 0; x < width; ++x, row += 4, out += 4)
        {
            std::uint32_t pixel = 0;
            std::memcpy(&pixel, row, 4);
            const std::uint32_t alpha = pixel >> 24;
            for (int c = 0; c < 3; ++c)
            {
                const std::uint32_t value = pixel >> (16 - 8 * c) & 255u;
                out[c] = static_cast<unsigned char>(
                    alpha == 0 ? 0 : std::min(255u, (value * 255u + alpha / 2) / alpha));
            }
            out[3] = static_cast<unsigned char>(alpha);
        }
    }
    return image;
}

/// Texels with little opacity hardly know their color, and get that of the most opaque neighbour.
void spread(osg::Image& image)
{
    constexpr int little = 24;
    const int width = image.s(), height = image.t();
    for (int pass = 0; pass < 2; ++pass)
    {
        const std::vector<unsigned char> before(image.data(), image.data() + image.getTotalSizeInBytes());
        const auto at = [&](int x, int y)
        {
            return before.data() + 4 * (static_cast<std::ptrdiff_t>(y) * width + x);
        };
        for (int y = 0; y < height; ++y)
        {
            for (int x = 0; x < width; ++x)
            {
                if (at(x, y)[3] >= little) continue;
                const unsigned char* best = at(x, y);
                // In the second pass colors go one texel farther.
                int most = best[3] + (pass > 0 && (best[0] | best[1] | best[2]) != 0 ? 1 : 0);
                for (int i = 0; i < 9; ++i)
                {
                    const unsigned char* const there =
                        at(std::clamp(x + i % 3 - 1, 0, width - 1), std::clamp(y + i / 3 - 1, 0, height - 1));
                    const int weight = there[3] + (pass > 0 && (there[0] | there[1] | there[2]) != 0 ? 1 : 0);
                    if (weight <= most) continue;
                    most = weight;
                    best = there;
                }
                std::copy(best, best + 3,
                          image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
            }
        }
    }
}

} // namespace

class ShapePainter::Work
{
public:
    Work(const osg::Vec2d& low, const osg::Vec2d& high, int columns, int rows, double coarseness)
        : _texelsOfPixel(texelsOfPixel / coarseness), _low(low),
          _scale(columns / (high.x() - low.x()), rows / (high.y() - low.y())), _columns(columns), _rows(rows),
          _surface(makeSurface(columns, rows)), _context(cairo_create(_surface.get()))
    {
        cairo_set_fill_rule(_context.get(), CAIRO_FILL_RULE_EVEN_ODD);
        cairo_set_tolerance(_context.get(), 0.05);
    }

    void draw(const VectorShape& shape, const ShapePaint& paint)
    {
        const double scale = std::sqrt(_scale.x() * _scale.y());
        const double pixel = _texelsOfPixel / scale / 0.00028;
        if (pixel < paint.leastScale || pixel >= paint.mostScale) return;
        const bool fills = paint.fill && shape.area;
        if (fills && !paint.stroke && addTiny(shape, *paint.fill)) return;
        std::vector<Line> parts;
        for (const Line& part : shape.parts)
            parts.push_back(inTexels(part));
        const double unit = paint.metres ? scale : _texelsOfPixel;
        if (fills && !addTiny(shape, *paint.fill)) fill(parts, *paint.fill);
        if (paint.pattern && shape.area) fillWith(*paint.pattern, parts, unit);
        if (paint.stroke) stroke(parts, shape.area, *paint.stroke, unit);
    }

    osg::ref_ptr<osg::Image> finish()
    {
        if (cairo_status(_context.get()) != CAIRO_STATUS_SUCCESS)
            throw BuildError(std::string("Vector data cannot be drawn (") +
                             cairo_status_to_string(cairo_status(_context.get())) + "); free some memory.");
        blendTiny();
        osg::ref_ptr<osg::Image> image = imageOf(_surface.get());
        spread(*image);
        return image;
    }

private:
    /// Areas that are much smaller than a texel would be lost one by one, and together they may cover half of it: their shares are added. False of larger ones.
    bool addTiny(const VectorShape& shape, const osg::Vec4& color)
    {
        constexpr double tiny = 0.5;
        constexpr std::size_t most = 256;
        osg::Vec2d first, middle, size;
        double area = 0.0;
        for (std::size_t part = 0; part < shape.parts.size(); ++part)
        {
            const Line& ring = shape.parts[part];
            if (ring.empty() || ring.size() > most) return false;
            if (part == 0) first = ring[0];
            double twice = 0.0;
            for (std::size_t i = 0; i < ring.size(); ++i)
            {
                const osg::Vec2d a = ring[i] - first, b = ring[(i + 1) % ring.size()] - first;
                if (std::abs(a.x()) * _scale.x() > tiny || std::abs(a.y()) * _scale.y() > tiny) return false;
                twice += a.x() * b.y() - a.y() * b.x();
            }
            area += (part == 0 ? 0.5 : -0.5) * std::abs(twice);
        }
        const double column = std::floor((first.x() - _low.x()) * _scale.x());
        const double row = std::floor(_rows - (first.y() - _low.y()) * _scale.y());
        if (!(column >= 0.0 && column < _columns && row >= 0.0 && row < _rows)) return true;
        if (_tiny.empty()) _tiny.resize(static_cast<std::size_t>(_columns) * static_cast<std::size_t>(_rows));
        osg::Vec4& sum = _tiny[static_cast<std::size_t>(row) * static_cast<std::size_t>(_columns) +
                               static_cast<std::size_t>(column)];
        const float share = color.a() * static_cast<float>(std::max(area, 0.0) * _scale.x() * _scale.y());
        sum += osg::Vec4(color.r() * share, color.g() * share, color.b() * share, share);
        return true;
    }

    /// Over all else.
    void blendTiny()
    {
        if (_tiny.empty()) return;
        cairo_surface_flush(_surface.get());
        unsigned char* const data = cairo_image_surface_get_data(_surface.get());
        const int stride = cairo_image_surface_get_stride(_surface.get());
        for (int y = 0; y < _rows; ++y)
        {
            for (int x = 0; x < _columns; ++x)
            {
                osg::Vec4 sum = _tiny[static_cast<std::size_t>(y) * static_cast<std::size_t>(_columns) +
                                      static_cast<std::size_t>(x)];
                if (!(sum.a() > 0.0f)) continue;
                if (sum.a() > 1.0f) sum /= sum.a();
                unsigned char* const at = data + static_cast<std::ptrdiff_t>(stride) * y + 4 * x;
                std::uint32_t pixel = 0, result = 0;
                std::memcpy(&pixel, at, 4);
                const float channels[] = {sum.b(), sum.g(), sum.r(), sum.a()};
                for (int c = 0; c < 4; ++c)
                {
                    const auto below = static_cast<float>(pixel >> (8 * c) & 255u);
                    const float value = 255.0f * channels[c] + below * (1.0f - sum.a());
                    result |= static_cast<std::uint32_t>(std::lround(std::min(value, 255.0f))) << (8 * c);
                }
                std::memcpy(at, &result, 4);
            }
        }
        cairo_surface_mark_dirty(_surface.get());
    }

    Line inTexels(const Line& part) const
    {
        Line result;
        for (std::size_t i = 0; i < part.size(); ++i)
        {
            const osg::Vec2d place((part[i].x() - _low.x()) * _scale.x(),
                                   _rows - (part[i].y() - _low.y()) * _scale.y());
            const bool keeps = i == 0 || i + 1 == part.size() ||
                               std::abs(place.x() - result.back().x()) > nearest ||
                               std::abs(place.y() - result.back().y()) > nearest;
            if (keeps) result.push_back(place);
        }
        // Many small things together are seen, so their corners stay.
        if (result.size() < 5 && part.size() < 64 && part.size() > result.size())
        {
            result.clear();
            for (const osg::Vec2d& place : part)
                result.emplace_back((place.x() - _low.x()) * _scale.x(),
                                    _rows - (place.y() - _low.y()) * _scale.y());
        }
        return result;
    }

    osg::Vec2d low(double reach) const { return osg::Vec2d(-reach, -reach); }
    osg::Vec2d high(double reach) const { return osg::Vec2d(_columns + reach, _rows + reach); }

    void add(const Line& line) const
    {
        cairo_move_to(_context.get(), line[0].x(), line[0].y());
        for (std::size_t i = 1; i < line.size(); ++i)
            cairo_line_to(_context.get(), line[i].x(), line[i].y());
    }

    void fill(const std::vector<Line>& parts, const osg::Vec4& color) const
    {
        setColor(_context.get(), color);
        addRings(parts);
        cairo_fill(_context.get());
    }

    void addRings(const std::vector<Line>& parts) const
    {
        for (const Line& part : parts)
        {
            const Line ring = ringWithin(part, low(margin), high(margin));
            if (ring.size() < 3) continue;
            add(ring);
            cairo_close_path(_context.get());
        }
    }

    /// A pattern that is the same in all tiles of a magnification. `scale`: texels in one of its units.
    void fillWith(const SymbolPaint& pattern, const std::vector<Line>& parts, double scale) const
    {
        cairo_t* const context = _context.get();
        cairo_save(context);
        addRings(parts);
        cairo_clip(context);
        cairo_set_fill_rule(context, CAIRO_FILL_RULE_WINDING);
        Window window;
        cairo_clip_extents(context, &window.low.x(), &window.low.y(), &window.high.x(), &window.high.y());
        const std::vector<double> hatches = MarkShapes::hatches(pattern.mark);
        if (window.low.x() < window.high.x() && window.low.y() < window.high.y() && pattern.size > 0.0)
        {
            for (const double direction : hatches)
                hatch(pattern, window, direction, scale);
            if (hatches.empty()) repeat(pattern, window, scale);
        }
        cairo_restore(context);
    }

    struct Window
    {
        osg::Vec2d low, high; ///< texels
    };

    /// The frame's origin, texels.
    osg::Vec2d origin() const { return osg::Vec2d(-_low.x() * _scale.x(), _rows + _low.y() * _scale.y()); }

    void hatch(const SymbolPaint& pattern, const Window& window, double direction, double scale) const
    {
        if (!pattern.stroke) return;
        const double angle = osg::DegreesToRadians(direction - pattern.rotation);
        const osg::Vec2d along(std::cos(angle), -std::sin(angle)), across(-along.y(), along.x());
        // Diagonals of squares are nearer to each other than their sides.
        const double diagonal = std::abs(direction) == 45.0 ? std::sqrt(0.5) : 1.0;
        const double step = (pattern.size + pattern.gap.y()) * scale * diagonal;
        const double width = pattern.stroke->width * scale;
        osg::Vec4 color = pattern.stroke->color;
        color.a() *= static_cast<float>(pattern.opacity);
        if (step < leastStep)
        {
            color.a() *= static_cast<float>(std::min(1.0, width / step));
            return tint(color);
        }
        const osg::Vec2d middle = (window.low + window.high) / 2.0;
        const double reach = (window.high - window.low).length() / 2.0 + width;
        const double place = (middle - origin()) * across;
        setStroke(_context.get(), *pattern.stroke, scale);
        setColor(_context.get(), color);
        std::vector<double> dashes;
        for (const double dash : pattern.stroke->dashes)
            dashes.push_back(dash * scale);
        double period = 0.0;
        for (const double dash : dashes)
            period += dash;
        // Each line begins at the same place.
        const double start = pattern.stroke->dashOffset * scale + (middle - origin()) * along - reach;
        if (period >= leastStep)
            cairo_set_dash(_context.get(), dashes.data(), static_cast<int>(dashes.size()),
                           start - std::floor(start / (2.0 * period)) * 2.0 * period);
        for (double at = std::ceil((place - reach) / step) * step; at <= place + reach; at += step)
            add({middle + across * (at - place) - along * reach,
                 middle + across * (at - place) + along * reach});
        cairo_stroke(_context.get());
        cairo_set_dash(_context.get(), nullptr, 0, 0.0);
    }

    void repeat(const SymbolPaint& pattern, const Window& window, double scale) const
    {
        cairo_t* const context = _context.get();
        const osg::Vec2d step = (osg::Vec2d(pattern.size, pattern.size) + pattern.gap) * scale;
        const auto faded = [&](osg::Vec4 color, double share)
        {
            color.a() *= static_cast<float>(pattern.opacity * share);
            return color;
        };
        if (std::min(step.x(), step.y()) < leastStep)
        {
            const double share = pattern.size * scale / step.x() * pattern.size * scale / step.y();
            if (pattern.fill) tint(faded(*pattern.fill, share));
            return;
        }
        const osg::Vec2d start = origin();
        const auto first = [](double from, double low, double by)
        {
            return from + std::floor((low - from) / by) * by;
        };
        for (double y = first(start.y(), window.low.y(), step.y()); y < window.high.y() + step.y();
             y += step.y())
            for (double x = first(start.x(), window.low.x(), step.x()); x < window.high.x() + step.x();
                 x += step.x())
            {
                cairo_save(context);
                cairo_translate(context, x, y);
                cairo_rotate(context, osg::DegreesToRadians(pattern.rotation));
                cairo_scale(context, pattern.size * scale, pattern.size * scale);
                MarkShapes::add(context, pattern.mark);
                cairo_restore(context);
                if (pattern.fill)
                {
                    setColor(context, faded(*pattern.fill, 1.0));
                    cairo_fill_preserve(context);
                }
                if (pattern.stroke)
                {
                    setStroke(context, *pattern.stroke, scale);
                    setColor(context, faded(pattern.stroke->color, 1.0));
                    cairo_stroke_preserve(context);
                }
                cairo_new_path(context);
            }
    }

    /// All of the area that is clipped to.
    void tint(const osg::Vec4& color) const
    {
        setColor(_context.get(), color);
        cairo_paint(_context.get());
    }

    void stroke(const std::vector<Line>& parts, bool closed, const StrokePaint& paint, double scale) const
    {
        setStroke(_context.get(), paint, scale);
        // Cairo looks at each texel in fifteen rows, so what is thinner is drawn fainter.
        constexpr double thin = 0.25;
        if (paint.width * scale < thin)
        {
            cairo_set_line_width(_context.get(), thin);
            setColor(_context.get(), paint.color, paint.width * scale / thin);
        }
        const double reach = margin + paint.width * scale * miterLimit;
        std::vector<double> dashes;
        for (const double dash : paint.dashes)
            dashes.push_back(dash * scale);
        // Dashes that nobody can tell apart would take long.
        double period = 0.0;
        for (const double dash : dashes)
            period += dash;
        if (period < 0.5) dashes.clear();
        for (Line part : parts)
        {
            if (closed && part.front() != part.back()) part.push_back(part.front());
            std::vector<double> starts;
            const std::vector<Line> pieces = lineWithin(part, low(reach), high(reach), &starts);
            // A ring that is there as a whole has a join where it closes.
            const bool whole = closed && pieces.size() == 1 && pieces[0].size() == part.size();
            for (std::size_t i = 0; i < pieces.size(); ++i)
            {
                add(pieces[i]);
                if (whole) cairo_close_path(_context.get());
                if (dashes.empty()) continue;
                // Whatever part of a line is drawn, its dashes begin where the line does.
                cairo_set_dash(_context.get(), dashes.data(), static_cast<int>(dashes.size()),
                               std::fmod(paint.dashOffset * scale + starts[i], 2.0 * period));
                cairo_stroke(_context.get());
            }
        }
        cairo_set_dash(_context.get(), nullptr, 0, 0.0);
        cairo_stroke(_context.get());
    }

    const double _texelsOfPixel;
    const osg::Vec2d _low, _scale; ///< metres; texels in a metre
    const int _columns, _rows;
    const Surface _surface;
    const Context _context;
    std::vector<osg::Vec4> _tiny; ///< of the texels, rows from above, colors times alpha
};

ShapePainter::ShapePainter(const osg::Vec2d& low, const osg::Vec2d& high, int columns, int rows,
                           double coarseness)
    : _work(std::make_unique<Work>(low, high, columns, rows, coarseness))
{
}

ShapePainter::~ShapePainter() = default;

void ShapePainter::draw(const VectorShape& shape, const ShapePaint& paint)
{
    _work->draw(shape, paint);
}

osg::ref_ptr<osg::Image> ShapePainter::finish()
{
    return _work->finish();
}

double ShapePainter::reachOf(const ShapePaint& paint, double texel)
{
    if (!paint.stroke) return texel;
    return texel + paint.stroke->width * miterLimit / 2.0 * (paint.metres ? 1.0 : texelsOfPixel * texel);
}

namespace
{

/// A picture of a file, premultiplied.
Surface readPicture(const std::string& picture, const std::string& file, bool anyFormat)
{
    constexpr int most = 512;
    osg::ref_ptr<osg::Image> image;
    try
    {
        const FrameRaster raster(picture, DataLayer::COLOR, false,
                                 anyFormat ? FrameRaster::ANY_FORMAT : FrameRaster::PLAIN_PICTURES);
        image = raster.picture(most);
    }
    catch (const BuildError& failure)
    {
        throw BuildError(file + ": a symbol of its style cannot be used: " + failure.what());
    }
    Surface surface = makeSurface(image->s(), image->t());
    unsigned char* const data = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < image->t(); ++y)
    {
        for (int x = 0; x < image->s(); ++x)
        {
            const unsigned char* const from =
                image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(image->t() - 1 - y));
            std::uint32_t pixel = static_cast<std::uint32_t>(from[3]) << 24;
            for (int c = 0; c < 3; ++c)
                pixel |= (static_cast<std::uint32_t>(from[c]) * from[3] + 127u) / 255u << (16 - 8 * c);
            std::memcpy(data + static_cast<std::ptrdiff_t>(stride) * y + 4 * x, &pixel, 4);
        }
    }
    cairo_surface_mark_dirty(surface.get());
    return surface;
}

} // namespace

osg::ref_ptr<osg::Image> ShapePainter::symbol(const SymbolPaint& paint, const std::string& file,
                                              bool anyFormat, double& side)
{
    Surface picture;
    double height = paint.size, width = paint.size;
    if (!paint.picture.empty())
    {
        picture = readPicture(paint.picture, file, anyFormat);
        const double own = cairo_image_surface_get_height(picture.get());
        if (height <= 0.0) height = own;
        width = height * cairo_image_surface_get_width(picture.get()) / own;
    }
    const double line = paint.stroke && paint.picture.empty() ? paint.stroke->width : 0.0;
    // From the place to the symbol's middle, y upwards.
    const osg::Vec2d middle((0.5 - paint.anchor.x()) * width + paint.offset.x(),
                            (0.5 - paint.anchor.y()) * height + paint.offset.y());
    const bool isRound = paint.mark == "circle" && picture == nullptr;
    const bool isTurned = std::fmod(paint.rotation, 90.0) != 0.0 || paint.mark == "x";
    const double radius = (isTurned && !isRound ? std::hypot(width, height) : std::max(width, height)) / 2.0 +
                          line * (isRound ? 0.5 : miterLimit / 2.0);
    side = 2.0 * (radius + middle.length());
    // Some transparent pixels around it, for the filter.
    int pixels = 32;
    while (pixels < 256 && pixels < 2.0 * side)
        pixels *= 2;
    if (paint.metres) pixels = 128;
    side *= pixels / (pixels - 4.0);
    const double scale = pixels / side;
    const Surface surface = makeSurface(pixels, pixels);
    const Context context(cairo_create(surface.get()));
    cairo_translate(context.get(), pixels / 2.0, pixels / 2.0);
    cairo_scale(context.get(), scale, scale);
    cairo_rotate(context.get(), osg::DegreesToRadians(paint.rotation));
    cairo_translate(context.get(), middle.x(), -middle.y());
    cairo_push_group(context.get());
    if (picture)
    {
        const double shrink = height / cairo_image_surface_get_height(picture.get());
        cairo_translate(context.get(), -width / 2.0, -height / 2.0);
        cairo_scale(context.get(), shrink, shrink);
        cairo_set_source_surface(context.get(), picture.get(), 0.0, 0.0);
        cairo_paint(context.get());
    }
    else
    {
        cairo_save(context.get());
        cairo_scale(context.get(), width, height);
        MarkShapes::add(context.get(), paint.mark);
        cairo_restore(context.get());
        if (paint.fill)
        {
            setColor(context.get(), *paint.fill);
            cairo_fill_preserve(context.get());
        }
        if (paint.stroke)
        {
            setStroke(context.get(), *paint.stroke, 1.0);
            cairo_stroke(context.get());
        }
    }
    cairo_pop_group_to_source(context.get());
    cairo_paint_with_alpha(context.get(), paint.opacity);
    osg::ref_ptr<osg::Image> image = imageOf(surface.get());
    spread(*image);
    return image;
}

} // namespace osgGeoFX
