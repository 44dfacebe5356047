// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

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

} // namespace geofx::print
