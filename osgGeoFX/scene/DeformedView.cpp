// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/Transform>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// What stands between the world of the viewer and the children of a terrain.
osg::NodePath pathTo(const osg::Group& terrain)
{
    const osg::NodePathList paths = terrain.getParentalNodePaths();
    return paths.empty() ? osg::NodePath() : paths.front();
}

osg::Matrixd frameOf(const osg::NodePath& path)
{
    osg::NodePath nodes = path;
    // A viewer's camera stands above its scene data; its view is told apart.
    while (!nodes.empty() && nodes.front()->asCamera() && nodes.front()->getNumParents() == 0)
        nodes.erase(nodes.begin());
    return osg::computeLocalToWorld(nodes);
}

} // namespace

DeformedView::DeformedView(EffectScene& scene, const osg::Camera& camera)
    : DeformedView(scene, camera.getViewMatrix(), camera.getProjectionMatrix(),
                   camera.getViewport() ? camera.getViewport()->width() : 1.0,
                   camera.getViewport() ? camera.getViewport()->height() : 1.0,
                   static_cast<double>(camera.getLODScale()))
{
}

DeformedView::DeformedView(EffectScene& scene, const osg::Matrixd& view, const osg::Matrixd& projection,
                           double width, double height, double lodScale)
    : _scene(&scene), _projection(projection), _width(width), _height(height), _lodScale(lodScale)
{
    const osg::NodePath path = pathTo(*scene.getTerrain());
    _modelView = frameOf(path) * view;
    _toWorld.invert(_modelView);
    _ground = scene.ground(path);
    _chain = scene.deformation(_modelView, projection, path);
    const unsigned int parts = scene.leastParts();
    // Those that drawInParts() makes.
    const unsigned int columns = parts > 1 ? parts : 0;
    for (unsigned int i = 0; i < columns; ++i)
        _columns.push_back(scene.deformationOfColumn(_modelView, projection, 2.0 * i / columns - 1.0,
                                                     2.0 * (i + 1) / columns - 1.0, path));
}

const DeformationChain& DeformedView::chainAt(double x) const
{
    if (_columns.empty()) return *_chain;
    const double column = 0.5 * (x + 1.0) * static_cast<double>(_columns.size());
    const double last = static_cast<double>(_columns.size()) - 1.0;
    return *_columns[static_cast<std::size_t>(std::clamp(std::floor(column), 0.0, last))];
}

const DeformationChain& DeformedView::chainOf(const osg::Vec3d& position) const
{
    for (std::size_t i = 0; i < _columns.size(); ++i)
    {
        const osg::Vec4d clip = osg::Vec4d(_columns[i]->deform(position), 1.0) * _projection;
        const double column = 0.5 * (clip.x() / clip.w() + 1.0) * static_cast<double>(_columns.size());
        // A place on the border of two columns is the same in both.
        constexpr double room = 1e-6;
        if (clip.w() > 0.0 && std::abs(column - static_cast<double>(i) - 0.5) <= 0.5 + room)
            return *_columns[i];
    }
    return *_chain;
}

bool DeformedView::project(const osg::Vec3d& world, osg::Vec2d& pixel) const
{
    const osg::Vec3d position = world * _modelView;
    const osg::Vec3d eye = chainOf(position).deform(position);
    const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * _projection;
    if (clip.w() <= 0.0) return false;
    pixel.set((clip.x() / clip.w() + 1.0) / 2.0 * _width, (clip.y() / clip.w() + 1.0) / 2.0 * _height);
    return true;
}

bool DeformedView::project(double longitude, double latitude, double height, const Georeference& reference,
                           osg::Vec2d& pixel) const
{
    osg::Vec3d world;
    return reference.toWorld(longitude, latitude, height, world) && project(world, pixel);
}

bool DeformedView::maySee(const osg::BoundingSphered& ball) const
{
    if (!ball.valid()) return false;
    // Transforms above a scene do not scale.
    const Ball eye = {ball.center() * _modelView, ball.radius()};
    const auto within = [&](const DeformationChain& chain)
    {
        const Ball bound = chain.bound(eye);
        for (const int axis : {0, 1})
        {
            for (const double side : {-1.0, 1.0})
            {
                // The plane of the picture's border: w + side * x >= 0.
                osg::Vec3d normal;
                for (int i = 0; i < 3; ++i)
                    normal[i] = _projection(i, 3) + side * _projection(i, axis);
                const double away = bound.center * normal + _projection(3, 3) + side * _projection(3, axis);
                if (away < -bound.radius * normal.length()) return false;
            }
        }
        return true;
    };
    if (_columns.empty()) return within(*_chain);
    return std::any_of(_columns.begin(), _columns.end(), [&](const auto& column) { return within(*column); });
}

std::optional<DeformedLineIntersector::Intersection> DeformedView::pick(double x, double y,
                                                                        osg::Node::NodeMask mask) const
{
    return meet(x, y, mask, false);
}

std::optional<DeformedLineIntersector::Intersection> DeformedView::pickCurved(double x, double y,
                                                                              osg::Node::NodeMask mask) const
{
    return meet(x, y, mask, true);
}

std::optional<DeformedLineIntersector::Intersection>
DeformedView::meet(double x, double y, osg::Node::NodeMask mask, bool curved) const
{
    osg::Matrixd inverse;
    inverse.invert(_projection);
    const double ndcX = 2.0 * x / _width - 1.0;
    const double ndcY = 2.0 * y / _height - 1.0;
    osg::Vec3d onNear, direction;
    ViewGeometry::ray(_projection, inverse, ndcX, ndcY, onNear, direction);
    // From the eye, not from the near plane: a viewer moves that plane with what it draws.
    const bool perspective = _projection(3, 3) == 0.0;
    const osg::Vec3d origin = perspective ? osg::Vec3d() : onNear;
    const osg::ref_ptr<DeformedLineIntersector> ray = new DeformedLineIntersector(origin, direction);
    ray->setCurved(curved);
    const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
        new DeformedIntersectionVisitor(ray, chainAt(ndcX), _modelView, _lodScale);
    visitor->setTraversalMask(mask);
    _scene->getTerrain()->traverse(*visitor);
    if (ray->intersections().empty()) return std::nullopt;
    return ray->intersections().front();
}

bool DeformedView::unproject(double x, double y, const Georeference& reference, double& longitude,
                             double& latitude, double& height) const
{
    const auto hit = pick(x, y);
    return hit && reference.toGeodetic(hit->world, longitude, latitude, height);
}

osg::Vec3d DeformedView::deform(const osg::Vec3d& world) const
{
    const osg::Vec3d position = world * _modelView;
    return chainOf(position).deform(position) * _toWorld;
}

osg::Vec3d DeformedView::undeform(const osg::Vec3d& world) const
{
    return _chain->undeform(world * _modelView) * _toWorld;
}

} // namespace osgGeoFX
