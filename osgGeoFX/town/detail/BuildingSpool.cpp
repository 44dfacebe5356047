// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/BuildingSpool.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/terrain/detail/AtomicFile.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t BUFFER = 1 << 20;

/// What a building starts with.
struct Head
{
    double height = 0.0, bottom = 0.0;
    std::uint32_t bytes = 0; ///< of all that follows
    std::uint16_t rings = 0;
    std::uint8_t use = 0, notes = 0; ///< the highest bit of the notes: gabled
};

} // namespace

BuildingSpool::BuildingSpool(std::string path)
    : _path(std::move(path)), _file(::open(_path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600))
{
    if (_file < 0) failToWrite(_path, errno);
    _buffer.reserve(BUFFER + 4096);
}

BuildingSpool::~BuildingSpool()
{
    if (_file >= 0) ::close(_file);
}

std::uint64_t BuildingSpool::add(const Building& building)
{
    const std::uint64_t place = _size + _buffer.size();
    ByteWriter body;
    for (const Ring& ring : building.rings)
    {
        body.put(static_cast<std::uint32_t>(ring.size()));
        body.put(ring.data(), ring.size());
    }
    Head head;
    head.height = building.height;
    head.bottom = building.bottom;
    head.bytes = static_cast<std::uint32_t>(body.bytes().size());
    head.rings = static_cast<std::uint16_t>(building.rings.size());
    head.use = static_cast<std::uint8_t>(building.use);
    head.notes = static_cast<std::uint8_t>(building.notes | (building.gabled ? 128 : 0));
    const auto* bytes = reinterpret_cast<const char*>(&head);
    _buffer.insert(_buffer.end(), bytes, bytes + sizeof(head));
    _buffer.insert(_buffer.end(), body.bytes().begin(), body.bytes().end());
    if (_buffer.size() >= BUFFER) flush();
    return place;
}

void BuildingSpool::flush()
{
    std::size_t done = 0;
    while (done < _buffer.size())
    {
        const ssize_t count = ::write(_file, _buffer.data() + done, _buffer.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) failToWrite(_path, errno);
        done += static_cast<std::size_t>(count);
    }
    _size += _buffer.size();
    _buffer.clear();
}

void BuildingSpool::finish()
{
    flush();
    _buffer.shrink_to_fit();
}

Building BuildingSpool::read(std::uint64_t place) const
{
    const auto take = [&](void* to, std::size_t size, std::uint64_t from)
    {
        std::size_t done = 0;
        while (done < size)
        {
            const ssize_t count =
                ::pread(_file, static_cast<char*>(to) + done, size - done, static_cast<off_t>(from + done));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0)
                throw BuildError(_path +
                                 ": the work file was damaged while the town was built; build it again.");
            done += static_cast<std::size_t>(count);
        }
    };
    Head head;
    take(&head, sizeof(head), place);
    std::vector<char> body(head.bytes);
    take(body.data(), body.size(), place + sizeof(head));
    Building building;
    building.height = head.height;
    building.bottom = head.bottom;
    building.use = static_cast<BuildingUse>(head.use);
    building.gabled = (head.notes & 128) != 0;
    building.notes = static_cast<std::uint8_t>(head.notes & 127);
    std::size_t at = 0;
    for (int i = 0; i < head.rings; ++i)
    {
        std::uint32_t count = 0;
        std::copy_n(body.data() + at, sizeof(count), reinterpret_cast<char*>(&count));
        at += sizeof(count);
        Ring ring(count);
        std::copy_n(body.data() + at, count * sizeof(osg::Vec2d), reinterpret_cast<char*>(ring.data()));
        at += count * sizeof(osg::Vec2d);
        building.rings.push_back(std::move(ring));
    }
    return building;
}

} // namespace osgGeoFX
