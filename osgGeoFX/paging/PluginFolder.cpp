// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/PluginFolder.h>

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <dlfcn.h>

#include <algorithm>

namespace osgGeoFX
{

void addPluginFolder()
{
    Dl_info self{};
    if (dladdr(reinterpret_cast<void*>(&addPluginFolder), &self) == 0 || !self.dli_fname) return;
    const std::string folder = osgDB::getFilePath(self.dli_fname);
    osgDB::FilePathList& folders = osgDB::Registry::instance()->getLibraryFilePathList();
    if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
}

} // namespace osgGeoFX
