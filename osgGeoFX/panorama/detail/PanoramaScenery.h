// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

namespace osgGeoFX
{

/// A panorama map as the effect that draws more than the terrain: the sky behind it, and the picture in the water.
class PanoramaMap::Scenery : public PassEffect
{
public:
    Scenery(const PanoramaMap& map, PanoramaTextures& textures);

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "PanoramaMap::Scenery"; }
    const Properties& properties() const override;

    void cull(const ScenePass& pass) override;
    DrawableCompanion* companion(const ScenePass& pass) override;
    osg::ref_ptr<TileListener> tileListener(const osgGeoFX::Ground& ground) override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~Scenery() override;

private:
    class Cameras;

    const PanoramaMap& _map;
    PanoramaTextures& _textures;
    std::unique_ptr<Cameras> _cameras;
};

} // namespace osgGeoFX
