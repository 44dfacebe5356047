// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "LiveLayers.h"

#include "BenchError.h"
#include "ChildProcess.h"
#include "Machine.h"
#include "WorkFolder.h"

#include <osgGeoFX/map/OverlayFile.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osgDB/WriteFile>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>

namespace geofx::bench
{

namespace
{

using namespace osgGeoFX;
using Clock = std::chrono::steady_clock;

constexpr double reach = 5000.0; ///< half the side of the ground, metres

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string milliseconds(const std::string& what, double time)
{
    char text[60];
    std::snprintf(text, sizeof text, "%.2f ms", time);
    return what + text;
}

void look(OffscreenView& view, const osg::Vec3d& eye, const osg::Vec3d& at)
{
    view.look(osg::Matrixd::lookAt(eye, at, osg::Vec3d(0.0, 0.0, 1.0)));
}

/// Rings that move on, in all texels.
void paint(osg::Image& image, int step)
{
    for (int y = 0; y < image.t(); ++y)
    {
        unsigned char* texel = image.data(0, static_cast<unsigned int>(y));
        for (int x = 0; x < image.s(); ++x, texel += 4)
        {
            const int wave = (x * x + y * y) / 512 + 5 * step;
            texel[0] = static_cast<unsigned char>(wave);
            texel[1] = static_cast<unsigned char>(x + step);
            texel[2] = static_cast<unsigned char>(y - step);
            texel[3] = 200;
        }
    }
}

/// Writes a raster of so many pixels a side as a virtual one of ten by ten files, all different to GDAL. Each has noise as fine as
/// its pixels, as photographs have.
std::string makeRaster(const std::filesystem::path& folder, int side)
{
    const int part = side / 10;
    {
        std::ofstream raw(folder / "part.bin", std::ios::binary);
        std::mt19937 engine(11);
        std::vector<unsigned char> row(static_cast<std::size_t>(part) * 3);
        for (int y = 0; y < part; ++y)
        {
            for (int x = 0; x < part; ++x)
            {
                const int noise = static_cast<int>(engine() % 60);
                unsigned char* texel = &row[static_cast<std::size_t>(x) * 3];
                texel[0] = static_cast<unsigned char>(60 + 100 * ((x / 50 + y / 80) % 2) + noise);
                texel[1] = static_cast<unsigned char>(90 + 60 * (x / 400 % 2) + noise);
                texel[2] = static_cast<unsigned char>(50 + 60 * (y / 300 % 2) + noise);
            }
            raw.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size()));
        }
        std::ofstream(folder / "part.hdr") << "ENVI\nsamples = " << part << "\nlines = " << part
                                           << "\nbands = 3\nheader offset = 0\ndata type = 1\n"
                                              "interleave = bip\nbyte order = 0\n";
    }
    const std::string first = (folder / "part-0.tif").string();
    runChild({"gdal_translate", "-q", "-co", "TILED=YES", "-co", "COMPRESS=JPEG", "-co", "PHOTOMETRIC=YCBCR",
              "-colorinterp", "red,green,blue", (folder / "part.bin").string(), first});
    runChild({"gdaladdo", "-q", "-r", "average", first, "2", "4", "8", "16", "32"});
    for (int i = 1; i < 100; ++i)
        std::filesystem::create_hard_link(first, folder / ("part-" + std::to_string(i) + ".tif"));
    const std::filesystem::path file = folder / "large.vrt";
    std::ofstream vrt(file);
    const double texel = 2.0 * reach / side;
    vrt << "<VRTDataset rasterXSize=\"" << side << "\" rasterYSize=\"" << side
        << "\">\n<SRS>EPSG:32604</SRS>\n"
        << "<GeoTransform>600000, " << texel << ", 0, 2360000, 0, " << -texel << "</GeoTransform>\n"
        << "<OverviewList resampling=\"average\">2 4 8 16 32 64 128 256</OverviewList>\n";
    const char* const colors[] = {"Red", "Green", "Blue"};
    for (int band = 1; band <= 3; ++band)
    {
        vrt << "<VRTRasterBand dataType=\"Byte\" band=\"" << band << "\"><ColorInterp>" << colors[band - 1]
            << "</ColorInterp>\n";
        for (int i = 0; i < 100; ++i)
            vrt << "<SimpleSource><SourceFilename relativeToVRT=\"1\">part-" << i
                << ".tif</SourceFilename><SourceBand>" << band
                << "</SourceBand><SourceProperties RasterXSize=\"" << part << "\" RasterYSize=\"" << part
                << "\" DataType=\"Byte\" BlockXSize=\"256\" BlockYSize=\"256\"/><SrcRect xOff=\"0\" "
                   "yOff=\"0\" xSize=\""
                << part << "\" ySize=\"" << part << "\"/><DstRect xOff=\"" << i % 10 * part << "\" yOff=\""
                << i / 10 * part << "\" xSize=\"" << part << "\" ySize=\"" << part << "\"/></SimpleSource>\n";
        vrt << "</VRTRasterBand>\n";
    }
    vrt << "</VRTDataset>\n";
    return file.string();
}

/// Processor time of a tile as fine as the raster, milliseconds: whatever else the machine does.
double tileTime(RasterTiles& tiles)
{
    std::vector<double> times;
    const double side = 256.0 * tiles.texel();
    for (int i = 0; i < 20; ++i)
    {
        const osg::Vec2d from(tiles.low().x() + (3.0 + 7.3 * i) * side,
                              tiles.low().y() + (5.0 + 3.7 * i) * side);
        std::string error;
        const double before = threadSeconds();
        if (!tiles.read(from, from + osg::Vec2d(side, side), 256, 256, error)) throw BenchError(error);
        times.push_back(1000.0 * (threadSeconds() - before));
    }
    return median(times);
}

/// What happens until all is there.
struct Paging
{
    double seconds = 0.0;
    std::vector<double> frames; ///< milliseconds
};

Paging settle(OffscreenView& view, const PagedRaster& raster)
{
    Paging paging;
    const auto start = Clock::now();
    for (int i = 0; i < 5000; ++i)
    {
        paging.frames.push_back(1000.0 * view.frame());
        // What this frame saw, the next one asks for.
        if (i >= 2 && raster.statistics().settled)
        {
            paging.seconds = secondsSince(start);
            return paging;
        }
    }
    throw BenchError("The tiles of the raster never all came.");
}

} // namespace

std::vector<Figure> liveLayers(OffscreenView& view, EffectScene& scene, const Settings& settings)
{
    announce("drawing a live layer");
    const int side = settings.smoke ? 64 : 1024;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    // Painting is the program's own; eight pictures in turn are put into the image.
    std::vector<osg::ref_ptr<osg::Image>> pictures;
    for (int i = 0; i < 8; ++i)
    {
        pictures.push_back(new osg::Image(*image, osg::CopyOp::DEEP_COPY_ALL));
        paint(*pictures.back(), i);
    }
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setLayer(new DataLayer(image));
    mapping->setRectangle({0.0, 0.0}, 0.8 * reach, 0.8 * reach);
    mappings->addMapping(mapping);
    scene.addEffect(mappings);
    look(view, {0.0, -7000.0, 5500.0}, {0.0, -700.0, 0.0});
    view.frame();
    const int rounds = settings.smoke ? 1 : settings.quick ? 10 : 30;
    std::vector<double> resting, live, part;
    std::size_t next = 0;
    const auto put = [&](int rows)
    {
        const osg::Image& picture = *pictures[next++ % pictures.size()];
        std::copy_n(picture.data(0, static_cast<unsigned int>(side / 2)),
                    static_cast<std::size_t>(rows) * picture.getRowSizeInBytes(),
                    image->data(0, static_cast<unsigned int>(side / 2)));
        image->dirty();
    };
    const auto putAll = [&]
    {
        const osg::Image& picture = *pictures[next++ % pictures.size()];
        std::copy_n(picture.data(), picture.getTotalSizeInBytes(), image->data());
        image->dirty();
    };
    for (int i = 0; i < rounds; ++i)
    {
        resting.push_back(1000.0 * view.frame());
        putAll();
        live.push_back(1000.0 * view.frame());
        put(side / 16);
        part.push_back(1000.0 * view.frame());
    }
    scene.removeEffect(mappings);
    Figure all{"live",
               "time of a frame in which a layer of 1024² texels has changed, over one without the change",
               "", Bound::Below, 1.5};
    all.measured = median(live) / median(resting);
    all.remark = milliseconds("changed ", median(live)) + milliseconds(", resting ", median(resting));
    Figure some{"live-part", "the same, a sixteenth of the rows have changed", ""};
    some.measured = median(part) / median(resting);
    return {all, some};
}

std::vector<Figure> pagedRaster(OffscreenView& view, EffectScene& scene, const Settings& settings)
{
    const int side = settings.smoke ? 5000 : 60000;
    announce("making a raster of " + std::to_string(side) + " pixels a side");
    const WorkFolder folder(settings.work);
    const std::string file = makeRaster(folder.path(), side);
    look(view, {0.0, -7000.0, 5500.0}, {0.0, -700.0, 0.0});
    for (int i = 0; i < 5; ++i)
        view.frame();

    announce("paging it");
    const double before = residentMiB();
    const auto start = Clock::now();
    OverlayFile overlays;
    overlays.file = file;
    overlays.globe = false;
    overlays.wkt = "EPSG:32604";
    overlays.paged = true;
    std::string error;
    if (!overlays.read(error)) throw BenchError(error);
    if (!overlays.overlays[0].tiles)
        throw BenchError(overlays.notices.empty() ? file + ": it has no tiles." : overlays.notices[0]);
    const double opened = secondsSince(start);
    const double tile = tileTime(*overlays.overlays[0].tiles);
    const auto second = Clock::now();
    const osg::ref_ptr<PagedRaster> raster = PagedRaster::create(overlays.overlays[0].tiles, {}, error);
    if (!raster) throw BenchError(error);
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addRaster(raster);
    scene.addEffect(mappings);
    view.frame();
    const double first = opened + secondsSince(second);
    settle(view, *raster);

    double slowest = 0.0, longest = 0.0, longestOverRest = 0.0, most = residentMiB();
    bool coarser = false;
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> where(-0.7 * reach, 0.7 * reach);
    for (int i = 0; i < (settings.smoke ? 2 : settings.quick ? 6 : 20); ++i)
    {
        // From far to near, somewhere else each time.
        const double height = i % 3 == 0 ? 200.0 : i % 3 == 1 ? 600.0 : 2500.0;
        const osg::Vec3d at(where(engine), where(engine), 0.0);
        look(view, at + osg::Vec3d(0.3 * height, -1.2 * height, height), at);
        const Paging paging = settle(view, *raster);
        std::vector<double> resting;
        for (int k = 0; k < 5; ++k)
            resting.push_back(1000.0 * view.frame());
        slowest = std::max(slowest, paging.seconds);
        // The first frame of another view has more to do, with tiles and without.
        for (std::size_t k = 1; k < paging.frames.size(); ++k)
        {
            longest = std::max(longest, paging.frames[k] / median(paging.frames));
            longestOverRest = std::max(longestOverRest, paging.frames[k] / median(resting));
        }
        most = std::max(most, residentMiB());
        coarser = coarser || raster->statistics().coarser;
        if (!settings.pictures.empty() && i < 3)
        {
            const std::filesystem::path picture = settings.pictures / ("paged-" + std::to_string(i) + ".png");
            if (!osgDB::writeImageFile(*view.capture(), picture.string()))
                throw BenchError(picture.string() + ": the picture cannot be written; name another folder.");
        }
    }
    scene.removeEffect(mappings);
    const PagedRaster::Statistics all = raster->statistics();
    Figure soon{"paged-first", "time to the first picture of a raster of 60,000² pixels", "seconds",
                Bound::AtMost, 1.0};
    soon.measured = first;
    Figure sharp{"paged-sharp", "the longest time until a new view of it is as sharp as its pixels",
                 "seconds", Bound::AtMost, 2.0};
    sharp.measured = slowest;
    sharp.remark = std::to_string(all.read) + " tiles were read" + (coarser ? "; a view was coarser" : "");
    Figure frames{"paged-frames", "the longest frame while it pages, over the median of these frames", "",
                  Bound::AtMost, 3.0};
    frames.measured = longest;
    char remark[60];
    std::snprintf(remark, sizeof remark, "over frames at rest %.2f", longestOverRest);
    frames.remark = remark;
    Figure read{"paged-tile", "processor time to read and warp a tile of 256² texels of it", "milliseconds"};
    read.measured = tile;
    Figure memory{"paged-memory", "growth of the main memory, with that of OpenGL", "MiB", Bound::Below,
                  512.0};
    memory.measured = most - before;
    return {soon, sharp, frames, memory, read};
}

} // namespace geofx::bench
