// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/UnitLog.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <unistd.h>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Seconds since 1970. Machines that share a folder agree on them well enough.
double now()
{
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

fs::path logFolder(const std::string& folder, const std::string& stage)
{
    return workFolderOf(folder) / LOG_FOLDER / stage;
}

} // namespace

std::string stageDoneFile(const std::string& folder, const std::string& stage)
{
    return (logFolder(folder, stage) / "done").string();
}

UnitLog::UnitLog(const std::string& folder, const std::string& stage)
{
    const fs::path logs = logFolder(folder, stage);
    std::error_code code;
    fs::create_directories(logs, code);
    // The time makes the name unique where process numbers come again, as in containers.
    char host[256] = {};
    gethostname(host, sizeof(host) - 1);
    for (unsigned int number = 0; _descriptor < 0; ++number)
    {
        char name[400];
        std::snprintf(name, sizeof(name), "%s:%d.%.0f-%u.log", host, static_cast<int>(getpid()), 1e3 * now(),
                      number);
        _path = (logs / name).string();
        _descriptor = open(_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
        if (_descriptor < 0 && errno != EEXIST) failToWrite(_path, errno);
    }
}

UnitLog::~UnitLog()
{
    close(_descriptor);
}

void UnitLog::write(const std::string& line)
{
    // At once, so that lines of several threads stay whole.
    if (::write(_descriptor, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
        failToWrite(_path, errno);
}

void UnitLog::begin(std::uint64_t unit)
{
    char line[80];
    std::snprintf(line, sizeof(line), "begin %llu %.3f\n", static_cast<unsigned long long>(unit), now());
    write(line);
}

void UnitLog::done(std::uint64_t unit)
{
    char line[80];
    std::snprintf(line, sizeof(line), "done %llu %.3f\n", static_cast<unsigned long long>(unit), now());
    write(line);
}

void UnitLog::fail(std::uint64_t unit, const std::string& sentence)
{
    std::string text = sentence;
    std::replace(text.begin(), text.end(), '\n', ' ');
    char line[80];
    std::snprintf(line, sizeof(line), "fail %llu %.3f ", static_cast<unsigned long long>(unit), now());
    write(line + text + "\n");
}

StageStatus readUnitLogs(const std::string& folder, const std::string& stage, std::uint64_t units,
                         std::vector<bool>* isDone)
{
    StageStatus status;
    status.name = stage;
    status.units = units;
    std::vector<bool> done(units);
    std::vector<StageStatus::Begun> begun;
    std::vector<StageStatus::Failed> failed;
    std::vector<double> times;
    double first = 0.0;
    std::error_code code;
    for (fs::directory_iterator entry(logFolder(folder, stage), code), end; !code && entry != end;
         entry.increment(code))
    {
        const fs::path path = entry->path();
        if (path.extension() != ".log") continue;
        std::ifstream stream(path);
        std::map<std::uint64_t, double> open; // units in work, and when they began
        for (std::string line;
             std::getline(stream, line) && !stream.eof();) // a line without its end is not whole
        {
            std::istringstream words(line);
            std::string event, sentence;
            std::uint64_t unit = 0;
            double time = 0.0;
            if (!(words >> event >> unit >> time) || unit >= units) continue;
            if (event == "begin")
            {
                open[unit] = time;
                if (first == 0.0 || time < first) first = time;
                continue;
            }
            const auto start = open.find(unit);
            if (event == "done")
            {
                done[unit] = true;
                if (start != open.end()) times.push_back(time - start->second);
            }
            else if (event == "fail")
            {
                std::getline(words >> std::ws, sentence);
                failed.push_back({unit, sentence});
            }
            if (start != open.end()) open.erase(start);
        }
        for (const auto& [unit, time] : open)
            begun.push_back({unit, now() - time, path.stem().stem().string()});
    }
    for (const auto& each : begun)
        if (!done[each.unit]) status.begun.push_back(each);
    for (const auto& each : failed)
        if (!done[each.unit]) status.failed.push_back(each);
    status.done = static_cast<std::uint64_t>(std::count(done.begin(), done.end(), true));
    if (!times.empty())
    {
        const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
        std::nth_element(times.begin(), middle, times.end());
        status.unitSeconds = *middle;
        if (now() > first) status.rate = static_cast<double>(times.size()) / (now() - first);
    }
    if (isDone) *isDone = std::move(done);
    return status;
}

} // namespace osgGeoFX
