// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>

#include <optional>

namespace osgGeoFX
{

/// Where a bend lies before one camera, metres and radians; lengths in the reference plane T from the eye's foot.
struct OSGGEOFX_EXPORT BendPlacement
{
    double planeHeight = 0.0; ///< of the eye above T
    double start = 0.0;       ///< s_b, the line b
    double size = 0.0;        ///< d, the width of the transition zone
    double angle = 0.0;       ///< β, positive upwards
};

/** What the multi-perspective views have in common: the terrain bends along a straight line across the view.

    Lorenz, Trapp, Döllner, Jobst: "Interactive Multi-Perspective Views of Virtual 3D Landscape and City Models" (2008),
    Section 4. The reference plane T is horizontal (on a globe it touches the ellipsoid below the eye). Before the line b
    lies the focus, where nothing moves. Behind the transition zone lies the context, which moves as one rigid piece.

    The curve of the zone: "bezier" (the paper's, parameter t = s/d), "arcLength" (the same curve, along which equal
    ground takes equal length; the default), or "circularArc" (which keeps lengths on T). Light and shadows are those
    of the terrain as it is. Things that stand on the inner side of the curve must be lower than its radius, or they would
    fold over: the zone is widened as far as `tallest` needs.

    Styles: a fragment has a value q, 0 in the focus and 1 in the context; the context's saturation and brightness
    apply by q, and so does a map from texture unit `mapUnit` in the place of the ground's own colours. */
class OSGGEOFX_EXPORT PerspectiveBend : public Deformation
{
public:
    enum Curve
    {
        BEZIER,
        ARC_LENGTH,
        CIRCULAR_ARC
    };
    enum PlaneReference
    {
        GROUND, ///< planeElevation is the height of T above the ellipsoid or map zero
        EYE     ///< planeElevation is the height of T above the eye, so negative
    };

    bool setCurve(Curve curve) { return assign("curve", curve); }
    Curve getCurve() const { return static_cast<Curve>(_curve); }
    /// The raised reference plane (paper, Section 3), metres, −12 000…1e7; 0 by default.
    bool setPlaneElevation(double metres) { return assign("planeElevation", metres); }
    double getPlaneElevation() const { return _planeElevation; }
    bool setPlaneReference(PlaneReference reference) { return assign("planeReference", reference); }
    PlaneReference getPlaneReference() const { return static_cast<PlaneReference>(_planeReference); }
    /// Height above T of the tallest thing in the zone, metres; −1, the default, takes it from the database.
    bool setTallest(double metres) { return assign("tallest", metres); }
    double getTallest() const { return _tallest; }

    /// How much finer the level of detail is in the transition zone (paper, Section 4); 1…16, 2 by default.
    bool setTransitionDetail(double factor) { return assign("transitionDetail", factor); }
    double getTransitionDetail() const { return _transitionDetail; }
    /// The same for the context; 0.1…16, 1 by default. Less than 1 spares the disk.
    bool setContextDetail(double factor) { return assign("contextDetail", factor); }
    double getContextDetail() const { return _contextDetail; }

    /// 0 grey, 1 (the default) as it is, up to 2.
    bool setContextSaturation(double factor) { return assign("contextSaturation", factor); }
    double getContextSaturation() const { return _contextSaturation; }
    /// 0 black, 1 (the default) as it is, up to 2.
    bool setContextBrightness(double factor) { return assign("contextBrightness", factor); }
    double getContextBrightness() const { return _contextBrightness; }
    /// Texture unit of a map that the context shows, 0…3; −1, the default, for none.
    bool setMapUnit(int unit) { return assign("mapUnit", unit); }
    int getMapUnit() const { return _mapUnit; }

    /// Where the bend lies for this camera; nothing where there is none.
    std::optional<BendPlacement> placement(const ViewGeometry& view) const
    {
        return placementOf(getCurve(), view);
    }
    /// The same with a curve that need not be its own.
    virtual std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const = 0;

    osg::ref_ptr<const DeformationFrame> frame(const ViewGeometry& view) const override;
    std::string vertexFile() const override { return "stages/bendview.glsl"; }
    /// None where the context looks like the focus.
    std::string fragmentFile() const override;
    std::string constants() const override;
    int mapUnit() const override { return _mapUnit; }

protected:
    PerspectiveBend() = default;
    PerspectiveBend(const PerspectiveBend& other, const osg::CopyOp& copy);
    ~PerspectiveBend() override;

    static Properties bendProperties();
    /// Height of the eye above T.
    double planeHeight(const ViewGeometry& view) const;
    /// T's height above the ground's zero.
    double planeLevel(const ViewGeometry& view) const;
    /// The largest curvature that a bend of this kind may have above or below T, 1/metre.
    double mostCurvature(const ViewGeometry& view, double angle, double reach) const;
    /// Direction D: across the view, in T; its length falls from 1 to 0 where the camera's roll nears 90°.
    static osg::Vec3d heading(const ViewGeometry& view);

private:
    int _curve = ARC_LENGTH;
    double _planeElevation = 0.0;
    int _planeReference = GROUND;
    double _tallest = -1.0;
    double _transitionDetail = 2.0;
    double _contextDetail = 1.0;
    double _contextSaturation = 1.0;
    double _contextBrightness = 1.0;
    int _mapUnit = -1;
};

} // namespace osgGeoFX
