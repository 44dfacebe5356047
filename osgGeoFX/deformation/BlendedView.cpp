// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/BlendedView.h>

#include <osg/CopyOp>
#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

BlendedView::BlendedView() : _birdsEye(new BirdsEyeView), _pedestrian(new PedestrianView) {}

BlendedView::BlendedView(const BlendedView& other, const osg::CopyOp& copy)
    : PerspectiveBend(other, copy), _lowHeight(other._lowHeight), _highHeight(other._highHeight),
      _birdsEye(other._birdsEye), _pedestrian(other._pedestrian)
{
    if (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)
    {
        _birdsEye = osg::clone(other._birdsEye.get(), copy);
        _pedestrian = osg::clone(other._pedestrian.get(), copy);
    }
}

BlendedView::~BlendedView() = default;

bool BlendedView::setBirdsEyeView(BirdsEyeView* view)
{
    if (!view)
    {
        OSG_WARN << "osgGeoFX: BlendedView needs a bird's-eye view. The former one stays." << std::endl;
        return false;
    }
    _birdsEye = view;
    touch();
    return true;
}

bool BlendedView::setPedestrianView(PedestrianView* view)
{
    if (!view)
    {
        OSG_WARN << "osgGeoFX: BlendedView needs a pedestrian's view. The former one stays." << std::endl;
        return false;
    }
    _pedestrian = view;
    touch();
    return true;
}

const Properties& BlendedView::properties() const
{
    using Self = BlendedView;
    static const Properties all = []
    {
        Properties list = bendProperties();
        list.insert(
            list.end(),
            {Property::number("lowHeight",
                              "the height of the camera above the database's zero height below which the "
                              "pedestrian's view alone is in force; less than highHeight",
                              -12000.0, 1e7, "m")
                 .of<&Self::_lowHeight>(),
             Property::number("highHeight",
                              "the height of the camera above the database's zero height above which the "
                              "bird's-eye view alone is in force; more than lowHeight",
                              -12000.0, 1e7, "m")
                 .of<&Self::_highHeight>()
                 .turnedByFactor(1.15)});
        return withDefaultsOf(new Self, std::move(list));
    }();
    return all;
}

std::string BlendedView::inconsistency() const
{
    return _lowHeight < _highHeight ? "" : "lowHeight must be less than highHeight.";
}

std::optional<BendPlacement> BlendedView::placementOf(Curve curve, const ViewGeometry& view) const
{
    // Not the mean of both: where one of the views has no bend it is endlessly wide, or has no width.
    const double share = std::clamp((view.eyeHeight - _lowHeight) / (_highHeight - _lowHeight), 0.0, 1.0);
    const PerspectiveBend* part = _pedestrian.get();
    if (share > 0.5) part = _birdsEye.get();
    std::optional<BendPlacement> place = part->placementOf(curve, view);
    const double strength = std::abs(2.0 * share - 1.0);
    if (place) place->angle *= strength * strength * (3.0 - 2.0 * strength);
    return place;
}

} // namespace osgGeoFX
