// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

namespace osgGeoFX
{

/// A panorama map as the effect that paints the ground. It has the map's parameters, and is enabled if the map is.
class PanoramaMap::Ground : public SurfaceEffect
{
public:
    Ground(const PanoramaMap& map, PanoramaTextures& textures) : _map(map), _textures(textures) {}

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "PanoramaMap::Ground"; }
    const Properties& properties() const override;

    std::string vertexFile() const override { return "stages/panorama.ground.vert.glsl"; }
    std::string fragmentFile() const override { return "stages/panorama.ground.frag.glsl"; }
    std::vector<Varying> varyings() const override
    {
        return {{"vec3", "place"}, {"vec4", "facing"}, {"vec4", "texels"}};
    }
    bool looksAtNormals() const override { return true; }
    bool repaints() const override { return true; }
    bool fades() const override { return _map.getStrength() < 1.0; }
    bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) override;

protected:
    ~Ground() override;

private:
    const PanoramaMap& _map;
    PanoramaTextures& _textures;
};

} // namespace osgGeoFX
