// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/offscreen/SceneRenderer.h>

#include <nlohmann/json.hpp>
#include <osg/Image>
#include <osgDB/ReaderWriter>

#include <string>

/// Why a file cannot be written there, as a sentence; empty if it probably can.
std::string faultOfOutput(const std::string& name);

/// The picture files of osggeofx_render: one name, or a pattern such as f%04d.png for many.
class PictureFiles
{
public:
    PictureFiles(const std::string& name, bool many);

    /// Writes a whole file or none. Several processes may write the same one at once.
    bool write(const osg::Image& image, unsigned int frame);

    /// What is wrong with the name or with the last write, as a sentence; empty if nothing is.
    const std::string& error() const { return _error; }

    /// The file of a picture.
    std::string nameOf(unsigned int frame) const;

private:
    const std::string _name;
    const bool _many;
    std::string _before;
    std::size_t _digits = 1;
    std::string _after;
    osg::ref_ptr<osgDB::ReaderWriter> _writer;
    std::string _error;
};

/// The JSON file of --stats.
class StatisticsFile
{
public:
    StatisticsFile(const osgGeoFX::SceneRenderer& renderer, const osgGeoFX::SceneRenderer::Options& options);

    void add(const osgGeoFX::FrameStatistics& frame);
    bool write(const std::string& file);

private:
    bool _least; ///< whether the least number of triangles is known
    nlohmann::ordered_json _json;
};
