// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/BoundingBox>
#include <osg/Matrixd>
#include <osg/Referenced>
#include <osg/Vec2d>
#include <osg/Vec3d>
#include <osg/Vec4d>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/// A ball in eye space, metres.
struct Ball
{
    osg::Vec3d centre;
    double radius = 0.0;
};

/// A box in eye space, metres: any parallelepiped.
struct OSGGEOFX_EXPORT EyeBox
{
    osg::Vec3d centre;
    osg::Vec3d half[3]; ///< from the centre to the middle of three faces

    static EyeBox of(const osg::BoundingBox& box, const osg::Matrixd& modelView);
    /// A ball around it.
    Ball ball() const;
    /// Puts its eight corners in the place of what was in there.
    void corners(std::vector<osg::Vec3d>& points) const;
};

/// What a deformed box lies within: the convex hull of points, and a margin around it, metres.
struct Hull
{
    std::vector<osg::Vec3d> points;
    double margin = 0.0;
};

/** A deformation as one camera has it in one frame: a function of eye space, and what culling must know of it.

    Immutable, so every thread may use it. All positions are in eye space, metres. */
class OSGGEOFX_EXPORT DeformationFrame : public osg::Referenced
{
public:
    virtual osg::Vec3d deform(const osg::Vec3d& position) const = 0;
    /// The same for bounds, faster, and off by roughness() at most within a ball.
    virtual osg::Vec3d roughly(const osg::Vec3d& position) const { return deform(position); }
    virtual double roughness(const Ball&) const { return 0.0; }
    /// The inverse of deform().
    virtual osg::Vec3d undeform(const osg::Vec3d& position) const = 0;
    /// What becomes of the unit normal of a surface at a position that has not been deformed.
    virtual osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const = 0;
    /// The turn of what stands at a position and keeps its shape; a pure rotation.
    virtual osg::Matrixd turn(const osg::Vec3d& position) const;
    /// 0 in the focus, 1 in the context.
    virtual double style(const osg::Vec3d&) const { return 0.0; }

    /// What the function does to a ball at most.
    enum class Reach
    {
        Identity, ///< nothing
        Affine,   ///< the same affine map everywhere in it
        Curved
    };
    virtual Reach reach(const Ball& ball) const = 0;
    /// By how much distances within a ball grow at most; at least 1.
    virtual double lipschitz(const Ball& ball) const = 0;
    /// A ball around what becomes of a ball: what follows from the four above. To be overridden for speed alone.
    virtual Ball bound(const Ball& ball) const;
    /// A hull around what becomes of a box: what follows from the four above and sag(). To be overridden for speed and a
    /// tighter hull. `hull` is reused for speed; `fineness` is DeformationChain::bound()'s.
    virtual void boundBox(const EyeBox& box, Hull& hull, double fineness) const;

    /// How far from straight the image of a straight edge within a ball is: a bound of the second derivative along
    /// it, and of the jump of the first, both for the whole edge. Between the ends of an edge, straight
    /// interpolation is off by `curve / 8 + kink / 4` at most.
    struct Sag
    {
        double curve = 0.0; ///< metres
        double kink = 0.0;  ///< metres
        double most = 1e30; ///< metres that it can be off in any case
    };
    /// What follows from lipschitz() unless it is overridden.
    virtual Sag sag(const Ball& ball, const osg::Vec3d& edge) const;

    /// How much more detail a ball deserves, beside what follows from lipschitz(): 1 as much as ever, 2 twice.
    virtual double detail(const Ball&) const { return 1.0; }
    /// Where the picture is not as large as distances in eye space tell: the distance, metres, from which a plain view would
    /// show what is in a ball as large; levels of detail go by it. Nothing where they tell it.
    virtual std::optional<double> viewDistance(const Ball&) const { return std::nullopt; }
    /// How long an edge of a flat mesh in a ball may be, metres: as only its ends are moved, it then misses its curved image by
    /// `tolerance` at most, a share of the distance from the eye.
    virtual double longestEdge(const Ball&, double) const { return HUGE_VAL; }
    /// Whether nothing in a ball is to be drawn, though it may lie in the picture. What is drawn may reach beyond the ball by
    /// `room`, in the picture's x and y (−1…1).
    virtual bool hides(const Ball&, const osg::Vec2d&) const { return false; }
    /// The same of a box; to be overridden where a box tells more.
    virtual bool hidesBox(const EyeBox& box, const osg::Vec2d& room) const { return hides(box.ball(), room); }
    /// Whether hides() or complaint() can ever say anything. False spares culling many boxes, and they are not asked.
    virtual bool looksAtBoxes() const { return true; }
    /// A sentence where something in this box cannot be drawn well; said once by the scene.
    virtual std::string complaint(const EyeBox&) const { return {}; }

    /// The uniforms of the deformation's shader code, by their names without the prefix. All finite.
    using Uniforms = std::vector<std::pair<std::string, osg::Vec4d>>;
    virtual Uniforms uniforms() const = 0;

protected:
    ~DeformationFrame() override;
};

/** An effect that moves the geometry below its scene, on the GPU, as a continuous function of eye space.

    To write a new one:
    - put the function into shaders/lib, where the GPU, the culling and the tests run the same text, and list it in
      shaders/CMakeLists.txt;
    - derive a DeformationFrame, which calls that text in double and bounds it;
    - derive a Deformation, which makes the frame for a camera, lists its properties, and names the shader file with
      `vec3 SLOT_deform(vec3)`, `vec3 SLOT_normal(vec3 position, vec3 normal)` and `float SLOT_style(vec3)`.
    Culling, level of detail, near and far planes, picking, serializers, scene files and the tests of all of them then
    work by themselves. VerticalExaggeration is an example.

    Several deformations in one scene act one after the other, in the order in which the scene has them. */
class OSGGEOFX_EXPORT Deformation : public Effect
{
public:
    const Deformation* asDeformation() const override { return this; }

    /// What it does for this camera; null where it does nothing.
    virtual osg::ref_ptr<const DeformationFrame> frame(const ViewGeometry& view) const = 0;

    /// What the ground is like after this deformation, for those that follow it in the scene.
    virtual void changeGround(Ground&) const {}

    /// The shader file in which `SLOT_` stands for the prefix of its names.
    virtual std::string vertexFile() const = 0;
    /// The file with `vec4 SLOT_restyle(vec4 colour, vec4 map, float style)`; empty where it has none.
    virtual std::string fragmentFile() const { return {}; }
    /// Text that goes before the files: constants that are worth compiling in.
    virtual std::string constants() const { return {}; }
    /// Texture unit of a map that the context shows in place of its colours; −1 for none.
    virtual int mapUnit() const { return -1; }

protected:
    Deformation() = default;
    Deformation(const Deformation& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    ~Deformation() override;
};

} // namespace osgGeoFX
