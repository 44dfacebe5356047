// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/CloseUpPicking.h>

#include <osgGeoFX/closeup/detail/LiftSnapshot.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/LOD>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// Heights of a flat map cannot be told from the picture; this scale tells them, and is too small to be seen.
constexpr double flatScale = 1e-6;
/// Ground is sought so far above and below a region's base and sea level, metres.
constexpr double highestGround = 1e5;
constexpr double wholeMask = 0.9999;

/// A ray of the picture in eye space, from the eye where there is perspective; the direction has unit length.
struct PixelRay
{
    osg::Vec3d origin, direction;

    osg::Vec3d at(double distance) const { return origin + direction * distance; }
    double distanceOf(const osg::Vec3d& point) const { return (point - origin) * direction; }
};

/// One camera's picture of the scene.
class Picture
{
public:
    Picture(EffectScene& scene, const osg::Camera& camera)
        : _view(scene, camera), _geometry(_view.modelView(), camera.getProjectionMatrix(), _view.ground()),
          _toWorld(osg::Matrixd::inverse(_view.modelView()))
    {
        if (const osg::Viewport* port = camera.getViewport()) _size.set(port->width(), port->height());
    }

    const DeformedView& view() const { return _view; }
    const osg::Matrixd& toWorld() const { return _toWorld; }
    bool perspective() const { return _geometry.projection(3, 3) == 0.0; }

    CloseUpItem item(const CloseUp& closeUp, double time) const
    {
        return {closeUp, _geometry, _view.modelView(), _view.chain(), time};
    }
    PixelRay ray(double x, double y) const
    {
        PixelRay ray;
        _geometry.ray(2.0 * x / _size.x() - 1.0, 2.0 * y / _size.y() - 1.0, ray.origin, ray.direction);
        ray.direction.normalize();
        if (perspective()) ray.origin = osg::Vec3d();
        return ray;
    }
    std::optional<osg::Vec2d> pixelOf(const osg::Vec3d& eye) const
    {
        const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * _geometry.projection;
        if (!(clip.w() > 0.0)) return std::nullopt;
        return osg::Vec2d((clip.x() / clip.w() + 1.0) / 2.0 * _size.x(),
                          (clip.y() / clip.w() + 1.0) / 2.0 * _size.y());
    }

private:
    DeformedView _view;
    ViewGeometry _geometry;
    osg::Matrixd _toWorld;
    osg::Vec2d _size = {1.0, 1.0};
};

/// The ground as it lies, at the levels of detail that are drawn of it elsewhere.
class LiftedGroundVisitor : public DeformedIntersectionVisitor
{
public:
    LiftedGroundVisitor(osgUtil::Intersector* intersector, const DeformationChain& drawn,
                        const osg::Matrixd& modelView, double lodScale)
        : DeformedIntersectionVisitor(intersector, *osg::ref_ptr<DeformationChain>(new DeformationChain),
                                      modelView, lodScale),
          _drawn(&drawn), _lodScale(lodScale)
    {
    }

    using DeformedIntersectionVisitor::apply;
    void apply(osg::LOD& node) override
    {
        const double former = _radius;
        const double formerLimit = _limit;
        const osg::Matrixd here = modelView();
        _radius = static_cast<double>(node.getBound().radius()) * largestScale(here);
        _limit = _drawn->lodLimit(node, {osg::Vec3d(node.getBound().center()) * here, _radius});
        DeformedIntersectionVisitor::apply(node);
        _radius = former;
        _limit = formerLimit;
    }
    float getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const override
    {
        const double distance =
            _drawn->lodDistance({osg::Vec3d(position) * modelView(), _radius}, osg::Vec3d());
        return static_cast<float>(std::min(withLodScale ? distance * _lodScale : distance, _limit));
    }

protected:
    ~LiftedGroundVisitor() override = default;

private:
    osg::ref_ptr<const DeformationChain> _drawn;
    double _lodScale;
    double _radius = 0.0;
    double _limit = std::numeric_limits<double>::infinity();
};

/// Where a line is within |x| and |y| ≤ 1 and near the ground, in multiples of its direction.
struct Stretch
{
    double first = -std::numeric_limits<double>::infinity();
    double last = std::numeric_limits<double>::infinity();

    void clip(double at, double step, double half)
    {
        if (step == 0.0)
        {
            if (std::abs(at) > half) last = -std::numeric_limits<double>::infinity();
            return;
        }
        const double a = (-half - at) / step;
        const double b = (half - at) / step;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    bool empty() const { return !(first < last); }
};

struct LiftedHit
{
    double distance; ///< along the pixel's ray
    CloseUpHit hit;
};

bool shows(const CloseUp& closeUp)
{
    return closeUp.getEnabled() && !closeUp.getRegion()->isEmpty();
}

using Found = DeformedLineIntersector::Intersection;

bool isWhole(const CloseUp& closeUp, const osg::Vec3d& inRegion)
{
    return closeUp.getRegion()->maskAt({inRegion.x(), inRegion.y()}).x() >= wholeMask;
}

/// Whether a triangle has all corners where the mask is 1.
bool isWhole(const CloseUp& closeUp, const Found& found, const osg::Matrixd& worldToRegion)
{
    const DrawableTriangles mesh(*found.drawable);
    const osg::Matrixd toRegion = osg::computeLocalToWorld(found.path) * worldToRegion;
    const unsigned int* const first = &mesh.corners()[std::size_t{3} * found.triangle];
    return std::all_of(first, first + 3,
                       [&](unsigned int corner)
                       { return isWhole(closeUp, mesh.positions()[corner] * toRegion); });
}

/// What a ray meets of a close-up.
std::optional<LiftedHit> meet(EffectScene& scene, CloseUp& closeUp, const Picture& picture,
                              const DeformationChain* overview, bool tessellated, double lodScale,
                              const PixelRay& ray, double time)
{
    const CloseUpItem item = picture.item(closeUp, time);
    osg::ref_ptr<const CloseUp> raised = &closeUp;
    if (closeUp.getScaleHeight() < flatScale)
    {
        const osg::ref_ptr<CloseUp> copy = osg::clone(&closeUp);
        copy->setScale(closeUp.getScaleX(), closeUp.getScaleY(), flatScale);
        raised = copy;
    }
    // A lift takes lines to lines; two points of the ray tell its own on the ground.
    const osg::Matrixd back = osg::Matrixd::inverse(picture.item(*raised, time).lift());
    const double far = std::max(ray.distanceOf(item.lifted(item.regionToEye().getTrans())), 1.0);
    const osg::Vec3d start = ray.at(far) * back;
    osg::Vec3d direction = ray.at(2.0 * far) * back - start;
    direction.normalize();
    const osg::Vec3d at = start * item.toRegion();
    const osg::Vec3d step = osg::Matrixd::transform3x3(direction, item.toRegion());
    Stretch stretch;
    stretch.clip(at.x(), step.x(), 1.0);
    stretch.clip(at.y(), step.y(), 1.0);
    stretch.clip(at.z(), step.z(), highestGround + std::abs(closeUp.getRegion()->getBaseHeight()));
    if (stretch.empty()) return std::nullopt;

    osg::ref_ptr<const DeformationChain> drawn = overview;
    if (!drawn)
    {
        const osg::ref_ptr<DeformationChain> lift = new DeformationChain;
        lift->add(new LiftSnapshot(item));
        drawn = lift;
    }
    const osg::ref_ptr<DeformedLineIntersector> line =
        new DeformedLineIntersector(start + direction * stretch.first, direction);
    const osg::ref_ptr<LiftedGroundVisitor> visitor =
        new LiftedGroundVisitor(line, *drawn, picture.view().modelView(), lodScale);
    scene.getTerrain()->traverse(*visitor);
    const osg::Matrixd worldToRegion = picture.view().modelView() * item.toRegion();
    for (const Found& found : line->intersections())
    {
        const osg::Vec3d inRegion = found.deformed * item.toRegion();
        const osg::Vec2d place(inRegion.x(), inRegion.y());
        const bool shown = closeUp.getEdge() == CloseUp::FRAGMENTS
                               ? closeUp.getRegion()->maskAt(place).y() > 0.0
                           : tessellated ? isWhole(closeUp, inRegion)
                                         : isWhole(closeUp, found, worldToRegion);
        if (!shown) continue;
        const osg::Vec3d lifted = item.lifted(found.deformed);
        const double distance = ray.distanceOf(lifted);
        if (!(distance > 0.0)) continue;
        return LiftedHit{distance, {&closeUp, false, found.world, place, lifted * picture.toWorld()}};
    }
    return std::nullopt;
}

/// The last region that a place of the ground lies in.
std::optional<CloseUpHit> regionAt(CloseUps& closeUps, const Picture& picture, const Found& ground,
                                   double time)
{
    const osg::Vec3d eye = ground.world * picture.view().modelView();
    for (unsigned int i = closeUps.getNumCloseUps(); i-- > 0;)
    {
        CloseUp& closeUp = *closeUps.getCloseUp(i);
        if (!shows(closeUp)) continue;
        const osg::Vec3d inRegion = eye * picture.item(closeUp, time).toRegion();
        const osg::Vec2d place(inRegion.x(), inRegion.y());
        if (closeUp.getRegion()->maskAt(place).y() > 0.0)
            return CloseUpHit{&closeUp, true, ground.world, place, ground.deformed * picture.toWorld()};
    }
    return std::nullopt;
}

} // namespace

std::optional<CloseUpHit> pickCloseUp(EffectScene& scene, CloseUps& closeUps, const osg::Camera& camera,
                                      double x, double y, double time)
{
    if (!closeUps.getEnabled() || closeUps.getOpacity() <= 0.0) return std::nullopt;
    const Picture picture(scene, camera);
    const PixelRay ray = picture.ray(x, y);
    const CloseUps::Statistics last = closeUps.statistics();
    const bool single = last.pipeline == CloseUps::SINGLE_PASS;
    std::optional<LiftedHit> best;
    for (unsigned int i = 0; i < closeUps.getNumCloseUps(); ++i)
    {
        CloseUp& closeUp = *closeUps.getCloseUp(i);
        if (!shows(closeUp) || closeUp.getActivity() == CloseUp::REGION_ONLY || closeUp.getOpacity() <= 0.0)
            continue;
        const std::optional<LiftedHit> found =
            meet(scene, closeUp, picture, single ? &picture.view().chain() : nullptr, last.tessellated,
                 static_cast<double>(camera.getLODScale()), ray, time);
        if (found && (!best || !closeUps.getDepthTest() || found->distance < best->distance)) best = found;
    }
    if (best && !closeUps.getDepthTest()) return best->hit;
    const auto ground = picture.view().pick(x, y);
    if (best && !(ground && ground->distance < best->distance)) return best->hit;
    if (!ground) return std::nullopt;
    return regionAt(closeUps, picture, *ground, time);
}

std::optional<osg::Vec2d> projectCloseUp(EffectScene& scene, const CloseUp& closeUp,
                                         const osg::Camera& camera, const osg::Vec3d& world, double time)
{
    const Picture picture(scene, camera);
    return picture.pixelOf(picture.item(closeUp, time).lifted(world * picture.view().modelView()));
}

std::optional<osg::Vec3d> dragCloseUp(EffectScene& scene, const CloseUp& closeUp, const osg::Camera& camera,
                                      const osg::Vec3d& drawn, double x, double y, double time)
{
    const Picture picture(scene, camera);
    const CloseUpItem item = picture.item(closeUp, time);
    const osg::Matrixd placed =
        item.regionToEye() * rigidPlacement(picture.view().chain(), item.regionToEye().getTrans(), true);
    osg::Vec3d from = drawn * picture.view().modelView();
    if (!picture.pixelOf(from)) return std::nullopt;
    // Without perspective all of it is as far away as its middle.
    if (item.parallel()) from *= (closeUp.getOffset() * placed).z() / from.z();
    const PixelRay ray = picture.ray(x, y);
    const osg::Vec3d to = ray.at((from.z() - ray.origin.z()) / ray.direction.z());
    return osg::Matrixd::transform3x3(to - from, osg::Matrixd::inverse(placed));
}

} // namespace osgGeoFX
