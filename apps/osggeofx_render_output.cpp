// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "osggeofx_render_output.h"

#include <osgGeoFX/batch/WholeFile.h>

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace
{

fs::path folderOf(const std::string& name)
{
    const fs::path folder = fs::path(name).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

} // namespace

std::string faultOfOutput(const std::string& name)
{
    std::error_code ignored;
    if (!fs::is_directory(folderOf(name), ignored) || access(folderOf(name).c_str(), W_OK) != 0)
    {
        return "\"" + name +
               "\" cannot be written, as its folder does not exist or is not writable; make it first.";
    }
    if (fs::is_directory(name, ignored))
    {
        return "\"" + name + "\" is a folder; give the name of a file.";
    }
    return {};
}

PictureFiles::PictureFiles(const std::string& name, bool many) : _name(name), _many(many)
{
    std::smatch parts;
    // As printf has it, with one conversion: f%04d.png, f%d.png.
    if (many && std::regex_match(name, parts, std::regex("([^%]*)%(0([1-9]))?d([^%]*)")))
    {
        _before = parts[1];
        _digits = parts[3].matched ? static_cast<std::size_t>(std::stoi(parts[3])) : 1;
        _after = parts[4];
    }
    else if (many)
    {
        _error = "-o " + name + ": a path needs a pattern for its pictures, such as f%04d.png.";
        return;
    }
    const std::string extension = osgDB::getLowerCaseFileExtension(name);
    if (!extension.empty()) _writer = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (!_writer)
    {
        _error =
            "-o " + name + ": OpenSceneGraph writes no \"" + extension + "\" pictures; use png, jpg or tiff.";
        return;
    }
    _error = faultOfOutput(name);
}

std::string PictureFiles::nameOf(unsigned int frame) const
{
    if (!_many)
    {
        return _name;
    }
    const std::string number = std::to_string(frame);
    const std::size_t zeros = number.size() < _digits ? _digits - number.size() : 0;
    return _before + std::string(zeros, '0') + number + _after;
}

bool PictureFiles::write(const osg::Image& image, unsigned int frame)
{
    const std::string name = nameOf(frame);
    // OSG's writers do not all notice a full disk, so the bytes are made in memory and written here.
    std::ostringstream bytes;
    const osgDB::ReaderWriter::WriteResult result = _writer->writeImage(image, bytes);
    if (!result.success())
    {
        _error = "The picture \"" + name +
                 "\" cannot be written: its format is not one for pictures of this kind; "
                 "use png, jpg or tiff.";
        return false;
    }
    const std::string content = bytes.str();
    if (osgGeoFX::writeWholeFile(name, content.data(), content.size()) != 0)
    {
        _error = "The picture \"" + name +
                 "\" cannot be written; check the folder, its permissions and the disk's "
                 "space.";
        return false;
    }
    return true;
}

StatisticsFile::StatisticsFile(const osgGeoFX::SceneRenderer& renderer,
                               const osgGeoFX::SceneRenderer::Options& options)
    : _least(options.leastTriangles)
{
    _json["renderer"] = renderer.rendererName();
    _json["gl_version"] = renderer.glVersion();
    _json["size"] = std::array<int, 2>{options.width, options.height};
    _json["samples"] = renderer.samples();
    _json["peak_memory_bytes"] = 0;
    _json["frames"] = nlohmann::ordered_json::array();
}

void StatisticsFile::add(const osgGeoFX::FrameStatistics& frame)
{
    nlohmann::ordered_json figures = {
        {"cull_ms", frame.cullMilliseconds},   {"draw_ms", frame.drawMilliseconds},
        {"total_ms", frame.totalMilliseconds}, {"triangles", frame.triangles},
        {"drawables", frame.drawables},        {"tiles_drawn", frame.tilesDrawn},
        {"tiles_loaded", frame.tilesLoaded},   {"bytes_read", frame.bytesRead}};
    if (_least) figures["least_triangles"] = frame.leastTriangles;
    _json["frames"].push_back(figures);
}

bool StatisticsFile::write(const std::string& file)
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    _json["peak_memory_bytes"] = 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
    std::ofstream stream(file);
    stream << _json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    stream.close();
    return static_cast<bool>(stream);
}
