// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/FolderLock.h>
#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/print/PicturePrint.h>

#include <string>

namespace CLI
{
class App;
}

/// How the programs' pictures are written.
namespace geofx::print
{

struct Options
{
    int bits = 8; ///< of each channel
};

/// Adds --bits to a program.
void addOptions(CLI::App& app, Options& options);
/// A sentence if the output's format has not what they ask for; else empty.
std::string faultOf(const Options& options, const std::string& output);
/// Whether osgGeoFX::PicturePrint writes the picture: one that is large, has a resolution, has more than 8 bits, or becomes a PDF.
bool isPrint(const Options& options, const std::string& output, const osgGeoFX::PrintSize& size);

/// Where the tiles of a print are until it is there.
std::string tileFolderOf(const std::string& output);

/// Makes sure that the folder is free, or one of a print that was interrupted. Throws WorkError.
void claimTileFolder(const std::string& output, osgGeoFX::InputFiles& inputs);

/// Takes that folder (osgGeoFX::OwnFolder), which nobody else may use while this lives. Throws WorkError.
class TileFolder
{
public:
    explicit TileFolder(const std::string& output);

private:
    osgGeoFX::FolderLock _lock;
};

} // namespace geofx::print
