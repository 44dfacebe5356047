// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/scene/detail/GroundShell.h>

#include <osg/BoundingSphere>
#include <osg/Matrixd>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** What an undeformed camera would have to see so that nothing is missing in the deformed picture.

    Terrain engines cull by what they know: a projection, a modelview matrix and a view point. This class finds the
    projection and the view point that contain all ground which the deformed picture shows. It starts with blocks of all
    ground (GroundShell), and leaves out what is out of sight. It halves the blocks that reach furthest, until they are small. So the
    result is conservative at any time, and tighter with each step. The result is a pyramid with its tip at the eye, or a box if something behind the
    eye is shown. */
class ProxyFrustum
{
public:
    struct Terrain
    {
        osg::BoundingSphere bound; ///< of the terrain's children, in their frame
        osg::Matrixd modelView;    ///< from that frame to the eye space of the camera
        osg::Matrixd toView;       ///< from there to the view's
        osg::Vec3d up;             ///< in the eye space of the camera
        const Ground& ground;
        /// The tangents of the angles to the picture's left, right, bottom and top, seen from the eye; infinite where there are none.
        std::array<double, 4> picture;
        double movement; ///< how far vertical movements move the ground at most, metres
    };
    /// Whether a box, undeformed, in the view's eye space, is out of sight once it is deformed.
    using OutOfSight = std::function<bool(const EyeBox&)>;

    /// The least and the greatest depth that a box, in the view's eye space, has once it is deformed; any numbers, also infinite ones.
    using DepthsOf = std::function<std::pair<double, double>(const EyeBox&)>;

    /// Whether nothing but vertical movements moves the ground in a box, in the view's eye space.
    using MovesVertically = std::function<bool(const EyeBox&)>;

    ProxyFrustum(const Terrain& terrain, const OutOfSight& outOfSight, const DepthsOf& depthsOf,
                 const MovesVertically& movesVertically);

    /// From the eye space of the camera to clip coordinates.
    const osg::Matrixd& projection() const { return _projection; }
    /// A point above the eye, in the eye space of the camera, from which all that is shown is above the horizon. Empty if no
    /// height is enough, or if there is no ellipsoid.
    const std::optional<osg::Vec3d>& viewPoint() const { return _viewPoint; }

    /// The least and the greatest depth of the deformed ground that is shown, metres; the first one is the greater one where
    /// nothing is.
    std::pair<double, double> depths() const;
    /// How far ahead of the eye this ground lies at most before it is deformed, metres; infinite where no pyramid has it.
    double farthestGround() const;

private:
    static constexpr std::size_t sides = 6;
    static constexpr std::size_t shapes = 3;
    enum : std::size_t
    {
        Own,   ///< a pyramid with sides along those of the picture
        Level, ///< one with level sides
        Box
    };
    using Reach =
        std::array<double, sides>; ///< how far something goes to each side; a larger number is further out
    struct Shape
    {
        osg::Matrixd frame; ///< from the eye space of the camera; −z is forward
        bool parallel = false;
    };
    struct Cell
    {
        GroundShell::Block block;
        EyeBox box;                      ///< in the eye space of the camera
        std::array<Reach, shapes> reach; ///< infinite where a corner does not lie in front of the tip
        double coarseness = 0;           ///< its size over its distance from the eye
        std::array<double, 2>
            depths{}; ///< how far forward and back it goes, deformed; a larger number is further out
    };

    void setShapes();
    void add(const GroundShell::Block& block);
    static Reach reachOf(const Shape& shape, const std::vector<osg::Vec3d>& corners);
    /// Cuts off what vertical movements do not bring into the picture.
    void cutToPicture(Reach& own) const;
    void refine();
    /// By each of several measures, the coarsest one of the cells that reach furthest, if it is not yet fine; the last one first.
    std::vector<std::size_t> worstCells() const;
    Reach reachOf(std::size_t shape) const;
    /// Opened to the picture's own sides. Engines fit to their frustum what they drape, which is then as without effects where
    /// nothing moves.
    Reach withPicture(const Reach& own) const;
    static Reach withRoom(Reach reach);
    osg::Matrixd projectionOf(std::size_t shape, const Reach& most) const;
    void setProjection();
    void setViewPoint();

    const Terrain& _terrain;
    const OutOfSight& _outOfSight;
    const DepthsOf& _depthsOf;
    const MovesVertically& _movesVertically;
    const GroundShell _shell;
    std::array<Shape, shapes> _shapes;
    std::vector<Cell> _cells;
    osg::Matrixd _projection;
    std::optional<osg::Vec3d> _viewPoint;
};

} // namespace osgGeoFX
