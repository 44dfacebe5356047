// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/CullHarness.h>

#include <osgGeoFX/effect/Tessellation.h>

#include <osg/GLObjects>
#include <osg/TriangleIndexFunctor>
#include <osgDB/ReadFile>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>

namespace geofx::test
{

namespace
{

void collect(const osgUtil::RenderBin& bin, std::vector<Culled::Leaf>& leaves)
{
    const auto take = [&](const osgUtil::RenderLeaf& leaf)
    {
        if (leaf._modelview)
            leaves.push_back({&osgGeoFX::PatchGeometry::originalOf(*leaf._drawable), *leaf._modelview});
    };
    for (const osgUtil::RenderLeaf* leaf : bin.getRenderLeafList())
        take(*leaf);
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
    {
        for (const auto& leaf : graph->_leaves)
            take(*leaf);
    }
    for (const auto& entry : bin.getRenderBinList())
        collect(*entry.second, leaves);
}

/// Whether a triangle in clip space has a point before the eye and within the picture's sides.
bool visible(const std::array<osg::Vec4d, 3>& corners)
{
    static const std::array<osg::Vec4d, 5> planes = {osg::Vec4d(1, 0, 0, 1), osg::Vec4d(-1, 0, 0, 1),
                                                     osg::Vec4d(0, 1, 0, 1), osg::Vec4d(0, -1, 0, 1),
                                                     osg::Vec4d(0, 0, 0, 1)};
    // Most triangles lie beyond one of the planes.
    for (const osg::Vec4d& plane : planes)
        if (corners[0] * plane < 0.0 && corners[1] * plane < 0.0 && corners[2] * plane < 0.0) return false;
    // Each plane adds one corner at most.
    std::array<osg::Vec4d, 8> polygon, kept;
    std::size_t count = corners.size();
    std::copy(corners.begin(), corners.end(), polygon.begin());
    for (const osg::Vec4d& plane : planes)
    {
        std::size_t left = 0;
        for (std::size_t i = 0; i < count; ++i)
        {
            const osg::Vec4d& a = polygon[i];
            const osg::Vec4d& b = polygon[(i + 1) % count];
            const double da = a * plane;
            const double db = b * plane;
            if (da >= 0.0) kept.at(left++) = a;
            if ((da >= 0.0) != (db >= 0.0)) kept.at(left++) = a + (b - a) * (da / (da - db));
        }
        polygon.swap(kept);
        count = left;
        if (count == 0) return false;
    }
    // What is gathered in a point covers no pixel.
    const osg::Vec4d& first = polygon[0];
    for (std::size_t i = 0; i < count; ++i)
    {
        const osg::Vec4d& corner = polygon[i];
        if (first.w() < 1e-9 || corner.w() < 1e-9) return true;
        if (std::hypot(corner.x() / corner.w() - first.x() / first.w(),
                       corner.y() / corner.w() - first.y() / first.w()) > 1e-9)
            return true;
    }
    return false;
}

/// Looks at triangles until one is in sight. Each vertex is deformed once, whatever the number of its triangles.
struct VisibleTriangle
{
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        if (!found) found = visible({place(a), place(b), place(c)});
    }

    const osg::Vec4d& place(unsigned int index)
    {
        std::optional<osg::Vec4d>& result = places.at(index);
        if (!result)
            result = osg::Vec4d(chain->deform(osg::Vec3d(vertices[index]) * modelView), 1.0) * projection;
        return *result;
    }

    const osgGeoFX::DeformationChain* chain = nullptr;
    osg::Matrixd modelView;
    osg::Matrixd projection;
    const osg::Vec3* vertices = nullptr;
    std::vector<std::optional<osg::Vec4d>> places; ///< of vertices in clip space
    bool found = false;
};

class VisibleTriangles : public osg::TriangleIndexFunctor<VisibleTriangle>
{
public:
    using osg::TriangleIndexFunctor<VisibleTriangle>::setVertexArray;
    void setVertexArray(unsigned int count, const osg::Vec3* given) override
    {
        vertices = given;
        places.assign(count, std::nullopt);
    }
};

bool inSight(const Culled::Leaf& leaf, const osg::Matrixd& projection,
             const osgGeoFX::DeformationChain& chain)
{
    VisibleTriangles functor;
    functor.chain = &chain;
    functor.modelView = leaf.modelView;
    functor.projection = projection;
    leaf.drawable->accept(functor);
    return functor.found;
}

} // namespace

void RequestRecorder::requestNodeFile(const std::string& file, osg::NodePath& path, float priority,
                                      const osg::FrameStamp* stamp, osg::ref_ptr<osg::Referenced>&,
                                      const osg::Referenced*)
{
    requests.push_back({file, dynamic_cast<osg::PagedLOD*>(path.back()), priority,
                        stamp ? stamp->getReferenceTime() : 0.0, stamp ? stamp->getFrameNumber() : 0});
}

std::set<const osg::Drawable*> Culled::drawables() const
{
    std::set<const osg::Drawable*> result;
    for (const Leaf& leaf : leaves)
        result.insert(leaf.drawable);
    return result;
}

std::set<const osg::PagedLOD*> Culled::requesting() const
{
    std::set<const osg::PagedLOD*> result;
    for (const auto& request : requests)
        result.insert(request.group);
    return result;
}

Oracle::Oracle(const Culled& everything, const osgGeoFX::DeformationChain& chain) : image(everything.image)
{
    const std::set<const osg::PagedLOD*> asking = everything.requesting();
    for (const Culled::Leaf& leaf : everything.leaves)
    {
        if (!inSight(leaf, everything.projection, chain)) continue;
        needed.insert(leaf.drawable);
        for (const osg::NodePath& path : leaf.drawable->getParentalNodePaths())
        {
            for (const osg::Node* node : path)
            {
                const auto* group = dynamic_cast<const osg::PagedLOD*>(node);
                if (group && asking.count(group)) deserving.insert(group);
            }
        }
    }
}

Oracle::Mistakes Oracle::mistakesOf(const Culled& culled) const
{
    Mistakes mistakes;
    mistakes.picture = culled.image->getTotalSizeInBytes() != image->getTotalSizeInBytes() ||
                       std::memcmp(culled.image->data(), image->data(), image->getTotalSizeInBytes()) != 0;
    const std::set<const osg::Drawable*> drawn = culled.drawables();
    for (const osg::Drawable* drawable : needed)
        mistakes.culled += drawn.count(drawable) ? 0 : 1;
    const std::set<const osg::PagedLOD*> asking = culled.requesting();
    for (const osg::PagedLOD* group : deserving)
        mistakes.unasked += asking.count(group) ? 0 : 1;
    return mistakes;
}

CullHarness::CullHarness(osg::GraphicsContext& context, osg::Node* scene, int width, int height)
    : _context(&context), _view(new osgUtil::SceneView), _stamp(new osg::FrameStamp)
{
    _view->setDefaults(osgUtil::SceneView::STANDARD_SETTINGS);
    _view->setState(context.getState());
    _view->setFrameStamp(_stamp);
    osg::Camera& own = *_view->getCamera();
    own.setViewport(0, 0, width, height);
    own.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    own.getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    setScene(scene);
}

void CullHarness::setScene(osg::Node* scene)
{
    _view->setSceneData(scene);
    // Or OpenGL's buffers of the former scene would be used for tiles of this one, which Mesa finds slow.
    if (_context->makeCurrent()) osg::flushAllDeletedGLObjects(_context->getState()->getContextID());
}

void CullHarness::setCamera(const osg::Matrixd& view, const osg::Matrixd& projection)
{
    camera().setViewMatrix(view);
    camera().setProjectionMatrix(projection);
    _stamp->setFrameNumber(_stamp->getFrameNumber() + 1);
}

Culled CullHarness::frame(bool cull, bool draw)
{
    const osg::CullSettings::CullingMode former = camera().getCullingMode();
    if (!cull) camera().setCullingMode(osg::CullSettings::NO_CULLING);
    _recorder->requests.clear();
    _view->getCullVisitor()->setDatabaseRequestHandler(_recorder);
    // As osgViewer's renderer does it.
    _view->inheritCullSettings(camera());
    _context->makeCurrent();
    const auto start = std::chrono::steady_clock::now();
    _view->cull();
    Culled result;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    camera().setCullingMode(former);
    collect(*_view->getRenderStage(), result.leaves);
    result.requests = _recorder->requests;
    result.projection = camera().getProjectionMatrix();
    for (const osgUtil::RenderBin* bin = _view->getRenderStage(); bin && !result.leaves.empty();)
    {
        const osgUtil::RenderLeaf* leaf = nullptr;
        if (!bin->getRenderLeafList().empty())
            leaf = bin->getRenderLeafList().front();
        else if (!bin->getStateGraphList().empty())
            leaf = bin->getStateGraphList().front()->_leaves.front().get();
        if (leaf)
        {
            result.projection = *leaf->_projection;
            break;
        }
        const auto& bins = bin->getRenderBinList();
        bin = bins.empty() ? nullptr : bins.begin()->second.get();
    }
    if (draw)
    {
        _view->draw();
        const osg::Viewport& port = *camera().getViewport();
        result.image = new osg::Image;
        result.image->readPixels(0, 0, static_cast<int>(port.width()), static_cast<int>(port.height()),
                                 GL_RGB, GL_UNSIGNED_BYTE);
    }
    return result;
}

int CullHarness::load(const std::vector<RequestRecorder::Request>& requests, Random& random,
                      double probability)
{
    int loaded = 0;
    // Several passes may ask for the same.
    std::set<std::pair<const osg::PagedLOD*, std::string>> known;
    for (const auto& request : requests)
    {
        if (random.uniform(0.0, 1.0) > probability) continue;
        if (!known.emplace(request.group, request.file).second) continue;
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(request.file);
        if (!node) continue;
        request.group->addChild(node);
        // As the pager does on its own thread.
        node->getBound();
        ++loaded;
    }
    return loaded;
}

} // namespace geofx::test
