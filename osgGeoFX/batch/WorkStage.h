// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** A part of a work whose units do not need each other: any number of threads and processes do them, in any order. A
    unit needs the results of all stages before. It leaves its own in files that no other stage writes. Thus a unit may
    be done twice, even by two processes at once: they write the same bytes.

    begin() comes first, before each range of units, on one thread. Then takeOver(), hasWork(), keep() and run() may be
    called from several threads, for different units.
    @ingroup batch */
class OSGGEOFX_EXPORT WorkStage
{
public:
    /// `name` is unique in a work. `phase` is what progress reports call it.
    WorkStage(std::string name, std::string phase) : _name(std::move(name)), _phase(std::move(phase)) {}
    virtual ~WorkStage();
    WorkStage(const WorkStage&) = delete;
    WorkStage& operator=(const WorkStage&) = delete;

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
    /// Takes a unit over from a former result if nothing that it is made from has changed. Returns false if it must be
    /// done.
    virtual bool keep(std::size_t) { return false; }
    /// Does a unit. `worker` counts the threads from 0. Throws what is derived from std::runtime_error, with a sentence.
    virtual void run(int worker, std::size_t unit) = 0;

private:
    const std::string _name, _phase;
};

/// In their order.
using WorkStages = std::vector<std::unique_ptr<WorkStage>>;

} // namespace osgGeoFX
