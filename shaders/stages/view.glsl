// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Effects work in the eye space of a view. Most often that is the camera's own. With GEOFX_IMAGE the camera draws another
// one's view from elsewhere: osgGeoFX/effect/ViewGeometry.h.
#pragma import_defines(GEOFX_IMAGE)
#ifdef GEOFX_IMAGE
uniform mat4 geofx_toView; // from the camera's eye space to the view's; it does not scale
uniform mat4 geofx_toEye;  // and back
uniform mat4 geofx_viewProjection;

vec3 geofx_inView(vec3 position)
{
    return (geofx_toView * vec4(position, 1.0)).xyz;
}

vec3 geofx_inEye(vec3 position)
{
    return (geofx_toEye * vec4(position, 1.0)).xyz;
}

vec3 geofx_directionInView(vec3 direction)
{
    return mat3(geofx_toView) * direction;
}

vec3 geofx_directionInEye(vec3 direction)
{
    return mat3(geofx_toEye) * direction;
}

// Where a position in the camera's eye space is in the view's picture, in clip coordinates.
vec4 geofx_inPicture(vec4 position)
{
    return geofx_viewProjection * vec4(geofx_inView(position.xyz / position.w), 1.0);
}
#else
#define geofx_inView(position) (position)
#define geofx_inEye(position) (position)
#define geofx_directionInView(direction) (direction)
#define geofx_directionInEye(direction) (direction)
#define geofx_inPicture(position) (gl_ProjectionMatrix * (position))
#endif
