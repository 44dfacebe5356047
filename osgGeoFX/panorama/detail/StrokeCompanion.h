// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DrawableCompanion.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/StrokeMaker.h>

#include <osg/Texture2D>
#include <osg/observer_ptr>

#include <cstddef>
#include <map>
#include <set>

namespace osgGeoFX
{

/** Draws the strokes of each terrain tile that one camera sees. A tile is a geometry with a texture of its cover at
    PanoramaMap's coverUnit, which may be that of a node above. Other geometries have no strokes. */
class StrokeCompanion final : public DrawableCompanion
{
public:
    /// Starts a frame. False if there is nothing to draw.
    bool begin(const ScenePass& pass, const PanoramaMap& map, StrokeMaker& maker);

    void start() override { _given.clear(); }
    osg::Drawable* companion(osg::Drawable& drawable, const osg::Matrixd& modelView) override;
    osg::StateSet* state() override { return _state; }
    double reach() const override { return _reach; }
    /// For the points, which belong to the tiles. The program belongs to the scene.
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    void forgetGone();

    osg::ref_ptr<osg::StateSet> _state = new osg::StateSet;
    osg::ref_ptr<StrokeMaker> _maker;
    osg::Matrixd _toWorld; ///< from eye space
    unsigned int _coverUnit = 0;
    double _reach = 0.0; ///< pixels from a stroke's foot to its end, at most
    std::map<const osg::Drawable*, osg::observer_ptr<osg::Drawable>> _drawn; ///< all strokes so far
    std::set<const osg::Drawable*> _given; ///< those of the current traversal
    std::size_t _remembered = 0;           ///< how many were alive at the last look
};

} // namespace osgGeoFX
