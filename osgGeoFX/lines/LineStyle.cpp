// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/lines/LineStyle.h>

namespace osgGeoFX
{

namespace
{

LineStyle road(double width, double ground, double casingWidth, double rank, const osg::Vec4& color)
{
    LineStyle style;
    style.color = color;
    style.casing.set(0.42f, 0.30f, 0.22f, 1.0f);
    style.width = width;
    style.ground = ground;
    style.casingWidth = casingWidth;
    style.rank = rank;
    return style;
}

LineStyle dashed(double width, double dash, double gap, double rank, const osg::Vec4& color)
{
    LineStyle style;
    style.color = color;
    style.width = width;
    style.dash = dash;
    style.gap = gap;
    style.rank = rank;
    return style;
}

} // namespace

std::map<std::string, LineStyle> usualLineStyles()
{
    const osg::Vec4 pale(0.99f, 0.96f, 0.88f, 1.0f), yellow(0.99f, 0.87f, 0.55f, 1.0f);
    const osg::Vec4 orange(0.95f, 0.66f, 0.36f, 1.0f), brown(0.38f, 0.26f, 0.18f, 1.0f);
    std::map<std::string, LineStyle> styles;
    styles[""] = LineStyle();
    styles["motorway"] = styles["trunk"] = road(3.6, 60.0, 0.7, 90.0, orange);
    styles["primary"] = road(2.8, 45.0, 0.6, 80.0, yellow);
    styles["secondary"] = road(2.3, 36.0, 0.5, 70.0, yellow);
    styles["tertiary"] = styles["road"] = road(2.0, 30.0, 0.5, 60.0, pale);
    LineStyle street = road(1.3, 16.0, 0.35, 50.0, pale);
    street.least = 0.4;
    for (const char* const name :
         {"unclassified", "residential", "living_street", "service", "street", "minor"})
        styles[name] = street;
    for (const char* const name : {"motorway_link", "trunk_link", "primary_link", "secondary_link"})
        styles[name] = styles["tertiary"];
    styles["track"] = dashed(1.2, 90.0, 30.0, 40.0, brown);
    for (const char* const name : {"path", "footway", "bridleway", "steps", "cycleway", "trail", "hiking"})
        styles[name] = dashed(1.2, 45.0, 30.0, 40.0, brown);
    LineStyle rail;
    rail.color.set(0.16f, 0.16f, 0.18f, 1.0f);
    rail.casingWidth = 0.4;
    rail.width = 1.5;
    rail.ground = 25.0;
    rail.rank = 85.0;
    rail.hand = 0.0;
    for (const char* const name : {"rail", "railway", "light_rail", "narrow_gauge", "tram", "funicular"})
        styles[name] = rail;
    LineStyle lift;
    lift.color.set(0.72f, 0.08f, 0.10f, 1.0f);
    lift.casingWidth = 0.4;
    lift.width = 1.6;
    lift.hand = 0.0;
    lift.rank = 100.0;
    lift.straight = true;
    for (const char* const name : {"cable_car", "gondola", "mixed_lift", "chair_lift", "drag_lift", "t-bar",
                                   "j-bar", "platter", "rope_tow", "magic_carpet", "zip_line", "lift"})
        styles[name] = lift;
    LineStyle piste;
    piste.color.set(0.13f, 0.36f, 0.78f, 1.0f);
    piste.casingWidth = 0.3;
    piste.width = 2.2;
    piste.ground = 30.0;
    piste.least = 0.6;
    piste.rank = 70.0;
    for (const char* const name : {"downhill", "snow_park", "sled", "connection", "piste"})
        styles[name] = piste;
    for (const char* const name : {"nordic", "skitour"})
        styles[name] = dashed(1.4, 60.0, 30.0, 65.0, piste.color);
    LineStyle river;
    river.color.set(0.24f, 0.46f, 0.66f, 1.0f);
    river.width = 3.0;
    river.ground = 40.0;
    river.hand = 0.35;
    river.rank = 20.0;
    styles["river"] = river;
    river.width = 1.5;
    river.ground = 15.0;
    river.least = 0.5;
    river.rank = 10.0;
    for (const char* const name : {"stream", "canal", "ditch", "drain", "waterway"})
        styles[name] = river;
    for (const char* const name : {"administrative", "border", "boundary", "national_park", "protected_area"})
        styles[name] = dashed(1.8, 300.0, 120.0, 30.0, osg::Vec4(0.56f, 0.20f, 0.36f, 1.0f));
    LineStyle route;
    route.color.set(0.84f, 0.12f, 0.16f, 1.0f);
    route.casingWidth = 0.8;
    route.width = 3.0;
    route.ground = 80.0;
    route.least = 1.2;
    route.rank = 95.0;
    styles["route"] = route;
    return styles;
}

const LineStyle& lineStyleOf(const std::map<std::string, LineStyle>& styles, const std::string& name)
{
    static const LineStyle usual;
    for (const std::string& each : {name, std::string()})
        if (const auto found = styles.find(each); found != styles.end()) return found->second;
    return usual;
}

} // namespace osgGeoFX
