// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/StrokeMaker.h>

#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/UserDataContainer>

#include <vector>

namespace osgGeoFX
{

namespace
{

/// Geometries may be shared by scenes, and so by makers.
std::mutex& userDataMutex()
{
    static std::mutex mutex;
    return mutex;
}

TileStrokes* found(const osg::Geometry& terrain, const StrokeParameters& parameters,
                   const osg::EllipsoidModel* ellipsoid)
{
    const osg::UserDataContainer* data = terrain.getUserDataContainer();
    for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
    {
        const auto* strokes = dynamic_cast<const TileStrokes*>(data->getUserObject(i));
        if (strokes && strokes->madeWith(parameters, ellipsoid)) return const_cast<TileStrokes*>(strokes);
    }
    return nullptr;
}

/// Scenes with different parameters may share a terrain; more than these and the oldest go.
constexpr unsigned int mostSets = 2;

void keep(osg::Geometry& terrain, TileStrokes& strokes)
{
    osg::UserDataContainer* data = terrain.getOrCreateUserDataContainer();
    std::vector<unsigned int> former;
    for (unsigned int i = 0; i < data->getNumUserObjects(); ++i)
        if (dynamic_cast<const TileStrokes*>(data->getUserObject(i))) former.push_back(i);
    if (former.size() >= mostSets) data->removeUserObject(former.front());
    data->addUserObject(&strokes);
}

} // namespace

class StrokeMaker::Furnisher : public osg::NodeVisitor
{
public:
    Furnisher(const StrokeMaker& maker, const osg::Matrixd& toWorld)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _maker(maker), _toWorld(toWorld)
    {
        setNodeMaskOverride(~0u);
    }

    void apply(osg::Transform& transform) override
    {
        const osg::Matrixd above = _toWorld;
        transform.computeLocalToWorldMatrix(_toWorld, this);
        traverse(transform);
        _toWorld = above;
    }

    void apply(osg::Geometry& geometry) override { _maker.strokes(geometry, _toWorld); }

private:
    const StrokeMaker& _maker;
    osg::Matrixd _toWorld;
};

StrokeMaker::StrokeMaker(const osg::EllipsoidModel* ellipsoid) : _ellipsoid(ellipsoid) {}

StrokeMaker::~StrokeMaker() = default;

void StrokeMaker::setParameters(const StrokeParameters& parameters)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _parameters = parameters;
}

StrokeParameters StrokeMaker::getParameters() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _parameters;
}

void StrokeMaker::furnish(osg::Node& tile, const osg::Matrixd& toWorld)
{
    Furnisher furnisher(*this, toWorld);
    tile.accept(furnisher);
}

osg::ref_ptr<osg::Geometry> StrokeMaker::strokes(osg::Geometry& terrain, const osg::Matrixd& toWorld) const
{
    const StrokeParameters parameters = getParameters();
    {
        const std::lock_guard<std::mutex> lock(userDataMutex());
        if (const TileStrokes* known = found(terrain, parameters, _ellipsoid.get())) return known->points();
    }
    // Not under the lock. Where two threads make the same ones, the first's are kept.
    const osg::ref_ptr<TileStrokes> made = TileStrokes::make(terrain, toWorld, parameters, _ellipsoid.get());
    const std::lock_guard<std::mutex> lock(userDataMutex());
    if (const TileStrokes* known = found(terrain, parameters, _ellipsoid.get())) return known->points();
    keep(terrain, *made);
    return made->points();
}

} // namespace osgGeoFX
