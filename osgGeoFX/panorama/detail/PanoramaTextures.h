// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>
#include <osg/Texture2D>
#include <osg/observer_ptr>
#include <osgGeoFX/panorama/detail/EdgeMap.h>

#include <mutex>
#include <vector>

namespace osgGeoFX
{

class PanoramaMap;

/// The textures that all cameras of a panorama map share. They are made on demand, and again after a change of what
/// they are made of. Any thread may ask.
class PanoramaTextures
{
public:
    PanoramaTextures();

    osg::ref_ptr<osg::Texture2D> palette(const PanoramaMap& map);
    osg::ref_ptr<osg::Texture2D> sky(const PanoramaMap& map);
    osg::ref_ptr<osg::Texture2D> brush();
    /// One texel that says that nothing is known of the ground (shaders/lib/cover.glsl).
    osg::ref_ptr<osg::Texture2D> noCover() { return _noCover; }
    /// Where the terrain below a root ends, with the map's parameters. Null if this is not known.
    osg::ref_ptr<const EdgeMap> edge(const PanoramaMap& map, const osg::Node* root);

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    mutable std::mutex _mutex;
    osg::ref_ptr<osg::Texture2D> _noCover, _palette, _sky, _brush;
    double _paletteSeason = -1.0;
    osg::ref_ptr<const osg::Image> _paletteImage;
    double _skySeason = -1.0;
    int _skySeed = -1;
    osg::ref_ptr<const osg::Image> _skyImage;
    struct TerrainEdge
    {
        osg::observer_ptr<const osg::Node> root;
        bool seaGoesOn;
        int coverUnit;
        osg::ref_ptr<const EdgeMap> map;
    };
    std::vector<TerrainEdge> _edges;
};

} // namespace osgGeoFX
