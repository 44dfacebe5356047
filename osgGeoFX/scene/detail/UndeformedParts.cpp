// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/UndeformedParts.h>

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/NodeVisitor>
#include <osg/StateSet>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

/// Nothing tells of a change of state. It is noticed after so many frames.
constexpr unsigned int patience = 30;

class Finder : public osg::NodeVisitor
{
public:
    explicit Finder(OwnPrograms& programs)
        : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN), _programs(programs)
    {
        setNodeMaskOverride(~0u);
    }

    void apply(osg::Node& node) override
    {
        const osg::StateSet* state = node.getStateSet();
        DeformationSwitch own;
        own.meet(state);
        found = found || !own.on || _programs.isStranger(own.program);
        if (!found) traverse(node);
    }

    bool found = false;

private:
    OwnPrograms& _programs;
};

} // namespace

bool UndeformedParts::search(const osg::Node& node, OwnPrograms& programs)
{
    Finder finder(programs);
    const_cast<osg::Node&>(node).accept(finder);
    return finder.found;
}

bool UndeformedParts::below(const osg::Node& node, OwnPrograms& programs, unsigned int frame)
{
    Known& known = _known[&node];
    if (known.node.valid() && frame - known.frame < patience) return known.parts;
    known.node = &node;
    known.frame = frame;
    known.parts = search(node, programs);
    const bool parts = known.parts;
    if (_known.size() > _most)
    {
        for (auto entry = _known.begin(); entry != _known.end();)
            entry = entry->second.node.valid() ? std::next(entry) : _known.erase(entry);
        _most = 2 * _known.size() + 64;
    }
    return parts;
}

} // namespace osgGeoFX
