// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace osgGeoFX
{

/// What stands for content: if two are equal, so is what they were made of.
struct Digest
{
    std::uint64_t low = 0, high = 0;

    friend bool operator==(const Digest& a, const Digest& b) { return a.low == b.low && a.high == b.high; }
    friend bool operator!=(const Digest& a, const Digest& b) { return !(a == b); }
};

/** Makes a digest of 128 bits, at some gigabytes a second (Appleby: MurmurHash3, the variant x64_128, over the pieces as
    they come). It tells changes from none. It does not withstand people who make equal digests on purpose. */
class ContentHash
{
public:
    ContentHash& add(const void* data, std::size_t size)
    {
        // Each piece is closed by its size, so pieces cannot be shifted against each other.
        const auto* bytes = static_cast<const unsigned char*>(data);
        std::size_t left = size;
        for (; left >= 16; bytes += 16, left -= 16)
            mix(word(bytes, 8), word(bytes + 8, 8));
        mix(word(bytes, left < 8 ? left : 8), left > 8 ? word(bytes + 8, left - 8) : 0);
        mix(size, 0x9e3779b97f4a7c15u);
        return *this;
    }
    template<typename T>
    ContentHash& add(const T& value)
    {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "padding has no content");
        return add(&value, sizeof(value));
    }
    template<typename T>
    ContentHash& add(const std::vector<T>& values)
    {
        return add(values.data(), values.size() * sizeof(T));
    }
    ContentHash& add(const std::string& text) { return add(text.data(), text.size()); }
    ContentHash& add(const Digest& digest) { return add(digest.low).add(digest.high); }

    Digest digest() const
    {
        std::uint64_t a = _a + _b, b = _b + _a + _b;
        a = finished(a);
        b = finished(b);
        a += b;
        return {a, b + a};
    }

private:
    static std::uint64_t word(const unsigned char* bytes, std::size_t size)
    {
        std::uint64_t result = 0;
        if (size > 0) std::memcpy(&result, bytes, size);
        return result;
    }
    static std::uint64_t turned(std::uint64_t value, int bits)
    {
        return value << bits | value >> (64 - bits);
    }
    static std::uint64_t finished(std::uint64_t value)
    {
        value ^= value >> 33;
        value *= 0xff51afd7ed558ccdu;
        value ^= value >> 33;
        value *= 0xc4ceb9fe1a85ec53u;
        return value ^ value >> 33;
    }
    void mix(std::uint64_t first, std::uint64_t second)
    {
        constexpr std::uint64_t c1 = 0x87c37b91114253d5u, c2 = 0x4cf5ad432745937fu;
        _a ^= turned(first * c1, 31) * c2;
        _a = (turned(_a, 27) + _b) * 5 + 0x52dce729u;
        _b ^= turned(second * c2, 33) * c1;
        _b = (turned(_b, 31) + _a) * 5 + 0x38495ab5u;
    }

    std::uint64_t _a = 0, _b = 0;
};

} // namespace osgGeoFX
