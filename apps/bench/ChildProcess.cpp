// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "ChildProcess.h"

#include "BenchError.h"
#include "Interruption.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>

extern char** environ;

namespace geofx::bench
{

namespace
{

struct CloseFile
{
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string contents(std::FILE* file)
{
    std::string text;
    std::rewind(file);
    char buffer[4096];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file))
        text.append(buffer, count);
    return text;
}

double seconds(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

} // namespace

ChildUsage runChild(const std::vector<std::string>& arguments)
{
    const File output(std::tmpfile());
    if (!output)
        throw BenchError(std::string("No temporary file can be made (") + std::strerror(errno) + ").");

    std::vector<char*> argv;
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(output.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(output.get()), STDERR_FILENO);

    const auto start = std::chrono::steady_clock::now();
    pid_t child = 0;
    const int failure = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
        throw BenchError(arguments[0] + ": it cannot be started (" + std::strerror(failure) + ").");
    Interruption::passOnTo(child);
    int status = 0;
    rusage usage = {};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR)
    {
    }
    Interruption::passOnTo(0);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;

    Interruption::throwIfInterrupted();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    {
        std::string command;
        for (const std::string& argument : arguments)
            command += " " + argument;
        throw BenchError("This command failed:" + command + "\n" + contents(output.get()));
    }
    return {taken.count(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
            static_cast<double>(usage.ru_maxrss) / 1024.0};
}

} // namespace geofx::bench
