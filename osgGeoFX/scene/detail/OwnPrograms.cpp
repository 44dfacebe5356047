// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <osgGeoFX/effect/detail/TileNormals.h>
#include <osgGeoFX/scene/ShaderHost.h>
#include <osgGeoFX/scene/detail/AdaptedPrograms.h>

#include <osg/FragmentProgram>
#include <osg/VertexProgram>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <unordered_map>

namespace osgGeoFX
{

namespace
{

bool placesVertices(const osg::Shader& shader)
{
    return shader.getType() == osg::Shader::VERTEX || shader.getType() == osg::Shader::TESSEVALUATION ||
           shader.getType() == osg::Shader::GEOMETRY;
}

/// The text with a space in place of each comment.
std::string withoutComments(const std::string& text)
{
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size();)
    {
        const bool line = text.compare(i, 2, "//") == 0;
        if (!line && text.compare(i, 2, "/*") != 0)
        {
            result += text[i++];
            continue;
        }
        const std::size_t end = line ? text.find('\n', i) : text.find("*/", i + 2);
        i = end == std::string::npos ? text.size() : end + (line ? 0 : 2);
        result += ' ';
    }
    return result;
}

bool isPartOfName(char letter)
{
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}

/// Whether the name that begins at this place is declared or defined. Its type stands before it then.
bool followsType(const std::string& text, std::size_t at)
{
    while (at > 0 && std::isspace(static_cast<unsigned char>(text[at - 1])) != 0)
        --at;
    constexpr const char type[] = "vec4";
    constexpr std::size_t size = sizeof type - 1;
    return at >= size && text.compare(at - size, size, type) == 0 &&
           (at == size || !isPartOfName(text[at - size - 1]));
}

/// OwnPrograms::calls(), which reads the whole text, of the last texts. Each pick looks at the same programs anew.
bool callsOnceRead(const std::string& source)
{
    constexpr std::size_t most = 64;
    thread_local std::unordered_map<std::string, bool> known;
    if (known.size() > most) known.clear();
    const auto [text, isNew] = known.try_emplace(source, false);
    if (isNew) text->second = OwnPrograms::calls(source);
    return text->second;
}

} // namespace

bool OwnPrograms::isOwn(const osg::StateAttribute* program)
{
    if (!program) return false;
    const auto* known = dynamic_cast<const osg::Program*>(program);
    return !known || !(known->isFixedFunction() || known->getName() == TileNormals::program);
}

bool OwnPrograms::calls(const std::string& source, const std::string& name)
{
    if (source.find(name) == std::string::npos) return false;
    const std::string text = withoutComments(source);
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
    {
        const std::size_t end = at + name.size();
        const bool whole =
            (at == 0 || !isPartOfName(text[at - 1])) && (end >= text.size() || !isPartOfName(text[end]));
        if (whole && !followsType(text, at)) return true;
    }
    return false;
}

void OwnPrograms::startFrame()
{
    for (auto known = _known.begin(); known != _known.end();)
    {
        known->second.current = false;
        known = known->second.program.valid() ? std::next(known) : _known.erase(known);
    }
}

bool OwnPrograms::callsFunctions(const osg::StateAttribute& program)
{
    if (_host && _host->draws(program)) return true;
    Known& known = _known[&program];
    if (known.current && known.program.valid()) return known.calls;
    if (!known.program.valid()) known = {};
    known.program = &program;
    known.current = true;
    const auto* shaders = dynamic_cast<const osg::Program*>(&program);
    if (!shaders) return known.calls = false;
    if (_adapting) AdaptedPrograms::instance().add(*shaders);
    const std::shared_ptr<const ProgramAdaptation> adaptation = AdaptedPrograms::instance().of(*shaders);
    if (adaptation)
    {
        known.sources.clear();
        return known.calls = adaptation->refusal().empty();
    }
    // A shader does not count its changes.
    const unsigned int count = shaders->getNumShaders();
    bool same = known.sources.size() == count;
    for (unsigned int i = 0; same && i < count; ++i)
        same = known.sources[i].first == shaders->getShader(i) &&
               known.sources[i].second == shaders->getShader(i)->getShaderSource();
    if (same && count > 0) return known.calls;
    known.sources.clear();
    known.calls = false;
    for (unsigned int i = 0; i < count; ++i)
    {
        const osg::Shader* shader = shaders->getShader(i);
        known.sources.emplace_back(shader, shader->getShaderSource());
        known.calls = known.calls || (placesVertices(*shader) && callsOnceRead(shader->getShaderSource()));
    }
    return known.calls;
}

std::size_t OwnPrograms::numberOf(const osg::StateAttribute& program)
{
    std::string texts;
    const auto* shaders = dynamic_cast<const osg::Program*>(&program);
    for (unsigned int i = 0; shaders && i < shaders->getNumShaders(); ++i)
    {
        const osg::Shader& shader = *shaders->getShader(i);
        texts += std::to_string(shader.getType()) + '\n' + shader.getShaderSource() + '\0';
    }
    if (const auto* vertices = dynamic_cast<const osg::VertexProgram*>(&program))
        texts = vertices->getVertexProgram();
    if (const auto* fragments = dynamic_cast<const osg::FragmentProgram*>(&program))
        texts = fragments->getFragmentProgram();
    return std::hash<std::string>()(texts);
}

std::string OwnPrograms::describe(const osg::StateAttribute& program, const osg::NodePath& path)
{
    if (!program.getName().empty()) return "The program \"" + program.getName() + "\"";
    std::string names;
    if (const auto* shaders = dynamic_cast<const osg::Program*>(&program))
    {
        for (unsigned int i = 0; i < shaders->getNumShaders(); ++i)
        {
            const osg::Shader& shader = *shaders->getShader(i);
            const std::string& name = shader.getName().empty() ? shader.getFileName() : shader.getName();
            if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
        }
    }
    else
    {
        names = program.getCompoundClassName();
    }
    const auto named = std::find_if(path.rbegin(), path.rend(),
                                    [](const osg::Node* node) { return !node->getName().empty(); });
    std::string text = names.empty() ? "A program without a name" : "The program of " + names;
    if (named != path.rend())
        text += ", at the node \"" + (*named)->getName() + "\",";
    else if (!path.empty())
        text += ", at a node of the class " + path.back()->getCompoundClassName() + ",";
    return text;
}

} // namespace osgGeoFX
