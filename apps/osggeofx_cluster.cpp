// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_cluster: a planned work under Slurm or make, how far it is, and how long it would take. Slurm and make do the
// scheduling.
#include "cluster/Jobs.h"
#include "cluster/Prediction.h"
#include "process/CommandLine.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/batch/WorkError.h>
#include <osgGeoFX/terrain/DistributedBuild.h>
#include <process/RunProgram.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <system_error>

namespace
{

namespace fs = std::filesystem;
using geofx::cluster::JobArray;
using geofx::cluster::MeasuredTimes;
using osgGeoFX::StageStatus;
using osgGeoFX::WorkError;
using osgGeoFX::WorkStatus;

// Slurm's usual limit of an array (MaxArraySize) is 1001.
constexpr std::uint64_t MOST_OF_AN_ARRAY = 1000;
// So often a job whose process was killed tries again at once, and then elsewhere.
constexpr int TRIES = 5, REQUEUES = 3;
// A prediction is the median of so many draws.
constexpr std::uint64_t DRAWS = 9;

struct Options
{
    std::string folder, partition, builder, until;
    geofx::cluster::JobOptions jobs;
    int memoryMiB = 0;
    bool dryRun = false;
    // Of a prediction.
    std::vector<std::uint64_t> workers;
    std::vector<double> cores;
    std::string times, save;
};

/// A text as one word of a shell's command line.
std::string quoted(const std::string& text)
{
    std::string result = "'";
    for (const char letter : text)
        result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return result + "'";
}

WorkStatus statusOf(const Options& options)
{
    // Of a database that is finished, nothing but itself tells.
    if (fs::exists(fs::path(options.folder) / "terrain.osgb"))
        return osgGeoFX::readBuildStatus(options.folder);
    return osgGeoFX::readWorkStatus(options.folder);
}

/// What is finished, as a sentence without its end.
std::string finished(const Options& options)
{
    const fs::path database = fs::path(options.folder) / "terrain.osgb";
    return fs::exists(database) ? database.string() + ": the database is finished"
                                : options.folder + ": the pictures are finished";
}

/// The arrays that are asked for.
std::vector<JobArray> arraysOf(const Options& options, WorkStatus work)
{
    if (!options.until.empty())
    {
        const auto last = std::find_if(work.stages.begin(), work.stages.end(),
                                       [&](const StageStatus& each) { return each.name == options.until; });
        if (last == work.stages.end())
            throw WorkError("--until " + options.until + ": the plan has no such stage; status lists them.");
        work.stages.erase(last + 1, work.stages.end());
    }
    return geofx::cluster::arraysOf(options.jobs, work);
}

/// The program that does the units, of the same installation unless it was named.
std::string programOf(const Options& options, const WorkStatus& work)
{
    if (!options.builder.empty()) return options.builder;
    std::error_code code;
    const fs::path self = fs::read_symlink("/proc/self/exe", code);
    const fs::path beside = self.parent_path() / work.program;
    return !code && fs::exists(beside) ? beside.string() : work.program;
}

/// `part`: its number, as the shell has it.
std::string workerLine(const Options& options, const WorkStatus& work, const JobArray& array,
                       const std::string& part)
{
    if (options.memoryMiB > 0 && work.program != "osggeofx_build")
        throw WorkError("--memory: " + work.program + " has no such limit; leave it out.");
    std::string line = quoted(programOf(options, work)) + " --quiet --threads 1";
    if (options.memoryMiB > 0) line += " --memory " + std::to_string(options.memoryMiB);
    line += " --work " + quoted(options.folder) + " --unit";
    const std::string share = ":" + part + "/" + std::to_string(array.jobs);
    for (const std::string& stage : array.stages)
    {
        line += " ";
        line += stage;
        line += share;
    }
    return line;
}

/// The numbers of the jobs that were submitted for a work.
std::string jobsFile(const WorkStatus& work)
{
    return (fs::path(work.logFolder) / "slurm-jobs").string();
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
        throw WorkError(
            arguments.front() +
            ": this program of Slurm is not here; run osggeofx_cluster on a machine of the cluster, or build "
            "with `osggeofx_cluster make` on this one.");
    }
}

/// What a job does. If its process is killed, it tries again: units that are done stay done. Then it is queued again, by
/// Slurm, for another machine may do better. Errors that have a sentence (1, 2) would come again.
std::string scriptOf(const Options& options, const WorkStatus& work, const JobArray& array,
                     std::uint64_t firstPart)
{
    const std::string part = firstPart == 0 ? "$SLURM_ARRAY_TASK_ID"
                                            : "$((SLURM_ARRAY_TASK_ID + " + std::to_string(firstPart) + "))";
    return "for try in $(seq " + std::to_string(TRIES) + "); do " + workerLine(options, work, array, part) +
           "; code=$?; [ $code -le 2 ] && exit $code; echo \"The process ended with $code.\"; done; "
           "[ \"${SLURM_RESTART_COUNT:-0}\" -lt " +
           std::to_string(REQUEUES) +
           " ] && echo \"The job is queued again.\" && scontrol requeue $SLURM_JOB_ID && sleep 60; exit "
           "$code";
}

/// Submits an array, or prints the command. Returns the job's number.
std::string submitArray(const Options& options, const std::vector<std::string>& command,
                        const std::string& name, const std::string& submitted)
{
    if (options.dryRun)
    {
        std::string line;
        for (const std::string& word : command)
            line += (line.empty() ? "" : " ") +
                    (word.find_first_of(" $'\"%;") == std::string::npos ? word : quoted(word));
        std::printf("%s\n", line.c_str());
        return "JOB-" + name;
    }
    const auto result = slurm(command);
    std::string job = result.standardOutput.substr(0, result.standardOutput.find_first_of(";\n"));
    if (result.exitCode != 0 || job.empty())
        throw WorkError("sbatch refuses the jobs of " + name + ": " + result.standardError +
                        "What was submitted before waits for them; cancel it with scancel" +
                        (submitted.empty() ? "." : submitted + "."));
    return job;
}

void submit(const Options& options)
{
    const WorkStatus work = statusOf(options);
    if (work.finished)
    {
        std::printf("%s; nothing is submitted.\n", finished(options).c_str());
        return;
    }
    std::string before, submitted;
    if (!options.dryRun) fs::create_directories(work.logFolder);
    for (const JobArray& array : arraysOf(options, work))
    {
        std::string name = "geofx", jobs;
        for (const std::string& stage : array.stages)
            name += (&stage == &array.stages.front() ? "-" : "+") + stage;
        // Those that are too many for one array of Slurm's are in several, side by side.
        const std::uint64_t count = (array.jobs + MOST_OF_AN_ARRAY - 1) / MOST_OF_AN_ARRAY;
        const std::uint64_t atOnce = std::max<std::uint64_t>(options.jobs.maxWorkers / count, 1);
        for (std::uint64_t i = 0; i < count; ++i)
        {
            const std::uint64_t first = i * MOST_OF_AN_ARRAY;
            const std::uint64_t size = std::min(MOST_OF_AN_ARRAY, array.jobs - first);
            std::vector<std::string> command = {
                "sbatch", "--parsable", "--job-name=" + name, "--requeue", "--open-mode=append", "--ntasks=1",
                "--cpus-per-task=1",
                // Jobs behind one that fails would wait for ever.
                "--kill-on-invalid-dep=yes",
                "--output=" + (fs::path(work.logFolder) / "slurm-%A_%a.txt").string(),
                "--array=0-" + std::to_string(size - 1) + "%" + std::to_string(atOnce)};
            if (!options.partition.empty()) command.push_back("--partition=" + options.partition);
            if (!before.empty()) command.push_back("--dependency=afterok" + before);
            command.push_back("--wrap=" + scriptOf(options, work, array, first));
            const std::string job = submitArray(options, command, array.stages.back(), submitted);
            jobs += ":" + job;
            if (options.dryRun) continue;
            submitted += " " + job;
            std::printf("%s: job %s, %llu %s\n", name.c_str(), job.c_str(),
                        static_cast<unsigned long long>(size), size == 1 ? "part" : "parts");
            std::ofstream(jobsFile(work), std::ios::app) << job << "\n";
        }
        before = jobs;
    }
}

/// The jobs that were submitted for a work, with commas between them.
std::string submittedJobs(const WorkStatus& work)
{
    std::string jobs;
    std::ifstream stream(jobsFile(work));
    for (std::string job; stream >> job;)
        jobs += (jobs.empty() ? "" : ",") + job;
    return jobs;
}

/// What Slurm says of the jobs: a line for each state. Returns whether there were jobs and none is left.
bool printSlurm(const WorkStatus& work)
{
    const std::string jobs = submittedJobs(work);
    if (jobs.empty()) return false;
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
            return false;
        }
        if (result.exitCode != 0)
        {
            // Jobs that ended long ago are forgotten.
            if (result.standardError.find("Invalid job id") != std::string::npos) return true;
            std::printf("%s does not answer: %s\n", title, result.standardError.c_str());
            return false;
        }
        std::map<std::string, int> states;
        std::istringstream lines(result.standardOutput);
        for (std::string line; std::getline(lines, line);)
            if (!line.empty()) ++states[line.substr(0, line.find_last_not_of(' ') + 1)];
        for (const auto& [state, number] : states)
            std::printf("%s: %d × %s\n", title, number, state.c_str());
        return states.empty();
    };
    const bool none =
        count({"squeue", "--noheader", "--array", "--jobs=" + jobs, "--format=%T %r"}, "squeue");
    count({"sacct", "--noheader", "--allocations", "--jobs=" + jobs, "--format=State%20"}, "sacct");
    return none;
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
    const WorkStatus work = statusOf(options);
    if (work.finished)
    {
        std::printf("%s.\n", finished(options).c_str());
        return;
    }
    std::printf("%-16s %21s %10s %10s %10s\n", "stage", "done", "a unit", "units/s", "remaining");
    for (const StageStatus& stage : work.stages)
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
    for (const StageStatus& stage : work.stages)
    {
        std::map<std::uint64_t, int> times;
        for (const auto& each : stage.begun)
            ++times[each.unit];
        for (const auto& [unit, number] : times)
            if (number >= TRIES)
                std::printf(
                    "unit %llu of %s was begun %d times and is not done: is there enough memory for its "
                    "process?\n",
                    static_cast<unsigned long long>(unit), stage.name.c_str(), number);
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
    // The last job may have ended just now.
    if (printSlurm(work) && !statusOf(options).finished)
        std::printf(
            "No job of this work is left in Slurm's queue. What is missing is done by submitting again: "
            "osggeofx_cluster submit %s\n",
            quoted(options.folder).c_str());
}

/// Writes a makefile to the standard output. Each part is a target; make does as many at once as -j says.
void printMakefile(const Options& options)
{
    const WorkStatus work = statusOf(options);
    if (work.finished) throw WorkError(finished(options) + "; nothing is left to make.");
    const auto escaped = [](std::string text)
    {
        for (std::size_t at = 0; (at = text.find('$', at)) != std::string::npos; at += 2)
            text.insert(at, "$");
        return text;
    };
    // All of it or nothing, since a file may be made of it.
    std::ostringstream text;
    text << "# The work planned in " << options.folder << "; run: make -j N -f THIS-FILE\n"
         << "# A part that is killed is done again by the next make. Parts that are done take a moment.\n"
            ".PHONY: all\nall:\n";
    std::string before;
    for (const JobArray& array : arraysOf(options, work))
    {
        const std::string name = array.stages.front();
        std::string parts;
        for (std::uint64_t part = 0; part < array.jobs; ++part)
        {
            const std::string target = name + "." + std::to_string(part);
            parts += " " + target;
            text << ".PHONY: " << target << "\n"
                 << target << ": " << before << "\n\t"
                 << escaped(workerLine(options, work, array, std::to_string(part))) << "\n";
        }
        text << ".PHONY: " << name << "\n" << name << ":" << parts << "\n";
        before = name;
    }
    text << "all: " << before << "\n";
    std::fputs(text.str().c_str(), stdout);
}

/// Tells how long the whole work would take.
void predict(Options options)
{
    WorkStatus work = statusOf(options);
    if (work.finished)
        throw WorkError(options.folder + ": the work is finished; plan it in another folder to predict it.");
    const std::string source = options.times.empty() ? options.folder : options.times;
    if (!options.save.empty())
    {
        osgGeoFX::InputFiles inputs;
        inputs.add(osgGeoFX::WorkPlan::workFolder(options.folder));
        inputs.add(fs::is_directory(source) ? osgGeoFX::WorkPlan::workFolder(source) : source);
        inputs.claim("The file of times", options.save, "--save");
    }
    const MeasuredTimes times = MeasuredTimes::read(source);
    if (times.stages.empty())
        throw WorkError(source + ": no times were measured; do some units first, or give --times.");
    if (!options.save.empty()) times.write(options.save);
    std::string missing;
    for (StageStatus& stage : work.stages)
    {
        stage.done = 0;
        if (!times.like(stage.name)) missing += (missing.empty() ? "" : ", ") + stage.name;
    }
    if (!missing.empty())
        std::printf("No times were measured of %s; they count as nothing.\n", missing.c_str());
    std::printf(
        "A process takes %.3f s to its first unit (%.3f s of CPU) and begins %.3f s after the one before "
        "it; a stage, %.3f s after the one before.\n",
        times.startWall, times.startCpu, times.betweenJobs, times.betweenStages);
    // One worker on one core is what speed is compared with.
    struct Row
    {
        double cores;
        std::uint64_t workers;
    };
    std::vector<Row> rows = {{1.0, 1}};
    for (const double cores : options.cores)
        if (options.workers.empty()) rows.push_back({cores, static_cast<std::uint64_t>(cores)});
    for (const std::uint64_t workers : options.workers)
        rows.push_back({options.cores.front(), workers});
    std::printf("%10s %10s %10s %14s %14s %14s %10s %11s\n", "cores", "workers", "jobs", "seconds", "least",
                "most", "speed-up", "efficiency");
    double single = 0.0;
    for (const Row& row : rows)
    {
        options.jobs.maxWorkers = row.workers;
        const std::vector<JobArray> arrays = arraysOf(options, work);
        std::uint64_t jobs = 0;
        for (const JobArray& array : arrays)
            jobs += array.jobs;
        std::vector<double> seconds;
        for (std::uint64_t seed = 1; seed <= DRAWS; ++seed)
            seconds.push_back(geofx::cluster::predict(work, arrays, times, {row.workers, row.cores}, seed));
        std::sort(seconds.begin(), seconds.end());
        const double middle = seconds[DRAWS / 2];
        if (&row == &rows.front())
        {
            single = middle;
            continue;
        }
        std::printf("%10.10g %10llu %10llu %14.1f %14.1f %14.1f %10.1f %9.0f %%\n", row.cores,
                    static_cast<unsigned long long>(row.workers), static_cast<unsigned long long>(jobs),
                    middle, seconds.front(), seconds.back(), single / middle,
                    100.0 * single / middle / std::min(row.cores, static_cast<double>(row.workers)));
    }
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    CLI::App app{
        "A work that was planned with --plan of osggeofx_build, osggeofx_render or osggeofx_panorama: "
        "by many processes on a cluster or on one machine",
        "osggeofx_cluster"};
    app.require_subcommand(1);
    auto* submitting =
        app.add_subcommand("submit", "Submit the work to Slurm: an array of jobs for each stage");
    auto* status = app.add_subcommand("status", "How far the work is, what failed, and what is slow");
    auto* make = app.add_subcommand("make", "Print a makefile for one machine, for make -j");
    auto* predicting = app.add_subcommand(
        "predict", "How long the whole work would take, from the times of units that are done");
    for (auto* command : {submitting, status, make, predicting})
        command->add_option("DIR", options.folder, "The folder of the plan")->required();
    for (auto* command : {submitting, make})
    {
        command->add_option("--max-workers", options.jobs.maxWorkers, "Processes at once, at most")
            ->check(CLI::Range(1, 100000))
            ->capture_default_str();
        command->add_option("--memory", options.memoryMiB,
                            "Memory of each process for the data, MiB; without it, the plan's");
        command
            ->add_option("--builder", options.builder,
                         "The program that does the units, on the machines that do them")
            ->type_name("FILE");
    }
    for (auto* command : {submitting, make, predicting})
    {
        command
            ->add_option("--units-per-job", options.jobs.unitsPerJob,
                         "Units for each process; without it, jobs take about half a minute")
            ->check(CLI::Range(1, 1000000000));
        command->add_option("--until", options.until, "The last stage; without it, all")->type_name("STAGE");
    }
    submitting->add_option("--partition", options.partition, "Slurm's partition")->type_name("NAME");
    submitting->add_flag("--dry-run", options.dryRun, "Print sbatch's command lines, and submit nothing");
    for (double number = 1.0; number <= 4096.0; number *= 2.0)
        options.cores.push_back(number);
    auto* cores =
        predicting
            ->add_option(
                "--cores", options.cores,
                "Numbers of cores, such as 1,2,4; each with as many workers, unless --workers says how "
                "many (1 to 4096)")
            ->delimiter(',')
            ->check(CLI::Range(1.0, 1e6));
    predicting
        ->add_option("--workers", options.workers,
                     "Numbers of processes at once, which share the cores: then --cores is one number")
        ->delimiter(',')
        ->check(CLI::Range(1, 1000000))
        ->needs(cores);
    predicting
        ->add_option(
            "--times", options.times,
            "The times of another work with units of the same kinds: the folder of its plan, or a file "
            "of --save; without it, those of DIR")
        ->type_name("DIR|FILE");
    predicting->add_option("--save", options.save, "Write the times that were measured to a file")
        ->type_name("FILE");
    try
    {
        app.parse(argc, argv);
        if (!options.workers.empty() && options.cores.size() != 1)
            throw CLI::ValidationError("--workers", "--cores must be one number then");
    }
    catch (const CLI::ParseError& error)
    {
        return geofx::exitCodeOf(app, error);
    }
    try
    {
        options.folder = fs::absolute(options.folder).lexically_normal().string();
        if (submitting->parsed()) submit(options);
        if (status->parsed()) printStatus(options);
        if (make->parsed()) printMakefile(options);
        if (predicting->parsed()) predict(options);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::cerr << "osggeofx_cluster: " << error.what() << std::endl;
        return 2;
    }
}
