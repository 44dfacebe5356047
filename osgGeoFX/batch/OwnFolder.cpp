// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/OwnFolder.h>

#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/batch/WorkError.h>

#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* TEXT =
    "Work files of osgGeoFX. The folder is removed with all in it; keep nothing else here.";

bool isOurs(const fs::path& folder)
{
    std::ifstream stream(folder / OwnFolder::MARK);
    std::string line;
    return std::getline(stream, line) && line == TEXT;
}

/// Whether nothing is in a folder but a mark that another process is writing.
bool isFree(const fs::path& folder)
{
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
        if (entry->path().filename().string().rfind(OwnFolder::MARK, 0) != 0) return false;
    return !code;
}

} // namespace

void OwnFolder::check(const std::string& folder, const std::string& option)
{
    std::error_code code;
    if (!fs::exists(folder, code) || isOurs(folder)) return;
    if (!fs::is_directory(folder, code))
        throw WorkError(folder + ": a file has the name of the folder for work files; choose another " +
                        option + ", or move it away.");
    // Another process may have put its mark and its files there since.
    if (!isFree(folder) && !isOurs(folder))
        throw WorkError(folder +
                        ": the folder for work files holds other files, which would be lost with them; "
                        "choose another " +
                        option +
                        ", or move it away. If an earlier version of osgGeoFX has made it, remove it.");
}

void OwnFolder::take(const std::string& folder, const std::string& option)
{
    check(folder, option);
    if (isOurs(folder)) return;
    std::error_code code;
    fs::create_directories(folder, code);
    const std::string text = std::string(TEXT) + "\n";
    const int error =
        code ? code.value() : writeWholeFile((fs::path(folder) / MARK).string(), text.data(), text.size());
    if (error != 0)
        throw WorkError(folder + ": the folder for work files cannot be made (" +
                        std::generic_category().message(error) +
                        "); check permissions and the disk's space, or choose another " + option + ".");
}

void OwnFolder::remove(const std::string& folder)
{
    if (!isOurs(folder)) return;
    std::error_code code;
    std::vector<fs::path> rest;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
        if (entry->path().filename() != MARK) rest.push_back(entry->path());
    for (const fs::path& path : rest)
        fs::remove_all(path, code);
    fs::remove_all(folder, code);
}

} // namespace osgGeoFX
