// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/PathText.h>

namespace osgGeoFX
{

namespace
{

unsigned int byteAt(const std::string& text, std::size_t at)
{
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u;
}

/// The bytes of the character that begins at a place; 0 if they are no UTF-8.
std::size_t lengthAt(const std::string& text, std::size_t at)
{
    const unsigned int first = byteAt(text, at);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xf0 && first <= 0xf4  ? 4
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xc2 && first < 0xe0 ? 2
                                                               : 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byteAt(text, at + i) & 0xc0u) != 0x80u) return 0;
    const unsigned int second = byteAt(text, at + 1);
    // Too long, half of a pair, beyond Unicode.
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90))
        return 0;
    return length;
}

/// The byte that a character of the private area stands for; 0 for any other.
unsigned int privateByte(const std::string& text, std::size_t at)
{
    const unsigned int third = byteAt(text, at + 2);
    if (byteAt(text, at) != 0xf4 || byteAt(text, at + 1) != 0x8f || (third != 0xbe && third != 0xbf))
        return 0;
    return (third == 0xbe ? 0x80u : 0xc0u) + (byteAt(text, at + 3) & 0x3fu);
}

} // namespace

std::string PathText::of(const std::string& path)
{
    std::string result;
    for (std::size_t at = 0; at < path.size();)
    {
        const std::size_t length = lengthAt(path, at);
        if (length > 0 && privateByte(path, at) == 0)
        {
            result.append(path, at, length);
            at += length;
            continue;
        }
        const unsigned int byte = byteAt(path, at++);
        result += "\xf4\x8f";
        result += static_cast<char>(byte < 0xc0 ? 0xbe : 0xbf);
        result += static_cast<char>(0x80u | (byte & 0x3fu));
    }
    return result;
}

std::string PathText::path(const std::string& text)
{
    std::string result;
    for (std::size_t at = 0; at < text.size();)
    {
        const unsigned int byte = privateByte(text, at);
        result += byte > 0 ? static_cast<char>(byte) : text[at];
        at += byte > 0 ? 4 : 1;
    }
    return result;
}

} // namespace osgGeoFX
