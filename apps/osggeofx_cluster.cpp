// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_cluster: a planned build under Slurm or make, and how far it is. Slurm and make do the scheduling.
#include <osgGeoFX/terrain/DistributedBuild.h>
#include <process/RunProgram.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <system_error>

namespace
{

namespace fs = std::filesystem;
using osgGeoFX::BuildError;
using osgGeoFX::BuildStatus;
using osgGeoFX::StageStatus;

// A job should take about so long, seconds: much longer than its start.
constexpr double JOB_SECONDS = 30.0;
// Slurm's usual limit of an array (MaxArraySize) is 1001.
constexpr std::uint64_t MOST_JOBS = 1000;
constexpr int MOST_RESTARTS = 3;

struct Options
{
    std::string folder, partition, builder;
    std::uint64_t maxWorkers = 8, unitsPerJob = 0;
    int memoryMiB = 0;
    bool dryRun = false;
};

/// A text as one word of a shell's command line.
std::string quoted(const std::string& text)
{
    std::string result = "'";
    for (const char letter : text)
        result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return result + "'";
}

/// The number of jobs that do a stage.
std::uint64_t jobsOf(const Options& options, const BuildStatus& build, const StageStatus& stage)
{
    std::uint64_t all = 0;
    for (const StageStatus& each : build.stages)
        all += each.units;
    const auto most = std::min(stage.units, MOST_JOBS);
    if (options.unitsPerJob > 0)
        return std::clamp<std::uint64_t>((stage.units + options.unitsPerJob - 1) / options.unitsPerJob, 1,
                                         most);
    // The estimate is for all cores of a machine; units of different stages count as alike.
    const double seconds = build.estimatedSeconds * static_cast<double>(stage.units) /
                           static_cast<double>(std::max<std::uint64_t>(all, 1));
    const auto wanted = static_cast<std::uint64_t>(std::ceil(seconds / JOB_SECONDS));
    return std::clamp(wanted, std::min(most, options.maxWorkers), most);
}

/// Stages that one array of jobs does: one stage in parts, or several stages in a row that have one part each.
struct JobArray
{
    std::vector<std::string> stages;
    std::uint64_t jobs = 1;
};

std::vector<JobArray> arraysOf(const Options& options, const BuildStatus& build)
{
    std::vector<JobArray> arrays;
    for (const StageStatus& stage : build.stages)
    {
        if (stage.done == stage.units) continue;
        const std::uint64_t jobs = jobsOf(options, build, stage);
        if (jobs == 1 && !arrays.empty() && arrays.back().jobs == 1)
            arrays.back().stages.push_back(stage.name);
        else
            arrays.push_back({{stage.name}, jobs});
    }
    return arrays;
}

std::string builderLine(const Options& options, const JobArray& array, const std::string& part)
{
    std::string line = quoted(options.builder) + " --quiet --threads 1";
    if (options.memoryMiB > 0) line += " --memory " + std::to_string(options.memoryMiB);
    line += " --work " + quoted(options.folder) + " --unit";
    for (const std::string& stage : array.stages)
        line += " " + stage + ":" + part + "/" + std::to_string(array.jobs);
    return line;
}

/// The numbers of the jobs that were submitted for a build.
std::string jobsFile(const BuildStatus& build)
{
    return (fs::path(build.logFolder) / "slurm-jobs").string();
}

/// Runs one of Slurm's programs.
geofx::ProgramResult slurm(const std::vector<std::string>& arguments)
{
    try
    {
        return geofx::runProgram(arguments);
    }
    catch (const std::system_error&)
    {
        throw BuildError(
            arguments.front() +
            ": this program of Slurm is not here; run osggeofx_cluster on a machine of the cluster, or build "
            "with `osggeofx_cluster make` on this one.");
    }
}

/// What a job does. A process that was killed gets its job queued again, by Slurm. Errors that have a sentence (2)
/// would come again.
std::string scriptOf(const Options& options, const JobArray& array)
{
    return builderLine(options, array, "$SLURM_ARRAY_TASK_ID") +
           "; code=$?; if [ $code -gt 2 ] && [ \"${SLURM_RESTART_COUNT:-0}\" -lt " +
           std::to_string(MOST_RESTARTS) +
           " ]; then echo \"The builder ended with $code; the job is queued again.\"; scontrol requeue "
           "$SLURM_JOB_ID && "
           "sleep 60; fi; exit $code";
}

void submit(const Options& options)
{
    const BuildStatus build = osgGeoFX::readBuildStatus(options.folder);
    if (build.finished)
    {
        std::printf("%s/terrain.osgb: the database is finished; nothing is submitted.\n",
                    options.folder.c_str());
        return;
    }
    std::string before, jobs;
    if (!options.dryRun) fs::create_directories(build.logFolder);
    for (const JobArray& array : arraysOf(options, build))
    {
        std::string name = "geofx";
        for (const std::string& stage : array.stages)
            name += (&stage == &array.stages.front() ? "-" : "+") + stage;
        std::vector<std::string> command = {
            "sbatch",
            "--parsable",
            "--job-name=" + name,
            "--requeue",
            "--open-mode=append",
            "--ntasks=1",
            "--cpus-per-task=1",
            "--output=" + (fs::path(build.logFolder) / "slurm-%A_%a.txt").string(),
            "--array=0-" + std::to_string(array.jobs - 1) + "%" + std::to_string(options.maxWorkers)};
        if (!options.partition.empty()) command.push_back("--partition=" + options.partition);
        if (!before.empty()) command.push_back("--dependency=afterok:" + before);
        command.push_back("--wrap=" + scriptOf(options, array));
        if (options.dryRun)
        {
            std::string line;
            for (const std::string& word : command)
                line += (line.empty() ? "" : " ") +
                        (word.find_first_of(" $'\"%;") == std::string::npos ? word : quoted(word));
            std::printf("%s\n", line.c_str());
            before = "JOB-" + array.stages.back();
            continue;
        }
        const auto result = slurm(command);
        before = result.standardOutput.substr(0, result.standardOutput.find_first_of(";\n"));
        if (result.exitCode != 0 || before.empty())
            throw BuildError("sbatch refuses the jobs of " + array.stages.front() + ": " +
                             result.standardError +
                             "What was submitted before waits for them; cancel it with scancel" +
                             (jobs.empty() ? "." : jobs + "."));
        jobs += " " + before;
        std::printf("%s: job %s, %llu %s\n", name.c_str(), before.c_str(),
                    static_cast<unsigned long long>(array.jobs), array.jobs == 1 ? "part" : "parts");
        std::ofstream(jobsFile(build), std::ios::app) << before << "\n";
    }
}

/// The last jobs that were submitted for a build, with commas between them.
std::string submittedJobs(const BuildStatus& build)
{
    std::string jobs;
    std::ifstream stream(jobsFile(build));
    for (std::string job; stream >> job;)
        jobs += (jobs.empty() ? "" : ",") + job;
    return jobs;
}

/// What Slurm says of the jobs: a line for each state.
void printSlurm(const BuildStatus& build)
{
    const std::string jobs = submittedJobs(build);
    if (jobs.empty()) return;
    const auto count = [](const std::vector<std::string>& command, const char* title)
    {
        geofx::ProgramResult result;
        try
        {
            result = geofx::runProgram(command);
        }
        catch (const std::system_error&)
        {
            std::printf("%s: %s is not here.\n", title, command.front().c_str());
            return;
        }
        if (result.exitCode != 0) return; // no accounting, or all jobs are forgotten already
        std::map<std::string, int> states;
        std::istringstream lines(result.standardOutput);
        for (std::string line; std::getline(lines, line);)
            if (!line.empty()) ++states[line.substr(0, line.find_last_not_of(' ') + 1)];
        for (const auto& [state, number] : states)
            std::printf("%s: %d × %s\n", title, number, state.c_str());
    };
    count({"squeue", "--noheader", "--array", "--jobs=" + jobs, "--format=%T %r"}, "squeue");
    count({"sacct", "--noheader", "--allocations", "--jobs=" + jobs, "--format=State%20"}, "sacct");
}

std::string timeInWords(double seconds)
{
    char text[40];
    if (seconds < 120.0)
        std::snprintf(text, sizeof(text), "%.1f s", seconds);
    else
        std::snprintf(text, sizeof(text), "%.0f min", seconds / 60.0);
    return text;
}

void printStatus(const Options& options)
{
    const BuildStatus build = osgGeoFX::readBuildStatus(options.folder);
    if (build.finished)
    {
        std::printf("%s/terrain.osgb: the database is finished.\n", options.folder.c_str());
        return;
    }
    std::printf("%-16s %21s %10s %10s %10s\n", "stage", "done", "a unit", "units/s", "remaining");
    for (const StageStatus& stage : build.stages)
    {
        const bool timed = stage.rate > 0.0;
        char rate[40] = "-";
        if (timed) std::snprintf(rate, sizeof(rate), "%.3g", stage.rate);
        const std::string done = std::to_string(stage.done) + "/" + std::to_string(stage.units);
        std::printf("%-16s %21s %10s %10s %10s\n", stage.name.c_str(), done.c_str(),
                    timed ? timeInWords(stage.unitSeconds).c_str() : "-", rate,
                    stage.done == stage.units ? "done"
                    : timed                   ? timeInWords(stage.remainingSeconds()).c_str()
                                              : "-");
    }
    for (const StageStatus& stage : build.stages)
    {
        for (const auto& each : stage.begun)
            std::printf(
                "%s: unit %llu of %s was begun %s ago by %s and is not done%s\n",
                stage.isSlow(each) ? "slow or killed" : "in work", static_cast<unsigned long long>(each.unit),
                stage.name.c_str(), timeInWords(each.seconds).c_str(), each.process.c_str(),
                stage.isSlow(each) ? (" (usual: " + timeInWords(stage.unitSeconds) + ").").c_str() : ".");
        for (const auto& each : stage.failed)
            std::printf("failed: unit %llu of %s: %s\n", static_cast<unsigned long long>(each.unit),
                        stage.name.c_str(), each.sentence.c_str());
    }
    printSlurm(build);
}

/// Writes a makefile to the standard output. Each part is a target; make does as many at once as -j says.
void printMakefile(const Options& options)
{
    const BuildStatus build = osgGeoFX::readBuildStatus(options.folder);
    const auto escaped = [](std::string text)
    {
        for (std::size_t at = 0; (at = text.find('$', at)) != std::string::npos; at += 2)
            text.insert(at, "$");
        return text;
    };
    std::printf("# The build planned in %s; run: make -j N -f THIS-FILE\n"
                "# A part that is killed is done again by the next make. Parts that are done take a moment.\n"
                ".PHONY: all\nall:\n",
                options.folder.c_str());
    std::string before;
    for (const JobArray& array : arraysOf(options, build))
    {
        const std::string name = array.stages.front();
        std::string parts;
        for (std::uint64_t part = 0; part < array.jobs; ++part)
        {
            const std::string target = name + "." + std::to_string(part);
            parts += " " + target;
            std::printf(".PHONY: %s\n%s: %s\n\t%s\n", target.c_str(), target.c_str(), before.c_str(),
                        escaped(builderLine(options, array, std::to_string(part))).c_str());
        }
        std::printf(".PHONY: %s\n%s:%s\n", name.c_str(), name.c_str(), parts.c_str());
        before = name;
    }
    std::printf("all: %s\n", before.c_str());
}

/// The builder of the same installation.
std::string builderBeside()
{
    std::error_code code;
    const fs::path self = fs::read_symlink("/proc/self/exe", code);
    const fs::path beside = self.parent_path() / "osggeofx_build";
    return !code && fs::exists(beside) ? beside.string() : "osggeofx_build";
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    options.builder = builderBeside();
    CLI::App app{"A build that was planned with osggeofx_build --plan, by many processes on a cluster or on "
                 "one machine",
                 "osggeofx_cluster"};
    app.require_subcommand(1);
    auto* submitting =
        app.add_subcommand("submit", "Submit the build to Slurm: an array of jobs for each stage");
    auto* status = app.add_subcommand("status", "How far the build is, what failed, and what is slow");
    auto* make = app.add_subcommand("make", "Print a makefile that builds on one machine, with make -j");
    for (auto* command : {submitting, status, make})
        command->add_option("DIR", options.folder, "The folder of the plan")->required();
    for (auto* command : {submitting, make})
    {
        command->add_option("--max-workers", options.maxWorkers, "Processes at once, at most")
            ->check(CLI::Range(1, 100000))
            ->capture_default_str();
        command
            ->add_option("--units-per-job", options.unitsPerJob,
                         "Units for each process; without it, jobs take about half a minute")
            ->check(CLI::Range(1, 1000000000));
        command->add_option("--memory", options.memoryMiB,
                            "Memory of each process for the data, MiB; without it, the plan's");
        command
            ->add_option("--builder", options.builder,
                         "The program osggeofx_build on the machines that build")
            ->type_name("FILE");
    }
    submitting->add_option("--partition", options.partition, "Slurm's partition")->type_name("NAME");
    submitting->add_flag("--dry-run", options.dryRun, "Print sbatch's command lines, and submit nothing");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try
    {
        options.folder = fs::absolute(options.folder).lexically_normal().string();
        if (submitting->parsed()) submit(options);
        if (status->parsed()) printStatus(options);
        if (make->parsed()) printMakefile(options);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::cerr << "osggeofx_cluster: " << error.what() << std::endl;
        return 2;
    }
}
