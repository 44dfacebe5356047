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

StrokeMaker::~StrokeMaker()
{
    // Those of tiles that stay would stay with them.
    const std::lock_guard<std::mutex> lock(userDataMutex());
    for (const auto& each : _keepers)
    {
        osg::ref_ptr<osg::Object> keeper;
        if (each.lock(keeper)) dropUnwanted(*keeper, [this](const TileStrokes&) { return true; });
    }
}

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
TileStrokes* StrokeMaker::known(osg::Object& keeper, const osg::Matrixd& toWorld,
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
        if (std::none_of(strokes->_users.begin(), strokes->_users.end(), isThis)) take(keeper, *strokes);
        return strokes;
    }
    return nullptr;
}

/// Strokes belong to this maker, too. The caller holds the lock of the user data.
void StrokeMaker::take(osg::Object& keeper, TileStrokes& strokes) const
{
    strokes._users.emplace_back(this);
    if (_keepers.size() >= _tidyAt)
    {
        const auto gone = [](const auto& each)
        {
            return !each.valid();
        };
        _keepers.erase(std::remove_if(_keepers.begin(), _keepers.end(), gone), _keepers.end());
        _tidyAt = 2 * _keepers.size() + 64;
    }
    _keepers.emplace_back(&keeper);
}

/// Takes away the strokes that no maker wants any more. This one does not want those of which `isFormer` is true, and
/// that is asked of the youngest first. The caller holds the lock of the user data.
template<typename IsFormer>
void StrokeMaker::dropUnwanted(osg::Object& keeper, const IsFormer& isFormer) const
{
    osg::UserDataContainer* data = keeper.getUserDataContainer();
    for (unsigned int i = data ? data->getNumUserObjects() : 0; i-- > 0;)
    {
        auto* strokes = dynamic_cast<TileStrokes*>(data->getUserObject(i));
        if (!strokes) continue;
        const bool former = isFormer(*strokes);
        const auto gone = [&](const auto& each)
        {
            return !each.valid() || (former && each.get() == this);
        };
        auto& users = strokes->_users;
        users.erase(std::remove_if(users.begin(), users.end(), gone), users.end());
        if (users.empty()) data->removeUserObject(i);
    }
}

/// Gives strokes to their keeper in the place of former ones. The caller holds the lock of the user data.
void StrokeMaker::keep(osg::Object& keeper, TileStrokes& strokes) const
{
    int places = 1;
    // This maker's parameters have changed, or it has seen the tile in too many places.
    dropUnwanted(keeper,
                 [&](const TileStrokes& other) {
                     return !other.madeWith(strokes.parameters(), _ellipsoid.get()) || ++places > mostPlaces;
                 });
    take(keeper, strokes);
    keeper.getOrCreateUserDataContainer()->addUserObject(&strokes);
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
