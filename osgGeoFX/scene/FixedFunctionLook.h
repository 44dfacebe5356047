// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Program>
#include <osg/StateSet>
#include <osgUtil/StateGraph>

#include <array>

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
    bool colorSum = false; ///< the secondary colour is added after the textures
    bool specular = false; ///< the material shines
    bool normalize = false;
    bool rescale = false;
    bool pointSize = false;   ///< points get smaller with the distance
    int colorMaterial = 0;    ///< OSG's colour modes, 1 ambient … 5 emission
    int fog = 0;              ///< 1 linear, 2 exp, 3 exp2; 4 more with the vertices' fog coordinates
    int texture[units] = {};  ///< the code of an environment, as stages/fixed.frag has it; 0 for none
    int texGen[units] = {};   ///< the code of generated coordinates, as stages/fixed.vert has it; 0 for none
    bool map = false;         ///< there is a texture on the map's unit
    bool unsupported = false; ///< something is in force that the shaders do not know

    /// `state` is the innermost state set's node, `drawable` a state set below it or null.
    static FixedFunctionLook find(const osgUtil::StateGraph& state, const osg::StateSet* drawable,
                                  int mapUnit);

    using Key = std::array<int, 4 + 2 * units>;
    Key key() const;
    /// The defines of stages/fixed.vert and .frag, with the program.
    osg::ref_ptr<osg::StateSet> createStateSet(osg::Program* program) const;
};

} // namespace osgGeoFX
