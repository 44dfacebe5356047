// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/PlacePicture.h>

#include <osgGeoFX/closeup/LiftedPlaces.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

osg::Vec2d pictureOf(const osg::Vec3d& eye, const osg::Matrixd& projection)
{
    const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * projection;
    return {clip.x() / clip.w(), clip.y() / clip.w()};
}

bool isPerspective(const osg::Matrixd& projection)
{
    return projection(3, 3) == 0.0;
}

/// The eye space's z of a depth in the buffer.
double zOf(double depth, const DepthPicture& picture, const CameraDepth& kind)
{
    // 1 + w is 2 to the power of the depth over that of w = 1.
    if (kind.logarithmic()) return 1.0 - std::exp2(depth / kind.logarithmicDepth(1.0));
    const osg::Matrixd& p = picture.projection;
    const double clip = picture.zeroToOne ? depth : 2.0 * depth - 1.0;
    return (p(3, 2) - clip * p(3, 3)) / (clip * p(2, 3) - p(2, 2));
}

} // namespace

PlacePicture::PlacePicture(EffectScene& scene, const osg::Camera& camera,
                           const std::vector<std::shared_ptr<const DepthPicture>>& depths,
                           const Georeference& reference)
    : PlacePicture(scene, camera, depths)
{
    _reference = &reference;
}

PlacePicture::PlacePicture(EffectScene& scene, const osg::Camera& camera,
                           const std::vector<std::shared_ptr<const DepthPicture>>& depths)
    : _width(camera.getViewport() ? static_cast<int>(camera.getViewport()->width()) : 0),
      _height(camera.getViewport() ? static_cast<int>(camera.getViewport()->height()) : 0)
{
    const DeformedView view(scene, camera);
    _toWorld.invert(view.modelView());
    const osg::Matrixd& whole = camera.getProjectionMatrix();
    const osg::NodePathList paths = scene.getTerrain()->getParentalNodePaths();
    const osg::NodePath above = paths.empty() ? osg::NodePath() : paths.front();
    const bool columns = scene.leastParts() > 1;
    for (const std::shared_ptr<const DepthPicture>& picture : depths)
    {
        if (!picture || picture->depths.empty()) continue;
        Part part;
        part.picture = picture;
        part.depth = CameraDepth(picture->convention, picture->projection);
        part.inverse.invert(picture->projection);
        const auto corner = [&](double side)
        {
            osg::Vec3d origin, direction;
            ViewGeometry::ray(picture->projection, part.inverse, side, side, origin, direction);
            return pictureOf(origin + direction, whole);
        };
        const osg::Vec2d low = corner(-1.0), high = corner(1.0);
        part.chain = &view.chain();
        if (columns)
            part.chain = scene.deformationOfColumn(view.modelView(), whole, low.x(), high.x(), above);
        part.low.set(0.5 * (low.x() + 1.0) * _width, 0.5 * (low.y() + 1.0) * _height);
        part.high.set(0.5 * (high.x() + 1.0) * _width, 0.5 * (high.y() + 1.0) * _height);
        if (part.high.x() > part.low.x() && part.high.y() > part.low.y()) _parts.push_back(std::move(part));
    }
    const auto lifted =
        std::make_shared<LiftedPlaces>(scene, camera.getViewMatrix(), camera.getProjectionMatrix());
    lifted->lookAtGround(scene, static_cast<double>(camera.getLODScale()));
    _lifted = lifted;
    // Of two cameras that drew the same, the later one counts.
    std::stable_sort(_parts.begin(), _parts.end(),
                     [](const Part& a, const Part& b) { return a.picture->frame > b.picture->frame; });
}

std::optional<PlacePicture::Seen> PlacePicture::seenAt(int x, int y) const
{
    if (x < 0 || y < 0 || x >= _width || y >= _height) return std::nullopt;
    const osg::Vec2d pixel(x + 0.5, _height - y - 0.5);
    const auto found = std::find_if(_parts.begin(), _parts.end(),
                                    [&](const Part& part)
                                    {
                                        return pixel.x() >= part.low.x() && pixel.x() < part.high.x() &&
                                               pixel.y() >= part.low.y() && pixel.y() < part.high.y();
                                    });
    if (found == _parts.end()) return std::nullopt;
    const DepthPicture& picture = *found->picture;
    const osg::Vec2d share((pixel.x() - found->low.x()) / (found->high.x() - found->low.x()),
                           (pixel.y() - found->low.y()) / (found->high.y() - found->low.y()));
    const auto column =
        static_cast<std::size_t>(std::min<double>(share.x() * picture.width, picture.width - 1));
    const auto row =
        static_cast<std::size_t>(std::min<double>(share.y() * picture.height, picture.height - 1));
    const auto depth =
        static_cast<double>(picture.depths[row * static_cast<std::size_t>(picture.width) + column]);
    if (found->depth.reversed() ? depth <= 0.0 : depth >= 1.0) return std::nullopt;
    Seen seen;
    seen.part = &*found;
    seen.place = share * 2.0 - osg::Vec2d(1.0, 1.0);
    osg::Vec3d origin, direction;
    ViewGeometry::ray(picture.projection, found->inverse, seen.place.x(), seen.place.y(), origin, direction);
    // Through the eye itself, since the near plane is that of the frame.
    if (isPerspective(picture.projection)) origin = osg::Vec3d();
    seen.eye = origin + direction * ((zOf(depth, picture, found->depth) - origin.z()) / direction.z());
    if (!(seen.eye.length2() < 1e30)) return std::nullopt;
    return seen;
}

std::optional<double> PlacePicture::distanceAt(int x, int y) const
{
    const std::optional<Seen> seen = seenAt(x, y);
    if (!seen) return std::nullopt;
    return seen->eye.length();
}

std::optional<osg::Vec3d> PlacePicture::groundAt(const Seen& seen) const
{
    const DeformationChain& chain = *seen.part->chain;
    const osg::Vec3d ground = chain.undeform(seen.eye);
    if (!(ground.length2() < 1e30)) return std::nullopt;
    // Where a deformation gathers ground in one point, no place is that of the pixel.
    if (!chain.empty())
    {
        const DepthPicture& picture = *seen.part->picture;
        const osg::Vec2d off = pictureOf(chain.deform(ground), picture.projection) - seen.place;
        if (!(std::abs(off.x()) * picture.width < 1.0 && std::abs(off.y()) * picture.height < 1.0))
            return std::nullopt;
    }
    return ground * _toWorld;
}

std::optional<PlacePicture::Place> PlacePicture::at(int x, int y) const
{
    if (!_reference) return std::nullopt;
    const std::optional<Seen> seen = seenAt(x, y);
    if (!seen) return std::nullopt;
    const std::optional<osg::Vec3d> lifted = _lifted->groundOf(seen->eye * _toWorld);
    const std::optional<osg::Vec3d> ground = lifted ? lifted : groundAt(*seen);
    Place place;
    if (!ground || !_reference->toGeodetic(*ground, place.longitude, place.latitude, place.height))
        return std::nullopt;
    place.longitude = osg::RadiansToDegrees(place.longitude);
    place.latitude = osg::RadiansToDegrees(place.latitude);
    place.distance = seen->eye.length();
    return place;
}

WithoutStrokes::WithoutStrokes(EffectScene& scene)
{
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        auto* const map = dynamic_cast<PanoramaMap*>(scene.getEffect(i));
        if (!map || !map->getStrokes()) continue;
        map->setStrokes(false);
        _maps.emplace_back(map);
    }
}

WithoutStrokes::~WithoutStrokes()
{
    for (const osg::ref_ptr<PanoramaMap>& map : _maps)
        map->setStrokes(true);
}

} // namespace osgGeoFX
