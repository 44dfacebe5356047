// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LayerWords.h>

#include <osg/UserDataContainer>
#include <osg/ValueObject>

#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr const char* unitKey = "geofx.unit";
constexpr const char* classKeys = "geofx.class.";

/// Classes are whole numbers as a rule.
std::string classKey(double number)
{
    const bool whole = std::abs(number) < 1e15 && number == std::floor(number);
    return classKeys + (whole ? std::to_string(static_cast<long long>(number)) : std::to_string(number));
}

std::string textOf(const DataLayer& layer, const std::string& key)
{
    std::string text;
    layer.getUserValue(key, text);
    return text;
}

} // namespace

void LayerWords::setUnit(DataLayer& layer, const std::string& unit)
{
    if (unit != unitOf(layer)) layer.setUserValue(unitKey, unit);
}

std::string LayerWords::unitOf(const DataLayer& layer)
{
    return textOf(layer, unitKey);
}

void LayerWords::setNames(DataLayer& layer, const std::map<double, std::string>& names)
{
    for (const auto& [number, name] : names)
        layer.setUserValue(classKey(number), name);
}

std::string LayerWords::nameOf(const DataLayer& layer, double number)
{
    return textOf(layer, classKey(number));
}

void LayerWords::copy(const DataLayer& from, DataLayer& to)
{
    const osg::UserDataContainer* const all = from.getUserDataContainer();
    for (unsigned int i = 0; all && i < all->getNumUserObjects(); ++i)
    {
        const std::string& key = all->getUserObject(i)->getName();
        if (key == unitKey || key.rfind(classKeys, 0) == 0) to.setUserValue(key, textOf(from, key));
    }
}

} // namespace osgGeoFX
