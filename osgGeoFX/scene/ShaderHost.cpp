// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/ShaderHost.h>

namespace osgGeoFX
{

ShaderHost::~ShaderHost() = default;

void ShaderHost::use(const ShaderTexts&) {}

osg::ref_ptr<osg::StateSet> ShaderHost::addition(const ShaderTexts&)
{
    return nullptr;
}

} // namespace osgGeoFX
