// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class BuildPlan;
struct TilePassResult;

/** A part of a build whose units do not need each other: any number of threads and processes do them, in any order. A
    unit needs the results of all stages before. It leaves its own in files that no other stage writes. Thus a unit may
    be done twice, even by two processes at once: they write the same bytes.

    begin() comes first, once in each process. Then takeOver() and run() may be called from several threads, for
    different units. */
class BuildStage
{
public:
    /// `name` is unique. `phase` is what progress reports call it.
    BuildStage(std::string name, std::string phase) : _name(std::move(name)), _phase(std::move(phase)) {}
    virtual ~BuildStage() = default;
    BuildStage(const BuildStage&) = delete;
    BuildStage& operator=(const BuildStage&) = delete;

    const std::string& name() const { return _name; }
    const std::string& phase() const { return _phase; }
    virtual std::size_t units() const = 0;
    /// Whether the stage has anything to do. This is known once the stages before are done.
    virtual bool isNeeded() const { return true; }
    /// Opens what the stages before have left.
    virtual void begin() {}
    /// The number of threads that fit into memory.
    virtual int threads(int wanted) const { return wanted; }
    /// Takes a unit over that an earlier process has done. Returns false if it must be done.
    virtual bool takeOver(std::size_t unit) = 0;
    /// Whether a unit that is not taken over has anything to do.
    virtual bool hasWork(std::size_t) const { return true; }
    /// Takes a unit over from the former database if this is an update and nothing that it is made from has changed.
    /// Returns false if it must be done.
    virtual bool keep(std::size_t) { return false; }
    /// Does a unit. `worker` counts the threads from 0. Throws BuildError.
    virtual void run(int worker, std::size_t unit) = 0;

private:
    const std::string _name, _phase;
};

using BuildStages = std::vector<std::unique_ptr<BuildStage>>;

/// Sampled heights, filled voids, and what upper tiers gather of them.
void addHeightStages(BuildPlan& plan, BuildStages& stages);
/// Finds and fills voids. They have nothing to do if no height is missing.
void addVoidStages(BuildPlan& plan, BuildStages& stages);
/// The rasters of shores.
void addGroundStages(BuildPlan& plan, BuildStages& stages);
/// The tiles' files. `result` gets the number of tiles that were taken over.
void addTileStages(BuildPlan& plan, BuildStages& stages, TilePassResult& result);
/// All stages of a build, in their order. The last one writes terrain.osgb.
BuildStages createStages(BuildPlan& plan, TilePassResult& result);

} // namespace osgGeoFX
