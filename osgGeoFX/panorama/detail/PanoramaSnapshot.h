// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/GlslFunctions.h>

#include <optional>

namespace osgGeoFX
{

class PanoramaMap;

/// The projection of a panorama map for a camera. Nothing if the camera has no heading or shows nothing.
std::optional<glsl::geofx_Panorama> panoramaOf(const PanoramaMap& map, const ViewGeometry& view);

/// The share of a map in the picture, from its strength: both are 0 and 1 together. The end is slower than the beginning, since
/// the map's own heights and colors change a picture more than the camera's.
inline double shareOf(double strength)
{
    return strength * (1.35 - 0.35 * strength);
}

/// The tree line of a latitude (radians), metres.
inline double treeLineAt(double latitude)
{
    return 0.8 * glsl::geofx_snowLine(latitude);
}

/** The projection of a panorama map for one camera and frame (shaders/lib/panorama.glsl). Immutable. */
class PanoramaSnapshot : public DeformationSnapshot
{
public:
    /// `viewDistance`: at this distance, metres, the camera's own projection would show ground as large as the
    /// picture's base does.
    PanoramaSnapshot(const glsl::geofx_Panorama& view, double viewDistance);

    osg::Vec3d deform(const osg::Vec3d& position) const override;
    osg::Vec3d undeform(const osg::Vec3d& position) const override;
    /// The ground is lit as it lies, undeformed.
    osg::Vec3d deformNormal(const osg::Vec3d&, const osg::Vec3d& normal) const override { return normal; }
    /// A map shows all things in its own projection.
    osg::Vec3d carried(const osg::Vec3d& position, const osg::Vec3d& offset) const override
    {
        return deform(position + offset) - deform(position);
    }
    Reach reach(const Ball&) const override { return Reach::Curved; }
    double lipschitz(const Ball& ball) const override;
    void boundBox(const EyeBox& box, Hull& hull, double fineness) const override;
    Sag sag(const Ball& ball, const osg::Vec3d& edge) const override;
    double longestEdge(const Ball& ball, double tolerance) const override;
    bool hides(const Ball& ball, const osg::Vec2d& room) const override;
    bool isBeyond(const osg::Vec3d& position) const override;
    bool isAside(const Ball& ball) const override;
    bool hidesBox(const EyeBox& box, const osg::Vec2d& room) const override;
    std::optional<double> viewDistance(const Ball& ball) const override;
    std::string complaint(const EyeBox& box) const override;
    Uniforms uniforms() const override;

    const glsl::geofx_Panorama& view() const { return _view; }
    /// The projection for the reflection in still water at a height, metres: what stands `h` above the water stands
    /// `h` below. `detail`: the factor of levels of detail.
    osg::ref_ptr<const PanoramaSnapshot> mirrored(double level, double detail) const;

protected:
    ~PanoramaSnapshot() override;

private:
    /// Whether a ball lies farther around the Earth than anything that the picture shows, and more than 60 degrees of arc
    /// away, where places on the ground no longer tell left from right.
    bool isAroundTheEarth(const Ball& ball, const osg::Vec2d& room) const;
    /// From this distance on, along the ground, nothing is left of a place's height or its way to the side.
    double faded() const;
    struct Extent;
    Extent extentOf(const Ball& ball) const;
    /// The ranges of the places (x, s, height) in a box, metres.
    struct Places
    {
        glm::dvec3 low, high;
        glm::dvec3 bent; ///< by how much they are wider than those of the box' corners
    };
    /// False where places have no such ranges.
    bool placesOf(const EyeBox& box, const Extent& extent, Places& places) const;
    /// The ranges of a picture's x, y and n.
    void pictureOf(const Places& places, glm::dvec3& low, glm::dvec3& high) const;
    double ownStretch(const Extent& extent) const;
    double distanceAround(const Extent& extent) const;
    osg::Vec3d undeformMixed(const osg::Vec3d& position) const;
    double follow(const osg::Vec3d& position, double from, osg::Vec3d& found) const;

    glsl::geofx_Panorama _view;
    double _viewDistance;
};

} // namespace osgGeoFX
