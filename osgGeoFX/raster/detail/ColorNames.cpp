// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/detail/ColorNames.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace osgGeoFX
{

namespace
{

constexpr std::int32_t NONE = -1;

struct NamedColor
{
    const char* name;
    std::int32_t rgb;
    std::int32_t numbered; ///< the color of "name1", of which "name2" to "name4" are darker shades; or NONE
};

/// In the order of the alphabet.
constexpr NamedColor namedColors[] = {
    {"aliceblue", 0xf0f8ff, NONE},
    {"antiquewhite", 0xfaebd7, 0xffefdb},
    {"aqua", 0x00ffff, NONE},
    {"aquamarine", 0x7fffd4, 0x7fffd4},
    {"azure", 0xf0ffff, 0xf0ffff},
    {"beige", 0xf5f5dc, NONE},
    {"bisque", 0xffe4c4, 0xffe4c4},
    {"black", 0x000000, NONE},
    {"blanchedalmond", 0xffebcd, NONE},
    {"blue", 0x0000ff, 0x0000ff},
    {"blueviolet", 0x8a2be2, NONE},
    {"brown", 0xa52a2a, 0xff4040},
    {"burlywood", 0xdeb887, 0xffd39b},
    {"cadetblue", 0x5f9ea0, 0x98f5ff},
    {"chartreuse", 0x7fff00, 0x7fff00},
    {"chocolate", 0xd2691e, 0xff7f24},
    {"coral", 0xff7f50, 0xff7256},
    {"cornflowerblue", 0x6495ed, NONE},
    {"cornsilk", 0xfff8dc, 0xfff8dc},
    {"crimson", 0xdc143c, NONE},
    {"cyan", 0x00ffff, 0x00ffff},
    {"darkblue", 0x00008b, NONE},
    {"darkcyan", 0x008b8b, NONE},
    {"darkgoldenrod", 0xb8860b, 0xffb90f},
    {"darkgray", 0xa9a9a9, NONE},
    {"darkgreen", 0x006400, NONE},
    {"darkgrey", 0xa9a9a9, NONE},
    {"darkkhaki", 0xbdb76b, NONE},
    {"darkmagenta", 0x8b008b, NONE},
    {"darkolivegreen", 0x556b2f, 0xcaff70},
    {"darkorange", 0xff8c00, 0xff7f00},
    {"darkorchid", 0x9932cc, 0xbf3eff},
    {"darkred", 0x8b0000, NONE},
    {"darksalmon", 0xe9967a, NONE},
    {"darkseagreen", 0x8fbc8f, 0xc1ffc1},
    {"darkslateblue", 0x483d8b, NONE},
    {"darkslategray", 0x2f4f4f, 0x97ffff},
    {"darkslategrey", 0x2f4f4f, NONE},
    {"darkturquoise", 0x00ced1, NONE},
    {"darkviolet", 0x9400d3, NONE},
    {"deeppink", 0xff1493, 0xff1493},
    {"deepskyblue", 0x00bfff, 0x00bfff},
    {"dimgray", 0x696969, NONE},
    {"dimgrey", 0x696969, NONE},
    {"dodgerblue", 0x1e90ff, 0x1e90ff},
    {"firebrick", 0xb22222, 0xff3030},
    {"floralwhite", 0xfffaf0, NONE},
    {"forestgreen", 0x228b22, NONE},
    {"fuchsia", 0xff00ff, NONE},
    {"gainsboro", 0xdcdcdc, NONE},
    {"ghostwhite", 0xf8f8ff, NONE},
    {"gold", 0xffd700, 0xffd700},
    {"goldenrod", 0xdaa520, 0xffc125},
    {"gray", 0xbebebe, NONE},
    {"green", 0x00ff00, 0x00ff00},
    {"greenyellow", 0xadff2f, NONE},
    {"grey", 0xbebebe, NONE},
    {"honeydew", 0xf0fff0, 0xf0fff0},
    {"hotpink", 0xff69b4, 0xff6eb4},
    {"indianred", 0xcd5c5c, 0xff6a6a},
    {"indigo", 0x4b0082, NONE},
    {"ivory", 0xfffff0, 0xfffff0},
    {"khaki", 0xf0e68c, 0xfff68f},
    {"lavender", 0xe6e6fa, NONE},
    {"lavenderblush", 0xfff0f5, 0xfff0f5},
    {"lawngreen", 0x7cfc00, NONE},
    {"lemonchiffon", 0xfffacd, 0xfffacd},
    {"lightblue", 0xadd8e6, 0xbfefff},
    {"lightcoral", 0xf08080, NONE},
    {"lightcyan", 0xe0ffff, 0xe0ffff},
    {"lightgoldenrod", 0xeedd82, 0xffec8b},
    {"lightgoldenrodyellow", 0xfafad2, NONE},
    {"lightgray", 0xd3d3d3, NONE},
    {"lightgreen", 0x90ee90, NONE},
    {"lightgrey", 0xd3d3d3, NONE},
    {"lightpink", 0xffb6c1, 0xffaeb9},
    {"lightsalmon", 0xffa07a, 0xffa07a},
    {"lightseagreen", 0x20b2aa, NONE},
    {"lightskyblue", 0x87cefa, 0xb0e2ff},
    {"lightslateblue", 0x8470ff, NONE},
    {"lightslategray", 0x778899, NONE},
    {"lightslategrey", 0x778899, NONE},
    {"lightsteelblue", 0xb0c4de, 0xcae1ff},
    {"lightyellow", 0xffffe0, 0xffffe0},
    {"lime", 0x00ff00, NONE},
    {"limegreen", 0x32cd32, NONE},
    {"linen", 0xfaf0e6, NONE},
    {"magenta", 0xff00ff, 0xff00ff},
    {"maroon", 0xb03060, 0xff34b3},
    {"mediumaquamarine", 0x66cdaa, NONE},
    {"mediumblue", 0x0000cd, NONE},
    {"mediumorchid", 0xba55d3, 0xe066ff},
    {"mediumpurple", 0x9370db, 0xab82ff},
    {"mediumseagreen", 0x3cb371, NONE},
    {"mediumslateblue", 0x7b68ee, NONE},
    {"mediumspringgreen", 0x00fa9a, NONE},
    {"mediumturquoise", 0x48d1cc, NONE},
    {"mediumvioletred", 0xc71585, NONE},
    {"midnightblue", 0x191970, NONE},
    {"mintcream", 0xf5fffa, NONE},
    {"mistyrose", 0xffe4e1, 0xffe4e1},
    {"moccasin", 0xffe4b5, NONE},
    {"navajowhite", 0xffdead, 0xffdead},
    {"navy", 0x000080, NONE},
    {"navyblue", 0x000080, NONE},
    {"oldlace", 0xfdf5e6, NONE},
    {"olive", 0x808000, NONE},
    {"olivedrab", 0x6b8e23, 0xc0ff3e},
    {"orange", 0xffa500, 0xffa500},
    {"orangered", 0xff4500, 0xff4500},
    {"orchid", 0xda70d6, 0xff83fa},
    {"palegoldenrod", 0xeee8aa, NONE},
    {"palegreen", 0x98fb98, 0x9aff9a},
    {"paleturquoise", 0xafeeee, 0xbbffff},
    {"palevioletred", 0xdb7093, 0xff82ab},
    {"papayawhip", 0xffefd5, NONE},
    {"peachpuff", 0xffdab9, 0xffdab9},
    {"peru", 0xcd853f, NONE},
    {"pink", 0xffc0cb, 0xffb5c5},
    {"plum", 0xdda0dd, 0xffbbff},
    {"powderblue", 0xb0e0e6, NONE},
    {"purple", 0xa020f0, 0x9b30ff},
    {"rebeccapurple", 0x663399, NONE},
    {"red", 0xff0000, 0xff0000},
    {"rosybrown", 0xbc8f8f, 0xffc1c1},
    {"royalblue", 0x4169e1, 0x4876ff},
    {"saddlebrown", 0x8b4513, NONE},
    {"salmon", 0xfa8072, 0xff8c69},
    {"sandybrown", 0xf4a460, NONE},
    {"seagreen", 0x2e8b57, 0x54ff9f},
    {"seashell", 0xfff5ee, 0xfff5ee},
    {"sienna", 0xa0522d, 0xff8247},
    {"silver", 0xc0c0c0, NONE},
    {"skyblue", 0x87ceeb, 0x87ceff},
    {"slateblue", 0x6a5acd, 0x836fff},
    {"slategray", 0x708090, 0xc6e2ff},
    {"slategrey", 0x708090, NONE},
    {"snow", 0xfffafa, 0xfffafa},
    {"springgreen", 0x00ff7f, 0x00ff7f},
    {"steelblue", 0x4682b4, 0x63b8ff},
    {"tan", 0xd2b48c, 0xffa54f},
    {"teal", 0x008080, NONE},
    {"thistle", 0xd8bfd8, 0xffe1ff},
    {"tomato", 0xff6347, 0xff6347},
    {"turquoise", 0x40e0d0, 0x00f5ff},
    {"violet", 0xee82ee, NONE},
    {"violetred", 0xd02090, 0xff3e96},
    {"wheat", 0xf5deb3, 0xffe7ba},
    {"white", 0xffffff, NONE},
    {"whitesmoke", 0xf5f5f5, NONE},
    {"yellow", 0xffff00, 0xffff00},
    {"yellowgreen", 0x9acd32, NONE},
};

osg::Vec4 colorOf(std::int32_t rgb, double share = 1.0)
{
    const auto part = [&](int shift)
    {
        return static_cast<float>(std::lround(((rgb >> shift) & 255) * share)) / 255.0f;
    };
    return {part(16), part(8), part(0), 1.0f};
}

/// The levels "gray0", black, to "gray100", white.
std::optional<osg::Vec4> greyLevel(const std::string& name)
{
    if (name.rfind("gray", 0) != 0 && name.rfind("grey", 0) != 0) return std::nullopt;
    int percent = -1;
    const char* const end = name.data() + name.size();
    const auto [stop, failure] = std::from_chars(name.data() + 4, end, percent);
    if (failure != std::errc() || stop != end || percent < 0 || percent > 100) return std::nullopt;
    const float level = static_cast<float>(std::lround(percent * 2.55)) / 255.0f;
    return osg::Vec4(level, level, level, 1.0f);
}

} // namespace

std::optional<osg::Vec4> ColorNames::x11(const std::string& name)
{
    std::string key;
    for (const char c : name)
        if (c != ' ') key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto find = [](const std::string& wanted) -> const NamedColor*
    {
        const NamedColor* const found = std::lower_bound(
            std::begin(namedColors), std::end(namedColors), wanted,
            [](const NamedColor& color, const std::string& text) { return color.name < text; });
        return found != std::end(namedColors) && wanted == found->name ? found : nullptr;
    };
    if (const NamedColor* const found = find(key)) return colorOf(found->rgb);
    if (const auto level = greyLevel(key)) return level;
    if (key.empty() || key.back() < '1' || key.back() > '4') return std::nullopt;
    constexpr double shares[] = {1.0, 0.932, 0.804, 0.548};
    const NamedColor* const base = find(key.substr(0, key.size() - 1));
    if (!base || base->numbered == NONE) return std::nullopt;
    return colorOf(base->numbered, shares[key.back() - '1']);
}

std::optional<osg::Vec4> ColorNames::hexadecimal(const std::string& word)
{
    const std::size_t digits = word.size() - 1;
    if (word.empty() || word[0] != '#' || (digits != 3 && digits != 6 && digits != 8)) return std::nullopt;
    const std::size_t width = digits == 3 ? 1 : 2;
    osg::Vec4 color(0.0f, 0.0f, 0.0f, 1.0f);
    for (std::size_t i = 0; i * width < digits; ++i)
    {
        int part = 0;
        const char* const begin = word.data() + 1 + i * width;
        const auto [stop, failure] = std::from_chars(begin, begin + width, part, 16);
        if (failure != std::errc() || stop != begin + width || *begin == '-') return std::nullopt;
        color[static_cast<int>(i)] = static_cast<float>(width == 1 ? part * 17 : part) / 255.0f;
    }
    return color;
}

} // namespace osgGeoFX
