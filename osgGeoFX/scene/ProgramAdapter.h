// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/NodeVisitor>
#include <osg/StateSet>

namespace osgGeoFX
{

/** Adapts all programs of a subgraph: calls EffectScene::adapt() for those in the state sets of nodes and drawables.

    @code
    osgGeoFX::ProgramAdapter adapter;
    terrain->accept(adapter);
    @endcode

    It visits all children, whatever their masks and levels of detail, and changes nothing in the graph. Programs that
    come later need another visit; for the tiles of a pager see TileProgramAdapter. Labels of osgText have programs, too.
    They keep their shape if they stand below a RigidReference.

    Threads: a thread may visit what no other one changes at the same time; other threads may draw it.

    @ingroup scene */
class OSGGEOFX_EXPORT ProgramAdapter : public osg::NodeVisitor
{
public:
    ProgramAdapter();
    META_NodeVisitor(osgGeoFX, ProgramAdapter);

    void apply(osg::Node& node) override;

    /// How many programs it has met so far, each once for each state set that has it.
    unsigned int met() const { return _met; }

private:
    unsigned int _met = 0;
};

/** Adapts the programs of tiles on the thread of the pager that reads them, before anything draws them.

    @code
    osg::ref_ptr<osgGeoFX::TileProgramAdapter> adapter = new osgGeoFX::TileProgramAdapter; // to be kept
    osgGeoFX::TileGuard::install(terrain)->addListener(adapter);
    @endcode

    @ingroup scene */
class OSGGEOFX_EXPORT TileProgramAdapter : public TileListener
{
public:
    TileProgramAdapter() = default;
    void tileRead(osg::Node& tile) override;

protected:
    ~TileProgramAdapter() override;
};

} // namespace osgGeoFX
