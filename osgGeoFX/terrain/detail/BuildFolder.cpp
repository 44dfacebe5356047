// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildFolder.h>

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/KeptFiles.h>
#include <osgGeoFX/terrain/detail/PlanFile.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// The file that says that all files are ready, and what else is to be done.
constexpr const char* COMMIT_FILE = "commit";
constexpr const char *KEEP = "keep", *KEEP_NOTHING = "keep nothing";
/// The folders of work files that updates need.
constexpr const char* KEPT_WORK[] = {"facts", "facts-filled", "roots", "roots-filled", "tiles", UNIT_RECORDS};

bool isLeftover(const fs::path& path)
{
    return path.extension() == TEMPORARY_ENDING;
}

[[noreturn]] void failToRemove(const fs::path& path, const std::error_code& code)
{
    throw BuildError(path.string() + ": the old database cannot be removed (" + code.message() +
                     "); make the folder writable, or choose another with -o.");
}

void removeAll(const fs::path& path)
{
    std::error_code code;
    fs::remove_all(path, code);
    if (code) failToRemove(path, code);
}

/// Moves a file or a folder. Another process may have done so already.
void move(const fs::path& from, const fs::path& to)
{
    std::error_code code;
    fs::create_directories(to.parent_path(), code);
    if (code) failToWrite(to.string(), code.value());
    fs::rename(from, to, code);
    if (code && fs::exists(from)) failToWrite(to.string(), code.value());
}

/// The files below a folder. Those of deeper levels come first, whose folders have the level's number as their name.
std::vector<fs::path> deepestFirst(const fs::path& folder)
{
    std::vector<std::pair<int, fs::path>> found;
    std::error_code code;
    for (fs::recursive_directory_iterator entry(folder, code), end; !code && entry != end;
         entry.increment(code))
        if (entry->is_regular_file(code) && !isLeftover(entry->path()))
        {
            const fs::path name = fs::relative(entry->path(), folder);
            found.emplace_back(std::atoi(name.begin()->c_str()), name);
        }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<fs::path> result;
    for (auto& [level, name] : found)
        result.push_back(std::move(name));
    return result;
}

/// Makes sure that no source is removed with the former database. Throws WorkError.
void keepSources(const BuildPlan& plan)
{
    const BuildOptions& options = plan.options;
    InputFiles inputs;
    for (const auto* const files : {&options.dems, &options.imagery})
        for (const std::string& file : *files)
            inputs.add(file);
    for (const std::string& file : {options.landCover, options.landCoverTable, options.treeCover})
        inputs.add(file);
    const fs::path folder = options.output;
    for (const char* part : {"terrain.osgb", ORIGIN_FILE, "tiles", "work", "kept", "buildings"})
        inputs.claimFolder("The database's", (folder / part).string(), "-o");
}

/// What updates need becomes `kept`, in the place of what the former build has left.
void replaceKept(const fs::path& database)
{
    const fs::path work = workFolderOf(database), next = work / "kept", former = work / "former-kept",
                   kept = keptFolderOf(database);
    for (const char* name : KEPT_WORK)
        if (fs::exists(work / name)) move(work / name, next / name);
    // Another process was here, or it was done before the interruption.
    if (!fs::exists(next / UNIT_RECORDS)) return;
    std::error_code code;
    fs::remove_all(former, code);
    fs::rename(kept, former, code);
    fs::rename(next, kept, code);
    // Another process was as far.
    if (code && !fs::exists(kept)) fs::rename(former, kept, code);
}

} // namespace

std::shared_ptr<const FolderLock> lockFolder(const fs::path& folder, FolderLock::Kind kind)
{
    return sayAsBuildError([&] { return std::make_shared<const FolderLock>(folder.string(), kind, "-o"); });
}

std::uint64_t bytesBelow(const fs::path& folder)
{
    std::uint64_t bytes = 0;
    std::error_code code;
    for (fs::recursive_directory_iterator entry(folder, code), end; !code && entry != end;
         entry.increment(code))
        if (entry->is_regular_file(code)) bytes += entry->file_size();
    return bytes;
}

std::string heightRange(const BuildPlan& plan)
{
    const TileFacts& whole = plan.whole();
    return CPLSPrintf("%.9g to %.9g m", static_cast<double>(whole.minHeight),
                      static_cast<double>(whole.maxHeight));
}

std::string readText(const fs::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

fs::path workFolderOf(const fs::path& database)
{
    return WorkPlan::workFolder(database.string());
}

fs::path keptFolderOf(const fs::path& database)
{
    return database / "kept";
}

fs::path stagedFolderOf(const fs::path& database)
{
    return workFolderOf(database) / "new";
}

void joinBuild(BuildPlan& plan)
{
    plan.staged = fs::exists(workFolderOf(plan.options.output) / ORIGIN_FILE);
    plan.kept =
        plan.staged && KeptFiles::obstacle(plan).empty() ? std::make_shared<KeptFiles>(plan) : nullptr;
}

FolderState prepareFolder(BuildPlan& plan)
{
    const fs::path folder = plan.options.output, work = workFolderOf(folder);
    const fs::path origin = folder / ORIGIN_FILE, root = folder / "terrain.osgb",
                   pending = work / ORIGIN_FILE;
    std::error_code code;
    fs::create_directories(folder, code);
    if (code || !fs::is_directory(folder))
        throw BuildError(folder.string() + ": the folder cannot be made (" +
                         (code ? code.message() : std::string("a file has this name")) +
                         "); choose another with -o.");
    sayAsBuildError([&] { keepSources(plan); });
    plan.folderLock = lockFolder(folder, FolderLock::ALONE);
    completeFolder(folder);
    // A kill in its very first moments leaves only the origin's temporary file.
    for (const auto& entry : fs::directory_iterator(folder, code))
        if (isLeftover(entry.path()) && entry.path().filename().string().rfind(ORIGIN_FILE, 0) == 0)
            fs::remove(entry.path(), code);
    const bool ours = readText(origin).rfind(ORIGIN_BEGIN, 0) == 0;
    if (!ours && !fs::is_empty(folder))
        throw BuildError(
            folder.string() +
            ": the folder holds other files, which a build would mix with its own; choose an empty one "
            "with -o.");
    const bool hasRoot = ours && fs::exists(root), same = ours && readText(origin) == plan.fingerprint;
    FolderState state;
    if (same && (plan.options.resume || (plan.options.update && hasRoot)))
    {
        // Another update may have been begun, or its work files left.
        if (hasRoot) removeAll(work);
        state.finished = hasRoot;
        return state;
    }
    state.update = hasRoot && plan.options.resume && readText(pending) == plan.fingerprint;
    if (ours && plan.options.resume && !state.update)
        throw BuildError(
            folder.string() +
            ": the build that was begun here has other sources or options; repeat it with those, or "
            "leave out --resume.");
    if (!state.update && hasRoot && plan.options.update)
    {
        removeAll(work);
        writeFileAtomically(pending.string(), plan.fingerprint.data(), plan.fingerprint.size());
        state.update = true;
    }
    if (state.update)
    {
        state.allBecause = KeptFiles::obstacle(plan);
        joinBuild(plan);
        return state;
    }
    // The root first: without it, what is left of an old database does not look whole. Then the work files: with
    // them, tiles that are removed already would count as done when a kill here is followed by --resume.
    for (const fs::path& old : {root, work, keptFolderOf(folder), folder / "tiles"})
        removeAll(old);
    writeFileAtomically(origin.string(), plan.fingerprint.data(), plan.fingerprint.size());
    return state;
}

void finishFolder(const BuildPlan& plan, const std::vector<std::string>& obsolete)
{
    const fs::path work = plan.workFolder(), staged = stagedFolderOf(plan.options.output);
    const auto write = [](const fs::path& path, const std::string& text)
    {
        writeFileAtomically(path.string(), text.data(), text.size());
    };
    if (plan.staged) write(staged / ORIGIN_FILE, plan.fingerprint);
    if (plan.options.keep)
    {
        write(work / "kept" / COMMON_FILE, plan.common);
        write(work / "kept" / ORIGIN_FILE, plan.fingerprint);
        write(work / "kept" / RANGE_FILE, heightRange(plan));
    }
    std::string commit = std::string(plan.options.keep ? KEEP : KEEP_NOTHING) + "\n";
    for (const std::string& name : obsolete)
        commit += name + "\n";
    write(work / COMMIT_FILE, commit);
}

void completeFolder(const fs::path& database)
{
    const fs::path work = workFolderOf(database), staged = stagedFolderOf(database);
    std::ifstream commit(work / COMMIT_FILE);
    std::string keep;
    if (!std::getline(commit, keep)) return;
    // A tile is in its place before one that refers to it. What nothing refers to any more goes last.
    for (const fs::path& name : deepestFirst(staged / "tiles"))
        move(staged / "tiles" / name, database / "tiles" / name);
    for (const char* name : {"terrain.osgb", ORIGIN_FILE})
        if (fs::exists(staged / name)) move(staged / name, database / name);
    std::error_code code;
    for (std::string name; std::getline(commit, name);)
    {
        const fs::path file = database / name;
        fs::remove(file, code);
        // Folders that are empty now; others refuse.
        fs::remove(file.parent_path(), code);
        fs::remove(file.parent_path().parent_path(), code);
    }
    if (keep == KEEP)
        replaceKept(database);
    else
        fs::remove_all(keptFolderOf(database), code);
    fs::remove(PlanFile::file(database.string()), code);
    fs::remove(work / ORIGIN_FILE, code);
    // As long as the commit's file is there, all of this is done again.
    std::vector<fs::path> rest;
    for (fs::directory_iterator entry(work, code), end; !code && entry != end; entry.increment(code))
        if (entry->path().filename() != COMMIT_FILE) rest.push_back(entry->path());
    for (const fs::path& path : rest)
        fs::remove_all(path, code);
    fs::remove_all(work, code);
}

void removeLeftovers(const BuildPlan& plan)
{
    std::error_code code;
    std::vector<fs::path> leftovers;
    const fs::path output = plan.options.output;
    for (const fs::path& folder : {output / "tiles", keptFolderOf(output)})
        for (fs::recursive_directory_iterator entry(folder, code), end; !code && entry != end;
             entry.increment(code))
            if (isLeftover(entry->path())) leftovers.push_back(entry->path());
    for (const fs::path& path : leftovers)
        fs::remove(path, code);
}

} // namespace osgGeoFX
