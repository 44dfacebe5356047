// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The lighting of OpenGL's fixed functions, after OpenGL 2.1, Section 2.14.1. It is for vertices, or, if a texture
// has the normals, for fragments.
#pragma import_defines(GEOFX_SPECULAR)
#pragma import_defines(GEOFX_LIGHTS, GEOFX_LOCAL_VIEWER)
#pragma import_defines(GEOFX_COLOR_MATERIAL, GEOFX_COLOR_SUM)

#ifdef GEOFX_LIGHTS
float sunShare = 1.0; // of light 0, that reaches the place

struct Material
{
    vec4 emission;
    vec4 ambient;
    vec4 diffuse;
    vec4 specular;
    float shininess;
};

Material colored(gl_MaterialParameters given)
{
    Material material = Material(given.emission, given.ambient, given.diffuse, given.specular, given.shininess);
#ifdef GEOFX_COLOR_MATERIAL
    if (GEOFX_COLOR_MATERIAL == 1 || GEOFX_COLOR_MATERIAL == 3) material.ambient = gl_Color;
    if (GEOFX_COLOR_MATERIAL == 2 || GEOFX_COLOR_MATERIAL == 3) material.diffuse = gl_Color;
    if (GEOFX_COLOR_MATERIAL == 4) material.specular = gl_Color;
    if (GEOFX_COLOR_MATERIAL == 5) material.emission = gl_Color;
#endif
    return material;
}

// Adds the light of one lamp. `lamp` is a constant in each call, so that no driver makes a loop of it.
void shine(int lamp, vec3 position, vec3 normal, Material material, inout vec4 sum, inout vec4 glitter)
{
    vec3 direction = gl_LightSource[lamp].position.xyz;
    float strength = 1.0;
    if (gl_LightSource[lamp].position.w != 0.0)
    {
        direction = direction / gl_LightSource[lamp].position.w - position;
        float distance = length(direction);
        strength = 1.0 / (gl_LightSource[lamp].constantAttenuation +
                          distance * (gl_LightSource[lamp].linearAttenuation +
                                      distance * gl_LightSource[lamp].quadraticAttenuation));
    }
    direction = normalize(direction);
    if (gl_LightSource[lamp].spotCutoff <= 90.0)
    {
        float spot = dot(-direction, normalize(gl_LightSource[lamp].spotDirection));
        strength *= spot < gl_LightSource[lamp].spotCosCutoff ? 0.0 : pow(max(spot, 0.0), gl_LightSource[lamp].spotExponent);
    }
    float facing = max(dot(normal, direction), 0.0);
    float reaching = lamp == 0 ? sunShare : 1.0;
    sum += strength * (gl_LightSource[lamp].ambient * material.ambient +
                       reaching * facing * gl_LightSource[lamp].diffuse * material.diffuse);
#ifdef GEOFX_SPECULAR
    if (facing > 0.0)
    {
#ifdef GEOFX_LOCAL_VIEWER
        vec3 viewer = -normalize(position);
#else
        vec3 viewer = vec3(0.0, 0.0, 1.0);
#endif
        float glance = max(dot(normal, normalize(direction + viewer)), 0.0);
        float lobe = material.shininess > 0.0 ? pow(glance, material.shininess) : 1.0;
        glitter += reaching * strength * lobe * gl_LightSource[lamp].specular * material.specular;
    }
#endif
}

// The light of all lamps on one side of the surface.
void illuminate(vec3 position, vec3 normal, Material material, out vec4 primary, out vec4 secondary)
{
    vec4 sum = material.emission + gl_LightModel.ambient * material.ambient;
    vec4 glitter = vec4(0.0);
    if ((GEOFX_LIGHTS & 1) != 0) shine(0, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 2) != 0) shine(1, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 4) != 0) shine(2, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 8) != 0) shine(3, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 16) != 0) shine(4, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 32) != 0) shine(5, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 64) != 0) shine(6, position, normal, material, sum, glitter);
    if ((GEOFX_LIGHTS & 128) != 0) shine(7, position, normal, material, sum, glitter);
#ifdef GEOFX_COLOR_SUM
    primary = vec4(clamp(sum.rgb, 0.0, 1.0), clamp(material.diffuse.a, 0.0, 1.0));
    secondary = vec4(clamp(glitter.rgb, 0.0, 1.0), 0.0);
#else
    primary = vec4(clamp(sum.rgb + glitter.rgb, 0.0, 1.0), clamp(material.diffuse.a, 0.0, 1.0));
    secondary = vec4(0.0);
#endif
}
#endif
