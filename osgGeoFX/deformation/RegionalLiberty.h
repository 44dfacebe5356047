// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/effect/NormalTurner.h>

namespace osgGeoFX
{

/** A liberty that painters of panorama maps take with a region: a summit enlarged, a valley widened, a mountain turned a
    little towards the viewer (panorama maps, Sections 1 and 2.1, report it of Berann; the paper has no algorithm).

    **Region.** An ellipse on the ground: a center, half a width across and along its heading, metres. The middle gets the
    whole effect. It fades smoothly towards the border, and outside nothing moves: positions stay the same to the bit.

    **Movements**, in this order: the middle turns about its vertical; widths across and along the heading grow; heights
    above `baseHeight` grow. Each of them, and all together, are one to one for every value that the setters accept, so
    nothing folds. Places of the region stay in the region.

    A scene may have any number of liberties, also of one region. They act in the order of the scene's list, and come
    before a panorama map or a bend. On a globe the ground below a region is a sphere's with the Earth's curvature there,
    exact within 1 m up to 50 km from the center. The GPU places ground within 1e-7 of the region's size. Lighting follows
    the deformed surface. What stands on the ground stays upright, and turns as the ground does. The result does not depend on
    the camera.
    @ingroup deformation */
class OSGGEOFX_EXPORT RegionalLiberty : public Deformation, public NormalTurner
{
public:
    RegionalLiberty() = default;
    RegionalLiberty(const RegionalLiberty& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, RegionalLiberty);

    /// How much of the liberty is taken: from 0, nothing, to 1, the default.
    bool setStrength(double strength) { return assign("strength", strength); }
    double getStrength() const { return _strength; }
    bool isActive() const override { return getEnabled() && _strength > 0.0; }

    /// The center on a projected terrain, metres in its coordinate system, ±5e7. Default: (0, 0).
    bool setCenter(const osg::Vec2d& center)
    {
        return assign({{"centerX", center.x()}, {"centerY", center.y()}});
    }
    osg::Vec2d getCenter() const { return _center.place(); }
    /// The center on a globe, radians. Default: (0, 0).
    bool setGeodeticCenter(double longitude, double latitude)
    {
        return assign({{"longitude", longitude}, {"latitude", latitude}});
    }
    double getLongitude() const { return _center.longitude; }
    double getLatitude() const { return _center.latitude; }
    /// Half the width across the heading, and along it, metres, 10…3e5; 2000 by default.
    bool setRadii(double across, double along) { return assign({{"across", across}, {"along", along}}); }
    double getAcross() const { return _across; }
    double getAlong() const { return _along; }
    /// The direction of the region, clockwise from north (from y on a projected terrain), radians, −2π…2π; 0 by default.
    bool setHeading(double heading) { return assign("heading", heading); }
    double getHeading() const { return _heading; }

    /// The factor of heights in the middle, 0.1…5; 1, the default, changes none.
    bool setEnlarge(double factor) { return assign("enlarge", factor); }
    double getEnlarge() const { return _enlarge; }
    /// The height that stays, metres above the ellipsoid or z = 0, −12 000…12 000; 0 by default.
    bool setBaseHeight(double metres) { return assign("baseHeight", metres); }
    double getBaseHeight() const { return _baseHeight; }
    /// The factor of widths across the heading in the middle, 0.25…2; 1, the default, changes none. What is near the border
    /// gets narrower instead, or wider.
    bool setWiden(double factor) { return assign("widen", factor); }
    double getWiden() const { return _widen; }
    /// The same along the heading.
    bool setLengthen(double factor) { return assign("lengthen", factor); }
    double getLengthen() const { return _lengthen; }
    /// How far the middle turns about its vertical, clockwise seen from above, radians, −π/2…π/2; 0 by default. In a region
    /// that is not a circle it turns along ellipses.
    bool setTurn(double radians) { return assign("turn", radians); }
    double getTurn() const { return _turn; }

    const Properties& properties() const override;
    osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const override;
    void changeGround(Ground& ground) const override;
    double longestEdge(const CameraRange& cameras, double tolerance) const override;
    double mostGrowth(const Ground& ground) const override;
    std::string vertexFile() const override { return "stages/liberty.glsl"; }
    std::string normalFile() const override { return vertexFile(); }
    bool carriesThings() const override { return true; }

protected:
    ~RegionalLiberty() override;

private:
    LocalOrigin _center;
    double _strength = 1.0;
    double _across = 2000.0;
    double _along = 2000.0;
    double _heading = 0.0;
    double _enlarge = 1.0;
    double _baseHeight = 0.0;
    double _widen = 1.0;
    double _lengthen = 1.0;
    double _turn = 0.0;
};

} // namespace osgGeoFX
