// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "names/SceneNames.h"

#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/lines/LinePicture.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <osgGeoFX/scene/DepthReader.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace geofx::names
{

/** The names and lines of a program's pictures, of its options and of its scene: on the picture itself, or as vectors in files beside it, as the options say.

    Make it before the pictures' renderer, since it adds to the scene. All of it throws std::runtime_error with a sentence. */
class PictureMap
{
public:
    /// `output`: the file of the picture. `size`: its size; names and lines grow with it. `layered`: whether lines are to be a layer of their own,
    /// over what the scene draws.
    PictureMap(const Options& options, const std::string& output, const osgGeoFX::PrintSize& size,
               osgGeoFX::Scene& scene, bool layered = false);

    /// Null if there are none.
    const osg::ref_ptr<osgGeoFX::NameSet>& names() const { return _names; }
    /// The lines that are a layer over the picture, once it is finished; null if there are none.
    const osgGeoFX::LinePicture* linesAbove() const
    {
        return _layered && _placedLines ? &*_placedLines : nullptr;
    }

    /// A text that differs where other names, lines or styles do.
    std::string digest() const { return _map.digest(); }

    /// What people should know of names and lines, as sentences.
    const std::vector<std::string>& notices() const { return _notices; }

    /// Whether a file is a PDF, which is made of a JPEG and vectors.
    static bool isPdf(const std::string& output);
    /// Where the picture itself is to be written for an output: there, or for a PDF beside it.
    static std::string rasterOf(const std::string& output);

    /// Claims the files of an output, unless it is that of many pictures. Throws WorkError.
    static void claimOutput(const std::string& output, osgGeoFX::InputFiles& inputs);

    /// For pictures of a renderer: call it before the renderer is made.
    void prepare();
    /// For a picture that a renderer has just drawn: draws on it. `camera`: SceneRenderer::camera().
    /// `beforeNames`: called with the picture as it is with its lines and without names, even where both become vectors.
    void draw(const osg::Camera& camera, osg::Image& image,
              const std::function<void(const osg::Image& plain)>& beforeNames = {});

    /// For a print: sets what it does with names and lines. `view`: the print's.
    void prepare(osgGeoFX::PicturePrint::Options& options, const osg::Matrixd& view);
    /// Writes the files for names and lines, once the picture or the print is written: what fails here takes nothing from it.
    void writeFiles();

private:
    bool onPicture() const { return _options.svg.empty() && !isPdf(_output); }
    bool wantsLineVectors() const
    {
        return !_map.lines.empty() && (_layered || !onPicture() || !_options.geoJson.empty());
    }
    void takeLines(const osg::Camera& camera, const osgGeoFX::DepthReader& reader, double scale);
    void takeLines(const osgGeoFX::SceneRenderer::Options& options, const osg::Matrixd& view);
    /// Whether lines are drawn over what the scene has drawn.
    bool drawsLines() const { return _placedLines && (_layered || !onPicture()); }

    const Options _options;
    const std::string _output;
    const osgGeoFX::PrintSize _size;
    osgGeoFX::Scene& _scene;
    const bool _layered;
    std::vector<std::string> _notices;
    osg::ref_ptr<osgGeoFX::NameSet> _names;
    osgGeoFX::MapContents _map;
    osg::ref_ptr<osgGeoFX::DepthReader> _reader;
    std::optional<osgGeoFX::LabelPicture> _placedNames;
    std::optional<osgGeoFX::LinePicture> _placedLines;
};

} // namespace geofx::names
