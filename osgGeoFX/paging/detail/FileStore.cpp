// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/FileStore.h>

#include <osgGeoFX/batch/WholeFile.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <vector>

namespace osgGeoFX
{

namespace fs = std::filesystem;

bool FileStore::has(const std::string& file)
{
    std::error_code ignored;
    return !file.empty() && fs::is_regular_file(file, ignored);
}

std::string FileStore::read(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    if (stream) bytes << stream.rdbuf();
    return bytes.str();
}

std::string FileStore::write(const std::string& file, const std::string& bytes)
{
    std::error_code fault;
    fs::create_directories(fs::path(file).parent_path(), fault);
    if (fault) return fault.message();
    const int error = writeWholeFile(file, bytes.data(), bytes.size());
    return error == 0 ? std::string() : std::generic_category().message(error);
}

void FileStore::remove(const std::string& file)
{
    std::error_code ignored;
    fs::remove(file, ignored);
}

void FileStore::removeTiles(const fs::path& folder)
{
    std::error_code ignored;
    std::vector<fs::path> tiles;
    for (auto each = fs::recursive_directory_iterator(folder, ignored);
         each != fs::recursive_directory_iterator(); each.increment(ignored))
        if (each->path().extension() == ".osgb" && each->is_regular_file(ignored))
            tiles.push_back(each->path());
    for (const fs::path& tile : tiles)
        fs::remove(tile, ignored);
}

} // namespace osgGeoFX
