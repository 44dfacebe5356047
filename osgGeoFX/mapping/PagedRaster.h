// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/mapping/RasterTiles.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

class PageSight;
struct SeenGround;

/** A raster that is larger than memory, on the ground: 60,000 x 60,000 pixels and more. What cameras see of it is read in
    tiles, by threads of its own, coarse ones first, within an amount of memory; the tiles needed longest ago make room.

    @code
    const osg::ref_ptr<osgGeoFX::PagedRaster> raster = osgGeoFX::PagedRaster::create(tiles, {}, error);
    if (raster) mappings->addRaster(raster); // a ProjectiveMappings, whose frame is that of the tiles
    @endcode

    getMapping() stands for it in the list of mappings: its order, opacity, table, transfer, fades and the like are those of
    all tiles. Its own layer is a coarse picture of all of the raster, which is there at once. In each frame tiles are shown
    in its place, which do not overlap: fine where the camera needs it, coarser where fine ones are still missing, or out of
    sight. What is needed follows from the boxes of what is drawn, as for pages of composed mappings: nothing is read back from
    the GPU, and deformations count. If a view needs more than the memory holds, all of it is coarser.

    Values are greys from the lowest to the highest at first. The rectangle of the mapping must stay as it is, and a mask shows
    nothing. OSG's files have the raster if its tiles have a source(), which is opened again when they are read; of others they have the mapping with its coarse picture alone.

    **Threads.** add and remove it between frames. Any number of cameras may see it; statistics() may be called from any thread.
    @ingroup mapping */
class OSGGEOFX_EXPORT PagedRaster : public osg::Referenced
{
public:
    struct Options
    {
        int megabytes =
            256; ///< for tiles in main memory and on the GPU together, of each camera that sees it, 32…65536 MiB
        int threads = 2; ///< that read, 1…16
        /// So many tiles are shown for the first time in a frame, 1…64: each takes about a millisecond. More, where frames take so long
        /// that it is a tenth of their time.
        int tilesPerFrame = 6;
    };

    /// Reads the coarse picture. Null, with a sentence in `error`, if it cannot be read, or if an option is out of range. `mapping`: the one that
    /// shall stand for it, which gets the layer's picture and the rectangle and keeps its look; null for one of its own.
    static osg::ref_ptr<PagedRaster> create(RasterTiles* tiles, const Options& options, std::string& error,
                                            ProjectiveMapping* mapping = nullptr);
    const Options& getOptions() const;
    const RasterTiles& tiles() const;

    /// Stands for the raster, and says how it looks. Never null.
    ProjectiveMapping* getMapping();
    const ProjectiveMapping* getMapping() const;

    /// A part of the raster in memory.
    struct Tile
    {
        osg::ref_ptr<DataLayer> layer; ///< not to be changed; null beyond the raster
        osg::Vec2d low, high;          ///< what it covers, metres in the frame
    };
    /// The finest tile in memory at a place of the frame, metres; beside what was read there is always a coarse one. From any thread.
    Tile tileAt(const osg::Vec2d& place) const;

    struct Statistics
    {
        int shown = 0;    ///< tiles and parts of coarser ones
        int wanted = 0;   ///< tiles that the cameras need now
        int waiting = 0;  ///< tiles that are not read yet, of these and above them
        int inMemory = 0; ///< tiles
        int failed = 0;   ///< tiles that could not be read when last tried; coarser ones show in their place
        std::size_t read = 0;   ///< tiles, since the beginning
        double megabytes = 0.0; ///< of main memory and the GPU
        /// The last frame showed all that it needs, as fine as it needs it; a picture that is coarser for lack of memory, too.
        bool settled = false;
        bool coarser = false; ///< for lack of memory
        /// Why a tile that the last frame needed could not be read; empty if all could. It is tried again while a camera needs it, after a
        /// second and then after times that double, up to a minute.
        std::string fault;
    };
    Statistics statistics() const;

protected:
    ~PagedRaster() override;

private:
    friend class ProjectiveMappings;
    using Parts = std::vector<osg::ref_ptr<ProjectiveMapping>>;
    class Work;

    PagedRaster(RasterTiles* tiles, const Options& options, osg::Image* coarse, ProjectiveMapping* mapping);
    /// The part of the plane that the raster covers.
    osg::Vec2d low() const;
    osg::Vec2d high() const;
    /// The pages of so many texels a side that its tiles take.
    int pagesOf(int side) const;
    /// What a camera needs from now on.
    void see(const void* camera, const std::vector<SeenGround>& seen, PageSight& sight);
    /// It is shown in a new place: the next update gives all mappings.
    void reset();
    /// The mappings to show in the place of the one that stands for it; false if they are those of the last call.
    bool update(Parts& parts);

    std::unique_ptr<Work> _work;
};

} // namespace osgGeoFX
