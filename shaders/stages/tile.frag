#version 120
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A tile of a terrain database where there is no kit: part of the database. There is no vertex shader, so OpenGL's fixed
// functions place, clip and light the vertices, by whatever is in force; this lights once more with the normals of the tile's
// texture. Which modes are on a shader cannot see. What is used instead:
// - Lighting: without it the vertices' color arrives, whose alpha is 254/255; with it, the material's alpha. With
//   GL_COLOR_MATERIAL that, too, is the vertices', and what the fixed functions have found is good enough.
// - Lamp 0, osgviewer's: it is taken to be on where no less light has arrived than it gives the vertices. Their normals arrive
//   as generated coordinates, set 6. What other lamps give, and gloss, stays as the fixed functions have it: it has no detail,
//   but it is true. So does all light where lamp 0 is out or has a place.
// - Fog: osg::Fog gives back OpenGL's defaults where there is none.
uniform sampler2D geofx_tileColors;
uniform sampler2D geofx_tileNormals;

vec3 shine(vec3 normal)
{
    float facing = max(dot(normal, normalize(gl_LightSource[0].position.xyz)), 0.0);
    return gl_FrontLightProduct[0].ambient.rgb + facing * gl_FrontLightProduct[0].diffuse.rgb;
}

vec3 light(vec3 normal, vec3 vertexNormal, vec3 fixedLight)
{
    vec3 none = gl_FrontLightModelProduct.sceneColor.rgb;
    vec3 there = shine(vertexNormal);
    vec3 here = shine(normal);
    // Between vertices there may be more, since light ends at 0, and not less.
    vec3 missing = clamp(none + there, 0.0, 1.0) - fixedLight;
    vec3 others = gl_FrontLightProduct[0].specular.rgb + gl_FrontLightProduct[1].diffuse.rgb +
                  gl_FrontLightProduct[2].diffuse.rgb + gl_FrontLightProduct[3].diffuse.rgb +
                  gl_FrontLightProduct[4].diffuse.rgb + gl_FrontLightProduct[5].diffuse.rgb +
                  gl_FrontLightProduct[6].diffuse.rgb + gl_FrontLightProduct[7].diffuse.rgb;
    bool alone = others.r + others.g + others.b == 0.0;
    // OpenGL gives lamp 0 a color in the beginning, and a place behind the eye.
    bool untouched = gl_LightSource[0].diffuse == vec4(1.0) && gl_LightSource[0].position == vec4(0.0, 0.0, 1.0, 0.0);
    bool out0 = max(max(missing.r, missing.g), missing.b) > 0.01 || gl_LightSource[0].position.w != 0.0 ||
                (untouched && !alone);
    return out0 ? fixedLight : clamp((alone ? none : fixedLight - there) + here, 0.0, 1.0);
}

// As in stages/fixed.frag: where a tile is seen from its edge, llvmpipe would visit every texel between neighbours.
vec2 tame(vec2 place)
{
    return all(lessThan(fwidth(place), vec2(4.0))) ? place : clamp(place, 0.0, 1.0);
}

// The distance along the view, from the fragment's own depth: not every driver's fixed functions hand over gl_FogFragCoord.
float away()
{
    mat4 p = gl_ProjectionMatrix;
    return p[2][3] != 0.0 ? abs((1.0 / gl_FragCoord.w - p[3][3]) / p[2][3])
                          : abs((2.0 * gl_FragCoord.z - 1.0 - p[3][2]) / p[2][2]);
}

void main()
{
    vec4 color = gl_Color;
    bool lit = abs(color.a * 255.0 - 254.0) > 0.25;
    vec3 texel = texture2D(geofx_tileNormals, tame((gl_TextureMatrix[2] * gl_TexCoord[0]).xy)).rgb;
    vec3 normal = (255.0 * texel - 128.0) / 127.0;
    // A byte is 0 only in a channel that the texture does not have; the first is where there is no texture.
    if (texel.b < 0.002) normal.z = sqrt(max(1.0 - dot(normal.xy, normal.xy), 0.0));
    vec3 relit = light(normalize(gl_NormalMatrix * normal), gl_TexCoord[6].xyz, color.rgb);
    if (lit && texel.r > 0.002) color.rgb = relit;
    if (!lit) color.a = 1.0;
    color *= texture2D(geofx_tileColors, tame(gl_TexCoord[0].xy));
    bool linear = gl_Fog.start != 0.0 || gl_Fog.end != 1.0;
    if (linear || gl_Fog.density != 1.0 || gl_Fog.color != vec4(0.0))
    {
        float clear = linear ? (gl_Fog.end - away()) * gl_Fog.scale : exp(-gl_Fog.density * away());
        color.rgb = mix(gl_Fog.color.rgb, color.rgb, clamp(clear, 0.0, 1.0));
    }
    gl_FragColor = color;
}
