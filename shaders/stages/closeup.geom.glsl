// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// CloseUps in the geometry stage: copies each triangle for each close-up and each anchor that it touches, into the
// layers of one texture array. EffectProgram replaces GEOFX_VARYINGS and GEOFX_COPY by the varyings of the other
// effects.
layout(triangles) in;
layout(triangle_strip, max_vertices = 18) out;

in vec2 SLOT_surface_in[];
in vec3 SLOT_located_in[];
in vec3 SLOT_bent_in[];
out vec2 SLOT_surface;
out vec3 SLOT_place;
flat out int SLOT_target;
GEOFX_VARYINGS
#include "stages/view.glsl"
#include "stages/depth.glsl"

uniform ivec4 SLOT_targets; // up to three items, and how many they are
uniform int SLOT_only;      // if layers are drawn one by one, the one to draw: 0 the close-up's, 1 its anchor's; else -1

void SLOT_emit(int target, vec3 positions[3], vec3 places[3])
{
    int item = target / 2;
    // If layers are drawn one by one, their viewports move the picture.
    vec4 shift = SLOT_only < 0 ? SLOT_item(item, 14) : vec4(0.0);
    for (int i = 0; i < 3; ++i)
    {
        vec3 eye = geofx_inEye(positions[i]);
        gl_Layer = int(target == 2 * item ? shift.z : shift.w);
        gl_Position = gl_ProjectionMatrix * vec4(eye, 1.0);
        GEOFX_PUT_DEPTH(gl_Position);
        gl_Position.xy += shift.xy * gl_Position.w;
        gl_ClipVertex = vec4(geofx_inEye(SLOT_located_in[i]), 1.0); // clip planes cut the ground as it lies
        gl_FrontColor = gl_in[i].gl_FrontColor;
#ifdef GEOFX_COLOR_SUM
        gl_FrontSecondaryColor = gl_in[i].gl_FrontSecondaryColor;
#endif
#ifdef GEOFX_TWO_SIDED
        gl_BackColor = gl_in[i].gl_BackColor;
#endif
#if defined(GEOFX_TEXTURE_0) || defined(GEOFX_MAP)
        gl_TexCoord[0] = gl_in[i].gl_TexCoord[0];
#endif
#ifdef GEOFX_TEXTURE_1
        gl_TexCoord[1] = gl_in[i].gl_TexCoord[1];
#endif
#ifdef GEOFX_TEXTURE_2
        gl_TexCoord[2] = gl_in[i].gl_TexCoord[2];
#endif
#ifdef GEOFX_TEXTURE_3
        gl_TexCoord[3] = gl_in[i].gl_TexCoord[3];
#endif
#ifdef GEOFX_FOG
        gl_FogFragCoord = GEOFX_FOG >= 4 ? gl_in[i].gl_FogFragCoord : abs(eye.z);
#endif
        SLOT_surface = SLOT_surface_in[i];
        SLOT_place = places[i];
        SLOT_target = target;
        GEOFX_COPY(i)
        EmitVertex();
    }
    EndPrimitive();
}

void main()
{
    vec3 positions[3];
    vec3 places[3];
    for (int k = 0; k < SLOT_targets.w; ++k)
    {
        int item = SLOT_targets[k];
        vec2 low = vec2(2.0);
        vec2 high = vec2(-2.0);
        for (int i = 0; i < 3; ++i)
        {
            positions[i] = SLOT_moved(item, 0, SLOT_located_in[i], SLOT_bent_in[i], places[i]);
            low = min(low, places[i].xy);
            high = max(high, places[i].xy);
        }
        if (any(greaterThan(low, vec2(1.0))) || any(lessThan(high, vec2(-1.0)))) continue;
        float least = min(places[0].z, min(places[1].z, places[2].z));
        float most = max(places[0].z, max(places[1].z, places[2].z));
        bool primitives = SLOT_item(item, 9).y > 0.5;
        bool shown = SLOT_item(item, 15).x > 0.5 && SLOT_only != 1;
        if (shown && (!primitives || most > 0.999)) SLOT_emit(2 * item, positions, places);
        if (SLOT_only == 0 || SLOT_item(item, 15).y < 0.5 || least > 0.9999 || most <= 0.0) continue;
        for (int i = 0; i < 3; ++i)
        {
            positions[i] = geofx_raise(SLOT_bent_in[i], geofx_lift(SLOT_liftOf(item), SLOT_located_in[i]), places[i].z);
        }
        SLOT_emit(2 * item + 1, positions, places);
    }
}
