// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "web/ScenePage.h"

#include <osgGeoFX/print/PlacePicture.h>
#include <osgGeoFX/raster/PictureFile.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/web/WebPage.h>

#include <CLI/CLI.hpp>
#include <osg/Group>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace fs = std::filesystem;

namespace geofx::web
{

namespace
{

using osgGeoFX::SceneRenderer;

/// Pixels of the reduced picture.
constexpr double mostPixels = 1.2e6;

class Fault : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// A smaller size with the same shape, as nearly as whole pixels allow.
void reduce(int& width, int& height)
{
    const double all = static_cast<double>(width) * height, aspect = static_cast<double>(width) / height;
    if (all <= mostPixels) return;
    const int most = static_cast<int>(height * std::sqrt(mostPixels / all));
    double least = HUGE_VAL;
    for (int rows = std::max(most, 1); rows > most - std::max(most / 10, 1); --rows)
    {
        const int columns = std::max(1, static_cast<int>(std::lround(rows * aspect)));
        const double off = std::abs(columns - rows * aspect) / columns;
        if (off >= least - 1e-12) continue;
        least = off;
        width = columns;
        height = rows;
    }
}

} // namespace

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--web", options.folder,
                   "Also write a folder that any browser shows, from a web server or by a double click: the "
                   "picture to zoom, names to search, the place under the pointer. A former page is replaced")
        ->type_name("DIR");
    app.add_option("--title", options.title, "The web page's title (the picture's name)")->type_name("TEXT");
    app.add_option("--attribution", options.attribution,
                   "A line for the web page's foot, such as whose data it shows")
        ->type_name("TEXT");
}

void claimOutputs(const Options& options, osgGeoFX::InputFiles& inputs)
{
    if (options.wanted()) inputs.claimFolder("The web page", options.folder, "--web");
}

ScenePage::ScenePage(const Options& options, const std::string& picture) : _options(options)
{
    const std::string fault = osgGeoFX::WebPage::faultOf(options.folder);
    if (!fault.empty()) throw Fault("--web: " + fault);
    const fs::path file(picture);
    if (_options.title.empty()) _options.title = file.stem().string();
    // A name that no file has.
    _plain = (file.parent_path() / (file.stem().string() + ".XXXXXX.tif")).string();
    const int made = mkstemps(_plain.data(), 4);
    if (made < 0)
        throw Fault("No file can be made beside \"" + picture + "\"; check the folder and its permissions.");
    close(made);
}

ScenePage::~ScenePage()
{
    std::error_code ignored;
    fs::remove(_plain, ignored);
}

void ScenePage::setPicture(const osg::Image& image) const
{
    const int channels = image.getPixelFormat() == GL_RGB ? 3 : image.getPixelFormat() == GL_RGBA ? 4 : 0;
    if (!channels || image.getDataType() != GL_UNSIGNED_BYTE)
        throw Fault("--web: pictures of this kind of pixels cannot be shown on a page.");
    osgGeoFX::PictureHeader header;
    header.width = image.s();
    header.height = image.t();
    header.channels = {"R", "G", "B"};
    if (channels == 4) header.channels.emplace_back("A");
    header.set("compression", "zip");
    header.set("tiff:zipquality", 1);
    const auto output = osgGeoFX::PictureWriter::create(_plain);
    bool good = output && output->open(_plain, header);
    for (int row = 0; good && row < image.t(); ++row)
        good = output->write(image.data(0, static_cast<unsigned int>(image.t() - 1 - row)),
                             osgGeoFX::PictureNumber::BYTE);
    if (!good || !output->close())
        throw Fault("\"" + _plain +
                    "\" cannot be written; check the folder, its permissions and the disk's space.");
}

void ScenePage::write(osgGeoFX::Scene& scene, const SceneRenderer::Options& renderer,
                      const osg::Matrixd& view, osgGeoFX::NameSet* names) const
{
    osgGeoFX::Scene both = scene;
    const osg::ref_ptr<osgGeoFX::DepthReader> reader = both.readDepths();
    SceneRenderer::Options reduced = renderer;
    reduced.samples = 0;
    reduced.countTriangles = reduced.leastTriangles = false;
    reduce(reduced.width, reduced.height);
    std::string error;
    const auto drawing = SceneRenderer::create(both, reduced, error);
    if (!drawing) throw Fault(error);
    osgGeoFX::FrameStatistics unused;
    // Strokes stand above the ground that they show.
    const osgGeoFX::WithoutStrokes bare(*scene.effects);
    if (!drawing->render(view, 0.0, unused, error)) throw Fault(error);

    osgGeoFX::WebPage::Options page;
    page.picture = _plain;
    page.title = _options.title;
    page.attribution = _options.attribution;
    if (names)
    {
        osgGeoFX::WebNames layout;
        layout.width = renderer.width;
        layout.height = renderer.height;
        layout.view = view;
        const double aspect = static_cast<double>(renderer.width) / renderer.height;
        layout.projection = osg::Matrixd::perspective(renderer.fieldOfView, aspect, 1.0, 1e6);
        layout.depths = reader->pictures();
        layout.reference = scene.reference.get();
        page.names = layout.layOut(*names, *scene.effects);
    }
    std::optional<osgGeoFX::PlacePicture> places;
    if (scene.reference)
    {
        places.emplace(*scene.effects, drawing->camera(), reader->pictures(), *scene.reference);
        page.places.width = places->width();
        page.places.height = places->height();
        page.places.at = [&](int x, int y) -> std::optional<osgGeoFX::WebPlaces::Place>
        {
            const auto place = places->at(x, y);
            if (!place) return std::nullopt;
            return osgGeoFX::WebPlaces::Place{place->longitude, place->latitude, place->height};
        };
    }
    if (!osgGeoFX::WebPage::write(page, _options.folder, error)) throw Fault("--web: " + error);
}

} // namespace geofx::web
