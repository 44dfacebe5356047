// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/RowFile.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>
#include <utility>

namespace osgGeoFX
{

RowFile::RowFile(std::string path, std::size_t rowBytes, Mode mode)
    : _path(mode == Mode::TEMPORARY ? temporaryName(path) : std::move(path)), _rowBytes(rowBytes),
      _temporary(mode == Mode::TEMPORARY)
{
    std::error_code code;
    const bool writes = mode != Mode::READ;
    if (writes) std::filesystem::create_directories(std::filesystem::path(_path).parent_path(), code);
    const int flags = writes ? O_RDWR | O_CREAT | (mode == Mode::SHARE ? 0 : O_TRUNC) : O_RDONLY;
    _descriptor = open(_path.c_str(), flags | O_CLOEXEC, 0666);
    if (_descriptor >= 0) return;
    if (writes) failToWrite(_path, errno);
    throw BuildError(_path + ": this work file cannot be read; build again without --resume.");
}

RowFile::RowFile(RowFile&& other) noexcept
    : _path(std::move(other._path)), _rowBytes(other._rowBytes),
      _descriptor(std::exchange(other._descriptor, -1)), _temporary(std::exchange(other._temporary, false))
{
}

RowFile::~RowFile()
{
    if (_descriptor >= 0) close(_descriptor);
    if (_temporary) std::remove(_path.c_str());
}

void RowFile::write(int row, const void* data)
{
    write(row, 0, _rowBytes, data);
}

void RowFile::read(int row, void* data) const
{
    read(row, 0, _rowBytes, data);
}

void RowFile::write(int row, std::size_t first, std::size_t size, const void* data)
{
    const char* bytes = static_cast<const char*>(data);
    const auto start = static_cast<std::size_t>(row) * _rowBytes + first;
    for (std::size_t done = 0; done < size;)
    {
        const ssize_t count =
            pwrite(_descriptor, bytes + done, size - done, static_cast<off_t>(start + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) failToWrite(_path, count < 0 ? errno : ENOSPC);
        done += static_cast<std::size_t>(count);
    }
}

void RowFile::read(int row, std::size_t first, std::size_t size, void* data) const
{
    char* bytes = static_cast<char*>(data);
    const auto start = static_cast<std::size_t>(row) * _rowBytes + first;
    for (std::size_t done = 0; done < size;)
    {
        const ssize_t count = pread(_descriptor, bytes + done, size - done, static_cast<off_t>(start + done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0)
            throw BuildError(_path + ": this work file is damaged; build again without --resume.");
        done += static_cast<std::size_t>(count);
    }
}

void RowFile::extend(int rows)
{
    const auto size = static_cast<off_t>(static_cast<std::size_t>(rows) * _rowBytes);
    if (ftruncate(_descriptor, size) != 0) failToWrite(_path, errno);
}

void RowFile::finish(const std::string& path)
{
    const int closed = close(std::exchange(_descriptor, -1));
    if (closed != 0 || std::rename(_path.c_str(), path.c_str()) != 0) failToWrite(path, errno);
    _temporary = false;
}

} // namespace osgGeoFX
