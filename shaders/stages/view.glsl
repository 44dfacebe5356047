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

// Not functions: a program may have this text in several shaders of one stage.
#define geofx_inView(position) ((geofx_toView * vec4(position, 1.0)).xyz)
#define geofx_inEye(position) ((geofx_toEye * vec4(position, 1.0)).xyz)
#define geofx_directionInView(direction) (mat3(geofx_toView) * (direction))
#define geofx_directionInEye(direction) (mat3(geofx_toEye) * (direction))
// Where a position in the camera's eye space is in the view's picture, in clip coordinates.
#define geofx_inPicture(position) (geofx_viewProjection * vec4(geofx_inView((position).xyz / (position).w), 1.0))
#else
#define geofx_inView(position) (position)
#define geofx_inEye(position) (position)
#define geofx_directionInView(direction) (direction)
#define geofx_directionInEye(direction) (direction)
#define geofx_inPicture(position) (gl_ProjectionMatrix * (position))
#endif
