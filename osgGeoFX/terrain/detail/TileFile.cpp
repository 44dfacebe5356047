// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileFile.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <osgDB/Options>
#include <osgDB/Registry>

#include <libdeflate.h>

#include <memory>
#include <new>
#include <sstream>

namespace osgGeoFX
{

namespace
{

/// The level of libdeflate. Its files are a little smaller than those of zlib's usual level, in half of the time.
constexpr int LEVEL = 7;

/// The bytes of an .osgb file before the compressor's name: two marks, the kind, the version, attributes.
constexpr std::size_t HEADER = 20;
/// The names of no compressor and of OSG's own one, each behind its length.
const std::string NONE("\1\0\0\0"
                       "0",
                       5),
    ZLIB("\4\0\0\0"
         "zlib",
         8);

struct Free
{
    void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

/// The file that OSG would have compressed: a gzip stream behind the header and the name. A file of unknown form
/// stays uncompressed, which can be read as well.
std::string compressed(const std::string& plain)
{
    if (plain.compare(HEADER, NONE.size(), NONE) != 0) return plain;
    const std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(LEVEL));
    if (!compressor) throw std::bad_alloc();
    const std::size_t start = HEADER + NONE.size(), size = plain.size() - start;
    std::string result = plain.substr(0, HEADER) + ZLIB;
    const std::size_t head = result.size();
    result.resize(head + libdeflate_gzip_compress_bound(compressor.get(), size));
    result.resize(head + libdeflate_gzip_compress(compressor.get(), plain.data() + start, size,
                                                  result.data() + head, result.size() - head));
    return result;
}

} // namespace

std::uint64_t writeNodeAtomically(const osg::Node& node, const std::string& path)
{
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    if (!writer)
        throw BuildError(
            path + ": OpenSceneGraph's plugin osgdb_osg cannot be found; install openscenegraph's plugins, "
                   "or name their folder in OSG_LIBRARY_PATH.");
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("WriteImageHint=IncludeData");
    std::ostringstream stream(std::ios::binary);
    const auto result = writer->writeNode(node, stream, options);
    if (!result.success())
        throw BuildError(path + ": OpenSceneGraph cannot write the tile (" + result.statusMessage() + ").");
    const std::string bytes = compressed(stream.str());
    writeFileAtomically(path, bytes.data(), bytes.size());
    return bytes.size();
}

} // namespace osgGeoFX
