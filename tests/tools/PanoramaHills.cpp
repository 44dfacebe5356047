// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/PanoramaHills.h>

#include <tools/StrokeTiles.h>

#include <algorithm>
#include <cmath>

namespace geofx::test
{

namespace
{

constexpr double longitude = 0.4;
constexpr double halfSide = 40000.0;
constexpr double earth = 6378137.0;
constexpr double lakeRadius = 6000.0;
constexpr unsigned int coverUnit = 7;

double lakeDistance(double x, double y)
{
    return lakeRadius - std::hypot(x + 12000.0, y + 5000.0);
}

/// Of metres about the middle.
double heightAt(double x, double y)
{
    const double wave = std::sin(x / 7000.0) * std::sin(y / 6000.0);
    // The lake lies level, in a shore that rises gently.
    return 1500.0 * wave * wave * std::clamp(-lakeDistance(x, y) / 4000.0, 0.0, 1.0);
}

osgGeoFX::glsl::geofx_Cover coverAt(double x, double y)
{
    osgGeoFX::glsl::geofx_Cover cover{};
    cover.trees = x > 0.0 ? 0.8 : 0.1;
    cover.town = std::hypot(x - 3000.0, y + 9000.0) < 2500.0 ? 0.9 : 0.0;
    cover.shore = lakeDistance(x, y);
    return cover;
}

} // namespace

osg::ref_ptr<osg::CoordinateSystemNode> PanoramaHills::terrain() const
{
    StrokeTiles tiles;
    osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
    const double up = latitude.value_or(0.0);
    const double perX = latitude ? earth * std::cos(up) : 1.0;
    const double perY = latitude ? earth : 1.0;
    const double east = latitude ? longitude : 0.0;
    if (latitude) root->setEllipsoidModel(tiles.ellipsoid = new osg::EllipsoidModel);
    tiles.cells = 80;
    tiles.height = [=](double x, double y)
    {
        return heightAt((x - east) * perX, (y - up) * perY);
    };
    tiles.cover = [=](double x, double y)
    {
        return coverAt((x - east) * perX, (y - up) * perY);
    };
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(east - halfSide / perX, up - halfSide / perY,
                                                               east + halfSide / perX, up + halfSide / perY);
    auto* cover = StrokeTiles::geometryOf(*tile).getStateSet()->getTextureAttribute(
        coverUnit, osg::StateAttribute::TEXTURE);
    static_cast<osg::Texture2D*>(cover)->setResizeNonPowerOfTwoHint(false);
    root->addChild(tile);
    return root;
}

osg::Vec3d PanoramaHills::middle() const
{
    osg::Vec3d place;
    const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    if (latitude)
        globe->convertLatLongHeightToXYZ(*latitude, longitude, 0.0, place.x(), place.y(), place.z());
    return place;
}

} // namespace geofx::test
