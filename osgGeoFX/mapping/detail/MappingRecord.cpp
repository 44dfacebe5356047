// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/MappingRecord.h>

#include <glm/glm.hpp>
#include <osg/Math>

#include <cmath>
#include <cstring>

namespace osgGeoFX
{

namespace
{

using Texel = TexelArena::Texel;

std::uint32_t bits(double value)
{
    const auto number = static_cast<float>(value);
    std::uint32_t result = 0;
    std::memcpy(&result, &number, sizeof result);
    return result;
}

Texel numbers(double x, double y, double z = 0.0, double w = 0.0)
{
    return {bits(x), bits(y), bits(z), bits(w)};
}

Texel numbers(const osg::Vec4d& v)
{
    return numbers(v.x(), v.y(), v.z(), v.w());
}

/// The bits of a record's flags; stages/mappings.frag.glsl has the same.
enum Flag : std::uint32_t
{
    // The lowest two bits are the layer's kind, 0 for none.
    SMOOTH = 1u << 2u,
    MATRIX = 1u << 3u,
    PROJECTIVE = 1u << 4u,
    PINHOLE = 1u << 5u,
    DISTANCE_FADE = 1u << 6u,
    SIZE_FADE = 1u << 7u,
    SLOPE_FADE = 1u << 8u,
    PIXEL_SIZE = 1u << 9u,
    TURNED = 1u << 10u,
    SOFT_EDGES = 1u << 12u,
    HEIGHTS = 1u << 13u,
    RANGE = 1u << 15u,
    TABLE_CLASSES = 1u << 16u,
    TABLE_EXACT = 1u << 20u
    // From bit 17 on: the mask's kind, and whether it is smooth. From bit 24 on: the channels.
};

std::uint32_t kindBits(const DataLayer& layer)
{
    const auto kind = static_cast<std::uint32_t>(layer.getKind()) + 1u;
    return kind | (layer.getSmooth() && layer.getKind() != DataLayer::CLASS ? SMOOTH : 0u);
}

Texel slot(const PlacedLayer& layer)
{
    int last = 0;
    while (layer.slot.side >> (last + 1))
        ++last;
    const auto pack = [](int low, int high)
    {
        return static_cast<std::uint32_t>(low) | static_cast<std::uint32_t>(high) << 16u;
    };
    return {pack(layer.slot.page, last), pack(layer.slot.x, layer.slot.y), pack(layer.width, layer.height),
            0u};
}

bool usesConstant(const ColorTransfer& transfer)
{
    const auto constant = [](ColorTransfer::Factor factor)
    {
        return factor >= ColorTransfer::CONSTANT_COLOR && factor <= ColorTransfer::ONE_MINUS_CONSTANT_ALPHA;
    };
    return transfer.getSource() == ColorTransfer::CONSTANT || constant(transfer.getSourceFactor()) ||
           constant(transfer.getDestinationFactor());
}

std::uint32_t flagsOf(const ProjectiveMapping& mapping, bool hasLayer, bool hasMask)
{
    const ColorTransfer& transfer = *mapping.getTransfer();
    std::uint32_t flags = hasLayer ? kindBits(*mapping.getLayer()) : 0u;
    const auto set = [&](bool on, Flag flag)
    {
        if (on) flags |= flag;
    };
    const bool pinhole = mapping.getProjector() == ProjectiveMapping::PINHOLE;
    set(pinhole, PINHOLE);
    set(mapping.getNearest() > 0.0 || mapping.getFarthest() < 5e7, DISTANCE_FADE);
    set(mapping.getPixelsFull() > 0.0, SIZE_FADE);
    set(mapping.getSlopeNone() < osg::PI_2, SLOPE_FADE);
    set(mapping.getSizeInPixels() > 0.0 && !pinhole, PIXEL_SIZE);
    set(mapping.getTurned() && !pinhole, TURNED);
    set(mapping.getSoftEdges(), SOFT_EDGES);
    set(mapping.getLowest() > -1e6 || mapping.getHighest() < 1e6, HEIGHTS);
    const bool numbersMatter = hasLayer && mapping.getLayer()->getKind() != DataLayer::COLOR;
    set(usesConstant(transfer) || numbersMatter || transfer.getSource() == ColorTransfer::TABLE ||
            transfer.getAlpha() == ColorTransfer::FROM_RAMP ||
            transfer.getAlpha() == ColorTransfer::FROM_MASK,
        RANGE);
    set(mapping.getTable() && mapping.getTable()->getMode() != ColorTable::LINEAR, TABLE_CLASSES);
    set(mapping.getTable() && mapping.getTable()->getMode() == ColorTable::EXACT, TABLE_EXACT);
    if (hasMask) flags |= kindBits(*mapping.getMask()) << 17u;
    return flags | static_cast<std::uint32_t>(mapping.getChannels()) << 24u;
}

void writeProjector(const ProjectiveMapping& mapping, double opacity, std::uint32_t& flags, Texel* record)
{
    const glm::dmat3 there = mapping.placeToRaster();
    // The place in the middle of the raster, and the projection's part in it.
    const glm::dvec3 middle = glm::inverse(there) * glm::dvec3(0.5, 0.5, 1.0);
    const glm::dvec2 center(middle.x / middle.z, middle.y / middle.z);
    const double scale = (there * glm::dvec3(center, 1.0)).z;
    const glm::dvec2 w(there[0][2] / scale, there[1][2] / scale);
    glm::dvec2 u = glm::dvec2(there[0][0], there[1][0]) / scale - 0.5 * w;
    glm::dvec2 v = glm::dvec2(there[0][1], there[1][1]) / scale - 0.5 * w;
    if (!mapping.getSoftEdges())
    {
        // A margin: a pixel on the edge of two tiles lies within one of them, in spite of the rounding of floats.
        const double size = 1.0 / glm::length(u) + 1.0 / glm::length(v);
        const double rounding = 2.5e-7 * (std::abs(center.x) + std::abs(center.y) + size);
        u /= 1.0 + 2.0 * rounding * glm::length(u);
        v /= 1.0 + 2.0 * rounding * glm::length(v);
    }
    if (w != glm::dvec2(0.0)) flags |= PROJECTIVE;
    record[0] = numbers(u.x, u.y, v.x, v.y);
    record[1] = {bits(center.x), bits(center.y), bits(opacity), 0u};
    record[9] = numbers(w.x, w.y);
}

/// The square of the largest radius of the camera's picture. Up to it the distorted radius grows with the true one,
/// or is well outside of the picture.
double reachOf(const ProjectiveMapping::Camera& camera, double tangentX, double tangentY)
{
    const double outside = 2.0 * std::hypot(tangentX, tangentY);
    constexpr double growth = 1.002;
    double former = 0.0;
    for (double r = 1e-3; r < 100.0; r *= growth)
    {
        const double r2 = r * r;
        const double distorted = r * (1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3)));
        if (distorted <= former || distorted > outside) return r2;
        former = distorted;
    }
    return 1e4;
}

void writePinhole(const ProjectiveMapping::Camera& camera, Texel* record)
{
    const double sinHeading = std::sin(camera.heading), cosHeading = std::cos(camera.heading);
    const double sinPitch = std::sin(camera.pitch), cosPitch = std::cos(camera.pitch);
    const osg::Vec3d forward(sinHeading * cosPitch, cosHeading * cosPitch, sinPitch);
    const osg::Vec3d level(cosHeading, -sinHeading, 0.0);
    const osg::Vec3d upright = level ^ forward;
    const osg::Vec3d right = level * std::cos(camera.roll) - upright * std::sin(camera.roll);
    const osg::Vec3d up = upright * std::cos(camera.roll) + level * std::sin(camera.roll);
    const double tangentX = std::tan(camera.fieldOfView / 2.0);
    const double tangentY = tangentX / camera.aspectRatio;
    record[16] = numbers(osg::Vec4d(camera.eye, camera.range));
    record[17] = numbers(osg::Vec4d(right / tangentX, 0.0));
    record[18] = numbers(osg::Vec4d(up / tangentY, 0.0));
    record[19] = numbers(osg::Vec4d(forward, 0.0));
    record[20] = numbers(camera.k1, camera.k2, camera.k3, reachOf(camera, tangentX, tangentY));
    record[21] = numbers(camera.p1, camera.p2, tangentX, tangentY);
}

} // namespace

std::uint32_t MappingRecord::sizeOf(const ProjectiveMapping& mapping)
{
    return mapping.getProjector() == ProjectiveMapping::PINHOLE ? pinholeTexels : texels;
}

std::uint32_t MappingRecord::featuresOf(const Texel* record)
{
    const std::uint32_t flags = record[1][3];
    const std::uint32_t codes = record[2][3];
    const std::uint32_t source = codes >> 12u & 3u;
    const std::uint32_t alpha = codes >> 14u & 3u;
    constexpr std::uint32_t sourceOverDestination =
        ColorTransfer::SOURCE_ALPHA | ColorTransfer::ONE_MINUS_SOURCE_ALPHA << 4u;
    std::uint32_t result = 0;
    unsigned int bit = 0;
    const auto next = [&](bool needed)
    {
        if (needed) result |= 1u << bit;
        ++bit;
    };
    const bool masked = alpha == ColorTransfer::FROM_MASK;
    const auto ofKind = [&](std::uint32_t kind)
    {
        return (flags & 3u) == kind || (masked && (flags >> 17u & 3u) == kind);
    };
    next(ofKind(1));
    next(ofKind(2));
    next(ofKind(3));
    next(source == ColorTransfer::TABLE);
    next((flags & MATRIX) != 0);
    next(masked);
    next((flags & PROJECTIVE) != 0);
    next((flags & PINHOLE) != 0);
    next((flags & (PIXEL_SIZE | TURNED | DISTANCE_FADE | SIZE_FADE)) != 0);
    next((flags & (DISTANCE_FADE | SIZE_FADE | SLOPE_FADE)) != 0);
    next((flags & HEIGHTS) != 0);
    next((codes & 0xfffu) != sourceOverDestination);
    next((flags & RANGE) != 0);
    const auto coarse = [](std::uint32_t kind)
    {
        return (kind & 7u) == 1u;
    };
    next(coarse(flags) || (masked && coarse(flags >> 17u)));
    next((codes >> 16u & 7u) != 0);
    return result;
}

void MappingRecord::write(const ProjectiveMapping& mapping, const std::optional<PlacedLayer>& layer,
                          const std::optional<PlacedLayer>& mask, int tableRow, const osg::Vec3d& position,
                          Texel* record)
{
    const ColorTransfer& transfer = *mapping.getTransfer();
    std::uint32_t flags = flagsOf(mapping, layer.has_value(), mask.has_value());
    writeProjector(mapping, mapping.getOpacity(), flags, record);
    record[2] = layer ? slot(*layer) : Texel{};
    // A mask takes its place.
    const ColorTransfer::Pattern pattern =
        transfer.getAlpha() == ColorTransfer::FROM_MASK ? ColorTransfer::NONE : transfer.getPattern();
    const auto codes = static_cast<std::uint32_t>(transfer.getSourceFactor()) |
                       static_cast<std::uint32_t>(transfer.getDestinationFactor()) << 4u |
                       static_cast<std::uint32_t>(transfer.getEquation()) << 8u |
                       static_cast<std::uint32_t>(transfer.getSource()) << 12u |
                       static_cast<std::uint32_t>(transfer.getAlpha()) << 14u |
                       static_cast<std::uint32_t>(pattern) << 16u |
                       static_cast<std::uint32_t>(transfer.getPatternIndex()) << 19u;
    record[2][3] = codes;
    record[3] = numbers(mapping.getLowest(), mapping.getHighest(), tableRow + 0.5);
    record[4] = numbers(transfer.getLowValue(), 1.0 / (transfer.getHighValue() - transfer.getLowValue()),
                        transfer.getRampLow(), transfer.getRampHigh());
    const ColorTransfer::Matrix matrix = transfer.effectiveMatrix();
    const ColorTransfer::Matrix identity = {osg::Vec4d(1.0, 0.0, 0.0, 0.0), osg::Vec4d(0.0, 1.0, 0.0, 0.0),
                                            osg::Vec4d(0.0, 0.0, 1.0, 0.0)};
    if (matrix != identity) flags |= MATRIX;
    for (std::size_t row = 0; row < 3; ++row)
        record[5 + row] = numbers(matrix[row]);
    record[8] = numbers(transfer.getConstant());
    const double halfSize = mapping.getProjector() == ProjectiveMapping::PINHOLE
                                ? mapping.getCamera().range
                                : std::sqrt(mapping.getU().length() * mapping.getV().length());
    record[10] = numbers(osg::Vec4d(position, halfSize));
    record[11] = numbers(mapping.getNearest(), mapping.getFarthest(), mapping.getPixelsNone(),
                         mapping.getPixelsFull());
    record[12] = numbers(std::cos(mapping.getSlopeNone()), std::cos(mapping.getSlopeFull()),
                         mapping.getSizeInPixels(), mapping.getSoftness());
    record[13] = mask ? slot(*mask) : Texel{};
    if (pattern != ColorTransfer::NONE)
        record[13] = numbers(transfer.getPatternInterval(), transfer.getPatternWidth(),
                             std::cos(transfer.getPatternAngle()), -std::sin(transfer.getPatternAngle()));
    if (mapping.getProjector() == ProjectiveMapping::PINHOLE) writePinhole(mapping.getCamera(), record);
    record[1][3] = flags;
}

} // namespace osgGeoFX
