// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/lines/LinePicture.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/labels/detail/CairoRows.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/BoundingBox>

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// The share of its distance by which a line may lie behind what is drawn: that of MapLines.
constexpr double tolerance = 0.006;
/// Between two places of a line it is looked whether it is hidden at least that often; pixels.
constexpr double sampleStep = 2.0;
constexpr int mostSamples = 1000;
/// Hidden parts that are no longer than this are shown, and shown ones that are shorter are left out; pixels.
constexpr double shortestGap = 5.0, shortestPart = 1.5;
/// By how much the width of a piece may differ from that of the line.
constexpr double widthStep = 1.08;
/// Dashes that are shorter are doubled, as MapLines does it; pixels.
constexpr double shortestDash = 6.0;

struct Sample
{
    osg::Vec3d world;
    osg::Vec2d pixel;
    double along = 0.0;
    double perMetre = 0.0;
    bool placed = false; ///< whether it has a pixel
    bool seen = false;
};

/// Where places of lines are in the picture, and whether they are to be seen.
class Projection
{
public:
    Projection(EffectScene& scene, const osg::Camera& camera,
               const std::vector<std::shared_ptr<const DepthPicture>>& depths)
        : _view(scene, camera), _camera(camera), _depths(depths)
    {
        const osg::Matrixd& projection = camera.getProjectionMatrix();
        _pixels = 0.5 * camera.getViewport()->height() * std::hypot(projection(0, 1), projection(1, 1));
    }

    bool maySee(const osg::BoundingSphered& ball) const { return _view.maySee(ball); }

    Sample at(const osg::Vec3d& world, double along) const
    {
        Sample sample;
        sample.world = world;
        sample.along = along;
        sample.placed = _view.project(world, sample.pixel);
        if (!sample.placed) return sample;
        const osg::Vec3d drawn = _view.deform(world);
        const osg::Vec4d clip =
            osg::Vec4d(drawn, 1.0) * _camera.getViewMatrix() * _camera.getProjectionMatrix();
        sample.perMetre = _pixels / std::max(clip.w(), 1e-9);
        const osg::Viewport& port = *_camera.getViewport();
        const bool within = sample.pixel.x() >= 0.0 && sample.pixel.y() >= 0.0 &&
                            sample.pixel.x() <= port.width() && sample.pixel.y() <= port.height();
        sample.seen =
            within &&
            (_depths.empty() || std::any_of(_depths.begin(), _depths.end(),
                                            [&](const auto& picture)
                                            { return picture->shows(drawn * picture->view, 1, tolerance); }));
        return sample;
    }

private:
    DeformedView _view;
    const osg::Camera& _camera;
    const std::vector<std::shared_ptr<const DepthPicture>>& _depths;
    double _pixels = 0.0;
};

/// Samples along a line, as close as its picture needs them.
std::vector<Sample> samplesOf(const MapLine& line, const Projection& projection)
{
    std::vector<Sample> samples;
    double along = 0.0;
    for (std::size_t i = 0; i < line.places.size(); ++i)
    {
        if (i == 0)
        {
            samples.push_back(projection.at(line.places[0], 0.0));
            continue;
        }
        const osg::Vec3d from = line.places[i - 1], way = line.places[i] - from;
        const double length = way.length();
        const Sample former = samples.back();
        const Sample next = projection.at(line.places[i], along + length);
        int steps = 1;
        if (former.placed && next.placed)
            steps = static_cast<int>(std::clamp(std::ceil((next.pixel - former.pixel).length() / sampleStep),
                                                1.0, double(mostSamples)));
        else if (former.placed || next.placed)
            steps = 32;
        for (int k = 1; k < steps; ++k)
        {
            const double share = static_cast<double>(k) / steps;
            samples.push_back(projection.at(from + way * share, along + length * share));
        }
        samples.push_back(next);
        along += length;
    }
    return samples;
}

/// The last place that is to be seen between one that is and one that is not.
Sample border(Sample seen, Sample hidden, const Projection& projection)
{
    for (int i = 0; i < 8; ++i)
    {
        const Sample middle =
            projection.at((seen.world + hidden.world) * 0.5, 0.5 * (seen.along + hidden.along));
        (middle.seen ? seen : hidden) = middle;
    }
    return seen;
}

/// Shows what is hidden for a few pixels only.
void closeGaps(std::vector<Sample>& samples, double most)
{
    std::size_t last = samples.size(); // the last one seen
    double length = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        if (i > 0 && samples[i].placed && samples[i - 1].placed)
            length += (samples[i].pixel - samples[i - 1].pixel).length();
        else
            length = HUGE_VAL;
        if (!samples[i].seen) continue;
        if (last < samples.size() && i > last + 1 && length <= most)
            for (std::size_t k = last + 1; k < i; ++k)
                samples[k].seen = true;
        last = i;
        length = 0.0;
    }
}

double lengthOf(const std::vector<osg::Vec2d>& points)
{
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i)
        length += (points[i] - points[i - 1]).length();
    return length;
}

void add(const Sample& sample, LinePicture::Part& part)
{
    part.points.push_back(sample.pixel);
    part.along.push_back(sample.along);
    part.perMetre.push_back(sample.perMetre);
}

/// The parts of a line that are to be seen.
std::vector<LinePicture::Part> partsOf(std::size_t line, const std::vector<Sample>& samples,
                                       const Projection& projection, double scale)
{
    std::vector<LinePicture::Part> parts;
    LinePicture::Part part;
    part.line = line;
    const auto finish = [&]
    {
        if (part.points.size() > 1 && lengthOf(part.points) >= shortestPart * scale) parts.push_back(part);
        part.points.clear();
        part.along.clear();
        part.perMetre.clear();
    };
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        const Sample& sample = samples[i];
        if (!sample.seen)
        {
            if (!part.points.empty()) add(border(samples[i - 1], sample, projection), part);
            finish();
            continue;
        }
        if (part.points.empty() && i > 0) add(border(sample, samples[i - 1], projection), part);
        // Of points that share a pixel one is enough.
        const bool last = i + 1 == samples.size() || !samples[i + 1].seen;
        if (last || part.points.empty() || (sample.pixel - part.points.back()).length() > 0.5)
            add(sample, part);
    }
    finish();
    return parts;
}

void setColor(cairo_t* target, const osg::Vec4& color)
{
    cairo_set_source_rgba(target, static_cast<double>(color.r()), static_cast<double>(color.g()),
                          static_cast<double>(color.b()), static_cast<double>(color.a()));
}

} // namespace

LinePicture::LinePicture(std::vector<MapLine> lines, std::map<std::string, LineStyle> styles,
                         EffectScene& scene, const osg::Camera& camera,
                         const std::vector<std::shared_ptr<const DepthPicture>>& depths, double scale)
    : _lines(std::move(lines)), _styles(std::move(styles)), _width(camera.getViewport()->width()),
      _height(camera.getViewport()->height()), _scale(scale)
{
    const Projection projection(scene, camera, depths);
    for (std::size_t i = 0; i < _lines.size(); ++i)
    {
        if (!lineStyleOf(_styles, _lines[i].style).shown) continue;
        osg::BoundingBoxd box;
        for (const osg::Vec3d& place : _lines[i].places)
            box.expandBy(place);
        if (!projection.maySee({box.center(), box.radius()})) continue;
        std::vector<Sample> samples = samplesOf(_lines[i], projection);
        closeGaps(samples, shortestGap * _scale);
        for (Part& part : partsOf(i, samples, projection, _scale))
            _parts.push_back(std::move(part));
    }
    std::stable_sort(_parts.begin(), _parts.end(),
                     [this](const Part& a, const Part& b) { return styleOf(a).rank < styleOf(b).rank; });
}

LinePicture LinePicture::enlarged(double factor) const
{
    LinePicture result = *this;
    result._width *= factor;
    result._height *= factor;
    result._scale *= factor;
    for (Part& part : result._parts)
    {
        for (osg::Vec2d& point : part.points)
            point *= factor;
        for (double& pixels : part.perMetre)
            pixels *= factor;
    }
    return result;
}

std::vector<LinePicture::Piece> LinePicture::piecesOf(const Part& part) const
{
    const LineStyle& style = styleOf(part);
    const auto widthAt = [&](std::size_t i)
    {
        return glsl::geofx_lineWidth(style.ground, _scale * style.least, _scale * style.width,
                                     part.perMetre[i]);
    };
    std::vector<Piece> pieces;
    std::size_t first = 0;
    for (std::size_t i = 1; i < part.points.size(); ++i)
    {
        const double ratio = widthAt(i) / widthAt(first);
        const bool dashes = style.dash > 0.0 && style.gap > 0.0;
        const double zoom = dashes ? part.perMetre[i] / part.perMetre[first] : 1.0;
        const bool differs = ratio > widthStep || ratio < 1.0 / widthStep || zoom > 1.2 || zoom < 1.0 / 1.2;
        if (!differs && i + 1 < part.points.size()) continue;
        Piece piece;
        piece.points.assign(part.points.begin() + static_cast<std::ptrdiff_t>(first),
                            part.points.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        piece.width = std::sqrt(widthAt(first) * widthAt(i));
        const double ground = part.along[i] - part.along[first];
        if (dashes && ground > 0.0)
        {
            // The ground's metres are shorter where it is seen at a slant.
            const double metre = std::sqrt(part.perMetre[first] * part.perMetre[i]);
            const double level =
                std::max(std::ceil(std::log2(shortestDash * _scale / (style.dash * metre))), 0.0);
            const double pixels = std::exp2(level) * lengthOf(piece.points) / ground;
            piece.dash = style.dash * pixels;
            piece.gap = style.gap * pixels;
            const double period = std::exp2(level) * (style.dash + style.gap);
            piece.offset = std::fmod(part.along[first], period) / period * (piece.dash + piece.gap);
        }
        pieces.push_back(std::move(piece));
        first = i;
    }
    return pieces;
}

void LinePicture::draw(_cairo* target) const
{
    cairo_set_line_join(target, CAIRO_LINE_JOIN_ROUND);
    for (const bool casing : {true, false})
    {
        for (const Part& part : _parts)
        {
            const LineStyle& style = styleOf(part);
            if (casing && style.casingWidth <= 0.0) continue;
            setColor(target, casing ? style.casing : style.color);
            for (const Piece& piece : piecesOf(part))
            {
                const bool dashes = !casing && piece.dash > 0.0 && piece.gap > 0.0;
                const double pattern[2] = {piece.dash, piece.gap};
                cairo_set_dash(target, pattern, dashes ? 2 : 0, dashes ? piece.offset : 0.0);
                cairo_set_line_cap(target, dashes ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
                cairo_set_line_width(target, piece.width + (casing ? 2.0 * _scale * style.casingWidth : 0.0));
                for (const osg::Vec2d& point : piece.points)
                    cairo_line_to(target, point.x(), _height - point.y());
                cairo_stroke(target);
            }
        }
    }
    cairo_set_dash(target, nullptr, 0, 0.0);
}

bool LinePicture::drawOnto(osg::Image& rows, int top) const
{
    return drawOver(rows, top, static_cast<int>(_width), [this](cairo_t* target) { draw(target); });
}

} // namespace osgGeoFX
