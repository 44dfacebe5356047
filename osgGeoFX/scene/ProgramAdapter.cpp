// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/ProgramAdapter.h>

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <osg/Node>
#include <osg/Program>

namespace osgGeoFX
{

ProgramAdapter::ProgramAdapter() : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN)
{
    setNodeMaskOverride(~0u);
}

void ProgramAdapter::apply(osg::Node& node)
{
    osg::StateSet* state = node.getStateSet();
    osg::StateAttribute* attribute = state ? state->getAttribute(osg::StateAttribute::PROGRAM) : nullptr;
    auto* program = dynamic_cast<osg::Program*>(attribute);
    if (program && OwnPrograms::isOwn(program))
    {
        EffectScene::adapt(*program);
        ++_met;
    }
    traverse(node);
}

void TileProgramAdapter::tileRead(osg::Node& tile)
{
    ProgramAdapter adapter;
    tile.accept(adapter);
}

TileProgramAdapter::~TileProgramAdapter() = default;

} // namespace osgGeoFX
