// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/print/PicturePrint.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI
{
class App;
class Option;
} // namespace CLI

/// Pictures that many processes draw: --plan, and --work with --unit.
namespace geofx::plan
{

/// A call such as `osggeofx_render --work DIR --unit frames:0/8`.
struct Worker
{
    std::string folder;
    std::vector<std::string> units;
    bool quiet = false;
};

/// Adds --plan to a program. `folder` gets the plan's folder; empty: none.
CLI::Option* addOption(CLI::App& app, std::string& folder);

/** The plan of a film or a print, in the folder of the pictures: the command line that was planned, and the stages. A worker
    reads it and does as the command line says, but only its units. All of it throws std::runtime_error with a sentence. */
struct PicturePlan
{
    std::string program;
    std::vector<std::string> arguments; ///< without --plan
    std::string workingFolder;          ///< where the program was called; relative names are relative to it
    /// Files that the pictures are made of, and their ages. Other files make other pictures.
    std::string madeOf;
    std::vector<osgGeoFX::WorkPlan::Stage> stages;

    /// Makes the folder, which must be empty, and writes the plan.
    void write(const std::string& folder) const;
    /// Empty if the work is finished.
    static std::optional<PicturePlan> read(const std::string& folder, const std::string& program);
};

/// What a program does with its command line where it has a plan, or is called to do units of one.
class Division
{
public:
    /// Nothing is divided.
    Division() = default;
    /// A plan of the command line in a folder, which is made and must be empty; or nothing is divided, if `folder` is empty.
    Division(const std::string& program, const std::vector<std::string>& arguments,
             const std::string& folder);
    /// Units of a plan.
    Division(Worker worker, PicturePlan plan) : _worker(std::move(worker)), _plan(std::move(plan)) {}

    bool any() const { return _worker.has_value() || !_planned.empty(); }
    /// The folder of the pictures and the plan; empty if nothing is divided.
    std::string folder() const { return _worker ? _worker->folder : _planned; }
    bool plans() const { return !_planned.empty(); }
    /// A file or folder of this name among the work files, if something is divided.
    std::string workFile(const std::string& name) const;
    /// Where the files of a print's tiles are until it is there, if something is divided.
    std::string tileFolder() const { return workFile("tiles"); }
    /// What a plan's workers are called with, in the place of the program's own arguments.
    void setArguments(std::vector<std::string> arguments) { _plan.arguments = std::move(arguments); }
    /// The file that -o means: with a plan, it is a name alone.
    std::string outputOf(const std::string& option) const;

    /** Writes the plan, or does the worker's units. `madeOf`: the files that the pictures are made of, for comparison. `seconds`: of all units of
        a stage, about, by stage. */
    void run(const osgGeoFX::WorkStages& stages, const std::string& madeOf,
             const std::vector<double>& seconds) const;

private:
    std::optional<Worker> _worker;
    std::string _planned;
    PicturePlan _plan;
};

/// A command line to go by, and whose units it is to do.
struct Call
{
    std::vector<std::string> arguments;
    std::optional<Division> units; ///< of the plan that `arguments` are from
};
/** What a program is called to do. A call with --unit has other options than any other one: its arguments are those of the plan, whose
    folder becomes the current one. Empty if nothing is left to do but to end with `exitCode`. */
std::optional<Call> callOf(const std::string& program, int argc, char** argv, int& exitCode);

/// The stages of a print: its tiles, and what puts them together. `print` draws the tiles; it is gone when these are put together, since a
/// scene has one renderer at a time.
osgGeoFX::WorkStages printStages(std::unique_ptr<osgGeoFX::PicturePrint> print, int tiles,
                                 std::function<void()> putTogether);

/// A stage by its functions.
class PictureStage : public osgGeoFX::WorkStage
{
public:
    /// `isDone` and `draw` get the unit.
    PictureStage(const std::string& name, std::size_t units, std::function<bool(std::size_t)> isDone,
                 std::function<void(std::size_t)> draw)
        : WorkStage(name, "pictures"), _units(units), _isDone(std::move(isDone)), _draw(std::move(draw))
    {
    }
    std::size_t units() const override { return _units; }
    int threads(int) const override { return 1; }
    bool takeOver(std::size_t unit) override { return _isDone(unit); }
    void run(int, std::size_t unit) override { _draw(unit); }

private:
    const std::size_t _units;
    const std::function<bool(std::size_t)> _isDone;
    const std::function<void(std::size_t)> _draw;
};

} // namespace geofx::plan
