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

# The linker's view of the libraries.
run(readelf -d ${prefix}/${LIBDIR}/libosgGeoFX.so)
if(NOT output MATCHES "soname: \\[libosgGeoFX\\.so\\.${SOVERSION}\\]")
  message(FATAL_ERROR "libosgGeoFX.so has not the soname libosgGeoFX.so.${SOVERSION}:\n${output}")
endif()
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
