// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The parts of a picture that its layers are made of (osgGeoFX/print/PictureLayers.cpp). A state set above a scene has GEOFX_PART as one
// of these numbers. Without it all is drawn as ever. The mirror in the water stays whole.
#define GEOFX_PART_NOTHING 1 // what stands behind the ground
#define GEOFX_PART_BLACK 2
#define GEOFX_PART_WHITE 3
#define GEOFX_PART_SHARES 4 // red: the share of water; green: of forest, as if there was no water; blue: 1
#define GEOFX_PART_CLASSES 5 // the number of what takes the largest share, over 255
#define GEOFX_PART_FLAT 6 // land without light, without forest and without water
#define GEOFX_PART_LAND 7 // the same in its light
#define GEOFX_PART_WOODS 8 // the same with its forest
