// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Shader>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A shader file is missing or includes itself; what() is the sentence to show.
class OSGGEOFX_EXPORT ShaderError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    ~ShaderError() override;
};

/** The kit's shader files, by their names below shaders/, for example "lib/bend.glsl".

    They are baked into the library. A file of the same name in the override folder takes precedence, and
    is read anew each time, so that shaders can be edited while a program runs. The folder is by default
    what the environment variable OSGGEOFX_SHADER_PATH names, else none; it may hold further files.

    A line `#include "lib/bend.glsl"` is replaced by that file, once in each assembled text; names are
    always relative to shaders/. Conditions such as #ifdef do not hide an #include. `#line` directives
    keep the lines of a compiler's messages true, and name the files in comments: in "3(12)", 3 is the
    number behind `#line 1` (Mesa says 0 for every file, with the right line).

    Threads: all methods may be called from any thread. Errors: ShaderError. */
class OSGGEOFX_EXPORT ShaderLibrary
{
public:
    ShaderLibrary();
    explicit ShaderLibrary(std::filesystem::path overrideFolder);

    /// The names of the baked files.
    static std::vector<std::string> files();

    /// The text of one file as it stands.
    std::string read(const std::string& name) const;

    /// The text of one file with everything that it includes.
    std::string source(const std::string& name) const;

    /// A text of one's own with everything that it includes; `name` is for messages.
    std::string assemble(const std::string& text, const std::string& name) const;

    /// An OSG shader of the assembled file, named after it.
    osg::ref_ptr<osg::Shader> createShader(osg::Shader::Type type, const std::string& name) const;

private:
    std::filesystem::path _overrideFolder;
};

} // namespace osgGeoFX
