// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Node>
#include <osg/Program>
#include <osg/observer_ptr>

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class ShaderHost;

/** Finds out how an application's own programs use the kit's functions. A program that places vertices without
    geofx_vertex() draws its geometry undeformed. For one thread at a time. */
class OwnPrograms
{
public:
    /// Whether an attribute of type PROGRAM draws by itself. Null and an osg::Program without shaders leave the
    /// drawing to OpenGL's fixed functions. The program of a database's tiles (TileNormals) does the same as these
    /// functions, so it is none of its own either. Other engines have other classes for programs.
    static bool isOwn(const osg::StateAttribute* program);
    /// Whether a stage that places vertices calls geofx_vertex(), or the program is drawn adapted (AdaptedPrograms). A class that is
    /// no osg::Program does not tell, and so does not.
    bool callsFunctions(const osg::StateAttribute& program);
    /// Whether a program draws by itself and does not call the functions.
    bool isStranger(const osg::StateAttribute* program)
    {
        return isOwn(program) && !callsFunctions(*program);
    }
    /// Whether programs that do not call the functions are adapted as they are met. False by default.
    void setAdapting(bool on) { _adapting = on; }
    /// An engine that knows which of its programs call the functions; null for none.
    void setHost(const ShaderHost* host) { _host = host; }
    /// Starts a frame. Each program is looked at once in a frame.
    void startFrame();

    /// The same number for programs with equal texts, as the tiles of a database may have them. `program`: an osg::Program, or one in
    /// assembly language.
    static std::size_t numberOf(const osg::StateAttribute& program);
    /// A description for messages: the program's name, else its shaders' names, with the node where it draws.
    static std::string describe(const osg::StateAttribute& program, const osg::NodePath& path);
    /// Whether a shader's text calls a function that returns a vec4, comments and declarations apart.
    static bool calls(const std::string& source, const std::string& name = "geofx_vertex");

private:
    using Sources = std::vector<std::pair<const osg::Shader*, std::string>>;
    struct Known
    {
        osg::observer_ptr<const osg::StateAttribute> program;
        Sources sources;
        bool calls = false;
        bool current = false; ///< whether this frame has looked at it
    };
    bool _adapting = false;
    const ShaderHost* _host = nullptr;
    std::map<const osg::StateAttribute*, Known> _known;
};

} // namespace osgGeoFX
