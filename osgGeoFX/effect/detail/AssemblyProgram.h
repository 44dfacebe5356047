// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/StateSet>

#include <utility>

namespace osgGeoFX
{

/// Programs in assembly language (osg::VertexProgram, osg::FragmentProgram), as osgFX has them. GLSL cannot call functions from them.
struct AssemblyProgram
{
    static bool is(const osg::StateAttribute& program)
    {
        return program.getType() == osg::StateAttribute::VERTEXPROGRAM ||
               program.getType() == osg::StateAttribute::FRAGMENTPROGRAM;
    }
    /// The one that a state set switches on, with its flags; null for none.
    static const osg::StateSet::RefAttributePair* of(const osg::StateSet& state)
    {
        // OpenGL's names for these modes are not in all headers of OSG.
        constexpr GLenum vertexProgram = 0x8620, fragmentProgram = 0x8804;
        if (state.getAttributeList().empty()) return nullptr;
        for (const auto& [type, mode] : {std::pair(osg::StateAttribute::VERTEXPROGRAM, vertexProgram),
                                         std::pair(osg::StateAttribute::FRAGMENTPROGRAM, fragmentProgram)})
        {
            const osg::StateSet::RefAttributePair* const attribute = state.getAttributePair(type);
            if (attribute && (state.getMode(mode) & osg::StateAttribute::ON)) return attribute;
        }
        return nullptr;
    }
};

} // namespace osgGeoFX
