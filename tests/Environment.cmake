# Read by ctest itself, before its tests: what all of them have in their environment.

# llvmpipe compiles each shader in a third of the time without its optimizer, and tests draw too little to miss it.
if(NOT DEFINED ENV{GALLIVM_PERF})
  set(ENV{GALLIVM_PERF} nopt)
endif()
