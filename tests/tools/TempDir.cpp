// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/TempDir.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace geofx::test
{

TempDir::TempDir()
{
    std::string pattern = (std::filesystem::temp_directory_path() / "osggeofx-test-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
    {
        throw std::system_error(errno, std::generic_category(), "no temporary folder " + pattern);
    }
    _path = pattern;
}

TempDir::~TempDir()
{
    std::error_code ignored;
    std::filesystem::remove_all(_path, ignored);
}

std::filesystem::path TempDir::write(const std::string& name, const std::string& content) const
{
    std::filesystem::path path = _path / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary);
    file << content;
    file.close();
    if (!file)
    {
        throw std::system_error(errno, std::generic_category(), "cannot write " + path.string());
    }
    return path;
}

} // namespace geofx::test
