// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <CLI/CLI.hpp>

#include <iostream>
#include <string>

namespace geofx
{

/// The exit code of a program whose arguments ended its parser: 0 behind its help, else 2 behind a sentence on the standard error.
inline int exitCodeOf(CLI::App& app, const CLI::ParseError& error)
{
    if (error.get_exit_code() == 0) return app.exit(error);
    std::string text = error.what();
    // A whole sentence has a remedy of its own.
    if (text.back() != '.') text += "; --help lists the options.";
    std::cerr << app.get_name() << ": " << text << std::endl;
    return 2;
}

} // namespace geofx
