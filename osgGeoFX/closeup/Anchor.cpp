// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/Anchor.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Table = std::vector<float>;

/// Eight bands as wide as the gaps between them, with soft edges, clear at both ends.
Table rings()
{
    constexpr int bands = 8;
    Table table;
    for (int i = 0; i <= 4 * bands; ++i)
        table.push_back(i % 4 == 1 || i % 4 == 2 ? 1.0f : 0.0f);
    return table;
}

const Table& readyTable(int style)
{
    // In the order of Anchor::Style, TABLE excepted.
    static const std::vector<Table> all = {{1.0f, 1.0f},       {0.35f, 0.35f},     {0.0f, 1.0f}, {1.0f, 0.0f},
                                           {1.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f}, rings()};
    return all[static_cast<std::size_t>(style)];
}

} // namespace

Anchor::Anchor() = default;

Anchor::Anchor(const Anchor& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy), _table(other._table)
{
    for (const Property& property : Anchor::properties())
        property.put(*this, property.get(other));
}

Anchor::~Anchor() = default;

const Properties& Anchor::properties() const
{
    using Self = Anchor;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::choice("kind", "what it is",
                             {{"none", ""},
                              {"stretched", "the terrain's triangles"},
                              {"contour", "a wall along the region's border"}})
                .of<&Self::_kind>(),
            Property::choice("style", "how it becomes transparent; in a scene file, table where there is one",
                             {{"solid", ""},
                              {"veil", "alike everywhere"},
                              {"rising", "clear at the ground"},
                              {"falling", "clear at the close-up"},
                              {"ends", "clear between"},
                              {"middle", "clear at both ends"},
                              {"rings", ""},
                              {"table", "by a table of opacities"}})
                .of<&Self::_style>(),
            Property::number("opacity", "the opacity of all of it", 0.0, 1.0).of<&Self::_opacity>(),
            Property::number("lineWidth", "the width of the lines around the region and the close-up", 0.0,
                             64.0, "px")
                .of<&Self::_lineWidth>(),
        });
    return all;
}

bool Anchor::setTable(const std::vector<float>& opacities)
{
    // This way round NaN is out of range.
    const bool within = std::all_of(opacities.begin(), opacities.end(),
                                    [](float opacity) { return opacity >= 0.0f && opacity <= 1.0f; });
    if (opacities.size() < 2 || opacities.size() > 256 || !within)
    {
        OSG_WARN << "osgGeoFX: Anchor: "
                 << (within ? "a table needs 2 to 256 opacities." : "a table's opacities must be 0 to 1.")
                 << " The former one stays." << std::endl;
        return false;
    }
    if (_style == TABLE && opacities == _table) return true;
    _table = opacities;
    _style = TABLE;
    touch();
    return true;
}

double Anchor::opacityAt(double height) const
{
    const Table& table = _style == TABLE ? _table : readyTable(_style);
    // Beyond the ends as at them; this way round NaN is at the ground.
    const double share = height > 0.0 ? std::min(height, 1.0) : 0.0;
    const double place = share * static_cast<double>(table.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), table.size() - 2);
    const auto low = static_cast<double>(table[below]), high = static_cast<double>(table[below + 1]);
    return _opacity * (low + (high - low) * (place - static_cast<double>(below)));
}

} // namespace osgGeoFX
