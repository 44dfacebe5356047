// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "BenchError.h"
#include "ChildProcess.h"
#include "OahuSource.h"
#include "TerrainSuite.h"
#include "WorkFolder.h"

#include <cstdio>
#include <optional>

namespace geofx::bench
{

namespace
{

// A build's work files and database together, measured, with a margin.
constexpr std::uint64_t DISK_BYTES_PER_SAMPLE = 25;

struct Sizes
{
    int large, small, pairs;
};

Sizes sizes(const Settings& settings)
{
    if (settings.smoke) return {512, 256, 1};
    return {settings.quick ? 8000 : 16000, 4000, 3};
}

double square(int samples)
{
    return static_cast<double>(samples) * samples;
}

std::string squared(int samples)
{
    const std::string text = std::to_string(samples);
    return text + " x " + text;
}

std::string inSeconds(double seconds)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f s", seconds);
    return text;
}

struct Build
{
    ProgramResult usage;
    double bytesPerSample = 0.0;
    double secondsPerMillion = 0.0;
};

class Builds
{
public:
    Builds(const Settings& settings, const std::filesystem::path& folder)
        : _settings(settings), _folder(folder)
    {
    }

    Build build(int samples, int threads) const
    {
        const std::filesystem::path source = _folder / "source.vrt", database = _folder / "database";
        writeResampledOahu(_settings.data / "oahu" / "elevation.tif", samples, source);
        const auto command = builderCommand(_settings, source, database, threads);
        announce("building " + squared(samples) + " samples with " + std::to_string(threads) +
                 (threads == 1 ? " thread" : " threads"));
        Build result;
        result.usage = runChild(command);
        const double count = square(samples);
        result.bytesPerSample = static_cast<double>(bytesBelow(database)) / count;
        result.secondsPerMillion = result.usage.seconds / (count * 1e-6);
        std::filesystem::remove_all(database);
        announce("  took " + inSeconds(result.usage.seconds));
        return result;
    }

private:
    const Settings& _settings;
    const std::filesystem::path& _folder;
};

struct Runs
{
    std::vector<Build> one, two; ///< by pair: the small source with one thread and with two
    std::optional<Build> large;
};

std::vector<double> seconds(const std::vector<Build>& builds)
{
    std::vector<double> result;
    for (const Build& build : builds)
        result.push_back(build.usage.seconds);
    return result;
}

Figure memoryFigure(const Sizes& size, const Runs& runs)
{
    Figure figure{"memory",
                  "peak resident memory of osggeofx_build --memory 512 --threads 2 on " +
                      squared(size.large) + " samples",
                  "MiB", Bound::Below, 1024.0};
    figure.measured = runs.large->usage.peakMiB;
    return figure;
}

Figure linearityFigure(const Sizes& size, const Runs& runs)
{
    Figure figure{"linearity",
                  "time for each sample on " + squared(size.large) + " samples over that on " +
                      squared(size.small) + ", 2 threads",
                  "", Bound::AtMost, 1.25};
    std::vector<double> small;
    for (const Build& build : runs.two)
        small.push_back(build.secondsPerMillion);
    figure.measured = runs.large->secondsPerMillion / median(small);
    char remark[160];
    std::snprintf(remark, sizeof remark,
                  "%.3f against %.3f s for a million samples; %.1f against %.1f bytes on disk "
                  "for a sample",
                  runs.large->secondsPerMillion, median(small), runs.large->bytesPerSample,
                  runs.two.front().bytesPerSample);
    figure.remark = remark;
    figure.details = {
        {"secondsPerMillionLarge", runs.large->secondsPerMillion},
        {"secondsPerMillionSmall", small},
        {"processorSecondsPerMillionLarge", runs.large->usage.cpuSeconds * 1e6 / square(size.large)},
        {"processorSecondsPerMillionSmall", runs.two.front().usage.cpuSeconds * 1e6 / square(size.small)},
        {"bytesPerSampleLarge", runs.large->bytesPerSample},
        {"bytesPerSampleSmall", runs.two.front().bytesPerSample}};
    return figure;
}

Figure threadsFigure(const Sizes& size, const Runs& runs)
{
    Figure figure{"threads",
                  "time with 1 thread over that with 2 on " + squared(size.small) +
                      " samples, median of pairs",
                  "", Bound::AtLeast, 1.7};
    std::vector<double> ratios;
    for (std::size_t i = 0; i < runs.one.size(); ++i)
        ratios.push_back(runs.one[i].usage.seconds / runs.two[i].usage.seconds);
    figure.measured = median(ratios);
    figure.remark = inSeconds(median(seconds(runs.one))) + " against " + inSeconds(median(seconds(runs.two)));
    figure.details = {{"secondsOneThread", seconds(runs.one)}, {"secondsTwoThreads", seconds(runs.two)}};
    return figure;
}

} // namespace

std::vector<Figure> measureBuilding(const Settings& settings, const std::filesystem::path& folder)
{
    const bool memory = settings.wants("memory"), linearity = settings.wants("linearity"),
               threads = settings.wants("threads");
    if (!memory && !linearity && !threads) return {};
    const Sizes size = sizes(settings);
    const bool needsLarge = memory || linearity;
    requireSpace(folder, DISK_BYTES_PER_SAMPLE *
                             static_cast<std::uint64_t>(needsLarge ? size.large : size.small) *
                             static_cast<std::uint64_t>(needsLarge ? size.large : size.small));

    const Builds builds(settings, folder);
    Runs runs;
    for (int pair = 0; pair < size.pairs; ++pair)
    {
        // The large build stands between the small ones, so that a machine that slows down in time tells on
        // both.
        if (needsLarge && pair == size.pairs / 2) runs.large = builds.build(size.large, 2);
        if (threads) runs.one.push_back(builds.build(size.small, 1));
        if (threads || linearity) runs.two.push_back(builds.build(size.small, 2));
    }
    std::vector<Figure> figures;
    if (memory) figures.push_back(memoryFigure(size, runs));
    if (linearity) figures.push_back(linearityFigure(size, runs));
    if (threads) figures.push_back(threadsFigure(size, runs));
    return figures;
}

} // namespace geofx::bench
