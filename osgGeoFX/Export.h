// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#if defined(_WIN32)
#define OSGGEOFX_SYMBOL_OUT __declspec(dllexport)
#define OSGGEOFX_SYMBOL_IN __declspec(dllimport)
#else
#define OSGGEOFX_SYMBOL_OUT __attribute__((visibility("default")))
#define OSGGEOFX_SYMBOL_IN __attribute__((visibility("default")))
#endif

/// Symbols of libosgGeoFX.
#if defined(osgGeoFX_EXPORTS)
#define OSGGEOFX_EXPORT OSGGEOFX_SYMBOL_OUT
#else
#define OSGGEOFX_EXPORT OSGGEOFX_SYMBOL_IN
#endif

/// Symbols of libosgGeoFXData.
#if defined(osgGeoFXData_EXPORTS)
#define OSGGEOFXDATA_EXPORT OSGGEOFX_SYMBOL_OUT
#else
#define OSGGEOFXDATA_EXPORT OSGGEOFX_SYMBOL_IN
#endif

/// Symbols of libosgGeoFXMaps.
#if defined(osgGeoFXMaps_EXPORTS)
#define OSGGEOFXMAPS_EXPORT OSGGEOFX_SYMBOL_OUT
#else
#define OSGGEOFXMAPS_EXPORT OSGGEOFX_SYMBOL_IN
#endif
