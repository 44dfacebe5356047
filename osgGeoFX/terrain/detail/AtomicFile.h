// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/WholeFile.h>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Throws a BuildError for a file that cannot be written. The remedy in it suits the error number.
[[noreturn]] void failToWrite(const std::string& path, int error);

/// As writeWholeFile(), and makes the folder; throws a BuildError if the file cannot be written.
void writeFileAtomically(const std::string& path, const char* data, std::size_t size);

/// The bytes of a work file: plain values and arrays, read in the order in which they were written.
class ByteWriter
{
public:
    template<typename T>
    void put(const T* values, std::size_t count)
    {
        const auto* bytes = reinterpret_cast<const char*>(values);
        _bytes.insert(_bytes.end(), bytes, bytes + count * sizeof(T));
    }
    template<typename T>
    void put(const T& value)
    {
        put(&value, 1);
    }
    template<typename T>
    void put(const std::vector<T>& values)
    {
        put(static_cast<std::size_t>(values.size()));
        put(values.data(), values.size());
    }
    const std::vector<char>& bytes() const { return _bytes; }

private:
    std::vector<char> _bytes;
};

class ByteReader
{
public:
    /// Reads the whole file. `good()` is false if there is none.
    explicit ByteReader(const std::string& path);

    bool good() const { return _good; }
    /// All of them.
    const std::vector<char>& bytes() const { return _bytes; }

    template<typename T>
    void get(T* values, std::size_t count)
    {
        take(values, count * sizeof(T));
    }
    template<typename T>
    T get()
    {
        T value{};
        get(&value, 1);
        return value;
    }
    template<typename T>
    std::vector<T> getVector()
    {
        const auto count = get<std::size_t>();
        if (count > (_bytes.size() - _position) / sizeof(T)) _good = false;
        std::vector<T> values(_good ? count : 0);
        get(values.data(), values.size());
        return values;
    }

private:
    void take(void* target, std::size_t size);

    std::vector<char> _bytes;
    std::size_t _position = 0;
    bool _good = false;
};

} // namespace osgGeoFX
