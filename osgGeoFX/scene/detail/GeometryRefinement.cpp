// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/GeometryRefinement.h>

#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/effect/detail/EdgeSplitter.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace osgGeoFX
{

namespace
{

using Parents = std::vector<std::pair<unsigned int, unsigned int>>;

bool isFilled(GLenum mode)
{
    return mode == GL_TRIANGLES || mode == GL_TRIANGLE_STRIP || mode == GL_TRIANGLE_FAN || mode == GL_QUADS ||
           mode == GL_QUAD_STRIP || mode == GL_POLYGON;
}

template<typename Number>
Number meanOf(Number a, Number b)
{
    if constexpr (std::is_floating_point_v<Number>)
        return (a + b) / Number(2);
    else
        return static_cast<Number>(std::floor((static_cast<double>(a) + static_cast<double>(b)) / 2.0 + 0.5));
}

/// Appends to an array the means of two of its elements.
class MeanAppender : public osg::ArrayVisitor
{
public:
    MeanAppender(const Parents& parents, bool normals) : _parents(parents), _normals(normals) {}

    using osg::ArrayVisitor::apply;
    void apply(osg::ByteArray& array) override { numbers(array); }
    void apply(osg::ShortArray& array) override { numbers(array); }
    void apply(osg::IntArray& array) override { numbers(array); }
    void apply(osg::UByteArray& array) override { numbers(array); }
    void apply(osg::UShortArray& array) override { numbers(array); }
    void apply(osg::UIntArray& array) override { numbers(array); }
    void apply(osg::FloatArray& array) override { numbers(array); }
    void apply(osg::DoubleArray& array) override { numbers(array); }
    void apply(osg::Vec2Array& array) override { vectors(array); }
    void apply(osg::Vec3Array& array) override { vectors(array); }
    void apply(osg::Vec4Array& array) override { vectors(array); }
    void apply(osg::Vec2dArray& array) override { vectors(array); }
    void apply(osg::Vec3dArray& array) override { vectors(array); }
    void apply(osg::Vec4dArray& array) override { vectors(array); }
    void apply(osg::Vec2bArray& array) override { vectors(array); }
    void apply(osg::Vec3bArray& array) override { vectors(array); }
    void apply(osg::Vec4bArray& array) override { vectors(array); }
    void apply(osg::Vec2sArray& array) override { vectors(array); }
    void apply(osg::Vec3sArray& array) override { vectors(array); }
    void apply(osg::Vec4sArray& array) override { vectors(array); }
    void apply(osg::Vec2iArray& array) override { vectors(array); }
    void apply(osg::Vec3iArray& array) override { vectors(array); }
    void apply(osg::Vec4iArray& array) override { vectors(array); }
    void apply(osg::Vec2ubArray& array) override { vectors(array); }
    void apply(osg::Vec3ubArray& array) override { vectors(array); }
    void apply(osg::Vec4ubArray& array) override { vectors(array); }
    void apply(osg::Vec2usArray& array) override { vectors(array); }
    void apply(osg::Vec3usArray& array) override { vectors(array); }
    void apply(osg::Vec4usArray& array) override { vectors(array); }
    void apply(osg::Vec2uiArray& array) override { vectors(array); }
    void apply(osg::Vec3uiArray& array) override { vectors(array); }
    void apply(osg::Vec4uiArray& array) override { vectors(array); }

    bool known = false; ///< whether the array is of a type that has means

private:
    template<typename Array, typename Mean>
    void append(Array& array, Mean mean)
    {
        known = true;
        // What counts for a shader as a number of something has no mean.
        const bool exact =
            array.getPreserveDataType() && !std::is_same_v<typename Array::ElementDataType, float>;
        array.reserve(array.size() + _parents.size());
        for (const auto& [a, b] : _parents)
        {
            const auto first = array[a], second = array[b];
            array.push_back(exact ? first : mean(first, second));
        }
    }
    template<typename Array>
    void numbers(Array& array)
    {
        append(array, [](auto a, auto b) { return meanOf(a, b); });
    }
    template<typename Array>
    void vectors(Array& array)
    {
        using Vector = typename Array::ElementDataType;
        append(array,
               [this](const Vector& a, const Vector& b)
               {
                   Vector result;
                   for (int i = 0; i < Vector::num_components; ++i)
                       result[i] = meanOf(a[i], b[i]);
                   if (_normals) keepLength(result, lengthOf(a) / 2.0 + lengthOf(b) / 2.0);
                   return result;
               });
    }
    template<typename Vector>
    static double lengthOf(const Vector& vector)
    {
        double square = 0.0;
        for (int i = 0; i < Vector::num_components; ++i)
            square += static_cast<double>(vector[i]) * static_cast<double>(vector[i]);
        return std::sqrt(square);
    }
    template<typename Vector>
    static void keepLength(Vector& vector, double length)
    {
        const double now = lengthOf(vector);
        if (!(now > 0.0)) return;
        for (int i = 0; i < Vector::num_components; ++i)
            vector[i] =
                static_cast<typename Vector::value_type>(static_cast<double>(vector[i]) * length / now);
    }

    const Parents& _parents;
    const bool _normals;
};

/// Whether vertices are divided by a number of their own.
class DividedVertices : public osg::ConstArrayVisitor
{
public:
    bool any = false;
    using osg::ConstArrayVisitor::apply;
    void apply(const osg::Vec4Array& array) override { look(array); }
    void apply(const osg::Vec4dArray& array) override { look(array); }

private:
    template<typename Array>
    void look(const Array& array)
    {
        using Number = typename Array::ElementDataType::value_type;
        any = std::any_of(array.begin(), array.end(), [](const auto& each) { return each[3] != Number(1); });
    }
};

/// The new array in the place of one; the same one where it is not bound per vertex, and null where it cannot be.
osg::ref_ptr<osg::Array> grown(osg::Array* array, std::size_t vertices, const Parents& parents, bool normals,
                               osg::VertexBufferObject& buffer)
{
    if (array->getBinding() != osg::Array::BIND_PER_VERTEX) return array;
    if (array->getNumElements() < vertices) return nullptr;
    const osg::ref_ptr<osg::Array> result = osg::clone(array, osg::CopyOp::DEEP_COPY_ALL);
    result->resizeArray(static_cast<unsigned int>(vertices));
    MeanAppender appender(parents, normals);
    result->accept(appender);
    if (!appender.known) return nullptr;
    // OSG would put it into the former ones' buffer, which others may have, too.
    result->setVertexBufferObject(&buffer);
    return result;
}

/// All of a geometry's arrays; the same places again for setArrays().
std::vector<osg::Array*> arraysOf(osg::Geometry& geometry)
{
    std::vector<osg::Array*> all = {geometry.getVertexArray(), geometry.getNormalArray(),
                                    geometry.getColorArray(), geometry.getSecondaryColorArray(),
                                    geometry.getFogCoordArray()};
    for (unsigned int i = 0; i < geometry.getNumTexCoordArrays(); ++i)
        all.push_back(geometry.getTexCoordArray(i));
    for (unsigned int i = 0; i < geometry.getNumVertexAttribArrays(); ++i)
        all.push_back(geometry.getVertexAttribArray(i));
    return all;
}

void setArrays(osg::Geometry& geometry, const std::vector<osg::ref_ptr<osg::Array>>& all)
{
    auto next = all.begin();
    geometry.setVertexArray(*next++);
    geometry.setNormalArray(*next++);
    geometry.setColorArray(*next++);
    geometry.setSecondaryColorArray(*next++);
    geometry.setFogCoordArray(*next++);
    const unsigned int units = geometry.getNumTexCoordArrays(),
                       attributes = geometry.getNumVertexAttribArrays();
    for (unsigned int i = 0; i < units; ++i)
        geometry.setTexCoordArray(i, *next++);
    for (unsigned int i = 0; i < attributes; ++i)
        geometry.setVertexAttribArray(i, *next++);
}

/// The vertices in metres, and the triangles of each filled primitive set.
struct Mesh
{
    std::vector<osg::Vec3d> positions;
    std::vector<EdgeSplitter::Triangles> lists;
    std::vector<unsigned int> sets; ///< of which primitive set each list is
    bool longer = false;            ///< whether any edge is longer than wished
};

Mesh meshOf(const osg::Geometry& geometry, const osg::Matrixd& matrix, double longest)
{
    const DrawableTriangles triangles(geometry);
    Mesh mesh;
    for (const osg::Vec3d& position : triangles.positions())
        mesh.positions.push_back(position * matrix);
    std::size_t start = 0;
    for (unsigned int set = 0; set < triangles.setEnds().size(); ++set)
    {
        const std::size_t end = triangles.setEnds()[set];
        if (isFilled(geometry.getPrimitiveSet(set)->getMode()) && end > start)
        {
            mesh.sets.push_back(set);
            mesh.lists.emplace_back(triangles.corners().begin() + static_cast<std::ptrdiff_t>(start),
                                    triangles.corners().begin() + static_cast<std::ptrdiff_t>(end));
        }
        for (; start < end; ++start)
        {
            const std::size_t next = start % 3 == 2 ? start - 2 : start + 1;
            const osg::Vec3d edge =
                mesh.positions[triangles.corners()[next]] - mesh.positions[triangles.corners()[start]];
            mesh.longer = mesh.longer || edge.length() > longest;
        }
    }
    // What is not a number has no middle.
    if (std::any_of(mesh.positions.begin(), mesh.positions.end(),
                    [](const osg::Vec3d& each) { return !each.valid() || !std::isfinite(each.length2()); }))
        mesh.longer = false;
    return mesh;
}

} // namespace

RefinedGeometry refineGeometry(osg::Geometry& geometry, const osg::Matrixd& matrix, double longest,
                               std::size_t most)
{
    RefinedGeometry result;
    if (DrawableTriangles::instanced(geometry)) return result;
    DividedVertices divided;
    if (geometry.getVertexArray()) geometry.getVertexArray()->accept(divided);
    if (divided.any) return result;
    if (geometry.containsDeprecatedData()) geometry.fixDeprecatedData();
    Mesh mesh = meshOf(geometry, matrix, longest);
    if (!mesh.longer || mesh.lists.empty()) return result;
    const std::size_t vertices = mesh.positions.size();
    EdgeSplitter splitter(std::move(mesh.positions), longest);
    splitter.split(mesh.lists, most);
    if (splitter.parents().empty() || splitter.positions().size() > std::numeric_limits<unsigned int>::max())
        return result;

    // Nothing of the geometry changes before all is there.
    const osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    std::vector<osg::ref_ptr<osg::Array>> arrays;
    for (osg::Array* array : arraysOf(geometry))
    {
        const bool normals = array && array == geometry.getNormalArray();
        arrays.push_back(array ? grown(array, vertices, splitter.parents(), normals, *buffer) : nullptr);
        if (array && !arrays.back()) return result;
    }
    setArrays(geometry, arrays);
    const osg::ref_ptr<osg::ElementBufferObject> elements = new osg::ElementBufferObject;
    for (std::size_t i = 0; i < mesh.lists.size(); ++i)
    {
        const osg::ref_ptr<osg::DrawElementsUInt> set = new osg::DrawElementsUInt(
            osg::PrimitiveSet::TRIANGLES, mesh.lists[i].begin(), mesh.lists[i].end());
        set->setName(geometry.getPrimitiveSet(mesh.sets[i])->getName());
        set->setElementBufferObject(elements);
        geometry.setPrimitiveSet(mesh.sets[i], set);
        result.triangles += mesh.lists[i].size() / 3;
    }
    // A tree of the former triangles, for picking.
    geometry.setShape(nullptr);
    geometry.dirtyGLObjects();
    result.inside = splitter.inside();
    return result;
}

} // namespace osgGeoFX
