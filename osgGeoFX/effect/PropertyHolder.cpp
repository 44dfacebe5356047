// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/Notify>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

PropertyHolder::~PropertyHolder() = default;

void PropertyHolder::removeListener(PropertyListener& listener)
{
    // One of them, where it listens for two reasons.
    const auto found = std::find(_listeners.begin(), _listeners.end(), &listener);
    if (found != _listeners.end()) _listeners.erase(found);
}

void PropertyHolder::touch()
{
    ++_revision;
    for (PropertyListener* listener : _listeners)
        listener->propertyChanged(*this);
}

const Property* PropertyHolder::property(const std::string& name) const
{
    const Properties& all = properties();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Property& each) { return each.name == name; });
    return found == all.end() ? nullptr : &*found;
}

bool PropertyHolder::setProperty(const std::string& name, double value, std::string& error)
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

double PropertyHolder::getProperty(const std::string& name) const
{
    const Property* found = property(name);
    return found ? found->get(*this) : 0.0;
}

bool PropertyHolder::setProperties(const std::map<std::string, double>& values, std::string& error)
{
    // All that are in range together, and only then the question whether they fit each other.
    std::map<const Property*, double> former;
    bool changed = false;
    std::string sentences;
    const auto refuse = [&](const std::string& sentence)
    {
        sentences += (sentences.empty() ? "" : " ") + sentence;
    };
    for (const auto& [name, value] : values)
    {
        const Property* found = property(name);
        const std::string fault = found ? found->refusal(value) : "there is no property " + name + ".";
        if (!fault.empty()) refuse(std::string(className()) + ": " + fault);
        if (!fault.empty()) continue;
        former[found] = found->get(*this);
        changed = changed || former[found] != value;
        found->put(*this, value);
    }
    if (inconsistency().empty())
    {
        if (changed) touch();
    }
    else
    {
        std::map<const Property*, double> wanted;
        for (const auto& [each, value] : former)
        {
            wanted[each] = each->get(*this);
            each->put(*this, value);
        }
        // One after the other, again and again, as long as one more is taken.
        std::map<const Property*, std::string> refused;
        for (std::size_t left = wanted.size() + 1; left > wanted.size();)
        {
            left = wanted.size();
            refused.clear();
            for (auto each = wanted.begin(); each != wanted.end();)
            {
                std::string sentence;
                const bool taken = setProperty(each->first->name, each->second, sentence);
                if (!taken) refused[each->first] = sentence;
                each = taken ? wanted.erase(each) : std::next(each);
            }
        }
        for (const auto& [each, sentence] : refused)
            refuse(sentence);
    }
    error = sentences;
    return sentences.empty();
}

bool PropertyHolder::setPropertyText(const std::string& name, const std::string& value, std::string& error)
{
    return setPropertyTexts({{name, value}}, error);
}

bool PropertyHolder::setPropertyTexts(const Texts& texts, std::string& error)
{
    std::map<std::string, double> values;
    std::map<const char*, Texts> ofParts;
    const std::vector<Part> allParts = parts();
    for (const auto& [name, text] : texts)
    {
        const auto part = std::find_if(allParts.begin(), allParts.end(),
                                       [&, &start = name](const Part& each)
                                       { return start.rfind(std::string(each.name) + ".", 0) == 0; });
        if (part != allParts.end())
        {
            ofParts[part->name].emplace_back(name.substr(std::string(part->name).size() + 1), text);
            continue;
        }
        const Properties& all = properties();
        const auto found =
            std::find_if(all.begin(), all.end(),
                         [&, &wanted = name](const Property& each) { return each.name == wanted; });
        if (found == all.end())
        {
            error = std::string(className()) + " has no property " + name + "; it has ";
            for (const Property& each : all)
                error += (&each == &all.front() ? "" : ", ") + each.name;
            error += ".";
            return false;
        }
        if (!found->parse(text, values[found->name], error))
        {
            error.insert(0, std::string(className()) + ": ");
            return false;
        }
    }
    for (const Part& part : allParts)
    {
        const auto found = ofParts.find(part.name);
        if (found == ofParts.end()) continue;
        if (!part.object->setPropertyTexts(found->second, error)) return false;
        touch();
    }
    return setProperties(values, error);
}

bool PropertyHolder::assign(const char* name, double value)
{
    std::string error;
    if (setProperty(name, value, error)) return true;
    OSG_WARN << "osgGeoFX: " << error << " The former value stays." << std::endl;
    return false;
}

bool PropertyHolder::assign(const std::map<std::string, double>& values)
{
    std::map<std::string, double> former;
    for (const auto& [name, value] : values)
        former[name] = getProperty(name);
    std::string error;
    if (setProperties(values, error)) return true;
    // All or nothing: those that were taken go back.
    std::string none;
    setProperties(former, none);
    OSG_WARN << "osgGeoFX: " << error << " The former values stay." << std::endl;
    return false;
}

} // namespace osgGeoFX
