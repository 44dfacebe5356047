// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/ColorRampFile.h>
#include <osgGeoFX/raster/detail/ColorNames.h>

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

/// The colors that gdaldem has under other values than X11.
constexpr NamedColor gdaldemColors[] = {
    {"aqua", {0, 191, 191}},   {"grey", {191, 191, 191}}, {"gray", {191, 191, 191}},
    {"orange", {255, 127, 0}}, {"brown", {191, 127, 63}}, {"purple", {127, 0, 255}},
    {"violet", {127, 0, 255}}, {"indigo", {0, 127, 255}},
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
    if (const auto color = ColorNames::x11(name)) return *color;
    throw Refusal{
        "the color " + inQuotes(name) +
        " is not known; write red, green and blue as numbers, #rrggbb, or a name of X11 such as darkgreen."};
}

/// The colors of names in files for gdaldem, where they differ from those of X11.
std::optional<osg::Vec4> nameOfGdaldem(const std::string& name)
{
    for (const NamedColor& color : gdaldemColors)
        if (lower(name) == color.name)
            return osg::Vec4(static_cast<float>(color.rgb[0]) / 255.0f,
                             static_cast<float>(color.rgb[1]) / 255.0f,
                             static_cast<float>(color.rgb[2]) / 255.0f, 1.0f);
    return std::nullopt;
}

/// Where a line's comment begins, or npos. A color such as #ff8000 begins none.
std::size_t commentOf(const std::string& line)
{
    for (std::size_t at = line.find('#'); at != std::string::npos; at = line.find('#', at + 1))
    {
        const std::size_t end = std::min(line.find_first_of(" ,\t\r;", at), line.size());
        if (at == 0 || !ColorNames::hexadecimal(line.substr(at, end - at))) return at;
    }
    return std::string::npos;
}

/// Reads a file's lines, one after the other.
class Parser
{
public:
    Parser(bool cpt, const std::optional<ColorRampFile::Range>& range) : _range(range), _isCpt(cpt) {}

    void take(const std::string& line)
    {
        if (!line.empty() && line[0] == '#') checkColorModel(line);
        // A label of GMT follows a semicolon.
        const std::size_t end = std::min(commentOf(line), _isCpt ? line.find(';') : std::string::npos);
        const Words words = split(line.substr(0, end), " ,\t:\r");
        if (words.empty() || words[0][0] == '/' || (words.size() == 1 && lower(words[0]) == "end")) return;
        if (lower(words[0]) == "interpolation")
            takeInterpolation(words);
        else if (_isCpt)
            takeSlice(words);
        else
        {
            checkComma(line);
            takeStop(words);
        }
    }

    osg::ref_ptr<ColorTable> finish()
    {
        if (_isCpt) joinSlices();
        if (_stops.empty())
            throw Refusal{"there are no colors; write a line for each value, such as 100 0 128 0."};
        const auto below = [](const Stop& a, const Stop& b)
        {
            return a.value < b.value;
        };
        // In a list that descends, the first of two lines with one value is the upper side of the jump.
        if (_stops.front().value > _stops.back().value &&
            std::is_sorted(_stops.rbegin(), _stops.rend(), below))
            std::reverse(_stops.begin(), _stops.end());
        std::stable_sort(_stops.begin(), _stops.end(), below);
        if (_discrete) makeDiscrete();
        addOutside();
        osg::ref_ptr<ColorTable> table = new ColorTable;
        table->setStops(_stops);
        table->setNoDataColor(_noData);
        table->setMode(_mode);
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

    /// A line of the files that QGIS exports.
    void takeInterpolation(const Words& words)
    {
        const std::string kind = words.size() == 2 ? lower(words[1]) : "";
        _mayBeOpen = kind != "exact";
        if (kind == "exact")
            _mode = ColorTable::EXACT;
        else if (kind == "discrete")
            _discrete = true;
        else if (kind != "interpolated")
            throw Refusal{"the interpolation is not known; write INTERPOLATED, DISCRETE or EXACT."};
    }

    /// "0,5 255 0 0" would be read as the value 0 and the color 5 255 0.
    static void checkComma(const std::string& line)
    {
        const std::size_t first = line.find_first_not_of(" \t");
        const std::size_t end = std::min(line.find_first_of(" \t\r", first), line.size());
        const std::string word = line.substr(first, end - first);
        const std::size_t comma = word.find(',');
        const bool isLast = line.find_first_not_of(" \t\r", end) == std::string::npos;
        if (comma == std::string::npos || isLast || word.find(',', comma + 1) != std::string::npos) return;
        if (number(word.substr(0, comma)) && number(word.substr(comma + 1)))
            throw Refusal{"the value is " + inQuotes(word) +
                          "; write a point in numbers, or a comma behind each number."};
    }

    void takeStop(const Words& words)
    {
        const std::string key = lower(words[0]);
        const bool isWord = key == "nv" || key == "default" || (key == "inf" && _mayBeOpen);
        if (words.size() < 2)
            throw Refusal{inQuotes(words[0]) + " has no color; write value, red, green, blue."};
        const double value = isWord ? 0.0 : stopValue(words[0]);
        osg::Vec4 color;
        std::size_t next = 2;
        if (const auto hexadecimal = ColorNames::hexadecimal(words[1]))
            color = *hexadecimal;
        else if (!number(words[1]))
        {
            const auto named = nameOfGdaldem(words[1]);
            color = named ? *named : namedColor(words[1]);
        }
        else if (words.size() < 4)
            throw Refusal{"the color is not complete; write value, red, green, blue."};
        else
        {
            color = partsToColor(words[1], words[2], words[3]);
            next = 4;
        }
        if (words.size() > next) color[3] = part(words[next]);
        if (key == "nv")
            _noData = color;
        else if (key == "default")
            _below = _above = color;
        else if (isWord)
            _last = color; // between stops, the last one's color goes on anyway
        else
            _stops.push_back({value, color});
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

    /// Each color of a DISCRETE table reaches up to its own value, that value included. So the next color begins a
    /// little above it, a texel of a row. The last color may reach on.
    void makeDiscrete()
    {
        const double margin = marginOf(_stops);
        Stops steps{_stops.front()};
        for (std::size_t i = 1; i < _stops.size(); ++i)
            steps.push_back({_stops[i - 1].value + margin, _stops[i].color});
        steps.push_back({_stops.back().value + margin, _last ? *_last : osg::Vec4()});
        _stops = steps;
        _mode = ColorTable::STEPS;
    }

    /// More than the distance of texels in a row of 1024; of a single value, a step of 32-bit numbers.
    static double marginOf(const Stops& stops)
    {
        const double low = stops.front().value, high = stops.back().value;
        return std::max((high - low) / 512.0, std::abs(high) * 1e-6 + 1e-30);
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
        // L, U or B says which of a slice's ends get a number.
        if (words.size() % 2 == 1)
            if (words.back() == "L" || words.back() == "U" || words.back() == "B") words.pop_back();
        if (words.size() == 2) return takeCategory(words);
        if (words.size() != 4 && words.size() != 8)
            throw Refusal{"the line is not z0 color z1 color; write the colors as R G B or R/G/B."};
        const auto middle = words.begin() + static_cast<std::ptrdiff_t>(words.size() / 2);
        const std::optional<double> from = number(words[0]), to = number(*middle);
        if (!from || !to || *from == *to)
            throw Refusal{"the slice goes from " + inQuotes(words[0]) + " to " + inQuotes(*middle) +
                          "; write two different numbers."};
        Slice slice{{*from, sliceColor({words.begin() + 1, middle})},
                    {*to, sliceColor({middle + 1, words.end()})}};
        if (*from > *to) std::swap(slice.low, slice.high);
        if (!_stops.empty())
            throw Refusal{"the line is a slice, and those before are classes; write one kind of lines."};
        if (!_slices.empty())
        {
            const Slice& before = _slices.back();
            const bool above = slice.low.value >= before.high.value;
            const bool below = slice.high.value <= before.low.value;
            if ((!above && !below) || (_slices.size() > 1 && below != _descends))
                throw Refusal{"the slice does not begin where the one before ends; put the lines in order."};
            _descends = below;
        }
        _slices.push_back(slice);
    }

    /// A line of a categorical table.
    void takeCategory(const Words& words)
    {
        const std::optional<double> value = number(words[0]);
        if (!value)
            throw Refusal{"the class " + inQuotes(words[0]) + " is not a number; write the raster's values."};
        if (!_slices.empty())
            throw Refusal{"the line is a class, and those before are slices; write one kind of lines."};
        _stops.push_back({*value, sliceColor({words[1]})});
        _mode = ColorTable::EXACT;
    }

    void joinSlices()
    {
        if (_descends) std::reverse(_slices.begin(), _slices.end());
        for (const Slice& slice : _slices)
        {
            if (_stops.empty() || _stops.back().value < slice.low.value ||
                _stops.back().color != slice.low.color)
                _stops.push_back(slice.low);
            _stops.push_back(slice.high);
        }
    }

    static osg::Vec4 sliceColor(const Words& words)
    {
        const Words parts = words.size() == 1 ? split(words[0], "/") : words;
        if (parts.size() == 3) return partsToColor(parts[0], parts[1], parts[2]);
        if (parts.size() != 1) throw Refusal{"the color is not complete; write R G B or R/G/B."};
        if (parts[0] == "-") return {}; // "leave it unpainted"
        if (const auto hexadecimal = ColorNames::hexadecimal(parts[0])) return *hexadecimal;
        return number(parts[0]) ? partsToColor(parts[0], parts[0], parts[0]) : namedColor(parts[0]);
    }

    /// The colors below and above: with a little of the ends' colors between, for they count from beyond the ends.
    void addOutside()
    {
        if (_mode != ColorTable::LINEAR) return;
        const Stop first = _stops.front(), last = _stops.back();
        const double margin = marginOf(_stops);
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

    /// A line z0 color z1 color.
    struct Slice
    {
        Stop low, high;
    };

    std::optional<ColorRampFile::Range> _range;
    bool _isCpt;
    bool _mayBeOpen = false; ///< whether the last value may be infinite, as QGIS writes it
    bool _discrete = false;  ///< QGIS's way of writing steps
    bool _descends = false;  ///< whether the slices do
    ColorTable::Mode _mode = ColorTable::LINEAR;
    Stops _stops;
    std::vector<Slice> _slices;
    osg::Vec4 _noData;
    std::optional<osg::Vec4> _below, _above, _last;
};

/// Takes a mark of the byte order out of the first line. Refuses what is no color table by its first line.
void checkFirst(std::string& line)
{
    if (line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
    if (line.find('\0') != std::string::npos)
        throw Refusal{"its letters have two bytes, or it is no text; save it as UTF-8."};
    if (!line.empty() && line[0] == '<')
        throw Refusal{"it is XML and no color table; export the colors as text, or the style as SLD."};
}

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
            if (++count == 1) checkFirst(line);
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
