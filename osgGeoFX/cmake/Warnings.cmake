# Warnings and sanitizers for everything that is ours; headers of others are SYSTEM and stay silent.
add_library(geofx_warnings INTERFACE)
target_compile_options(geofx_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Woverloaded-virtual -Wcast-align -Wdouble-promotion -Wformat=2)
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
