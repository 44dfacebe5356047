// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <osg/Node>
#include <osg/observer_ptr>

#include <unordered_map>

namespace osgGeoFX
{

/** Finds out whether a subgraph has parts that are not deformed. GEOFX_DEFORMATION leaves such parts out, or their
    program does not call the functions. The deformed bound of the subgraph says nothing of them. For one thread at a
    time. */
class UndeformedParts
{
public:
    /// Looks at everything below a node now.
    static bool search(const osg::Node& node, OwnPrograms& programs);
    /// The same. The result is kept for some frames.
    bool below(const osg::Node& node, OwnPrograms& programs, unsigned int frame);

private:
    struct Known
    {
        osg::observer_ptr<const osg::Node> node;
        unsigned int frame = 0;
        bool parts = false;
    };
    std::unordered_map<const osg::Node*, Known> _known;
    std::size_t _most = 64; ///< the number of entries at which those of deleted nodes go
};

} // namespace osgGeoFX
