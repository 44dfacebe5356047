// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/detail/LayerList.h>

#include <osgGeoFX/print/detail/LayerFile.h>

#include <algorithm>
#include <fstream>
#include <system_error>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

const std::vector<std::string> red = {"R", "G", "B"}, redAndOpacity = {"R", "G", "B", "A"};

std::string quoted(const std::string& text)
{
    std::string result = "\"";
    for (const char letter : text)
    {
        if (letter == '"' || letter == '\\') result += '\\';
        result += letter == '\n' ? ' ' : letter;
    }
    return result + "\"";
}

} // namespace

LayerList::LayerList(bool painted, bool water, bool strokes, const std::string& noReference)
    : _painted(painted)
{
    addColor("sky", "What stands behind the ground, also beyond the data. It covers the whole picture.",
             true);
    addColor("terrain", painted ? "The ground without shade, forest and water."
                                : "The ground, and all that stands on it, without light.");
    _layers.push_back({"shade", "shade.tif", red, "factor", "float", "",
                       "By what the colors of the terrain are multiplied, before it is put over the sky."});
    if (painted)
        addColor("forest", "The floor of the forest, in its light.");
    else
        leaveOut("forest", "No panorama map paints the ground.");
    if (painted && water)
        addColor("water", "The water with what it reflects.");
    else
        leaveOut("water", "No panorama map paints water.");
    if (painted && strokes)
        addColor("strokes", "Trees, cliffs, houses and lines, as strokes.");
    else
        leaveOut("strokes", "No panorama map paints strokes.");
    if (painted)
        _layers.push_back({"classes",
                           "classes.png",
                           {"Y"},
                           "value",
                           "uint8",
                           "",
                           "What takes the largest share of the pixel's middle; \"classes\" has the names."});
    else
        leaveOut("classes", "No panorama map paints the ground.");
    _layers.push_back({"distance",
                       "distance.tif",
                       {"Y"},
                       "value",
                       "float",
                       "m",
                       "The distance from the eye, in the deformed picture as drawn; NaN: none."});
    if (noReference.empty())
    {
        _layers.push_back({"height",
                           "height.tif",
                           {"Y"},
                           "value",
                           "float",
                           "m",
                           "The height above the database's zero height; NaN: none."});
        _layers.push_back({"lonlat",
                           "lonlat.tif",
                           {"longitude", "latitude"},
                           "value",
                           "double",
                           "degrees",
                           "The place on WGS 84, in two bands; NaN: none."});
        return;
    }
    leaveOut("height", noReference);
    leaveOut("lonlat", noReference);
}

void LayerList::addColor(const std::string& name, const std::string& meaning, bool opaque)
{
    _layers.push_back({name, name + ".png", opaque ? red : redAndOpacity, "color", "uint8", "", meaning});
}

const LayerList::Layer* LayerList::find(const std::string& name) const
{
    const auto found =
        std::find_if(_layers.begin(), _layers.end(), [&](const Layer& each) { return each.name == name; });
    return found == _layers.end() ? nullptr : &*found;
}

const LayerList::Layer& LayerList::addOverlay(const std::string& name, const std::string& meaning)
{
    addColor(name, meaning);
    return _layers.back();
}

void LayerList::leaveOut(const std::string& name, const std::string& why)
{
    _leftOut.emplace_back(name, why);
}

std::string LayerList::command() const
{
    // The uppermost comes first, since --over puts the last but one over the last.
    std::string command = "oiiotool --no-autopremult", overs;
    for (auto layer = _layers.rbegin(); layer != _layers.rend(); ++layer)
    {
        if (layer->kind != "color" || layer->name == "sky") continue;
        command += " " + layer->file;
        if (layer->name == "terrain") command += " shade.tif --ch R,G,B,A=1 --mul";
        command += " --premult";
        overs += " --over";
    }
    return command + " sky.png --ch R,G,B,A=1" + overs + " --ch R,G,B -d uint8 -o picture.png";
}

void LayerList::write(const fs::path& folder, int width, int height) const
{
    const fs::path file = folder / "layers.json";
    const fs::path unfinished = folder / "layers.unfinished.json";
    std::ofstream stream(unfinished);
    stream << "{\n  \"width\": " << width << ",\n  \"height\": " << height << ",\n  \"layers\": [";
    const char* comma = "\n";
    for (const Layer& layer : _layers)
    {
        stream << comma << "    {\"name\": " << quoted(layer.name) << ", \"file\": " << quoted(layer.file)
               << ", \"kind\": " << quoted(layer.kind) << ", \"type\": " << quoted(layer.type)
               << ", \"channels\": " << layer.channels.size()
               << (layer.unit.empty() ? "" : ", \"unit\": " + quoted(layer.unit))
               << ",\n     \"meaning\": " << quoted(layer.meaning) << "}";
        comma = ",\n";
    }
    stream << "\n  ],\n  \"leftOut\": [";
    comma = "\n";
    for (const auto& [name, why] : _leftOut)
    {
        stream << comma << "    {\"name\": " << quoted(name) << ", \"why\": " << quoted(why) << "}";
        comma = ",\n";
    }
    stream << "\n  ],\n";
    if (_painted)
        stream << "  \"classes\": {\"0\": \"none\", \"1\": \"field\", \"2\": \"hill\", \"3\": \"cliff\", "
                  "\"4\": \"snow\", \"5\": \"forest\", \"6\": \"town\", \"7\": \"bare ground\", \"8\": "
                  "\"water\"},\n";
    stream
        << "  \"recipe\": "
        << quoted(
               "Colors are 0 to 1, as they are coded (sRGB), with straight opacity. Begin with the sky. "
               "Multiply the terrain's colors by the shade's, and put it over. Then put each other layer of "
               "colors over, in the order of the list: result = result * (1 - opacity) + color * opacity.")
        << ",\n  \"command\": " << quoted(command()) << "\n}\n";
    stream.close();
    std::error_code fault;
    if (stream) fs::rename(unfinished, file, fault);
    if (!stream || fault)
        throw LayerFault("\"" + file.string() +
                         "\" cannot be written; check the folder, its permissions and the disk's space.");
}

} // namespace osgGeoFX
