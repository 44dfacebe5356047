// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Node>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Puts rasters in time onto the ground of a scene: the time dimension of NetCDF, GRIB and Zarr, the bands of a raster, or a folder of
    rasters (SequenceRaster).

    @code
    osgGeoFX::SceneSequences sequences(*scene.node, *scene.effects);
    if (!sequences.add("forecast.nc:precipitation", {}, error)) …
    @endcode

    All sequences of a scene share a clock, which a LayerPlayer drives: an update callback of the EffectScene. Its speed is such
    that all of their time takes twenty seconds, until a program sets another one. Each sequence lies on top of those before,
    in an effect of its own behind the scene's other effects. One thread at a time, between frames.
    @ingroup map */
class OSGGEOFXMAPS_EXPORT SceneSequences
{
public:
    /// `node`: the scene's outermost node, with all that tells its place on the Earth. Both must outlive this.
    SceneSequences(osg::Node& node, EffectScene& scene);

    struct Options
    {
        std::string
            colors; ///< of values: an SLD file, or one that ColorRampFile reads; empty: viridis over their range
        double opacity = 1.0;                            ///< 0…1
        int maxSide = 1024;                              ///< texels along the longer side, 1…16384
        std::optional<RasterBands> bands = std::nullopt; ///< of a folder of pictures: what is shown
    };
    /// Adds a file, "FILE" or "FILE:VARIABLE", or a folder. False, with a sentence in `error`, if it cannot; the scene stays as it is then.
    bool add(const std::string& file, const Options& options, std::string& error);

    /// The scene's player, which has the clock.
    LayerPlayer& player() { return *_player; }

private:
    osg::ref_ptr<EffectScene> _scene;
    std::string _wkt; ///< of a projected scene
    osg::ref_ptr<LayerPlayer> _player;
};

} // namespace osgGeoFX
