// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/LiftedPlaces.h>

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/CopyOp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// The ground of a region is looked at in so many rows and columns.
constexpr int side = 33;
/// From so far above the region's base, metres.
constexpr double highestGround = 1e5;
/// The heights of a flat map cannot be told from where it is drawn; this scale tells them.
constexpr double flatScale = 1e-6;

/// The ground of a region, and the way back to it.
struct Survey
{
    osg::Matrixd back; ///< from a drawn place to one above or below the ground; homogeneous
    bool flat = false; ///< whether all heights are drawn at one
    std::array<double, side * side> heights{}; ///< above the region's base, metres; not a number: none

    /// The lowest and the highest ground around a place of the region, and about the height there.
    struct Height
    {
        double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest(),
               here = 0.0;
    };
    Height at(double x, double y) const
    {
        const double column = std::clamp(0.5 * (x + 1.0), 0.0, 1.0) * (side - 1),
                     row = std::clamp(0.5 * (y + 1.0), 0.0, 1.0) * (side - 1);
        Height result;
        double weights = 0.0;
        for (int j = static_cast<int>(row) - 1; j <= static_cast<int>(row) + 2; ++j)
            for (int i = static_cast<int>(column) - 1; i <= static_cast<int>(column) + 2; ++i)
            {
                if (i < 0 || j < 0 || i >= side || j >= side) continue;
                const double height = heights[static_cast<std::size_t>(j * side + i)];
                if (std::isnan(height)) continue;
                result.low = std::min(result.low, height);
                result.high = std::max(result.high, height);
                const double weight =
                    std::max(0.0, 1.0 - std::abs(column - i)) * std::max(0.0, 1.0 - std::abs(row - j));
                result.here += weight * height;
                weights += weight;
            }
        result.here = weights > 0.0 ? result.here / weights : result.low;
        return result;
    }
};

} // namespace

struct LiftedPlaces::Items
{
    Items(EffectScene& scene, const osg::Matrixd& viewMatrix, const osg::Matrixd& projection, double now)
        : view(scene, viewMatrix, projection, 1.0, 1.0),
          geometry(view.modelView(), projection, view.ground()),
          toWorld(osg::Matrixd::inverse(view.modelView())), time(now)
    {
        for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
        {
            auto* const effect = dynamic_cast<CloseUps*>(scene.getEffect(i));
            if (!effect || !effect->getEnabled() || effect->getOpacity() <= 0.0) continue;
            for (unsigned int k = 0; k < effect->getNumCloseUps(); ++k)
            {
                const CloseUp& closeUp = *effect->getCloseUp(k);
                if (!closeUp.getEnabled() || closeUp.getRegion()->isEmpty() || closeUp.getOpacity() <= 0.0)
                    continue;
                const CloseUpItem item(closeUp, geometry, view.modelView(), view.chain(), now);
                if (item.showsCloseUp()) all.push_back(item);
            }
        }
    }

    const DeformedView view;
    const ViewGeometry geometry;
    const osg::Matrixd toWorld;
    std::vector<CloseUpItem> all;
    double time;
    std::vector<Survey> surveys; ///< for each, once the ground was looked at
};

LiftedPlaces::LiftedPlaces(EffectScene& scene, const osg::Matrixd& view, const osg::Matrixd& projection,
                           double time)
    : _items(std::make_unique<Items>(scene, view, projection, time))
{
}

LiftedPlaces::~LiftedPlaces() = default;

std::optional<LiftedPlaces::Place> LiftedPlaces::of(const osg::Vec3d& world) const
{
    const osg::Vec3d eye = world * _items->view.modelView();
    for (auto item = _items->all.rbegin(); item != _items->all.rend(); ++item)
    {
        const osg::Vec3d inRegion = eye * item->toRegion();
        if (inRegion.z() <= item->otherSide() ||
            !(item->closeUp().getRegion()->maskAt({inRegion.x(), inRegion.y()}).y() > 0.0))
            continue;
        const osg::Vec3d lifted = item->lifted(eye);
        const osg::Vec4d clip = osg::Vec4d(lifted, 1.0) * _items->geometry.projection;
        if (!(clip.w() > 0.0)) return std::nullopt;
        return Place{lifted * _items->toWorld, osg::Vec2d(clip.x() / clip.w(), clip.y() / clip.w())};
    }
    return std::nullopt;
}

bool LiftedPlaces::mayHave(const osg::BoundingSphered& ball) const
{
    const Ball eye{ball.center() * _items->view.modelView(), ball.radius()};
    return std::any_of(_items->all.begin(), _items->all.end(),
                       [&](const CloseUpItem& item) { return !item.outside(eye); });
}

void LiftedPlaces::lookAtGround(EffectScene& scene, double lodScale)
{
    const osg::Matrixd& modelView = _items->view.modelView();
    const osg::ref_ptr<DeformationChain> plain = new DeformationChain;
    _items->surveys.clear();
    for (const CloseUpItem& item : _items->all)
    {
        Survey survey;
        survey.flat = item.closeUp().getScaleHeight() < flatScale;
        survey.back = osg::Matrixd::inverse(item.lift());
        if (survey.flat)
        {
            const osg::ref_ptr<CloseUp> raised = osg::clone(&item.closeUp(), osg::CopyOp::SHALLOW_COPY);
            raised->setScale(item.closeUp().getScaleX(), item.closeUp().getScaleY(), flatScale);
            survey.back = osg::Matrixd::inverse(
                CloseUpItem(*raised, _items->geometry, modelView, _items->view.chain(), _items->time).lift());
        }
        const osg::Matrixd fromRegion = osg::Matrixd::inverse(item.toRegion());
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
            {
                const osg::Vec3d place(2.0 * i / (side - 1) - 1.0, 2.0 * j / (side - 1) - 1.0, highestGround);
                const osg::Vec3d from = place * fromRegion,
                                 to = osg::Vec3d(place.x(), place.y(), -highestGround) * fromRegion;
                const osg::ref_ptr<DeformedLineIntersector> ray =
                    new DeformedLineIntersector(from, to - from);
                const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
                    new DeformedIntersectionVisitor(ray, *plain, modelView, lodScale);
                scene.getTerrain()->traverse(*visitor);
                survey.heights[static_cast<std::size_t>(j * side + i)] =
                    ray->containsIntersections()
                        ? (ray->intersections().front().deformed * item.toRegion()).z()
                        : std::numeric_limits<double>::quiet_NaN();
            }
        _items->surveys.push_back(survey);
    }
}

std::optional<osg::Vec3d> LiftedPlaces::groundOf(const osg::Vec3d& drawn) const
{
    const osg::Vec3d eye = drawn * _items->view.modelView();
    for (std::size_t i = _items->surveys.size(); i-- > 0;)
    {
        const CloseUpItem& item = _items->all[i];
        const Survey& survey = _items->surveys[i];
        const osg::Vec3d ground = eye * survey.back, inRegion = ground * item.toRegion();
        if (!inRegion.valid() ||
            !(item.closeUp().getRegion()->maskAt({inRegion.x(), inRegion.y()}).y() > 0.0))
            continue;
        const Survey::Height height = survey.at(inRegion.x(), inRegion.y());
        if (height.low > height.high) continue;
        const osg::Matrixd fromRegion = osg::Matrixd::inverse(item.toRegion());
        const auto place = [&](double z)
        {
            return osg::Vec3d(inRegion.x(), inRegion.y(), z) * fromRegion;
        };
        // Between the samples the ground may be as much higher and lower again, and is drawn with an error.
        const double more = height.high - height.low + 0.002 * item.closeUp().getRegion()->getWidth();
        if (survey.flat)
        {
            const osg::Vec3d on = place(height.here);
            const double scale = std::max(item.closeUp().getScaleX(), item.closeUp().getScaleY());
            if ((item.lifted(on) - eye).length() > 0.002 * scale * item.closeUp().getRegion()->getWidth())
                continue;
            return on * _items->toWorld;
        }
        if (inRegion.z() < height.low - more || inRegion.z() > height.high + more) continue;
        return ground * _items->toWorld;
    }
    return std::nullopt;
}

} // namespace osgGeoFX
