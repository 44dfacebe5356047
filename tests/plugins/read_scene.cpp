// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// read_scene FILE [OPTIONS]: reads a file as osgviewer does (-O OPTIONS there), in a process of its own, and ends with 1 where
// that fails. (Debian's programs cannot load a plugin that was built with sanitizers.)
#include <osgDB/Options>
#include <osgDB/ReadFile>

int main(int argc, char** argv)
{
    const osg::ref_ptr<osgDB::Options> options = argc > 2 ? new osgDB::Options(argv[2]) : nullptr;
    return osgDB::readRefNodeFile(argv[1], options.get()) ? 0 : 1;
}
