// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>

#include <cstdint>
#include <string>

namespace osgGeoFX
{

/** Writes a node into a compressed .osgb file that any OpenSceneGraph reads. The file is written completely or not at
    all. Returns its size in bytes.

    Throws a BuildError with the file and the remedy. Several threads may call it for different files. */
std::uint64_t writeNodeAtomically(const osg::Node& node, const std::string& path);

} // namespace osgGeoFX
