// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/TableRows.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

GpuStore::Table texelsOf(const ColorTable& table, double low, double high, int row)
{
    std::vector<osg::Vec4us> colors(GpuStore::tableWidth);
    table.row(low, high, colors.data(), GpuStore::tableWidth);
    GpuStore::Table result{row, std::vector<std::uint16_t>(4 * colors.size())};
    for (std::size_t i = 0; i < colors.size(); ++i)
        std::copy(colors[i].ptr(), colors[i].ptr() + 4,
                  result.texels.begin() + static_cast<std::ptrdiff_t>(4 * i));
    return result;
}

} // namespace

void TableRows::reset()
{
    for (auto& [key, table] : _tables)
        table.seen = false;
}

void TableRows::use(ProjectiveMapping& user, const Key& next, const Key& former)
{
    if (!(next < former) && !(former < next)) return;
    leave(former, user);
    if (!next.table) return;
    Table& table = _tables[next];
    table.table = next.table;
    table.users.insert(&user);
}

void TableRows::leave(const Key& key, ProjectiveMapping& user)
{
    const auto found = _tables.find(key);
    if (found == _tables.end()) return;
    found->second.users.erase(&user);
    if (!found->second.users.empty()) return;
    if (found->second.row >= 0) _freeRows.insert(found->second.row);
    _tables.erase(found);
}

void TableRows::update()
{
    for (auto& [key, table] : _tables)
    {
        if (table.seen && table.revision == table.table->revision()) continue;
        if (table.row < 0)
        {
            table.row = _freeRows.empty() ? _rows++ : *_freeRows.begin();
            _freeRows.erase(table.row);
        }
        _changes.uploads.tables.push_back(texelsOf(*table.table, key.low, key.high, table.row));
        _changes.mappings.insert(table.users.begin(), table.users.end());
        table.seen = true;
        table.revision = table.table->revision();
    }
}

int TableRows::row(const Key& key) const
{
    const auto found = _tables.find(key);
    return found != _tables.end() ? found->second.row : 0;
}

} // namespace osgGeoFX
