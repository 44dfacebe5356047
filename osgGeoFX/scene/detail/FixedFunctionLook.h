// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Program>
#include <osg/StateSet>
#include <osgUtil/StateGraph>

#include <array>
#include <cstdint>

namespace osgGeoFX
{

/** The fixed functions of OpenGL that are in force for a drawable, so that a shader can do the same.

    Culling finds them in the state sets between the root and the drawable, by OSG's rules of inheritance. */
struct FixedFunctionLook
{
    static constexpr int units = 4;

    bool ownProgram = false; ///< the drawable has a shader of its own; no other member is set
    int lights = -1;         ///< one bit for each of eight lights; −1 without lighting
    bool twoSided = false;
    bool localViewer = false;
    bool colorSum = false; ///< the secondary color is added after the textures
    bool specular = false; ///< the material shines
    bool normalize = false;
    bool rescale = false;
    bool pointSize = false;   ///< points get smaller with the distance
    int colorMaterial = 0;    ///< OSG's color modes, 1 ambient … 5 emission
    int fog = 0;              ///< 1 linear, 2 exp, 3 exp2; plus 4 with the vertices' fog coordinates
    int texture[units] = {};  ///< the code of an environment in stages/fixed.frag; 0 for none
    int texGen[units] = {};   ///< the code of generated coordinates in stages/fixed.vert; 0 for none
    bool normalMap = false;   ///< fragments have normals of their own (TileNormals)
    bool noNormal = false;    ///< the geometry has no normals, and OpenGL any of those drawn before
    bool map = false;         ///< the map's unit has a texture
    bool unsupported = false; ///< something is in force that the shaders do not know

    using Key = std::array<int, 4 + 2 * units>;
    Key key() const;
    /// A state set with the program and with the defines of stages/fixed.vert and .frag.
    osg::ref_ptr<osg::StateSet> createStateSet(osg::Program* program) const;
};

/// The state between the root and a drawable, as far as the look depends on it, by OSG's rules of inheritance.
class FixedFunctionState
{
public:
    void meet(const osg::StateSet& set);
    /// Takes in the state sets from the root down to a node of the state graph.
    void meetAll(const osgUtil::StateGraph& state);
    FixedFunctionLook look(int mapUnit) const;
    /// What the vertex stage does for a program that has a fragment stage alone: everything that OpenGL's own would do.
    FixedFunctionLook vertexLook() const;
    /// The program in force; null for none.
    const osg::StateAttribute* program() const;

private:
    enum ModeBit : unsigned int;
    enum Attribute : unsigned int;
    static constexpr unsigned int attributes = 17;

    void meetLights(FixedFunctionLook& look) const;
    void meetMode(GLenum mode, unsigned int flags);
    void meetTextureMode(unsigned int unit, GLenum mode, unsigned int flags);
    void setMode(unsigned int bit, unsigned int flags);
    void setAttribute(unsigned int index, const osg::StateAttribute* attribute, unsigned int flags);
    bool on(unsigned int bit) const { return (_on >> bit & 1u) != 0; }
    int environment(unsigned int unit, bool& unsupported) const;
    int texGen(unsigned int unit) const;

    // Every drawable copies this object, so it is small.
    std::uint64_t _on = 0, _onOverridden = 0; ///< one bit for each mode
    std::array<const osg::StateAttribute*, attributes> _attributes{};
    std::uint32_t _attributesOverridden = 0;
    bool _beyond = false; ///< a unit that the shaders do not have has a texture
};

} // namespace osgGeoFX
