// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Brush strokes of PanoramaMap in the geometry stage: a rectangle on the screen for each point. Trees and houses
// stand on the point. Cliffs, roads and rivers have it in their middle. EffectProgram replaces GEOFX_VARYINGS and
// GEOFX_COPY by the varyings of the other effects.
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

in vec3 SLOT_lightTone_in[];
in vec3 SLOT_darkTone_in[];
in vec4 SLOT_stamp_in[];
in vec2 SLOT_traits_in[];
in vec3 SLOT_ground_in[];
flat out vec3 SLOT_lightTone;
flat out vec3 SLOT_darkTone;
flat out vec4 SLOT_stamp;
flat out vec2 SLOT_traits;
out vec2 SLOT_point; // -1 to 1 over the stroke
GEOFX_VARYINGS

uniform vec4 SLOT_viewport; // width and height in pixels, and one over each

void main()
{
    const int i = 0; // the number of the one point, for GEOFX_COPY
    vec4 brush = SLOT_stamp_in[i];
    vec4 foot = gl_in[i].gl_Position;
    // A smaller stroke would not be seen, and one behind the eye must not be.
    if (brush.y < 0.2 || foot.w <= 0.0) return;
    // Room for the edge's softness.
    vec2 room = vec2(1.0) + 1.0 / max(brush.xy, vec2(0.5));
    vec2 up = brush.zw * brush.y;
    vec2 across = vec2(brush.w, -brush.z) * brush.x;
    vec2 middle = SLOT_traits_in[i].x == 1.0 || (SLOT_traits_in[i].x > 2.5 && SLOT_traits_in[i].x < 4.5) ? vec2(0.0) : 0.85 * up;
    for (int corner = 0; corner < 4; ++corner)
    {
        vec2 point = room * vec2((corner & 1) == 0 ? -1.0 : 1.0, (corner & 2) == 0 ? -1.0 : 1.0);
        vec2 pixels = middle + point.x * across + point.y * up;
        gl_Position = foot + vec4(2.0 * pixels * SLOT_viewport.zw * foot.w, 0.0, 0.0);
        gl_ClipVertex = vec4(SLOT_ground_in[i], 1.0); // clip planes cut the ground as it lies
        SLOT_point = point;
        SLOT_lightTone = SLOT_lightTone_in[i];
        SLOT_darkTone = SLOT_darkTone_in[i];
        SLOT_stamp = brush;
        SLOT_traits = SLOT_traits_in[i];
        GEOFX_COPY(i)
        EmitVertex();
    }
    EndPrimitive();
}
