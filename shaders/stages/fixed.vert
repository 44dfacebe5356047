#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// OpenGL's fixed vertex stage, for geometry that has no shader of its own: what OpenGL 2.1, Section 2.14, says, with
// the effects in between. scene/FixedFunctionLook.cpp sets the defines from the modes that are in force.
#pragma import_defines(GEOFX_LIGHTS, GEOFX_TWO_SIDED, GEOFX_LOCAL_VIEWER)
#pragma import_defines(GEOFX_COLOR_MATERIAL, GEOFX_SEPARATE_SPECULAR)
#pragma import_defines(GEOFX_NORMALIZE, GEOFX_RESCALE, GEOFX_FOG)
#pragma import_defines(GEOFX_TEXTURE_0, GEOFX_TEXTURE_1, GEOFX_TEXTURE_2, GEOFX_TEXTURE_3)
#pragma import_defines(GEOFX_TEXGEN_0, GEOFX_TEXGEN_1, GEOFX_TEXGEN_2, GEOFX_TEXGEN_3)
#pragma import_defines(GEOFX_MAP)

vec4 geofx_vertex(vec4 eyePosition);
vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal);

#ifdef GEOFX_LIGHTS
struct Material
{
    vec4 emission;
    vec4 ambient;
    vec4 diffuse;
    vec4 specular;
    float shininess;
};

Material coloured(gl_MaterialParameters given)
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

// The light of all lamps on one side of the surface.
void illuminate(vec3 position, vec3 normal, Material material, out vec4 primary, out vec4 secondary)
{
    vec4 sum = material.emission + gl_LightModel.ambient * material.ambient;
    vec4 shine = vec4(0.0);
    for (int i = 0; i < 8; ++i)
    {
        if (((GEOFX_LIGHTS >> i) & 1) == 0) continue;
        vec3 direction = gl_LightSource[i].position.xyz;
        float strength = 1.0;
        if (gl_LightSource[i].position.w != 0.0)
        {
            direction = direction / gl_LightSource[i].position.w - position;
            float distance = length(direction);
            strength = 1.0 / (gl_LightSource[i].constantAttenuation +
                              distance * (gl_LightSource[i].linearAttenuation +
                                          distance * gl_LightSource[i].quadraticAttenuation));
        }
        direction = normalize(direction);
        if (gl_LightSource[i].spotCutoff <= 90.0)
        {
            float spot = dot(-direction, normalize(gl_LightSource[i].spotDirection));
            strength *= spot < gl_LightSource[i].spotCosCutoff ? 0.0 : pow(max(spot, 0.0), gl_LightSource[i].spotExponent);
        }
        float facing = max(dot(normal, direction), 0.0);
        sum += strength * (gl_LightSource[i].ambient * material.ambient +
                           facing * gl_LightSource[i].diffuse * material.diffuse);
        if (facing > 0.0)
        {
#ifdef GEOFX_LOCAL_VIEWER
            vec3 viewer = -normalize(position);
#else
            vec3 viewer = vec3(0.0, 0.0, 1.0);
#endif
            float glance = max(dot(normal, normalize(direction + viewer)), 0.0);
            float lobe = material.shininess > 0.0 ? pow(glance, material.shininess) : 1.0;
            shine += strength * lobe * gl_LightSource[i].specular * material.specular;
        }
    }
#ifdef GEOFX_SEPARATE_SPECULAR
    primary = vec4(clamp(sum.rgb, 0.0, 1.0), clamp(material.diffuse.a, 0.0, 1.0));
    secondary = vec4(clamp(shine.rgb, 0.0, 1.0), 0.0);
#else
    primary = vec4(clamp(sum.rgb + shine.rgb, 0.0, 1.0), clamp(material.diffuse.a, 0.0, 1.0));
    secondary = vec4(0.0);
#endif
}
#endif

// Generated texture coordinates: 1 object linear, 2 eye linear.
vec4 generated(int mode, vec4 given, vec4 eye, vec4 objectS, vec4 objectT, vec4 eyeS, vec4 eyeT)
{
    if (mode == 1) return vec4(dot(gl_Vertex, objectS), dot(gl_Vertex, objectT), given.zw);
    return vec4(dot(eye, eyeS), dot(eye, eyeT), given.zw);
}

#define GEOFX_COORDINATES(unit, given) gl_TexCoord[unit] = gl_TextureMatrix[unit] * (given);
#define GEOFX_GENERATED(unit, mode, given)                                                                       \
    GEOFX_COORDINATES(unit, generated(mode, given, eye, gl_ObjectPlaneS[unit], gl_ObjectPlaneT[unit],           \
                                      gl_EyePlaneS[unit], gl_EyePlaneT[unit]))

void main()
{
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    vec4 deformed = geofx_vertex(eye);
    // What stays where it is goes exactly where OpenGL's own stage would put it.
    gl_Position = deformed == eye ? ftransform() : gl_ProjectionMatrix * deformed;
    gl_ClipVertex = eye;

    gl_FrontColor = gl_Color;
    gl_BackColor = gl_Color;
    gl_FrontSecondaryColor = vec4(0.0);
    gl_BackSecondaryColor = vec4(0.0);
#ifdef GEOFX_LIGHTS
    vec3 normal = gl_NormalMatrix * gl_Normal;
#ifdef GEOFX_RESCALE
    normal *= gl_NormalScale;
#endif
#ifdef GEOFX_NORMALIZE
    normal = normalize(normal);
#endif
    normal = geofx_normal(eye, normal);
    illuminate(eye.xyz, normal, coloured(gl_FrontMaterial), gl_FrontColor, gl_FrontSecondaryColor);
#ifdef GEOFX_TWO_SIDED
    illuminate(eye.xyz, -normal, coloured(gl_BackMaterial), gl_BackColor, gl_BackSecondaryColor);
#endif
#endif

#ifdef GEOFX_TEXGEN_0
    GEOFX_GENERATED(0, GEOFX_TEXGEN_0, gl_MultiTexCoord0)
#elif defined(GEOFX_TEXTURE_0) || defined(GEOFX_MAP)
    GEOFX_COORDINATES(0, gl_MultiTexCoord0)
#endif
#ifdef GEOFX_TEXGEN_1
    GEOFX_GENERATED(1, GEOFX_TEXGEN_1, gl_MultiTexCoord1)
#elif defined(GEOFX_TEXTURE_1)
    GEOFX_COORDINATES(1, gl_MultiTexCoord1)
#endif
#ifdef GEOFX_TEXGEN_2
    GEOFX_GENERATED(2, GEOFX_TEXGEN_2, gl_MultiTexCoord2)
#elif defined(GEOFX_TEXTURE_2)
    GEOFX_COORDINATES(2, gl_MultiTexCoord2)
#endif
#ifdef GEOFX_TEXGEN_3
    GEOFX_GENERATED(3, GEOFX_TEXGEN_3, gl_MultiTexCoord3)
#elif defined(GEOFX_TEXTURE_3)
    GEOFX_COORDINATES(3, gl_MultiTexCoord3)
#endif
#ifdef GEOFX_FOG
    gl_FogFragCoord = abs(deformed.z);
#endif
}
