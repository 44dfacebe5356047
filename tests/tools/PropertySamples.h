// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace geofx::test
{

/// What a property needs beside it to take any value but its default: another one's value.
inline const std::map<std::string, std::pair<std::string, double>>& companions()
{
    static const std::map<std::string, std::pair<std::string, double>> all = {
        {"pixelsNone", {"pixelsFull", 1e6}},
        {"slopeNone", {"slopeFull", 0.0}},
    };
    return all;
}

/// An object with its defaults, but for what one of its properties needs beside it.
inline osg::ref_ptr<osgGeoFX::PropertyHolder> createHolder(const std::string& kind,
                                                           const std::string& property)
{
    osg::ref_ptr<osgGeoFX::PropertyHolder> holder = osgGeoFX::createPropertyHolder(kind);
    const auto companion = companions().find(property);
    if (companion == companions().end()) return holder;
    std::string error;
    EXPECT_TRUE(holder->setProperty(companion->second.first, companion->second.second, error)) << error;
    return holder;
}

/// A class and one of its properties: a row of the table that every test of properties goes through.
struct PropertyRow
{
    std::string kind;
    std::string name;

    const osgGeoFX::Property& property() const
    {
        // The table is a static one of the class.
        return *osgGeoFX::createPropertyHolder(kind)->property(name);
    }
    osg::ref_ptr<osgGeoFX::PropertyHolder> create() const { return createHolder(kind, name); }
};

inline std::ostream& operator<<(std::ostream& stream, const PropertyRow& row)
{
    return stream << row.kind << "." << row.name;
}

/// Every property of every class of the kit.
inline std::vector<PropertyRow> allProperties()
{
    std::vector<PropertyRow> rows;
    for (const std::string& kind : osgGeoFX::propertyHolderKinds())
        for (const osgGeoFX::Property& property : osgGeoFX::createPropertyHolder(kind)->properties())
            rows.push_back({kind, property.name});
    return rows;
}

inline bool isWhole(const osgGeoFX::Property& property)
{
    using Kind = osgGeoFX::Property::Kind;
    return property.kind != Kind::Number && property.kind != Kind::Angle;
}

/// Numbers to try, the default perhaps among them; those that are not whole have as many digits as a double holds.
inline std::vector<double> candidateValues(const osgGeoFX::Property& property)
{
    const double low = property.minimum;
    const double high = property.maximum;
    if (!isWhole(property))
    {
        const double digits = 1.0 / 3.0;
        // The points of a bending curve lie in order, so that all of them can be there at once.
        const std::string& name = property.name;
        if (name.rfind("curve", 0) == 0 && name[5] >= '1' && name[5] <= '6')
            return {(name[5] - '0') / 7.0, (name[5] - '0') / 7.0 - 0.01234567890123456789, low, high};
        // A cylindrical map has no strength between none and all.
        if (name == "strength") return {low, low + (high - low) * 0.1234567890123456789, high};
        return {low + (high - low) * 0.1234567890123456789,
                low + (high - low) * 0.7234567890123456789,
                property.defaultValue + digits,
                property.defaultValue - digits,
                low,
                high};
    }
    // All of a short range; of a long one its ends, the default's neighbours and the powers of two.
    std::vector<double> candidates;
    const bool all = high - low <= 32.0;
    for (double value = low; value <= high; value = all ? value + 1.0 : std::max(2.0 * value, value + 1.0))
        candidates.push_back(value);
    candidates.insert(candidates.end(), {property.defaultValue - 1.0, property.defaultValue + 1.0, high});
    return candidates;
}

/// The values, all but the default, that the object of row.create() takes.
inline std::vector<double> otherValues(const PropertyRow& row)
{
    const osgGeoFX::Property& property = row.property();
    std::vector<double> taken;
    for (const double value : candidateValues(property))
    {
        std::string error;
        if (value != property.defaultValue && row.create()->setProperty(row.name, value, error))
            taken.push_back(value);
    }
    return taken;
}

/// Takes every property of an object away from its default, and those of its parts.
inline void alter(osgGeoFX::PropertyHolder& holder)
{
    // A property may have to wait until others have made room for it.
    std::vector<const osgGeoFX::Property*> left;
    for (const osgGeoFX::Property& property : holder.properties())
        left.push_back(&property);
    const auto taken = [&](const osgGeoFX::Property* property)
    {
        std::string error;
        for (const double value : candidateValues(*property))
            if (value != property->defaultValue && holder.setProperty(property->name, value, error))
                return true;
        return false;
    };
    for (std::size_t before = left.size() + 1; before > left.size();)
    {
        before = left.size();
        left.erase(std::remove_if(left.begin(), left.end(), taken), left.end());
    }
    for (const osgGeoFX::Property* property : left)
        ADD_FAILURE() << holder.className() << "." << property->name << " takes no value but the default";
    for (const osgGeoFX::PropertyHolder::Part& part : holder.parts())
        alter(*part.object);
}

inline osg::ref_ptr<osgGeoFX::PropertyHolder> alteredHolder(const std::string& kind)
{
    osg::ref_ptr<osgGeoFX::PropertyHolder> holder = osgGeoFX::createPropertyHolder(kind);
    alter(*holder);
    return holder;
}

inline osg::ref_ptr<osgGeoFX::Effect> alteredEffect(const std::string& kind)
{
    osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::createEffect(kind);
    alter(*effect);
    return effect;
}

/// Fails for each property in which two objects differ, with those of their parts.
inline void expectSame(osgGeoFX::PropertyHolder& actual, osgGeoFX::PropertyHolder& expected)
{
    ASSERT_STREQ(actual.className(), expected.className());
    for (const osgGeoFX::Property& property : expected.properties())
        EXPECT_EQ(property.get(actual), property.get(expected))
            << expected.className() << "." << property.name;
    ASSERT_EQ(actual.parts().size(), expected.parts().size());
    for (std::size_t i = 0; i < expected.parts().size(); ++i)
        expectSame(*actual.parts()[i].object, *expected.parts()[i].object);
}

} // namespace geofx::test
