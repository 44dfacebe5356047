// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <string>

namespace osgGeoFX
{

/** A work file of rows of equal size, for data that are too large for memory. Several threads may read and write rows
    at once, in any order. Methods throw BuildError. */
class RowFile
{
public:
    enum class Mode
    {
        CREATE,    ///< empty; makes the folder, too
        SHARE,     ///< the same, but what other processes have written stays
        TEMPORARY, ///< CREATE under a name of its own beside the path; removed at the end unless it is finished
        READ
    };
    RowFile(std::string path, std::size_t rowBytes, Mode mode);
    ~RowFile();
    RowFile(RowFile&& other) noexcept;
    RowFile(const RowFile&) = delete;
    RowFile& operator=(const RowFile&) = delete;

    void write(int row, const void* data);
    void read(int row, void* data) const;

    /// A part of a row: `size` bytes from the byte `first` on. Bytes that were never written are 0 if a later row was
    /// written.
    void write(int row, std::size_t first, std::size_t size, const void* data);
    void read(int row, std::size_t first, std::size_t size, void* data) const;

    /// Makes the file so many rows long. Rows that are never written are 0 and take no room on the disk.
    void extend(int rows);

    /// Closes a file that was written, and gives it its final name. A file of this name is complete.
    void finish(const std::string& path);

private:
    std::string _path;
    std::size_t _rowBytes;
    int _descriptor = -1;
    bool _temporary = false;
};

} // namespace osgGeoFX
