// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// All that the library osgGeoFXMaps offers: the names and lines of maps, pictures of any size, and web pages.
#pragma once

#include <osgGeoFX/labels/FinestGround.h>
#include <osgGeoFX/labels/LabelLayout.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/labels/LabelText.h>
#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/labels/MapName.h>
#include <osgGeoFX/labels/NameFile.h>
#include <osgGeoFX/labels/NamePlacement.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/labels/Prominence.h>

#include <osgGeoFX/lines/LineFile.h>
#include <osgGeoFX/lines/LinePicture.h>
#include <osgGeoFX/lines/LinePlacement.h>
#include <osgGeoFX/lines/LineStyle.h>
#include <osgGeoFX/lines/MapLine.h>
#include <osgGeoFX/lines/MapLines.h>

#include <osgGeoFX/map/MapContents.h>
#include <osgGeoFX/map/MapKeys.h>
#include <osgGeoFX/map/MapReader.h>
#include <osgGeoFX/map/MapStyles.h>
#include <osgGeoFX/map/OverlayFile.h>
#include <osgGeoFX/map/RouteFile.h>
#include <osgGeoFX/map/SceneOverlays.h>
#include <osgGeoFX/map/SceneRoutes.h>
#include <osgGeoFX/map/SceneSequences.h>
#include <osgGeoFX/map/SequenceFile.h>
#include <osgGeoFX/map/SourceFiles.h>

#include <osgGeoFX/print/PictureLayers.h>
#include <osgGeoFX/print/PictureMesh.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <osgGeoFX/print/PictureVectors.h>
#include <osgGeoFX/print/PlacePicture.h>

#include <osgGeoFX/web/WebNames.h>
#include <osgGeoFX/web/WebPage.h>
