// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/MapStyles.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

using nlohmann::json;
using Fault = std::runtime_error;

osg::Vec4 colorOf(const std::string& text, const std::string& where)
{
    unsigned int value = 0;
    int used = 0;
    const bool withAlpha = text.size() == 9;
    if ((text.size() != 7 && !withAlpha) || std::sscanf(text.c_str(), "#%8x%n", &value, &used) != 1 ||
        static_cast<std::size_t>(used) != text.size())
        throw Fault(where + " \"" + text + "\" is no color; write #rrggbb or #rrggbbaa.");
    if (!withAlpha) value = value << 8 | 255u;
    const auto channel = [&](int shift)
    {
        return static_cast<float>(value >> shift & 255u) / 255.0f;
    };
    return {channel(24), channel(16), channel(8), channel(0)};
}

/// One style of the file.
class Entry
{
public:
    Entry(const json& entry, std::string where, const std::vector<std::string>& known)
        : _entry(entry), _where(std::move(where))
    {
        if (!entry.is_object()) throw Fault(_where + " it must be an object, such as {\"width\": 2}.");
        for (const auto& [key, value] : entry.items())
        {
            if (std::find(known.begin(), known.end(), key) != known.end()) continue;
            std::string all = known.front();
            for (std::size_t i = 1; i < known.size(); ++i)
                all += (i + 1 == known.size() ? " and " : ", ") + known[i];
            std::string sentence = _where + " \"";
            sentence += key;
            throw Fault(sentence.append("\" is not known; there are ").append(all).append("."));
        }
    }

    void number(const char* key, double low, double high, double& value) const
    {
        if (!_entry.contains(key)) return;
        const json& found = _entry.at(key);
        if (!found.is_number() || !(found.get<double>() >= low && found.get<double>() <= high))
        {
            char text[80];
            std::snprintf(text, sizeof(text), "%g to %g.", low, high);
            throw Fault(_where + " \"" + key + "\" must be a number from " + text);
        }
        value = found.get<double>();
    }
    void flag(const char* key, bool& value) const
    {
        if (!_entry.contains(key)) return;
        if (!_entry.at(key).is_boolean())
            throw Fault(_where + " \"" + std::string(key) + "\" must be true or false.");
        value = _entry.at(key).get<bool>();
    }
    /// Whether it has a text of this name.
    bool text(const char* key, std::string& value) const
    {
        if (!_entry.contains(key)) return false;
        if (!_entry.at(key).is_string())
            throw Fault(_where + " \"" + std::string(key) + "\" must be a text.");
        value = _entry.at(key).get<std::string>();
        return true;
    }
    void color(const char* key, osg::Vec4& value) const
    {
        std::string written;
        if (text(key, written)) value = colorOf(written, _where + " \"" + key + "\"");
    }
    const std::string& where() const { return _where; }

private:
    const json& _entry;
    const std::string _where;
};

void readName(const Entry& entry, NameStyle& style)
{
    entry.text("font", style.text.font);
    entry.number("size", 1.0, 500.0, style.text.size);
    entry.number("spacing", 0.0, 4.0, style.text.spacing);
    entry.number("haloWidth", 0.0, 1.0, style.text.haloWidth);
    entry.number("longest", 1.0, 1000.0, style.text.longest);
    entry.number("line", 0.0, 50.0, style.lineWidth);
    entry.number("dot", 0.0, 50.0, style.dot);
    entry.flag("bold", style.text.bold);
    entry.flag("italic", style.text.italic);
    entry.color("color", style.text.color);
    entry.color("halo", style.text.halo);
    std::string manner;
    if (!entry.text("manner", manner)) return;
    if (manner != "leader" && manner != "beside")
        throw Fault(entry.where() + " \"manner\" must be leader (above, with a line) or beside.");
    style.manner = manner == "leader" ? LabelCandidate::LEADER : LabelCandidate::BESIDE;
}

void readLine(const Entry& entry, LineStyle& style)
{
    entry.color("color", style.color);
    entry.color("casing", style.casing);
    entry.number("width", 0.1, 500.0, style.width);
    entry.number("least", 0.1, 500.0, style.least);
    entry.number("ground", 0.0, 1e5, style.ground);
    entry.number("casingWidth", 0.0, 100.0, style.casingWidth);
    entry.number("dash", 0.0, 1e6, style.dash);
    entry.number("gap", 0.0, 1e6, style.gap);
    entry.number("hand", 0.0, 1.0, style.hand);
    entry.number("rank", -1e6, 1e6, style.rank);
    entry.flag("straight", style.straight);
    entry.flag("shown", style.shown);
}

/// Those of one kind; one that is new begins as the usual one.
template<class Style, class Read>
void readAll(const json& whole, const std::string& file, const char* key,
             const std::vector<std::string>& known, std::map<std::string, Style>& styles, Read read)
{
    if (!whole.contains(key)) return;
    if (!whole.at(key).is_object())
        throw Fault("\"" + file + "\": \"" + key + "\" must be an object of styles by name.");
    for (const auto& [name, style] : whole.at(key).items())
    {
        std::string where = "\"" + file + "\", style \"";
        where += name;
        const Entry entry(style, where + "\":", known);
        const auto found = styles.find(name);
        Style changed = found != styles.end() ? found->second : styles[""];
        read(entry, changed);
        styles[name] = changed;
    }
}

/// Throws Fault.
void readFile(const std::string& file, MapStyles& styles)
{
    std::ifstream stream(file);
    if (!stream) throw Fault("The style file \"" + file + "\" cannot be read; check its name.");
    const json whole = json::parse(stream, nullptr, false, true);
    if (whole.is_discarded() || !whole.is_object() ||
        !(whole.contains("names") || whole.contains("lines") || whole.contains("nameField") ||
          whole.contains("lineField") || whole.contains("contextImportance")))
        throw Fault("\"" + file +
                    "\" is no style file; it must be JSON such as {\"names\": {\"peak\": {\"size\": 16}}, "
                    "\"lines\": {\"river\": {\"width\": 2}}}.");
    for (const auto& [key, value] : whole.items())
    {
        if (key == "names" || key == "lines" || key == "nameField" || key == "lineField" ||
            key == "contextImportance")
            continue;
        std::string sentence = "\"" + file + "\": \"";
        sentence += key;
        throw Fault(sentence +
                    "\" is not known; there are names, lines, nameField, lineField and contextImportance.");
    }
    readAll(whole, file, "names",
            {"font", "size", "bold", "italic", "spacing", "color", "halo", "haloWidth", "manner", "longest",
             "line", "dot"},
            styles.names, readName);
    readAll(whole, file, "lines",
            {"color", "casing", "width", "least", "ground", "casingWidth", "dash", "gap", "hand", "rank",
             "straight", "shown"},
            styles.lines, readLine);
    if (whole.contains("contextImportance"))
    {
        if (!whole.at("contextImportance").is_number())
            throw Fault("\"" + file + "\": \"contextImportance\" must be a number.");
        styles.contextImportance = whole.at("contextImportance").get<double>();
    }
    for (const auto& [key, field] :
         {std::pair("nameField", &styles.nameField), {"lineField", &styles.lineField}})
    {
        if (!whole.contains(key)) continue;
        if (!whole.at(key).is_string()) throw Fault("\"" + file + "\": \"" + key + "\" must be a text.");
        *field = whole.at(key).get<std::string>();
    }
}

} // namespace

bool MapStyles::read(const std::string& file, std::string& error)
{
    MapStyles changed = *this;
    try
    {
        readFile(file, changed);
    }
    catch (const std::exception& fault)
    {
        error = fault.what();
        return false;
    }
    *this = std::move(changed);
    return true;
}

void MapStyles::preferFont(const std::string& families)
{
    for (auto& [name, style] : names)
        style.text.font = families + "," + style.text.font;
}

bool MapStyles::preferFontFile(const std::string& file, std::string& error)
{
    std::string family;
    if (!addFontFile(file, family, error)) return false;
    preferFont(family);
    return true;
}

} // namespace osgGeoFX
