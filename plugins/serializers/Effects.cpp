// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrappers of the effects. A new effect needs one line at the end.
#include "Wrappers.h"

#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/ground/GroundDetail.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/StrokeLines.h>

namespace osgGeoFX
{

namespace
{

/// Of a class that has no objects of its own; the wrappers of derived classes write and read everything.
class BaseWrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    BaseWrapper(const std::string& name, const std::string& associates)
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return nullptr; }, serializerDomain, name,
                                            associates, nullptr)
    {
    }
};

void addViews(osgDB::ObjectWrapper& wrapper)
{
    using Self = BlendedView;
    addPart<Self, BirdsEyeView, &Self::getBirdsEyeView, &Self::setBirdsEyeView>(wrapper, "BirdsEyeView");
    addPart<Self, PedestrianView, &Self::getPedestrianView, &Self::setPedestrianView>(wrapper,
                                                                                      "PedestrianView");
}

void addImagesAndLines(osgDB::ObjectWrapper& wrapper)
{
    using Self = PanoramaMap;
    addImage<Self, &Self::getPalette, &Self::setPalette>(wrapper, "Palette");
    addImage<Self, &Self::getSkyImage, &Self::setSkyImage>(wrapper, "SkyImage");
    addPart<Self, StrokeLines, &Self::getLines, &Self::setLines>(wrapper, "Lines");
}

const std::string effect = "osg::Object osgGeoFX::Effect";
const std::string deformation = effect + " osgGeoFX::Deformation";
const std::string bend = deformation + " osgGeoFX::PerspectiveBend";

const BaseWrapper effectWrapper("osgGeoFX::Effect", effect);
const BaseWrapper deformationWrapper("osgGeoFX::Deformation", deformation);
const BaseWrapper bendWrapper("osgGeoFX::PerspectiveBend", bend);
const Wrapper<BirdsEyeView> birdsEyeView("osgGeoFX::BirdsEyeView", bend + " osgGeoFX::BirdsEyeView");
const Wrapper<PedestrianView> pedestrianView("osgGeoFX::PedestrianView", bend + " osgGeoFX::PedestrianView");
const Wrapper<BlendedView, addViews> blendedView("osgGeoFX::BlendedView", bend + " osgGeoFX::BlendedView");
const Wrapper<VerticalExaggeration> verticalExaggeration("osgGeoFX::VerticalExaggeration",
                                                         deformation + " osgGeoFX::VerticalExaggeration");
const Wrapper<RegionalLiberty> regionalLiberty("osgGeoFX::RegionalLiberty",
                                               deformation + " osgGeoFX::RegionalLiberty");
const Wrapper<GroundDetail> groundDetail("osgGeoFX::GroundDetail", effect + " osgGeoFX::GroundDetail");
const Wrapper<SunShadows> sunShadows("osgGeoFX::SunShadows", effect + " osgGeoFX::SunShadows");
const Wrapper<PanoramaMap, addImagesAndLines> panoramaMap("osgGeoFX::PanoramaMap",
                                                          deformation + " osgGeoFX::PanoramaMap");

} // namespace

} // namespace osgGeoFX
