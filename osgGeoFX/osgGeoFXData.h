// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// All that the library osgGeoFXData offers: GDAL's rasters as what effects take, and the building of databases.
#pragma once

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/CoordinateText.h>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/geodata/KmlOverlays.h>
#include <osgGeoFX/geodata/LandCoverTable.h>
#include <osgGeoFX/geodata/LineVectors.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/MaterialLegend.h>
#include <osgGeoFX/geodata/NameVectors.h>
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/geodata/PalettePoints.h>
#include <osgGeoFX/geodata/PictureRaster.h>
#include <osgGeoFX/geodata/RouteVectors.h>
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/geodata/SldColors.h>
#include <osgGeoFX/geodata/StrokeVectors.h>
#include <osgGeoFX/geodata/SurfaceRaster.h>
#include <osgGeoFX/geodata/TiledRaster.h>
#include <osgGeoFX/geodata/TiledVectors.h>

#include <osgGeoFX/terrain/BuilderCode.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/terrain/DistributedBuild.h>
#include <osgGeoFX/terrain/ProgressLine.h>
#include <osgGeoFX/terrain/ThinnedRaster.h>

#include <osgGeoFX/town/TownBuilder.h>
