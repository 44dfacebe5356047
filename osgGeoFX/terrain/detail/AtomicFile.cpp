// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/AtomicFile.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

namespace osgGeoFX
{

void failToWrite(const std::string& path, int error)
{
    std::string remedy = "make the folder writable, or choose another with -o.";
    if (error == ENOSPC || error == EDQUOT || error == EFBIG)
        remedy = "free some space and continue with --resume, or choose another folder with -o.";
    throw BuildError(path + ": cannot be written (" + std::strerror(error) + "); " + remedy);
}

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

void writeFileAtomically(const std::string& path, const char* data, std::size_t size)
{
    std::error_code code;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path(), code);
    if (code) failToWrite(path, code.value());

    const std::string temporary = temporaryName(path);
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file) failToWrite(path, errno);
    errno = 0;
    const bool written = std::fwrite(data, 1, size, file) == size;
    int error = written ? 0 : errno;
    if (std::fclose(file) != 0 && error == 0) error = errno;
    if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error != 0)
    {
        std::remove(temporary.c_str());
        failToWrite(path, error);
    }
}

ByteReader::ByteReader(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    if (!stream) return;
    _bytes.resize(static_cast<std::size_t>(stream.tellg()));
    stream.seekg(0);
    stream.read(_bytes.data(), static_cast<std::streamsize>(_bytes.size()));
    _good = static_cast<bool>(stream);
}

void ByteReader::take(void* target, std::size_t size)
{
    if (size > _bytes.size() - _position) _good = false;
    if (!_good || size == 0) return;
    std::memcpy(target, _bytes.data() + _position, size);
    _position += size;
}

} // namespace osgGeoFX
