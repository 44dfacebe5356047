// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// Whether the content may be read as an OSG file of somebody else; the reason otherwise, as a part of a sentence. Afterwards a
/// compressed file is unpacked, so that it is so only once. `most`: bytes.
std::string faultOfDatabase(std::string& content, std::size_t most);

} // namespace osgGeoFX
