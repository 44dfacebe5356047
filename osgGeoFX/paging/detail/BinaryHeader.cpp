// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/BinaryHeader.h>

#include <cstdint>

namespace osgGeoFX
{

namespace
{

class BinaryHeader
{
public:
    explicit BinaryHeader(std::istream& stream) : _stream(stream) {}

    std::string fault()
    {
        constexpr std::uint32_t low = 0x6C910EA1;
        constexpr std::uint32_t high = 0x1AFB4545;
        if (!_stream) return "it cannot be opened";
        const std::uint32_t first = number();
        const std::uint32_t second = number();
        if (!_stream) return "it is empty or cut off";
        if (first == swapped(low) && second == swapped(high)) return {};
        if (first != low || second != high) return "it is not an OpenSceneGraph binary file";
        const std::uint32_t type = number();
        number(); // version
        const std::uint32_t attributes = number();
        if (!_stream) return "it is cut off";
        if (type > 3 || (attributes & ~7u) != 0) return _damaged;
        if (attributes & 1u)
        {
            const std::uint32_t domains = number();
            if (domains > 1000) return _damaged;
            for (std::uint32_t i = 0; i < domains; ++i)
            {
                if (!skipString()) return _damaged;
                number();
            }
        }
        return skipString() ? std::string() : _damaged;
    }

private:
    std::uint32_t number()
    {
        std::uint32_t value = 0;
        _stream.read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }

    bool skipString()
    {
        const std::uint32_t length = number();
        return _stream && length <= 4096 && _stream.ignore(length) &&
               _stream.gcount() == static_cast<std::streamsize>(length);
    }

    static std::uint32_t swapped(std::uint32_t value)
    {
        return (value >> 24) | ((value >> 8) & 0xff00u) | ((value << 8) & 0xff0000u) | (value << 24);
    }

    const std::string _damaged = "its header is damaged";
    std::istream& _stream;
};

} // namespace

std::string faultOfBinaryHeader(std::istream& stream)
{
    return BinaryHeader(stream).fault();
}

} // namespace osgGeoFX
