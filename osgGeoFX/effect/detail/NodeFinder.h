// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Group>

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/** Finds the first node of a kind below a group, and remembers the way to it: asking again costs no more than that way, a step for
    each level. Levels of detail (osg::LOD) are not looked into.

    The first look is complete. While there is none, each later one goes on for a few dozen nodes from where the last one ended: OSG
    does not tell what comes into a graph, and to look through a large one in each frame would take longer than drawing it. So
    what comes to a small scene is found at once, to one of 100,000 nodes within some seconds. For one thread at a time. */
class NodeFinder
{
public:
    using Wanted = bool (*)(const osg::Node& node);

    /// `depth`: how far below the group a node may be.
    NodeFinder(Wanted wanted, std::size_t depth) : _wanted(wanted), _depth(depth) {}

    /// Of the group itself and what is below it; null where there is none.
    const osg::Node* find(const osg::Group& top);

private:
    /// A child on the way down, and where it was in its parent.
    struct Step
    {
        const osg::Node* node;
        unsigned int place;
    };
    bool leadsDown() const;
    void start();
    void walk(std::size_t nodes);

    const Wanted _wanted;
    const std::size_t _depth;
    const osg::Group* _top = nullptr;
    std::vector<Step> _way; ///< to what was found, or to where the look through the graph is
    unsigned int _next = 0; ///< the child to be looked at then
    bool _found = false;
    bool _looking = false;
};

} // namespace osgGeoFX
