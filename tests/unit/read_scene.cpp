// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// read_scene FILE: reads a file as osgviewer does, in a process of its own, and ends with 1 where that fails.
// (Debian's programs cannot load a plugin that was built with sanitizers.)
#include <osgDB/ReadFile>

int main(int, char** argv)
{
    return osgDB::readRefNodeFile(argv[1]) ? 0 : 1;
}
