// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/FileStore.h>

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
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
    std::error_code code;
    fs::create_directories(fs::path(file).parent_path(), code);
    if (code) return code.message();
    static std::atomic<unsigned int> count{0};
    const std::string unfinished =
        file + "." + std::to_string(::getpid()) + "-" + std::to_string(++count) + ".part";
    std::FILE* const stream = std::fopen(unfinished.c_str(), "wb");
    if (!stream) return std::strerror(errno);
    errno = 0;
    int error = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size() ? 0 : errno;
    if (std::fclose(stream) != 0 && error == 0) error = errno;
    if (error == 0 && std::rename(unfinished.c_str(), file.c_str()) != 0) error = errno;
    if (error != 0) std::remove(unfinished.c_str());
    return error == 0 ? std::string() : std::strerror(error);
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
