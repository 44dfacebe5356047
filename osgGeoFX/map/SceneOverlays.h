// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Node>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

struct OverlayFile;

/** Puts files onto the ground of a scene: KML and KMZ ground overlays, any raster with a georeference, and the areas, lines and points of any vector data.

    @code
    osgGeoFX::SceneOverlays overlays(*scene.node, *scene.effects);
    std::vector<std::string> notices;
    std::string error;
    if (!overlays.add("fire.kmz", {}, notices, error)) …
    @endcode

    Each file lies on top of those before. Its mappings are in effects of this object's own, one for each frame that OverlayReader
    needs (as a rule one), behind the scene's other effects; a mapping has the overlay's name. The plugin osgdb_geofxdata reads the
    files. One thread at a time, between frames.
    @ingroup map */
class OSGGEOFXMAPS_EXPORT SceneOverlays
{
public:
    /// `node`: the scene's outermost node, with all that tells its place on the Earth. Both must outlive this.
    SceneOverlays(osg::Node& node, EffectScene& scene);

    struct Options
    {
        /// Whether a KML file may name files outside of its folder, and addresses.
        bool allowOutside = false;
        /// Colors of values: an SLD file, or one that ColorRampFile reads. Empty: greys from the lowest to the highest value.
        std::string colors;
        std::string layer; ///< of vector data: one layer; empty: all, and the file may be a raster
        std::string
            style; ///< of vector data: an SLD file; empty: the one beside the file, the features' own, or plain colors
        std::optional<RasterBands>
            bands;          ///< of rasters: what is shown; nothing: the file and its numbers decide
        int maxSide = 2048; ///< texels along the longer side of a raster, 1…16384
        /// Whether a raster with more pixels than that, and a georeference, is read in tiles as it is needed (PagedRaster).
        bool paged = false;
        PagedRaster::Options paging = {};
    };
    /// Adds a file. False, with a sentence in `error`, if it cannot; the scene stays as it is then. `notices` gets sentences that
    /// people should know.
    bool add(const std::string& file, const Options& options, std::vector<std::string>& notices,
             std::string& error);

    /// The effects with the mappings.
    const std::vector<osg::ref_ptr<ProjectiveMappings>>& effects() const { return _effects; }

    /// Of the KML files that were added: these themselves and the files on disk that they link or show.
    const std::vector<std::string>& files() const { return _files; }

private:
    /// Symbols without a height stand on the ground.
    void giveHeights(OverlayFile& request) const;

    osg::Node& _node;
    osg::ref_ptr<EffectScene> _scene;
    std::string _wkt; ///< of a projected scene
    std::vector<osg::ref_ptr<ProjectiveMappings>> _effects;
    std::vector<std::string> _files;
};

} // namespace osgGeoFX
