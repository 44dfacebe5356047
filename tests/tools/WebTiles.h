// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cpl_vsi.h>
#include <tools/KmlFiles.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <optional>
#include <string>

namespace geofx::test
{

/// A tile of a map of the world in Web Mercator; y counts from the north.
struct WebTile
{
    int level = 0, x = 0, y = 0;

    /// Of a name such as "12/2127/1474.png".
    static std::optional<WebTile> parse(const std::string& name)
    {
        WebTile tile;
        char end = 0;
        if (std::sscanf(name.c_str(), "%d/%d/%d.pn%c", &tile.level, &tile.x, &tile.y, &end) != 4 ||
            end != 'g')
            return std::nullopt;
        return tile;
    }
};

/// The bytes of a PNG of 256 × 256 pixels.
inline std::string pngTile(const std::function<std::array<int, 4>(int, int)>& color)
{
    static std::atomic<int> number{0};
    const std::string file = "/vsimem/tile" + std::to_string(++number) + ".png";
    writePicture(file, 256, 256, color);
    vsi_l_offset size = 0;
    const GByte* const data = VSIGetMemFileBuffer(file.c_str(), &size, FALSE);
    const std::string bytes(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size));
    VSIUnlink(file.c_str());
    return bytes;
}

/// What a file of a user's says to GDAL of a service with so many levels below the coarsest. `more`: further elements.
inline std::string serviceText(const std::string& address, int levels, const std::string& more = {})
{
    return "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://" + address +
           "/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow><UpperLeftX>-20037508.34</UpperLeftX>"
           "<UpperLeftY>20037508.34</UpperLeftY><LowerRightX>20037508.34</LowerRightX>"
           "<LowerRightY>-20037508.34</LowerRightY><TileLevel>" +
           std::to_string(levels) +
           "</TileLevel><TileCountX>1</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin></"
           "DataWindow>"
           "<Projection>EPSG:3857</Projection><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY>"
           "<BandsCount>3</BandsCount>" +
           more + "</GDAL_WMS>";
}

} // namespace geofx::test
