// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// All that the library osgGeoFX offers. osgGeoFX/Start.md tells what is for what; osgGeoFX/osgGeoFXData.h is for who builds
// databases.
#pragma once

#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/paging/FreedMemory.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/MemoryBudget.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/paging/PluginFolder.h>
#include <osgGeoFX/paging/ReadingFile.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/paging/TilePosts.h>

#include <osgGeoFX/batch/FolderLock.h>
#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/batch/OwnFolder.h>
#include <osgGeoFX/batch/PathText.h>
#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/batch/WorkError.h>
#include <osgGeoFX/batch/WorkStage.h>
#include <osgGeoFX/batch/WorkTimes.h>

#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/DrawableCompanion.h>
#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/effect/NormalTurner.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PassFilter.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/effect/Property.h>
#include <osgGeoFX/effect/PropertyHolder.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osgGeoFX/raster/ColorRampFile.h>
#include <osgGeoFX/raster/ColorTable.h>
#include <osgGeoFX/raster/LayerPixels.h>
#include <osgGeoFX/raster/PictureFile.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/CameraRole.h>
#include <osgGeoFX/scene/CoreProfile.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/EngineTiles.h>
#include <osgGeoFX/scene/MeshRefiner.h>
#include <osgGeoFX/scene/ProgramAdapter.h>
#include <osgGeoFX/scene/RigidModel.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <osgGeoFX/scene/ShaderHost.h>
#include <osgGeoFX/scene/TilePrefetch.h>

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>

#include <osgGeoFX/ground/GroundDetail.h>

#include <osgGeoFX/mapping/ColorTransfer.h>
#include <osgGeoFX/mapping/DataLayer.h>
#include <osgGeoFX/mapping/Footprint.h>
#include <osgGeoFX/mapping/GeometrySwap.h>
#include <osgGeoFX/mapping/GroundOverlay.h>
#include <osgGeoFX/mapping/LensMapping.h>
#include <osgGeoFX/mapping/MappingPool.h>
#include <osgGeoFX/mapping/MarkImages.h>
#include <osgGeoFX/mapping/MaskPainter.h>
#include <osgGeoFX/mapping/PathRibbon.h>
#include <osgGeoFX/mapping/PointerPlace.h>
#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/mapping/RoutePath.h>
#include <osgGeoFX/mapping/SymbolMapping.h>
#include <osgGeoFX/mapping/ValueLegend.h>
#include <osgGeoFX/mapping/ValueMap.h>

#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/light/SunPosition.h>
#include <osgGeoFX/light/SunShadows.h>

#include <osgGeoFX/closeup/Anchor.h>
#include <osgGeoFX/closeup/CloseUp.h>
#include <osgGeoFX/closeup/CloseUpHandler.h>
#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/closeup/LiftedPlaces.h>
#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/closeup/SurfaceData.h>
#include <osgGeoFX/closeup/SurfaceDerivation.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerProbe.h>
#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/LayerSeries.h>
#include <osgGeoFX/mapping/LayerSource.h>
#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/RasterTiles.h>

#include <osgGeoFX/panorama/MaterialCover.h>
#include <osgGeoFX/panorama/PanoramaBrush.h>
#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <osgGeoFX/panorama/PanoramaPose.h>
#include <osgGeoFX/panorama/PanoramaSky.h>
#include <osgGeoFX/panorama/StrokeLines.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osgGeoFX/viewer/AboveGround.h>
#include <osgGeoFX/viewer/AutomaticPanorama.h>
#include <osgGeoFX/viewer/BendHandles.h>
#include <osgGeoFX/viewer/BendOnGround.h>
#include <osgGeoFX/viewer/CameraPath.h>
#include <osgGeoFX/viewer/ClickAndFly.h>
#include <osgGeoFX/viewer/Compass.h>
#include <osgGeoFX/viewer/CornerOverlay.h>
#include <osgGeoFX/viewer/CurvePanel.h>
#include <osgGeoFX/viewer/EarthNavigation.h>
#include <osgGeoFX/viewer/EarthSky.h>
#include <osgGeoFX/viewer/EffectKeys.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/EffectPanel.h>
#include <osgGeoFX/viewer/EffectPresets.h>
#include <osgGeoFX/viewer/GroundGrip.h>
#include <osgGeoFX/viewer/HelpPage.h>
#include <osgGeoFX/viewer/Liberties.h>
#include <osgGeoFX/viewer/LibertyHandler.h>
#include <osgGeoFX/viewer/ListPanel.h>
#include <osgGeoFX/viewer/MappingPanel.h>
#include <osgGeoFX/viewer/MiniMap.h>
#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/PanelCursor.h>
#include <osgGeoFX/viewer/PanelPicture.h>
#include <osgGeoFX/viewer/PictureParts.h>
#include <osgGeoFX/viewer/PresetKeys.h>
#include <osgGeoFX/viewer/ProbePanel.h>
#include <osgGeoFX/viewer/Scene.h>
#include <osgGeoFX/viewer/SceneData.h>
#include <osgGeoFX/viewer/SunKeys.h>
#include <osgGeoFX/viewer/ViewOrientation.h>
#include <osgGeoFX/viewer/ViewPoint.h>
#include <osgGeoFX/viewer/ViewerHandlers.h>

// Not there where the library was built without EGL.
#if __has_include(<osgGeoFX/offscreen/EglGraphicsContext.h>)
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/offscreen/LeastTriangles.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/viewer/TimeBar.h>
#endif
