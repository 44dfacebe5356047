// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Texture2DArray>

namespace osgGeoFX
{

/** Makes the storage of a texture array and loads all of its images at once.

    OSG's own storage has a fixed size. OSG gives it to the next array of the same size and format, and fails there
    (osg#935). OSG also leaves layers empty that it loaded into a former storage. */
class ArrayStorage final : public osg::Texture2DArray::SubloadCallback
{
public:
    /// The format and the type of the images, if there are any.
    ArrayStorage(GLenum format, GLenum type) : _format(format), _type(type) {}

    void load(const osg::Texture2DArray& texture, osg::State& state) const override;
    void subload(const osg::Texture2DArray&, osg::State&) const override {}

protected:
    ~ArrayStorage() override;

private:
    const GLenum _format, _type;
};

} // namespace osgGeoFX
