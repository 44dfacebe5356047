// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/print/PictureMesh.h>

#include <osgGeoFX/print/detail/MeshPiece.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Math>
#include <osg/TexMat>
#include <osg/TriangleIndexFunctor>
#include <osg/ValueObject>
#include <osgDB/FileNameUtils>
#include <osgDB/WriteFile>
#include <osgUtil/SmoothingVisitor>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <system_error>

#include <unistd.h>

namespace fs = std::filesystem;

namespace osgGeoFX
{

namespace
{

struct Corners
{
    std::vector<unsigned int> all;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        for (const unsigned int corner : {a, b, c})
            all.push_back(corner);
    }
};

/// Vertices or texture coordinates of any type of numbers.
class Values : public osg::ConstValueVisitor
{
public:
    osg::Vec3d value;
    bool known = false;
    void apply(const osg::Vec2& v) override
    {
        put(osg::Vec3d(static_cast<double>(v.x()), static_cast<double>(v.y()), 0.0));
    }
    void apply(const osg::Vec3& v) override { put(v); }
    void apply(const osg::Vec3b& v) override
    {
        put({static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())});
    }
    void apply(const osg::Vec2d& v) override { put({v.x(), v.y(), 0.0}); }
    void apply(const osg::Vec3d& v) override { put(v); }
    void apply(const osg::Vec4& v) override { put(osg::Vec3d(osg::Vec3(v.x(), v.y(), v.z()) / v.w())); }
    void apply(const osg::Vec4d& v) override { put(osg::Vec3d(v.x(), v.y(), v.z()) / v.w()); }

private:
    void put(const osg::Vec3d& v)
    {
        value = v;
        known = true;
    }
};

/// The texture and its matrix of unit 0 that are in force at the end of a path.
struct Look
{
    osg::ref_ptr<osg::Texture2D> texture;
    osg::Matrixd matrix;

    void meet(osg::StateSet* state)
    {
        if (!state) return;
        if (auto* const found =
                dynamic_cast<osg::Texture2D*>(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE)))
            texture = found;
        if (const auto* const found =
                dynamic_cast<osg::TexMat*>(state->getTextureAttribute(0, osg::StateAttribute::TEXMAT)))
            matrix = found->getMatrix();
    }
};

/// Outside of which sides of the picture a place in clip coordinates lies, as bits.
int outside(const osg::Vec4d& clip)
{
    return (clip.x() < -clip.w() ? 1 : 0) | (clip.x() > clip.w() ? 2 : 0) | (clip.y() < -clip.w() ? 4 : 0) |
           (clip.y() > clip.w() ? 8 : 0);
}

/// A state with a texture like this one. Those of tiles have what files do not keep.
osg::ref_ptr<osg::StateSet> stateOf(osg::Texture2D& texture)
{
    const osg::ref_ptr<osg::Texture2D> plain = new osg::Texture2D(texture.getImage());
    plain->setResizeNonPowerOfTwoHint(false);
    plain->setMaxAnisotropy(texture.getMaxAnisotropy());
    for (const osg::Texture::WrapParameter side : {osg::Texture::WRAP_S, osg::Texture::WRAP_T})
        plain->setWrap(side, texture.getWrap(side));
    for (const osg::Texture::FilterParameter filter : {osg::Texture::MIN_FILTER, osg::Texture::MAG_FILTER})
        plain->setFilter(filter, texture.getFilter(filter));
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setTextureAttributeAndModes(0, plain);
    return state;
}

std::string text(const osg::Matrixd& matrix)
{
    std::string result;
    char number[40];
    for (int i = 0; i < 16; ++i)
    {
        std::snprintf(number, sizeof(number), i ? " %.12g" : "%.12g", matrix.ptr()[i]);
        result += number;
    }
    return result;
}

} // namespace

/// Takes the triangles of all drawables that a DeformedIntersectionVisitor finds in a picture.
class PictureMesh::Collector : public osgUtil::Intersector
{
public:
    /// `clip`: from eye space to the picture.
    Collector(std::vector<MeshPiece>& pieces, const osg::Matrixd& clip)
        : osgUtil::Intersector(osgUtil::Intersector::MODEL), _pieces(pieces), _clip(clip),
          _chain(new DeformationChain)
    {
    }
    osgUtil::Intersector* clone(osgUtil::IntersectionVisitor& visitor) override
    {
        auto* const result = new Collector(_pieces, _clip);
        if (const auto* const ours = dynamic_cast<DeformedIntersectionVisitor*>(&visitor))
        {
            result->_chain = &ours->chain();
            result->_modelView = ours->modelView();
        }
        return result;
    }
    bool enter(const osg::Node& node) override
    {
        if (!node.isCullingActive()) return true;
        const osg::BoundingSphere& sphere = node.getBound();
        if (!sphere.valid()) return false;
        const Ball ball = {osg::Vec3d(sphere.center()) * _modelView,
                           static_cast<double>(sphere.radius()) * largestScale(_modelView)};
        return sees(_chain->bound(ball)) || sees(ball);
    }
    void leave() override {}
    void reset() override {}
    bool containsIntersections() override { return false; }
    void intersect(osgUtil::IntersectionVisitor& visitor, osg::Drawable* drawable) override
    {
        osg::Geometry* const geometry = drawable->asGeometry();
        const osg::Array* const vertices = geometry ? geometry->getVertexArray() : nullptr;
        if (!vertices || vertices->getNumElements() == 0) return;
        MeshPiece piece;
        std::vector<int> sides; // of the picture that a vertex lies outside of; −1: it cannot be drawn
        for (unsigned int i = 0; i < vertices->getNumElements(); ++i)
        {
            Values vertex;
            vertices->accept(i, vertex);
            const osg::Vec3d eye = _chain->deform(vertex.value * _modelView);
            const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * _clip;
            const bool good = vertex.known && eye.length2() < 1e30 && clip.w() > 1e-9 * eye.length();
            sides.push_back(good ? outside(clip) : -1);
            piece.positions.push_back(eye);
        }
        osg::TriangleIndexFunctor<Corners> all;
        geometry->accept(all);
        for (std::size_t i = 0; i + 2 < all.all.size(); i += 3)
        {
            const unsigned int* const corner = &all.all[i];
            if (std::any_of(corner, corner + 3,
                            [&](unsigned int each) { return each >= sides.size() || sides[each] < 0; }))
                continue;
            if (sides[corner[0]] & sides[corner[1]] & sides[corner[2]]) continue;
            piece.corners.insert(piece.corners.end(), corner, corner + 3);
        }
        if (piece.corners.empty()) return;
        takeLook(visitor.getNodePath(), *geometry, piece);
        takeNormals(*geometry, piece);
        turnFronts(piece);
        keepUsed(piece);
        _pieces.push_back(std::move(piece));
    }

private:
    /// Whether a ball may be in the picture.
    bool sees(const Ball& ball) const
    {
        for (const int axis : {0, 1})
        {
            for (const double side : {-1.0, 1.0})
            {
                osg::Vec3d normal;
                for (int i = 0; i < 3; ++i)
                    normal[i] = _clip(i, 3) + side * _clip(i, axis);
                if (ball.center * normal + _clip(3, 3) + side * _clip(3, axis) <
                    -ball.radius * normal.length())
                    return false;
            }
        }
        return true;
    }

    static void takeLook(const osg::NodePath& path, osg::Geometry& geometry, MeshPiece& piece)
    {
        Look look;
        for (osg::Node* const node : path)
            look.meet(node->getStateSet());
        if (path.empty() || path.back() != &geometry) look.meet(geometry.getStateSet());
        const osg::Array* const places = geometry.getTexCoordArray(0);
        if (!look.texture || !places || places->getNumElements() < piece.positions.size()) return;
        piece.texture = look.texture;
        for (unsigned int i = 0; i < piece.positions.size(); ++i)
        {
            Values place;
            places->accept(i, place);
            const osg::Vec3d moved = osg::Vec3d(place.value.x(), place.value.y(), 0.0) * look.matrix;
            piece.places.emplace_back(static_cast<float>(moved.x()), static_cast<float>(moved.y()));
        }
    }

    void takeNormals(const osg::Geometry& geometry, MeshPiece& piece) const
    {
        const osg::Array *const normals = geometry.getNormalArray(), *const vertices =
                                                                         geometry.getVertexArray();
        if (!normals || normals->getBinding() != osg::Array::BIND_PER_VERTEX ||
            normals->getNumElements() < piece.positions.size())
            return;
        for (unsigned int i = 0; i < piece.positions.size(); ++i)
        {
            Values normal, vertex;
            normals->accept(i, normal);
            vertices->accept(i, vertex);
            osg::Vec3d turned = _chain->deformNormal(vertex.value * _modelView,
                                                     osg::Matrixd::transform3x3(normal.value, _modelView));
            turned.normalize();
            piece.normals.push_back(turned);
        }
    }

    /// Turns triangles so that their front is where their normals are, as readers of files expect. Walls between tiles have normals of the
    /// ground above them.
    static void turnFronts(MeshPiece& piece)
    {
        if (piece.normals.empty()) return;
        for (std::size_t i = 0; i + 2 < piece.corners.size(); i += 3)
        {
            unsigned int* const corner = &piece.corners[i];
            const osg::Vec3d& a = piece.positions[corner[0]];
            const osg::Vec3d front = (piece.positions[corner[1]] - a) ^ (piece.positions[corner[2]] - a);
            osg::Vec3d normal;
            for (int j = 0; j < 3; ++j)
                normal += piece.normals[corner[j]];
            if (front * normal < 0.0) std::swap(corner[1], corner[2]);
        }
    }

    /// Leaves out vertices that no triangle has.
    static void keepUsed(MeshPiece& piece)
    {
        constexpr unsigned int unused = std::numeric_limits<unsigned int>::max();
        std::vector<unsigned int> numbers(piece.positions.size(), unused);
        MeshPiece kept;
        kept.texture = piece.texture;
        for (const unsigned int corner : piece.corners)
        {
            if (numbers[corner] == unused)
            {
                numbers[corner] = static_cast<unsigned int>(kept.positions.size());
                kept.positions.push_back(piece.positions[corner]);
                if (!piece.normals.empty()) kept.normals.push_back(piece.normals[corner]);
                if (!piece.places.empty()) kept.places.push_back(piece.places[corner]);
            }
            kept.corners.push_back(numbers[corner]);
        }
        piece = std::move(kept);
    }

    std::vector<MeshPiece>& _pieces;
    const osg::Matrixd _clip;
    osg::ref_ptr<const DeformationChain> _chain;
    osg::Matrixd _modelView;
};

PictureMesh::PictureMesh(EffectScene& scene, const osg::Camera& camera, const Georeference* reference)
    : _pieces(std::make_shared<std::vector<MeshPiece>>()), _projection(camera.getProjectionMatrix())
{
    const DeformedView view(scene, camera);
    _modelView = view.modelView();
    const auto lodScale = static_cast<double>(camera.getLODScale());
    const unsigned int columns = scene.leastParts();
    const osg::NodePathList paths = scene.getTerrain()->getParentalNodePaths();
    const osg::NodePath above = paths.empty() ? osg::NodePath() : paths.front();
    // Each column of a wide strip has another deformation.
    for (unsigned int i = 0; i < columns; ++i)
    {
        const double low = 2.0 * i / columns - 1.0, high = 2.0 * (i + 1) / columns - 1.0;
        const osg::ref_ptr<const DeformationChain> chain =
            columns > 1 ? scene.deformationOfColumn(_modelView, _projection, low, high, above)
                        : osg::ref_ptr<const DeformationChain>(&view.chain());
        const osg::Matrixd part = osg::Matrixd::translate(-0.5 * (low + high), 0.0, 0.0) *
                                  osg::Matrixd::scale(static_cast<double>(columns), 1.0, 1.0);
        collect(scene, *chain, _projection * part, lodScale);
    }
    settle(reference);
}

void PictureMesh::collect(EffectScene& scene, const DeformationChain& chain, const osg::Matrixd& clip,
                          double lodScale)
{
    const osg::ref_ptr<Collector> collector = new Collector(*_pieces, clip);
    const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
        new DeformedIntersectionVisitor(collector, chain, _modelView, lodScale);
    scene.getTerrain()->traverse(*visitor);
}

void PictureMesh::settle(const Georeference* reference)
{
    osg::Vec3d middle;
    double count = 0.0;
    for (const MeshPiece& piece : *_pieces)
        for (const osg::Vec3d& position : piece.positions)
        {
            count += 1.0;
            middle += (position - middle) / count;
        }
    osg::Matrixd toWorld;
    toWorld.invert(_modelView);
    middle = middle * toWorld;
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    if (!reference || !reference->toGeodetic(middle, longitude, latitude, height) ||
        !reference->localToWorld(longitude, latitude, 0.0, _frame))
        _frame = osg::Matrixd::translate(std::round(middle.x()), std::round(middle.y()), 0.0);
    const osg::Matrixd toLocal = toWorld * osg::Matrixd::inverse(_frame);
    for (MeshPiece& piece : *_pieces)
    {
        for (osg::Vec3d& position : piece.positions)
            position = position * toLocal;
        for (osg::Vec3d& normal : piece.normals)
            normal = osg::Matrixd::transform3x3(normal, toLocal);
    }
}

std::size_t PictureMesh::triangles() const
{
    std::size_t count = 0;
    for (const MeshPiece& piece : *_pieces)
        count += piece.corners.size() / 3;
    return count;
}

osg::ref_ptr<osg::Node> PictureMesh::node() const
{
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    std::map<const osg::Texture2D*, osg::ref_ptr<osg::StateSet>> states;
    for (const MeshPiece& piece : *_pieces)
    {
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        const osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
        for (const osg::Vec3d& position : piece.positions)
            positions->push_back(osg::Vec3(position));
        geometry->setVertexArray(positions);
        if (piece.texture)
        {
            geometry->setTexCoordArray(0, new osg::Vec2Array(piece.places.begin(), piece.places.end()),
                                       osg::Array::BIND_PER_VERTEX);
            osg::ref_ptr<osg::StateSet>& state = states[piece.texture];
            if (!state) state = stateOf(*piece.texture);
            geometry->setStateSet(state);
        }
        geometry->addPrimitiveSet(
            new osg::DrawElementsUInt(GL_TRIANGLES, piece.corners.begin(), piece.corners.end()));
        geometry->setUseVertexBufferObjects(true);
        if (piece.normals.empty())
            osgUtil::SmoothingVisitor::smooth(*geometry, osg::PI);
        else
            geometry->setNormalArray(new osg::Vec3Array(piece.normals.begin(), piece.normals.end()),
                                     osg::Array::BIND_PER_VERTEX);
        geode->addDrawable(geometry);
    }
    geode->setUserValue("geofx.frame", _frame);
    geode->setUserValue("geofx.view", view());
    geode->setUserValue("geofx.projection", _projection);
    return geode;
}

std::string PictureMesh::faultOf(const std::string& file)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(file);
    if (extension != "obj" && extension != "osgb")
        return "\"" + file + "\": a mesh is written as .obj or .osgb; name such a file.";
    std::error_code ignored;
    const fs::path folder = fs::absolute(file).parent_path();
    if (fs::is_directory(file, ignored)) return "\"" + file + "\" is a folder; give the name of a file.";
    if (!fs::is_directory(folder, ignored) || access(folder.c_str(), W_OK) != 0)
        return "\"" + file +
               "\" cannot be written, as its folder does not exist or is not writable; make it first.";
    return {};
}

bool PictureMesh::write(const std::string& file, std::string& error) const
{
    error = faultOf(file);
    if (!error.empty()) return false;
    if (_pieces->empty())
    {
        error = "\"" + file + "\" is not written, since the picture shows no ground; choose another view.";
        return false;
    }
    const std::vector<std::string> notes = {
        "The terrain as a picture shows it, deformed. Metres; x is east, y up and z south of a local frame.",
        "Matrices have rows of four, and multiply rows of coordinates x east, y north, z up from the right.",
        "frame, from local coordinates to the world: " + text(_frame),
        "view, from local coordinates to the eye's: " + text(view()), "projection: " + text(_projection)};
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("WriteImageHint=IncludeData");
    if (osgDB::getLowerCaseFileExtension(file) == "obj" ? writeObjFile(file, *_pieces, notes)
                                                        : osgDB::writeNodeFile(*node(), file, options))
        return true;
    error = "\"" + file + "\" cannot be written; check the folder, its permissions and the disk's space.";
    return false;
}

} // namespace osgGeoFX
