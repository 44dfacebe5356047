// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/NodeVisitor>
#include <osg/PagedLOD>

#include <vector>

namespace osgGeoFX
{

/** Goes through all paged children that are loaded, and tells when each was last seen. Keeps all of them from expiring; whoever wants one to go says so
    afterwards. */
class TileAges : public osg::NodeVisitor
{
public:
    /// A child that can go.
    struct Child
    {
        osg::PagedLOD* group = nullptr;
        unsigned int index = 0;
        /// The last time that it, or something below it, was culled or came, seconds of reference time.
        double seen = 0.0;
        bool ahead = false; ///< whether it, or something below it, is looked at by a TilePrefetch
        unsigned int depth = 0;

        /// The tile. What stands for one that came late is not it.
        osg::Node* node() const;
        /// Lets the pager remove it, if nobody looks at it until then.
        void expire() const;
        /// Lets the pager decide, as it does by itself.
        void free() const;
    };

    /// `frame`: that of the update. What has been marked in it or in the one before is looked at.
    explicit TileAges(unsigned int frame);

    void apply(osg::Transform& node) override;
    void apply(osg::LOD& node) override;
    void apply(osg::PagedLOD& node) override;
    void apply(osg::Geode&) override {}
    void apply(osg::Drawable&) override {}

    /// In the order in which they should go: unless all have been culled at the same time, those below others come first.
    std::vector<Child> sorted();

private:
    struct Age
    {
        double seen = -1e300;
        bool ahead = false;
    };

    const unsigned int _frame;
    unsigned int _depth = 0;
    Age _below; ///< of all that has been met below the node that is visited
    std::vector<Child> _children;
};

} // namespace osgGeoFX
