// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/TileAddress.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <cpl_minixml.h>
#include <cpl_string.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* RESOURCE = "tilemapresource.xml";
constexpr double MERCATOR = 20037508.342789244; // half of a web map's side, metres
constexpr int WEB_SIDE = 256, WEB_LEVEL = 18, MOST_LEVEL = 22;

bool isAddress(const std::string& name)
{
    return name.find("://") != std::string::npos;
}

bool hasPlaces(const std::string& name)
{
    const auto has = [&](const char* place)
    {
        return name.find(place) != std::string::npos;
    };
    return name.find('<') == std::string::npos && has("{z}") && has("{x}") && (has("{y}") || has("{-y}"));
}

void replace(std::string& text, const std::string& from, const std::string& to)
{
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

std::string inXml(const std::string& text)
{
    char* const escaped = CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML);
    std::string result = escaped;
    CPLFree(escaped);
    return result;
}

/// A path as an address. GDAL's places, ${z}, stay.
std::string addressOf(const std::string& path)
{
    std::error_code code;
    std::string result = "file://";
    for (const unsigned char c : fs::absolute(path, code).lexically_normal().string())
        if (c == '%' || c == '#' || c == '?' || c <= ' ' || c >= 0x7f)
            result += CPLSPrintf("%%%02X", c);
        else
            result += static_cast<char>(c);
    return result;
}

/// The deepest level of a folder of tiles: its subfolders have the levels' numbers.
int deepestLevel(const std::string& folder)
{
    int deepest = -1;
    std::error_code code;
    for (fs::directory_iterator entry(folder.empty() ? "." : folder, code), end; !code && entry != end;
         entry.increment(code))
    {
        const std::string name = entry->path().filename().string();
        if (!name.empty() && name.size() <= 2 && name.find_first_not_of("0123456789") == std::string::npos)
            deepest = std::max(deepest, std::min(std::stoi(name), MOST_LEVEL));
    }
    return deepest;
}

/// Square tiles, from an outermost corner on.
struct Tiles
{
    std::string address;                                               ///< with GDAL's places
    bool isSparse = false;                                             ///< whether tiles may lack
    bool southern = false;                                             ///< whether rows count from the south
    double west = -MERCATOR, south = -MERCATOR, side = 2.0 * MERCATOR; ///< of a tile of level 0, in the CRS
    int columns = 1, rows = 1;                                         ///< of level 0
    int level = WEB_LEVEL, width = WEB_SIDE, height = WEB_SIDE;
    std::string crs = "EPSG:3857";

    bool isAddressOfFile() const { return address.rfind("file://", 0) == 0; }
    std::string description() const
    {
        const double east = west + columns * side, north = south + rows * side;
        return "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + inXml(address) +
               "</ServerUrl></Service><DataWindow>" +
               CPLSPrintf("<UpperLeftX>%.17g</UpperLeftX><UpperLeftY>%.17g</UpperLeftY><LowerRightX>%.17g</"
                          "LowerRightX>"
                          "<LowerRightY>%.17g</LowerRightY>",
                          west, north, east, south) +
               CPLSPrintf("<TileLevel>%d</TileLevel><TileCountX>%d</TileCountX><TileCountY>%d</TileCountY>"
                          "<YOrigin>%s</YOrigin>",
                          level, columns, rows, southern ? "bottom" : "top") +
               "</DataWindow><Projection>" + inXml(crs) + "</Projection>" +
               CPLSPrintf("<BlockSizeX>%d</BlockSizeX><BlockSizeY>%d</BlockSizeY>", width, height) +
               "<BandsCount>4</BandsCount>" +
               (isSparse ? "<ZeroBlockHttpCodes>204,404</ZeroBlockHttpCodes>" : "") +
               (isAddressOfFile() ? "" : "<Cache/>") + "</GDAL_WMS>";
    }
};

std::string fromPlaces(std::string name)
{
    Tiles tiles;
    tiles.southern = name.find("{-y}") != std::string::npos;
    if (!isAddress(name))
    {
        const std::size_t place = name.find("{z}");
        const std::size_t slash = name.rfind('/', place);
        const std::string folder = slash == std::string::npos ? "" : name.substr(0, slash + 1);
        tiles.level = deepestLevel(folder);
        if (tiles.level < 0)
            throw BuildError(
                name + ": there are no tiles; the folder of {z} has no folders with the numbers of levels.");
        tiles.isSparse = true;
        name = addressOf(name);
    }
    replace(name, "{-y}", "${y}");
    replace(name, "{r}", "");
    replace(name, "{s}", "a");
    for (const char* const each : {"{x}", "{y}", "{z}"})
        for (std::size_t at = name.find(each); at != std::string::npos; at = name.find(each, at + 4))
            if (at == 0 || name[at - 1] != '$') name.insert(at, "$");
    tiles.address = name;
    return tiles.description();
}

struct XmlDestroyer
{
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};

double numberIn(const CPLXMLNode* node, const char* name)
{
    return CPLAtof(CPLGetXMLValue(node, name, "nan"));
}

/// Of a tilemapresource.xml, as gdal2tiles and MapTiler write it.
std::string fromResource(const std::string& file)
{
    const auto fail = [&](const std::string& what)
    {
        throw BuildError(
            file + ": " + what +
            "; make the tiles again with gdal2tiles.py, or give their address with {z}, {x} and {y}.");
    };
    const GdalErrorScope errors;
    const std::unique_ptr<CPLXMLNode, XmlDestroyer> xml(
        CPLParseXMLFile((isAddress(file) ? "/vsicurl/" + file : file).c_str()));
    const CPLXMLNode* const map = xml ? CPLGetXMLNode(xml.get(), "=TileMap") : nullptr;
    const CPLXMLNode* const sets = map ? CPLGetXMLNode(map, "TileSets") : nullptr;
    if (!sets) fail("this is no description of tiles");
    Tiles tiles;
    tiles.isSparse = tiles.southern = true;
    tiles.level = -1;
    tiles.crs = CPLGetXMLValue(map, "SRS", "");
    tiles.width = std::atoi(CPLGetXMLValue(map, "TileFormat.width", "256"));
    tiles.height = std::atoi(CPLGetXMLValue(map, "TileFormat.height", "256"));
    double step = 0.0; // of a pixel of level 0
    std::string address;
    for (const CPLXMLNode* set = sets->psChild; set; set = set->psNext)
    {
        if (set->eType != CXT_Element || !EQUAL(set->pszValue, "TileSet")) continue;
        const int level = std::atoi(CPLGetXMLValue(set, "order", "-1"));
        if (level <= tiles.level || level > MOST_LEVEL) continue;
        tiles.level = level;
        step = std::ldexp(numberIn(set, "units-per-pixel"), level);
        address = CPLGetXMLValue(set, "href", "");
    }
    constexpr int mostSide = 4096;
    if (tiles.level < 0 || !(step > 0.0) || tiles.width < 1 || tiles.width > mostSide ||
        tiles.height != tiles.width)
        fail("its levels or the size of its tiles are missing");
    const std::string profile = CPLGetXMLValue(sets, "profile", "");
    tiles.side = step * tiles.width;
    if (profile.find("mercator") != std::string::npos)
    {
        tiles.side = 2.0 * MERCATOR;
        tiles.crs = "EPSG:3857";
    }
    else if (profile.find("geodetic") != std::string::npos)
    {
        tiles.west = -180.0;
        tiles.south = -90.0;
        tiles.side = 180.0;
        tiles.columns = 2;
        tiles.crs = "EPSG:4326";
    }
    else
    {
        const double east = numberIn(map, "BoundingBox.maxx"), north = numberIn(map, "BoundingBox.maxy");
        tiles.west = numberIn(map, "BoundingBox.minx");
        tiles.south = numberIn(map, "BoundingBox.miny");
        const double columns = std::ceil((east - tiles.west) / tiles.side - 1e-6),
                     rows = std::ceil((north - tiles.south) / tiles.side - 1e-6);
        if (!(columns >= 1.0 && columns <= 1024.0 && rows >= 1.0 && rows <= 1024.0) || tiles.crs.empty())
            fail("its bounding box or its coordinate reference system is missing");
        tiles.columns = static_cast<int>(columns);
        tiles.rows = static_cast<int>(rows);
    }
    const std::string level = std::to_string(tiles.level),
                      places =
                          "${z}/${x}/${y}." + std::string(CPLGetXMLValue(map, "TileFormat.extension", "png"));
    // Without the level's number at its end.
    if (address.size() >= level.size() &&
        address.compare(address.size() - level.size(), level.size(), level) == 0)
        address.resize(address.size() - level.size());
    const std::string folder = file.substr(0, file.size() - std::string(RESOURCE).size());
    tiles.address = isAddress(address) ? address + places
                    : isAddress(file)  ? folder + address + places
                                       : addressOf(folder + address + places);
    return tiles.description();
}

bool endsWithResource(const std::string& name)
{
    const std::string file = RESOURCE;
    return name.size() >= file.size() && name.compare(name.size() - file.size(), file.size(), file) == 0;
}

/// The tilemapresource.xml that a name stands for; empty if it stands for none.
std::string resourceOf(const std::string& name)
{
    if (endsWithResource(name)) return name;
    if (isAddress(name)) return {};
    std::error_code code;
    const fs::path file = fs::path(name) / RESOURCE;
    return fs::is_directory(name, code) && fs::exists(file, code) ? file.string() : std::string();
}

} // namespace

bool TileAddress::is(const std::string& name)
{
    return hasPlaces(name) || !resourceOf(name).empty();
}

std::string TileAddress::forGdal(const std::string& name)
{
    if (hasPlaces(name)) return fromPlaces(name);
    const std::string resource = resourceOf(name);
    return resource.empty() ? name : fromResource(resource);
}

} // namespace osgGeoFX
