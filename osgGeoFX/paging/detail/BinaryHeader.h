// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <istream>
#include <string>

namespace osgGeoFX
{

/// What is wrong with the header of an .osgb file, as far as OSG would trust its sizes. Everything after it is checked by
/// zlib. Empty if nothing is wrong, or if it is not for us to judge.
std::string faultOfBinaryHeader(std::istream& stream);

} // namespace osgGeoFX
