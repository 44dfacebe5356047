// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Group>

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/** Finds the first node of a kind below a group, and remembers the way to it. Asking again costs one step for each
    level of the way.

    The first look is complete, up to a million nodes. If it finds nothing, each later look goes on for a few dozen nodes
    from where the last one ended. OSG does not tell what is added to a graph, and searching a large one in each frame
    would take longer than drawing it. A node that is added to a small scene is found at once; in one of 100,000 nodes it
    takes some seconds, unless someone meets it there. For one thread at a time. */
class NodeFinder
{
public:
    using Wanted = bool (*)(const osg::Node& node);

    explicit NodeFinder(Wanted wanted) : _wanted(wanted) {}

    /// The node among the group and everything below it; null if there is none.
    const osg::Node* find(const osg::Group& top);
    /// A traversal has met such a node: the last one of a path that leads through the group. It counts where none is known.
    void meet(const osg::Group& top, const osg::NodePath& path);

private:
    /// A child on the way down, and its place in its parent.
    struct Step
    {
        const osg::Node* node;
        unsigned int place;
    };
    bool leadsDown() const;
    void start();
    void walk(std::size_t nodes);

    const Wanted _wanted;
    const osg::Group* _top = nullptr;
    std::vector<Step> _way; ///< to the found node, or to where the search has come
    unsigned int _next = 0; ///< the child to look at next
    bool _found = false;
    bool _looking = false;
};

} // namespace osgGeoFX
