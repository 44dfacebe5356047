// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>

#include <osgGeoFX/panorama/PanoramaBrush.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <osgGeoFX/panorama/PanoramaSky.h>
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <osg/Notify>

#include <algorithm>
#include <deque>

namespace osgGeoFX
{

namespace
{

/// The skies that were painted last, for maps that wish for the same one, and for seasons that come and go. Any thread may
/// call it.
osg::ref_ptr<osg::Image> skyOf(unsigned int seed, double season)
{
    struct Painted
    {
        unsigned int seed;
        double season;
        osg::ref_ptr<osg::Image> image;
    };
    constexpr std::size_t most = 3; // of 4 MiB each
    static std::mutex mutex;
    static std::deque<Painted> shelf;
    const std::lock_guard<std::mutex> lock(mutex);
    for (const Painted& each : shelf)
        if (each.seed == seed && each.season == season) return each.image;
    const osg::ref_ptr<osg::Image> image =
        makeSky(UsualPaintings::SKY_WIDTH, UsualPaintings::SKY_HEIGHT, seed, season);
    shelf.push_front({seed, season, image});
    if (shelf.size() > most) shelf.pop_back();
    return image;
}

osg::ref_ptr<osg::Texture2D> textureOf(osg::Image* image, bool repeatsX, bool repeatsY, bool mipmaps)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER,
                       mipmaps ? osg::Texture::LINEAR_MIPMAP_LINEAR : osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, repeatsX ? osg::Texture::REPEAT : osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, repeatsY ? osg::Texture::REPEAT : osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

} // namespace

PanoramaTextures::PanoramaTextures()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f), 0, 0);
    _noCover = textureOf(image, false, false, false);
    _noCover->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    _noCover->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
}

osg::ref_ptr<osg::Texture2D> PanoramaTextures::palette(const PanoramaMap& map)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_palette && _paletteImage == map.getPalette() && _paletteSeason == map.getSeason()) return _palette;
    _paletteImage = map.getPalette();
    _paletteSeason = map.getSeason();
    osg::ref_ptr<osg::Image> image;
    if (_paletteImage)
    {
        std::string error;
        image = paletteFromImage(*_paletteImage, error);
        if (!image) OSG_WARN << "osgGeoFX: " << error << std::endl;
    }
    if (!image) image = makePalette(_paletteSeason);
    _palette = textureOf(image, false, false, false);
    return _palette;
}

osg::ref_ptr<osg::Texture2D> PanoramaTextures::sky(const PanoramaMap& map)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const bool own = map.getSkyImage() != nullptr;
    if (_sky && _skyImage == map.getSkyImage() &&
        (own || (_skySeason == map.getSeason() && _skySeed == map.getClouds())))
        return _sky;
    _skyImage = map.getSkyImage();
    _skySeason = map.getSeason();
    _skySeed = map.getClouds();
    osg::ref_ptr<osg::Image> image;
    if (own)
        image = const_cast<osg::Image*>(map.getSkyImage());
    else
        image = skyOf(static_cast<unsigned int>(_skySeed), _skySeason);
    _sky = textureOf(image, true, false, true);
    return _sky;
}

osg::ref_ptr<osg::Texture2D> PanoramaTextures::brush()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!_brush)
    {
        const osg::ref_ptr<osg::Image> image = makeBrushTexture();
        _brush = textureOf(image, true, true, true);
    }
    return _brush;
}

osg::ref_ptr<const EdgeMap> PanoramaTextures::edge(const PanoramaMap& map, const osg::Node* root)
{
    if (!root) return nullptr;
    const bool seaGoesOn = map.getEdge() != PanoramaMap::HAZE;
    const std::lock_guard<std::mutex> lock(_mutex);
    // Those of deleted terrains, and of former choices.
    const auto stale = [&](const TerrainEdge& each)
    {
        return !each.root.valid() || each.seaGoesOn != seaGoesOn || each.coverUnit != map.getCoverUnit();
    };
    _edges.erase(std::remove_if(_edges.begin(), _edges.end(), stale), _edges.end());
    for (const TerrainEdge& each : _edges)
        if (each.root.get() == root) return each.map;
    std::string error;
    const std::optional<TerrainInfo> info = TerrainInfo::read(root, error);
    osg::ref_ptr<const EdgeMap> made;
    if (info) made = EdgeMap::make(*root, *info, static_cast<unsigned int>(map.getCoverUnit()), seaGoesOn);
    _edges.push_back({root, seaGoesOn, map.getCoverUnit(), made});
    return made;
}

void PanoramaTextures::resizeGLObjectBuffers(unsigned int size)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& texture : {_noCover, _palette, _sky, _brush})
        osg::resizeGLObjectBuffers(texture, size);
}

void PanoramaTextures::releaseGLObjects(osg::State* state) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& texture : {_noCover, _palette, _sky, _brush})
    {
        if (texture) texture->releaseGLObjects(state);
    }
    for (const TerrainEdge& each : _edges)
        if (each.map && each.map->texture()) each.map->texture()->releaseGLObjects(state);
}

} // namespace osgGeoFX
