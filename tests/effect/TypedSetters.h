// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The typed setters and getters of every property of every class.
#pragma once

#include <effect/TypedSetter.h>
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

namespace geofx::test
{

/// Of effects that deform; their names mean one thing in all classes.
inline TypedSetters deformationSetters()
{
    using Bend = osgGeoFX::PerspectiveBend;
    using Exaggeration = osgGeoFX::VerticalExaggeration;
    return {
        {"enabled", typed(&osgGeoFX::Effect::setEnabled, &osgGeoFX::Effect::getEnabled)},
        {"curve", typed(&Bend::setCurve, &Bend::getCurve)},
        {"planeElevation", typed(&Bend::setPlaneElevation, &Bend::getPlaneElevation)},
        {"planeReference", typed(&Bend::setPlaneReference, &Bend::getPlaneReference)},
        {"tallest", typed(&Bend::setTallest, &Bend::getTallest)},
        {"transitionDetail", typed(&Bend::setTransitionDetail, &Bend::getTransitionDetail)},
        {"contextDetail", typed(&Bend::setContextDetail, &Bend::getContextDetail)},
        {"contextSaturation", typed(&Bend::setContextSaturation, &Bend::getContextSaturation)},
        {"contextBrightness", typed(&Bend::setContextBrightness, &Bend::getContextBrightness)},
        {"mapUnit", typed(&Bend::setMapUnit, &Bend::getMapUnit)},
        {"focusLine", typed(&osgGeoFX::BirdsEyeView::setFocusLine, &osgGeoFX::BirdsEyeView::getFocusLine)},
        {"horizonLine",
         typed(&osgGeoFX::BirdsEyeView::setHorizonLine, &osgGeoFX::BirdsEyeView::getHorizonLine)},
        {"contextTilt",
         typed(&osgGeoFX::BirdsEyeView::setContextTilt, &osgGeoFX::BirdsEyeView::getContextTilt)},
        {"bendAngle",
         typed(&osgGeoFX::PedestrianView::setBendAngle, &osgGeoFX::PedestrianView::getBendAngle)},
        {"focusDistance",
         typed(&osgGeoFX::PedestrianView::setFocusDistance, &osgGeoFX::PedestrianView::getFocusDistance)},
        {"zoneWidth",
         typed(&osgGeoFX::PedestrianView::setZoneWidth, &osgGeoFX::PedestrianView::getZoneWidth)},
        {"lowHeight", typed(&osgGeoFX::BlendedView::setLowHeight, &osgGeoFX::BlendedView::getLowHeight)},
        {"highHeight", typed(&osgGeoFX::BlendedView::setHighHeight, &osgGeoFX::BlendedView::getHighHeight)},
        {"factor", typed(&Exaggeration::setFactor, &Exaggeration::getFactor)},
        {"base", typed(&Exaggeration::setBase, &Exaggeration::getBase)},
        {"relight", typed(&Exaggeration::setRelight, &Exaggeration::getRelight)},
    };
}

inline TypedSetters mappingsSetters()
{
    using Self = osgGeoFX::ProjectiveMappings;
    using Geodetic = Two<Self, &Self::setGeodeticOrigin, &Self::getLongitude, &Self::getLatitude>;
    const auto unit = [](std::size_t which)
    {
        return oneOf<Self, &Self::getDataUnit, &Self::getLayerUnit, &Self::getTableUnit>(&Self::setUnits,
                                                                                         which);
    };
    return {
        {"enabled", typed(&osgGeoFX::Effect::setEnabled, &osgGeoFX::Effect::getEnabled)},
        {"originX", component(
                        &Self::setOrigin, &Self::getOrigin, [](auto& v) -> auto& { return v.x(); })},
        {"originY", component(
                        &Self::setOrigin, &Self::getOrigin, [](auto& v) -> auto& { return v.y(); })},
        {"longitude", Geodetic::first()},
        {"latitude", Geodetic::second()},
        {"opacity", typed(&Self::setOpacity, &Self::getOpacity)},
        {"wholeList", typed(&Self::setWholeList, &Self::getWholeList)},
        {"anisotropy", typed(&Self::setAnisotropy, &Self::getAnisotropy)},
        {"linear", typed(&Self::setLinear, &Self::getLinear)},
        {"dataUnit", unit(0)},
        {"layerUnit", unit(1)},
        {"tableUnit", unit(2)},
        {"pageSide", typed(&Self::setPageSide, &Self::getPageSide)},
        {"maxPages", typed(&Self::setMaxPages, &Self::getMaxPages)},
        {"maxDataSize", typed(&Self::setMaxDataSize, &Self::getMaxDataSize)},
    };
}

inline TypedSetters mappingSetters()
{
    using Self = osgGeoFX::ProjectiveMapping;
    using Camera = Self::Camera;
    const auto axis = [](bool second, int index)
    {
        return Typed{[=](osgGeoFX::PropertyHolder& holder, double value)
                     {
                         auto& mapping = static_cast<Self&>(holder);
                         osg::Vec2d u = mapping.getU();
                         osg::Vec2d v = mapping.getV();
                         (second ? v : u)[index] = value;
                         return mapping.setAxes(u, v);
                     },
                     [=](const osgGeoFX::PropertyHolder& holder)
                     {
                         const auto& mapping = static_cast<const Self&>(holder);
                         return (second ? mapping.getV() : mapping.getU())[index];
                     }};
    };
    const auto ofCamera = [](double Camera::*member)
    {
        return component(&Self::setCamera, &Self::getCamera,
                         [=](Camera& camera) -> double& { return camera.*member; });
    };
    using Heights = Two<Self, &Self::setHeights, &Self::getLowest, &Self::getHighest>;
    using Pixels = Two<Self, &Self::setPixels, &Self::getPixelsNone, &Self::getPixelsFull>;
    using Slopes = Two<Self, &Self::setSlopes, &Self::getSlopeFull, &Self::getSlopeNone>;
    TypedSetters all = {
        {"enabled", typed(&Self::setEnabled, &Self::getEnabled)},
        {"order", typed(&Self::setOrder, &Self::getOrder)},
        {"opacity", typed(&Self::setOpacity, &Self::getOpacity)},
        {"importance", typed(&Self::setImportance, &Self::getImportance)},
        {"channels", typed(&Self::setChannels, &Self::getChannels)},
        {"centreX", component(
                        &Self::setCentre, &Self::getCentre, [](auto& v) -> auto& { return v.x(); })},
        {"centreY", component(
                        &Self::setCentre, &Self::getCentre, [](auto& v) -> auto& { return v.y(); })},
        {"uX", axis(false, 0)},
        {"uY", axis(false, 1)},
        {"vX", axis(true, 0)},
        {"vY", axis(true, 1)},
        {"lowest", Heights::first()},
        {"highest", Heights::second()},
        {"nearest",
         typed<Self>([](Self& m, double v) { return m.setDistances(v, m.getFarthest(), m.getSoftness()); },
                     [](const Self& m) { return m.getNearest(); })},
        {"farthest",
         typed<Self>([](Self& m, double v) { return m.setDistances(m.getNearest(), v, m.getSoftness()); },
                     [](const Self& m) { return m.getFarthest(); })},
        {"softness",
         typed<Self>([](Self& m, double v) { return m.setDistances(m.getNearest(), m.getFarthest(), v); },
                     [](const Self& m) { return m.getSoftness(); })},
        {"pixelsNone", Pixels::first()},
        {"pixelsFull", Pixels::second()},
        {"slopeFull", Slopes::first()},
        {"slopeNone", Slopes::second()},
        {"softEdges", typed(&Self::setSoftEdges, &Self::getSoftEdges)},
        {"sizeInPixels", typed(&Self::setSizeInPixels, &Self::getSizeInPixels)},
        {"turned", typed(&Self::setTurned, &Self::getTurned)},
        {"projector", typed(&Self::setProjector, &Self::getProjector)},
        {"height", typed(&Self::setHeight, &Self::getHeight)},
        {"heading", ofCamera(&Camera::heading)},
        {"pitch", ofCamera(&Camera::pitch)},
        {"roll", ofCamera(&Camera::roll)},
        {"fieldOfView", ofCamera(&Camera::fieldOfView)},
        {"aspectRatio", ofCamera(&Camera::aspectRatio)},
        {"k1", ofCamera(&Camera::k1)},
        {"k2", ofCamera(&Camera::k2)},
        {"k3", ofCamera(&Camera::k3)},
        {"p1", ofCamera(&Camera::p1)},
        {"p2", ofCamera(&Camera::p2)},
        {"range", ofCamera(&Camera::range)},
    };
    for (int row = 0; row < 3; ++row)
    {
        for (int column = 0; column < 3; ++column)
            all["m" + std::to_string(row) + std::to_string(column)] =
                component(&Self::setTransform, &Self::getTransform,
                          [=](glm::dmat3& m) -> double& { return m[column][row]; });
    }
    return all;
}

inline TypedSetters layerSetters()
{
    using Self = osgGeoFX::DataLayer;
    return {
        {"kind", typed(&Self::setKind, &Self::getKind)},
        {"smooth", typed(&Self::setSmooth, &Self::getSmooth)},
        {"sRgb", typed(&Self::setSRgb, &Self::getSRgb)},
        {"hasNoData",
         typed<Self>([](Self& layer, double value)
                     { return value != 0.0 ? layer.setNoData(layer.getNoData()) : layer.clearNoData(); },
                     [](const Self& layer) { return layer.getHasNoData() ? 1.0 : 0.0; })},
        {"noData", typed(&Self::setNoData, &Self::getNoData)},
        {"importance", typed(&Self::setImportance, &Self::getImportance)},
    };
}

inline TypedSetters transferSetters()
{
    using Self = osgGeoFX::ColorTransfer;
    using Range = Two<Self, &Self::setValueRange, &Self::getLowValue, &Self::getHighValue>;
    using Ramp = Two<Self, &Self::setRamp, &Self::getRampLow, &Self::getRampHigh>;
    TypedSetters all = {
        {"source", typed(&Self::setSource, &Self::getSource)},
        {"alpha", typed(&Self::setAlpha, &Self::getAlpha)},
        {"sourceFactor",
         typed<Self>([](Self& t, double v)
                     { return t.setBlendFunction(static_cast<Self::Factor>(v), t.getDestinationFactor()); },
                     [](const Self& t) { return static_cast<double>(t.getSourceFactor()); })},
        {"destinationFactor",
         typed<Self>([](Self& t, double v)
                     { return t.setBlendFunction(t.getSourceFactor(), static_cast<Self::Factor>(v)); },
                     [](const Self& t) { return static_cast<double>(t.getDestinationFactor()); })},
        {"equation", typed(&Self::setEquation, &Self::getEquation)},
        {"lowValue", Range::first()},
        {"highValue", Range::second()},
        {"rampLow", Ramp::first()},
        {"rampHigh", Ramp::second()},
        {"brightness", typed(&Self::setBrightness, &Self::getBrightness)},
        {"contrast", typed(&Self::setContrast, &Self::getContrast)},
        {"saturation", typed(&Self::setSaturation, &Self::getSaturation)},
        {"hue", typed(&Self::setHue, &Self::getHue)},
    };
    const char* const parts[] = {"red", "green", "blue", "constantAlpha"};
    for (int i = 0; i < 4; ++i)
        all[parts[i]] =
            component(&Self::setConstant, &Self::getConstant, [=](osg::Vec4d& v) -> double& { return v[i]; });
    const char* const columns[] = {"FromRed", "FromGreen", "FromBlue", "Added"};
    for (int row = 0; row < 3; ++row)
    {
        for (int column = 0; column < 4; ++column)
            all[std::string(parts[row]) + columns[column]] = component(
                &Self::setColorMatrix, &Self::getColorMatrix,
                [=](Self::Matrix& m) -> double& { return m[static_cast<std::size_t>(row)][column]; });
    }
    return all;
}

inline TypedSetters closeUpsSetters()
{
    using Self = osgGeoFX::CloseUps;
    const auto unit = [](std::size_t which)
    {
        return oneOf<Self, &Self::getMaskUnit, &Self::getTableUnit, &Self::getSurfaceUnit>(&Self::setUnits,
                                                                                           which);
    };
    return {
        {"enabled", typed(&osgGeoFX::Effect::setEnabled, &osgGeoFX::Effect::getEnabled)},
        {"pipeline", typed(&Self::setPipeline, &Self::getPipeline)},
        {"opacity", typed(&Self::setOpacity, &Self::getOpacity)},
        {"supersampling", typed(&Self::setSupersampling, &Self::getSupersampling)},
        {"tessellation", typed(&Self::setTessellation, &Self::getTessellation)},
        {"depthTest", typed(&Self::setDepthTest, &Self::getDepthTest)},
        {"maxLayers", typed(&Self::setMaxLayers, &Self::getMaxLayers)},
        {"maskUnit", unit(0)},
        {"tableUnit", unit(1)},
        {"surfaceUnit", unit(2)},
        {"blockBinding", typed(&Self::setBlockBinding, &Self::getBlockBinding)},
    };
}

inline TypedSetters closeUpSetters()
{
    using Self = osgGeoFX::CloseUp;
    const auto offset = [](int axis)
    {
        return component(&Self::setOffset, &Self::getOffset,
                         [=](osg::Vec3d& v) -> double& { return v[axis]; });
    };
    const auto color = [](int channel)
    {
        return component(&Self::setColor, &Self::getColor,
                         [=](osg::Vec3d& v) -> double& { return v[channel]; });
    };
    using Sun = Two<Self, &Self::setSun, &Self::getSunAzimuth, &Self::getSunElevation>;
    return {
        {"enabled", typed(&Self::setEnabled, &Self::getEnabled)},
        {"offsetX", offset(0)},
        {"offsetY", offset(1)},
        {"offsetHeight", offset(2)},
        {"scaleX",
         typed<Self>([](Self& c, double v) { return c.setScale(v, c.getScaleY(), c.getScaleHeight()); },
                     [](const Self& c) { return c.getScaleX(); })},
        {"scaleY",
         typed<Self>([](Self& c, double v) { return c.setScale(c.getScaleX(), v, c.getScaleHeight()); },
                     [](const Self& c) { return c.getScaleY(); })},
        {"scaleHeight",
         typed<Self>([](Self& c, double v) { return c.setScale(c.getScaleX(), c.getScaleY(), v); },
                     [](const Self& c) { return c.getScaleHeight(); })},
        {"orientation", typed(&Self::setOrientation, &Self::getOrientation)},
        {"tilt", typed(&Self::setTilt, &Self::getTilt)},
        {"turn", typed(&Self::setTurn, &Self::getTurn)},
        {"roundness", typed(&Self::setRoundness, &Self::getRoundness)},
        {"edge", typed(&Self::setEdge, &Self::getEdge)},
        {"red", color(0)},
        {"green", color(1)},
        {"blue", color(2)},
        {"surfaceOpacity", typed(&Self::setSurfaceOpacity, &Self::getSurfaceOpacity)},
        {"lighting", typed(&Self::setLighting, &Self::getLighting)},
        {"sunAzimuth", Sun::first()},
        {"sunElevation", Sun::second()},
        {"saturation", typed(&Self::setSaturation, &Self::getSaturation)},
        {"contrast", typed(&Self::setContrast, &Self::getContrast)},
        {"brightness", typed(&Self::setBrightness, &Self::getBrightness)},
        {"opacity", typed(&Self::setOpacity, &Self::getOpacity)},
        {"mappingChannels", typed(&Self::setMappingChannels, &Self::getMappingChannels)},
        {"activity", typed(&Self::setActivity, &Self::getActivity)},
        {"turnRate", typed(&Self::setTurnRate, &Self::getTurnRate)},
    };
}

inline TypedSetters regionSetters()
{
    using Self = osgGeoFX::RegionOfInterest;
    using Geodetic = Two<Self, &Self::setGeodeticCentre, &Self::getLongitude, &Self::getLatitude>;
    using Size = Two<Self, &Self::setSize, &Self::getWidth, &Self::getDepth>;
    return {
        {"centreX", component(
                        &Self::setCentre, &Self::getCentre, [](auto& v) -> auto& { return v.x(); })},
        {"centreY", component(
                        &Self::setCentre, &Self::getCentre, [](auto& v) -> auto& { return v.y(); })},
        {"longitude", Geodetic::first()},
        {"latitude", Geodetic::second()},
        {"base", typed(&Self::setBase, &Self::getBase)},
        {"width", Size::first()},
        {"depth", Size::second()},
        {"heading", typed(&Self::setHeading, &Self::getHeading)},
        {"shape", typed(&Self::setShape, &Self::getShape)},
        {"rounding", typed(&Self::setRounding, &Self::getRounding)},
        {"points", typed(&Self::setPoints, &Self::getPoints)},
        {"innerRadius", typed(&Self::setInnerRadius, &Self::getInnerRadius)},
        {"softness", typed(&Self::setSoftness, &Self::getSoftness)},
        {"maskSide", typed(&Self::setMaskSide, &Self::getMaskSide)},
    };
}

inline TypedSetters anchorSetters()
{
    using Self = osgGeoFX::Anchor;
    return {
        {"kind", typed(&Self::setKind, &Self::getKind)},
        {"style", typed(&Self::setStyle, &Self::getStyle)},
        {"opacity", typed(&Self::setOpacity, &Self::getOpacity)},
        {"lineWidth", typed(&Self::setLineWidth, &Self::getLineWidth)},
    };
}

inline TypedSetters surfaceSetters()
{
    using Self = osgGeoFX::SurfaceData;
    using Geodetic = Two<Self, &Self::setGeodeticOrigin, &Self::getLongitude, &Self::getLatitude>;
    const auto corner = [](bool high, int axis)
    {
        return Typed{[=](osgGeoFX::PropertyHolder& holder, double value)
                     {
                         auto& data = static_cast<Self&>(holder);
                         osg::Vec2d corners[2] = {data.getLow(), data.getHigh()};
                         corners[high ? 1 : 0][axis] = value;
                         return data.setRectangle(corners[0], corners[1]);
                     },
                     [=](const osgGeoFX::PropertyHolder& holder)
                     {
                         const auto& data = static_cast<const Self&>(holder);
                         return (high ? data.getHigh() : data.getLow())[axis];
                     }};
    };
    return {
        {"originX", component(
                        &Self::setOrigin, &Self::getOrigin, [](auto& v) -> auto& { return v.x(); })},
        {"originY", component(
                        &Self::setOrigin, &Self::getOrigin, [](auto& v) -> auto& { return v.y(); })},
        {"longitude", Geodetic::first()},
        {"latitude", Geodetic::second()},
        {"lowX", corner(false, 0)},
        {"lowY", corner(false, 1)},
        {"highX", corner(true, 0)},
        {"highY", corner(true, 1)},
    };
}

inline TypedSetters panoramaSetters()
{
    using Self = osgGeoFX::PanoramaMap;
    return {
        {"enabled", typed(&osgGeoFX::Effect::setEnabled, &osgGeoFX::Effect::getEnabled)},
        {"projection", typed(&Self::setProjection, &Self::getProjection)},
        {"viewRadius", typed(&Self::setViewRadius, &Self::getViewRadius)},
        {"horizonLine", typed(&Self::setHorizonLine, &Self::getHorizonLine)},
        {"curveDistance", typed(&Self::setCurveDistance, &Self::getCurveDistance)},
        {"horizonDistance", typed(&Self::setHorizonDistance, &Self::getHorizonDistance)},
        {"horizonBend", typed(&Self::setHorizonBend, &Self::getHorizonBend)},
        {"exaggeration", typed(&Self::setExaggeration, &Self::getExaggeration)},
        {"baseHeight", typed(&Self::setBaseHeight, &Self::getBaseHeight)},
        {"baseFromTerrain", typed(&Self::setBaseFromTerrain, &Self::getBaseFromTerrain)},
        {"detail", typed(&Self::setDetail, &Self::getDetail)},
        {"paint", typed(&Self::setPaint, &Self::getPaint)},
        {"season", typed(&Self::setSeason, &Self::getSeason)},
        {"snowLine", typed(&Self::setSnowLine, &Self::getSnowLine)},
        {"snowWidth", typed(&Self::setSnowWidth, &Self::getSnowWidth)},
        {"treeLine", typed(&Self::setTreeLine, &Self::getTreeLine)},
        {"cliffSlope", typed(&Self::setCliffSlope, &Self::getCliffSlope)},
        {"hillSlope", typed(&Self::setHillSlope, &Self::getHillSlope)},
        {"relief", typed(&Self::setRelief, &Self::getRelief)},
        {"brush", typed(&Self::setBrush, &Self::getBrush)},
        {"bottomShade", typed(&Self::setBottomShade, &Self::getBottomShade)},
        {"lightAzimuth", typed(&Self::setLightAzimuth, &Self::getLightAzimuth)},
        {"lightElevation", typed(&Self::setLightElevation, &Self::getLightElevation)},
        {"sceneLight", typed(&Self::setSceneLight, &Self::getSceneLight)},
        {"atmosphere", typed(&Self::setAtmosphere, &Self::getAtmosphere)},
        {"water", typed(&Self::setWater, &Self::getWater)},
        {"deepShore", typed(&Self::setDeepShore, &Self::getDeepShore)},
        {"reflection", typed(&Self::setReflection, &Self::getReflection)},
        {"ripples", typed(&Self::setRipples, &Self::getRipples)},
        {"sky", typed(&Self::setSky, &Self::getSky)},
        {"clouds", typed(&Self::setClouds, &Self::getClouds)},
        {"edge", typed(&Self::setEdge, &Self::getEdge)},
        {"edgeWidth", typed(&Self::setEdgeWidth, &Self::getEdgeWidth)},
        {"strokes", typed(&Self::setStrokes, &Self::getStrokes)},
        {"strokeSize", typed(&Self::setStrokeSize, &Self::getStrokeSize)},
        {"strokeSpacing", typed(&Self::setStrokeSpacing, &Self::getStrokeSpacing)},
        {"strokeStep", typed(&Self::setStrokeStep, &Self::getStrokeStep)},
        {"coverUnit", typed(&Self::setCoverUnit, &Self::getCoverUnit)},
        {"firstUnit", typed(&Self::setFirstUnit, &Self::getFirstUnit)},
        {"edgeUnit", typed(&Self::setEdgeUnit, &Self::getEdgeUnit)},
    };
}

inline const TypedSetters& typedSetters(const std::string& kind)
{
    static const TypedSetters deformations = deformationSetters();
    static const std::map<std::string, TypedSetters> others = {
        {"projectiveMappings", mappingsSetters()},
        {"projectiveMapping", mappingSetters()},
        {"dataLayer", layerSetters()},
        {"colorTransfer", transferSetters()},
        {"closeUps", closeUpsSetters()},
        {"closeUp", closeUpSetters()},
        {"regionOfInterest", regionSetters()},
        {"anchor", anchorSetters()},
        {"surfaceData", surfaceSetters()},
        {"panoramaMap", panoramaSetters()},
    };
    const auto found = others.find(kind);
    return found == others.end() ? deformations : found->second;
}

} // namespace geofx::test
