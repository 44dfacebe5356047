// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Depth>
#include <osg/Matrixd>
#include <osg/StateSet>

#include <string>

namespace osgGeoFX
{

/** What the application's programs write as depth, for EffectScene::setDepthConvention() and
    CameraEffects::setDepthConvention(). What the kit draws by its own programs gets the same kind of depth, so that both
    hide each other rightly.

    A reversed depth needs no word: each camera's projection tells whether depths fall with the distance.

    @ingroup effect */
struct OSGGEOFX_EXPORT DepthConvention
{
    enum Kind
    {
        /// What the projection makes of a place, be it standard or reversed, with any glClipControl.
        OF_PROJECTION,
        /// z = (log2(max(1e-6, 1 + w)) · F − 1) · w of each vertex, with F = 2 / log2(farDistance + 1).
        LOGARITHMIC,
        /// The depth ½ · log2(max(1e-6, 1 + w)) · F of each fragment. The projection's near and far planes cut what is drawn.
        LOGARITHMIC_BY_FRAGMENT
    };
    Kind kind = OF_PROJECTION;
    /// The distance, metres, at which logarithmic depths reach 1, > 0 and finite. 0, the default: that of the far plane of the
    /// camera's projection, as it is when the scene is culled.
    double farDistance = 0.0;

    /// A sentence that tells why the convention cannot be right, and the remedy; empty where it can.
    std::string fault() const;

    bool operator==(const DepthConvention& other) const
    {
        return kind == other.kind && farDistance == other.farDistance;
    }
    bool operator!=(const DepthConvention& other) const { return !(*this == other); }
};

/** The depths of one camera: which of two is the nearer one, and what shaders have to know. It is the one place that says so;
    shaders/stages/depth.glsl is its other half.

    @ingroup effect */
class OSGGEOFX_EXPORT CameraDepth
{
public:
    CameraDepth() = default;
    /// `projection`: the camera's. Logarithmic depths need a perspective one. With any other, and with a far plane that is not in
    /// front of the eye, the depth is the projection's.
    CameraDepth(const DepthConvention& convention, const osg::Matrixd& projection);

    /// Whether the projection's depth falls with the distance.
    static bool reverses(const osg::Matrixd& projection);

    bool reversed() const { return _reversed; }
    bool logarithmic() const { return _factor > 0.0; }
    /// Whether the projection's near and far planes cut what is drawn.
    bool cutByProjection() const { return !logarithmic() || _byFragment; }
    /// The logarithmic depth in the buffer of a place whose clip coordinate w is this one.
    double logarithmicDepth(double w) const;
    /// The depth of the far plane in the buffer, to which the buffer is cleared: 1, or 0 where it is reversed.
    double farthest() const { return _reversed ? 0.0 : 1.0; }
    /// LEQUAL, or GEQUAL where it is reversed.
    osg::Depth::Function notBehind() const { return _reversed ? osg::Depth::GEQUAL : osg::Depth::LEQUAL; }
    /// The format of depth textures that lose nothing of it. Reversed depths of distant places are near 0, where fixed-point
    /// numbers are too coarse.
    GLenum format() const;

    /// Sets the defines and uniforms that shaders/stages/depth.glsl reads.
    void put(osg::StateSet& state) const;

private:
    bool _reversed = false;
    bool _byFragment = false;
    double _factor = 0.0; ///< F; 0 where depths are not logarithmic
};

} // namespace osgGeoFX
