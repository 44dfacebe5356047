// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>

#include <string>

namespace osgGeoFX
{

/** Writes a node into an .osgb file that any OpenSceneGraph reads, compressed; the file is there whole or not at all.

    Throws BuildError, with the file and the remedy. Every thread may call it, for files of its own. */
void writeNodeAtomically(const osg::Node& node, const std::string& path);

} // namespace osgGeoFX
