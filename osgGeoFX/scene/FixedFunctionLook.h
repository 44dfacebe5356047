// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Program>
#include <osg/StateSet>
#include <osgUtil/StateGraph>

#include <map>
#include <string>
#include <tuple>

namespace osgGeoFX
{

/** Which of OpenGL's fixed functions are in force for a drawable, so that a shader can do the same.

    Found while culling, from the state sets between the root and the drawable, by OSG's rules of inheritance. */
struct FixedFunctionLook
{
    static constexpr int units = 4;

    bool ownProgram = false; ///< the drawable has a shader of its own: nothing else is set
    int lights = -1;         ///< a bit for each of eight; −1 without lighting
    bool twoSided = false;
    bool localViewer = false;
    bool separateSpecular = false;
    bool normalize = false;
    bool rescale = false;
    int colorMaterial = 0; ///< OSG's colour modes, 1 ambient … 5 emission
    int fog = 0;           ///< 1 linear, 2 exp, 3 exp2
    int texture[units] = {};
    int texGen[units] = {};
    bool map = false;         ///< there is a texture on the map's unit
    bool unsupported = false; ///< something is in force that the shaders do not know

    /// `state` is the innermost state set's node, `drawable` a state set below it or null.
    static FixedFunctionLook find(const osgUtil::StateGraph& state, const osg::StateSet* drawable,
                                  int mapUnit);

    using Key = std::tuple<int, int, int, int, int, int, int>;
    Key key() const;
    /// The defines of stages/fixed.vert and .frag, with the program.
    osg::ref_ptr<osg::StateSet> createStateSet(osg::Program* program) const;
};

} // namespace osgGeoFX
