// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// PerspectiveBend in the fragment stage: the context's style (paper, Section 3.3).
uniform vec4 SLOT_look; // saturation, brightness, whether there is a map

vec4 SLOT_restyle(vec4 color, vec4 map, float style)
{
    vec3 rgb = mix(color.rgb, map.rgb, style * SLOT_look.z * map.a);
    float grey = dot(rgb, vec3(0.2126, 0.7152, 0.0722));
    rgb = mix(rgb, (grey + (rgb - grey) * SLOT_look.x) * SLOT_look.y, style);
    return vec4(rgb, color.a);
}
