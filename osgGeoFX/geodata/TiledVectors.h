// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/mapping/RasterTiles.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

struct VectorShapes;

/** The areas, lines and points of any vector data that GDAL opens, as they lie on the ground. Areas and lines become tiles for a
    PagedRaster: they are drawn again in each tile, with smooth edges, so they are sharp at any magnification, down to a texel of 2 cm. Points become symbols.

    **Looks** come from an SLD file (OGC Styled Layer Descriptor, 1.0 and 1.1, as QGIS and GeoServer write them): PolygonSymbolizer, LineSymbolizer and
    PointSymbolizer, by rules with filters (comparisons, And, Or, Not, ElseFilter) and scales. Its values may be fields and sums of such. Without it the file `NAME.sld` beside `NAME.EXT` is
    taken; else the features' own styles (OGR's feature style strings, as of KML, DXF and MapInfo); else plain colors. Texts are left out.

    Lengths in pixels are about those of the picture's pixels for areas and lines, since a tile is seen from many distances: a third more at most, in bends, too, and down to a quarter where a tile is seen near and far. Of symbols they are exact. With `uom` of metres they are on the ground.

    Rings that cross themselves are filled by the even-odd rule. In degrees, lines go the short way across the antimeridian, and areas must be cut there (RFC 7946). More than
    ten million vertices or 100,000 symbols are refused.

    A plain value. Thread-safe.
    @ingroup geodata */
class OSGGEOFXDATA_EXPORT TiledVectors
{
public:
    struct Options
    {
        std::string layer;         ///< one layer; empty: all
        std::string style;         ///< an SLD file; empty: see above
        bool allowOutside = false; ///< whether a style may name pictures outside of its folder, and addresses
    };

    /// A point, as a picture whose middle lies there.
    struct Symbol
    {
        std::string name;                       ///< the feature's field "name"; may be empty
        double longitude = 0.0, latitude = 0.0; ///< degrees
        std::optional<double> height;           ///< the feature's own, metres
        osg::ref_ptr<DataLayer> layer;          ///< shared by those that look the same
        double side = 0.0;                      ///< of the square picture, metres; of one in pixels: at most
        double pixels = 0.0;                    ///< the side on the screen; 0: it is in metres
    };

    /// Empty, with a sentence in `error` that names file and remedy, if the file cannot be used.
    static std::optional<TiledVectors> read(const std::string& file, const Options& options,
                                            std::string& error);
    /// Whether GDAL opens a file as vector data, and as no raster.
    static bool isVectors(const std::string& file);

    bool hasShapes() const;
    /// Of a circle on the globe that has all shapes and symbols in it: degrees, and radians of arc.
    osg::Vec2d middle() const;
    double radius() const;
    /// The smallest texel that its tiles have, metres.
    double texel() const;
    /// Sentences that people should know, such as on parts of a style that are left out.
    const std::vector<std::string>& notices() const;
    const std::vector<Symbol>& symbols() const { return _symbols; }

    /// The shapes in a frame. Null, with a sentence in `error`, if none of them lies in its projection. `window`: of a globe around which they reach, one of six
    /// faces, whose origin the frame has.
    osg::ref_ptr<RasterTiles> tiles(const MappingFrame& frame,
                                    const std::optional<MappingRaster::Window>& window,
                                    std::string& error) const;
    /// The same of a file, as LayerSource tells of it.
    static osg::ref_ptr<RasterTiles> open(const LayerSource& source, std::string& error);

private:
    std::shared_ptr<const VectorShapes> _shapes;
    std::vector<Symbol> _symbols;
    Options _options;
};

} // namespace osgGeoFX
