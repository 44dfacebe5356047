# See CMakeLists.txt beside this file.
set(root ${BUILD_DIR}/test-output/install)
set(prefix ${root}/prefix)
file(REMOVE_RECURSE ${root})

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${code}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})

# The linker's view of the libraries: the name that programs ask for at run time is that of the versions which the
# package calls compatible, those with the same minor version.
string(REGEX REPLACE "^([0-9]+\\.[0-9]+).*" "\\1" compatible ${VERSION})
file(READ ${prefix}/${LIBDIR}/cmake/osgGeoFX/osgGeoFXConfigVersion.cmake package_version)
if(NOT package_version MATCHES "major and minor versions are the same")
  message(FATAL_ERROR "The package no longer asks for equal minor versions; the soname must follow.")
endif()
string(REPLACE "." "\\." pattern ${compatible})
foreach(library osgGeoFXData osgGeoFX)
  if(NOT DATA AND library STREQUAL "osgGeoFXData")
    continue()
  endif()
  run(readelf -d ${prefix}/${LIBDIR}/lib${library}.so)
  if(NOT output MATCHES "soname: \\[lib${library}\\.so\\.${pattern}\\]")
    message(FATAL_ERROR "lib${library}.so has not the soname lib${library}.so.${compatible}:\n${output}")
  endif()
endforeach()
if(output MATCHES "libgdal|libGeographic|libOpenImageIO")
  message(FATAL_ERROR "libosgGeoFX.so must need OSG and GLM alone:\n${output}")
endif()
if(NOT EXISTS ${prefix}/${DATADIR}/osgGeoFX/shaders/lib/bend.glsl)
  message(FATAL_ERROR "The shaders are not installed.")
endif()

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${root}/build -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_FLAGS=${FLAGS} -DWITH_DATA=${DATA}
    -DHEADERS=${prefix}/include/osgGeoFX)
run(${CMAKE_COMMAND} --build ${root}/build)
run(${root}/build/consumer)
if(DATA)
  run(${root}/build/consumer_data)
endif()
