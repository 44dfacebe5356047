// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/ColorRampFile.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

namespace osgGeoFX
{

namespace
{

using Stop = ColorTable::Stop;
using Stops = ColorTable::Stops;
using Words = std::vector<std::string>;

struct NamedColor
{
    const char* name;
    std::array<int, 3> rgb;
};

constexpr NamedColor namedColors[] = {
    {"white", {255, 255, 255}}, {"black", {0, 0, 0}},      {"red", {255, 0, 0}},
    {"green", {0, 255, 0}},     {"blue", {0, 0, 255}},     {"yellow", {255, 255, 0}},
    {"magenta", {255, 0, 255}}, {"cyan", {0, 255, 255}},   {"aqua", {0, 191, 191}},
    {"grey", {191, 191, 191}},  {"gray", {191, 191, 191}}, {"orange", {255, 127, 0}},
    {"brown", {191, 127, 63}},  {"purple", {127, 0, 255}}, {"violet", {127, 0, 255}},
    {"indigo", {0, 127, 255}},
};

std::string lower(std::string text)
{
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

Words split(const std::string& text, const char* separators)
{
    Words words;
    for (std::size_t begin = text.find_first_not_of(separators); begin != std::string::npos;)
    {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return words;
}

/// A word as it may stand in a sentence: a binary file's words do not fit there.
std::string inQuotes(const std::string& word)
{
    std::string text = word.substr(0, 40);
    for (char& c : text)
        if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
    return "\"" + text + (word.size() > 40 ? "…\"" : "\"");
}

/// The whole of a word as a finite number, with a point in every locale.
std::optional<double> number(const std::string& word)
{
    // The library knows no plus.
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    const char* begin = word.data() + (plus ? 1 : 0);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// Thrown within this file only: why a line cannot be used, and the remedy.
struct Refusal
{
    std::string sentence;
};

/// One part of a color, 0…1.
float part(const std::string& word)
{
    const std::optional<double> value = number(word);
    if (!value || *value < 0.0 || *value > 255.0)
        throw Refusal{"the color has " + inQuotes(word) + "; write a number from 0 to 255."};
    return static_cast<float>(*value / 255.0);
}

osg::Vec4 partsToColor(const std::string& red, const std::string& green, const std::string& blue)
{
    return {part(red), part(green), part(blue), 1.0f};
}

osg::Vec4 namedColor(const std::string& name)
{
    std::string known;
    for (const NamedColor& color : namedColors)
    {
        if (lower(name) == color.name)
            return {static_cast<float>(color.rgb[0]) / 255.0f, static_cast<float>(color.rgb[1]) / 255.0f,
                    static_cast<float>(color.rgb[2]) / 255.0f, 1.0f};
        known += std::string(known.empty() ? "" : ", ") + color.name;
    }
    throw Refusal{"the color " + inQuotes(name) +
                  " is not known; write red, green and blue as numbers, or one of " + known + "."};
}

/// Reads a file's lines, one after the other.
class Parser
{
public:
    Parser(bool cpt, const std::optional<ColorRampFile::Range>& range) : _range(range), _isCpt(cpt) {}

    void take(const std::string& line)
    {
        if (!line.empty() && line[0] == '#') checkColorModel(line);
        Words words = split(line.substr(0, line.find('#')), " ,\t:\r");
        if (words.empty() || words[0][0] == '/') return;
        if (_isCpt)
            takeSlice(words);
        else
            takeStop(words);
    }

    osg::ref_ptr<ColorTable> finish()
    {
        if (_stops.empty())
            throw Refusal{"there are no colors; write a line for each value, such as 100 0 128 0."};
        addOutside();
        osg::ref_ptr<ColorTable> table = new ColorTable;
        table->setStops(_stops);
        table->setNoDataColor(_noData);
        return table;
    }

private:
    void checkColorModel(const std::string& line)
    {
        const std::size_t key = line.find("COLOR_MODEL");
        if (key == std::string::npos) return;
        _isCpt = true;
        const Words words = split(line.substr(key + 11), " =+\t\r\"");
        if (words.size() != 1 || lower(words[0]) != "rgb")
            throw Refusal{"the COLOR_MODEL is not RGB; convert the file to RGB."};
    }

    void takeStop(const Words& words)
    {
        if (words.size() < 2)
            throw Refusal{inQuotes(words[0]) + " has no color; write value, red, green, blue."};
        osg::Vec4 color;
        std::size_t next = 2;
        if (!number(words[1]))
            color = namedColor(words[1]);
        else if (words.size() < 4)
            throw Refusal{"the color is not complete; write value, red, green, blue."};
        else
        {
            color = partsToColor(words[1], words[2], words[3]);
            next = 4;
        }
        if (words.size() > next) color[3] = part(words[next]);
        if (lower(words[0]) == "nv")
            _noData = color;
        else
            _stops.push_back({stopValue(words[0]), color});
    }

    double stopValue(const std::string& word) const
    {
        const bool isShare = word.size() > 1 && word.back() == '%';
        const std::optional<double> value = number(isShare ? word.substr(0, word.size() - 1) : word);
        if (!value) throw Refusal{"the value is " + inQuotes(word) + "; write a number, a percentage or nv."};
        if (!isShare) return *value;
        if (*value < 0.0 || *value > 100.0)
            throw Refusal{"the percentage is " + inQuotes(word) + "; write 0% to 100%."};
        if (!_range || !std::isfinite(_range->first) || !std::isfinite(_range->second))
            throw Refusal{inQuotes(word) +
                          " needs the range of the raster's values; give it, or write plain values."};
        return _range->first * (1.0 - *value / 100.0) + _range->second * (*value / 100.0);
    }

    void takeSlice(Words words)
    {
        const std::string key = words[0];
        if (key == "B" || key == "F" || key == "N")
        {
            words.erase(words.begin());
            const osg::Vec4 color = sliceColor(words);
            if (key == "B")
                _below = color;
            else if (key == "F")
                _above = color;
            else
                _noData = color;
            return;
        }
        // A label follows a semicolon; L, U or B says which of a slice's ends get a number.
        if (const auto label = std::find_if(words.begin(), words.end(),
                                            [](const std::string& word) { return word[0] == ';'; });
            label != words.end())
            words.erase(label, words.end());
        if (words.size() == 5 || words.size() == 9)
            if (words.back() == "L" || words.back() == "U" || words.back() == "B") words.pop_back();
        if (words.size() != 4 && words.size() != 8)
            throw Refusal{"the line is not z0 color z1 color; write the colors as R G B or R/G/B."};
        const auto middle = words.begin() + static_cast<std::ptrdiff_t>(words.size() / 2);
        const std::optional<double> from = number(words[0]), to = number(*middle);
        if (!from || !to || *from >= *to)
            throw Refusal{"the slice goes from " + inQuotes(words[0]) + " to " + inQuotes(*middle) +
                          "; write two numbers, the smaller one first."};
        if (!_stops.empty() && *from < _stops.back().value)
            throw Refusal{"the slice begins below the end of the one before; put the lines in order."};
        const Stop first{*from, sliceColor({words.begin() + 1, middle})};
        if (_stops.empty() || _stops.back().value < first.value || _stops.back().color != first.color)
            _stops.push_back(first);
        _stops.push_back({*to, sliceColor({middle + 1, words.end()})});
    }

    static osg::Vec4 sliceColor(const Words& words)
    {
        const Words parts = words.size() == 1 ? split(words[0], "/") : words;
        if (parts.size() == 3) return partsToColor(parts[0], parts[1], parts[2]);
        if (parts.size() != 1) throw Refusal{"the color is not complete; write R G B or R/G/B."};
        if (parts[0] == "-") return {}; // "leave it unpainted"
        return number(parts[0]) ? partsToColor(parts[0], parts[0], parts[0]) : namedColor(parts[0]);
    }

    /// A .cpt's colors below and above: with a little of its ends' colors between, for they count from beyond the ends.
    void addOutside()
    {
        const Stop first = _stops.front(), last = _stops.back();
        const double margin = (last.value - first.value) / 512.0;
        if (_below && *_below != first.color)
            _stops.insert(_stops.begin(), {{first.value - 2.0 * margin, *_below},
                                           {first.value - margin, *_below},
                                           {first.value - margin, first.color}});
        if (_above && *_above != last.color)
        {
            _stops.push_back({last.value + margin, last.color});
            _stops.push_back({last.value + margin, *_above});
        }
    }

    std::optional<ColorRampFile::Range> _range;
    bool _isCpt;
    Stops _stops;
    osg::Vec4 _noData;
    std::optional<osg::Vec4> _below, _above;
};

std::string text(double value)
{
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

std::string lineOf(const std::string& value, const osg::Vec4& color)
{
    std::string line = value;
    for (int i = 0; i < 4; ++i)
        line += " " + std::to_string(std::lround(color[i] * 255.0f));
    return line + "\n";
}

} // namespace

osg::ref_ptr<ColorTable> ColorRampFile::read(const std::string& path, const std::optional<Range>& rangeOfData,
                                             std::string& error)
{
    // The text of a million colors; what is larger is another file by mistake.
    constexpr std::uintmax_t largest = 32u << 20;
    std::error_code failure;
    const bool isFile = std::filesystem::is_regular_file(path, failure);
    std::ifstream stream(path, std::ios::binary);
    if (!isFile || !stream || std::filesystem::file_size(path, failure) > largest)
    {
        error = path + ": " +
                (isFile && stream ? "the file is too large for a color table; "
                                  : "the color table cannot be read; ") +
                "give a text file of gdaldem color-relief or GMT.";
        return nullptr;
    }
    Parser parser(lower(std::filesystem::path(path).extension().string()) == ".cpt", rangeOfData);
    std::string line;
    int count = 0;
    try
    {
        while (std::getline(stream, line))
        {
            if (++count == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
            parser.take(line);
        }
        count = 0;
        return parser.finish();
    }
    catch (const Refusal& refusal)
    {
        error = path + (count > 0 ? ":" + std::to_string(count) : "") + ": " + refusal.sentence;
        return nullptr;
    }
}

bool ColorRampFile::write(const ColorTable& table, const std::string& path, std::string& error)
{
    const Stops& stops = table.getStops();
    if (stops.empty())
    {
        error = path + ": the color table has no stops; add some before it is written.";
        return false;
    }
    std::ofstream stream(path, std::ios::binary);
    const bool nearest = table.getMode() == ColorTable::NEAREST, exact = table.getMode() == ColorTable::EXACT;
    stream << "# For gdaldem color-relief" << (nearest ? " -nearest_color_entry" : "")
           << (exact ? " -exact_color_entry" : "") << ": value red green blue alpha\n";
    for (std::size_t i = 0; i < stops.size(); ++i)
    {
        // A step is flat up to the next stop.
        if (table.getMode() == ColorTable::STEPS && i > 0)
            stream << lineOf(text(stops[i].value), stops[i - 1].color);
        stream << lineOf(text(stops[i].value), stops[i].color);
    }
    stream << lineOf("nv", table.getNoDataColor());
    stream.close();
    if (stream) return true;
    error = path + ": the color table cannot be written; check the folder and the space on the disk.";
    return false;
}

} // namespace osgGeoFX
