# Warnings and sanitizers for everything that is ours; headers of others are SYSTEM and stay silent.
add_library(geofx_warnings INTERFACE)
target_compile_options(geofx_warnings INTERFACE -Wall -Wextra -Wpedantic -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wcast-align -Wdouble-promotion -Wformat=2)
# In groups of files (Unity.cmake) names of one file hide those of another, and types of one are anonymous in another's.
set(geofx_grouped $<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>)
# GCC still compares the local names with each other; lint.tidy reads each file alone and compares all.
target_compile_options(geofx_warnings INTERFACE $<$<NOT:${geofx_grouped}>:-Wshadow>
                       "$<$<AND:${geofx_grouped},$<CXX_COMPILER_ID:GNU>>:-Wshadow=local;-Wno-subobject-linkage>")
option(GEOFX_WARNINGS_AS_ERRORS "Stop at the first compiler warning" ${PROJECT_IS_TOP_LEVEL})
if(GEOFX_WARNINGS_AS_ERRORS)
  target_compile_options(geofx_warnings INTERFACE -Werror)
endif()
if(GEOFX_SANITIZE)
  # GCC 12 finds uninitialised members in <regex> once it has instrumented it.
  target_compile_options(geofx_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_compile_options(-fsanitize=${GEOFX_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=${GEOFX_SANITIZE})
endif()
