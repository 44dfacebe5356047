// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/detail/ProfileProgram.h>

#include <osg/Notify>
#include <osg/State>
#include <osg/observer_ptr>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Marks a shader as one of the kit's, and keeps its translation, which all programs share.
class Translation : public osg::Referenced
{
public:
    osg::ref_ptr<osg::Shader> of(const osg::Shader& shader)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (!_core)
        {
            _core = new osg::Shader(shader.getType(),
                                    ProfileProgram::coreText(shader.getShaderSource(), shader.getType()));
            _core->setName(shader.getName());
        }
        return _core;
    }

protected:
    ~Translation() override = default;

private:
    std::mutex _mutex;
    osg::ref_ptr<osg::Shader> _core;
};

bool isPartOfWord(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Replaces a word; whether it was there.
bool replaceWord(std::string& text, const std::string& word, const std::string& by)
{
    bool found = false;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
    {
        const std::size_t end = at + word.size();
        const bool whole =
            (at == 0 || !isPartOfWord(text[at - 1])) && (end == text.size() || !isPartOfWord(text[end]));
        if (whole) text.replace(at, word.size(), by);
        at += whole ? by.size() : word.size();
        found = found || whole;
    }
    return found;
}

/// A program that draws nothing. Without a program, a driver draws what it likes: NVIDIA's draws white.
osg::ref_ptr<osg::Program> makeNothing()
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("nothing, in a core profile");
    program->addShader(new osg::Shader(
        osg::Shader::VERTEX, "#version 330 core\nvoid main() { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); }\n"));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT, "#version 330 core\nvoid main() { discard; }\n"));
    return program;
}

void warnOfFixedFunctions()
{
    static std::atomic<bool> said{false};
    if (!said.exchange(true))
        OSG_WARN
            << "osgGeoFX: geometry below effects has no program, and the kit's stand-in for OpenGL's fixed "
               "functions needs a context with the compatibility profile; it is not drawn. Give it a program "
               "(EffectScene::addFunctions() or adapt()), or ask for such a context."
            << std::endl;
}

void copyRest(const osg::Program& from, osg::Program& to)
{
    // What OSG's own copy leaves out.
    for (const auto& [name, binding] : from.getUniformBlockBindingList())
        to.addBindUniformBlock(name, binding);
    const osg::ShaderDefines& defines = from.getShaderDefines();
    to.getShaderDefines().insert(defines.begin(), defines.end());
}

/// What programs have in contexts. OSG itself makes room for a context where it looks for it, without a lock, while the thread of another
/// context may draw with the program.
class Contents : public osg::Program
{
public:
    static bool has(const osg::Program& program, unsigned int context)
    {
        const auto& all = program.*(&Contents::_pcpList);
        return context < all.size() && all[context].valid();
    }
};

/// Those that releaseAll() finds. Thread-safe.
class Programs
{
public:
    /// Never deleted: programs may outlive what is static.
    static Programs& instance()
    {
        static auto* const programs = new Programs;
        return *programs;
    }
    void add(osg::Program& program)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_all.size() >= _purgeSize)
        {
            const auto gone = [](const osg::observer_ptr<osg::Program>& each)
            {
                return !each.valid();
            };
            _all.erase(std::remove_if(_all.begin(), _all.end(), gone), _all.end());
            _purgeSize = 2 * _all.size() + 64;
        }
        _all.emplace_back(&program);
    }
    std::vector<osg::ref_ptr<osg::Program>> living()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        std::vector<osg::ref_ptr<osg::Program>> result;
        for (const osg::observer_ptr<osg::Program>& each : _all)
        {
            osg::ref_ptr<osg::Program> program;
            if (each.lock(program)) result.push_back(program);
        }
        return result;
    }

private:
    std::mutex _mutex;
    std::vector<osg::observer_ptr<osg::Program>> _all;
    std::size_t _purgeSize = 64;
};

} // namespace

ProfileProgram::ProfileProgram()
{
    watch(*this);
}

ProfileProgram::ProfileProgram(const osg::Program& other) : osg::Program(other)
{
    copyRest(other, *this);
    watch(*this);
}

void ProfileProgram::watch(osg::Program& program)
{
    Programs::instance().add(program);
}

void ProfileProgram::releaseAll(osg::State& state)
{
    for (const osg::ref_ptr<osg::Program>& program : Programs::instance().living())
        if (Contents::has(*program, state.getContextID())) program->releaseGLObjects(&state);
}

ProfileProgram::~ProfileProgram() = default;

bool ProfileProgram::isCore(const osg::State& state)
{
    return state.getUseModelViewAndProjectionUniforms() && state.getUseVertexAttributeAliasing();
}

osg::ref_ptr<osg::Shader> ProfileProgram::createShader(osg::Shader::Type stage, const std::string& text,
                                                       const std::string& name)
{
    osg::ref_ptr<osg::Shader> shader = new osg::Shader(stage, text);
    shader->setName(name);
    shader->setUserData(new Translation);
    return shader;
}

std::string ProfileProgram::coreText(const std::string& text, osg::Shader::Type stage)
{
    const std::size_t end = text.find('\n');
    std::string version = text.substr(0, end), rest = end == std::string::npos ? "" : text.substr(end + 1);
    replaceWord(version, "compatibility", "core");
    std::string declarations;
    if (stage != osg::Shader::VERTEX)
    {
        for (const auto& [type, name] :
             {std::pair{"mat4", "ModelViewMatrix"}, std::pair{"mat4", "ProjectionMatrix"},
              std::pair{"mat4", "ModelViewProjectionMatrix"}, std::pair{"mat3", "NormalMatrix"}})
        {
            const std::string ours = std::string("osg_") + name;
            if (replaceWord(rest, std::string("gl_") + name, ours))
                declarations += std::string("uniform ") + type + " " + ours + "; ";
        }
    }
    // Textures of normals have texture matrices, so normals are those of the vertices.
    replaceWord(rest, "GEOFX_NORMAL_MAP", "GEOFX_NO_NORMAL_MAP");
    if (replaceWord(rest, "gl_ClipVertex", "geofx_clipVertex")) declarations += "vec4 geofx_clipVertex; ";
    if (stage == osg::Shader::FRAGMENT && replaceWord(rest, "gl_FragColor", "geofx_fragColor"))
        declarations += "out vec4 geofx_fragColor; ";
    if (!declarations.empty()) declarations += '\n';
    return version + "\n#define GEOFX_CORE\n" + declarations + "#line 2\n" + rest;
}

std::mutex& ProfileProgram::sharing()
{
    static std::mutex mutex;
    return mutex;
}

bool ProfileProgram::standsInForFixedFunctions() const
{
    for (const auto& shader : _shaderList)
        if (shader->getName().rfind("stages/fixed.", 0) == 0) return true;
    return false;
}

osg::ref_ptr<osg::Program> ProfileProgram::core() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_core) return _core;
    if (standsInForFixedFunctions())
    {
        warnOfFixedFunctions();
        _core = makeNothing();
        watch(*_core);
        return _core;
    }
    const std::lock_guard<std::mutex> other(sharing());
    _core = new osg::Program(*this, osg::CopyOp::SHALLOW_COPY);
    for (const auto& shader : _shaderList)
        _core->removeShader(shader);
    for (const auto& shader : _shaderList)
    {
        auto* translation = dynamic_cast<Translation*>(shader->getUserData());
        _core->addShader(translation ? translation->of(*shader) : shader);
    }
    copyRest(*this, *_core);
    watch(*_core);
    return _core;
}

osg::ref_ptr<osg::Program> ProfileProgram::coreIfMade() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _core;
}

void ProfileProgram::apply(osg::State& state) const
{
    if (!isCore(state)) return osg::Program::apply(state);
    core()->apply(state);
}

void ProfileProgram::compileGLObjects(osg::State& state) const
{
    if (!isCore(state)) return osg::Program::compileGLObjects(state);
    core()->compileGLObjects(state);
}

void ProfileProgram::setThreadSafeRefUnref(bool threadSafe)
{
    osg::Program::setThreadSafeRefUnref(threadSafe);
    if (const osg::ref_ptr<osg::Program> program = coreIfMade()) program->setThreadSafeRefUnref(threadSafe);
}

void ProfileProgram::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Program::resizeGLObjectBuffers(maxSize);
    if (const osg::ref_ptr<osg::Program> program = coreIfMade()) program->resizeGLObjectBuffers(maxSize);
}

void ProfileProgram::releaseGLObjects(osg::State* state) const
{
    osg::Program::releaseGLObjects(state);
    if (const osg::ref_ptr<osg::Program> program = coreIfMade()) program->releaseGLObjects(state);
}

} // namespace osgGeoFX
