// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/map/MapContents.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Reads names and lines from vector files, and puts them on the ground of a scene.

    @code
    osgGeoFX::MapContents map;
    osgGeoFX::MapReader reader(*scene.node, *scene.effects);
    if (!reader.readNames("peaks.gpkg", "", "", error) || !reader.place(map, notices, error)) …
    scene.node = map.addTo(*scene.effects, *scene.node);
    @endcode

    The plugin osgdb_geofxdata reads the files (NameFile, LineFile). One thread at a time; no other thread may change the scene meanwhile.
    @ingroup map */
class OSGGEOFXMAPS_EXPORT MapReader
{
public:
    /// `node`: the scene's outermost node, with all that tells its place on the Earth. Both must outlive the reader.
    MapReader(osg::Node& node, EffectScene& scene);

    /// Reads the names of a file. `layer`: empty for all layers. `nameField`: as MapStyles::nameField. False, with a sentence in `error`, if it
    /// cannot, or if there are none.
    bool readNames(const std::string& file, const std::string& layer, const std::string& nameField,
                   std::string& error);
    /// The same for lines. `styleField`: as MapStyles::lineField.
    bool readLines(const std::string& file, const std::string& layer, const std::string& styleField,
                   std::string& error);

    /** Places all that was read, and appends it to `contents`, whose styles tell what is shown. `notices`: gets a sentence for what people should
        know. False, with a sentence in `error`, if there is no ground, or if all names or all lines lie beside it. */
    bool place(MapContents& contents, std::vector<std::string>& notices, std::string& error);

private:
    bool placeNames(MapContents& contents, const TerrainRelief& relief, std::vector<std::string>& notices,
                    std::string& error);
    bool placeLines(MapContents& contents, const TerrainRelief& relief, std::vector<std::string>& notices,
                    std::string& error);

    osg::Node& _node;
    EffectScene& _scene;
    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    std::string _wkt; ///< of a projected scene
    std::vector<MapName> _names;
    std::vector<MapLine> _lines;
};

} // namespace osgGeoFX
