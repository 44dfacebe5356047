// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/MappingPage.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/// Where on the plane the mappings have changed, in the order of the changes. For one thread at a time.
class PlaneChanges
{
public:
    /// The number of changes so far.
    std::uint64_t number() const { return _number; }
    void add(const PlaneBox& box)
    {
        ++_number;
        _boxes.push_back(box);
        if (_boxes.size() > most) _boxes.pop_front();
    }
    /// Everything has changed.
    void addAll()
    {
        ++_number;
        _boxes.clear();
    }
    /// The changes after this one. Nothing if they are everything, or too many to be known.
    std::optional<std::vector<PlaneBox>> since(std::uint64_t number) const
    {
        const std::uint64_t count = _number - number;
        if (number > _number || count > _boxes.size()) return std::nullopt;
        return std::vector<PlaneBox>(_boxes.end() - static_cast<std::ptrdiff_t>(count), _boxes.end());
    }

private:
    static constexpr std::size_t most = 512;
    std::deque<PlaneBox> _boxes;
    std::uint64_t _number = 0;
};

} // namespace osgGeoFX
