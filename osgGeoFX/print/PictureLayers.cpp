// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/PictureLayers.h>

#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/print/PlacePicture.h>
#include <osgGeoFX/print/detail/LayerColors.h>
#include <osgGeoFX/print/detail/LayerDrawing.h>
#include <osgGeoFX/print/detail/LayerFile.h>
#include <osgGeoFX/print/detail/LayerList.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <system_error>

#include <unistd.h>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

using layers::Color;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// The rows of a layer that are being made, and its file.
template<class Value>
class Rows
{
public:
    Rows(const fs::path& folder, const LayerList::Layer& layer, const TilePlan& plan, double dpi)
        : _width(static_cast<std::size_t>(plan.width)), _channels(layer.channels.size()),
          _values(_width * static_cast<std::size_t>(plan.tileHeight) * _channels),
          _file(folder / layer.file, {plan.width, plan.height, layer.channels, numberOf(Value()), dpi})
    {
    }
    Value* at(int x, int row)
    {
        return &_values[(static_cast<std::size_t>(row) * _width + static_cast<std::size_t>(x)) * _channels];
    }
    void write(int rows)
    {
        _file.write(rows, _values.data());
        std::fill(_values.begin(), _values.end(), Value());
    }
    void finish() { _file.finish(); }

private:
    static PictureNumber numberOf(unsigned char) { return PictureNumber::BYTE; }
    static PictureNumber numberOf(float) { return PictureNumber::FLOAT; }
    static PictureNumber numberOf(double) { return PictureNumber::DOUBLE; }

    std::size_t _width, _channels;
    std::vector<Value> _values;
    LayerFile _file;
};

template<class Value>
using RowsOf = std::unique_ptr<Rows<Value>>;

/// A row of tiles of the colors, but for overlays.
struct ColorStrip
{
    RowsOf<unsigned char> sky, terrain, forest, water, strokes;
    RowsOf<float> shade;

    template<class Action>
    void each(const Action& action)
    {
        for (const RowsOf<unsigned char>* layer : {&sky, &terrain, &forest, &water, &strokes})
            if (*layer) action(**layer);
        action(*shade);
    }
};

/// The same of the values.
struct ValueStrip
{
    RowsOf<unsigned char> classes;
    RowsOf<float> distance, height;
    RowsOf<double> places;

    template<class Action>
    void each(const Action& action)
    {
        for (const RowsOf<float>* layer : {&distance, &height})
            if (*layer) action(**layer);
        if (classes) action(*classes);
        if (places) action(*places);
    }
};

const unsigned char* pixelOf(const osg::ref_ptr<osg::Image>& image, int x, int row)
{
    return image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(image->t() - 1 - row));
}

float lessOf(const unsigned char* a, const unsigned char* b, int channel)
{
    return static_cast<float>(std::max(a[channel] - b[channel], 0)) / 255.0f;
}

/// The colors of a pixel's layers.
void putColors(ColorStrip& strip, const LayerDrawing::Kinds& kinds, const LayerDrawing::Colors& parts,
               const PlacePicture& places, const PictureTile& tile, int x, int row)
{
    const int column = tile.left + x;
    const auto color = [&](const osg::ref_ptr<osg::Image>& image)
    {
        return layers::colorOf(pixelOf(image, x, row));
    };
    std::copy_n(pixelOf(parts.sky, x, row), 3, strip.sky->at(column, row));
    Color made = color(parts.sky);
    float ground = 0.0f, forest = 0.0f, water = 0.0f;
    if (parts.shares)
    {
        const unsigned char *shares = pixelOf(parts.shares, x, row), *black = pixelOf(parts.black, x, row);
        water = lessOf(shares, black, 0);
        forest = lessOf(shares, black, 1);
        ground = lessOf(shares, black, 2);
    }
    else
    {
        ground = places.distanceAt(column, tile.top + row) ? 1.0f : 0.0f;
    }
    layers::putGround(made, color(parts.land), color(parts.flat), ground, strip.terrain->at(column, row),
                      strip.shade->at(column, row));
    if (strip.forest) layers::putLayer(made, color(parts.woods), forest, strip.forest->at(column, row));
    if (strip.water) layers::putLayer(made, color(parts.whole), water, strip.water->at(column, row));
    if (!kinds.strokes) return;
    const unsigned char *white = pixelOf(parts.strokesWhite, x, row),
                        *black = pixelOf(parts.strokesBlack, x, row);
    float covered = 0.0f;
    // The ground behind a stroke shows as much as it differs from white to black; where there is sky, only the colors tell.
    if (ground > 0.99f) covered = 1.0f - lessOf(white, black, 1);
    layers::putLayer(made, color(parts.all), covered, strip.strokes->at(column, row));
}

void putValues(ValueStrip& strip, const osg::ref_ptr<osg::Image>& classes, const PlacePicture& places,
               const PictureTile& tile, int x, int row)
{
    const int column = tile.left + x, line = tile.top + row;
    const std::optional<double> distance = places.distanceAt(column, line);
    *strip.distance->at(column, row) = distance ? static_cast<float>(*distance) : none;
    if (strip.classes && distance) *strip.classes->at(column, row) = *pixelOf(classes, x, row);
    if (!strip.places) return;
    const std::optional<PlacePicture::Place> place = places.at(column, line);
    *strip.height->at(column, row) = place ? static_cast<float>(place->height) : none;
    double* const lonLat = strip.places->at(column, row);
    lonLat[0] = place ? place->longitude : static_cast<double>(none);
    lonLat[1] = place ? place->latitude : static_cast<double>(none);
}

/// Writes what is drawn over the picture: its color and opacity follow from what it makes of black and of white.
void writeOverlay(const fs::path& folder, const LayerList::Layer& layer, const TilePlan& plan, double dpi,
                  const std::function<void(osg::Image&, int)>& draw)
{
    Rows<unsigned char> rows(folder, layer, plan, dpi);
    for (int row = 0; row < plan.rows; ++row)
    {
        const PictureTile tile = plan.at(0, row);
        osg::ref_ptr<osg::Image> on[2];
        for (int i = 0; i < 2; ++i)
        {
            on[i] = new osg::Image;
            on[i]->allocateImage(plan.width, tile.height, 1, GL_RGB, GL_UNSIGNED_BYTE);
            std::fill_n(on[i]->data(), on[i]->getTotalSizeInBytes(),
                        static_cast<unsigned char>(i == 0 ? 0 : 255));
            draw(*on[i], tile.top);
        }
        for (int y = 0; y < tile.height; ++y)
        {
            for (int x = 0; x < plan.width; ++x)
            {
                const unsigned char *black = pixelOf(on[0], x, y), *white = pixelOf(on[1], x, y);
                const int clear = std::min({white[0] - black[0], white[1] - black[1], white[2] - black[2]});
                unsigned char* const pixel = rows.at(x, y);
                pixel[3] = static_cast<unsigned char>(std::clamp(255 - clear, 0, 255));
                for (int i = 0; i < 3 && pixel[3] > 0; ++i)
                    pixel[i] = layers::byteOf(static_cast<float>(black[i]) / static_cast<float>(pixel[3]));
            }
        }
        rows.write(tile.height);
    }
    rows.finish();
}

/// The names of a picture that is drawn in tiles.
class TiledNames
{
public:
    TiledNames(const osg::ref_ptr<NameSet>& names, const TilePlan& plan) : _names(names), _plan(plan) {}

    void look(EffectScene& scene, const osg::Camera& camera,
              const std::vector<std::shared_ptr<const DepthPicture>>& depths)
    {
        if (_seen.empty())
            _seen = _names->inPicture(scene, camera.getViewMatrix(), camera.getProjectionMatrix(),
                                      _plan.width, _plan.height, LabelPicture::usualMost);
        for (const NameSet::Seen& name : _seen)
            _shown[name.name] += NameSet::placesShown(name, depths);
    }
    LabelPicture place()
    {
        std::vector<bool> visible;
        for (const NameSet::Seen& name : _seen)
            visible.push_back(NameSet::isShown(name, _shown[name.name]));
        return {*_names, _seen, visible, static_cast<double>(_plan.width), static_cast<double>(_plan.height)};
    }

private:
    osg::ref_ptr<NameSet> _names;
    const TilePlan& _plan;
    std::vector<NameSet::Seen> _seen;
    std::map<std::size_t, std::size_t> _shown;
};

/// What opens the layers that a list has.
struct Opening
{
    const LayerList& list;
    const fs::path& folder;
    const TilePlan& plan;
    double dpi;

    template<class Value>
    void operator()(const char* name, RowsOf<Value>& rows) const
    {
        if (const LayerList::Layer* const layer = list.find(name))
            rows = std::make_unique<Rows<Value>>(folder, *layer, plan, dpi);
    }
};

void writeColors(const Scene& scene, const PictureLayers::Options& options, const osg::Matrixd& view,
                 LayerDrawing& drawing, const Opening& open, TiledNames& names,
                 const std::function<void()>& drawn)
{
    const TilePlan& plan = open.plan;
    ColorStrip strip;
    open("sky", strip.sky);
    open("terrain", strip.terrain);
    open("shade", strip.shade);
    open("forest", strip.forest);
    open("water", strip.water);
    open("strokes", strip.strokes);
    for (int row = 0; row < plan.rows; ++row)
    {
        for (int column = 0; column < plan.columns; ++column)
        {
            const PictureTile tile = plan.at(column, row);
            const LayerDrawing::Colors parts = drawing.colors(tile, view, drawn);
            const PlacePicture places(*scene.effects, drawing.camera(), parts.depths);
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; ++x)
                    putColors(strip, drawing.kinds(), parts, places, tile, x, y);
            if (options.names) names.look(*scene.effects, drawing.camera(), parts.depths);
        }
        strip.each([&](auto& rows) { rows.write(plan.at(0, row).height); });
    }
    strip.each([](auto& rows) { rows.finish(); });
}

void writeValues(const Scene& scene, const osg::Matrixd& view, LayerDrawing& drawing, const Opening& open,
                 const std::function<void()>& drawn)
{
    const TilePlan& plan = open.plan;
    ValueStrip strip;
    open("classes", strip.classes);
    open("distance", strip.distance);
    open("height", strip.height);
    open("lonlat", strip.places);
    for (int row = 0; row < plan.rows; ++row)
    {
        for (int column = 0; column < plan.columns; ++column)
        {
            const PictureTile tile = plan.at(column, row);
            std::vector<std::shared_ptr<const DepthPicture>> depths;
            const osg::ref_ptr<osg::Image> classes = drawing.ground(tile, view, depths);
            drawn();
            const PlacePicture places =
                scene.reference ? PlacePicture(*scene.effects, drawing.camera(), depths, *scene.reference)
                                : PlacePicture(*scene.effects, drawing.camera(), depths);
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; ++x)
                    putValues(strip, classes, places, tile, x, y);
        }
        strip.each([&](auto& rows) { rows.write(plan.at(0, row).height); });
    }
    strip.each([](auto& rows) { rows.finish(); });
}

void writeLayers(const Scene& scene, const PictureLayers::Options& options, const osg::Matrixd& view,
                 const fs::path& folder)
{
    const TilePlan plan(options.size.width, options.size.height, options.tile);
    auto drawing = std::make_unique<LayerDrawing>(scene, options.renderer, plan);
    const LayerDrawing::Kinds kinds = drawing->kinds();
    LayerList list(kinds.painted, kinds.water, kinds.strokes,
                   scene.reference ? std::string() : scene.referenceError);
    const Opening open{list, folder, plan, options.size.dpi};
    int done = 0;
    const int all = plan.columns * plan.rows * (kinds.count() + 1);
    const auto drawn = [&]
    {
        if (options.progress) options.progress(++done, all);
    };
    TiledNames names(options.names, plan);
    writeColors(scene, options, view, *drawing, open, names, drawn);
    // Numbers have no mean: values are those of the pixels' middles.
    if (options.renderer.samples > 1)
    {
        drawing.reset();
        SceneRenderer::Options single = options.renderer;
        single.samples = 0;
        drawing = std::make_unique<LayerDrawing>(scene, single, plan);
    }
    writeValues(scene, view, *drawing, open, drawn);
    std::vector<PictureLayers::Overlay> overlays = options.overlays;
    std::optional<LabelPicture> labels;
    if (options.names)
    {
        labels.emplace(names.place());
        const auto above = std::find_if(overlays.begin(), overlays.end(),
                                        [](const PictureLayers::Overlay& each) { return !each.belowNames; });
        overlays.insert(above, {"labels", "The names.",
                                [&](osg::Image& rows, int top)
                                {
                                    labels->drawOnto(rows, top);
                                }});
    }
    else
    {
        list.leaveOut("labels", "The picture has no names.");
    }
    for (const PictureLayers::Overlay& overlay : overlays)
        writeOverlay(folder, list.addOverlay(overlay.name, overlay.meaning), plan, options.size.dpi,
                     overlay.draw);
    list.write(folder, plan.width, plan.height);
}

} // namespace

bool PictureLayers::prepare(const std::string& folder, std::string& error)
{
    std::error_code fault;
    if (fs::exists(folder, fault) && !fs::is_directory(folder, fault))
    {
        error = "\"" + folder + "\" is a file; name a folder for the layers.";
        return false;
    }
    if (!fs::exists(folder, fault)) fs::create_directory(folder, fault);
    if (!fs::is_directory(folder, fault) || access(folder.c_str(), W_OK) != 0)
    {
        error =
            "The folder \"" + folder + "\" cannot be made or written to; make it first, or name another one.";
        return false;
    }
    return true;
}

std::vector<std::string> PictureLayers::fileNames()
{
    std::vector<std::string> names = {"labels.png", "layers.json"};
    const LayerList all(true, true, true, {});
    for (const LayerList::Layer& layer : all.layers())
        names.push_back(layer.file);
    return names;
}

bool PictureLayers::write(const Scene& scene, const Options& options, const osg::Matrixd& view,
                          const std::string& folder, std::string& error)
{
    if (!prepare(folder, error)) return false;
    try
    {
        writeLayers(scene, options, view, folder);
        return true;
    }
    catch (const std::runtime_error& fault)
    {
        error = fault.what();
        return false;
    }
}

} // namespace osgGeoFX
