// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "plan/PicturePlan.h"
#include "process/CommandLine.h"

#include <osgGeoFX/batch/PathText.h>
#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/batch/WorkError.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace fs = std::filesystem;
using osgGeoFX::PathText;
using osgGeoFX::WorkError;
using osgGeoFX::WorkPlan;

namespace geofx::plan
{

namespace
{

constexpr const char* FORMAT = "osgGeoFX picture plan";
constexpr int VERSION = 1;

bool isOption(const std::string& argument, const std::string& option)
{
    return argument == option || argument.rfind(option + "=", 0) == 0;
}

} // namespace

CLI::Option* addOption(CLI::App& app, std::string& folder)
{
    return app
        .add_option(
            "--plan", folder,
            "Draw nothing yet: plan the pictures in DIR, for many processes; they lie there in the end. "
            "-o is a name alone. "
            "osggeofx_cluster runs the processes, each with --work DIR --unit STAGE:A-B or STAGE:I/N")
        ->type_name("DIR");
}

std::optional<Call> callOf(const std::string& program, int argc, char** argv, int& exitCode)
{
    Call call;
    call.arguments.assign(argv + 1, argv + argc);
    if (std::none_of(call.arguments.begin(), call.arguments.end(),
                     [](const std::string& each) { return isOption(each, "--unit"); }))
        return call;
    Worker worker;
    int threads = 0;
    CLI::App app("Does units of a plan.", program);
    app.add_option("--work", worker.folder, "The folder of the plan")->required()->type_name("DIR");
    app.add_option("--unit", worker.units, "Units A to B of a stage, or the part I, from 0, of N parts")
        ->required()
        ->type_name("STAGE:A-B|STAGE:I/N…");
    app.add_option("--threads", threads, "Threads of a driver that draws without a GPU (Mesa's llvmpipe)")
        ->check(CLI::Range(1, 1000));
    app.add_flag("--quiet", worker.quiet, "No summary");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        exitCode = exitCodeOf(app, error);
        return std::nullopt;
    }
    // What the environment says counts more.
    if (threads > 0) setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
    worker.folder = fs::absolute(worker.folder).lexically_normal().string();
    std::optional<PicturePlan> plan = PicturePlan::read(worker.folder, program);
    if (!plan)
    {
        if (!worker.quiet) std::printf("%s: all pictures are there.\n", worker.folder.c_str());
        exitCode = 0;
        return std::nullopt;
    }
    std::error_code code;
    fs::current_path(plan->workingFolder, code);
    if (code)
        throw WorkError(plan->workingFolder + ": the folder in which " + worker.folder +
                        " was planned is not here; plan in a folder that all machines have.");
    call.arguments = plan->arguments;
    call.units.emplace(std::move(worker), std::move(*plan));
    return call;
}

void PicturePlan::write(const std::string& folder) const
{
    double seconds = 0.0;
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const WorkPlan::Stage& stage : stages)
    {
        seconds += stage.seconds;
        list.push_back({{"name", stage.name}, {"units", stage.units}, {"seconds", stage.seconds}});
    }
    std::vector<std::string> words;
    for (const std::string& argument : arguments)
        words.push_back(PathText::of(argument));
    const nlohmann::ordered_json document = {{"format", FORMAT},
                                             {"version", VERSION},
                                             {"program", program},
                                             {"arguments", words},
                                             {"workingFolder", PathText::of(workingFolder)},
                                             {"madeOf", PathText::of(madeOf)},
                                             {"estimate", {{"seconds", seconds}}},
                                             {"stages", list}};
    const std::string file = WorkPlan::file(folder);
    const std::string text = document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    std::error_code code;
    fs::create_directories(fs::path(file).parent_path(), code);
    const int error = code ? code.value() : osgGeoFX::writeWholeFile(file, text.data(), text.size());
    if (error != 0)
        throw WorkError(file + ": cannot be written (" + std::generic_category().message(error) +
                        "); make the folder writable, or choose another with --plan.");
}

std::optional<PicturePlan> PicturePlan::read(const std::string& folder, const std::string& program)
{
    if (!WorkPlan::isIn(folder) && fs::exists(WorkPlan::finishedFile(folder)))
    {
        // Its last process may have been killed before the work files were gone.
        WorkPlan::finish(folder);
        return std::nullopt;
    }
    const std::string path = WorkPlan::file(folder);
    PicturePlan plan;
    // It says what is wrong with a plan that is missing or damaged.
    plan.stages = WorkPlan::read(folder).stages;
    try
    {
        std::ifstream stream(path);
        const nlohmann::json document = nlohmann::json::parse(stream);
        document.at("program").get_to(plan.program);
        if (plan.program != program)
            throw WorkError(path + ": this is a plan of " + plan.program + "; its units are done by " +
                            plan.program + " --work " + folder + ".");
        const int version = document.at("version").get<int>();
        if (version != VERSION)
            throw WorkError(path + ": the plan has version " + std::to_string(version) +
                            ", but this program reads version " + std::to_string(VERSION) +
                            "; use the program that has made it, or plan anew with --plan.");
        for (const nlohmann::json& word : document.at("arguments"))
            plan.arguments.push_back(PathText::path(word.get<std::string>()));
        plan.workingFolder = PathText::path(document.at("workingFolder").get<std::string>());
        plan.madeOf = PathText::path(document.at("madeOf").get<std::string>());
        return plan;
    }
    catch (const nlohmann::json::exception& error)
    {
        throw WorkError(path + ": the plan is damaged (" + error.what() + "); plan anew with --plan.");
    }
}

Division::Division(const std::string& program, const std::vector<std::string>& arguments,
                   const std::string& folder)
{
    if (folder.empty()) return;
    _planned = fs::absolute(folder).lexically_normal().string();
    std::error_code code;
    fs::create_directories(_planned, code);
    if (code || !fs::is_directory(_planned))
        throw WorkError(folder + ": the folder cannot be made (" +
                        (code ? code.message() : std::string("a file has this name")) +
                        "); choose another with --plan.");
    // A plan that was interrupted leaves work files alone.
    for (const auto& entry : fs::directory_iterator(_planned))
        if (entry.path() != WorkPlan::workFolder(_planned) || WorkPlan::isIn(_planned))
            throw WorkError(folder + ": the folder is not empty; choose another with --plan, or remove it. " +
                            "A plan that is there already goes on with osggeofx_cluster.");
    _plan.program = program;
    for (std::size_t i = 0; i < arguments.size(); ++i)
    {
        if (arguments[i] == "--plan")
            ++i;
        else if (!isOption(arguments[i], "--plan"))
            _plan.arguments.push_back(arguments[i]);
    }
}

std::string Division::workFile(const std::string& name) const
{
    return (fs::path(WorkPlan::workFolder(folder())) / name).string();
}

std::string Division::outputOf(const std::string& option) const
{
    if (!any()) return option;
    if (fs::path(option).filename() != fs::path(option))
        throw WorkError("-o " + option + ": with --plan, pictures lie in the folder of the plan; give -o " +
                        fs::path(option).filename().string() + ", a name alone.");
    return (fs::path(folder()) / option).string();
}

void Division::run(const osgGeoFX::WorkStages& stages, const std::string& madeOf,
                   const std::vector<double>& seconds) const
{
    if (!_worker)
    {
        PicturePlan plan = _plan;
        plan.workingFolder = fs::current_path().string();
        plan.madeOf = madeOf;
        for (std::size_t i = 0; i < stages.size(); ++i)
            plan.stages.push_back({stages[i]->name(), stages[i]->units(), seconds[i]});
        plan.write(_planned);
        std::printf("%s: planned: %llu %s.\n", _planned.c_str(),
                    static_cast<unsigned long long>(plan.stages.front().units),
                    plan.stages.front().name.c_str());
        return;
    }
    if (_plan.madeOf != madeOf)
        throw WorkError(
            WorkPlan::file(_worker->folder) +
            ": the pictures were planned of other files than there are now (planned: " + _plan.madeOf +
            "; now: " + madeOf + "); put back what was changed, or plan anew with --plan.");
    for (std::size_t i = 0; i < std::max(stages.size(), _plan.stages.size()); ++i)
        if (i >= stages.size() || i >= _plan.stages.size() || stages[i]->name() != _plan.stages[i].name ||
            stages[i]->units() != _plan.stages[i].units)
            throw WorkError(
                WorkPlan::file(_worker->folder) +
                ": this program divides the pictures otherwise than the one that planned them; use "
                "that one, or plan anew with --plan.");
    const osgGeoFX::BuiltUnits result = osgGeoFX::doUnits(_worker->folder, stages, _worker->units, {});
    if (result.finished) WorkPlan::finish(_worker->folder);
    if (_worker->quiet) return;
    std::printf("%s: %llu units are drawn, %llu were there.\n", _worker->folder.c_str(),
                static_cast<unsigned long long>(result.built),
                static_cast<unsigned long long>(result.takenOver));
    if (result.finished) std::printf("%s: all pictures are there.\n", _worker->folder.c_str());
}

osgGeoFX::WorkStages printStages(std::unique_ptr<osgGeoFX::PicturePrint> print, int tiles,
                                 std::function<void()> putTogether)
{
    const std::shared_ptr<std::unique_ptr<osgGeoFX::PicturePrint>> held =
        std::make_shared<std::unique_ptr<osgGeoFX::PicturePrint>>(std::move(print));
    osgGeoFX::WorkStages stages;
    stages.push_back(std::make_unique<PictureStage>(
        "tiles", static_cast<std::size_t>(tiles),
        [held](std::size_t tile) { return (*held)->isDrawn(static_cast<int>(tile)); },
        [held](std::size_t tile)
        {
            std::string error;
            if (!(*held)->draw(static_cast<int>(tile), error)) throw std::runtime_error(error);
        }));
    stages.push_back(std::make_unique<PictureStage>(
        "picture", 1, [](std::size_t) { return false; },
        [held, putTogether = std::move(putTogether)](std::size_t)
        {
            held->reset();
            putTogether();
        }));
    return stages;
}

} // namespace geofx::plan
