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
    constexpr int largest = osgGeoFX::PictureVectors::largestPdfSide;
    if (isPdf(output) && std::max(size.width, size.height) > largest)
        throw std::runtime_error("\"" + output + "\": pages of a PDF have up to " + std::to_string(largest) +
                                 " pixels on a side, and this one would have " + std::to_string(size.width) +
                                 " x " + std::to_string(size.height) +
                                 "; take fewer for each inch, or write a TIFF.");
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

void PictureMap::claimOutput(const std::string& output, osgGeoFX::InputFiles& inputs)
{
    inputs.claim("The picture", output, "-o");
    if (isPdf(output)) inputs.claim("The picture", rasterOf(output), "-o");
}

void PictureMap::prepare()
{
    if (_reader || !(_names || wantsLineVectors())) return;
    _reader = _scene.readDepths();
}

void PictureMap::takeLines(const osg::Camera& camera, const osgGeoFX::DepthReader& reader, double scale)
{
    _placedLines.emplace(_map.lines, _map.styles.lines, *_scene.effects, camera, reader.pictures(), scale);
}

/// Lines of a print, by the depths of a smaller picture.
void PictureMap::takeLines(const osgGeoFX::SceneRenderer::Options& options, const osg::Matrixd& view)
{
    osgGeoFX::SceneRenderer::Options small = options;
    const double factor =
        std::max(static_cast<double>(std::max(_size.width, _size.height)) / depthsSide, 1.0);
    small.width = static_cast<int>(std::lround(_size.width / factor));
    small.height = static_cast<int>(std::lround(_size.height / factor));
    small.samples = 0;
    // Tiles of the print need not be read.
    osgGeoFX::Scene scene = _scene;
    const osg::ref_ptr<osgGeoFX::DepthReader> reader = scene.readDepths();
    std::string error;
    const auto renderer = osgGeoFX::SceneRenderer::create(scene, small, error);
    osgGeoFX::FrameStatistics unused;
    if (!renderer || !renderer->render(view, 0.0, unused, error)) throw std::runtime_error(error);
    const double larger = static_cast<double>(_size.height) / small.height;
    takeLines(renderer->camera(), *reader, small.height / usualHeight);
    _placedLines = _placedLines->enlarged(larger);
}

void PictureMap::draw(const osg::Camera& camera, osg::Image& image,
                      const std::function<void(const osg::Image& plain)>& beforeNames)
{
    if (_names) _placedNames.emplace(*_names, *_scene.effects, camera, _reader->pictures());
    if (wantsLineVectors()) takeLines(camera, *_reader, _size.height / usualHeight);
    if (drawsLines() && onPicture()) _placedLines->drawOnto(image);
    if (beforeNames && drawsLines() && !onPicture())
    {
        const osg::ref_ptr<osg::Image> plain = new osg::Image(image, osg::CopyOp::DEEP_COPY_ALL);
        _placedLines->drawOnto(*plain);
        beforeNames(*plain);
    }
    else if (beforeNames)
    {
        beforeNames(image);
    }
    if (_placedNames && onPicture()) _placedNames->drawOnto(image);
}

void PictureMap::prepare(osgGeoFX::PicturePrint::Options& options, const osg::Matrixd& view)
{
    if (wantsLineVectors()) takeLines(options.renderer, view);
    options.names = _names;
    options.drawOver = onPicture();
    options.placed = [this](const osgGeoFX::LabelPicture& placed)
    {
        _placedNames = placed;
    };
    if (drawsLines())
        options.overlay = [this](osg::Image& rows, int top)
        {
            _placedLines->drawOnto(rows, top);
        };
}

void PictureMap::writeFiles()
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
    if (!written)
        throw std::runtime_error(error + " The picture without names and lines is " + rasterOf(_output) +
                                 ".");
    std::error_code ignored;
    fs::remove(rasterOf(_output), ignored);
}

} // namespace geofx::names
