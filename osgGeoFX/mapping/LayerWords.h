// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/DataLayer.h>

#include <map>
#include <string>

namespace osgGeoFX
{

/** What a layer's numbers mean to people: their unit, and the names of classes. Drawing needs none of it. They are user values
    of the layer (osg::Object::setUserValue(), "geofx.unit" and "geofx.class.3"), so OSG's files have them. UTF-8.
    @ingroup mapping */
struct OSGGEOFX_EXPORT LayerWords
{
    /// "mm", "dB(A)". Empty: none.
    static void setUnit(DataLayer& layer, const std::string& unit);
    static std::string unitOf(const DataLayer& layer);
    /// The names of classes by their numbers. Other names that the layer has stay.
    static void setNames(DataLayer& layer, const std::map<double, std::string>& names);
    /// The name of a class; empty where it has none.
    static std::string nameOf(const DataLayer& layer, double number);
    /// Gives a layer all that another one has.
    static void copy(const DataLayer& from, DataLayer& to);
};

} // namespace osgGeoFX
