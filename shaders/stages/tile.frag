#version 120
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A tile of a terrain database where there is no kit: part of the database. There is no vertex shader, so OpenGL's fixed
// functions place, clip and light the vertices, by whatever is in force; this lights once more with the normals of the tile's
// texture. Which modes are on a shader cannot see. What is used instead:
// - Lighting: without it the vertices' colour arrives, whose alpha is 254/255; with it, the material's alpha. With
//   GL_COLOR_MATERIAL that, too, is the vertices', and what the fixed functions have found is good enough.
// - Lamps: those that have any colour, but for those without which the light on the vertices is nearer to what has arrived; the
//   vertices' normals arrive as generated coordinates, set 6. A lamp that has a place needs the fragment's, which nothing
//   tells: where there is one the fixed functions' light stays.
// - Fog: osg::Fog gives back OpenGL's defaults where there is none.
uniform sampler2D geofx_tileColours;
uniform sampler2D geofx_tileNormals;

bool shines(int lamp)
{
    vec3 colours = abs(gl_FrontLightProduct[lamp].ambient.rgb) + abs(gl_FrontLightProduct[lamp].diffuse.rgb) +
                   abs(gl_FrontLightProduct[lamp].specular.rgb);
    return colours.r + colours.g + colours.b > 0.0;
}

vec3 shine(int lamp, vec3 normal)
{
    vec3 towards = normalize(gl_LightSource[lamp].position.xyz);
    float facing = max(dot(normal, towards), 0.0);
    vec3 sum = gl_FrontLightProduct[lamp].ambient.rgb + facing * gl_FrontLightProduct[lamp].diffuse.rgb;
    vec3 gloss = gl_FrontLightProduct[lamp].specular.rgb;
    if (facing > 0.0 && gloss.r + gloss.g + gloss.b > 0.0)
    {
        float glance = max(dot(normal, normalize(towards + vec3(0.0, 0.0, 1.0))), 0.0);
        sum += gloss * (gl_FrontMaterial.shininess > 0.0 ? pow(glance, gl_FrontMaterial.shininess) : 1.0);
    }
    return sum;
}

vec3 light(vec3 normal, vec3 vertexNormal, vec3 fixedLight)
{
    const float noise = 0.06; // what interpolation makes of the light between vertices
    vec3 fine = gl_FrontLightModelProduct.sceneColor.rgb;
    vec3 coarse = fine;
    for (int lamp = 0; lamp < 8; ++lamp)
    {
        if (!shines(lamp)) continue;
        if (gl_LightSource[lamp].position.w != 0.0) return fixedLight;
        fine += shine(lamp, normal);
        coarse += shine(lamp, vertexNormal);
    }
    float off = distance(clamp(coarse, 0.0, 1.0), fixedLight);
    // As long as there is too much light: the lamp without which most is explained is out.
    for (int round = 0; round < 8 && off > noise; ++round)
    {
        float least = off - noise;
        int best = -1;
        for (int lamp = 0; lamp < 8; ++lamp)
        {
            if (!shines(lamp)) continue;
            float without = distance(clamp(coarse - shine(lamp, vertexNormal), 0.0, 1.0), fixedLight);
            if (without >= least) continue;
            least = without;
            best = lamp;
        }
        if (best < 0) break;
        coarse -= shine(best, vertexNormal);
        fine -= shine(best, normal);
        off = least;
    }
    return clamp(fine, 0.0, 1.0);
}

void main()
{
    vec4 colour = gl_Color;
    vec3 texel = texture2D(geofx_tileNormals, (gl_TextureMatrix[2] * gl_TexCoord[0]).xy).rgb;
    // No byte is 0 but that of a channel which the texture does not have: without a texture the first is, too.
    if (abs(colour.a * 255.0 - 254.0) > 0.25 && texel.r > 0.002)
    {
        vec3 normal = (255.0 * texel - 128.0) / 127.0;
        if (texel.b < 0.002) normal.z = sqrt(max(1.0 - dot(normal.xy, normal.xy), 0.0));
        vec3 vertexNormal = gl_TexCoord[6].xyz + vec3(0.0, 0.0, 1e-6);
        colour.rgb = light(normalize(gl_NormalMatrix * normal), normalize(vertexNormal), colour.rgb);
    }
    if (abs(colour.a * 255.0 - 254.0) <= 0.25) colour.a = 1.0;
    colour *= texture2D(geofx_tileColours, gl_TexCoord[0].xy);
    bool linear = gl_Fog.start != 0.0 || gl_Fog.end != 1.0;
    if (linear || gl_Fog.density != 1.0 || gl_Fog.color != vec4(0.0))
    {
        float clear = linear ? (gl_Fog.end - gl_FogFragCoord) * gl_Fog.scale : exp(-gl_Fog.density * gl_FogFragCoord);
        colour.rgb = mix(gl_Fog.color.rgb, colour.rgb, clamp(clear, 0.0, 1.0));
    }
    gl_FragColor = colour;
}
