include(CMakePackageConfigHelpers)

set(geofx_targets osgGeoFX)
if(GEOFX_BUILD_DATA)
  list(APPEND geofx_targets osgGeoFXData)
endif()
set(geofx_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/osgGeoFX)

install(TARGETS ${geofx_targets} EXPORT osgGeoFXTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_COMPONENT Development)
set_target_properties(${geofx_targets} PROPERTIES INSTALL_RPATH "$ORIGIN")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/osgGeoFX DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "cmake" EXCLUDE PATTERN "terrain" EXCLUDE PATTERN "geodata" EXCLUDE)
if(GEOFX_BUILD_DATA)
  # Those that export something; the others are between the library's own files and include GDAL.
  foreach(folder terrain geodata)
    file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/osgGeoFX/${folder}/*.h)
    foreach(header ${headers})
      file(STRINGS ${header} exported REGEX OSGGEOFXDATA_EXPORT)
      if(exported)
        install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/osgGeoFX/${folder})
      endif()
    endforeach()
  endforeach()
endif()
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
