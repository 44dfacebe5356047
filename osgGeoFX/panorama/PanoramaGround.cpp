// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaGround.h>

#include <osgGeoFX/panorama/PanoramaFrame.h>

#include <cmath>

namespace osgGeoFX
{

namespace
{

void set(osg::StateSet& state, const std::string& name, const osg::Vec4d& value)
{
    state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
}

osg::Vec3d toOsg(const glm::dvec3& vector)
{
    return {vector.x, vector.y, vector.z};
}

/// One texel that says that nothing is known (shaders/lib/cover.glsl).
osg::ref_ptr<osg::Texture2D> noCover()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f), 0, 0);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    return texture;
}

} // namespace

PanoramaMap::Ground::Ground(const PanoramaMap& map) : _map(map), _noCover(noCover()) {}

PanoramaMap::Ground::~Ground() = default;

const Properties& PanoramaMap::Ground::properties() const
{
    static const Properties none;
    return none;
}

bool PanoramaMap::Ground::fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view)
{
    const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(_map, view.geometry);
    if (!panorama) return false;
    if (!_map.getProjection())
    {
        const osg::ref_ptr<const PanoramaFrame> frame = new PanoramaFrame(*panorama, 1.0);
        for (const auto& [name, value] : frame->uniforms())
            set(state, prefix + name, value);
    }
    // Light from the upper left of the picture, whatever the heading.
    const double azimuth = -0.9, elevation = 0.6;
    const osg::Vec3d right = toOsg(panorama->right), forward = toOsg(panorama->forward);
    const osg::Vec3d up = view.geometry.up;
    const osg::Vec3d light = (right * std::sin(azimuth) + forward * std::cos(azimuth)) * std::cos(elevation) +
                             up * std::sin(elevation);
    set(state, prefix + "light", {light, 2.0});
    if (state.getTextureAttribute(7, osg::StateAttribute::TEXTURE) != _noCover)
    {
        state.setTextureAttribute(7, _noCover);
        state.getOrCreateUniform(prefix + "cover", osg::Uniform::SAMPLER_2D)->set(7);
    }
    return true;
}

} // namespace osgGeoFX
