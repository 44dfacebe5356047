// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/PatchParameter>
#include <osg/Program>
#include <osg/Shader>
#include <tools/BentGround.h>

#include <string>
#include <utility>
#include <vector>

namespace geofx::test
{

/** A program as an application has it, and the same with calls of the kit's functions: its texts say DEFINES behind #version,
    DEFORM(place) and TINT(color) where the calls go. Fragments have the color of the geometry. */
struct HostProgram
{
    HostProgram(const std::string& version, const std::string& place, const std::string& declarations = "")
        : vertices{version + "DEFINES\n" + declarations + "void main()\n{\n    " + place +
                   "\n    gl_FrontColor = gl_Color;\n}\n"},
          fragments{version + "DEFINES\nvoid main() { gl_FragColor = TINT(gl_Color); }\n"}
    {
    }

    osg::ref_ptr<osg::Program> make(bool withCalls) const
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->setName("the host's");
        const auto add = [&](osg::Shader::Type stage, std::string text)
        {
            if (text.empty()) return;
            const std::string word = "DEFINES";
            const std::string vertex =
                withCalls ? "vec4 geofx_vertex(vec4 eye);\n#define DEFORM geofx_vertex" : "#define DEFORM";
            const std::string fragment = withCalls ? "vec4 geofx_fragment(vec4 color, vec4 map);\n"
                                                     "#define TINT(color) geofx_fragment(color, vec4(0.0))"
                                                   : "#define TINT";
            const std::size_t at = text.find(word);
            if (at != std::string::npos)
                text.replace(at, word.size(), stage == osg::Shader::FRAGMENT ? fragment : vertex);
            program->addShader(new osg::Shader(stage, text));
        };
        for (const std::string& text : vertices)
            add(osg::Shader::VERTEX, text);
        add(osg::Shader::TESSCONTROL, control);
        add(osg::Shader::TESSEVALUATION, evaluation);
        add(osg::Shader::GEOMETRY, geometry);
        for (const std::string& text : fragments)
            add(osg::Shader::FRAGMENT, text);
        for (const auto& [name, location] : locations)
            program->addBindFragDataLocation(name, location);
        return program;
    }

    std::vector<std::string> vertices, fragments;
    std::string control, evaluation, geometry;
    std::vector<std::pair<std::string, unsigned int>> locations; ///< of outputs
};

} // namespace geofx::test
