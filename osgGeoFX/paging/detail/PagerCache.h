// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgDB/FileCache>

namespace osgGeoFX
{

/** Stands between a pager and the file cache. Without a file cache, OSG's pager leaves files of servers to the threads that read
    disks. With one, it writes each tile anew: what stands in for a tile that failed, too, and half a file when the program
    ends. This one sends files of servers to the threads for them, and leaves the cache to RemoteFiles. */
class PagerCache : public osgDB::FileCache
{
public:
    /// `path`: the cache's folder; empty: the one of OSG's registry.
    explicit PagerCache(const std::string& path);

    std::string createCacheFileName(const std::string& url) const override;
    bool existsInCache(const std::string& url) const override;
    osgDB::ReaderWriter::ReadResult readNode(const std::string& url, const osgDB::Options* options,
                                             bool buildKdTree) const override;
    osgDB::ReaderWriter::WriteResult writeNode(const osg::Node& node, const std::string& url,
                                               const osgDB::Options* options) const override;

protected:
    ~PagerCache() override;
};

} // namespace osgGeoFX
