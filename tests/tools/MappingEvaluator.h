// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/raster/LayerPixels.h>

#include <map>
#include <vector>

namespace geofx::test
{

/** What the fragment stage does, on the CPU and in double: from the mappings themselves, without records, grid, atlas
    or textures. */
class MappingEvaluator
{
public:
    struct Fragment
    {
        glm::dvec3 place, across, up;                    ///< in the mappings' frame, and to the next pixels
        glm::dvec3 position, positionAcross, positionUp; ///< the same of the position
        glm::dvec3 eye;
    };

    /** `pixel` is what a pixel spans at a metre from the eye. With `filtersInBytes`, pictures are filtered as Mesa's
        llvmpipe does it: between two texels, two rows and two levels with weights of 1/256, each time rounded to bytes. In
        double, a stack of pictures that each amplify what is below them is off by more than its rounding. */
    MappingEvaluator(const osgGeoFX::ProjectiveMappings& mappings, double pixel, bool filtersInBytes);

    /// The scene's color under all mappings. Negative red where the fragment is discarded.
    glm::dvec4 color(const Fragment& fragment, const glm::dvec4& scene) const;

private:
    struct Sample
    {
        glm::dvec4 color{1.0};
        double value = 0.0;
        double cover = 1.0;
    };
    struct Layer
    {
        const osgGeoFX::DataLayer* data = nullptr;
        osgGeoFX::LayerPixels pixels;
    };

    const Layer* layerOf(const osgGeoFX::DataLayer* data) const;
    bool coordinates(const osgGeoFX::ProjectiveMapping& mapping, const Fragment& fragment, glm::dvec2& uv,
                     glm::dvec2& across, glm::dvec2& up, double& pixels) const;
    glm::dvec4 apply(const osgGeoFX::ProjectiveMapping& mapping, const Fragment& fragment,
                     const glm::dvec4& scene) const;
    Sample sampleClasses(const Layer& layer, const osgGeoFX::ColorTable& table, const glm::dvec2& uv,
                         const glm::dvec2& across, const glm::dvec2& up) const;
    Sample sample(const Layer& layer, const glm::dvec2& uv, const glm::dvec2& across, const glm::dvec2& up,
                  double mostProbes) const;

    double _pixel;
    double _anisotropy;
    bool _filtersInBytes;
    std::vector<const osgGeoFX::ProjectiveMapping*> _mappings; ///< the lowest first
    std::map<const osgGeoFX::DataLayer*, Layer> _layers;
};

} // namespace geofx::test
