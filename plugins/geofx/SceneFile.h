// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RoutePath.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/StrokeLines.h>
#include <osgGeoFX/raster/RasterBands.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/EffectPresets.h>

#include <osg/ref_ptr>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/// Where in a scene file something was said.
struct ScenePlace
{
    std::string file; ///< as the person named it
    int line = 0;     ///< 0: not known
    std::string element;

    /// `FILE:LINE: <element>: text`, without what is not known
    std::string message(const std::string& text) const;
};

/// A path in a scene, relative ones already joined to the folder of the scene file.
struct ScenePath
{
    std::string path;
    ScenePlace place;
    std::string attribute;
    std::string variable = {}; ///< of a raster; empty: the file decides

    /// As readers of rasters take it: "FILE" or "FILE:VARIABLE".
    std::string name() const { return variable.empty() ? path : path + ":" + variable; }
};

/// Red, green, blue, 0…1.
using SceneColor = std::array<double, 3>;

struct SceneRasters
{
    struct LandCover
    {
        ScenePath file;
        ScenePath table; ///< its path may be the name of a ready legend, which has neither point nor slash
    };

    ScenePlace place;
    std::vector<ScenePath> dems; ///< at least one
    std::vector<ScenePath> imagery;
    std::optional<LandCover> landCover;
    std::optional<ScenePath> treeCover;
    std::string cache; ///< empty: the person's cache folder
    int epsg = 0;      ///< 0: geocentric
    std::string vertical;
    std::string voids; ///< "fill" or "keep"
    int voidReach = 0, voidSmoothing = 0;
    int tileSize = 0, textureSize = 0;
    double pixelError = 0.0, texelError = 0.0; ///< pixels
    int memoryMiB = 0;
};

/// Degrees, and metres above the database's zero height.
struct SceneView
{
    double longitude = 0.0, latitude = 0.0, height = 0.0, heading = 0.0, pitch = 0.0, roll = 0.0;
    std::optional<double> verticalFieldOfView;
};

/// Degrees.
struct SceneSun
{
    ScenePlace place;
    double azimuth = 0.0, elevation = 0.0;
    SceneColor color{}, ambient{};
    std::optional<ClockTime> time; ///< the sun stands where it does then, not at azimuth and elevation
};

struct SceneBackground
{
    ScenePlace place;
    SceneColor color{};
    std::optional<double> visibility; ///< metres
    bool sky = false;
};

/// Degrees on a globe, else metres of the terrain's coordinate system.
struct SceneBox
{
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
};

/// A color table of a text file.
struct SceneTable
{
    osg::ref_ptr<ColorTable> table; ///< with its mode
    ScenePath file;
    std::optional<std::pair<double, double>> range; ///< what percentages in it are of
};

/// A mapping, and what of it is known when the terrain and the files are there.
struct SceneMapping
{
    /// Degrees.
    struct Point
    {
        double longitude = 0.0, latitude = 0.0;
    };
    /// A file with a georeference.
    struct Raster
    {
        ScenePath file;
        std::optional<DataLayer::Kind> kind; ///< nothing: the file decides
        int maxSide = 0;
        std::optional<RasterBands> bands = std::nullopt; ///< nothing: the file and its numbers decide
    };

    ScenePlace place;
    osg::ref_ptr<ProjectiveMapping> mapping;
    bool hasTransfer = false; ///< one of its own; without, the files decide
    // At most one of these; without, the mapping has its place already.
    std::optional<SceneBox> box;
    std::optional<Point> point;
    std::optional<Raster> raster;
};

/// The rasters of a KML file, any raster, or any vector data, as mappings of the effect.
struct SceneOverlay
{
    ScenePlace place;
    ScenePath file;
    std::string layer;              ///< of vector data; empty: all
    std::optional<ScenePath> style; ///< the same
    int maxSide = 0;
    double opacity = 1.0;
    int order = 0;
    std::optional<RasterBands> bands = std::nullopt; ///< of rasters; nothing: the file and its numbers decide
};

/// Rasters in time.
struct SceneSequence
{
    ScenePlace place;
    ScenePath file;
    osg::ref_ptr<ProjectiveMapping> mapping; ///< without its place and its layer
    bool hasTransfer = false;
    int maxSide = 0;
    bool blending = true;
    std::optional<double> speed;
};

/// A way over the ground, of a file or of way points.
struct SceneRoute
{
    ScenePlace place;
    std::optional<ScenePath> file;
    std::string layer; ///< empty: all
    RoutePath path;    ///< the way points; without a file
    RoutePath::Look look;
    std::optional<osg::Vec4> color;
    bool inAir = true; ///< whether one with heights is drawn there, too
};

/// An effect with mappings. The mappings are in the effect, with all that needs no file and no terrain.
struct SceneMappings
{
    struct Layer
    {
        osg::ref_ptr<DataLayer> layer; ///< without its picture
        ScenePath file;
    };
    ScenePlace place;
    osg::ref_ptr<ProjectiveMappings> effect;
    bool hasOrigin = false;
    std::vector<Layer> layers;
    std::vector<SceneTable> tables;
    std::vector<SceneMapping> mappings;   ///< as many as the effect has, in the same order
    std::vector<SceneSequence> sequences; ///< over these
    std::vector<SceneOverlay> overlays;   ///< over these
    std::vector<SceneRoute> routes;       ///< over all
};

/// A picture of surface data, or with DEM several.
struct SceneSurface
{
    enum Source
    {
        DEM,
        RASTER,
        VECTORS,
        DERIVED
    };
    Source source = DEM;
    ScenePlace place;
    std::string name;                            ///< not of DEM
    SurfaceData::Kind kind = SurfaceData::COLOR; ///< of RASTER and DERIVED
    ScenePath file;                              ///< not of DERIVED
    double width = 0.0;                          ///< of VECTORS, metres
    osg::Vec4 color;                             ///< of VECTORS
};

struct SceneSurfaceData
{
    ScenePlace place;
    std::optional<SceneBox> box; ///< without, all of the first surface, a DEM
    int maxSide = 0;             ///< texels
    double radius = 0.0;         ///< of what hides the sky, metres
    std::vector<SceneSurface> surfaces;
};

/// A close-up, and what of it is known when the terrain and the files are there.
struct SceneCloseUp
{
    ScenePlace place; ///< of its region
    osg::ref_ptr<CloseUp> closeUp;
    /// What the region's center is said in.
    enum Center
    {
        NOTHING,
        METRES,
        DEGREES
    };
    Center center = NOTHING;
    std::optional<ScenePath> image; ///< of its mask
};

/// An effect with close-ups. The close-ups are in the effect, with all that needs no file and no terrain.
struct SceneCloseUps
{
    ScenePlace place;
    osg::ref_ptr<CloseUps> effect;
    std::vector<SceneTable> tables;
    std::optional<SceneSurfaceData> surfaceData;
    std::vector<SceneCloseUp> closeUps; ///< as many as the effect has, in the same order
};

/// A panorama map, and the pictures and vector data that it has of its own.
struct ScenePanorama
{
    struct Lines
    {
        ScenePath file;
        std::string layer; ///< empty: all
        StrokeLines::Kind kind = StrokeLines::ROAD;
    };

    osg::ref_ptr<PanoramaMap> effect;
    std::optional<ScenePath> palette, skyImage;
    std::vector<Lines> lines;
};

/// The names and lines of a map.
struct SceneMap
{
    struct Vectors
    {
        ScenePath file;
        std::string layer; ///< empty: all
    };

    ScenePlace place;
    std::optional<ScenePath> style, fontFile;
    std::string font; ///< families; empty: the styles' own
    std::vector<Vectors> names, lines;
};

/// The terrain of the engine whose file the scene is a part of.
struct SceneEngine
{
    EffectScene::EngineCulling culling = EffectScene::PROXY;
};

/** What a .geofx file says; geofx.xsd.in and data/properties.md have the meaning, range and default of everything.

    All functions may be called from any thread. The effects belong to whoever has the value. */
struct SceneFile
{
    ScenePlace place;      ///< of <terrain>
    bool anywhere = false; ///< the program trusts the scene; no file says so
    // One of these three.
    std::optional<ScenePath> database;
    std::optional<SceneRasters> rasters;
    std::optional<SceneEngine> engine;
    EffectScene::GroundDescription ground; ///< what is stated of the database, or of the engine's ground

    std::optional<SceneView> homeView;
    std::optional<SceneSun> sun;
    std::optional<SceneBackground> background;
    ScenePlace homeViewPlace;
    std::vector<osg::ref_ptr<Effect>> effects; ///< in their order
    std::vector<SceneMappings> mappings;       ///< of the effects among them that have mappings
    std::vector<SceneCloseUps> closeUps;       ///< of the effects among them that have close-ups
    std::vector<ScenePanorama> panoramas;      ///< of the effects among them that are panorama maps
    std::vector<EffectPreset> presets;         ///< of these effects
    std::optional<SceneMap> map;
};

/// A scene, or else at least one sentence of the form `FILE:LINE: <element>: what was expected`.
struct SceneResult
{
    std::optional<SceneFile> scene;
    std::vector<std::string> errors;
};

/// A text longer than this (bytes) is no scene.
constexpr std::size_t largestScene = 16 * 1024 * 1024;

/// Reads the text of a scene. `file` is for messages; relative paths start at `folder`. No file is opened.
SceneResult parseScene(const std::string& text, const std::string& file, const std::string& folder);

/// An element or attribute of XML as an engine hands it over, which may have lost the case of names, and which of the two it was.
struct SceneElement
{
    std::string name;
    std::string value; ///< of an attribute; the text of an element
    std::vector<SceneElement> children;
};

/// Reads the scene that is a part of an engine's file, such as an .earth file: the element <geofx>. Its terrain is the engine's.
/// Messages have the lines of the first <geofx> in `text`, which may be empty where the engine's file cannot be had.
SceneResult parseEngineScene(const SceneElement& scene, const std::string& text, const std::string& file,
                             const std::string& folder);

/// All files that the scene names, in its order; not the names of ready legends, nor the cache.
std::vector<ScenePath> filesOf(const SceneFile& scene);

/// One sentence for each file that the scene names and that is not there.
std::vector<std::string> missingFiles(const SceneFile& scene);

} // namespace osgGeoFX
