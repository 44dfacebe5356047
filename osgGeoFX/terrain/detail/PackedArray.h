// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** Bytes of values of `stride` bytes each, compressed without loss. First bytes of all values come first, then the second
    ones, and so on: floats that lie side by side share their first bytes. Equal values give equal bytes. */
std::vector<char> packedBytes(const void* values, std::size_t size, std::size_t stride);
/// The values again: `size` bytes. Returns false if the bytes are damaged.
bool unpackBytes(const std::vector<char>& packed, void* values, std::size_t size, std::size_t stride);

template<typename T>
std::vector<char> packedArray(const std::vector<T>& values)
{
    return packedBytes(values.data(), values.size() * sizeof(T), sizeof(T));
}

/// Empty if the bytes are damaged.
template<typename T>
std::optional<std::vector<T>> unpackedArray(const std::vector<char>& packed, std::size_t count)
{
    std::vector<T> values(count);
    if (!unpackBytes(packed, values.data(), count * sizeof(T), sizeof(T))) return {};
    return values;
}

} // namespace osgGeoFX
