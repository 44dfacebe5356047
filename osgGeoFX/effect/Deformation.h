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

/// A bounding sphere in eye space, metres.
/// @ingroup effect
struct Ball
{
    osg::Vec3d center;
    double radius = 0.0;
};

/// An oriented bounding box in eye space, metres. It may be any parallelepiped.
/// @ingroup effect
struct OSGGEOFX_EXPORT EyeBox
{
    osg::Vec3d center;
    osg::Vec3d half[3]; ///< half axes: from the center to the centers of three faces

    /// A box in eye space. `modelView`: from the frame of `box` to eye space.
    static EyeBox of(const osg::BoundingBox& box, const osg::Matrixd& modelView);
    /// A bounding sphere of the box.
    Ball ball() const;
    /// Replaces the content of `points` with the eight corners.
    void corners(std::vector<osg::Vec3d>& points) const;
};

/// The bound of a deformed box: the convex hull of points in eye space, enlarged by a margin, metres.
/// @ingroup effect
struct Hull
{
    std::vector<osg::Vec3d> points;
    double margin = 0.0;
    /// How far a point of it may lie from the deformed box, metres, beside the margin. The hulls of the box' halves, which have
    /// less of either, may then tell more.
    double slack = 0.0;
};

/** A deformation for one camera and one drawn frame: a function of eye space, and the bounds that culling needs.

    An object is immutable, so every thread may use it. All positions are in eye space, metres.

    @ingroup effect */
class OSGGEOFX_EXPORT DeformationSnapshot : public osg::Referenced
{
public:
    /// The deformed place of a position.
    virtual osg::Vec3d deform(const osg::Vec3d& position) const = 0;
    /// A faster approximation of deform(), for bounds. Its error within a sphere is at most roughness(), metres.
    virtual osg::Vec3d roughly(const osg::Vec3d& position) const { return deform(position); }
    virtual double roughness(const Ball&) const { return 0.0; }
    /// The inverse of deform().
    virtual osg::Vec3d undeform(const osg::Vec3d& position) const = 0;
    /// The deformed normal of a surface. `position` and the unit normal `normal` are those before the deformation.
    virtual osg::Vec3d deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const = 0;
    /// The rotation of a rigid object that stands at a position: a pure rotation, by default the identity.
    virtual osg::Matrixd turn(const osg::Vec3d& position) const;
    /// What becomes of a vector from a thing's reference point, at `position`, to one of its vertices (RigidParts). By default
    /// it turns as turn() says. A projection that makes a picture of its own of all things deforms both ends.
    virtual osg::Vec3d carried(const osg::Vec3d& position, const osg::Vec3d& offset) const;
    /// The style of a position: 0 in the focus, 1 in the context; 0 by default.
    virtual double style(const osg::Vec3d&) const { return 0.0; }

    /// The strongest effect that the function can have within a sphere.
    enum class Reach
    {
        Identity, ///< no position changes
        Affine,   ///< one affine map applies to the whole sphere
        Curved
    };
    virtual Reach reach(const Ball& ball) const = 0;
    /// The largest factor by which a distance within a sphere grows (a Lipschitz constant); at least 1.
    virtual double lipschitz(const Ball& ball) const = 0;
    /// That factor for distances along the ground; at least 1. By default it is lipschitz().
    virtual double groundStretch(const Ball& ball) const { return lipschitz(ball); }
    /// A bounding sphere of a deformed sphere. The default follows from roughly(), roughness(), reach() and
    /// lipschitz(). Override it only for speed.
    virtual Ball bound(const Ball& ball) const;
    /// A hull around a deformed box. The default follows from the same four functions and from sag(). Override it for
    /// speed or for a tighter hull. `hull` receives the result; callers reuse it for speed. `fineness` is that of
    /// DeformationChain::bound().
    virtual void boundBox(const EyeBox& box, Hull& hull, double fineness) const;

    /// How far the image of a straight edge departs from a straight line. Both derivatives are with respect to a
    /// parameter that runs from 0 to 1 along the edge. Linear interpolation between the deformed ends of the edge has
    /// an error of at most `curve / 8 + kink / 4`.
    struct Sag
    {
        double curve = 0.0; ///< bound of the second derivative, metres
        double kink = 0.0;  ///< bound of the jump of the first derivative, metres
        double most = 1e30; ///< bound of the error in any case, metres
    };
    /// The sag of an edge within a sphere. `edge` is the vector between its ends. The default follows from lipschitz().
    virtual Sag sag(const Ball& ball, const osg::Vec3d& edge) const;

    /// A factor for the level of detail of a sphere, beside the one that follows from lipschitz(): 1 (the default)
    /// keeps the detail, 2 doubles it.
    virtual double detail(const Ball&) const { return 1.0; }
    /// The distance, metres, that levels of detail use where distances in eye space do not tell how large things
    /// appear. A plain view shows the content of the sphere equally large at this distance. Empty, the default, where
    /// distances in eye space are right.
    virtual std::optional<double> viewDistance(const Ball&) const { return std::nullopt; }
    /// The longest edge, metres, that a flat mesh within a sphere may have; HUGE_VAL, the default, for no limit. Only
    /// the ends of an edge are deformed, so the edge misses its curved image. The error must not exceed the second
    /// parameter, a share of the distance from the eye.
    virtual double longestEdge(const Ball&, double) const { return HUGE_VAL; }
    /// Whether nothing within a sphere needs to be drawn, although it may lie in the view frustum. What is drawn may
    /// extend beyond the sphere by the second parameter, in normalised device coordinates (x and y, −1…1). False by
    /// default.
    virtual bool hides(const Ball&, const osg::Vec2d&) const { return false; }
    /// The same for a box. Override it where a box allows a better answer than its bounding sphere.
    virtual bool hidesBox(const EyeBox& box, const osg::Vec2d& room) const { return hides(box.ball(), room); }
    /// Whether the ground at a position lies beyond the end of what the deformation shows, in the pictures of all cameras. A
    /// RigidReference that stands there is not drawn. False by default.
    virtual bool isBeyond(const osg::Vec3d&) const { return false; }
    /// Whether the GPU draws nothing of ground within a sphere that belongs to an engine with coarse tiles
    /// (ShaderTexts: GEOFX_HOST_COARSE_TILES). False by default.
    virtual bool isAside(const Ball&) const { return false; }
    /// Whether hides() or complaint() can ever give an answer. Where this is false, culling need not ask them and tests
    /// fewer boxes. True by default.
    virtual bool looksAtBoxes() const { return true; }
    /// The deformed height of a position at `height`, both above the ground's zero height, metres, where the deformation moves
    /// each position along its vertical, by a linear function of its height that never falls. Empty, the default, for other
    /// deformations. Culling derives the horizon of the deformed globe from it, and how far the ground moves.
    virtual std::optional<double> movedHeight([[maybe_unused]] double height) const { return std::nullopt; }
    /// A sentence that tells why something in this box cannot be drawn well; empty where it can. The scene prints it
    /// once, as a warning.
    virtual std::string complaint(const EyeBox&) const { return {}; }

    /// The uniforms of the deformation's shader code. Their names have no prefix. All values must be finite; otherwise
    /// the scene leaves the deformation out for this camera and frame.
    using Uniforms = std::vector<std::pair<std::string, osg::Vec4d>>;
    virtual Uniforms uniforms() const = 0;

protected:
    ~DeformationSnapshot() override;
};

/** An effect that moves the geometry below its scene on the GPU. The movement is a continuous function of eye space.

    To write a new deformation:
    - Put the function into a file in shaders/lib, and list the file in shaders/CMakeLists.txt and
      effect/GlslFunctions.h. The GPU, culling and the tests then run the same text.
    - Derive a class from DeformationSnapshot. It calls this text in double precision and computes bounds.
    - Derive a class from Deformation. It makes the snapshot for a camera, lists its properties, and names the shader
      file with `vec3 SLOT_deform(vec3)`, `vec3 SLOT_normal(vec3 position, vec3 normal)` and
      `float SLOT_style(vec3)`.
    - Add a line to viewer/EffectKinds.cpp.

    Culling, level of detail, near and far planes, picking, serializers, scene files and the tests of all of them
    then work without further code. VerticalExaggeration is an example.

    Several deformations of one scene act one after the other, in the order in which the scene has them.

    @ingroup effect */
class OSGGEOFX_EXPORT Deformation : public Effect
{
public:
    const Deformation* asDeformation() const override { return this; }

    /// The deformation as this camera needs it now; null where it does nothing.
    virtual osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const = 0;

    /// Changes the ground to what it is after this deformation, for the deformations that follow in the scene.
    virtual void changeGround(Ground&) const {}

    /// The longest edge, metres, that a flat mesh of the ground may have anywhere, whichever of the cameras looks;
    /// HUGE_VAL, the default, for no limit. Only the ends of an edge are deformed, so the edge misses its curved image.
    /// The error across the surface must not exceed `tolerance`, a share of the distance from the eye, where nothing folds
    /// and edges climb by at most a quarter of their length; steeper ones are short in any mesh of a ground. Along the
    /// surface, what is drawn on it may move by more. DeformationSnapshot::longestEdge() tells the same for one camera.
    virtual double longestEdge(const CameraRange&, [[maybe_unused]] double tolerance) const
    {
        return HUGE_VAL;
    }
    /// The largest factor by which an edge of the ground grows, for the deformations that follow; 1 by default.
    virtual double mostGrowth(const Ground&) const { return 1.0; }

    /// The vertex shader file. `SLOT_` in it stands for the prefix of its names.
    virtual std::string vertexFile() const = 0;
    /// Whether this file also has `vec3 SLOT_carried(vec3 position, vec3 offset)`, as DeformationSnapshot::carried(). False, the
    /// default, where that leaves the vector as it is.
    virtual bool carriesThings() const { return false; }
    /// The fragment shader file with `vec4 SLOT_restyle(vec4 color, vec4 map, float style)`; empty, the default, for
    /// none.
    virtual std::string fragmentFile() const { return {}; }
    /// The varyings that the vertex shader file declares with `out`; none by default. Some passes draw with a geometry or
    /// a tessellation stage, which copies what is named here. Such a pass cannot draw with a varying that is missing.
    virtual std::vector<Varying> varyings() const { return {}; }
    /// Text that is put before the files, such as constants that are worth compiling in.
    virtual std::string constants() const { return {}; }
    /// Whether it makes a picture of its own of the whole view, from where the camera stands, as bends and panorama maps
    /// do. Two of them do not compose: a camera shows the first one of the scene's list that is switched on. The others are
    /// left out with all that they draw, and a warning says so once.
    virtual bool isProjection() const { return false; }
    /// The least number of cameras, side by side, that draw a whole picture of it; 1 by default. Such cameras draw parts of one
    /// view (ViewGeometry::image).
    virtual unsigned int leastParts() const { return 1; }
    /// The texture unit of a map that the context shows instead of its colors; −1, the default, for none.
    virtual int mapUnit() const { return -1; }

protected:
    Deformation() = default;
    Deformation(const Deformation& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    ~Deformation() override;
};

} // namespace osgGeoFX
