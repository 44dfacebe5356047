// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/mapping/detail/GpuStore.h>

#include <optional>

namespace osgGeoFX
{

/// The place of a layer on the GPU.
struct PlacedLayer
{
    LayerAtlas::Slot slot;
    int width = 0; ///< of the picture in the slot, texels
    int height = 0;
};

/** One mapping as the GPU has it. shaders/stages/mappings.frag.glsl reads it.

    The texels are: 0 the rows U and V of the projector; 1 its center, opacity, flags; 2 the layer's slot, codes of the
    transfer; 3 heights, the color table's row; 4 value range and ramp; 5-7 the color matrix; 8 the constant; 9 the
    projector's row W; 10 center and half size in the frame; 11 fades by distance and size; 12 fade by slope, size in
    pixels, softness; 13 the mask's slot, or how a pattern is. A pinhole also has: 16 eye and range; 17-19 its axes; 20 radial distortion and
    its reach; 21 tangential distortion and the tangents of the half angles. Numbers are bits of floats, except slots,
    flags and codes. */
class MappingRecord
{
public:
    static constexpr std::uint32_t texels = 14;
    static constexpr std::uint32_t pinholeTexels = 22;

    /// What the shader's code must have for a mapping; one bit for each name, in this order.
    static constexpr const char* features[] = {"COLORS",  "VALUES",     "CLASSES",  "TABLES",  "MATRICES",
                                               "MASKS",   "PROJECTIVE", "PINHOLES", "SYMBOLS", "FADES",
                                               "HEIGHTS", "BLENDS",     "RANGES",   "NEAREST", "PATTERNS"};
    static std::uint32_t featuresOf(const TexelArena::Texel* record);

    /// The number of texels that a mapping needs.
    static std::uint32_t sizeOf(const ProjectiveMapping& mapping);
    /// `position` is the center in the frame. `tableRow` is −1 without a table.
    static void write(const ProjectiveMapping& mapping, const std::optional<PlacedLayer>& layer,
                      const std::optional<PlacedLayer>& mask, int tableRow, const osg::Vec3d& position,
                      TexelArena::Texel* record);
};

} // namespace osgGeoFX
