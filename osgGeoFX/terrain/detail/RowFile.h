// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <string>

namespace osgGeoFX
{

/** A work file of rows of equal size, for what is too large for memory. Rows may be read and written in any order, and
    by several threads at once. Methods throw BuildError. */
class RowFile
{
public:
    enum class Mode
    {
        CREATE, ///< empty, with the folder it lies in
        READ
    };
    RowFile(std::string path, std::size_t rowBytes, Mode mode);
    ~RowFile();
    RowFile(const RowFile&) = delete;
    RowFile& operator=(const RowFile&) = delete;

    void write(int row, const void* data);
    void read(int row, void* data) const;

    /// Part of a row: `size` bytes from the byte `first` on. Bytes that were never written are 0 where a later row was.
    void write(int row, std::size_t first, std::size_t size, const void* data);
    void read(int row, std::size_t first, std::size_t size, void* data) const;

    /// Makes the file as long as so many rows, of which those that are never written are 0 and take no room on the disk.
    void extend(int rows);

    /// Closes a file that was written, and gives it its final name: whoever finds that has all of it.
    void finish(const std::string& path);

private:
    std::string _path;
    std::size_t _rowBytes;
    int _descriptor = -1;
};

} // namespace osgGeoFX
