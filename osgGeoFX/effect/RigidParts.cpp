// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/RigidParts.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

void RigidParts::Switch::meet(const osg::StateSet* state)
{
    if (!state || state->getDefineList().empty()) return;
    const osg::StateSet::DefinePair* found = state->getDefinePair(define);
    if (!found || (overridden && !(found->second & osg::StateAttribute::PROTECTED))) return;
    on = (found->second & osg::StateAttribute::ON) != 0;
    overridden = (found->second & osg::StateAttribute::OVERRIDE) != 0;
}

const osg::Vec4Array* RigidParts::inForce(const osg::NodePath& path)
{
    const osg::Drawable* const drawable = path.empty() ? nullptr : path.back()->asDrawable();
    const osg::Vec4Array* const references = drawable ? of(*drawable) : nullptr;
    // Few drawables have any.
    if (!references) return nullptr;
    Switch state;
    const osg::NodePathList above = path.front()->getParentalNodePaths();
    for (const osg::Node* node : above.empty() ? osg::NodePath() : above.front())
    {
        // The thread of a view's camera may be changing its state.
        const bool ofView = node->asCamera() && node->getNumParents() == 0;
        if (node != path.front() && !ofView) state.meet(node->getStateSet());
    }
    for (const osg::Node* node : path)
        state.meet(node->getStateSet());
    return state.on ? references : nullptr;
}

const osg::Vec4Array* RigidParts::arrayOf(const osg::Geometry& geometry)
{
    const osg::Array* references = geometry.getVertexAttribArray(attribute);
    const osg::Array* vertices = geometry.getVertexArray();
    if (!references || references->getType() != osg::Array::Vec4ArrayType || !vertices ||
        references->getNumElements() != vertices->getNumElements())
        return nullptr;
    return static_cast<const osg::Vec4Array*>(references);
}

void RigidParts::finish(osg::Geometry& geometry, const std::vector<osg::Vec3>& references)
{
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
    if (!vertices || vertices->size() != references.size() || references.empty()) return;
    double square = 0.0;
    osg::BoundingBox box;
    for (std::size_t i = 0; i < references.size(); ++i)
    {
        square = std::max(square, (osg::Vec3d((*vertices)[i]) - osg::Vec3d(references[i])).length2());
        box.expandBy(references[i]);
    }
    // Rounded up, for what follows is computed in floats.
    const auto radius = static_cast<float>(std::sqrt(square) * (1.0 + 1e-6) + 1e-3);
    osg::ref_ptr<osg::Vec4Array> array = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    array->reserve(references.size());
    for (const osg::Vec3& reference : references)
        array->push_back(osg::Vec4(reference, radius));
    // A buffer of its own: drivers count how often one is written.
    array->setVertexBufferObject(new osg::VertexBufferObject);
    geometry.setVertexAttribArray(attribute, array);
    const osg::Vec3 around(radius, radius, radius);
    geometry.setInitialBound(osg::BoundingBox(box._min - around, box._max + around));
}

osg::Vec3d RigidParts::place(const DeformationChain& chain, const osg::Vec3d& position,
                             const osg::Vec3d& reference)
{
    osg::Vec3d at = reference, offset = position - reference;
    for (const auto& snapshot : chain.snapshots())
    {
        offset = snapshot->carried(at, offset);
        at = snapshot->deform(at);
    }
    return at + offset;
}

double RigidParts::reach(const osg::Drawable& drawable, const DeformationChain& chain, const Ball& ball,
                         double scale)
{
    double reach = radius(drawable) * scale;
    if (!(reach > 0.0)) return 0.0;
    Ball current = ball;
    for (const auto& snapshot : chain.snapshots())
    {
        reach *= std::max(snapshot->lipschitz(current), 1.0);
        current = snapshot->bound(current);
    }
    return reach;
}

} // namespace osgGeoFX
