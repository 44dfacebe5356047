// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/detail/UnitLog.h>

#include <osgGeoFX/batch/WorkError.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
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

double secondsOf(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// How long this process has been there, seconds, to a hundredth; 0 where the kernel does not say.
double age()
{
    std::ifstream stream("/proc/self/stat");
    std::string text;
    std::getline(stream, text);
    // The name, in brackets, may have spaces. The start is the 20th word after it, in ticks since the boot.
    const std::size_t end = text.rfind(')');
    if (end == std::string::npos) return 0.0;
    std::istringstream words(text.substr(end + 1));
    std::string word;
    for (int i = 0; i < 20; ++i)
        words >> word;
    const double start = std::strtod(word.c_str(), nullptr) / static_cast<double>(sysconf(_SC_CLK_TCK));
    return start > 0.0 ? std::max(secondsOf(CLOCK_BOOTTIME) - start, 0.0) : 0.0;
}

/// How long this thread could have run, but others had its core, seconds; 0 where the kernel does not say.
double delay()
{
    std::ifstream stream("/proc/thread-self/schedstat");
    double running = 0.0, waiting = 0.0;
    stream >> running >> waiting;
    return 1e-9 * waiting;
}

fs::path logFolder(const std::string& folder, const std::string& stage)
{
    return fs::path(WorkPlan::workFolder(folder)) / LOG_FOLDER / stage;
}

[[noreturn]] void failToWrite(const std::string& path, int error)
{
    throw WorkError(path + ": cannot be written (" + std::strerror(error) +
                    "); free some space, or make the folder writable, and do the units again.");
}

/// The CPU time and the delay at which the thread has begun its unit.
thread_local double cpuAtBegin = 0.0, delayAtBegin = 0.0;

} // namespace

std::string stageDoneFile(const std::string& folder, const std::string& stage)
{
    return (logFolder(folder, stage) / "done").string();
}

UnitLog::UnitLog(const std::string& folder, const std::string& stage, int threads)
    : _wholeProcess(threads <= 1)
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
    // What it took to come here counts once.
    static std::atomic<bool> first{true};
    char line[120];
    if (first.exchange(false))
        std::snprintf(line, sizeof(line), "start 0 %.3f %.3f %.3f %.3f\n", now(), age(),
                      secondsOf(CLOCK_PROCESS_CPUTIME_ID), delay());
    else
        std::snprintf(line, sizeof(line), "start 0 %.3f 0 0 0\n", now());
    write(line);
}

UnitLog::~UnitLog()
{
    close(_descriptor);
}

double UnitLog::cpuTime() const
{
    return secondsOf(_wholeProcess ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_THREAD_CPUTIME_ID);
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
    std::snprintf(line, sizeof(line), "begin %llu %.4f\n", static_cast<unsigned long long>(unit), now());
    write(line);
    delayAtBegin = delay();
    cpuAtBegin = cpuTime();
}

void UnitLog::done(std::uint64_t unit)
{
    char line[120];
    std::snprintf(line, sizeof(line), "done %llu %.4f %.4f %.4f\n", static_cast<unsigned long long>(unit),
                  now(), cpuTime() - cpuAtBegin, delay() - delayAtBegin);
    write(line);
}

void UnitLog::fail(std::uint64_t unit, const std::string& sentence)
{
    std::string text = sentence;
    std::replace(text.begin(), text.end(), '\n', ' ');
    char line[80];
    std::snprintf(line, sizeof(line), "fail %llu %.4f ", static_cast<unsigned long long>(unit), now());
    write(line + text + "\n");
}

StageAccount readUnitLogs(const std::string& folder, const WorkPlan::Stage& stage)
{
    StageAccount account;
    StageStatus& status = account.status;
    status.name = account.times.name = stage.name;
    status.units = stage.units;
    status.estimatedSeconds = stage.seconds;
    std::vector<bool>& done = account.done;
    done.resize(stage.units);
    std::vector<StageStatus::Begun> begun;
    std::vector<StageStatus::Failed> failed;
    double first = 0.0;
    std::error_code code;
    for (fs::directory_iterator entry(logFolder(folder, stage.name), code), end; !code && entry != end;
         entry.increment(code))
    {
        const fs::path path = entry->path();
        if (path.extension() != ".log") continue;
        std::ifstream stream(path);
        std::map<std::uint64_t, double> open; // units in work, and when they began
        ProcessTime process;
        process.host = path.filename().string();
        process.host.resize(std::min(process.host.size(), process.host.rfind(':')));
        for (std::string line;
             std::getline(stream, line) && !stream.eof();) // a line without its end is not whole
        {
            std::istringstream words(line);
            std::string event, sentence;
            std::uint64_t unit = 0;
            double time = 0.0;
            if (!(words >> event >> unit >> time) || unit >= stage.units) continue;
            if (process.start == 0.0) process.start = time;
            process.end = std::max(process.end, time);
            if (event == "start")
            {
                double startDelay = 0.0;
                if (words >> process.startWall >> process.startCpu >> startDelay)
                {
                    process.start = time - process.startWall;
                    process.startWall = std::max(process.startWall - startDelay, 0.0);
                }
                continue;
            }
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
                UnitTime taken;
                double others = 0.0;
                words >> taken.cpu >> others;
                if (start != open.end())
                {
                    taken.wall = std::max(time - start->second - others, 0.0);
                    account.times.units.push_back(taken);
                }
                else
                    ++account.times.idle;
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
        if (process.start > 0.0) account.times.processes.push_back(process);
    }
    for (const auto& each : begun)
        if (!done[each.unit]) status.begun.push_back(each);
    for (const auto& each : failed)
        if (!done[each.unit]) status.failed.push_back(each);
    status.done = static_cast<std::uint64_t>(std::count(done.begin(), done.end(), true));
    if (!account.times.units.empty())
    {
        std::vector<double> times;
        for (const UnitTime& each : account.times.units)
            times.push_back(each.wall);
        const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
        std::nth_element(times.begin(), middle, times.end());
        status.unitSeconds = *middle;
        if (now() > first) status.rate = static_cast<double>(times.size()) / (now() - first);
    }
    return account;
}

} // namespace osgGeoFX
