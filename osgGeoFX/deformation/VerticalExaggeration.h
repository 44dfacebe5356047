// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/NormalTurner.h>

namespace osgGeoFX
{

/** Exaggerates heights at run time, on projected terrains and on globes.

    Every point moves along its vertical. Its height above the ellipsoid (above z = 0 on a projected terrain) becomes
    base + factor · (height − base). On a globe each point has its own vertical. Lighting follows the exaggerated
    surface unless `relight` is off.

    The result does not depend on the camera. Positions are exact within 1e-5 of the viewing distance. Heights on the
    Earth's ellipsoid are exact within 1 mm at 9 km, times the factor. If a scene also has a bend, the program adds the
    exaggeration before the bend. Use DeformedView for picking and for collision with the ground. This effect is not in
    the papers. Users of globes ask for it.
    @ingroup deformation */
class OSGGEOFX_EXPORT VerticalExaggeration : public Deformation, public NormalTurner
{
public:
    VerticalExaggeration() = default;
    VerticalExaggeration(const VerticalExaggeration& other,
                         const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, VerticalExaggeration);

    /// The factor, 0.01…100. The default, 1, changes nothing.
    bool setFactor(double factor) { return assign("factor", factor); }
    double getFactor() const { return _factor; }
    /// The height that stays unchanged, metres, −12 000…12 000. Default: 0.
    bool setBaseHeight(double height) { return assign("baseHeight", height); }
    double getBaseHeight() const { return _baseHeight; }
    /// Whether the lighting uses the exaggerated slopes. Default: true.
    bool setRelight(bool relight) { return assign("relight", relight ? 1.0 : 0.0); }
    bool getRelight() const { return _relight; }

    const Properties& properties() const override;
    osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const override;
    void changeGround(Ground& ground) const override;
    double longestEdge(const CameraRange& cameras, double tolerance) const override;
    double mostGrowth(const Ground& ground) const override;
    std::string vertexFile() const override { return "stages/exaggeration.glsl"; }
    std::string normalFile() const override { return vertexFile(); }

protected:
    ~VerticalExaggeration() override;

private:
    double _factor = 1.0;
    double _baseHeight = 0.0;
    bool _relight = true;
};

} // namespace osgGeoFX
