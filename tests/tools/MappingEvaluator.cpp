// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/MappingEvaluator.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace geofx::test
{

using osgGeoFX::ColorTable;
using osgGeoFX::ColorTransfer;
using osgGeoFX::DataLayer;
using osgGeoFX::LayerPixels;
using osgGeoFX::ProjectiveMapping;
namespace glsl = osgGeoFX::glsl;

namespace
{

double grey(const glm::dvec3& rgb)
{
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// One texel of a level, the border's beyond it; `most` is the picture's size there.
LayerPixels::Texel texelAt(const LayerPixels& pixels, int level, int x, int y)
{
    const int side = pixels.side >> level;
    const int mostX = std::max((pixels.width - 1) >> level, 0);
    const int mostY = std::max((pixels.height - 1) >> level, 0);
    const auto index = static_cast<std::size_t>(std::clamp(y, 0, mostY) * side + std::clamp(x, 0, mostX));
    return pixels.levels[static_cast<std::size_t>(level)][index];
}

glm::dvec4 bytes(LayerPixels::Texel texel)
{
    return glm::dvec4(texel & 0xffu, texel >> 8u & 0xffu, texel >> 16u & 0xffu, texel >> 24u);
}

/// What a projection changes by along a step, by a small part of the step to both sides: at the step's end there may be
/// no picture.
template<typename Projection, typename Vector>
glm::dvec2 slope(const Projection& project, const Vector& at, const Vector& step)
{
    constexpr double part = 1e-4;
    return (project(at + part * step) - project(at - part * step)) / (2.0 * part);
}

constexpr double weights = 256.0; // of filters in bytes

/// Between two colors; those of filters in bytes are bytes again.
glm::dvec4 between(const glm::dvec4& a, const glm::dvec4& b, double weight, bool inBytes)
{
    const glm::dvec4 result = glm::mix(a, b, weight);
    return inBytes ? glm::floor(result + 0.5) : result;
}

/// A color between four texels of one level, at texel coordinates of level 0; 0 to 255.
glm::dvec4 bilinear(const LayerPixels& pixels, int level, const glm::dvec2& at, bool inBytes)
{
    const glm::dvec2 there = at / std::exp2(level) - 0.5;
    const glm::dvec2 low = glm::floor(there);
    const glm::dvec2 t = inBytes ? glm::floor((there - low) * weights + 0.5) / weights : there - low;
    const int side = pixels.side >> level;
    const auto texel = [&](int x, int y)
    {
        x = std::clamp(static_cast<int>(low.x) + x, 0, side - 1);
        y = std::clamp(static_cast<int>(low.y) + y, 0, side - 1);
        return bytes(pixels.levels[static_cast<std::size_t>(level)][static_cast<std::size_t>(y * side + x)]);
    };
    return between(between(texel(0, 0), texel(1, 0), t.x, inBytes),
                   between(texel(0, 1), texel(1, 1), t.x, inBytes), t.y, inBytes);
}

} // namespace

MappingEvaluator::MappingEvaluator(const osgGeoFX::ProjectiveMappings& mappings, double pixel,
                                   bool filtersInBytes)
    : _pixel(pixel), _anisotropy(mappings.getAnisotropy()), _filtersInBytes(filtersInBytes)
{
    for (unsigned int i = 0; i < mappings.getNumMappings(); ++i)
    {
        const ProjectiveMapping* mapping = mappings.getMapping(i);
        if (mapping->getEnabled()) _mappings.push_back(mapping);
        for (const DataLayer* data : {mapping->getLayer(), mapping->getMask()})
        {
            if (!data || !data->getImage() || _layers.count(data)) continue;
            LayerPixels::Options options;
            options.kind = static_cast<LayerPixels::Kind>(data->getKind());
            options.sRGB = data->getSRgb();
            if (data->getHasNoData()) options.noData = data->getNoData();
            options.maxSide = mappings.getPageSide();
            std::string error;
            if (auto pixels = LayerPixels::make(*data->getImage(), options, error))
                _layers[data] = {data, *pixels};
        }
    }
    std::stable_sort(_mappings.begin(), _mappings.end(),
                     [](const ProjectiveMapping* a, const ProjectiveMapping* b)
                     { return a->getOrder() < b->getOrder(); });
}

const MappingEvaluator::Layer* MappingEvaluator::layerOf(const DataLayer* data) const
{
    const auto found = _layers.find(data);
    return found != _layers.end() ? &found->second : nullptr;
}

MappingEvaluator::Sample MappingEvaluator::sample(const Layer& layer, const glm::dvec2& uv,
                                                  const glm::dvec2& across, const glm::dvec2& up,
                                                  double mostProbes) const
{
    const LayerPixels& pixels = layer.pixels;
    const glm::dvec2 size(pixels.width, pixels.height);
    const glsl::geofx_Filter how = glsl::geofx_filter(across * size, up * size, mostProbes,
                                                      static_cast<double>(pixels.levels.size() - 1));
    const bool color = layer.data->getKind() == DataLayer::COLOR;
    const bool smooth = layer.data->getSmooth() && layer.data->getKind() != DataLayer::CLASS;
    const double level = smooth ? how.level : std::floor(how.level + 0.5);
    const glm::dvec2 first = uv * size - how.step * (0.5 * (how.probes - 1.0));
    glm::dvec4 colors(0.0);
    glm::dvec2 values(0.0);
    for (double i = 0.0; i < how.probes; ++i)
    {
        glm::dvec2 at = glm::clamp(first + i * how.step, glm::dvec2(0.0), size);
        if (color)
        {
            if (!smooth) at = (glm::floor(at * std::exp2(-level)) + 0.5) * std::exp2(level);
            const glm::dvec2 inset(0.5 * std::exp2(std::ceil(level)));
            const glm::dvec2 there = glm::clamp(at, inset, glm::max(size - inset, inset));
            const int low = static_cast<int>(std::floor(level));
            const int high = std::min(low + 1, static_cast<int>(pixels.levels.size()) - 1);
            const double weight =
                _filtersInBytes ? std::floor((level - low) * weights) / weights : level - low;
            const glm::dvec4 texel =
                between(bilinear(pixels, low, there, _filtersInBytes),
                        bilinear(pixels, high, there, _filtersInBytes), weight, _filtersInBytes);
            colors += glm::dvec4(glm::dvec3(texel) * texel.a / 255.0, texel.a) / 255.0;
            continue;
        }
        const int whole = static_cast<int>(std::floor(level + 0.5));
        const glm::dvec2 there = at / std::exp2(whole);
        const glm::dvec2 low = smooth ? glm::floor(there - 0.5) : glm::floor(there);
        const glm::dvec2 t = there - 0.5 - low;
        for (int corner = 0; corner < (smooth ? 4 : 1); ++corner)
        {
            const int x = corner % 2;
            const int y = corner / 2;
            const double weight = smooth ? (x ? t.x : 1.0 - t.x) * (y ? t.y : 1.0 - t.y) : 1.0;
            const double value = static_cast<double>(LayerPixels::value(
                texelAt(pixels, whole, static_cast<int>(low.x) + x, static_cast<int>(low.y) + y)));
            if (!std::isnan(value)) values += glm::dvec2(value * weight, weight);
        }
    }
    Sample result;
    if (color)
    {
        result.color = glm::dvec4(glm::dvec3(colors) / std::max(colors.a, 1e-6), colors.a / how.probes);
    }
    else
    {
        result.cover = values.y / how.probes;
        result.value = values.y > 0.0 ? values.x / values.y : 0.0;
    }
    return result;
}

MappingEvaluator::Sample MappingEvaluator::sampleClasses(const Layer& layer, const ColorTable& table,
                                                         const glm::dvec2& uv, const glm::dvec2& across,
                                                         const glm::dvec2& up) const
{
    const LayerPixels& pixels = layer.pixels;
    const glm::dvec2 size(pixels.width, pixels.height);
    const glsl::geofx_Filter how = glsl::geofx_filter(across * size, up * size, std::min(_anisotropy, 4.0),
                                                      static_cast<double>(pixels.levels.size() - 1));
    const int level = static_cast<int>(std::floor(how.level + 0.5));
    glm::dvec4 sum(0.0);
    double count = 0.0;
    for (double i = 0.0; i < how.probes; ++i)
    {
        const glm::dvec2 at = uv * size + how.step * (i - 0.5 * (how.probes - 1.0));
        const glm::dvec2 there = glm::floor(glm::clamp(at, glm::dvec2(0.0), size) / std::exp2(level));
        const double value = static_cast<double>(
            LayerPixels::value(texelAt(pixels, level, static_cast<int>(there.x), static_cast<int>(there.y))));
        if (std::isnan(value)) continue;
        const osg::Vec4 entry = table.at(value);
        sum += glm::dvec4(glm::dvec3(entry.r(), entry.g(), entry.b()) * static_cast<double>(entry.a()),
                          entry.a());
        count += 1.0;
    }
    Sample result;
    result.color = glm::dvec4(glm::dvec3(sum) / std::max(sum.a, 1e-6), sum.a / std::max(count, 1.0));
    result.cover = count / how.probes;
    return result;
}

bool MappingEvaluator::coordinates(const ProjectiveMapping& mapping, const Fragment& fragment, glm::dvec2& uv,
                                   glm::dvec2& across, glm::dvec2& up, double& pixels) const
{
    const bool pinhole = mapping.getProjector() == ProjectiveMapping::PINHOLE;
    const osg::Vec2d center = mapping.getCenter();
    const glm::dvec2 o(center.x(), center.y());
    const glm::dvec3 way = fragment.eye - glm::dvec3(o, mapping.getHeight());
    const double metres = std::max(glm::length(way) * _pixel, 1e-9);
    // Of a camera, what its range covers.
    const double halfSize =
        pinhole ? mapping.getCamera().range : std::sqrt(mapping.getU().length() * mapping.getV().length());
    pixels = 2.0 * halfSize / metres;
    if (pinhole)
    {
        // By the textbook: turn into the camera's axes, divide, distort.
        const ProjectiveMapping::Camera c = mapping.getCamera();
        const auto project = [&](const glm::dvec3& position)
        {
            const glm::dvec3 d = position - glm::dvec3(c.eye.x(), c.eye.y(), c.eye.z());
            const double s = std::sin(c.heading), k = std::cos(c.heading);
            const glm::dvec3 turned(k * d.x - s * d.y, s * d.x + k * d.y, d.z); // right, ahead, up
            const double sp = std::sin(c.pitch), kp = std::cos(c.pitch);
            const double ahead = kp * turned.y + sp * turned.z;
            const double above = kp * turned.z - sp * turned.y;
            const double sr = std::sin(c.roll), kr = std::cos(c.roll);
            const glm::dvec2 t = glm::dvec2(kr * turned.x - sr * above, kr * above + sr * turned.x) / ahead;
            const double half = std::tan(c.fieldOfView / 2.0);
            const double r2 = glm::dot(t, t);
            const double radial = 1.0 + c.k1 * r2 + c.k2 * r2 * r2 + c.k3 * r2 * r2 * r2;
            const glm::dvec2 bent(t.x * radial + 2.0 * c.p1 * t.x * t.y + c.p2 * (r2 + 2.0 * t.x * t.x),
                                  t.y * radial + c.p1 * (r2 + 2.0 * t.y * t.y) + 2.0 * c.p2 * t.x * t.y);
            // Beyond the fold of the polynomial there is no picture.
            for (double r = 0.0; r * r < r2; r += 0.01)
            {
                if (1.0 + 3.0 * c.k1 * r * r + 5.0 * c.k2 * std::pow(r, 4.0) + 7.0 * c.k3 * std::pow(r, 6.0) <
                    0.0)
                    return glm::dvec2(-1.0);
            }
            return ahead > 0.0 ? 0.5 + 0.5 * bent / glm::dvec2(half, half / c.aspectRatio) : glm::dvec2(-1.0);
        };
        uv = glm::distance(fragment.position, glm::dvec3(c.eye.x(), c.eye.y(), c.eye.z())) <= c.range
                 ? project(fragment.position)
                 : glm::dvec2(-1.0);
        across = slope(project, fragment.position, fragment.positionAcross);
        up = slope(project, fragment.position, fragment.positionUp);
        return true;
    }
    double scale = 1.0;
    if (mapping.getSizeInPixels() > 0.0)
    {
        scale = std::max(pixels / mapping.getSizeInPixels(), 1.0);
        pixels = std::min(pixels, mapping.getSizeInPixels());
    }
    const glm::dmat3 there = mapping.placeToRaster();
    const auto project = [&](const glm::dvec2& place)
    {
        glm::dvec2 d = (place - o) * scale;
        if (mapping.getTurned())
        {
            // Into axes of which the second one points away from the eye.
            const glm::dvec2 north = glm::normalize(-glm::dvec2(way));
            d = glm::dvec2(d.x * north.y - d.y * north.x, d.x * north.x + d.y * north.y);
        }
        const glm::dvec3 raster = there * glm::dvec3(o + d, 1.0);
        return glm::dvec2(raster) / raster.z;
    };
    uv = project(glm::dvec2(fragment.place));
    across = slope(project, glm::dvec2(fragment.place), glm::dvec2(fragment.across));
    up = slope(project, glm::dvec2(fragment.place), glm::dvec2(fragment.up));
    return true;
}

glm::dvec4 MappingEvaluator::apply(const ProjectiveMapping& mapping, const Fragment& fragment,
                                   const glm::dvec4& scene) const
{
    const ColorTransfer& transfer = *mapping.getTransfer();
    glm::dvec2 uv, across, up;
    double pixels = 0.0;
    coordinates(mapping, fragment, uv, across, up, pixels);
    if (!(uv.x >= 0.0 && uv.y >= 0.0 && uv.x <= 1.0 && uv.y <= 1.0)) return scene;
    if (fragment.place.z < mapping.getLowest() || fragment.place.z > mapping.getHighest()) return scene;

    double strength = mapping.getOpacity();
    if (mapping.getSoftEdges())
    {
        strength *= glsl::geofx_edge(uv.x, std::max(std::abs(across.x), std::abs(up.x))) *
                    glsl::geofx_edge(uv.y, std::max(std::abs(across.y), std::abs(up.y)));
    }
    const double away = glm::distance(fragment.eye, fragment.position);
    if (mapping.getNearest() > 0.0 || mapping.getFarthest() < 5e7)
    {
        strength *= glsl::geofx_ramp(away, mapping.getNearest() * (1.0 - mapping.getSoftness()),
                                     mapping.getNearest());
        strength *= glsl::geofx_ramp(-away, -mapping.getFarthest() * (1.0 + mapping.getSoftness()),
                                     -mapping.getFarthest());
    }
    if (mapping.getPixelsFull() > 0.0)
        strength *= glsl::geofx_ramp(pixels, mapping.getPixelsNone(), mapping.getPixelsFull());
    if (mapping.getSlopeNone() < osg::PI_2)
    {
        const glm::dvec3 normal = glm::normalize(glm::cross(fragment.across, fragment.up));
        strength *= glsl::geofx_ramp(std::abs(normal.z), std::cos(mapping.getSlopeNone()),
                                     std::cos(mapping.getSlopeFull()));
    }
    if (strength <= 0.0) return scene;

    const Layer* layer = layerOf(mapping.getLayer());
    const bool colors = layer && layer->data->getKind() == DataLayer::COLOR;
    Sample found;
    const bool classes = layer && layer->data->getKind() == DataLayer::CLASS;
    const bool coloredClasses = classes && transfer.getSource() == ColorTransfer::TABLE;
    if (coloredClasses)
        found = sampleClasses(*layer, *mapping.getTable(), uv, across, up);
    else if (layer)
        found = sample(*layer, uv, across, up,
                       colors    ? _anisotropy
                       : classes ? 1.0
                                 : std::min(_anisotropy, 4.0));
    if (found.cover <= 0.0) return scene;
    const double low = transfer.getLowValue();
    const double high = transfer.getHighValue();
    const double value = layer && !colors ? found.value : grey(glm::dvec3(found.color));
    const osg::Vec4d given = transfer.getConstant();
    const glm::dvec4 constant(given.x(), given.y(), given.z(), given.w());
    glm::dvec4 source = found.color;
    switch (transfer.getSource())
    {
    case ColorTransfer::LAYER:
        if (layer && !colors)
            source = glm::dvec4(glm::dvec3(glm::clamp((value - low) / (high - low), 0.0, 1.0)), 1.0);
        break;
    case ColorTransfer::TABLE:
    {
        if (coloredClasses) break;
        // As the table has it, without the texels between.
        const bool exact = mapping.getTable()->getMode() == ColorTable::EXACT;
        if (exact && (value < low || value > high)) return scene;
        const osg::Vec4 entry = mapping.getTable()->at(std::clamp(value, low, high));
        const double alpha = colors ? source.a : 1.0;
        source = {entry.r(), entry.g(), entry.b(), static_cast<double>(entry.a()) * alpha};
        break;
    }
    case ColorTransfer::SCENE:
        source = glm::dvec4(glm::dvec3(scene), 1.0);
        break;
    case ColorTransfer::CONSTANT:
        source = glm::dvec4(glm::dvec3(constant), source.a);
        break;
    }
    const ColorTransfer::Matrix matrix = transfer.effectiveMatrix();
    const osg::Vec4d rgb(source.r, source.g, source.b, 1.0);
    const glm::dvec3 changed(matrix[0] * rgb, matrix[1] * rgb, matrix[2] * rgb);
    source = glm::dvec4(glm::clamp(changed, 0.0, 1.0), source.a);
    switch (transfer.getAlpha())
    {
    case ColorTransfer::OPAQUE:
        source.a = 1.0;
        break;
    case ColorTransfer::FROM_SOURCE:
        break;
    case ColorTransfer::FROM_MASK:
    {
        const Layer* mask = layerOf(mapping.getMask());
        const bool maskOfClasses = mask->data->getKind() == DataLayer::CLASS;
        const Sample share = sample(*mask, uv, across, up, maskOfClasses ? 1.0 : std::min(_anisotropy, 4.0));
        const double shown = mask->data->getKind() == DataLayer::COLOR
                                 ? grey(glm::dvec3(share.color)) * share.color.a
                                 : share.value;
        source.a = share.cover * glsl::geofx_ramp(shown, transfer.getRampLow(), transfer.getRampHigh());
        break;
    }
    case ColorTransfer::FROM_RAMP:
        source.a = glsl::geofx_ramp(value, transfer.getRampLow(), transfer.getRampHigh());
        break;
    }
    strength *= found.cover;
    if (transfer.getEquation() == ColorTransfer::DISCARD)
        return strength * source.a >= 0.5 ? glm::dvec4(-1.0) : scene;
    const glm::dvec3 blended = glsl::geofx_blend(transfer.getEquation(), transfer.getSourceFactor(),
                                                 transfer.getDestinationFactor(), source, scene, constant);
    return glm::dvec4(glm::mix(glm::dvec3(scene), blended, strength), scene.a);
}

glm::dvec4 MappingEvaluator::color(const Fragment& fragment, const glm::dvec4& scene) const
{
    glm::dvec4 result = scene;
    for (const ProjectiveMapping* mapping : _mappings)
    {
        result = apply(*mapping, fragment, result);
        if (result.r < 0.0) break;
    }
    return result;
}

} // namespace geofx::test
