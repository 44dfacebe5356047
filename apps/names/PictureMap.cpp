// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/PictureMap.h"

#include <osgGeoFX/print/PictureVectors.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace fs = std::filesystem;

namespace geofx::names
{

namespace
{

/// The longer side of the picture that tells what hides a print's lines, pixels.
constexpr int depthsSide = 4096;
constexpr double usualDpi = 150.0;

} // namespace

PictureMap::PictureMap(const Options& options, const std::string& output, const osgGeoFX::PrintSize& size,
                       osgGeoFX::Scene& scene, bool layered)
    : _options(options), _output(output), _size(size), _scene(scene), _layered(layered)
{
    _map = takeMap(options, scene, _notices);
    _names = _map.makeNames();
    if (_names) _names->setScale(size.height / usualHeight);
    if (onPicture() && !layered) _map.addLinesTo(*scene.effects, size.height / usualHeight);
}

bool PictureMap::isPdf(const std::string& output)
{
    std::string extension = fs::path(output).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return extension == ".pdf";
}

std::string PictureMap::rasterOf(const std::string& output)
{
    return isPdf(output) ? fs::path(output).replace_extension(".unfinished.jpg").string() : output;
}

void PictureMap::readDepths()
{
    if (_reader || !(_names || wantsLineVectors())) return;
    _reader = _scene.readDepths();
}

void PictureMap::takeLines(const osg::Camera& camera, double scale)
{
    _placedLines.emplace(_map.lines, _map.styles.lines, *_scene.effects, camera, _reader->pictures(), scale);
}

void PictureMap::finish(const osg::Camera& camera, osg::Image& image,
                        const std::function<void()>& beforeNames)
{
    if (_names) _placedNames.emplace(*_names, *_scene.effects, camera, _reader->pictures());
    if (wantsLineVectors()) takeLines(camera, _size.height / usualHeight);
    if (linesAbove() && onPicture()) linesAbove()->drawOnto(image);
    if (beforeNames) beforeNames();
    if (_placedNames && onPicture()) _placedNames->drawOnto(image);
    write();
}

void PictureMap::prepare(osgGeoFX::PicturePrint::Options& options)
{
    if (!_map.lines.empty() && _layered)
        throw std::runtime_error(
            "--layers: lines are a layer of pictures of up to 4096 pixels without a resolution only; take "
            "such a --size, or leave --lines out.");
    options.names = _names;
    options.drawNames = onPicture();
    options.placed = [this](const osgGeoFX::LabelPicture& placed)
    {
        _placedNames = placed;
    };
}

void PictureMap::finish(const osgGeoFX::PicturePrint::Options& options, const osg::Matrixd& view)
{
    if (wantsLineVectors())
    {
        readDepths();
        osgGeoFX::SceneRenderer::Options small = options.renderer;
        const double factor =
            std::max(static_cast<double>(std::max(_size.width, _size.height)) / depthsSide, 1.0);
        small.width = static_cast<int>(std::lround(_size.width / factor));
        small.height = static_cast<int>(std::lround(_size.height / factor));
        small.samples = 0;
        std::string error;
        const auto renderer = osgGeoFX::SceneRenderer::create(_scene, small, error);
        osgGeoFX::FrameStatistics unused;
        if (!renderer || !renderer->render(view, 0.0, unused, error)) throw std::runtime_error(error);
        const double larger = static_cast<double>(_size.height) / small.height;
        takeLines(renderer->camera(), small.height / usualHeight);
        _placedLines = _placedLines->enlarged(larger);
    }
    write();
}

void PictureMap::write()
{
    osgGeoFX::PictureVectors vectors;
    vectors.width = _size.width;
    vectors.height = _size.height;
    vectors.names = _placedNames ? &*_placedNames : nullptr;
    vectors.lines = _placedLines ? &*_placedLines : nullptr;
    std::string error;
    if (!_options.svg.empty())
    {
        const fs::path folder = fs::absolute(_options.svg).parent_path();
        const std::string picture = fs::absolute(rasterOf(_output)).lexically_relative(folder).string();
        if (!vectors.writeSvg(_options.svg, isPdf(_output) ? std::string() : picture, error))
            throw std::runtime_error(error);
    }
    if (!_options.geoJson.empty() && !vectors.writeGeoJson(_options.geoJson, error))
        throw std::runtime_error(error);
    if (!isPdf(_output)) return;
    const bool written = vectors.writePdf(_output, rasterOf(_output), _size.dpi > 0.0 ? _size.dpi : usualDpi,
                                          fs::path(_output).stem().string(), error);
    std::error_code ignored;
    fs::remove(rasterOf(_output), ignored);
    if (!written) throw std::runtime_error(error);
}

} // namespace geofx::names
