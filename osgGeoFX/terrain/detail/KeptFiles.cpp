// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/KeptFiles.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>

#include <cerrno>
#include <cstdio>
#include <sstream>
#include <unistd.h>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

} // namespace

std::string KeptFiles::obstacle(const BuildPlan& plan)
{
    const fs::path kept = keptFolderOf(plan.options.output);
    if (!fs::exists(kept / ORIGIN_FILE)) return "the former build has kept nothing for updates";
    if (readText(kept / ORIGIN_FILE) != readText(fs::path(plan.options.output) / ORIGIN_FILE))
        return "what is kept for updates belongs to another build";
    const std::string before = readText(kept / COMMON_FILE);
    if (before == plan.common) return {};
    // The first line that is new; each line is about something else.
    std::istringstream now(plan.common);
    for (std::string line; std::getline(now, line);)
        if (("\n" + before).find("\n" + line + "\n") == std::string::npos)
        {
            if (line.rfind("builder ", 0) == 0) return "another version of the program has built it";
            return "\"" + line + "\" is new, and every tile depends on it";
        }
    return "an option that every tile depends on has changed";
}

bool KeptFiles::haveFacts(const char* pass, const Unit& unit, const Digest& key) const
{
    ByteReader reader((keptFolderOf(_plan.options.output) / pass / unit.root.path()).string());
    reader.getVector<TileFacts>();
    return reader.get<Digest>() == key && reader.good();
}

std::optional<UnitRecord> KeptFiles::record(const Unit& unit) const
{
    return UnitRecord::read((keptFolderOf(_plan.options.output) / UNIT_RECORDS / unit.root.path()).string());
}

bool KeptFiles::hasTiles(const UnitRecord::Group& group, const TileKey& parent) const
{
    std::error_code code;
    return fs::file_size(_plan.tileFile(parent), code) == group.bytes && !code;
}

bool KeptFiles::take(const std::string& name) const
{
    const fs::path from = keptFolderOf(_plan.options.output) / name, to = fs::path(_plan.workFolder()) / name;
    std::error_code code;
    fs::create_directories(to.parent_path(), code);
    if (link(from.c_str(), to.c_str()) == 0 || errno == EEXIST) return true;
    if (errno == ENOENT) return false;
    // Some file systems have no second names.
    const ByteReader reader(from.string());
    if (!reader.good()) return false;
    writeFileAtomically(to.string(), reader.bytes().data(), reader.bytes().size());
    return true;
}

} // namespace osgGeoFX
