// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>
#include <osg/Program>
#include <osg/observer_ptr>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** What an application's own programs make of the kit's functions: one that places vertices without geofx_vertex() draws where
    nothing is deformed. For one thread at a time. */
class OwnPrograms
{
public:
    /// Whether what has the type PROGRAM in a state set draws by itself; null and an osg::Program without shaders leave it to
    /// OpenGL's fixed functions, and that of a database's tiles (TileNormals) does what those would. Other engines have classes of their own for programs.
    static bool isOwn(const osg::StateAttribute* program);
    /// Whether a stage that places vertices calls geofx_vertex(). A class that is no osg::Program does not tell, and so does not.
    bool callsFunctions(const osg::StateAttribute& program);
    /// Whether it is one that draws by itself and does not call them.
    bool isStranger(const osg::StateAttribute* program)
    {
        return isOwn(program) && !callsFunctions(*program);
    }
    /// Looks again, once, at programs that have been looked at.
    void startFrame();

    /// For messages: its name, else those of its shaders, else the place where it draws.
    static std::string describe(const osg::StateAttribute& program, const osg::NodePath& path);
    /// Whether a shader's text calls geofx_vertex(), comments and declarations apart.
    static bool calls(const std::string& source);

private:
    using Sources = std::vector<std::pair<const osg::Shader*, std::string>>;
    struct Known
    {
        osg::observer_ptr<const osg::StateAttribute> program;
        Sources sources;
        bool calls = false;
        bool current = false; ///< looked at in this frame
    };
    std::map<const osg::StateAttribute*, Known> _known;
};

} // namespace osgGeoFX
