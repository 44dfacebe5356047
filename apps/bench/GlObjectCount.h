// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/GLExtensions>
#include <osg/GLObjects>
#include <osg/State>

#include <algorithm>
#include <ostream>

namespace geofx::bench
{

/// How many objects a context has, asked name by name. What OSG has put aside to be deleted is deleted first.
struct GlObjectCount
{
    int textures = 0, buffers = 0, frameBuffers = 0, programs = 0, vertexArrays = 0;

    /// The context must be current.
    static GlObjectCount of(osg::State& state)
    {
        osg::flushAllDeletedGLObjects(state.getContextID());
        const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
        // OSG has no use for this one.
        GLboolean(GL_APIENTRY * isFrameBuffer)(GLuint) = nullptr;
        osg::setGLExtensionFuncPtr(isFrameBuffer, "glIsFramebuffer");
        // Names are handed out from the lowest on. A driver that gives no name twice leaves long runs without any below its newest
        // name; above it such a run is the end.
        constexpr GLuint longest = 20000;
        const GLuint next = newestName(gl);
        GlObjectCount count;
        int before = 0;
        for (GLuint name = 1, last = 0; name < std::max(last, next) + longest; ++name)
        {
            count.textures += glIsTexture(name) ? 1 : 0;
            count.buffers += gl.glIsBuffer(name) ? 1 : 0;
            count.frameBuffers += isFrameBuffer && isFrameBuffer(name) ? 1 : 0;
            count.programs += isProgram(gl, name) ? 1 : 0;
            count.vertexArrays += gl.glIsVertexArray(name) ? 1 : 0;
            if (count.all() > before) last = name;
            before = count.all();
        }
        return count;
    }

    /// The highest of names that are handed out now.
    static GLuint newestName(const osg::GLExtensions& gl)
    {
        GLuint texture = 0, buffer = 0, frameBuffer = 0;
        glGenTextures(1, &texture);
        gl.glGenBuffers(1, &buffer);
        gl.glGenFramebuffers(1, &frameBuffer);
        const GLuint program = gl.glCreateProgram();
        glDeleteTextures(1, &texture);
        gl.glDeleteBuffers(1, &buffer);
        gl.glDeleteFramebuffers(1, &frameBuffer);
        gl.glDeleteProgram(program);
        return std::max({texture, buffer, frameBuffer, program});
    }

    /// A driver may hold a program that has been deleted until it draws with another one; its name lives as long.
    static bool isProgram(const osg::GLExtensions& gl, GLuint name)
    {
        GLint deleted = GL_FALSE;
        if (gl.glIsProgram(name)) gl.glGetProgramiv(name, GL_DELETE_STATUS, &deleted);
        return gl.glIsProgram(name) && !deleted;
    }

    int all() const { return textures + buffers + frameBuffers + programs + vertexArrays; }

    bool operator==(const GlObjectCount& other) const
    {
        return textures == other.textures && buffers == other.buffers && frameBuffers == other.frameBuffers &&
               programs == other.programs && vertexArrays == other.vertexArrays;
    }

    friend std::ostream& operator<<(std::ostream& stream, const GlObjectCount& count)
    {
        return stream << count.textures << " textures, " << count.buffers << " buffers, "
                      << count.frameBuffers << " frame buffers, " << count.programs << " programs, "
                      << count.vertexArrays << " vertex arrays";
    }
};

} // namespace geofx::bench
