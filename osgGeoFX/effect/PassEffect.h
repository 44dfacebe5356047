// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ScenePass.h>

namespace osgGeoFX
{

class DrawableCompanion;
class TileListener;

/** An effect that draws parts of the scene again, through a ScenePass. It draws into images of its own and puts
    these into the camera's image, or it draws directly into the camera's image. apps/examples/Outline.h is an
    example.

    @ingroup effect */
class OSGGEOFX_EXPORT PassEffect : public Effect
{
public:
    PassEffect* asPassEffect() override { return this; }
    using Effect::asPassEffect;

    /** Draws the passes of one camera. The scene calls it after the scene itself has been culled. Several cameras'
        threads may call it at once. An effect best keeps data of a camera in a PerCamera. */
    virtual void cull(const ScenePass& pass) = 0;
    /// What to draw with the scene's drawables while they are culled; null, the default, for nothing. The camera's
    /// thread calls this before the scene is culled, and for passes of other effects that draw companions, too
    /// (ScenePass::within()). Each needs an object of its own, which must stay valid until the same cull visitor asks again.
    virtual DrawableCompanion* companion(const ScenePass&) { return nullptr; }
    /// A scene has removed the effect, which lets go of what it has for that scene alone. No camera culls the scene then; frames on
    /// their way may still be drawn. Does nothing by default.
    virtual void forget(const osg::Group& scene);
    /// The listener for tiles that a pager reads; null, the default, for none. EffectScene::listenTo() asks for it.
    virtual osg::ref_ptr<TileListener> tileListener(const Ground&);

protected:
    PassEffect() = default;
    PassEffect(const PassEffect& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    ~PassEffect() override;
};

} // namespace osgGeoFX
