// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/ShaderLibrary.h>

#include <osgGeoFX/effect/detail/ProfileProgram.h>

#include <BakedShaders.h>

#include <osg/Notify>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <regex>
#include <sstream>

namespace osgGeoFX
{

namespace
{

std::filesystem::path folderFromEnvironment()
{
    const char* folder = std::getenv("OSGGEOFX_SHADER_PATH");
    return folder ? folder : "";
}

/// The files that applications have added.
class AddedFiles
{
public:
    void add(const std::string& name, const std::string& text)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _texts[name] = text;
    }
    std::optional<std::string> find(const std::string& name)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _texts.find(name);
        return found == _texts.end() ? std::nullopt : std::optional<std::string>(found->second);
    }

private:
    std::mutex _mutex;
    std::map<std::string, std::string> _texts;
};

AddedFiles& addedFiles()
{
    static AddedFiles files;
    return files;
}

const BakedShader* bakedFile(const std::string& name)
{
    const BakedShader* end = bakedShaders + bakedShaderCount;
    const BakedShader* found =
        std::find_if(bakedShaders, end, [&](const BakedShader& each) { return each.name == name; });
    return found == end ? nullptr : found;
}

/// One assembled text in the making.
class Assembly
{
public:
    explicit Assembly(const ShaderLibrary& library) : _library(library) {}

    void add(const std::string& text, const std::string& name)
    {
        // In the order of their first lines; the position is the number that #line gives a file.
        const std::size_t number = _names.size();
        _names.push_back(name);
        _open.push_back(name);
        std::istringstream lines(text);
        std::string line;
        for (int lineNumber = 1; std::getline(lines, line); ++lineNumber)
        {
            static const std::regex includePattern(R"(\s*#\s*include\s+"([^"]+)\".*)");
            std::smatch match;
            if (!std::regex_match(line, match, includePattern))
            {
                _result << line << '\n';
                continue;
            }
            if (!include(match[1], name, lineNumber))
            {
                _result << '\n';
                continue;
            }
            _result << "#line " << lineNumber + 1 << ' ' << number << " // " << name << '\n';
        }
        _open.pop_back();
    }

    std::string text() const { return _result.str(); }

private:
    bool include(const std::string& included, const std::string& from, int lineNumber)
    {
        const std::string where = from + ":" + std::to_string(lineNumber) + ": ";
        if (std::find(_open.begin(), _open.end(), included) != _open.end())
        {
            std::string chain;
            for (const std::string& name : _open)
                chain += name + " > ";
            throw ShaderError(where + "the shader file includes itself (" + chain + included +
                              "); move what both need into a file of its own.");
        }
        if (std::find(_names.begin(), _names.end(), included) != _names.end())
        {
            return false;
        }
        std::string text;
        try
        {
            text = _library.read(included);
        }
        catch (const ShaderError& error)
        {
            throw ShaderError(where + error.what());
        }
        _result << "#line 1 " << _names.size() << " // " << included << '\n';
        add(text, included);
        return true;
    }

    const ShaderLibrary& _library;
    std::ostringstream _result;
    std::vector<std::string> _names;
    std::vector<std::string> _open;
};

} // namespace

ShaderError::~ShaderError() = default;

ShaderLibrary::ShaderLibrary() : ShaderLibrary(folderFromEnvironment()) {}

ShaderLibrary::ShaderLibrary(std::filesystem::path overrideFolder)
    : _overrideFolder(std::move(overrideFolder))
{
}

std::vector<std::string> ShaderLibrary::files()
{
    std::vector<std::string> names;
    std::transform(bakedShaders, bakedShaders + bakedShaderCount, std::back_inserter(names),
                   [](const BakedShader& shader) { return shader.name; });
    return names;
}

bool ShaderLibrary::add(const std::string& name, const std::string& text)
{
    if (bakedFile(name)) return false;
    addedFiles().add(name, text);
    return true;
}

std::string ShaderLibrary::read(const std::string& name) const
{
    const std::filesystem::path diskFile = _overrideFolder / name;
    if (!_overrideFolder.empty() && std::filesystem::is_regular_file(diskFile))
    {
        std::ostringstream text;
        text << std::ifstream(diskFile, std::ios::binary).rdbuf();
        return text.str();
    }
    if (const std::optional<std::string> added = addedFiles().find(name)) return *added;
    const BakedShader* shader = bakedFile(name);
    if (!shader)
    {
        const std::string orFolder =
            _overrideFolder.empty() ? "" : " and not in the folder " + _overrideFolder.string();
        throw ShaderError(
            "there is no shader file \"" + name + "\" in the library" + orFolder +
            "; correct the name, or add the file, one of the kit's to the list in shaders/CMakeLists.txt, "
            "another one with ShaderLibrary::add().");
    }
    return shader->text;
}

std::string ShaderLibrary::source(const std::string& name) const
{
    return assemble(read(name), name);
}

std::string ShaderLibrary::assemble(const std::string& text, const std::string& name) const
{
    Assembly assembly(*this);
    assembly.add(text, name);
    return assembly.text();
}

osg::ref_ptr<osg::Shader> ShaderLibrary::createShader(osg::Shader::Type type, const std::string& name) const
{
    return ProfileProgram::createShader(type, source(name), name);
}

osg::ref_ptr<osg::Program> ShaderLibrary::createProgram(const std::string& name,
                                                        const std::string& vertexFile,
                                                        const std::string& fragmentFile)
{
    try
    {
        const ShaderLibrary library;
        osg::ref_ptr<osg::Program> program = new ProfileProgram;
        program->setName(name);
        program->addShader(library.createShader(osg::Shader::VERTEX, vertexFile));
        program->addShader(library.createShader(osg::Shader::FRAGMENT, fragmentFile));
        return program;
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
        return nullptr;
    }
}

} // namespace osgGeoFX
