// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// GroundDetail in the vertex stage: the undeformed place, which detail goes by. SLOT_ stands for the effect's prefix.
#pragma import_defines(GEOFX_TEXTURE_0)
uniform mat4 SLOT_toFrame; // from eye space to a frame on the ground below the eye: x east, y north, z up, metres

out vec3 SLOT_position;
out vec3 SLOT_ground; // the place in the color's texture, and the rise over run

void SLOT_locate(vec3 eyePosition)
{
    SLOT_position = (SLOT_toFrame * vec4(eyePosition, 1.0)).xyz;
#if defined(GEOFX_TEXTURE_0) && !defined(GEOFX_CORE)
    SLOT_ground = vec3((gl_TextureMatrix[0] * gl_MultiTexCoord0).xy, 0.0);
#else
    SLOT_ground = vec3(gl_MultiTexCoord0.xy, 0.0);
#endif
}

void SLOT_face(vec3 normal)
{
    vec3 local = mat3(SLOT_toFrame) * normal;
    SLOT_ground.z = length(local.xy) / max(abs(local.z), 0.02);
}
