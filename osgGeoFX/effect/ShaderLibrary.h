// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Program>
#include <osg/Shader>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Thrown if a shader file is missing or includes itself. what() is the sentence to show.
/// @ingroup effect
class OSGGEOFX_EXPORT ShaderError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    ~ShaderError() override;
};

/** The kit's shader files. A file is known by its name below shaders/, for example "lib/bend.glsl".

    The files are compiled into the library. Applications add files for their own effects with add(). A file of the
    same name in the override folder takes precedence. It is read anew each time, so that shaders can be edited while
    a program runs. The folder may also hold further files. The environment variable OSGGEOFX_SHADER_PATH names it by
    default; without the variable there is none.

    A line `#include "lib/bend.glsl"` is replaced by that file, once in each assembled text. Names are always
    relative to shaders/. Conditions such as #ifdef do not hide an #include. `#line` directives keep the line numbers
    of a compiler's messages correct, and comments after them name the files. In "3(12)", 3 is the number behind
    `#line 1` (Mesa says 0 for every file, with the correct line).

    Threads: all methods may be called from any thread. Errors: ShaderError.

    @ingroup effect */
class OSGGEOFX_EXPORT ShaderLibrary
{
public:
    ShaderLibrary();
    explicit ShaderLibrary(std::filesystem::path overrideFolder);

    /// The names of the files that are compiled into the library.
    static std::vector<std::string> files();

    /// Adds a file for effects of an application, to all libraries of the process. `name` is relative to shaders/, for
    /// example "mine/outline.glsl". A file that was added before under this name is replaced, for programs that are
    /// made from then on. False for the name of one of the kit's own files, which do not change.
    static bool add(const std::string& name, const std::string& text);

    /// The text of one file, without its includes resolved.
    std::string read(const std::string& name) const;

    /// The text of one file and of all files that it includes.
    std::string source(const std::string& name) const;

    /// A given text with all files that it includes. `name` appears in messages.
    std::string assemble(const std::string& text, const std::string& name) const;

    /// An OSG shader of the assembled file. Its name is that of the file.
    osg::ref_ptr<osg::Shader> createShader(osg::Shader::Type type, const std::string& name) const;

    /// A program of a vertex and a fragment shader. Null, after a warning, if a file is missing.
    static osg::ref_ptr<osg::Program> createProgram(const std::string& name, const std::string& vertexFile,
                                                    const std::string& fragmentFile);

private:
    std::filesystem::path _overrideFolder;
};

} // namespace osgGeoFX
