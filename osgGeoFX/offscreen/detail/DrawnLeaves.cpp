// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/detail/DrawnLeaves.h>

#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/Drawable>
#include <osg/PrimitiveSet>

#include <set>

namespace osgGeoFX
{

namespace
{

class TriangleCounter : public osg::PrimitiveFunctor
{
public:
    std::uint64_t triangles = 0;

    void setVertexArray(unsigned int, const osg::Vec2*) override {}
    void setVertexArray(unsigned int, const osg::Vec3*) override {}
    void setVertexArray(unsigned int, const osg::Vec4*) override {}
    void setVertexArray(unsigned int, const osg::Vec2d*) override {}
    void setVertexArray(unsigned int, const osg::Vec3d*) override {}
    void setVertexArray(unsigned int, const osg::Vec4d*) override {}
    void drawArrays(GLenum mode, GLint, GLsizei count) override { add(mode, count); }
    void drawElements(GLenum mode, GLsizei count, const GLubyte*) override { add(mode, count); }
    void drawElements(GLenum mode, GLsizei count, const GLushort*) override { add(mode, count); }
    void drawElements(GLenum mode, GLsizei count, const GLuint*) override { add(mode, count); }

private:
    void add(GLenum mode, GLsizei count)
    {
        const auto n = static_cast<std::uint64_t>(count);
        switch (mode)
        {
        case GL_TRIANGLES:
            triangles += n / 3;
            break;
        case GL_QUADS:
            triangles += n / 4 * 2;
            break;
        case GL_TRIANGLE_STRIP:
        case GL_TRIANGLE_FAN:
        case GL_QUAD_STRIP:
        case GL_POLYGON:
            triangles += n > 2 ? n - 2 : 0;
            break;
        default:
            break;
        }
    }
};

class LeafCounter
{
public:
    void add(const osgUtil::RenderStage& stage)
    {
        for (const auto& before : stage.getPreRenderList())
            add(*before.second);
        add(static_cast<const osgUtil::RenderBin&>(stage));
        for (const auto& after : stage.getPostRenderList())
            add(*after.second);
    }

    DrawnLeaves result() const { return {_triangles.triangles, _drawables, _tiles.size()}; }

private:
    void add(const osgUtil::RenderBin& bin)
    {
        for (const osgUtil::RenderLeaf* leaf : bin.getRenderLeafList())
            add(*leaf);
        for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        {
            for (const auto& leaf : graph->_leaves)
                add(*leaf);
        }
        for (const auto& inner : bin.getRenderBinList())
            add(*inner.second);
    }

    void add(const osgUtil::RenderLeaf& leaf)
    {
        if (!leaf._drawable) return;
        const osg::Drawable& drawable = PatchGeometry::originalOf(*leaf._drawable);
        ++_drawables;
        drawable.accept(_triangles);
        addTile(drawable);
    }

    void addTile(const osg::Node& node)
    {
        if (TileInfo::isTile(node))
        {
            _tiles.insert(&node);
            return;
        }
        for (unsigned int i = 0; i < node.getNumParents(); ++i)
            addTile(*node.getParent(i));
    }

    TriangleCounter _triangles;
    std::uint64_t _drawables = 0;
    std::set<const osg::Node*> _tiles;
};

} // namespace

DrawnLeaves DrawnLeaves::count(const osgUtil::RenderStage& stage)
{
    LeafCounter counter;
    counter.add(stage);
    return counter.result();
}

} // namespace osgGeoFX
