// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the painting of a panorama map's ground needs of each vertex. SLOT_ stands for the effect's prefix.
uniform vec4 SLOT_light;  // towards the light, in eye space; the factor by which slopes are lit as steeper
uniform vec4 SLOT_brushX; // from eye space to the brush's picture
uniform vec4 SLOT_brushY;

out vec3 SLOT_place;  // of the map: x of the picture, s and height in metres
// The normal to light with, and the rise over run of the ground. If fragments have normals of their own, it is the
// vertical.
out vec4 SLOT_facing;
out vec4 SLOT_texels; // in the cover's texture and in the brush's

vec3 SLOT_vertical;

void SLOT_locate(vec3 position)
{
    geofx_Panorama view = SLOT_view();
    vec3 place = SLOT_placeOf(position);
    SLOT_place = vec3(place.x * view.across, place.yz);
    SLOT_texels = vec4(gl_MultiTexCoord0.xy, dot(position, SLOT_brushX.xyz) + SLOT_brushX.w,
                       dot(position, SLOT_brushY.xyz) + SLOT_brushY.w);
    SLOT_vertical = normalize(geofx_exaggerationGradient(view.globe, position));
    SLOT_facing = vec4(SLOT_vertical, 0.0);
}

void SLOT_face(vec3 normal)
{
#ifndef GEOFX_FRAGMENT_NORMAL
    float upward = dot(normal, SLOT_vertical);
    float level = length(normal - upward * SLOT_vertical);
    SLOT_facing = vec4(normalize(normal + (1.0 / SLOT_light.w - 1.0) * upward * SLOT_vertical),
                       level / max(abs(upward), 0.02));
#endif
}
