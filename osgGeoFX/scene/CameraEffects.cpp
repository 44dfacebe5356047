// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/CameraEffects.h>

#include <osgGeoFX/effect/TextureUnits.h>

#include <osg/Notify>
#include <osg/UserDataContainer>

#include <algorithm>
#include <cstring>
#include <string>

namespace osgGeoFX
{

CameraEffects::CameraEffects(const CameraEffects& other, const osg::CopyOp& copy)
    : osg::Object(other, copy), _role(other._role), _depthConvention(other._depthConvention),
      _replacements(other._replacements)
{
}

CameraEffects::~CameraEffects() = default;

CameraEffects& CameraEffects::of(osg::Camera& camera)
{
    if (const CameraEffects* known = find(camera)) return const_cast<CameraEffects&>(*known);
    const osg::ref_ptr<CameraEffects> made = new CameraEffects;
    camera.getOrCreateUserDataContainer()->addUserObject(made);
    return *made;
}

const CameraEffects* CameraEffects::find(const osg::Camera& camera)
{
    const osg::UserDataContainer* data = camera.getUserDataContainer();
    for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
    {
        if (const auto* found = dynamic_cast<const CameraEffects*>(data->getUserObject(i))) return found;
    }
    return nullptr;
}

bool CameraEffects::setDepthConvention(const DepthConvention& convention)
{
    const std::string fault = convention.fault();
    if (!fault.empty())
    {
        OSG_WARN << "osgGeoFX: CameraEffects::setDepthConvention: " << fault
                 << " The former convention stays." << std::endl;
        return false;
    }
    _depthConvention = convention;
    return true;
}

void CameraEffects::setEnabled(const Effect& effect, bool on)
{
    _replacements.erase(&effect);
    if (on) return;
    // A copy that is off: it needs what the effect needs, and draws nothing.
    const osg::ref_ptr<Effect> off = osg::clone(&effect, osg::CopyOp::SHALLOW_COPY);
    off->setEnabled(false);
    _replacements.emplace(&effect, off);
}

bool CameraEffects::mayReplace(const Effect& effect, const Effect& replacement)
{
    if (&effect == &replacement) return true;
    if (std::strcmp(effect.className(), replacement.className()) != 0) return false;
    const TextureUnits units = TextureUnits::of({const_cast<Effect*>(&effect)}),
                       others = TextureUnits::of({const_cast<Effect*>(&replacement)});
    return units.ofEffects == others.ofEffects && units.ofBlocks == others.ofBlocks;
}

const Effect* CameraEffects::find(const std::function<bool(const Effect&)>& condition) const
{
    const auto found = std::find_if(_replacements.begin(), _replacements.end(),
                                    [&](const auto& each) { return condition(*each.first); });
    return found == _replacements.end() ? nullptr : found->first.get();
}

bool CameraEffects::setReplacement(const Effect& effect, Effect* replacement)
{
    const osg::ref_ptr<Effect> other = replacement; // it may be no one else's
    if (other && !mayReplace(effect, *other))
    {
        const std::string sentence =
            "a " + std::string(other->className()) + " cannot be drawn in the place of a " +
            effect.className() +
            ", since it needs other shaders or texture units; nothing changes. Use an effect of the same "
            "class "
            "with the same texture units, or add it to the scene and switch it by CameraEffects::setEnabled.";
        if (_refused.insert(sentence).second)
            OSG_WARN << "osgGeoFX: CameraEffects::setReplacement: " << sentence << std::endl;
        return false;
    }
    _replacements.erase(&effect);
    if (other) _replacements.emplace(&effect, other);
    return true;
}

Effect* CameraEffects::effectFor(Effect& effect) const
{
    const auto found = _replacements.find(&effect);
    return found == _replacements.end() ? &effect : found->second.get();
}

} // namespace osgGeoFX
