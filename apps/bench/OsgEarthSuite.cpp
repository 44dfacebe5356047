// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The kit's terrain beside osgEarth's: the same DEM on a whole Earth, the same picture on it, no light, the same views.
#include "OsgEarthSuite.h"

#include "BenchError.h"
#include "ChildProcess.h"
#include "OahuSource.h"
#include "Outline.h"
#include "WorkFolder.h"

#include <nlohmann/json.hpp>
#include <osgDB/ReadFile>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace geofx::bench
{

namespace
{

namespace fs = std::filesystem;

constexpr int WIDTH = 1089, HEIGHT = 690;
constexpr double FIELD_OF_VIEW = 40.0; // degrees

struct NamedView
{
    const char* name;
    const char* what;
    const char* place; ///< longitude, latitude, height, heading, pitch: degrees and metres
};

const NamedView ofFuji[] = {{"fuji-far", "Mount Fuji from 45 km", "138.73,34.946,11300,0,-15"},
                            {"fuji-near", "Mount Fuji from 16 km", "138.73,35.22,4000,0,-12"}};
const NamedView ofOahu[] = {
    {"oahu-far", "Oahu from the south", "-157.753,20.79,46000,0,-35"},
    {"oahu-near", "Honolulu and the Koolau from 4 km above the sea", "-157.90,21.16,4000,15,-9"},
    {"oahu-low", "over Honolulu towards the Koolau", "-157.875,21.275,350,45,-3"}};

void write(const fs::path& file, const std::string& text)
{
    std::ofstream out(file);
    out << text;
    if (!out.flush()) throw BenchError(file.string() + ": it cannot be written; is the disk full?");
}

/// A terrain as both engines have it.
struct Terrain
{
    fs::path database; ///< the kit's
    fs::path earth;    ///< osgEarth's file, or the kit's once more
    fs::path region;   ///< the kit's, without the rest of the Earth
    fs::path sea;      ///< the Earth without the region
};

/// By what pictures are smaller where no one measures them.
int shrink(const Settings& settings)
{
    return settings.smoke ? 8 : 1;
}

/// The builder with what all databases here have in common.
std::vector<std::string> build(const Settings& settings, const fs::path& output)
{
    const int height = HEIGHT / shrink(settings);
    const double pixels = osgGeoFX::pixelsPerRadian(height, osg::DegreesToRadians(FIELD_OF_VIEW));
    std::vector<std::string> command = {settings.builder.string(), "--quiet",  "--pixels-per-radian",
                                        std::to_string(pixels),    "--output", output.string()};
    if (settings.smoke) command.insert(command.end(), {"--tile-size", "32"});
    command.emplace_back("--dem");
    return command;
}

Terrain makeTerrain(const Settings& settings, const fs::path& dem, const fs::path& folder)
{
    fs::create_directories(folder);
    const auto global = [&](const std::string& name, const std::vector<std::string>& bands, const char* type)
    {
        fs::path file = folder / name;
        std::vector<std::string> command = {"gdal_create", "-q",      "-ot",    type,
                                            "-outsize",    "72",      "36",     "-a_srs",
                                            "EPSG:4326",   "-a_ullr", "-180",   "90",
                                            "180",         "-90",     "-bands", std::to_string(bands.size())};
        for (const std::string& band : bands)
            command.insert(command.end(), {"-burn", band});
        command.push_back(file.string());
        runChild(command);
        return file;
    };
    announce("coloring the picture that both drape");
    const fs::path sea = global("sea.tif", {"0"}, "Int16");
    const fs::path blue = global("blue.tif", {"40", "80", "120"}, "Byte");
    const fs::path relief = folder / "relief.tif";
    write(folder / "colors.txt",
          "0 40 80 120\n1 90 140 70\n500 140 160 90\n1500 150 120 90\n2500 140 110 100\n"
          "3800 250 250 250\nnv 40 80 120\n");
    runChild(
        {"gdaldem", "color-relief", "-q", dem.string(), (folder / "colors.txt").string(), relief.string()});

    Terrain terrain;
    announce("building the terrain");
    std::vector<std::string> whole = build(settings, folder / "whole");
    whole.insert(whole.end(), {sea.string(), dem.string(), "--imagery", blue.string(), relief.string()});
    runChild(whole);
    terrain.database = folder / "whole" / "terrain.osgb";
    std::vector<std::string> region = build(settings, folder / "region");
    region.push_back(dem.string());
    runChild(region);
    terrain.region = folder / "region" / "terrain.osgb";
    std::vector<std::string> rest = build(settings, folder / "sea");
    rest.push_back(sea.string());
    runChild(rest);
    terrain.sea = folder / "sea" / "terrain.osgb";

    terrain.earth = terrain.database;
    if (settings.osgEarth.empty()) return terrain;
    terrain.earth = folder / "terrain.earth";
    write(terrain.earth, "<map version=\"3\">\n <GDALImage name=\"blue\"><url>" + blue.string() +
                             "</url></GDALImage>\n <GDALImage name=\"relief\"><url>" + relief.string() +
                             "</url></GDALImage>\n <GDALElevation name=\"dem\"><url>" + dem.string() +
                             "</url></GDALElevation>\n</map>\n");
    return terrain;
}

/// One run of one engine, or several.
struct Run
{
    std::vector<double> frame, memory, complete;
    double triangles = 0.0;
    fs::path mask;
};

class Comparison
{
public:
    Comparison(const Settings& settings, fs::path folder) : _settings(settings), _folder(std::move(folder))
    {
        _drawer = settings.builder.parent_path() / "geofx_bench_draw";
        if (!fs::exists(_drawer))
            throw BenchError(_drawer.string() +
                             ": it is not there; build it, or name another osggeofx_build beside it with "
                             "--builder FILE.");
        if (settings.osgEarth.empty()) return;
        const std::string libraries = (settings.osgEarth / "lib").string();
        _environment = {"LD_LIBRARY_PATH=" + libraries, "OSG_LIBRARY_PATH=" + libraries};
    }

    /// The figures of a view.
    std::vector<Figure> measure(const NamedView& view, const Terrain& terrain, std::vector<double>& speeds)
    {
        Run ours, theirs;
        // Whatever slows the machine down meets both.
        const int rounds = _settings.smoke ? 1 : 2;
        for (int round = 0; round < rounds; ++round)
        {
            draw(view, terrain.database, ours, "ours");
            draw(view, terrain.earth, theirs, "theirs");
            if (_settings.smoke) continue;
            draw(view, terrain.earth, theirs, "theirs");
            draw(view, terrain.database, ours, "ours");
        }
        const fs::path truth = _folder / "truth.png";
        announce(std::string("drawing the full mesh of ") + view.name);
        run({"--single-mesh", terrain.region.string(), "--behind", terrain.sea.string(), "--frames", "0",
             "--mask", truth.string()},
            view);

        const std::string name = view.name;
        Figure speed{name + "-speed", std::string("frames a second over osgEarth's: ") + view.what, "",
                     Bound::AtLeast, 1.0};
        speed.measured = median(theirs.frame) / median(ours.frame);
        speeds.push_back(*speed.measured);
        char remark[200];
        std::snprintf(remark, sizeof remark, "%.1f and %.1f frames/s, %.0f and %.0f triangles",
                      1.0 / median(ours.frame), 1.0 / median(theirs.frame), ours.triangles, theirs.triangles);
        speed.remark = remark;
        speed.details = {{"ours", ours.frame}, {"theirs", theirs.frame}};
        Figure memory{name + "-memory", "resident memory over osgEarth's in that view", "", Bound::AtMost,
                      1.0 / 3.0};
        memory.measured = median(ours.memory) / median(theirs.memory);
        std::snprintf(remark, sizeof remark, "%.0f and %.0f MiB", median(ours.memory), median(theirs.memory));
        memory.remark = remark;
        Figure complete{name + "-complete", "time to the first complete picture over osgEarth's", ""};
        complete.measured = median(ours.complete) / median(theirs.complete);
        std::snprintf(remark, sizeof remark, "%.1f and %.1f s", median(ours.complete),
                      median(theirs.complete));
        complete.remark = remark;
        const OutlineDifference far = outline(theirs.mask, truth);
        Figure edge{name + "-outline",
                    "largest distance of the outline from the full mesh's; asked: osgEarth's", "pixels",
                    Bound::AtMost, static_cast<double>(far.distance)};
        edge.measured = outline(ours.mask, truth).distance;
        return {speed, memory, complete, edge};
    }

private:
    nlohmann::json run(std::vector<std::string> what, const NamedView& view)
    {
        const int size = shrink(_settings);
        std::vector<std::string> command = {_drawer.string(),
                                            "--view",
                                            view.place,
                                            "--size",
                                            std::to_string(WIDTH / size) + "x" +
                                                std::to_string(HEIGHT / size),
                                            "--fov",
                                            std::to_string(FIELD_OF_VIEW)};
        if (_settings.smoke) command.insert(command.end(), {"--still", "0.2"});
        command.insert(command.end(), what.begin(), what.end());
        const std::string& text = runChild(command, _environment).standardOutput;
        // Plug-ins may have said something before it.
        const std::size_t begin = text.rfind("\n{");
        return nlohmann::json::parse(begin == std::string::npos ? text : text.substr(begin));
    }

    void draw(const NamedView& view, const fs::path& file, Run& all, const std::string& whose)
    {
        announce(std::string("drawing ") + view.name + ", " + whose);
        all.mask = _folder / (whose + ".png");
        std::vector<std::string> what = {file.string(), "--mask", all.mask.string(), "--frames",
                                         _settings.smoke ? "2" : "40"};
        if (!_settings.pictures.empty())
            what.insert(
                what.end(),
                {"--image", (_settings.pictures / (std::string(view.name) + "-" + whose + ".png")).string()});
        const nlohmann::json told = run(what, view);
        all.frame.push_back(told.at("frame"));
        all.memory.push_back(told.at("memory"));
        all.complete.push_back(told.at("complete"));
        all.triangles = told.at("triangles");
    }

    static OutlineDifference outline(const fs::path& a, const fs::path& b)
    {
        const osg::ref_ptr<osg::Image> first = osgDB::readRefImageFile(a.string());
        const osg::ref_ptr<osg::Image> second = osgDB::readRefImageFile(b.string());
        if (!first || !second) throw BenchError(b.string() + ": what was drawn cannot be read.");
        return compareOutlines(*first, *second);
    }

    const Settings& _settings;
    const fs::path _folder;
    fs::path _drawer;
    std::vector<std::string> _environment;
};

std::vector<Figure> run(const Settings& settings)
{
    if (settings.osgEarth.empty() && !settings.smoke)
        throw BenchError("The suite osgearth needs osgEarth 3: name the folder where it is installed with "
                         "--osgearth DIR.");
    if (settings.builder.empty())
        throw BenchError(
            "The program osggeofx_build was not found beside osggeofx_bench; name it with --builder FILE.");
    const WorkFolder folder(settings.work);
    Comparison comparison(settings, folder.path());
    std::vector<Figure> figures;
    std::vector<double> speeds;
    const auto measure = [&](const NamedView& view, const Terrain& terrain)
    {
        for (const Figure& figure : comparison.measure(view, terrain, speeds))
            figures.push_back(figure);
    };
    if (settings.wants("fuji") && !settings.smoke)
    {
        if (settings.fuji.empty())
            throw BenchError("The views of Mount Fuji need an elevation raster of it: name one with --fuji "
                             "FILE, or leave them "
                             "out with --only oahu.");
        const Terrain terrain = makeTerrain(settings, settings.fuji, folder.path() / "fuji");
        for (const NamedView& view : ofFuji)
            measure(view, terrain);
    }
    if (settings.wants("oahu"))
    {
        const fs::path dem = folder.path() / "oahu.vrt";
        writeWindowOfOahu(settings.data / "oahu" / "elevation.tif", settings.smoke ? 128 : 1621, dem);
        const Terrain terrain = makeTerrain(settings, dem, folder.path() / "oahu");
        for (const NamedView& view : ofOahu)
            measure(view, terrain);
    }
    Figure all{"speed", "frames a second over osgEarth's, the median of all views", "", Bound::AtLeast, 1.3};
    all.measured = median(speeds);
    figures.push_back(all);
    return figures;
}

} // namespace

Suite osgEarthSuite()
{
    return {"osgearth",
            "Draws the same terrain by the kit's database and by osgEarth (--osgearth DIR), in turns: "
            "frames, memory, "
            "the first complete picture, outlines",
            {"fuji", "oahu"},
            run};
}

} // namespace geofx::bench
