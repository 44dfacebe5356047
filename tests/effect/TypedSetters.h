// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The typed setters and getters of every property of every class. Those that are called as their property, setBrush()
// and getBrush(), are found by themselves; here are the others.
#pragma once

#include <effect/TypedSetter.h>
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/ground/GroundDetail.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <type_traits>

namespace geofx::test
{

/// The color of a property's value; one that setters refuse, of a value that the property refuses.
inline osg::Vec3d colorOf(double value)
{
    return value > 0xffffff ? osg::Vec3d(1.5, 0.0, 0.0) : osgGeoFX::unpackedColor(static_cast<int>(value));
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
        {"originX", component(
                        &Self::setOrigin, &Self::getOrigin, [](auto& v) -> auto& { return v.x(); })},
        {"originY", component(
                        &Self::setOrigin, &Self::getOrigin, [](auto& v) -> auto& { return v.y(); })},
        {"longitude", Geodetic::first()},
        {"latitude", Geodetic::second()},
        {"dataUnit", unit(0)},
        {"layerUnit", unit(1)},
        {"tableUnit", unit(2)},
        {"pageUnit",
         typed<Self>([](Self& o, double v) { return o.setCacheUnits(int(v), o.getPageTableUnit()); },
                     [](const Self& o) { return static_cast<double>(o.getPageUnit()); })},
        {"pageTableUnit",
         typed<Self>([](Self& o, double v) { return o.setCacheUnits(o.getPageUnit(), static_cast<int>(v)); },
                     [](const Self& o) { return static_cast<double>(o.getPageTableUnit()); })},
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
        {"centerX", component(
                        &Self::setCenter, &Self::getCenter, [](auto& v) -> auto& { return v.x(); })},
        {"centerY", component(
                        &Self::setCenter, &Self::getCenter, [](auto& v) -> auto& { return v.y(); })},
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
        {"hasNoData",
         typed<Self>([](Self& layer, double value)
                     { return value != 0.0 ? layer.setNoData(layer.getNoData()) : layer.clearNoData(); },
                     [](const Self& layer) { return layer.getHasNoData() ? 1.0 : 0.0; })},
    };
}

inline TypedSetters transferSetters()
{
    using Self = osgGeoFX::ColorTransfer;
    using Range = Two<Self, &Self::setValueRange, &Self::getLowValue, &Self::getHighValue>;
    using Ramp = Two<Self, &Self::setRamp, &Self::getRampLow, &Self::getRampHigh>;
    TypedSetters all = {
        {"sourceFactor",
         typed<Self>([](Self& t, double v)
                     { return t.setBlendFunction(static_cast<Self::Factor>(v), t.getDestinationFactor()); },
                     [](const Self& t) { return static_cast<double>(t.getSourceFactor()); })},
        {"destinationFactor",
         typed<Self>([](Self& t, double v)
                     { return t.setBlendFunction(t.getSourceFactor(), static_cast<Self::Factor>(v)); },
                     [](const Self& t) { return static_cast<double>(t.getDestinationFactor()); })},
        {"lowValue", Range::first()},
        {"highValue", Range::second()},
        {"rampLow", Ramp::first()},
        {"rampHigh", Ramp::second()},
    };
    all["constantColor"] = typed<Self>(
        [](Self& t, double v) {
            return t.setConstant({colorOf(v), t.getConstant().w()});
        },
        [](const Self& t)
        {
            const osg::Vec4d c = t.getConstant();
            return static_cast<double>(osgGeoFX::packedColor({c.x(), c.y(), c.z()}));
        });
    all["constantAlpha"] =
        component(&Self::setConstant, &Self::getConstant, [](osg::Vec4d& v) -> double& { return v.w(); });
    const char* const parts[] = {"red", "green", "blue"};
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
        {"maskUnit", unit(0)},
        {"tableUnit", unit(1)},
        {"surfaceUnit", unit(2)},
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
    using Sun = Two<Self, &Self::setSun, &Self::getSunAzimuth, &Self::getSunElevation>;
    return {
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
        {"color", typed<Self>([](Self& c, double v) { return c.setColor(colorOf(v)); }, [](const Self& c)
                              { return static_cast<double>(osgGeoFX::packedColor(c.getColor())); })},
        {"sunAzimuth", Sun::first()},
        {"sunElevation", Sun::second()},
    };
}

inline TypedSetters regionSetters()
{
    using Self = osgGeoFX::RegionOfInterest;
    using Geodetic = Two<Self, &Self::setGeodeticCenter, &Self::getLongitude, &Self::getLatitude>;
    using Size = Two<Self, &Self::setSize, &Self::getWidth, &Self::getDepth>;
    return {
        {"centerX", component(
                        &Self::setCenter, &Self::getCenter, [](auto& v) -> auto& { return v.x(); })},
        {"centerY", component(
                        &Self::setCenter, &Self::getCenter, [](auto& v) -> auto& { return v.y(); })},
        {"longitude", Geodetic::first()},
        {"latitude", Geodetic::second()},
        {"width", Size::first()},
        {"depth", Size::second()},
    };
}

inline TypedSetters routeSetters()
{
    using Self = osgGeoFX::RouteMapping;
    using Style = Self::Style;
    const auto number = [](double Style::*member)
    {
        return component(&Self::setStyle, &Self::getStyle,
                         [=](Style& style) -> double& { return style.*member; });
    };
    const auto alpha = [](osg::Vec4d Style::*member)
    {
        return component(&Self::setStyle, &Self::getStyle,
                         [=](Style& style) -> double& { return (style.*member).w(); });
    };
    const auto color = [](osg::Vec4d Style::*member)
    {
        return Typed{[=](osgGeoFX::PropertyHolder& holder, double value)
                     {
                         auto& route = static_cast<Self&>(holder);
                         Style style = route.getStyle();
                         style.*member = osg::Vec4d(colorOf(value), (style.*member).w());
                         return route.setStyle(style);
                     },
                     [=](const osgGeoFX::PropertyHolder& holder)
                     {
                         const osg::Vec4d c = static_cast<const Self&>(holder).getStyle().*member;
                         return static_cast<double>(osgGeoFX::packedColor({c.x(), c.y(), c.z()}));
                     }};
    };
    return {
        {"halfWidth", number(&Style::halfWidth)},
        {"casing", number(&Style::casing)},
        {"color", color(&Style::color)},
        {"colorAlpha", alpha(&Style::color)},
        {"casingColor", color(&Style::casingColor)},
        {"casingAlpha", alpha(&Style::casingColor)},
        {"highlightColor", color(&Style::highlightColor)},
        {"highlightAlpha", alpha(&Style::highlightColor)},
        {"dash", number(&Style::dash)},
        {"gap", number(&Style::gap)},
        {"pointRadius", number(&Style::pointRadius)},
        {"pointPixels", number(&Style::pointPixels)},
        {"context", Typed{[](osgGeoFX::PropertyHolder& holder, double value)
                          {
                              auto& route = static_cast<Self&>(holder);
                              Style style = route.getStyle();
                              style.context = value > 0.0;
                              return route.setStyle(style);
                          },
                          [](const osgGeoFX::PropertyHolder& holder)
                          {
                              return static_cast<const Self&>(holder).getStyle().context ? 1.0 : 0.0;
                          }}},
        {"surroundings", number(&Style::surroundings)},
        {"softness", number(&Style::softness)},
        {"brightness", number(&Style::brightness)},
        {"saturation", number(&Style::saturation)},
        {"contextReach", number(&Style::contextReach)},
    };
}

inline TypedSetters clockSetters()
{
    using Self = osgGeoFX::LayerClock;
    using Range = Two<Self, &Self::setRange, &Self::getBegin, &Self::getEnd>;
    return {{"begin", Range::first()}, {"end", Range::second()}};
}

inline TypedSetters libertySetters()
{
    using Self = osgGeoFX::RegionalLiberty;
    using Geodetic = Two<Self, &Self::setGeodeticCenter, &Self::getLongitude, &Self::getLatitude>;
    using Radii = Two<Self, &Self::setRadii, &Self::getAcross, &Self::getAlong>;
    return {
        {"centerX", component(
                        &Self::setCenter, &Self::getCenter, [](auto& v) -> auto& { return v.x(); })},
        {"centerY", component(
                        &Self::setCenter, &Self::getCenter, [](auto& v) -> auto& { return v.y(); })},
        {"longitude", Geodetic::first()},
        {"latitude", Geodetic::second()},
        {"across", Radii::first()},
        {"along", Radii::second()},
    };
}

inline TypedSetters panoramaSetters()
{
    using Self = osgGeoFX::PanoramaMap;
    TypedSetters result;
    for (unsigned int i = 0; i < Self::mostCurvePoints; ++i)
    {
        for (const int axis : {0, 1})
        {
            const auto set = [=](osgGeoFX::PropertyHolder& holder, double value)
            {
                auto& map = static_cast<Self&>(holder);
                osg::Vec2d point = map.getCurvePoint(i);
                point[axis] = value;
                return map.setCurvePoint(i, point);
            };
            const auto get = [=](const osgGeoFX::PropertyHolder& holder)
            {
                return static_cast<const Self&>(holder).getCurvePoint(i)[axis];
            };
            result["curve" + std::to_string(i + 1) + (axis == 0 ? "Distance" : "Height")] = Typed{set, get};
        }
    }
    return result;
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

/// A setter and a getter that are called as the property is; nothing where a class has others.
template<typename Class, typename Pair>
void addPlain(TypedSetters& setters, const char* name, Pair pair)
{
    if constexpr (std::is_invocable_v<Pair, Class*>) setters[name] = pair(static_cast<Class*>(nullptr));
}

inline const TypedSetters& typedSetters(const std::string& kind)
{
    static const std::map<std::string, TypedSetters> all = []
    {
        std::map<std::string, TypedSetters> result = {
            {"projectiveMappings", mappingsSetters()},
            {"projectiveMapping", mappingSetters()},
            {"dataLayer", layerSetters()},
            {"routeMapping", routeSetters()},
            {"layerClock", clockSetters()},
            {"colorTransfer", transferSetters()},
            {"regionalLiberty", libertySetters()},
            {"panoramaMap", panoramaSetters()},
            {"closeUps", closeUpsSetters()},
            {"closeUp", closeUpSetters()},
            {"regionOfInterest", regionSetters()},
            {"surfaceData", surfaceSetters()},
        };
#define GEOFX_PROPERTY(kind, Class, name, Name)                                                              \
    addPlain<osgGeoFX::Class>(                                                                               \
        result[#kind], #name,                                                                                \
        [](auto* of) -> decltype(typed(&std::remove_pointer_t<decltype(of)>::set##Name,                      \
                                       &std::remove_pointer_t<decltype(of)>::get##Name))                     \
        {                                                                                                    \
            using Self = std::remove_pointer_t<decltype(of)>;                                                \
            return typed(&Self::set##Name, &Self::get##Name);                                                \
        });
// Made by the build from the classes' tables.
#include <PlainSetters.inc>
#undef GEOFX_PROPERTY
        return result;
    }();
    return all.at(kind);
}

} // namespace geofx::test
