// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "RunProgram.h"

#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <sstream>
#include <system_error>

extern char** environ;

namespace geofx
{

namespace
{

struct CloseFile
{
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(int error, const std::string& what)
{
    throw std::system_error(error, std::generic_category(), what);
}

File temporaryFile(const std::string& text = {})
{
    File file(std::tmpfile());
    if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
        std::fflush(file.get()) != 0)
        fail(errno, "cannot write a temporary file");
    std::rewind(file.get());
    return file;
}

std::string contents(std::FILE* file)
{
    std::string text;
    std::rewind(file);
    char buffer[4096];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file))
        text.append(buffer, count);
    return text;
}

double secondsOf(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// The command as coreutils' timeout and env run it, where they are needed.
std::vector<std::string> wrapped(const std::vector<std::string>& arguments, const ProgramOptions& options)
{
    std::vector<std::string> command;
    if (options.seconds > 0.0)
    {
        std::ostringstream seconds;
        seconds << options.seconds;
        // A program that ignores the signal is killed ten seconds later.
        command = {"timeout", "--signal=" + std::to_string(options.signal), "--kill-after=10", seconds.str()};
    }
    if (!options.folder.empty() || !options.environment.empty()) command.emplace_back("env");
    if (!options.folder.empty()) command.push_back("--chdir=" + options.folder);
    command.insert(command.end(), options.environment.begin(), options.environment.end());
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

} // namespace

ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramOptions& options)
{
    const File streams[] = {temporaryFile(options.input), temporaryFile(), temporaryFile()};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (int i = 0; i < 3; ++i)
        posix_spawn_file_actions_adddup2(&actions, fileno(streams[i].get()), i);

    std::vector<std::string> command = wrapped(arguments, options);
    std::vector<char*> pointers;
    for (std::string& argument : command)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    const auto start = std::chrono::steady_clock::now();
    pid_t child = 0;
    const int failure = posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) fail(failure, command.front() + ": it cannot be started");
    if (options.runs) options.runs(child);
    int status = 0;
    rusage usage = {};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR)
    {
    }
    if (options.runs) options.runs(0);

    ProgramResult result;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.cpuSeconds = secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
    result.peakMiB = static_cast<double>(usage.ru_maxrss) / 1024.0;
    result.exitCode = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    // timeout exits with 124, or with 137 where it had to kill.
    result.timedOut = options.seconds > 0.0 && (result.exitCode == 124 || result.exitCode == 128 + SIGKILL) &&
                      result.seconds >= options.seconds;
    result.standardOutput = contents(streams[1].get());
    result.standardError = contents(streams[2].get());
    return result;
}

} // namespace geofx
