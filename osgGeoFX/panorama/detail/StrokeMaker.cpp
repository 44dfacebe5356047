// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/StrokeMaker.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/UserDataContainer>

#include <algorithm>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// One lock for all makers, since scenes, and so makers, may share geometries.
std::mutex& userDataMutex()
{
    static std::mutex mutex;
    return mutex;
}

/// The object that keeps the strokes of a geometry. The meshes of a terrain tile share theirs.
osg::Object& keeperOf(osg::Geometry& terrain)
{
    const osg::Transform* tile = TileInfo::tileOf(terrain);
    const osg::Geometry* mesh = tile ? TileInfo::firstMesh(*tile) : nullptr;
    // Not the tile itself: others read its user data without a lock.
    return mesh ? const_cast<osg::Geometry&>(*mesh) : terrain;
}

/// A tile in more places than these loses the strokes of the first ones.
constexpr int mostPlaces = 4;

} // namespace

class StrokeMaker::Furnisher : public osg::NodeVisitor
{
public:
    Furnisher(const StrokeMaker& maker, const osg::Matrixd& above, bool ofPager)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _maker(maker), _above(above), _toWorld(above),
          _ofPager(ofPager)
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

    void apply(osg::Geometry& geometry) override
    {
        _maker.strokes(geometry, _toWorld);
        if (!_ofPager) return;
        const std::lock_guard<std::mutex> lock(userDataMutex());
        TileStrokes* made = _maker.known(keeperOf(geometry), _toWorld, _maker.getParameters());
        if (made) made->_above = _above;
    }

private:
    const StrokeMaker& _maker;
    const osg::Matrixd _above;
    osg::Matrixd _toWorld;
    const bool _ofPager;
};

StrokeMaker::StrokeMaker(const osg::EllipsoidModel* ellipsoid) : _ellipsoid(ellipsoid) {}

StrokeMaker::~StrokeMaker() = default;

bool StrokeMaker::isFor(const osg::EllipsoidModel* ellipsoid) const
{
    if (!ellipsoid || !_ellipsoid) return ellipsoid == _ellipsoid;
    return *ellipsoid == *_ellipsoid;
}

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

/// The strokes of a place, if there are any. They belong to this maker, too, from now on. The caller holds the lock
/// of the user data.
TileStrokes* StrokeMaker::known(const osg::Object& keeper, const osg::Matrixd& toWorld,
                                const StrokeParameters& parameters) const
{
    const osg::UserDataContainer* data = keeper.getUserDataContainer();
    for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
    {
        auto* strokes = const_cast<TileStrokes*>(dynamic_cast<const TileStrokes*>(data->getUserObject(i)));
        if (!strokes || !strokes->madeWith(parameters, _ellipsoid.get()) || !strokes->madeAt(toWorld))
            continue;
        const auto isThis = [&](const auto& each)
        {
            return each.get() == this;
        };
        if (std::none_of(strokes->_users.begin(), strokes->_users.end(), isThis))
            strokes->_users.emplace_back(this);
        return strokes;
    }
    return nullptr;
}

/// Gives strokes to their keeper, and takes away those that no maker wants any more. The caller holds the lock of the
/// user data.
void StrokeMaker::keep(osg::Object& keeper, TileStrokes& strokes) const
{
    osg::UserDataContainer* data = keeper.getOrCreateUserDataContainer();
    int places = 1;
    for (unsigned int i = data->getNumUserObjects(); i-- > 0;)
    {
        auto* other = dynamic_cast<TileStrokes*>(data->getUserObject(i));
        if (!other) continue;
        // This maker's parameters have changed, or it has seen the tile in too many places.
        const bool same = other->madeWith(strokes.parameters(), _ellipsoid.get());
        const bool former = !same || ++places > mostPlaces;
        const auto gone = [&](const auto& each)
        {
            return !each.valid() || (former && each.get() == this);
        };
        auto& users = other->_users;
        users.erase(std::remove_if(users.begin(), users.end(), gone), users.end());
        if (users.empty()) data->removeUserObject(i);
    }
    strokes._users.emplace_back(this);
    data->addUserObject(&strokes);
}

/// If the pager's strokes were made for another place, there is a transform above its tiles. The caller holds the
/// lock of the user data.
void StrokeMaker::learn(const osg::Object& keeper, const osg::Matrixd& toWorld) const
{
    const osg::UserDataContainer* data = keeper.getUserDataContainer();
    for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
    {
        auto* strokes = const_cast<TileStrokes*>(dynamic_cast<const TileStrokes*>(data->getUserObject(i)));
        const auto isThis = [&](const auto& each)
        {
            return each.get() == this;
        };
        if (!strokes || !strokes->_above ||
            std::none_of(strokes->_users.begin(), strokes->_users.end(), isThis))
            continue;
        const osg::Matrixd above = *strokes->_above * osg::Matrixd::inverse(strokes->_toWorld) * toWorld;
        strokes->_users.erase(std::remove_if(strokes->_users.begin(), strokes->_users.end(), isThis),
                              strokes->_users.end());
        const std::lock_guard<std::mutex> lock(_mutex);
        _above = above;
        return;
    }
}

void StrokeMaker::tileRead(osg::Node& tile)
{
    osg::Matrixd above;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        above = _above;
    }
    furnishBelow(tile, above, true);
}

void StrokeMaker::furnish(osg::Node& tile, const osg::Matrixd& toWorld)
{
    furnishBelow(tile, toWorld, false);
}

void StrokeMaker::furnishBelow(osg::Node& tile, const osg::Matrixd& above, bool ofPager)
{
    Furnisher furnisher(*this, above, ofPager);
    tile.accept(furnisher);
}

osg::ref_ptr<osg::Geometry> StrokeMaker::strokes(osg::Geometry& terrain, const osg::Matrixd& toWorld) const
{
    const StrokeParameters parameters = getParameters();
    osg::Object& keeper = keeperOf(terrain);
    {
        const std::lock_guard<std::mutex> lock(userDataMutex());
        if (const TileStrokes* strokes = known(keeper, toWorld, parameters)) return strokes->points();
    }
    // Made without the lock. If two threads make the same strokes, the first ones are kept.
    const osg::Transform* tile = TileInfo::tileOf(terrain);
    const osg::ref_ptr<osg::Geometry> ground = tile ? TileInfo::ground(*tile) : nullptr;
    const osg::ref_ptr<TileStrokes> made =
        TileStrokes::make(ground ? *ground : terrain, toWorld, parameters, _ellipsoid.get());
    const std::lock_guard<std::mutex> lock(userDataMutex());
    if (const TileStrokes* strokes = known(keeper, toWorld, parameters)) return strokes->points();
    learn(keeper, toWorld);
    keep(keeper, *made);
    return made->points();
}

} // namespace osgGeoFX
