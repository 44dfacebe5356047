// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/TownGeometry.h>

#include <osg/BufferObject>
#include <osg/PrimitiveSet>

namespace osgGeoFX
{

osg::Array* TownGeometry::withOwnBuffer(osg::Array* array)
{
    array->setVertexBufferObject(new osg::VertexBufferObject);
    return array;
}

osg::ref_ptr<osg::Geometry> TownGeometry::create(const std::vector<osg::Vec3>& places,
                                                 const std::vector<osg::Vec4ub>& colors,
                                                 const std::vector<unsigned int>& triangles)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(withOwnBuffer(new osg::Vec3Array(places.begin(), places.end())));
    const osg::ref_ptr<osg::Vec4ubArray> shades = new osg::Vec4ubArray(colors.begin(), colors.end());
    shades->setBinding(osg::Array::BIND_PER_VERTEX);
    shades->setNormalize(true);
    geometry->setColorArray(withOwnBuffer(shades));
    if (places.size() <= 65536)
        geometry->addPrimitiveSet(
            new osg::DrawElementsUShort(GL_TRIANGLES, triangles.begin(), triangles.end()));
    else
        geometry->addPrimitiveSet(
            new osg::DrawElementsUInt(GL_TRIANGLES, triangles.begin(), triangles.end()));
    return geometry;
}

} // namespace osgGeoFX
