// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PaperPath.h"

#include "BenchError.h"

#include <osg/Math>

#include <algorithm>
#include <cstddef>

namespace geofx::bench
{

namespace
{

using osgGeoFX::ViewPoint;

ViewPoint place(double longitude, double latitude, double height, double heading, double pitch)
{
    return {osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), height,
            osg::DegreesToRadians(heading),   osg::DegreesToRadians(pitch),    0.0};
}

} // namespace

osg::Matrixd PaperPath::view(double share, const osgGeoFX::Georeference& reference) const
{
    const double along = std::clamp(share, 0.0, 1.0) * static_cast<double>(places.size() - 1);
    const auto first = std::min(static_cast<std::size_t>(along), places.size() - 2);
    const ViewPoint here =
        osgGeoFX::interpolate(places[first], places[first + 1], along - static_cast<double>(first));
    osg::Matrixd matrix;
    if (!here.viewMatrix(reference, matrix))
        throw BenchError("The terrain database has no place for the paths; take one that covers Oahu.");
    return matrix;
}

const std::vector<PaperPath>& paperPaths()
{
    static const std::vector<PaperPath> paths = {
        {"pedestrian-1",
         "a way between Waikiki's towers, the town folded up ahead",
         "pedestrianView bendAngle=45 focusDistance=700 zoneWidth=1200 planeHeight=5 tallest=150",
         {place(-157.8165, 21.2790, 75.0, 312.0, -1.0), place(-157.8260, 21.2860, 75.0, 318.0, -1.0),
          place(-157.8320, 21.2930, 75.0, 300.0, -1.0)},
         1.0,
         1.0,
         true,
         {{{12.95, 11.72}, {15.63, 17.85}, {16.49, 20.54}}},
         407822.0,
         260207.0},
        {"pedestrian-2",
         "a way down a hill, the town behind it folded up",
         "pedestrianView bendAngle=42 focusDistance=2300 zoneWidth=2500 tallest=500",
         {place(-157.8170, 21.3320, 650.0, 214.0, -3.0), place(-157.8290, 21.3190, 500.0, 185.0, -3.0)},
         1.0,
         1.0,
         true,
         {{{15.69, 19.33}, {17.69, 22.75}, {18.42, 23.94}}},
         215398.0,
         122729.0},
        {"birdsEye-3",
         "a flight from Diamond Head to downtown, the skyline behind the town",
         "birdsEyeView focusLine=0.35 horizonLine=0.84 contextTilt=0.15",
         {place(-157.8100, 21.2450, 2200.0, 325.0, -42.0), place(-157.8600, 21.2850, 2200.0, 345.0, -42.0)},
         0.8,
         2.5,
         false,
         {{{29.86, 8.35}, {27.24, 8.87}, {27.26, 8.74}}},
         190824.0,
         5720803.0},
        {"birdsEye-4",
         "a turn high above the harbor, from the Koolau to the Waianae Range",
         "birdsEyeView focusLine=0.35 horizonLine=0.84 contextTilt=0.15",
         {place(-157.8620, 21.2660, 4000.0, 25.0, -42.0), place(-157.8750, 21.2800, 4000.0, -35.0, -42.0)},
         0.8,
         2.5,
         false,
         {{{17.64, 6.73}, {16.07, 5.42}, {19.52, 8.48}}},
         243067.0,
         2555602.0}};
    return paths;
}

} // namespace geofx::bench
