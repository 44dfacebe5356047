// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/RunProgram.h>

#include <tools/TempDir.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <sstream>
#include <system_error>

extern char** environ;

namespace geofx::test
{

namespace
{

std::string readFile(const std::filesystem::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// The command as coreutils' timeout and env run it.
std::vector<std::string> wrapped(const std::vector<std::string>& arguments, const ProgramOptions& options)
{
    std::ostringstream seconds;
    seconds << options.seconds;
    // A program that ignores the signal is killed ten seconds later.
    std::vector<std::string> command = {"timeout", "--signal=" + std::to_string(options.signal),
                                        "--kill-after=10", seconds.str(), "env"};
    if (!options.folder.empty()) command.push_back("--chdir=" + options.folder);
    command.insert(command.end(), options.environment.begin(), options.environment.end());
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

} // namespace

ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramOptions& options)
{
    const TempDir streams;
    const std::string input = streams.write("input", options.input);
    const std::string output = streams / "output";
    const std::string error = streams / "error";

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, input.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, error.c_str(), O_WRONLY | O_CREAT, 0600);

    std::vector<std::string> command = wrapped(arguments, options);
    std::vector<char*> pointers;
    for (std::string& argument : command)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    const auto start = std::chrono::steady_clock::now();
    pid_t pid = 0;
    const int failure = posix_spawnp(&pid, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
    {
        throw std::system_error(failure, std::generic_category(), "cannot run " + command.front());
    }
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR)
    {
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

    ProgramResult result;
    result.exitCode = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    // timeout exits with 124, or with 137 where it had to kill.
    result.timedOut =
        (result.exitCode == 124 || result.exitCode == 128 + SIGKILL) && elapsed.count() >= options.seconds;
    result.standardOutput = readFile(output);
    result.standardError = readFile(error);
    return result;
}

std::string builtProgram(const std::string& name)
{
    return std::string(GEOFX_BUILD_DIR "/bin/") + name;
}

} // namespace geofx::test
