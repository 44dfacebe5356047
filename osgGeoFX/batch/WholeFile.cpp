// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/WholeFile.h>

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>

namespace osgGeoFX
{

std::string temporaryName(const std::string& path)
{
    static std::atomic<unsigned int> next{0};
    static const std::string host = []
    {
        char name[256] = {};
        gethostname(name, sizeof(name) - 1);
        return std::string(name);
    }();
    return path + "." + host + "-" + std::to_string(getpid()) + "-" + std::to_string(next++) +
           TEMPORARY_ENDING;
}

int writeWholeFile(const std::string& path, const char* data, std::size_t size)
{
    const std::string temporary = temporaryName(path);
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) return errno;
    errno = 0;
    const bool written = std::fwrite(data, 1, size, file) == size;
    int error = written ? 0 : errno;
    if (std::fclose(file) != 0 && error == 0) error = errno;
    if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0) std::remove(temporary.c_str());
    return error;
}

} // namespace osgGeoFX
