// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Runs a program under strace and tells what it did to the machine: for files of people whom nobody knows.
#pragma once

#include <gtest/gtest.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace geofx::test
{

/// What a program did.
struct WatchedProgram
{
    ProgramResult result;
    std::set<std::string>
        changed; ///< complete paths of files opened for writing, made, renamed, or removed; tried to be, too
    std::set<std::string> sockets;  ///< families of sockets, such as AF_INET
    std::set<std::string> children; ///< the system calls that made processes
    std::string log;                ///< what strace wrote

    /// What it changed that lies neither in one of the folders nor below it.
    std::set<std::string> changedOutside(const std::vector<std::filesystem::path>& folders) const
    {
        std::set<std::string> outside;
        for (const std::string& path : changed)
        {
            const auto isBelow = [&](const std::filesystem::path& folder)
            {
                const std::string root = std::filesystem::weakly_canonical(folder).string();
                return path == root || path.rfind(root + "/", 0) == 0;
            };
            if (std::none_of(folders.begin(), folders.end(), isBelow)) outside.insert(path);
        }
        return outside;
    }
};

/** Runs a program under strace in `options.folder`. Devices and /proc are no files here. Mesa's cache of shaders is switched off.
    Memory is that of the largest process. */
inline WatchedProgram watchProgram(const std::vector<std::string>& arguments, ProgramOptions options)
{
    namespace fs = std::filesystem;
    const TempDir place;
    const fs::path log = place / "strace";
    std::vector<std::string> command = {
        "strace",
        "-f",
        "-qq",
        "-y",
        "-s",
        "4096",
        "-o",
        log.string(),
        "-e",
        "trace=open,openat,creat,rename,renameat,renameat2,unlink,unlinkat,mkdir,mkdirat,rmdir,truncate,"
        "link,linkat,symlink,symlinkat,mknod,mknodat,socket,execve,execveat,fork,vfork,clone,clone3"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    options.environment.insert(options.environment.end(),
                               {"MESA_SHADER_CACHE_DISABLE=true", "ASAN_OPTIONS=detect_leaks=0"});
    if (options.folder.empty()) options.folder = fs::current_path().string();

    WatchedProgram watched;
    watched.result = runProgram(command, options);
    std::ifstream stream(log);
    watched.log.assign(std::istreambuf_iterator<char>(stream), {});
    // strace is the first to start a program.
    bool isStarted = false;
    static const std::regex call(R"re(^\d+ +(\w+)\((.*)$)re");
    static const std::regex path(R"re((?:[A-Z_0-9]+<([^>]*)>, )?"((?:[^"\\]|\\.)*)")re");
    std::istringstream lines(watched.log);
    for (std::string line; std::getline(lines, line);)
    {
        std::smatch match;
        if (!std::regex_match(line, match, call)) continue;
        const std::string name = match[1], rest = match[2];
        if (name.rfind("exec", 0) == 0)
        {
            if (std::exchange(isStarted, true)) watched.children.insert(line);
        }
        else if (name == "fork" || name == "vfork" || name.rfind("clone", 0) == 0)
        {
            if (rest.find("CLONE_THREAD") == std::string::npos) watched.children.insert(line);
        }
        else if (name == "socket")
        {
            watched.sockets.insert(rest.substr(0, rest.find(',')));
        }
        else
        {
            const bool opens = name.rfind("open", 0) == 0;
            static const std::regex writing("O_WRONLY|O_RDWR|O_CREAT|O_TRUNC|O_APPEND");
            if (opens && !std::regex_search(rest, writing)) continue;
            for (std::sregex_iterator each(rest.begin(), rest.end(), path), end; each != end; ++each)
            {
                const std::string folder = (*each)[1].matched ? (*each)[1].str() : options.folder;
                const fs::path full = (fs::path(folder) / (*each)[2].str()).lexically_normal();
                if (full.string().rfind("/dev/", 0) != 0 && full.string().rfind("/proc/", 0) != 0)
                    watched.changed.insert(
                        (fs::weakly_canonical(full.parent_path()) / full.filename()).string());
            }
        }
    }
    return watched;
}

/// What no file of somebody else's may make a program do: write outside of the folders, open a socket (but of the families given),
/// start a process, take 1 GiB of memory, or run for 20 s.
inline void expectHarmless(const WatchedProgram& watched, const std::vector<std::filesystem::path>& folders,
                           const std::set<std::string>& families = {})
{
    const std::string said = watched.result.standardOutput + watched.result.standardError;
    EXPECT_FALSE(watched.log.empty()) << "strace has not run: " << said;
    EXPECT_EQ(watched.changedOutside(folders), std::set<std::string>()) << said;
    std::set<std::string> sockets;
    std::set_difference(watched.sockets.begin(), watched.sockets.end(), families.begin(), families.end(),
                        std::inserter(sockets, sockets.end()));
    EXPECT_EQ(sockets, std::set<std::string>()) << said;
    EXPECT_EQ(watched.children, std::set<std::string>()) << said;
    EXPECT_LT(watched.result.exitCode, 128) << "a signal ended it: " << said;
    EXPECT_FALSE(watched.result.timedOut) << said;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_LT(watched.result.peakMiB, 1024.0) << said;
    EXPECT_LT(watched.result.seconds, 20.0) << said;
#endif
}

} // namespace geofx::test
