include(CMakePackageConfigHelpers)

set(geofx_targets osgGeoFX)
if(GEOFX_BUILD_DATA)
  list(APPEND geofx_targets osgGeoFXData)
endif()
if(GEOFX_BUILD_MAPS)
  list(APPEND geofx_targets osgGeoFXMaps)
endif()
set(geofx_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/osgGeoFX)

install(TARGETS ${geofx_targets} EXPORT osgGeoFXTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_COMPONENT Development)
set_target_properties(${geofx_targets} PROPERTIES INSTALL_RPATH "$ORIGIN")
# What lies in a folder's detail/ is between the library's own files.
set(geofx_installed_folders ${geofx_folders})
if(GEOFX_BUILD_DATA)
  list(APPEND geofx_installed_folders ${geofx_data_folders})
endif()
if(GEOFX_BUILD_MAPS)
  list(APPEND geofx_installed_folders ${geofx_maps_folders})
endif()
foreach(folder ${geofx_installed_folders})
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/osgGeoFX/${folder}/*.h)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/osgGeoFX/${folder})
endforeach()
set(geofx_top_headers Export.h osgGeoFX.h)
if(GEOFX_BUILD_DATA)
  list(APPEND geofx_top_headers osgGeoFXData.h)
endif()
if(GEOFX_BUILD_MAPS)
  list(APPEND geofx_top_headers osgGeoFXMaps.h)
endif()
list(TRANSFORM geofx_top_headers PREPEND ${PROJECT_SOURCE_DIR}/osgGeoFX/)
install(FILES ${geofx_top_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/osgGeoFX)
install(EXPORT osgGeoFXTargets NAMESPACE osgGeoFX:: DESTINATION ${geofx_config_dir})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/osgGeoFXConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/osgGeoFXConfig.cmake
                              INSTALL_DESTINATION ${geofx_config_dir})
# The interface may change with each minor version until 1.0.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/osgGeoFXConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/osgGeoFXConfig.cmake ${PROJECT_BINARY_DIR}/osgGeoFXConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/OpenSceneGraphTarget.cmake
        DESTINATION ${geofx_config_dir})
