// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "ChildProcess.h"

#include "BenchError.h"
#include "Interruption.h"

#include <system_error>

namespace geofx::bench
{

ProgramResult runChild(const std::vector<std::string>& arguments, const std::vector<std::string>& environment)
{
    ProgramOptions options;
    options.seconds = 0.0;
    options.environment = environment;
    options.runs = Interruption::passOnTo;
    ProgramResult result;
    try
    {
        result = runProgram(arguments, options);
    }
    catch (const std::system_error& error)
    {
        throw BenchError(std::string(error.what()) + ".");
    }
    Interruption::throwIfInterrupted();
    if (result.exitCode != 0)
    {
        std::string command;
        for (const std::string& argument : arguments)
            command += " " + argument;
        throw BenchError("This command failed:" + command + "\n" + result.standardOutput +
                         result.standardError);
    }
    return result;
}

} // namespace geofx::bench
