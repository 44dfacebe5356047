// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/AdaptedPrograms.h>

#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>
#include <osgGeoFX/scene/detail/ShaderText.h>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

constexpr const char* file = "stages/adapted.glsl";
constexpr const char* fixedFile = "stages/fixed.vert";

bool isRead(const osg::Shader& shader)
{
    return !EffectProgram::isFunctions(shader);
}

} // namespace

/// The application's shaders of one stage.
struct ProgramAdaptation::Stage
{
    struct Unit
    {
        const osg::Shader* shader;
        ShaderText text;
    };
    osg::Shader::Type type;
    std::vector<Unit> units;

    Stage(const osg::Program& program, osg::Shader::Type wanted) : type(wanted)
    {
        for (unsigned int i = 0; i < program.getNumShaders(); ++i)
        {
            const osg::Shader& shader = *program.getShader(i);
            if (shader.getType() == wanted && isRead(shader))
                units.push_back({&shader, ShaderText(shader.getShaderSource())});
        }
    }

    bool empty() const { return units.empty(); }
    template<class Test>
    bool any(const Test& test) const
    {
        return std::any_of(units.begin(), units.end(), [&](const Unit& each) { return test(each.text); });
    }
    bool names(const std::string& word) const
    {
        return any([&](const ShaderText& text) { return text.names(word); });
    }
    bool calls(const std::string& function) const
    {
        return std::any_of(units.begin(), units.end(),
                           [&](const Unit& each)
                           { return OwnPrograms::calls(each.shader->getShaderSource(), function); });
    }
    bool isLogarithmic() const { return (names("log2") || names("log")) && !names("gl_FragCoord"); }
    /// A depth that does not come from the fragment's place, and so would stay behind.
    bool writesOwnDepth() const
    {
        return any(
            [](const ShaderText& text)
            { return text.names("gl_FragDepth") && !text.assignsFrom("gl_FragDepth", "gl_FragCoord"); });
    }
    /// How the depths are made that scenes can move.
    FragmentDepth depth() const
    {
        if (!writesOwnDepth()) return FragmentDepth::OF_PLACE;
        if (isLogarithmic()) return FragmentDepth::LOGARITHMIC;
        return names("gl_ProjectionMatrix") ? FragmentDepth::PROJECTED : FragmentDepth::UNKNOWN;
    }
    /// The first shader with a `main`.
    const Unit* mainUnit() const
    {
        const auto found = std::find_if(units.begin(), units.end(),
                                        [](const Unit& unit) { return unit.text.names("main"); });
        return found == units.end() ? nullptr : &*found;
    }
    /// Why `main` cannot get another name; empty where it can.
    std::string mainRefusal(const std::string& stage) const
    {
        if (!names("main")) return stage + " has no main()";
        if (any([](const ShaderText& text) { return text.redefines("main"); }))
            return stage + " defines main by a directive";
        return {};
    }
};

ProgramAdaptation::ProgramAdaptation(const osg::Program& program)
{
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
    {
        const osg::Shader* shader = program.getShader(i);
        if (isRead(*shader)) _sources.emplace_back(shader, shader->getShaderSource());
    }
    for (const auto& [name, location] : program.getFragDataBindingList())
        _bindings.emplace_back(name, location);
    try
    {
        adapt(program);
    }
    catch (const ShaderError& error)
    {
        refuse(error.what());
    }
}

bool ProgramAdaptation::isOf(const osg::Program& program) const
{
    std::size_t next = 0;
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
    {
        const osg::Shader* shader = program.getShader(i);
        if (!isRead(*shader)) continue;
        if (next == _sources.size() || _sources[next].first != shader ||
            _sources[next].second != shader->getShaderSource())
            return false;
        ++next;
    }
    const auto& bindings = program.getFragDataBindingList();
    return next == _sources.size() &&
           std::equal(bindings.begin(), bindings.end(), _bindings.begin(), _bindings.end(),
                      [](const auto& a, const auto& b)
                      { return a.first == b.first && a.second == b.second; });
}

void ProgramAdaptation::apply(osg::Program& copy) const
{
    for (const auto& [former, text] : _replaced)
    {
        for (unsigned int i = 0; i < copy.getNumShaders(); ++i)
        {
            if (copy.getShader(i) != former) continue;
            const osg::ref_ptr<osg::Shader> ours = osg::clone(former, osg::CopyOp::SHALLOW_COPY);
            ours->setShaderSource(text);
            copy.removeShader(copy.getShader(i));
            copy.addShader(ours);
            break;
        }
    }
    if (_main.empty()) return;
    copy.addShader(ProfileProgram::createShader(_lastStage, _main, _fixedVertices ? fixedFile : file));
}

void ProgramAdaptation::adapt(const osg::Program& program)
{
    const Stage vertex(program, osg::Shader::VERTEX);
    const Stage tessellation(program, osg::Shader::TESSEVALUATION);
    const Stage geometry(program, osg::Shader::GEOMETRY);
    const Stage fragment(program, osg::Shader::FRAGMENT);
    for (const Stage* stage : {&vertex, &tessellation, &geometry, &fragment})
    {
        if (stage->any([](const ShaderText& text) { return text.embedded(); }))
            return refuse("it is written for OpenGL ES");
        if (std::any_of(stage->units.begin(), stage->units.end(),
                        [](const Stage::Unit& unit) { return unit.shader->getShaderBinary() != nullptr; }))
            return refuse("it has a shader without a text");
    }
    if (vertex.empty())
        return tessellation.empty() && geometry.empty() && !fragment.empty()
                   ? adaptFragments(program, fragment)
                   : refuse("it has no vertex shader");
    const Stage& last = !geometry.empty() ? geometry : !tessellation.empty() ? tessellation : vertex;
    // One that was written for us gets the functions and nothing else.
    if (vertex.calls("geofx_vertex") || tessellation.calls("geofx_vertex") || geometry.calls("geofx_vertex"))
        return;
    if (!last.names("gl_Position")) return refuse("it does not write gl_Position");
    const auto projects = [](const ShaderText& text)
    {
        return text.names("ftransform") || text.namesLike("mat4") || text.namesLike("gl_ModelView") ||
               text.namesLike("gl_Projection");
    };
    if (!vertex.any(projects) && !tessellation.any(projects) && !geometry.any(projects))
        return refuse("no matrix takes its vertices to the picture, so they have no place on the ground");
    if (last.any([](const ShaderText& text) { return text.declaresOut("gl_PerVertex"); }))
        return refuse("it declares gl_PerVertex anew");

    const FragmentDepth depth = fragment.depth();
    if (depth == FragmentDepth::UNKNOWN)
        return refuse("its fragment shader writes a gl_FragDepth that cannot follow what moves");
    const std::string refusal =
        fragment.empty() ? std::string() : fragment.mainRefusal("its fragment shader");
    if (depth != FragmentDepth::OF_PLACE && !refusal.empty()) return refuse(refusal);
    if (&last == &geometry)
        adaptEmissions(geometry);
    else
        adaptPlaces(last);
    if (!_refusal.empty()) return;
    addMain(last,
            &last == &geometry ? "void geofx_emitVertex()\n{\n    geofx_moveHost();\n    EmitVertex();\n}\n"
                               : "void geofx_hostMain();\nvoid main()\n{\n    geofx_hostMain();\n"
                                 "    geofx_moveHost();\n}\n",
            depth);
    if (fragment.empty())
        _colorRefusal = "it has no fragment shader";
    else if (!refusal.empty())
        _colorRefusal = refusal;
    else
        adaptColors(program, fragment, depth);
}

void ProgramAdaptation::adaptFragments(const osg::Program& program, const Stage& fragment)
{
    if (fragment.depth() != FragmentDepth::OF_PLACE)
        return refuse(
            "its fragment shader writes a gl_FragDepth, and no vertex shader of its own says of what");
    const ShaderLibrary library;
    _fixedVertices = true;
    _lastStage = osg::Shader::VERTEX;
    _main = library.assemble(library.read(fixedFile), fixedFile);
    _colorRefusal = fragment.mainRefusal("its fragment shader");
    if (_colorRefusal.empty()) adaptColors(program, fragment, FragmentDepth::OF_PLACE);
}

void ProgramAdaptation::adaptPlaces(const Stage& last)
{
    const std::string refusal = last.mainRefusal(
        last.type == osg::Shader::VERTEX ? "its vertex shader" : "its tessellation evaluation shader");
    if (!refusal.empty()) return refuse(refusal);
    for (const Stage::Unit& unit : last.units)
    {
        if (unit.text.names("main"))
            _replaced.emplace_back(unit.shader, unit.text.withDirective("#define main geofx_hostMain"));
    }
}

void ProgramAdaptation::adaptEmissions(const Stage& geometry)
{
    const auto refuses = [](const ShaderText& text)
    {
        return text.names("EmitStreamVertex") || text.redefines("EmitVertex");
    };
    if (geometry.any([](const ShaderText& text) { return text.version() < 150; }))
        return refuse("its geometry shader is older than GLSL 1.50");
    if (geometry.any(refuses) || !geometry.names("EmitVertex"))
        return refuse("its geometry shader emits vertices in another way than by EmitVertex()");
    for (const Stage::Unit& unit : geometry.units)
    {
        if (!unit.text.names("EmitVertex")) continue;
        std::string text = unit.text.withDirective("#define EmitVertex geofx_emitVertex");
        if (!unit.text.addDeclaration("void geofx_emitVertex();", text))
            return refuse("its geometry shader has an #extension behind its first declaration");
        _replaced.emplace_back(unit.shader, text);
    }
}

void ProgramAdaptation::addMain(const Stage& last, const std::string& main, FragmentDepth depth)
{
    const bool vertices = last.type == osg::Shader::VERTEX;
    std::string defines;
    const auto define = [&](bool on, const char* name)
    {
        if (on) defines += std::string("#define ") + name + '\n';
    };
    define(!vertices, "GEOFX_LATER_STAGE");
    define(last.type == osg::Shader::TESSEVALUATION, "GEOFX_EVALUATION");
    // The names behind OSG's vertex attribute aliasing, which programs for a core profile may write themselves.
    define(vertices && (last.names("gl_Vertex") || last.names("ftransform") || last.names("osg_Vertex")),
           "GEOFX_HOST_VERTEX");
    define(vertices && (last.names("gl_Normal") || last.names("osg_Normal")), "GEOFX_HOST_NORMAL");
    define(!vertices && last.names("gl_TexCoord"), "GEOFX_HOST_TEXTURE");
    define(last.names("gl_ClipVertex") || last.names("gl_ClipDistance"), "GEOFX_HOST_CLIPS");
    define(last.names("log2") || last.names("log"), "GEOFX_HOST_LOG");
    define(depth != FragmentDepth::OF_PLACE, "GEOFX_HOST_DEPTH");
    const ShaderLibrary library;
    const char* version = last.type == osg::Shader::TESSEVALUATION ? "#version 400 compatibility\n"
                                                                   : "#version 330 compatibility\n";
    _lastStage = last.type;
    _main = library.assemble(version + defines + library.read(file) + main, file);
}

/// What the fragment stage puts out as its color, and the shader whose text knows it by that name.
struct ProgramAdaptation::Color
{
    const Stage::Unit* unit = nullptr;
    std::string name;
    bool unclear = false; ///< there is one, but which?

    Color(const osg::Program& program, const Stage& fragment)
    {
        int count = 0;
        const auto& bindings = program.getFragDataBindingList();
        for (const Stage::Unit& each : fragment.units)
        {
            for (const ShaderText::Output& output : each.text.outputs())
            {
                const auto bound = bindings.find(output.name);
                const int location = output.location < 0 && bound != bindings.end()
                                         ? static_cast<int>(bound->second)
                                         : output.location;
                if (location > 0) continue;
                ++count;
                unclear = unclear || count > 1 || output.type != "vec4";
                unit = &each;
                name = output.array ? output.name + "[0]" : output.name;
            }
        }
        // Under conditions a text may have both kinds, and the name that it declares then is a macro for the built-in one.
        if (count > 0) return;
        const bool plain = fragment.names("gl_FragColor");
        const bool data = fragment.names("gl_FragData");
        unclear = plain && data;
        if (!plain && !data) return;
        name = plain ? "gl_FragColor" : "gl_FragData[0]";
        unit = fragment.mainUnit();
    }
};

void ProgramAdaptation::adaptColors(const osg::Program& program, const Stage& fragment, FragmentDepth depth)
{
    Color color(program, fragment);
    const bool called = fragment.calls("geofx_fragment");
    if (color.unclear)
        _colorRefusal = "the text of its fragment shader does not tell which output is the color";
    if (color.unclear || called) color.name.clear();
    const bool ownDepth = depth != FragmentDepth::OF_PLACE;
    if (color.name.empty() && !ownDepth) return;
    const Stage::Unit* const place = color.name.empty() ? fragment.mainUnit() : color.unit;
    for (const Stage::Unit& unit : fragment.units)
    {
        const bool hasMain = unit.text.names("main");
        if (!hasMain && &unit != place) continue;
        std::string text =
            hasMain ? unit.text.withDirective("#define main geofx_hostMain") : unit.shader->getShaderSource();
        if (&unit == place)
        {
            text += "\n#undef main\n#pragma import_defines(GEOFX_REVERSED_DEPTH)\n";
            if (ownDepth)
                text +=
                    std::string(unit.text.version() < 130 ? "varying" : "in") + " vec2 geofx_hostPlace;\n";
            if (!color.name.empty()) text += "vec4 geofx_fragment(vec4 color, vec4 map);\n";
            text += "void geofx_hostMain();\nvoid main()\n{\n    geofx_hostMain();\n";
            if (depth == FragmentDepth::LOGARITHMIC)
                text +=
                    "    gl_FragDepth *= log2(1.0 + 1.0 / gl_FragCoord.w) / log2(1.0 + geofx_hostPlace.y);\n";
            // As many metres nearer or farther than its place. Depth grows as the distance over its square.
            if (depth == FragmentDepth::PROJECTED)
                text +=
                    "    float geofx_far = geofx_hostPlace.y * gl_FragCoord.w;\n"
                    "    float geofx_former = 0.5 * (gl_DepthRange.diff * geofx_hostPlace.x / "
                    "geofx_hostPlace.y + "
                    "gl_DepthRange.near + gl_DepthRange.far);\n"
                    // With glClipControl; where depths are reversed, the two are apart.
                    "#ifdef GEOFX_REVERSED_DEPTH\n"
                    "    float geofx_other = gl_DepthRange.near + gl_DepthRange.diff * geofx_hostPlace.x / "
                    "geofx_hostPlace.y;\n"
                    "    if (abs(gl_FragDepth - geofx_other) < abs(gl_FragDepth - geofx_former))\n"
                    "        geofx_former = geofx_other;\n"
                    "#endif\n"
                    "    if (gl_FragDepth != gl_FragCoord.z)\n        gl_FragDepth = gl_FragCoord.z + "
                    "geofx_far * geofx_far * (gl_FragDepth - geofx_former);\n";
            if (!color.name.empty())
                text += "    " + color.name + " = geofx_fragment(" + color.name + ", vec4(0.0));\n";
            text += "}\n";
        }
        _replaced.emplace_back(unit.shader, text);
    }
}

AdaptedPrograms& AdaptedPrograms::instance()
{
    static AdaptedPrograms all;
    return all;
}

void AdaptedPrograms::add(const osg::Program& program)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Known& known = _known[&program];
    if (known.program.valid()) return;
    known.program = &program;
    known.adaptation = nullptr;
    if (_known.size() <= _purgeSize) return;
    for (auto each = _known.begin(); each != _known.end();)
        each = each->second.program.valid() ? std::next(each) : _known.erase(each);
    _purgeSize = 2 * _known.size() + 64;
}

std::shared_ptr<const ProgramAdaptation> AdaptedPrograms::of(const osg::Program& program)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _known.find(&program);
    if (found == _known.end() || !found->second.program.valid()) return nullptr;
    Known& known = found->second;
    if (!known.adaptation || !known.adaptation->isOf(program))
        known.adaptation = std::make_shared<const ProgramAdaptation>(program);
    return known.adaptation;
}

} // namespace osgGeoFX
