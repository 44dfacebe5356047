// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/Effect.h>

#include <osg/Notify>

#include <algorithm>

namespace osgGeoFX
{

Effect::~Effect() = default;

Property Effect::enabledProperty()
{
    return Property::flag("enabled", true).of<&Effect::_enabled>();
}

const Property* Effect::property(const std::string& name) const
{
    const Properties& all = properties();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Property& each) { return each.name == name; });
    return found == all.end() ? nullptr : &*found;
}

bool Effect::setProperty(const std::string& name, double value, std::string& error)
{
    const Property* found = property(name);
    if (!found)
    {
        error = std::string(className()) + " has no property " + name + ".";
        return false;
    }
    error = found->refusal(value);
    if (error.empty())
    {
        const double former = found->get(*this);
        found->put(*this, value);
        error = inconsistency();
        if (error.empty())
        {
            if (former != value) touch();
            return true;
        }
        found->put(*this, former);
    }
    error = std::string(className()) + ": " + error;
    return false;
}

double Effect::getProperty(const std::string& name) const
{
    const Property* found = property(name);
    return found ? found->get(*this) : 0.0;
}

bool Effect::setPropertyText(const std::string& name, const std::string& value, std::string& error)
{
    for (const Part& part : parts())
    {
        const std::string start = std::string(part.name) + ".";
        if (name.compare(0, start.size(), start) == 0)
        {
            const bool taken = part.effect->setPropertyText(name.substr(start.size()), value, error);
            if (taken) touch();
            return taken;
        }
    }
    for (const Property& each : properties())
    {
        if (each.textName() != name) continue;
        double number = 0.0;
        if (each.parse(value, number, error)) return setProperty(each.name, number, error);
        error = std::string(className()) + ": " + error;
        return false;
    }
    error = std::string(className()) + " has no property " + name + ".";
    return false;
}

bool Effect::assign(const char* name, double value)
{
    std::string error;
    if (setProperty(name, value, error)) return true;
    OSG_WARN << "osgGeoFX: " << error << " The former value stays." << std::endl;
    return false;
}

} // namespace osgGeoFX
