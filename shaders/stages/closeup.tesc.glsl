// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// CloseUps in the tessellation control stage: as many vertices as masks and magnified close-ups need. The number of
// an edge follows from the edge alone, so that its two triangles agree.
layout(vertices = 3) out;

in vec2 SLOT_surface_vertex[];
in vec3 SLOT_located_vertex[];
in vec3 SLOT_bent_vertex[];
in vec3 SLOT_normal_vertex[];
out vec2 SLOT_surface_control[];
out vec3 SLOT_located_control[];
out vec3 SLOT_bent_control[];
out vec3 SLOT_normal_control[];
GEOFX_VARYINGS

uniform ivec4 SLOT_targets; // up to three items, and how many they are
// Most parts of an edge; texels of a mask in one part; pixels in one part; pixels of a metre at a metre's distance, or,
// if less than 0, at any distance.
uniform vec4 SLOT_fineness;

float SLOT_parts(vec3 a, vec3 b)
{
    float parts = 1.0;
    for (int k = 0; k < SLOT_targets.w; ++k)
    {
        int item = SLOT_targets[k];
        vec2 from = SLOT_placeOf(item, a).xy;
        vec2 to = SLOT_placeOf(item, b).xy;
        if (any(greaterThan(min(from, to), vec2(1.0))) || any(lessThan(max(from, to), vec2(-1.0)))) continue;
        float texels = length(to - from) * 0.5 * SLOT_item(item, 11).z;
        // An edge across the mask's change is divided. If the border is farther away than the edge is long, there is
        // no change.
        vec2 ends = vec2(SLOT_maskAt(item, from).x, SLOT_maskAt(item, to).x);
        float border = abs(SLOT_maskAt(item, 0.5 * (from + to)).y);
        bool crossed = SLOT_item(item, 15).z > 0.5 && (ends.x != ends.y || border < length(to - from));
        if (crossed) parts = max(parts, texels / SLOT_fineness.y);
        // A close-up that is larger than its triangles were made for.
        if (SLOT_item(item, 15).w > 0.0)
        {
            vec3 first = geofx_lift(SLOT_liftOf(item), a);
            vec3 last = geofx_lift(SLOT_liftOf(item), b);
            float distance = SLOT_fineness.w < 0.0 ? 1.0 : max(-0.5 * (first.z + last.z), 1e-3);
            float pixels = length(last - first) * abs(SLOT_fineness.w) / distance;
            parts = max(parts, pixels / SLOT_fineness.z);
        }
    }
    return clamp(parts, 1.0, SLOT_fineness.x);
}

void main()
{
    SLOT_surface_control[gl_InvocationID] = SLOT_surface_vertex[gl_InvocationID];
    SLOT_located_control[gl_InvocationID] = SLOT_located_vertex[gl_InvocationID];
    SLOT_bent_control[gl_InvocationID] = SLOT_bent_vertex[gl_InvocationID];
    SLOT_normal_control[gl_InvocationID] = SLOT_normal_vertex[gl_InvocationID];
    gl_out[gl_InvocationID].gl_FrontColor = gl_in[gl_InvocationID].gl_FrontColor;
#ifdef GEOFX_COLOR_SUM
    gl_out[gl_InvocationID].gl_FrontSecondaryColor = gl_in[gl_InvocationID].gl_FrontSecondaryColor;
#endif
#ifdef GEOFX_TWO_SIDED
    gl_out[gl_InvocationID].gl_BackColor = gl_in[gl_InvocationID].gl_BackColor;
#endif
#if defined(GEOFX_TEXTURE_0) || defined(GEOFX_MAP)
    gl_out[gl_InvocationID].gl_TexCoord[0] = gl_in[gl_InvocationID].gl_TexCoord[0];
#endif
#ifdef GEOFX_TEXTURE_1
    gl_out[gl_InvocationID].gl_TexCoord[1] = gl_in[gl_InvocationID].gl_TexCoord[1];
#endif
#ifdef GEOFX_TEXTURE_2
    gl_out[gl_InvocationID].gl_TexCoord[2] = gl_in[gl_InvocationID].gl_TexCoord[2];
#endif
#ifdef GEOFX_TEXTURE_3
    gl_out[gl_InvocationID].gl_TexCoord[3] = gl_in[gl_InvocationID].gl_TexCoord[3];
#endif
#ifdef GEOFX_FOG
    gl_out[gl_InvocationID].gl_FogFragCoord = gl_in[gl_InvocationID].gl_FogFragCoord;
#endif
    GEOFX_COPY(gl_InvocationID)
    if (gl_InvocationID != 0) return;
    gl_TessLevelOuter[0] = SLOT_parts(SLOT_located_vertex[1], SLOT_located_vertex[2]);
    gl_TessLevelOuter[1] = SLOT_parts(SLOT_located_vertex[2], SLOT_located_vertex[0]);
    gl_TessLevelOuter[2] = SLOT_parts(SLOT_located_vertex[0], SLOT_located_vertex[1]);
    gl_TessLevelInner[0] = max(gl_TessLevelOuter[0], max(gl_TessLevelOuter[1], gl_TessLevelOuter[2]));
}
