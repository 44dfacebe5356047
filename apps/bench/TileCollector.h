// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "BenchError.h"
#include "OffscreenView.h"

#include <osg/Camera>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/Matrixd>
#include <osgUtil/RenderBin>

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Scene.h>

#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace geofx::bench
{

/// Takes down what a camera is about to draw.
class TileCollector : public osg::Camera::DrawCallback
{
public:
    /// Which drawables; all if empty.
    using Filter = std::function<bool(const osg::Drawable&)>;

    /// What the next frame of a view draws of a scene; never empty, for that throws BenchError.
    static osg::ref_ptr<osg::Group> collect(OffscreenView& view, const osg::Node& scene,
                                            const Filter& filter = {});

    TileCollector(const osg::Node& scene, Filter filter) : _scene(scene), _filter(std::move(filter)) {}

    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo& info) const override;

    /// The meshes, each below a transform, and these below the database's state without its levels of detail.
    mutable osg::ref_ptr<osg::Group> tiles = new osg::Group;

private:
    void add(const osgUtil::RenderBin& bin, const osg::Matrixd& toWorld) const;
    osg::Group& below(const std::vector<osg::StateSet*>& states) const;

    const osg::Node& _scene;
    const Filter _filter;
    mutable std::map<std::pair<const osg::Group*, const osg::StateSet*>, osg::Group*> _groups;
};

/// Collected tiles below an effect, as the scene has them: its coordinate system above them, which a scene without one would
/// look for in each frame.
osg::ref_ptr<osgGeoFX::EffectScene> deformedTiles(const osgGeoFX::Scene& scene, osgGeoFX::Effect& effect,
                                                  osg::Group& tiles);

/// The view matrix from which OSG's own camera sees all of them, from straight above.
osg::Matrixd viewOfAll(const osgGeoFX::Scene& scene, const osg::Group& tiles, double fieldOfView);

} // namespace geofx::bench
