// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/AtomicFile.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace osgGeoFX
{

void failToWrite(const std::string& path, int error)
{
    std::string remedy = "make the folder writable, or choose another with -o.";
    if (error == ENOSPC || error == EDQUOT || error == EFBIG)
        remedy = "free some space and continue with --resume, or choose another folder with -o.";
    throw BuildError(path + ": cannot be written (" + std::strerror(error) + "); " + remedy);
}

void writeFileAtomically(const std::string& path, const char* data, std::size_t size)
{
    std::error_code fault;
    std::filesystem::create_directories(std::filesystem::absolute(path).parent_path(), fault);
    if (fault) failToWrite(path, fault.value());
    if (const int error = writeWholeFile(path, data, size)) failToWrite(path, error);
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
