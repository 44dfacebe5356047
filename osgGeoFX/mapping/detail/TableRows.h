// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/MappingChanges.h>
#include <osgGeoFX/raster/ColorTable.h>

#include <map>
#include <set>
#include <tuple>
#include <unordered_set>

namespace osgGeoFX
{

/** The rows of color tables in the tables' texture. Mappings with the same table over the same range share a row. It
    is free again after the last of them. For one thread at a time. */
class TableRows
{
public:
    /// A table over a range. Without a table it stands for none.
    struct Key
    {
        const ColorTable* table = nullptr;
        double low = 0.0;
        double high = 0.0;
        bool operator<(const Key& other) const
        {
            return std::tie(table, low, high) < std::tie(other.table, other.low, other.high);
        }
    };

    /// The changes must outlive this object.
    explicit TableRows(MappingChanges& changes) : _changes(changes) {}

    /// Notes that all rows must be uploaded anew. They stay where they are.
    void reset();
    /// A mapping replaces its table.
    void use(ProjectiveMapping& user, const Key& next, const Key& former);
    /// Gives rows to new tables, and uploads what has changed.
    void update();
    /// The row of a table; 0 for a table that no mapping has.
    int row(const Key& key) const;

private:
    struct Table
    {
        osg::ref_ptr<const ColorTable> table;
        std::unordered_set<ProjectiveMapping*> users;
        unsigned int revision = 0;
        int row = -1;
        bool seen = false;
    };

    void leave(const Key& key, ProjectiveMapping& user);

    MappingChanges& _changes;
    std::map<Key, Table> _tables;
    std::set<int> _freeRows;
    int _rows = 0;
};

} // namespace osgGeoFX
