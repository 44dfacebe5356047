// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/Tessellation.h>

namespace osgGeoFX
{

PatchGeometry::PatchGeometry(osg::Geometry& original)
    : osg::Geometry(original, osg::CopyOp::SHALLOW_COPY), _original(&original)
{
    // The arrays belong to another geometry, which may be drawing them. Their buffers stay as they are.
    setUseDisplayList(false);
    removePrimitiveSet(0, getNumPrimitiveSets());
    // Whoever draws it takes the original's, which may change.
    setStateSet(nullptr);
}

PatchGeometry::~PatchGeometry() = default;

osg::Drawable& PatchGeometry::originalOf(osg::Drawable& drawable)
{
    const auto* patches = dynamic_cast<const PatchGeometry*>(&drawable);
    osg::ref_ptr<osg::Geometry> original;
    // What is drawn lives, and its owner keeps it.
    return patches && patches->_original.lock(original) ? *original : drawable;
}

} // namespace osgGeoFX
