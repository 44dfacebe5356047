// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/detail/NodeFinder.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// The steps of one look, and of a first one. A node takes up to two steps.
constexpr std::size_t slice = 128, all = 2000000;

} // namespace

bool NodeFinder::leadsDown() const
{
    // A node that is still a child of a living group lives. Only such nodes are used.
    const osg::Group* parent = _top;
    for (const Step& step : _way)
    {
        if (!parent || step.place >= parent->getNumChildren() || parent->getChild(step.place) != step.node)
            return false;
        parent = step.node->asGroup();
    }
    return true;
}

void NodeFinder::start()
{
    _way.clear();
    _next = 0;
    _found = _wanted(*_top);
    _looking = !_found;
}

void NodeFinder::walk(std::size_t nodes)
{
    for (; _looking && nodes > 0; --nodes)
    {
        const osg::Group* parent = _way.empty() ? _top : _way.back().node->asGroup();
        if (parent && _next < parent->getNumChildren())
        {
            const osg::Node* child = parent->getChild(_next);
            _way.push_back({child, _next});
            _next = 0;
            _found = _wanted(*child);
            _looking = !_found;
        }
        else if (_way.empty())
        {
            _looking = false;
        }
        else
        {
            _next = _way.back().place + 1;
            _way.pop_back();
        }
    }
}

const osg::Node* NodeFinder::find(const osg::Group& top)
{
    const auto found = [&]
    {
        return _way.empty() ? _top : _way.back().node;
    };
    if (&top != _top)
    {
        _top = &top;
        start();
        walk(all);
    }
    else if (_found)
    {
        if (leadsDown() && _wanted(*found())) return found();
        // The scene's frame depends on this node, so its replacement must be found at once.
        start();
        walk(all);
    }
    else
    {
        if (!_looking || !leadsDown()) start();
        walk(slice);
    }
    return _found ? found() : nullptr;
}

void NodeFinder::meet(const osg::Group& top, const osg::NodePath& path)
{
    if (&top != _top || _found) return;
    const auto start = std::find(path.begin(), path.end(), &top);
    if (start == path.end()) return;
    _way.clear();
    const osg::Group* parent = _top;
    for (auto node = start + 1; node != path.end() && parent; ++node)
    {
        _way.push_back({*node, parent->getChildIndex(*node)});
        parent = (*node)->asGroup();
    }
    _next = 0;
    _found = true;
    _looking = false;
}

} // namespace osgGeoFX
