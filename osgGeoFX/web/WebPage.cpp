// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/web/WebPage.h>

#include <osgGeoFX/raster/PictureFile.h>
#include <osgGeoFX/web/detail/BakedPage.h>
#include <osgGeoFX/web/detail/PlaceGrid.h>
#include <osgGeoFX/web/detail/TilePyramid.h>

#include <libxml/entities.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio> // renameat2(), too
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace osgGeoFX
{

namespace
{

class Fault : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

constexpr const char* page = "index.html";
/// By it a former page is known.
constexpr const char* mark = "<meta name=\"generator\" content=\"osgGeoFX\">";
constexpr const char* leafletFiles[] = {"leaflet.js", "leaflet.css"};

std::string contentOf(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void writeFile(const fs::path& file, const std::string& content)
{
    std::ofstream stream(file, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream)
        throw Fault("\"" + file.string() +
                    "\" cannot be written; check the folder's permissions and the disk's space.");
}

/// Without a slash at its end and without dots, so that it has a name and a folder above it.
fs::path pathOf(const std::string& folder)
{
    fs::path path = fs::absolute(folder).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    // A link stays: what it leads to is replaced.
    std::error_code fault;
    const fs::path real = fs::canonical(path, fault);
    return fault ? path : real;
}

/// What a page has at its top.
std::set<std::string> partsOf()
{
    std::set<std::string> parts = {"leaflet", "tiles", "data"};
    for (std::size_t i = 0; i < bakedPageCount; ++i)
        parts.insert(fs::path(bakedPage[i].name).begin()->string());
    return parts;
}

std::string faultOfFolder(const fs::path& path, const std::string& folder)
{
    std::error_code fault;
    if (!fs::exists(path, fault))
    {
        if (fs::is_directory(path.parent_path(), fault)) return {};
        return "\"" + folder + "\" cannot be made, since there is no folder \"" +
               path.parent_path().string() + "\"; make that one first.";
    }
    if (!fs::is_directory(path, fault))
        return "\"" + folder + "\" is a file; name a folder for the web page.";
    if (fs::is_empty(path, fault)) return {};
    const std::string other = "; name another folder, or empty this one.";
    if (contentOf(path / page).find(mark) == std::string::npos)
        return "\"" + folder + "\" has files that are no page of osgGeoFX, which are not removed" + other;
    const std::set<std::string> parts = partsOf();
    for (const fs::directory_entry& entry : fs::directory_iterator(path, fault))
        if (!parts.count(entry.path().filename().string()))
            return std::string("\"")
                .append(folder)
                .append("\" has \"")
                .append(entry.path().filename().string())
                .append("\" beside the page, which is not removed")
                .append(other);
    return {};
}

fs::path leafletOf(const std::string& folder)
{
    return folder.empty() ? fs::path(GEOFX_LEAFLET) : fs::path(folder);
}

/// Text in HTML, also within quotes.
std::string escaped(const std::string& text)
{
    const std::unique_ptr<xmlChar, void (*)(void*)> result(
        xmlEncodeSpecialChars(nullptr, reinterpret_cast<const xmlChar*>(text.c_str())), xmlFree);
    return result ? reinterpret_cast<const char*>(result.get()) : std::string();
}

void replace(std::string& text, const std::string& key, const std::string& value)
{
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + value.size()))
        text.replace(at, key.size(), value);
}

/// A number with no more digits than it needs in the file.
ordered_json decimal(double value, int digits)
{
    char text[64];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return ordered_json::parse(text);
}

std::string colorOf(const osg::Vec4& color)
{
    const auto byte = [](float value)
    {
        return static_cast<int>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    };
    char text[10];
    std::snprintf(text, sizeof(text), "#%02x%02x%02x%02x", byte(color.r()), byte(color.g()), byte(color.b()),
                  byte(color.a()));
    return text;
}

ordered_json jsonOf(const NameStyle& look)
{
    ordered_json json;
    json["font"] = look.text.font;
    json["size"] = decimal(look.text.size, 2);
    json["bold"] = look.text.bold;
    json["italic"] = look.text.italic;
    json["spacing"] = decimal(look.text.spacing, 3);
    json["color"] = colorOf(look.text.color);
    json["halo"] = colorOf(look.text.halo);
    json["haloWidth"] = decimal(look.text.haloWidth, 3);
    json["leader"] = look.manner == LabelCandidate::LEADER;
    json["line"] = decimal(look.lineWidth, 2);
    json["dot"] = decimal(look.dot, 2);
    return json;
}

ordered_json jsonOf(const WebName& name)
{
    ordered_json json;
    json["text"] = name.text;
    json["style"] = name.style;
    json["at"] = {decimal(name.anchor.x(), 2), decimal(name.anchor.y(), 2)};
    json["size"] = {decimal(name.size.x(), 1), decimal(name.size.y(), 1)};
    if (name.longitude && name.latitude)
        json["place"] = {decimal(*name.longitude, 6), decimal(*name.latitude, 6)};
    if (name.height) json["height"] = decimal(*name.height, 0);
    if (name.alongCurve)
    {
        json["curve"] = ordered_json::array();
        for (const osg::Vec2d& point : name.curve)
            json["curve"].push_back({decimal(point.x(), 1), decimal(point.y(), 1)});
    }
    // First and last step, and the corner from the anchor.
    json["shown"] = ordered_json::array();
    for (const WebName::Shown& shown : name.shown)
        json["shown"].push_back(
            {shown.from, shown.to, decimal(shown.corner.x(), 1), decimal(shown.corner.y(), 1)});
    return json;
}

/// Scripts, since a page that was opened by a double click may read nothing else.
void writeData(const fs::path& folder, const std::string& key, const ordered_json& json)
{
    // Bytes that are not UTF-8 become replacement characters, as on the picture.
    writeFile(folder / (key + ".js"), "geofx.data." + key + " = " +
                                          json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) +
                                          ";\n");
}

void writeNames(const fs::path& folder, const std::vector<WebName>& names)
{
    ordered_json json;
    json["stepsOfZoom"] = WebNames::stepsOfZoom;
    json["styles"] = ordered_json::object();
    json["names"] = ordered_json::array();
    for (const WebName& name : names)
    {
        if (!json["styles"].contains(name.style)) json["styles"][name.style] = jsonOf(name.look);
        json["names"].push_back(jsonOf(name));
    }
    writeData(folder, "names", json);
}

void writePlaces(const fs::path& folder, const WebPlaces& places)
{
    ordered_json json;
    if (places.at)
    {
        const PlaceGrid grid(places);
        json["width"] = places.width;
        json["height"] = places.height;
        json["first"] = grid.first;
        json["step"] = grid.step;
        json["columns"] = grid.columns;
        json["rows"] = grid.rows;
        json["unit"] = PlaceGrid::unit;
        json["samples"] = grid.samples;
        json["squares"] = grid.squares;
    }
    writeData(folder, "places", json);
}

/// Cuts the picture into tiles. Its size comes back.
std::pair<int, int> writeTiles(const WebPage::Options& options, const fs::path& folder)
{
    const auto input = PictureReader::open(options.picture);
    if (!input)
        throw Fault("The picture \"" + options.picture + "\" cannot be read; check its name and its format.");
    const PictureHeader& header = input->header();
    const std::size_t width = static_cast<std::size_t>(header.width), channels = header.channels.size();
    if (header.tiled || channels < 1)
        throw Fault("The picture \"" + options.picture + "\" is not stored row by row; write it as PNG.");
    TilePyramid pyramid(folder.string(), header.width, header.height, options.quality);
    std::vector<unsigned char> raw(width * channels), row(width * 3);
    for (int y = 0; y < header.height; ++y)
    {
        if (!input->read(raw.data(), PictureNumber::BYTE))
            throw Fault("The picture \"" + options.picture + "\" cannot be read (" + input->error() +
                        "); write it again.");
        // Gray ones have one channel, perhaps with a second one for what is clear.
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t channel = 0; channel < 3; ++channel)
                row[3 * x + channel] = raw[channels * x + (channels > 2 ? channel : 0)];
        pyramid.add(row.data());
    }
    return {header.width, header.height};
}

void writeLeaflet(const fs::path& from, const fs::path& to)
{
    fs::create_directories(to / "images");
    for (const char* const file : leafletFiles)
        writeFile(to / file, contentOf(from / file));
    // A third as large where Debian has it so. It must not ask for a file that helps its developers.
    std::string small = contentOf(from / "leaflet.min.js");
    const std::size_t map = small.rfind("//# sourceMappingURL");
    if (map != std::string::npos) small.erase(map);
    if (!small.empty()) writeFile(to / "leaflet.js", small);
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(from / "images", none))
        if (entry.path().extension() == ".png")
            writeFile(to / "images" / entry.path().filename(), contentOf(entry.path()));
}

/// A new folder beside another one, with a name that nobody has.
fs::path newFolderBeside(const fs::path& folder)
{
    const std::string stem = "." + folder.filename().string() + "." + std::to_string(getpid()) + ".";
    for (int number = 0;; ++number)
    {
        fs::path made = folder.parent_path() / (stem + std::to_string(number));
        if (fs::create_directory(made)) return made;
    }
}

/// The new folder takes the place of the former one, in one step where the file system can.
void moveTo(const fs::path& folder, const fs::path& unfinished)
{
    std::error_code fault, ignored;
#ifdef RENAME_EXCHANGE
    if (renameat2(AT_FDCWD, unfinished.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0)
    {
        fs::remove_all(unfinished, ignored);
        return;
    }
#endif
    const fs::path former = unfinished.string() + ".former";
    const bool replaces = fs::exists(folder, ignored);
    if (replaces) fs::rename(folder, former, fault);
    if (!fault) fs::rename(unfinished, folder, fault);
    if (fault)
    {
        if (replaces && !fs::exists(folder, ignored)) fs::rename(former, folder, ignored);
        throw Fault("\"" + folder.string() + "\" cannot be put in place (" + fault.message() +
                    "); check the permissions of the folder above it.");
    }
    fs::remove_all(former, ignored);
}

void writePage(const WebPage::Options& options, const fs::path& folder)
{
    for (std::size_t i = 0; i < bakedPageCount; ++i)
    {
        std::string content(bakedPage[i].content, bakedPage[i].size);
        if (std::string(bakedPage[i].name) == page)
        {
            replace(content, "{{attribution}}", escaped(options.attribution));
            replace(content, "{{title}}", escaped(options.title));
        }
        const fs::path file = folder / bakedPage[i].name;
        fs::create_directories(file.parent_path());
        writeFile(file, content);
    }
}

void writeFolder(const WebPage::Options& options, const fs::path& folder)
{
    const fs::path unfinished = newFolderBeside(folder);
    try
    {
        fs::create_directories(unfinished / "data");
        const auto [width, height] = writeTiles(options, unfinished / "tiles");
        ordered_json picture;
        picture["title"] = options.title;
        picture["width"] = width;
        picture["height"] = height;
        picture["zoom"] = TilePyramid::levelsOf(width, height);
        picture["tile"] = TilePyramid::side;
        picture["places"] = static_cast<bool>(options.places.at);
        writeData(unfinished / "data", "picture", picture);
        writeNames(unfinished / "data", options.names);
        writePlaces(unfinished / "data", options.places);
        writeLeaflet(leafletOf(options.leaflet), unfinished / "leaflet");
        writePage(options, unfinished);
        moveTo(folder, unfinished);
    }
    catch (...)
    {
        std::error_code ignored;
        fs::remove_all(unfinished, ignored);
        throw;
    }
}

} // namespace

std::string WebPage::faultOf(const std::string& folder, const std::string& leaflet)
{
    std::error_code fault;
    for (const char* const file : leafletFiles)
        if (!fs::is_regular_file(leafletOf(leaflet) / file, fault))
            return "A web page needs Leaflet, and \"" + (leafletOf(leaflet) / file).string() +
                   "\" is not there; on Debian install libjs-leaflet.";
    return faultOfFolder(pathOf(folder), folder);
}

bool WebPage::write(const Options& options, const std::string& folder, std::string& error)
{
    error = faultOf(folder, options.leaflet);
    if (!error.empty()) return false;
    try
    {
        writeFolder(options, pathOf(folder));
        return true;
    }
    catch (const fs::filesystem_error& fault)
    {
        error = "\"" + folder + "\" cannot be written (" + fault.code().message() +
                "); check its permissions and the disk's space.";
    }
    catch (const std::runtime_error& fault)
    {
        error = fault.what();
    }
    return false;
}

} // namespace osgGeoFX
