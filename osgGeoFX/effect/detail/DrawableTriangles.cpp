// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <osgGeoFX/effect/detail/FirstParent.h>

#include <osg/PrimitiveRestartIndex>

#include <algorithm>
#include <limits>
#include <optional>

namespace osgGeoFX
{

namespace
{

// OpenGL's names for these numbers are not in OSG's headers.
constexpr GLenum restartMode = 0x8F9D;      // GL_PRIMITIVE_RESTART
constexpr GLenum fixedRestartMode = 0x8D69; // GL_PRIMITIVE_RESTART_FIXED_INDEX

/// Reads a vertex array of any type as positions.
class PositionReader : public osg::ConstArrayVisitor
{
public:
    std::vector<osg::Vec3d> positions;
    bool finite = true; ///< no position is infinite or NaN

    using osg::ConstArrayVisitor::apply;
    void apply(const osg::Vec2Array& array) override { take(array); }
    void apply(const osg::Vec3Array& array) override { take(array); }
    void apply(const osg::Vec4Array& array) override { take(array); }
    void apply(const osg::Vec2dArray& array) override { take(array); }
    void apply(const osg::Vec3dArray& array) override { take(array); }
    void apply(const osg::Vec4dArray& array) override { take(array); }
    void apply(const osg::Vec2bArray& array) override { take(array); }
    void apply(const osg::Vec3bArray& array) override { take(array); }
    void apply(const osg::Vec4bArray& array) override { take(array); }
    void apply(const osg::Vec2sArray& array) override { take(array); }
    void apply(const osg::Vec3sArray& array) override { take(array); }
    void apply(const osg::Vec4sArray& array) override { take(array); }
    void apply(const osg::Vec2iArray& array) override { take(array); }
    void apply(const osg::Vec3iArray& array) override { take(array); }
    void apply(const osg::Vec4iArray& array) override { take(array); }
    void apply(const osg::Vec2ubArray& array) override { take(array); }
    void apply(const osg::Vec3ubArray& array) override { take(array); }
    void apply(const osg::Vec4ubArray& array) override { take(array); }
    void apply(const osg::Vec2usArray& array) override { take(array); }
    void apply(const osg::Vec3usArray& array) override { take(array); }
    void apply(const osg::Vec4usArray& array) override { take(array); }
    void apply(const osg::Vec2uiArray& array) override { take(array); }
    void apply(const osg::Vec3uiArray& array) override { take(array); }
    void apply(const osg::Vec4uiArray& array) override { take(array); }

    template<typename Vector>
    void take(const Vector* vectors, std::size_t count)
    {
        positions.clear();
        positions.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            constexpr unsigned int dimensions = Vector::num_components;
            const Vector& from = vectors[i];
            osg::Vec3d to(static_cast<double>(from[0]), static_cast<double>(from[1]), 0.0);
            if constexpr (dimensions > 2) to.z() = static_cast<double>(from[2]);
            if constexpr (dimensions > 3)
            {
                const auto w = static_cast<double>(from[3]);
                finite = finite && w != 0.0;
                if (w != 0.0) to /= w;
            }
            positions.push_back(to);
        }
    }

private:
    template<typename Array>
    void take(const Array& array)
    {
        take(array.empty() ? nullptr : &array.front(), array.size());
    }
};

/// The array that OpenGL takes vertices from, and OSG for its bounds.
const osg::Array* vertexArray(const osg::Geometry& geometry)
{
    if (geometry.getVertexArray()) return geometry.getVertexArray();
    return geometry.getNumVertexAttribArrays() > 0 ? geometry.getVertexAttribArray(0) : nullptr;
}

/// The index at which primitives restart: one that the state names, or the largest of the indices' type.
struct Restart
{
    std::optional<unsigned int> index;
    bool atLargest = false;
};

/// What a state set says of a mode, if anything.
std::optional<bool> modeIn(const osg::StateSet& state, GLenum mode)
{
    const auto found = state.getModeList().find(mode);
    if (found == state.getModeList().end()) return std::nullopt;
    return (found->second & osg::StateAttribute::ON) != 0;
}

/// The restart by the state of the drawable and of the nodes above it, the nearest first. Of several parents the
/// first counts. What a view's camera says of it is not known.
Restart restartOf(const osg::Drawable& drawable)
{
    std::optional<bool> on, atLargest;
    std::optional<unsigned int> index;
    for (const osg::Node* node = &drawable; node; node = firstParent(*node))
    {
        const osg::StateSet* state = node->getStateSet();
        if (!state) continue;
        if (!on) on = modeIn(*state, restartMode);
        if (!atLargest) atLargest = modeIn(*state, fixedRestartMode);
        const auto* attribute = dynamic_cast<const osg::PrimitiveRestartIndex*>(
            state->getAttribute(osg::StateAttribute::PRIMITIVERESTARTINDEX));
        if (attribute && !index) index = attribute->getRestartIndex();
    }
    Restart restart;
    restart.atLargest = atLargest.value_or(false);
    // Without the attribute, OpenGL's default is 0.
    if (on.value_or(false)) restart.index = index.value_or(0);
    return restart;
}

bool isList(GLenum mode)
{
    return mode == GL_TRIANGLES || mode == GL_QUADS;
}

} // namespace

/// Takes primitives apart. It is a functor of both kinds, since some drawables know only one of them.
class DrawableTriangles::Reader : public osg::PrimitiveFunctor, public osg::PrimitiveIndexFunctor
{
public:
    Reader(DrawableTriangles& triangles, const Restart& restart) : _triangles(triangles), _restart(restart) {}

    void setVertexArray(unsigned int count, const osg::Vec2* vertices) override { take(count, vertices); }
    void setVertexArray(unsigned int count, const osg::Vec3* vertices) override { take(count, vertices); }
    void setVertexArray(unsigned int count, const osg::Vec4* vertices) override { take(count, vertices); }
    void setVertexArray(unsigned int count, const osg::Vec2d* vertices) override { take(count, vertices); }
    void setVertexArray(unsigned int count, const osg::Vec3d* vertices) override { take(count, vertices); }
    void setVertexArray(unsigned int count, const osg::Vec4d* vertices) override { take(count, vertices); }

    void drawArrays(GLenum mode, GLint first, GLsizei count) override
    {
        if (first < 0 || count <= 0) return;
        const std::size_t all = _triangles._positions.size();
        const auto start = static_cast<std::size_t>(first);
        const std::size_t end = std::min(all, start + static_cast<std::size_t>(count));
        if (start >= end) return;
        assemble(mode, end - start, [start](std::size_t i) { return static_cast<unsigned int>(start + i); });
    }
    void drawElements(GLenum mode, GLsizei count, const GLubyte* indices) override
    {
        takeIndexed(mode, count, indices);
    }
    void drawElements(GLenum mode, GLsizei count, const GLushort* indices) override
    {
        takeIndexed(mode, count, indices);
    }
    void drawElements(GLenum mode, GLsizei count, const GLuint* indices) override
    {
        takeIndexed(mode, count, indices);
    }

private:
    template<typename Vector>
    void take(unsigned int count, const Vector* vertices)
    {
        PositionReader reader;
        reader.take(vertices, count);
        _triangles._tellAll = _triangles._tellAll && reader.finite;
        _triangles._positions = std::move(reader.positions);
    }

    template<typename Index>
    void takeIndexed(GLenum mode, GLsizei count, const Index* indices)
    {
        if (!indices || count <= 0) return;
        const std::size_t vertices = _triangles._positions.size();
        const auto cuts = [&](Index index)
        {
            if (_restart.index && index == *_restart.index) return true;
            if (_restart.atLargest && index == std::numeric_limits<Index>::max()) return true;
            // An index beyond the vertices may be a restart that another state sets. A primitive with it cannot be
            // drawn.
            return index >= vertices && !isList(mode);
        };
        const Index* const end = indices + count;
        for (const Index* start = indices; start < end;)
        {
            const Index* const stop = std::find_if(start, end, cuts);
            assemble(mode, static_cast<std::size_t>(stop - start),
                     [start](std::size_t i) { return static_cast<unsigned int>(start[i]); });
            start = stop + 1;
        }
    }

    void add(unsigned int a, unsigned int b, unsigned int c)
    {
        const std::size_t vertices = _triangles._positions.size();
        if (a >= vertices || b >= vertices || c >= vertices) return;
        for (const unsigned int corner : {a, b, c})
            _triangles._corners.push_back(corner);
    }

    /// Assembles triangles as osg::TriangleIndexFunctor does, but leaves out incomplete ones.
    template<typename At>
    void assemble(GLenum mode, std::size_t count, At at)
    {
        switch (mode)
        {
        case GL_TRIANGLES:
            for (std::size_t i = 0; i + 2 < count; i += 3)
                add(at(i), at(i + 1), at(i + 2));
            break;
        case GL_TRIANGLE_STRIP:
            for (std::size_t i = 0; i + 2 < count; ++i)
            {
                const bool odd = i % 2 == 1;
                add(at(i), at(odd ? i + 2 : i + 1), at(odd ? i + 1 : i + 2));
            }
            break;
        case GL_QUADS:
            for (std::size_t i = 0; i + 3 < count; i += 4)
            {
                add(at(i), at(i + 1), at(i + 2));
                add(at(i), at(i + 2), at(i + 3));
            }
            break;
        case GL_QUAD_STRIP:
            for (std::size_t i = 0; i + 3 < count; i += 2)
            {
                add(at(i), at(i + 1), at(i + 2));
                add(at(i + 1), at(i + 3), at(i + 2));
            }
            break;
        case GL_POLYGON:
        case GL_TRIANGLE_FAN:
            for (std::size_t i = 1; i + 1 < count; ++i)
                add(at(0), at(i), at(i + 1));
            break;
        default:
            _triangles._tellAll = false;
        }
    }

    DrawableTriangles& _triangles;
    const Restart _restart;
};

DrawableTriangles::DrawableTriangles(const osg::Drawable& drawable)
{
    Reader reader(*this, restartOf(drawable));
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry)
    {
        // A drawable that knows both kinds says the same to both.
        _tellAll = false;
        if (drawable.supports(static_cast<const osg::PrimitiveIndexFunctor&>(reader)))
            drawable.accept(static_cast<osg::PrimitiveIndexFunctor&>(reader));
        else if (drawable.supports(static_cast<const osg::PrimitiveFunctor&>(reader)))
            drawable.accept(static_cast<osg::PrimitiveFunctor&>(reader));
        _parts.push_back({_corners.size(), 0});
        return;
    }
    const osg::Array* vertices = vertexArray(*geometry);
    PositionReader positions;
    if (vertices) vertices->accept(positions);
    _positions = std::move(positions.positions);
    _tellAll = !_positions.empty() && positions.finite && !geometry->getInitialBound().valid() &&
               !geometry->getComputeBoundingBoxCallback() && !instanced(*geometry);
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry->getPrimitiveSetList())
    {
        primitives->accept(static_cast<osg::PrimitiveIndexFunctor&>(reader));
        _setEnds.push_back(_corners.size());
        const int instances = primitives->getNumInstances();
        if (!_parts.empty() && _parts.back().instances == instances)
            _parts.back().end = _corners.size();
        else
            _parts.push_back({_corners.size(), instances});
    }
}

bool DrawableTriangles::instanced(const osg::Geometry& geometry)
{
    const auto& all = geometry.getPrimitiveSetList();
    return std::any_of(all.begin(), all.end(), [](const auto& each) { return each->getNumInstances() > 0; });
}

template<typename Action>
bool GeometryStamp::forEachPart(const osg::Geometry& geometry, What what, Action action)
{
    if (!action(vertexArray(geometry))) return false;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry.getPrimitiveSetList())
    {
        if (!action(primitives.get())) return false;
    }
    if (what == SHAPE) return true;
    const auto all = [&](const osg::Geometry::ArrayList& arrays)
    {
        return std::all_of(arrays.begin(), arrays.end(),
                           [&](const auto& array) { return action(array.get()); });
    };
    return action(geometry.getNormalArray()) && action(geometry.getColorArray()) &&
           action(geometry.getSecondaryColorArray()) && action(geometry.getFogCoordArray()) &&
           action(geometry.getDrawCallback()) && all(geometry.getTexCoordArrayList()) &&
           all(geometry.getVertexAttribArrayList());
}

unsigned int GeometryStamp::changes(const osg::Geometry& geometry)
{
    const osg::Array* vertices = vertexArray(geometry);
    unsigned int count = vertices ? vertices->getModifiedCount() + vertices->getNumElements() : 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry.getPrimitiveSetList())
        count += primitives->getModifiedCount() + primitives->getNumIndices();
    return count;
}

GeometryStamp::GeometryStamp(const osg::Geometry& geometry, What what)
    : _what(what), _changes(changes(geometry)), _taken(true)
{
    forEachPart(geometry, what,
                [&](const osg::Referenced* part)
                {
                    _parts.emplace_back(part);
                    return true;
                });
}

bool GeometryStamp::matches(const osg::Geometry& geometry) const
{
    if (!_taken || _changes != changes(geometry)) return false;
    auto known = _parts.begin();
    const bool same = forEachPart(geometry, _what,
                                  [&](const osg::Referenced* part)
                                  {
                                      if (known == _parts.end()) return false;
                                      // A new array may have the address of a deleted one.
                                      const bool equal = *known == part && (!part || known->valid());
                                      ++known;
                                      return equal;
                                  });
    return same && known == _parts.end();
}

} // namespace osgGeoFX
