// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/Tessellation.h>

#include <optional>

namespace osgGeoFX
{

/// The position of a bend for one camera, metres and radians. Lengths are measured in the reference plane T, from the
/// point of T below the eye.
/// @ingroup deformation
struct OSGGEOFX_EXPORT BendPlacement
{
    double planeHeight = 0.0; ///< height of the eye above T
    double start = 0.0;       ///< s_b: the line b, where the transition zone begins
    double size = 0.0;        ///< d: the width of the transition zone
    double angle = 0.0;       ///< β: positive if the ground bends up
};

/** Base class of the multi-perspective views. The terrain bends along a straight line across the view.

    Lorenz, Trapp, Döllner, Jobst: "Interactive Multi-Perspective Views of Virtual 3D Landscape and City Models"
    (2008), Section 4. The reference plane T is horizontal. On a globe it is parallel to the tangent plane of the
    ellipsoid below the eye. The focus lies in front of the line b, and nothing moves there. The transition zone lies
    behind b. The context lies behind the zone and moves as one rigid piece.

    The zone has one of three curves: "bezier" is the paper's, with the parameter t = s/d. "arcLength", the default, is
    the same curve, but equal lengths of ground have equal lengths on it. "circularArc" preserves lengths on T.

    An object on the inner side of the curve folds over if its height above T (below T, where the ground bends down)
    reaches the curve's radius. `tallest` prevents this: PedestrianView widens the zone, and BirdsEyeView reduces the
    bend angle. Light and shadows are computed on the undeformed terrain.

    **Styles.** Each fragment has a style value q, from 0 in the focus to 1 in the context. By q, and in this order, are blended:
    a map (`mapUnit`, `coverMap`), which replaces the ground's own colors in the context, or in the focus (`mapPlace`);
    buildings into plain blocks (`contextBlocks`); saturation and brightness. On the side of the map, buildings are blocks, too. All of
    them may act at once. What stands behind the bend in the scene's list, such as the mappings of a route, keeps
    its colors everywhere. Where a camera has no bend, it has no styles.
    @ingroup deformation */
class OSGGEOFX_EXPORT PerspectiveBend : public Deformation, public Tessellator
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
        GROUND, ///< planeHeight is the height of T above the ellipsoid or map zero
        EYE     ///< planeHeight is the height of T above the eye, so it is negative
    };

    enum MapPlace
    {
        CONTEXT, ///< a map behind a photo
        FOCUS    ///< a photo behind a map
    };

    /// The curve of the transition zone. Default: ARC_LENGTH.
    bool setCurve(Curve curve) { return assign("curve", curve); }
    Curve getCurve() const { return static_cast<Curve>(_curve); }
    /// Raises the reference plane (paper, Section 3), metres, −12 000…1e7. Default: 0.
    bool setPlaneHeight(double metres) { return assign("planeHeight", metres); }
    double getPlaneHeight() const { return _planeHeight; }
    /// The level from which planeHeight is measured. Default: GROUND.
    bool setPlaneReference(PlaneReference reference) { return assign("planeReference", reference); }
    PlaneReference getPlaneReference() const { return static_cast<PlaneReference>(_planeReference); }
    /// Largest distance from T, metres, of an object on the inner side of the bend: above T where the ground bends up,
    /// below T where it bends down. −1…1e6. The default, −1, takes the distance from the database.
    bool setTallest(double metres) { return assign("tallest", metres); }
    double getTallest() const { return _tallest; }

    /// Factor by which the level of detail is finer in the transition zone (paper, Section 4), 1…16. Default: 2.
    bool setTransitionDetail(double factor) { return assign("transitionDetail", factor); }
    double getTransitionDetail() const { return _transitionDetail; }
    /// The same factor for the context, 0.1…16. A value below 1 loads less from the disk. Default: 1.
    bool setContextDetail(double factor) { return assign("contextDetail", factor); }
    double getContextDetail() const { return _contextDetail; }

    /// Whether the GPU divides the triangles of the transition zone, so that a coarse mesh is drawn as the curve that it lies on, where
    /// OpenGL 4 with the compatibility profile is at hand. Tiles are then refined for the curve's sake only where 15 parts of an edge
    /// are not enough. Default: false. What has a program of its own, rigid things, and what effects draw again (close-ups) keep their
    /// triangles. Of several graphics contexts all must have OpenGL 4; else finer levels are drawn, as without. The first frame of a
    /// context is drawn without.
    bool setTessellation(bool on) { return assign("tessellation", on ? 1.0 : 0.0); }
    bool getTessellation() const { return _tessellation; }
    /// How far a divided triangle may be from the curve, pixels, 0.1…16. Default: 0.5. An edge has 15 parts at most.
    bool setTessellationPixels(double pixels) { return assign("tessellationPixels", pixels); }
    double getTessellationPixels() const { return _tessellationPixels; }

    /// Saturation of the context, 0…2: 0 is grey and 1, the default, leaves it unchanged.
    bool setContextSaturation(double factor) { return assign("contextSaturation", factor); }
    double getContextSaturation() const { return _contextSaturation; }
    /// Brightness of the context, 0…2: 0 is black and 1, the default, leaves it unchanged.
    bool setContextBrightness(double factor) { return assign("contextBrightness", factor); }
    double getContextBrightness() const { return _contextBrightness; }
    /// How far buildings lose windows and colors in the context, 0, the default, to 1: plain blocks in the light. Buildings are
    /// things with references of their own (RigidParts) that have no program.
    bool setContextBlocks(double share) { return assign("contextBlocks", share); }
    double getContextBlocks() const { return _contextBlocks; }
    /// Saturation of the focus, 0…2: 0 is grey and 1, the default, leaves it unchanged.
    bool setFocusSaturation(double factor) { return assign("focusSaturation", factor); }
    double getFocusSaturation() const { return _focusSaturation; }
    /// Brightness of the focus, 0…2: 0 is black and 1, the default, leaves it unchanged.
    bool setFocusBrightness(double factor) { return assign("focusBrightness", factor); }
    double getFocusBrightness() const { return _focusBrightness; }
    /// Whether the map is made of what tiles say of the ground (shaders/lib/cover.glsl): water, woods, towns, in their light. Ground
    /// that has a texture on mapUnit shows that one. Default: false.
    bool setCoverMap(bool on) { return assign("coverMap", on ? 1.0 : 0.0); }
    bool getCoverMap() const { return _coverMap; }
    /// Where the map is shown. Default: CONTEXT.
    bool setMapPlace(MapPlace place) { return assign("mapPlace", place); }
    MapPlace getMapPlace() const { return static_cast<MapPlace>(_mapPlace); }
    /// Texture unit of a map that the context shows, or the focus, 0…3. The default, −1, means no map.
    bool setMapUnit(int unit) { return assign("mapUnit", unit); }
    int getMapUnit() const { return _mapUnit; }

    /// Whether lines on the ground show where the transition zone begins (amber) and ends (blue). Default: false.
    bool setZoneLines(bool on) { return assign("zoneLines", on ? 1.0 : 0.0); }
    bool getZoneLines() const { return _zoneLines; }

    /// The placement of the bend for this camera. Empty if there is no bend.
    std::optional<BendPlacement> placement(const ViewGeometry& view) const
    {
        return placementOf(getCurve(), view);
    }
    /// The same for a given curve, which may differ from this view's own curve.
    virtual std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const = 0;

    /// The largest curvature, 1/metre, that the bend has for any of the cameras. The default is that at which the ground
    /// would fold.
    virtual double mostCurvatureOf(Curve curve, const CameraRange& cameras) const;
    /// The largest distance of the ground from T, as a share of the radius of a bend with this curvature, 1/metre; 0.3 if
    /// the heights or the level of T are not known.
    virtual double heightShare(const Ground& ground, double curvature) const;

    osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const override;
    double longestEdge(const CameraRange& cameras, double tolerance) const override;
    double mostGrowth(const Ground& ground) const override;
    bool isProjection() const override { return true; }
    std::string vertexFile() const override { return "stages/bendview.glsl"; }
    bool carriesThings() const override { return true; }
    std::string tessellationFile() const override { return "stages/bendview.sag.glsl"; }
    bool wantsTessellation() const override { return _tessellation; }
    /// Empty if focus and context have no styles.
    std::string fragmentFile() const override;
    std::string constants() const override;
    std::vector<Varying> varyings() const override;
    int mapUnit() const override { return _mapUnit; }

protected:
    PerspectiveBend() = default;
    PerspectiveBend(const PerspectiveBend& other, const osg::CopyOp& copy);
    ~PerspectiveBend() override;

    static Properties bendProperties();
    /// The height of the eye above T, metres.
    virtual double planeHeight(const ViewGeometry& view) const;
    /// The height of T above the ellipsoid or map zero, metres.
    double planeLevel(const ViewGeometry& view) const;
    /// The largest curvature, 1/metre, at which nothing folds over in a bend with the sign of `angle`. `reach` is a
    /// distance on T from the eye, metres: on a globe the ground falls away below T within it.
    double mostCurvature(const ViewGeometry& view, double angle, double reach) const;
    /// The curvature at which the ground would fold in a bend with the sign of `angle`, with the margin that bends keep.
    double foldCurvature(const Ground& ground, double angle) const;
    /// The least height above T, metres, of the cameras' eyes.
    double leastPlaneHeight(const CameraRange& cameras) const;
    /// The direction D of the view in T, in eye space. Its length falls from 1 to 0 as the camera's roll approaches
    /// 90°.
    static osg::Vec3d heading(const ViewGeometry& view);

private:
    int _curve = ARC_LENGTH;
    double _planeHeight = 0.0;
    int _planeReference = GROUND;
    double _tallest = -1.0;
    double _transitionDetail = 2.0;
    double _contextDetail = 1.0;
    bool _tessellation = false;
    double _tessellationPixels = 0.5;
    double _contextSaturation = 1.0;
    double _contextBrightness = 1.0;
    double _contextBlocks = 0.0;
    double _focusSaturation = 1.0;
    double _focusBrightness = 1.0;
    int _mapUnit = -1;
    bool _coverMap = false;
    int _mapPlace = CONTEXT;
    bool _zoneLines = false;
};

} // namespace osgGeoFX
