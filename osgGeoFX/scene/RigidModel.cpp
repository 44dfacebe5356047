// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/RigidModel.h>

#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/scene/detail/ConnectedThings.h>
#include <osgGeoFX/scene/detail/PlainGeometry.h>

#include <osg/BoundingBox>
#include <osg/Geometry>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

bool scales(const osg::Matrixd& matrix)
{
    constexpr double slack = 1e-3;
    return std::abs(largestScale(matrix) - 1.0) > slack ||
           std::abs(largestScale(osg::Matrixd::inverse(matrix)) - 1.0) > slack;
}

/// Finds the geometries whose things keep their shape, each once, with its matrix, in the order of the traversal.
class Finder : public PlainGeometry
{
public:
    std::vector<std::pair<osg::ref_ptr<osg::Geometry>, osg::Matrixd>> found;

private:
    bool enters(const osg::Matrixd& matrix) const override { return !scales(matrix); }
    void meet(osg::Geometry& geometry, const osg::Matrixd& matrix) override
    {
        const auto* const vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
        if (!vertices || vertices->empty() || DrawableTriangles::instanced(geometry)) return;
        if (_known.insert(&geometry).second) found.emplace_back(&geometry, matrix);
    }

    std::set<const osg::Geometry*> _known;
};

/// What is known of one thing.
struct Thing
{
    osg::BoundingBoxd box;
    osg::Vec3d up;
    double lowest = HUGE_VAL;
    bool isBuilding = false;

    osg::Vec3d reference() const { return box.center() + up * (lowest - box.center() * up); }
};

} // namespace

RigidModel::RigidModel(const osg::EllipsoidModel* ellipsoid) : _ellipsoid(ellipsoid) {}

RigidModel::~RigidModel() = default;

bool RigidModel::setLargest(double metres)
{
    if (!(metres > 0.0))
    {
        OSG_WARN << "osgGeoFX: RigidModel: the largest building must be more than 0 m, not " << metres
                 << ". It stays " << _largest << " m." << std::endl;
        return false;
    }
    _largest = metres;
    return true;
}

void RigidModel::prepare(osg::Node& node)
{
    Finder finder;
    node.accept(finder);

    // Coordinates may be those of a globe, so places are differences from one of them.
    ConnectedThings connected;
    osg::Vec3d origin;
    bool any = false;
    std::vector<std::vector<unsigned int>> cornersOf;
    std::vector<char> inTriangle;
    for (const auto& [geometry, matrix] : finder.found)
    {
        const DrawableTriangles triangles(*geometry);
        if (!any && !triangles.positions().empty()) origin = triangles.positions().front() * matrix;
        any = any || !triangles.positions().empty();
        std::vector<unsigned int>& corners = cornersOf.emplace_back();
        corners.reserve(triangles.positions().size());
        for (const osg::Vec3d& position : triangles.positions())
            corners.push_back(connected.corner(position * matrix - origin));
        inTriangle.resize(connected.places().size(), 0);
        const std::vector<unsigned int>& all = triangles.corners();
        for (std::size_t i = 0; i + 2 < all.size(); i += 3)
        {
            connected.join(corners[all[i]], corners[all[i + 1]]);
            connected.join(corners[all[i]], corners[all[i + 2]]);
            for (std::size_t k = 0; k < 3; ++k)
                inTriangle[corners[all[i + k]]] = 1;
        }
    }

    std::map<unsigned int, Thing> things;
    const auto count = static_cast<unsigned int>(connected.places().size());
    for (unsigned int i = 0; i < count; ++i)
        if (inTriangle[i]) things[connected.thing(i)].box.expandBy(connected.places()[i]);
    for (auto& [name, thing] : things)
    {
        thing.isBuilding = 2.0 * thing.box.radius() <= _largest;
        const osg::Vec3d middle = thing.box.center() + origin;
        thing.up = _ellipsoid ? _ellipsoid->computeLocalUpVector(middle.x(), middle.y(), middle.z())
                              : osg::Vec3d(0.0, 0.0, 1.0);
        _things += thing.isBuilding ? 1 : 0;
    }
    for (unsigned int i = 0; i < count; ++i)
    {
        if (!inTriangle[i]) continue;
        Thing& thing = things[connected.thing(i)];
        thing.lowest = std::min(thing.lowest, connected.places()[i] * thing.up);
    }

    // Geometries that shared a state set share its copy, so that the order of drawing stays good.
    std::map<osg::ref_ptr<osg::StateSet>, osg::ref_ptr<osg::StateSet>> states;
    for (std::size_t i = 0; i < finder.found.size(); ++i)
    {
        const auto& [geometry, matrix] = finder.found[i];
        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
        const osg::Matrixd back = osg::Matrixd::inverse(matrix);
        std::vector<osg::Vec3> references(vertices.begin(), vertices.end());
        bool moves = false;
        for (std::size_t k = 0; k < references.size() && k < cornersOf[i].size(); ++k)
        {
            // What refers to itself moves as the ground does.
            const auto found = things.find(connected.thing(cornersOf[i][k]));
            if (found == things.end() || !found->second.isBuilding) continue;
            references[k] = osg::Vec3((found->second.reference() + origin) * back);
            moves = true;
        }
        if (!moves) continue;
        RigidParts::finish(*geometry, references);
        osg::ref_ptr<osg::StateSet>& state = states[geometry->getStateSet()];
        if (!state)
            state = geometry->getStateSet()
                        ? new osg::StateSet(*geometry->getStateSet(), osg::CopyOp::SHALLOW_COPY)
                        : new osg::StateSet;
        state->setDefine(RigidParts::define);
        geometry->setStateSet(state);
        geometry->dirtyGLObjects();
        ++_geometries;
    }
}

} // namespace osgGeoFX
