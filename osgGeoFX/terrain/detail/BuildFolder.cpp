// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildFolder.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/work/PlannedWork.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

std::string readText(const fs::path& path)
{
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

bool isLeftover(const fs::path& path)
{
    return path.extension() == TEMPORARY_ENDING;
}

} // namespace

std::uint64_t bytesBelow(const std::string& folder)
{
    std::uint64_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) bytes += entry.file_size();
    return bytes;
}

fs::path workFolderOf(const fs::path& database)
{
    return WorkPlan::workFolder(database.string());
}

bool prepareFolder(const BuildPlan& plan)
{
    const fs::path folder = plan.options.output;
    const fs::path origin = folder / ORIGIN_FILE, root = folder / "terrain.osgb";
    std::error_code code;
    fs::create_directories(folder, code);
    if (code || !fs::is_directory(folder))
        throw BuildError(folder.string() + ": the folder cannot be made (" +
                         (code ? code.message() : std::string("a file has this name")) +
                         "); choose another with -o.");
    // A kill in its very first moments leaves only the origin's temporary file.
    for (const auto& entry : fs::directory_iterator(folder, code))
        if (isLeftover(entry.path()) && entry.path().filename().string().rfind(ORIGIN_FILE, 0) == 0)
            fs::remove(entry.path(), code);
    const bool ours = fs::exists(origin);
    if (!ours && !fs::is_empty(folder))
        throw BuildError(
            folder.string() +
            ": the folder holds other files, which a build would mix with its own; choose an empty one "
            "with -o.");
    if (ours && plan.options.resume)
    {
        if (readText(origin) != plan.fingerprint)
            throw BuildError(
                folder.string() +
                ": the build that was begun here has other sources or options; repeat it with those, or "
                "leave out --resume to begin anew.");
        return fs::exists(root);
    }
    // The root first: without it, what is left of an old database does not look whole. Then the work files: with
    // them, tiles that are removed already would count as done when a kill here is followed by --resume.
    for (const fs::path& old : {root, workFolderOf(folder), folder / "tiles"})
    {
        fs::remove_all(old, code);
        if (code)
            throw BuildError(old.string() + ": the old database cannot be removed (" + code.message() +
                             "); make the folder writable, or choose another with -o.");
    }
    writeFileAtomically(origin.string(), plan.fingerprint.data(), plan.fingerprint.size());
    return false;
}

void removeLeftovers(const BuildPlan& plan)
{
    std::error_code code;
    std::vector<fs::path> leftovers;
    for (fs::recursive_directory_iterator entry(fs::path(plan.options.output) / "tiles", code), end;
         !code && entry != end; entry.increment(code))
        if (isLeftover(entry->path())) leftovers.push_back(entry->path());
    for (const fs::path& path : leftovers)
        fs::remove(path, code);
    fs::remove_all(plan.workFolder(), code);
}

} // namespace osgGeoFX
