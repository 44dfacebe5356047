// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "print/PrintOptions.h"

#include "names/PictureMap.h"

#include <osgGeoFX/batch/OwnFolder.h>

#include <CLI/CLI.hpp>
#include <osgDB/FileNameUtils>

#include <filesystem>

namespace geofx::print
{

namespace
{

constexpr const char* OPTION = "-o";

std::string taken(const std::string& folder)
{
    osgGeoFX::OwnFolder::take(folder, OPTION);
    return folder;
}

} // namespace

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--bits", options.bits,
                   "Bits for each channel of the colors: 8 (the default), or 16 for png, tiff and exr. exr "
                   "always has 16, linear")
        ->check(CLI::IsMember({8, 16}))
        ->type_name("8|16");
}

std::string faultOf(const Options& options, const std::string& output)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(output);
    if (options.bits == 8 || extension == "png" || extension == "tif" || extension == "tiff" ||
        extension == "exr")
        return {};
    return "--bits " + std::to_string(options.bits) + ": \"" + extension +
           "\" pictures have 8 bits for each channel; write png, tiff or exr.";
}

bool isPrint(const Options& options, const std::string& output, const osgGeoFX::PrintSize& size)
{
    return size.dpi > 0.0 || options.bits > 8 || osgGeoFX::PicturePrint::isLarge(size) ||
           names::PictureMap::isPdf(output) || osgDB::getLowerCaseFileExtension(output) == "exr";
}

std::string tileFolderOf(const std::string& output)
{
    return std::filesystem::path(output).replace_extension().string() + ".tiles";
}

void claimTileFolder(const std::string& output, osgGeoFX::InputFiles& inputs)
{
    inputs.claimFolder("The folder for tiles", tileFolderOf(output), OPTION);
    osgGeoFX::OwnFolder::check(tileFolderOf(output), OPTION);
}

TileFolder::TileFolder(const std::string& output)
    : _lock(taken(tileFolderOf(output)), osgGeoFX::FolderLock::ALONE, OPTION)
{
}

} // namespace geofx::print
