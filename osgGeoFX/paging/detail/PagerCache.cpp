// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/PagerCache.h>

#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/paging/detail/FileStore.h>

#include <osgDB/Registry>

namespace osgGeoFX
{

PagerCache::PagerCache(const std::string& path) : osgDB::FileCache(path) {}

PagerCache::~PagerCache() = default;

std::string PagerCache::createCacheFileName(const std::string& url) const
{
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setFileCache(const_cast<PagerCache*>(this));
    return RemoteFiles::cacheFileOf(url, options);
}

bool PagerCache::existsInCache(const std::string& url) const
{
    return FileStore::has(createCacheFileName(url));
}

osgDB::ReaderWriter::ReadResult PagerCache::readNode(const std::string& url, const osgDB::Options* options,
                                                     bool buildKdTree) const
{
    // Through the guard, which reads the cache first.
    return osgDB::Registry::instance()->readNode(url, options, buildKdTree);
}

osgDB::ReaderWriter::WriteResult PagerCache::writeNode(const osg::Node&, const std::string&,
                                                       const osgDB::Options*) const
{
    return osgDB::ReaderWriter::WriteResult::FILE_SAVED;
}

} // namespace osgGeoFX
