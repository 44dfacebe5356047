// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/EffectProgram.h>

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/NormalTurner.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>

#include <osg/Notify>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

std::string replaced(std::string text, const std::string& word, const std::string& by)
{
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
    {
        text.replace(at, word.size(), by);
    }
    return text;
}

/// The file that turns the normals of fragments; empty where they stay as they are.
std::string normalFile(const Deformation& deformation)
{
    const auto* turner = dynamic_cast<const NormalTurner*>(&deformation);
    return turner ? turner->normalFile() : std::string();
}

/// What stands in the place of the words in capitals in stages/functions.*.
struct Parts
{
    std::string imports, functions, locate, face, deform, normal, turn, first, color, light, move, finish,
        pixel;

    std::string fill(std::string text) const
    {
        text = replaced(std::move(text), "GEOFX_IMPORTED_EFFECTS", imports);
        text = replaced(std::move(text), "GEOFX_EFFECT_FUNCTIONS", functions);
        text = replaced(std::move(text), "GEOFX_LOCATE_CALLS", locate);
        text = replaced(std::move(text), "GEOFX_FACE_CALLS", face);
        text = replaced(std::move(text), "GEOFX_DEFORM_CALLS", deform);
        text = replaced(std::move(text), "GEOFX_NORMAL_CALLS", normal);
        text = replaced(std::move(text), "GEOFX_COLOR_CALLS", first + color);
        text = replaced(std::move(text), "GEOFX_LIGHT_CALLS", light);
        text = replaced(std::move(text), "GEOFX_MOVE_CALLS", move);
        text = replaced(std::move(text), "GEOFX_PIXEL_CALLS", pixel);
        return replaced(std::move(text), "GEOFX_FINISH_CALLS", finish);
    }
};

std::string fileOf(osg::Shader::Type stage)
{
    return stage == osg::Shader::FRAGMENT ? "stages/functions.frag" : "stages/functions.vert";
}

constexpr const char* passName = "osgGeoFX pass";

/// Those that have functions.
constexpr osg::Shader::Type functionStages[] = {osg::Shader::VERTEX, osg::Shader::TESSEVALUATION,
                                                osg::Shader::GEOMETRY, osg::Shader::FRAGMENT};

bool hasStage(const osg::Program& program, osg::Shader::Type stage)
{
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
    {
        const osg::Shader& shader = *program.getShader(i);
        if (shader.getType() == stage && !EffectProgram::isFunctions(shader)) return true;
    }
    return false;
}

/// The vertex stage's functions in a later stage, which has no attributes.
std::string inLaterStage(std::string text, osg::Shader::Type stage)
{
    std::string start = stage == osg::Shader::TESSEVALUATION ? "#version 400 compatibility\n"
                                                             : "#version 330 compatibility\n";
    start += "#define GEOFX_LATER_STAGE\n";
    // The version is the first line.
    text.replace(0, text.rfind("#version", 0) == 0 ? text.find('\n') + 1 : 0, start);
    return replaced(text, "gl_MultiTexCoord0", "geofx_textureCoordinates");
}

std::string conditional(const std::string& condition, const std::string& text)
{
    return "#if " + condition + "\n" + text + "#endif\n";
}

void addDeformation(Parts& parts, const Deformation& deformation, const std::string& prefix,
                    const std::string& define)
{
    const std::string move = "    position = " + prefix + "deform(position);\n";
    std::string deform = "    geofx_styleBlend = max(geofx_styleBlend, ";
    deform += prefix + "style(position));\n";
    if (deformation.carriesThings())
        deform +=
            conditional("defined(GEOFX_RIGID)", "    offset = " + prefix + "carried(position, offset);\n");
    deform += move;
    parts.deform += conditional("defined(" + define + ")", deform);
    std::string normal = "    normal = ";
    normal += prefix + "normal(position, normal);\n";
    normal += move;
    parts.normal += conditional("defined(" + define + ")", normal);
    if (!normalFile(deformation).empty())
        parts.turn += conditional("defined(" + define + ")",
                                  "    normal = " + prefix + "normal(geofx_groundPlace, normal);\n");
    if (deformation.fragmentFile().empty()) return;
    parts.color += conditional("defined(GEOFX_DEFORMATION) && defined(" + define + ")",
                               "    result = " + prefix + "restyle(result, map, geofx_styleBlend);\n");
}

void addSurface(Parts& parts, const SurfaceEffect& surface, const std::string& prefix,
                const std::string& define)
{
    if (surface.looksAtNormals())
        parts.face += conditional("defined(" + define + ")", "    " + prefix + "face(eyeNormal);\n");
    parts.locate += conditional("defined(" + define + ")", "    " + prefix + "locate(located);\n");
    const std::string color =
        conditional("defined(" + define + ")", "    result = " + prefix + "color(result);\n");
    if (surface.shadesLight())
        parts.light += conditional("defined(" + define + ")", "    light *= " + prefix + "sunlight();\n");
    if (surface.comesFirst())
        parts.first += color;
    else
        parts.color += color;
}

/// The code of all effects for one stage.
Parts partsOf(const std::vector<osg::ref_ptr<Effect>>& effects, const ShaderLibrary& library, bool vertex)
{
    Parts parts;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Deformation* deformation = effects[i]->asDeformation();
        const SurfaceEffect* surface = effects[i]->asSurfaceEffect();
        if (!deformation && !surface) continue;
        const std::string prefix = EffectProgram::prefix(i);
        std::string text;
        // Short lines: some drivers broke on long ones.
        if (deformation)
        {
            const std::string define = EffectProgram::define(i);
            parts.imports += "#pragma import_defines(" + define + ")\n";
            for (const std::string& file :
                 vertex ? std::vector{deformation->vertexFile()}
                        : std::vector{normalFile(*deformation), deformation->fragmentFile()})
                if (!file.empty())
                    text += (text.empty() ? deformation->constants() : "") + library.read(file);
            addDeformation(parts, *deformation, prefix, define);
        }
        if (surface)
        {
            const std::string define = EffectProgram::surfaceDefine(i);
            parts.imports += "#pragma import_defines(" + define + ")\n";
            text += library.read(vertex ? surface->vertexFile() : surface->fragmentFile());
            addSurface(parts, *surface, prefix, define);
        }
        parts.functions += replaced(text, "SLOT_", prefix);
    }
    if (!vertex) parts.normal = parts.turn;
    return parts;
}

std::string joined(const ShaderLibrary& library, const std::vector<std::string>& files,
                   const std::string& prefix)
{
    std::string text;
    for (const std::string& file : files)
        text += library.read(file);
    return replaced(text, "SLOT_", prefix);
}

/// A varying under its whole name.
struct Handed
{
    Varying varying;
    std::string define = {}; ///< without which it is not there
};

/// What effects and stages/functions.vert hand to the fragment stage.
std::vector<Handed> allVaryings(const EffectProgram::Effects& effects)
{
    std::vector<Handed> all;
    const auto add = [&](const std::vector<Varying>& varyings, std::size_t effect)
    {
        for (const Varying& each : varyings)
            all.push_back({{each.type, EffectProgram::prefix(effect) + each.name, each.flat}});
    };
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        if (const Deformation* deformation = effects[i]->asDeformation()) add(deformation->varyings(), i);
        if (const SurfaceEffect* surface = effects[i]->asSurfaceEffect()) add(surface->varyings(), i);
    }
    all.push_back({{"float", "geofx_styleBlend"}});
    all.push_back({{"vec3", "geofx_shade"}, "GEOFX_SHADOWED"});
    all.push_back({{"vec2", "geofx_normalPlace"}, "GEOFX_NORMAL_MAP"});
    all.push_back({{"vec3", "geofx_groundPlace"}, "GEOFX_NORMAL_MAP"});
    return all;
}

/// What a pass within another one has to hand on for that one.
std::vector<Handed> varyingsFor(const EffectProgram::Effects& effects, const PassShaders& pass)
{
    std::vector<Handed> all = allVaryings(effects);
    if (!pass.within) return all;
    for (const Varying& each : pass.within->varyings)
        all.push_back({{each.type, pass.withinPrefix + each.name, each.flat}});
    return all;
}

/// Adds what a pass has in the vertex stage.
void addMove(Parts& parts, const EffectProgram::Effects& effects, const ShaderLibrary& library,
             const PassShaders& pass, const std::string& prefix)
{
    const bool amplified = !pass.geometry.empty();
    const bool tessellated = !pass.tessellationControl.empty();
    if (amplified)
    {
        // Later stages hand the values on under the names that the fragment stage knows.
        parts.imports += "#define GEOFX_AMPLIFY\n";
        if (tessellated) parts.imports += "#define GEOFX_TESSELLATE\n";
        for (const Handed& each : varyingsFor(effects, pass))
            parts.imports += "#define " + each.varying.name + " " + each.varying.name +
                             (tessellated ? "_vertex\n" : "_in\n");
    }
    parts.functions += joined(library, pass.vertex, prefix);
    std::string mover = prefix;
    if (pass.within)
    {
        // The other pass has no geometry stage.
        parts.functions += "#undef GEOFX_AMPLIFY\n" + joined(library, pass.within->vertex, pass.withinPrefix);
        mover = pass.withinPrefix;
    }
    parts.move = "    return geofx_drawnAt(" + mover + "move(located, position));\n";
}

/// Adds what a pass has in the fragment stage.
void addFinish(Parts& parts, const ShaderLibrary& library, const PassShaders& pass, const std::string& prefix)
{
    // Which mappings show is the pass' own choice, among those that the subgraph takes.
    const std::string channels = "#ifdef GEOFX_MAPPING_CHANNELS\n"
                                 "const int geofx_subgraphChannels = GEOFX_MAPPING_CHANNELS;\n"
                                 "#undef GEOFX_MAPPING_CHANNELS\n"
                                 "#else\n"
                                 "const int geofx_subgraphChannels = 255;\n"
                                 "#endif\n"
                                 "#define GEOFX_MAPPING_CHANNELS (geofx_subgraphChannels & " +
                                 prefix + "channels())\n";
    parts.imports += "#pragma import_defines(GEOFX_MAPPING_CHANNELS)\n";
    if (!pass.geometry.empty()) parts.imports += "#define GEOFX_AMPLIFY\n";
    parts.functions = joined(library, pass.fragment, prefix) + channels + parts.functions;
    parts.finish = "    result = " + prefix + "finish(result);\n";
    parts.pixel = "    pixel = " + prefix + "pixel(pixel);\n";
}

/// How a stage between the vertices and the fragments hands the other effects' variables on.
struct Relay
{
    const char* from; ///< endings of the names
    const char* to;
    const char* fromArray;
    const char* toArray;
    const char* place; ///< where GEOFX_COPY stands
};

std::string copyOf(const Varying& varying, const Relay& relay)
{
    const std::string from = varying.name + relay.from;
    const std::string to = varying.name + relay.to;
    if (*relay.toArray) return to + "[gl_InvocationID] = " + from + "[gl_InvocationID];";
    if (std::string(relay.place) == "GEOFX_COPY(i)") return to + " = " + from + "[i];";
    if (varying.flat) return to + " = " + from + "[0];";
    return to + " = w.x * " + from + "[0] + w.y * " + from + "[1] + w.z * " + from + "[2];";
}

constexpr const char* laterVersion = "#version 400 compatibility\n";
constexpr Relay toControl = {"_vertex", "_control", "[]", "[]", "GEOFX_COPY(gl_InvocationID)"};

/// The main function of a stage between vertices and fragments: its text with all that is handed on.
std::string relayText(const Parts& parts, const std::vector<Handed>& handed, const std::string& main,
                      const Relay& relay, const char* version)
{
    std::string declarations, copies;
    for (const Handed& each : handed)
    {
        const Varying& varying = each.varying;
        const std::string qualifier = varying.flat ? "flat " : "";
        std::string declaration =
            qualifier + "in " + varying.type + " " + varying.name + relay.from + relay.fromArray + ";\n";
        declaration +=
            qualifier + "out " + varying.type + " " + varying.name + relay.to + relay.toArray + ";\n";
        const std::string copy = copyOf(varying, relay) + "\n";
        const std::string condition = "defined(" + each.define + ")";
        declarations += each.define.empty() ? declaration : conditional(condition, declaration);
        // A condition begins a line.
        copies += each.define.empty() ? copy : "\n" + conditional(condition, copy);
    }
    std::string text = version + parts.imports;
    text += "#pragma import_defines(GEOFX_FOG, GEOFX_TWO_SIDED, GEOFX_COLOR_SUM, GEOFX_MAP)\n"
            "#pragma import_defines(GEOFX_NORMAL_MAP, GEOFX_SHADOWED)\n"
            "#pragma import_defines(GEOFX_TEXTURE_0, GEOFX_TEXTURE_1, GEOFX_TEXTURE_2, GEOFX_TEXTURE_3)\n" +
            main;
    text = replaced(text, "GEOFX_VARYINGS\n", declarations);
    return replaced(text, relay.place, copies);
}

const std::vector<std::string>& relayFiles(const PassShaders& pass, osg::Shader::Type stage)
{
    if (stage == osg::Shader::GEOMETRY) return pass.geometry;
    return stage == osg::Shader::TESSCONTROL ? pass.tessellationControl : pass.tessellationEvaluation;
}

std::string relayText(const EffectProgram::Effects& effects, const ShaderLibrary& library,
                      const PassShaders& pass, const std::string& prefix, osg::Shader::Type stage)
{
    constexpr const char* version = "#version 330 compatibility\n";
    const Parts parts = partsOf(effects, library, true);
    const std::vector<Handed> handed = varyingsFor(effects, pass);
    const std::string main = joined(library, relayFiles(pass, stage), prefix);
    if (stage == osg::Shader::GEOMETRY)
        return relayText(parts, handed, main, {"_in", "", "[]", "", "GEOFX_COPY(i)"}, version);
    if (stage == osg::Shader::TESSCONTROL) return relayText(parts, handed, main, toControl, laterVersion);
    return relayText(parts, handed, main, {"_control", "_in", "[]", "", "GEOFX_COPY(w)"}, laterVersion);
}

/// What the evaluation stage of a tessellating program does not find out itself, from the deformations.
std::vector<Handed> handedByTessellation(const EffectProgram::Effects& effects)
{
    std::vector<Handed> handed = allVaryings(effects);
    const auto drop = [&](const std::string& name)
    {
        handed.erase(std::remove_if(handed.begin(), handed.end(),
                                    [&](const Handed& each) { return each.varying.name == name; }),
                     handed.end());
    };
    drop("geofx_styleBlend");
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Deformation* deformation = effects[i]->asDeformation();
        for (const Varying& each : deformation ? deformation->varyings() : std::vector<Varying>())
            drop(EffectProgram::prefix(i) + each.name);
    }
    return handed;
}

/// The deformations alone, for a tessellation stage.
Parts tessellationParts(const EffectProgram::Effects& effects, const ShaderLibrary& library,
                        osg::Shader::Type stage, std::string& sags)
{
    Parts parts;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Deformation* deformation = effects[i]->asDeformation();
        if (!deformation) continue;
        const std::string prefix = EffectProgram::prefix(i);
        const std::string define = EffectProgram::define(i);
        parts.imports += "#pragma import_defines(" + define + ")\n";
        std::string text = deformation->constants() + library.read(deformation->vertexFile());
        const auto* tessellator = dynamic_cast<const Tessellator*>(deformation);
        if (stage == osg::Shader::TESSCONTROL)
        {
            // It has no such outputs.
            for (const Varying& each : deformation->varyings())
            {
                const std::string declaration = each.type + " SLOT_" + each.name + ";";
                for (const char* output : {"flat out ", "out "})
                    text = replaced(text, std::string(output).append(declaration), declaration);
            }
            if (tessellator) text += library.read(tessellator->tessellationFile());
            std::string call;
            if (tessellator) call += "    sag = max(sag, " + prefix + "sag(from, to));\n";
            for (const char* end : {"from", "to"})
                call.append("    ")
                    .append(end)
                    .append(" = ")
                    .append(prefix)
                    .append("deform(")
                    .append(end)
                    .append(");\n");
            sags += conditional("defined(" + define + ")", call);
        }
        parts.functions += replaced(text, "SLOT_", prefix);
        addDeformation(parts, *deformation, prefix, define);
    }
    parts.functions = replaced(parts.functions, "gl_MultiTexCoord0", "geofx_textureCoordinates");
    return parts;
}

/// OpenGL's own variables, but for the position, in a tessellation stage.
std::string builtIns(osg::Shader::Type stage)
{
    const auto copy = [stage](const std::string& condition, const std::string& name)
    {
        const std::string text = stage == osg::Shader::TESSCONTROL
                                     ? "gl_out[gl_InvocationID]." + name + " = gl_in[gl_InvocationID]." + name
                                     : name + " = w.x * gl_in[0]." + name + " + w.y * gl_in[1]." + name +
                                           " + w.z * gl_in[2]." + name;
        return condition.empty() ? "    " + text + ";\n" : conditional(condition, "    " + text + ";\n");
    };
    std::string all = copy("", "gl_FrontColor");
    all += copy("defined(GEOFX_COLOR_SUM)", "gl_FrontSecondaryColor");
    all += copy("defined(GEOFX_TWO_SIDED)", "gl_BackColor");
    all += copy("defined(GEOFX_TWO_SIDED) && defined(GEOFX_COLOR_SUM)", "gl_BackSecondaryColor");
    all += copy("defined(GEOFX_TEXTURE_0) || defined(GEOFX_MAP)", "gl_TexCoord[0]");
    for (const char* unit : {"1", "2", "3"})
        all += copy(std::string("defined(GEOFX_TEXTURE_") + unit + ")",
                    std::string("gl_TexCoord[") + unit + "]");
    return all + copy("defined(GEOFX_FOG)", "gl_FogFragCoord");
}

/// A tessellation stage of the program that divides triangles.
std::string tessellationText(const EffectProgram::Effects& effects, const ShaderLibrary& library,
                             osg::Shader::Type stage)
{
    const bool control = stage == osg::Shader::TESSCONTROL;
    const std::string file = control ? "stages/tessellation.tesc.glsl" : "stages/tessellation.tese.glsl";
    std::string sags;
    const Parts parts = tessellationParts(effects, library, stage, sags);
    std::string main = replaced(library.read(file), "GEOFX_BUILT_INS\n", builtIns(stage));
    main = parts.fill(replaced(main, "GEOFX_SAG_CALLS\n", sags));
    if (control) main = replaced(main, "GEOFX_MOST_PARTS", std::to_string(TessellatedSnapshot::mostParts));
    const Relay fromControl = {"_control", "", "[]", "", "GEOFX_COPY(w)"};
    return library.assemble(relayText(parts, handedByTessellation(effects), main,
                                      control ? toControl : fromControl, laterVersion),
                            file);
}

/// The functions of its vertex stage, which hands on what it finds, and the undeformed place.
std::string tessellatedVertexText(const EffectProgram::Effects& effects, const ShaderLibrary& library)
{
    const std::string file = fileOf(osg::Shader::VERTEX);
    Parts parts = partsOf(effects, library, true);
    for (const Handed& each : allVaryings(effects))
        parts.imports += "#define " + each.varying.name + " " + each.varying.name + "_vertex\n";
    parts.functions += "out vec3 geofx_undeformed_vertex;\nout vec4 geofx_coordinates_vertex;\n";
    parts.move = "    geofx_undeformed_vertex = eyePosition.xyz / eyePosition.w;\n"
                 "    geofx_coordinates_vertex = gl_MultiTexCoord0;\n";
    return library.assemble(parts.fill(library.read(file)), file);
}

std::string withoutVersion(std::string text)
{
    // The line is left empty, so that a compiler's messages name the right one.
    if (text.compare(0, 8, "#version") == 0) text.erase(0, text.find('\n'));
    return text;
}

osg::ref_ptr<osg::Shader> functionShader(osg::Shader::Type stage, const std::string& text)
{
    return ProfileProgram::createShader(stage, text, fileOf(stage));
}

} // namespace

std::string EffectProgram::prefix(std::size_t effect)
{
    return "geofx_" + std::to_string(effect) + "_";
}

std::string EffectProgram::define(std::size_t effect)
{
    return "GEOFX_EFFECT_" + std::to_string(effect);
}

std::string EffectProgram::surfaceDefine(std::size_t effect)
{
    return "GEOFX_SURFACE_" + std::to_string(effect);
}

std::string EffectProgram::key(const Effects& effects)
{
    std::string key;
    for (const auto& effect : effects)
    {
        const Deformation* deformation = effect->asDeformation();
        if (deformation)
            key += deformation->vertexFile() + normalFile(*deformation) + deformation->fragmentFile() +
                   deformation->constants();
        if (const SurfaceEffect* surface = effect->asSurfaceEffect())
            key += surface->vertexFile() + surface->fragmentFile();
        key += ';';
    }
    for (const Handed& each : allVaryings(effects))
        key += (each.varying.flat ? "flat " : "") + each.varying.type + " " + each.varying.name + ";";
    return key;
}

std::string EffectProgram::functions(const Effects& effects, osg::Shader::Type stage)
{
    const ShaderLibrary library;
    const std::string file = fileOf(stage);
    const Parts parts = partsOf(effects, library, stage != osg::Shader::FRAGMENT);
    std::string text = library.assemble(parts.fill(library.read(file)), file);
    const bool later = stage != osg::Shader::FRAGMENT && stage != osg::Shader::VERTEX;
    return later ? inLaterStage(std::move(text), stage) : text;
}

std::string EffectProgram::hostText(const Effects& effects, osg::Shader::Type stage)
{
    return withoutVersion(functions(effects, stage));
}

std::string EffectProgram::hostText(const Effects& effects, const PassShaders& pass,
                                    const std::string& prefix, osg::Shader::Type stage)
{
    return withoutVersion(passFunctions(effects, pass, prefix, stage));
}

std::string EffectProgram::passFunctions(const Effects& effects, const PassShaders& pass,
                                         const std::string& prefix, osg::Shader::Type stage)
{
    const ShaderLibrary library;
    if (stage != osg::Shader::VERTEX && stage != osg::Shader::FRAGMENT)
    {
        const std::vector<std::string>& files = relayFiles(pass, stage);
        if (files.empty()) return {};
        return library.assemble(relayText(effects, library, pass, prefix, stage), files.back());
    }
    const std::string file = fileOf(stage);
    Parts parts = partsOf(effects, library, stage == osg::Shader::VERTEX);
    if (stage == osg::Shader::VERTEX && !pass.vertex.empty()) addMove(parts, effects, library, pass, prefix);
    if (stage == osg::Shader::FRAGMENT && pass.within)
        addFinish(parts, library, *pass.within, pass.withinPrefix);
    else if (stage == osg::Shader::FRAGMENT && !pass.fragment.empty())
        addFinish(parts, library, pass, prefix);
    return library.assemble(parts.fill(library.read(file)), file);
}

void EffectProgram::addFunctions(osg::Program& program, const Effects& effects)
{
    for (const osg::Shader::Type stage : missingStages(program))
        program.addShader(functionShader(stage, functions(effects, stage)));
}

void EffectProgram::addIdleFunctions(osg::Program& program)
{
    for (const osg::Shader::Type stage : missingStages(program))
        program.addShader(functionShader(stage, ProfileProgram::coreText(functions({}, stage), stage)));
}

void EffectProgram::addFunctionsOf(const osg::Program& like, osg::Program& program)
{
    for (const osg::Shader::Type stage : missingStages(program))
    {
        osg::ref_ptr<osg::Shader> vertex;
        osg::ref_ptr<osg::Shader> found;
        for (unsigned int i = 0; i < like.getNumShaders(); ++i)
        {
            const osg::Shader& shader = *like.getShader(i);
            if (!isFunctions(shader)) continue;
            if (shader.getType() == stage) found = const_cast<osg::Shader*>(&shader);
            if (shader.getType() == osg::Shader::VERTEX) vertex = const_cast<osg::Shader*>(&shader);
        }
        if (!found && vertex) found = functionShader(stage, inLaterStage(vertex->getShaderSource(), stage));
        if (found) program.addShader(found);
    }
}

std::vector<osg::Shader::Type> EffectProgram::missingStages(const osg::Program& program)
{
    std::vector<osg::Shader::Type> missing;
    // The application's shaders may come later.
    const bool empty = std::none_of(std::begin(functionStages), std::end(functionStages),
                                    [&](osg::Shader::Type stage) { return hasStage(program, stage); });
    for (const osg::Shader::Type stage : functionStages)
    {
        const bool wanted =
            empty ? stage == osg::Shader::VERTEX || stage == osg::Shader::FRAGMENT : hasStage(program, stage);
        bool has = false;
        for (unsigned int i = 0; i < program.getNumShaders(); ++i)
            has = has || (program.getShader(i)->getType() == stage && isFunctions(*program.getShader(i)));
        if (wanted && !has) missing.push_back(stage);
    }
    return missing;
}

bool EffectProgram::isFunctions(const osg::Shader& shader)
{
    // A name outlives copies and files.
    return shader.getName() == fileOf(shader.getType());
}

bool EffectProgram::isPassOfTwoStages(const osg::Program& program)
{
    if (program.getName() != passName) return false;
    bool two = true;
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
    {
        const osg::Shader::Type stage = program.getShader(i)->getType();
        two = two && (stage == osg::Shader::VERTEX || stage == osg::Shader::FRAGMENT);
    }
    return two;
}

bool EffectProgram::hasFunctions(const osg::Program& program)
{
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
    {
        if (isFunctions(*program.getShader(i))) return true;
    }
    return false;
}

osg::ref_ptr<osg::Program> EffectProgram::create(const Effects& effects, const PassShaders& pass,
                                                 const std::string& prefix)
{
    const auto add =
        [](osg::Program& program, osg::Shader::Type stage, const std::string& text, const std::string& name)
    {
        program.addShader(ProfileProgram::createShader(stage, text, name));
    };
    try
    {
        const ShaderLibrary library;
        osg::ref_ptr<osg::Program> program = new ProfileProgram;
        program->setName(passName);
        for (const osg::Shader::Type stage :
             {osg::Shader::VERTEX, osg::Shader::TESSCONTROL, osg::Shader::TESSEVALUATION,
              osg::Shader::GEOMETRY, osg::Shader::FRAGMENT})
        {
            const std::string text = passFunctions(effects, pass, prefix, stage);
            const bool own = stage == osg::Shader::VERTEX || stage == osg::Shader::FRAGMENT;
            if (!text.empty()) add(*program, stage, text, own ? fileOf(stage) : "functions of " + prefix);
        }
        const auto addMain = [&](osg::Shader::Type stage, const std::string& own, const char* standIn)
        {
            const std::string name = own.empty() ? standIn : own;
            add(*program, stage, library.assemble(replaced(library.read(name), "SLOT_", prefix), name), name);
        };
        addMain(osg::Shader::VERTEX, pass.vertexMain, "stages/fixed.vert");
        addMain(osg::Shader::FRAGMENT, pass.fragmentMain, "stages/fixed.frag");
        for (const auto& [name, binding] : pass.blocks)
            program->addBindUniformBlock(prefix + name, binding);
        for (const auto& [name, binding] : pass.within ? pass.within->blocks : PassShaders().blocks)
            program->addBindUniformBlock(pass.withinPrefix + name, binding);
        return program;
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
        return nullptr;
    }
}

osg::ref_ptr<osg::Program> EffectProgram::createTessellating(const Effects& effects)
{
    try
    {
        const ShaderLibrary library;
        osg::ref_ptr<osg::Program> program = new ProfileProgram;
        program->setName("osgGeoFX tessellation");
        program->addShader(library.createShader(osg::Shader::VERTEX, "stages/fixed.vert"));
        program->addShader(functionShader(osg::Shader::VERTEX, tessellatedVertexText(effects, library)));
        for (const osg::Shader::Type stage : {osg::Shader::TESSCONTROL, osg::Shader::TESSEVALUATION})
            program->addShader(ProfileProgram::createShader(stage, tessellationText(effects, library, stage),
                                                            "tessellation"));
        program->addShader(library.createShader(osg::Shader::FRAGMENT, "stages/fixed.frag"));
        program->addShader(functionShader(osg::Shader::FRAGMENT, functions(effects, osg::Shader::FRAGMENT)));
        return program;
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
        return nullptr;
    }
}

osg::ref_ptr<osg::Program> EffectProgram::create(const Effects& effects)
{
    try
    {
        const ShaderLibrary library;
        osg::ref_ptr<osg::Program> program = new ProfileProgram;
        program->setName("osgGeoFX");
        program->addShader(library.createShader(osg::Shader::VERTEX, "stages/fixed.vert"));
        program->addShader(library.createShader(osg::Shader::FRAGMENT, "stages/fixed.frag"));
        addFunctions(*program, effects);
        return program;
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
        return nullptr;
    }
}

} // namespace osgGeoFX
