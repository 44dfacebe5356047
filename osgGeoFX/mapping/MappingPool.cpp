// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/MappingPool.h>

#include <utility>

namespace osgGeoFX
{

MappingPool::MappingPool(ProjectiveMappings& host, Prepare prepare)
    : MappingPool([keep = osg::ref_ptr<ProjectiveMappings>(&host)](ProjectiveMapping& mapping, std::size_t)
                  { keep->addMapping(&mapping); },
                  [keep = osg::ref_ptr<ProjectiveMappings>(&host)](ProjectiveMapping& mapping, std::size_t)
                  { keep->removeMapping(&mapping); },
                  std::move(prepare))
{
}

MappingPool::MappingPool(Put add, Put remove, Prepare prepare)
    : _add(std::move(add)), _remove(std::move(remove)), _prepare(std::move(prepare))
{
}

MappingPool::~MappingPool()
{
    clear();
}

ProjectiveMapping& MappingPool::next()
{
    if (_used == _mappings.size())
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        _prepare(*mapping);
        _add(*mapping, _used);
        _mappings.push_back(mapping);
    }
    return *_mappings[_used++];
}

void MappingPool::trim()
{
    for (; _mappings.size() > _used; _mappings.pop_back())
        _remove(*_mappings.back(), _mappings.size() - 1);
}

void MappingPool::clear()
{
    rewind();
    trim();
}

void MappingPool::prepareAll(Prepare prepare)
{
    _prepare = std::move(prepare);
    prepareAll();
}

void MappingPool::prepareAll()
{
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : _mappings)
        _prepare(*mapping);
}

void surround(MappingPool& pool, const osg::Vec2d& low, const osg::Vec2d& high, double reach)
{
    const osg::Vec2d outerLow = low - osg::Vec2d(reach, reach);
    const osg::Vec2d outerHigh = high + osg::Vec2d(reach, reach);
    const auto add = [&pool](const osg::Vec2d& from, const osg::Vec2d& to)
    {
        const osg::Vec2d half = (to - from) / 2.0;
        ProjectiveMapping& mapping = pool.next();
        mapping.setRectangle(from + half, half.x(), half.y());
        mapping.setSoftEdges(false);
    };
    pool.rewind();
    add(outerLow, {outerHigh.x(), low.y()});
    add({outerLow.x(), high.y()}, outerHigh);
    add({outerLow.x(), low.y()}, {low.x(), high.y()});
    add({high.x(), low.y()}, {outerHigh.x(), high.y()});
    pool.trim();
}

} // namespace osgGeoFX
