// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/PackedArray.h>

#include <libdeflate.h>

#include <memory>
#include <new>

namespace osgGeoFX
{

namespace
{

/// Fast rather than small.
constexpr int LEVEL = 1;

struct Free
{
    void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    void operator()(libdeflate_decompressor* decompressor) const
    {
        libdeflate_free_decompressor(decompressor);
    }
};

} // namespace

std::vector<char> packedBytes(const void* values, std::size_t size, std::size_t stride)
{
    const auto* bytes = static_cast<const char*>(values);
    const std::size_t count = size / stride;
    std::vector<char> planes(size);
    for (std::size_t byte = 0; byte < stride; ++byte)
        for (std::size_t i = 0; i < count; ++i)
            planes[byte * count + i] = bytes[i * stride + byte];
    const std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(LEVEL));
    if (!compressor) throw std::bad_alloc();
    std::vector<char> result(libdeflate_deflate_compress_bound(compressor.get(), size));
    result.resize(
        libdeflate_deflate_compress(compressor.get(), planes.data(), size, result.data(), result.size()));
    return result;
}

bool unpackBytes(const std::vector<char>& packed, void* values, std::size_t size, std::size_t stride)
{
    const std::unique_ptr<libdeflate_decompressor, Free> decompressor(libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    std::vector<char> planes(size);
    if (libdeflate_deflate_decompress(decompressor.get(), packed.data(), packed.size(), planes.data(), size,
                                      nullptr) != LIBDEFLATE_SUCCESS)
        return false;
    auto* bytes = static_cast<char*>(values);
    const std::size_t count = size / stride;
    for (std::size_t byte = 0; byte < stride; ++byte)
        for (std::size_t i = 0; i < count; ++i)
            bytes[i * stride + byte] = planes[byte * count + i];
    return true;
}

} // namespace osgGeoFX
