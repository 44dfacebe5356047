// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/UnitRecord.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>

namespace osgGeoFX
{

std::optional<UnitRecord> UnitRecord::read(const std::string& file)
{
    ByteReader reader(file);
    UnitRecord record;
    record.key = reader.get<Digest>();
    record.handedOn = reader.get<Digest>();
    record.root = reader.get<Digest>();
    record.rootTextures = reader.get<TextureFigures>();
    record.groups = reader.getVector<Group>();
    if (!reader.good()) return {};
    return record;
}

void UnitRecord::write(const std::string& file) const
{
    ByteWriter writer;
    writer.put(key);
    writer.put(handedOn);
    writer.put(root);
    writer.put(rootTextures);
    writer.put(groups);
    writeFileAtomically(file, writer.bytes().data(), writer.bytes().size());
}

} // namespace osgGeoFX
