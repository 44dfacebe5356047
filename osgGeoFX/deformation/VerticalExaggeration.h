// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/NormalTurner.h>

namespace osgGeoFX
{

/** Vertical exaggeration at run time, on projected terrains and on globes.

    Every point moves along the vertical through it: its height above the ellipsoid (above z = 0 on a projected
    terrain) becomes base + factor · (height − base). On a globe the vertical is each point's own. Lighting follows the
    exaggerated surface unless `relight` is off.

    The result does not depend on the camera. Positions are exact within 1e-5 of the viewing distance, heights on the
    Earth's ellipsoid within 1 mm at 9 km, times the factor. In a scene with a bend it stands before it. For collision
    with the ground and for picking, see DeformedView. Not in the papers; users of globes ask for it. */
class OSGGEOFX_EXPORT VerticalExaggeration : public Deformation, public NormalTurner
{
public:
    VerticalExaggeration() = default;
    VerticalExaggeration(const VerticalExaggeration& other,
                         const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, VerticalExaggeration);

    /// 0.01…100; 1, the default, changes nothing.
    bool setFactor(double factor) { return assign("factor", factor); }
    double getFactor() const { return _factor; }
    /// The height that stays as it is, metres; 0 by default.
    bool setBase(double height) { return assign("base", height); }
    double getBase() const { return _base; }
    /// Whether slopes are lit as steep as they look; true by default.
    bool setRelight(bool relight) { return assign("relight", relight ? 1.0 : 0.0); }
    bool getRelight() const { return _relight; }

    const Properties& properties() const override;
    osg::ref_ptr<const DeformationFrame> frame(const ViewGeometry& view) const override;
    void changeGround(Ground& ground) const override;
    std::string vertexFile() const override { return "stages/exaggeration.glsl"; }
    std::string normalFile() const override { return vertexFile(); }

protected:
    ~VerticalExaggeration() override;

private:
    double _factor = 1.0;
    double _base = 0.0;
    bool _relight = true;
};

} // namespace osgGeoFX
