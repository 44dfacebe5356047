// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectKinds.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace geofx::test
{

/// A kind of effect and one of its properties: a row of the table that every test of properties goes through.
struct PropertyRow
{
    std::string kind;
    std::string name;

    const osgGeoFX::Property& property() const
    {
        // The table is a static one of the class.
        return *osgGeoFX::createEffect(kind)->property(name);
    }
};

inline std::ostream& operator<<(std::ostream& stream, const PropertyRow& row)
{
    return stream << row.kind << "." << row.name;
}

/// Every property of every effect of the kit.
inline std::vector<PropertyRow> allProperties()
{
    std::vector<PropertyRow> rows;
    for (const std::string& kind : osgGeoFX::effectKinds())
        for (const osgGeoFX::Property& property : osgGeoFX::createEffect(kind)->properties())
            rows.push_back({kind, property.name});
    return rows;
}

inline bool isWhole(const osgGeoFX::Property& property)
{
    using Kind = osgGeoFX::Property::Kind;
    return property.kind == Kind::Flag || property.kind == Kind::Choice || property.kind == Kind::Integer;
}

/// Values that an effect with its defaults takes, all but the default; numbers have as many digits as a double holds.
inline std::vector<double> otherValues(const std::string& kind, const osgGeoFX::Property& property)
{
    std::vector<double> candidates;
    const double low = property.minimum;
    const double high = property.maximum;
    if (isWhole(property))
    {
        // All of a short range; of a long one its ends, the default's neighbours and the powers of two.
        const bool all = high - low < 32.0;
        for (double value = low; value <= high;
             value = all ? value + 1.0 : std::max(2.0 * value, value + 1.0))
            candidates.push_back(value);
        for (const double value : {property.defaultValue - 1.0, property.defaultValue + 1.0, high})
            candidates.push_back(value);
    }
    else
    {
        const double digits = 1.0 / 3.0;
        candidates = {low + (high - low) * 0.1234567890123456789,
                      low + (high - low) * 0.7234567890123456789,
                      property.defaultValue + digits,
                      property.defaultValue - digits,
                      low,
                      high};
    }
    std::vector<double> taken;
    for (const double value : candidates)
    {
        std::string error;
        if (value != property.defaultValue &&
            osgGeoFX::createEffect(kind)->setProperty(property.name, value, error))
            taken.push_back(value);
    }
    return taken;
}

/// An effect in which no property is at its default, of its parts neither.
inline void alter(osgGeoFX::PropertyHolder& effect)
{
    for (const osgGeoFX::Property& property : effect.properties())
    {
        std::string error;
        EXPECT_TRUE(
            effect.setProperty(property.name, otherValues(osgGeoFX::kindOf(effect), property).at(0), error))
            << error;
    }
    for (const osgGeoFX::PropertyHolder::Part& part : effect.parts())
        alter(*part.object);
}

inline osg::ref_ptr<osgGeoFX::Effect> alteredEffect(const std::string& kind)
{
    osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::createEffect(kind);
    alter(*effect);
    return effect;
}

/// Fails for each property in which two effects differ, with those of their parts.
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
