// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Drawable>
#include <osg/Matrixd>
#include <osg/StateSet>

namespace osgGeoFX
{

/// What an effect draws together with a drawable of the scene, wherever the drawable is in sight. Only one thread at a
/// time may use an object.
/// @ingroup effect
class DrawableCompanion
{
public:
    /// Called when a traversal begins.
    virtual void start() {}
    /// What to draw with `drawable`; null for nothing. `modelView`: from the frame of the drawable to eye space.
    virtual osg::Drawable* companion(osg::Drawable& drawable, const osg::Matrixd& modelView) = 0;
    /// The state of the companion. It inherits the effects' uniforms, but nothing of the drawable's own state set.
    virtual osg::StateSet* state() = 0;
    /// Whether companion() gets the matrix of where a drawable stands on the undeformed ground, although it may be drawn
    /// elsewhere as a rigid whole. False by default.
    virtual bool standing() const { return false; }
    /// The largest distance, pixels, by which the companion extends beyond the drawable's own part of the image.
    virtual double reach() const { return 0.0; }

protected:
    ~DrawableCompanion() = default;
};

} // namespace osgGeoFX
