// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <osg/Node>
#include <osg/observer_ptr>

#include <unordered_map>

namespace osgGeoFX
{

/** Whether a subgraph has parts that stay where they are while the rest is deformed: left out by GEOFX_DEFORMATION, or with a program
    that does not call the functions. What the deformation makes of the subgraph's bound says nothing of those. For one
    thread at a time. */
class UndeformedParts
{
public:
    /// Looks at all that is below now.
    static bool search(const osg::Node& node, OwnPrograms& programs);
    /// The same, remembered for some frames.
    bool below(const osg::Node& node, OwnPrograms& programs, unsigned int frame);

private:
    struct Known
    {
        osg::observer_ptr<const osg::Node> node;
        unsigned int frame = 0;
        bool parts = false;
    };
    std::unordered_map<const osg::Node*, Known> _known;
    std::size_t _most = 64; ///< entries before those of deleted nodes are forgotten
};

} // namespace osgGeoFX
