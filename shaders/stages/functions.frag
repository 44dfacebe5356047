#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The effects of a scene in the fragment stage. Declare and call this in a fragment shader of your own:
//
//     vec4 geofx_fragment(vec4 colour, vec4 map);    // `map`: what the context shows instead, or vec4(0.0)
//
// EffectScene puts the code of its effects in the place of the words in capitals.
#pragma import_defines(GEOFX_DEFORMATION)
GEOFX_IMPORTED_EFFECTS
in float geofx_styleBlend;
GEOFX_EFFECT_FUNCTIONS
vec4 geofx_fragment(vec4 colour, vec4 map)
{
    vec4 result = colour;
GEOFX_COLOUR_CALLS
GEOFX_FINISH_CALLS
    return result;
}
