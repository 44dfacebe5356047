// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Texture2DArray>

namespace osgGeoFX
{

/** Makes a texture array's storage and fills it with all of its images at once.

    OSG by itself makes storage that cannot change, and gives it to the next array of the same size and format, where it fails
    (osg#935). And it leaves layers empty that it has loaded into a former storage. */
class ArrayStorage final : public osg::Texture2DArray::SubloadCallback
{
public:
    /// Of what is loaded, if anything.
    ArrayStorage(GLenum format, GLenum type) : _format(format), _type(type) {}

    void load(const osg::Texture2DArray& texture, osg::State& state) const override;
    void subload(const osg::Texture2DArray&, osg::State&) const override {}

protected:
    ~ArrayStorage() override;

private:
    const GLenum _format, _type;
};

} // namespace osgGeoFX
