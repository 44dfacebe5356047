// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <array>
#include <functional>
#include <map>
#include <string>

namespace geofx::test
{

/// A typed setter and getter.
struct Typed
{
    std::function<bool(osgGeoFX::PropertyHolder&, double)> set;
    std::function<double(const osgGeoFX::PropertyHolder&)> get;
};

template<typename Class, typename Value>
Typed typed(bool (Class::*setter)(Value), Value (Class::*getter)() const)
{
    return {[setter](osgGeoFX::PropertyHolder& holder, double value)
            { return (static_cast<Class&>(holder).*setter)(static_cast<Value>(value)); },
            [getter](const osgGeoFX::PropertyHolder& holder)
            {
                return static_cast<double>((static_cast<const Class&>(holder).*getter)());
            }};
}

/// Of a setter for several values.
template<typename Class>
Typed typed(bool (*set)(Class&, double), double (*get)(const Class&))
{
    return {[set](osgGeoFX::PropertyHolder& holder, double value)
            { return set(static_cast<Class&>(holder), value); },
            [get](const osgGeoFX::PropertyHolder& holder)
            {
                return get(static_cast<const Class&>(holder));
            }};
}

/// Of a component of a value that is set as a whole.
template<typename Class, typename Whole, typename Access>
Typed component(bool (Class::*setter)(const Whole&), Whole (Class::*getter)() const, Access access)
{
    return {[=](osgGeoFX::PropertyHolder& holder, double value)
            {
                auto& object = static_cast<Class&>(holder);
                Whole whole = (object.*getter)();
                access(whole) = value;
                return (object.*setter)(whole);
            },
            [=](const osgGeoFX::PropertyHolder& holder)
            {
                Whole whole = (static_cast<const Class&>(holder).*getter)();
                return static_cast<double>(access(whole));
            }};
}

/// Sets one of two values that have a setter in common.
template<typename Class, bool (Class::*Set)(double, double), double (Class::*First)() const,
         double (Class::*Second)() const>
struct Two
{
    static bool setFirst(Class& object, double value) { return (object.*Set)(value, (object.*Second)()); }
    static bool setSecond(Class& object, double value) { return (object.*Set)((object.*First)(), value); }
    static Typed first()
    {
        return typed<Class>(&setFirst, [](const Class& c) { return (c.*First)(); });
    }
    static Typed second()
    {
        return typed<Class>(&setSecond, [](const Class& c) { return (c.*Second)(); });
    }
};

using TypedSetters = std::map<std::string, Typed>;

/// Of three whole numbers that have a setter in common.
template<typename Class, int (Class::*... Get)() const>
Typed oneOf(bool (Class::*set)(int, int, int), std::size_t which)
{
    const auto all = [](const osgGeoFX::PropertyHolder& holder)
    {
        const auto& object = static_cast<const Class&>(holder);
        return std::array<int, 3>{(object.*Get)()...};
    };
    return {[=](osgGeoFX::PropertyHolder& holder, double value)
            {
                std::array<int, 3> values = all(holder);
                values[which] = static_cast<int>(value);
                return (static_cast<Class&>(holder).*set)(values[0], values[1], values[2]);
            },
            [=](const osgGeoFX::PropertyHolder& holder)
            {
                return static_cast<double>(all(holder)[which]);
            }};
}

} // namespace geofx::test
