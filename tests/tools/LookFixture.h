// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Light>
#include <osg/Material>
#include <osg/TexEnv>
#include <osg/Texture2D>
#include <tools/GlFixture.h>

#include <functional>
#include <string>

namespace geofx::test
{

/** Compares the look of geometry without a shader below an EffectScene with OpenGL's fixed functions: a wavy square of
    8 × 8 m around the origin, seen from south and above. There is no light but what a test adds. */
class LookFixture : public GlFixture
{
protected:
    static constexpr int on = osg::StateAttribute::ON;
    static constexpr int off = osg::StateAttribute::OFF;
    static constexpr int overriding = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE;
    static constexpr int keeping = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;

    /// What stands above the group that is either plain or an EffectScene, and that group.
    struct Place
    {
        osg::Group& above;
        osg::Group& scene;
        osg::StateSet& state() const { return *scene.getOrCreateStateSet(); }
    };
    using Build = std::function<void(const Place&)>;

    LookFixture() : GlFixture(120, 100) {}
    void SetUp() override;

    /** A scene below a plain group, and below an EffectScene whose program draws it without moving anything. The same
        pixels must be covered, and no channel be further off than the tolerance, of 255: 1 since two floats that are next
        to each other may be rounded to different bytes. `moves`: whether effects move what is drawn. */
    void compare(const std::string& name, const Build& build, int tolerance = 1, bool moves = true);
    osg::ref_ptr<osg::Image> renderPlain(const Build& build);
    static void expectSame(const osg::Image& actual, const osg::Image& expected, int tolerance,
                           const std::string& name);

    /// The square, with normals, colors and coordinates for four textures.
    static osg::ref_ptr<osg::Geometry> makeWaves();
    /// The same vertices as another primitive.
    static osg::ref_ptr<osg::Geometry> makeWaves(GLenum primitive);
    static osg::ref_ptr<osg::Texture2D> makeTexture(GLenum format, GLint internalFormat = 0);
    static void addTexture(osg::StateSet& state, unsigned int unit, GLenum format, osg::TexEnv::Mode mode,
                           GLint internalFormat = 0);
    static osg::ref_ptr<osg::Light> addLight(const Place& place, int number, const osg::Vec4& position);
    static void addSun(const Place& place);
    static osg::ref_ptr<osg::Material> makeMaterial(float shininess,
                                                    osg::Material::ColorMode mode = osg::Material::OFF);
};

} // namespace geofx::test
