// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osgDB/DatabasePager>
#include <osgDB/Options>
#include <osgDB/ReaderWriter>

#include <cstdint>
#include <string>

namespace osgGeoFX
{

/** Files on web servers (`http://`, `https://`). OSG's plugin osgdb_curl fetches them, so its option strings hold, such as
    `OSG_CURL_PROXY`, and so does OSG's AuthenticationMap.

    A server may take 10 seconds to accept a connection and 30 seconds for a file. The option strings
    `OSG_CURL_CONNECTTIMEOUT=SECONDS` and `OSG_CURL_TIMEOUT=SECONDS` change this, and so do environment variables with
    these names. After three requests in a row without an answer, a server is not asked for 2 seconds.

    If OSG has a file cache (`OSG_FILE_CACHE=FOLDER` or osgDB::Options::setFileCache()), each file that could be read is
    kept there, byte by byte, under the name that OSG gives it. A file is written under another name first, so an
    interrupted program leaves no half of it. A file in the cache that cannot be read is removed and fetched again.
    All functions may be called from any thread.

    @ingroup paging */
class OSGGEOFX_EXPORT RemoteFiles
{
public:
    /// Which copy of a file is read.
    enum class Order
    {
        CacheFirst, ///< the server is asked only for what the cache lacks; for tiles, which do not change
        /// The cache is read only if the server does not answer, or fails (5xx), with one warning. For the root of a
        /// database: if it differs from the copy in the cache, the .osgb files in the cache beside and below are removed.
        ServerFirst
    };

    /// Why a file could not be had.
    enum class Fault
    {
        None,
        NoAnswer, ///< no connection, too late, or broken off
        Refused,  ///< the server answered with an error
        Damaged,  ///< the server sent something that cannot be read
        NoPlugin  ///< osgdb_curl was not found
    };

    /// A node, or else the reason why there is none, as a part of a sentence.
    struct Node
    {
        osg::ref_ptr<osg::Node> node;
        std::uint64_t bytes = 0; ///< size of the file
        bool fromCache = false;
        Fault fault = Fault::None;
        std::string reason;
    };

    /// A file's content, or else the reason why there is none, as a part of a sentence.
    struct Content
    {
        std::string bytes;
        Fault fault = Fault::None;
        std::string reason;
    };

    /// Whether a name is one of a file on a server.
    static bool isRemote(const std::string& name);

    /// An address without the segments "." and ".." of its path.
    static std::string normalOf(const std::string& url);

    /// Reads a node with the reader of the file's extension. PagedLODs below it look for their files beside it on the server.
    /// Exceptions of the reader are faults, too.
    static Node readNode(const std::string& url, const osgDB::Options* options, Order order);

    /// Reads a whole file, always in the order ServerFirst.
    static Content readContent(const std::string& url, const osgDB::Options* options);

    /// Where the cache has a file, or would have it. Empty without a cache. Segments ".." do not lead out of the cache.
    static std::string cacheFileOf(const std::string& url, const osgDB::Options* options);

    /// What a person can do about a fault: the last part of a sentence.
    static std::string remedyOf(Fault fault);

    /// Gives a pager threads: `local` ones for files on disks and in the cache, and others that wait for servers. There are
    /// 8 of the latter, or as many as `OSG_NUM_HTTP_DATABASE_THREADS` says. Call it before the first frame.
    static void setUpThreads(osgDB::DatabasePager& pager, unsigned int local);
};

} // namespace osgGeoFX
